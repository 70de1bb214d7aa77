"""Outcomes of calls; free of ROS. The numbers are those of msg/Status.msg."""
from enum import IntEnum


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
