"""Outcomes of calls; free of ROS. The numbers are those of msg/Status.msg."""
from enum import IntEnum
import re


class Code(IntEnum):
    OK = 0
    INVALID_ARGUMENT = 1
    NOT_FOUND = 2
    FAILED_PRECONDITION = 3
    BAD_INPUT = 4
    NO_RESULT = 5
    STORAGE = 6
    CANCELLED = 7
    TIMEOUT = 8
    INTERNAL = 9


class Failure(Exception):
    """Why a call is refused or a job ended without result; the message names the thing, the value and the remedy."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = Code(code)
        self.message = message


class NodeDown(Failure):
    """A node that should answer does not."""

    def __init__(self, name, detail):
        super().__init__(
            Code.TIMEOUT,
            "%s does not answer (%s): is its node running and in the same namespace? See 'rosnode list'"
            % (name, detail),
        )


_ID = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}\Z")


def check_id(what, value):
    """Session and object ids become names of folders, topics and rows: the same rule as keyframes::isValidId."""
    if not _ID.match(value):
        raise Failure(
            Code.INVALID_ARGUMENT,
            "%s '%s' must have 1 to 64 of [A-Za-z0-9_.-] and not begin with '.' or '-'" % (what, value),
        )
