"""Reads a node's private parameters into a dataclass; free of ROS."""
import dataclasses


class ParameterError(Exception):
    """Lists everything that is wrong, so that a user mends all of it at once."""


def read(options_type, values, owner):
    """`values`: the private namespace as a dict. Unknown keys and wrong types are errors; absent ones keep the default.
    `options_type` may have violations() -> [str]."""
    problems = []
    known = {field.name: field for field in dataclasses.fields(options_type)}
    taken = {}
    for key, value in sorted(values.items()):
        if key not in known:
            problems.append("%s/%s: unknown parameter; known are %s" % (owner, key, ", ".join(sorted(known))))
            continue
        expected = type(known[key].default)
        if expected is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if type(value) is not expected:
            problems.append("%s/%s: must be of type %s, is '%s'" % (owner, key, expected.__name__, value))
            continue
        taken[key] = value
    options = options_type(**taken)
    if not problems and hasattr(options, "violations"):
        problems = ["%s/%s" % (owner, violation) for violation in options.violations()]
    if problems:
        raise ParameterError("invalid parameters:\n  " + "\n  ".join(problems))
    return options
