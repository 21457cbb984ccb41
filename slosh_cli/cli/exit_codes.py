"""Exit codes of the command `slosh`."""

from enum import IntEnum


class ExitCode(IntEnum):
    """What the shell learns from a command; scripts rely on these numbers."""

    DONE = 0
    FELL_SHORT = 1
    """A validation missed its stated tolerance."""
    BAD_INPUT = 2
    """The user's input is wrong (scenario, option, file), or a file could not be written."""
    NO_ANSWER = 3
    """A run ended without an answer (its status says why), or the program itself failed."""
    INTERRUPTED = 130
