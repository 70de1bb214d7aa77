"""Private parameters of a rospy node."""
from object_modelling.outcome import Code, Failure


def read(node, defaults, given):
    """Values by name, all of them texts; `defaults` names those that the node knows. Raises Failure that names all that
    is wrong."""
    wrong = ["~%s is not known" % name for name in sorted(set(given) - set(defaults))]
    wrong += ["~%s must be text, but is %r" % (name, value) for name, value in sorted(given.items())
              if name in defaults and not isinstance(value, str)]
    if wrong:
        raise Failure(Code.INVALID_ARGUMENT, "parameters of %s: %s; known: %s" % (
            node, "; ".join(wrong), ", ".join(defaults)))
    return dict(defaults, **given)
