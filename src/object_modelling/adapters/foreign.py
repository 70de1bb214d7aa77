"""Message packages of others, found when the program runs."""
import importlib

from object_modelling.outcome import Code, Failure


class Package:
    """Where the messages come from, and how to get them."""

    def __init__(self, names, remedy):
        """`names`: of packages that have the messages, tried in this order."""
        self._names = names
        self._remedy = remedy

    def types(self, wanted):
        """Message classes by name. `wanted`: the fields that each must have. Raises Failure that names what is missing
        and how to install it."""
        reasons = []
        for name in self._names:
            try:
                module = importlib.import_module(name + ".msg")
            except ImportError as error:
                reasons.append("package %s is not found (%s)" % (name, error))
                continue
            lacking = list(self._lacking(module, wanted))
            if not lacking:
                return {message: getattr(module, message) for message in wanted}
            reasons.append("package %s is another version: it lacks %s" % (name, ", ".join(lacking)))
        raise Failure(Code.FAILED_PRECONDITION, "%s; %s" % ("; ".join(reasons), self._remedy))

    @staticmethod
    def _lacking(module, wanted):
        for message, fields in wanted.items():
            if not hasattr(module, message):
                yield message
                continue
            for field in fields:
                if field not in getattr(module, message).__slots__:
                    yield "%s.%s" % (message, field)


def fill(message, **fields):
    """Sets those of the fields that this version of the message has."""
    for name, value in fields.items():
        if name in message.__slots__:
            setattr(message, name, value)
    return message
