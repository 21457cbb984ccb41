"""The command line: the only part of the program that prints and sets exit codes."""

import atexit
import gc
import os
from collections.abc import Sequence

from slosh_cli.cli.interrupts import catch_signals


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line with `arguments` (default: those of the process); returns the exit code."""
    if arguments is None:  # the process is ours
        catch_signals()
    _hurry()
    _draw_without_windows()
    from slosh_cli.cli.shell import execute

    return execute(arguments)


def _hurry() -> None:
    """Spend no time on what a short-lived process does not need.

    Loading libraries makes objects by the hundred thousand and no garbage, and at the end of the process nobody needs
    to know which of them refer to each other; plugins of pydantic are sought in the metadata of every installed
    package.
    """
    gc.set_threshold(100_000)
    atexit.register(gc.freeze)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")


def _draw_without_windows() -> None:
    """Figures go to files: whatever kind of window matplotlib is told to open, or cannot, is no matter here."""
    os.environ.pop("MPLBACKEND", None)
