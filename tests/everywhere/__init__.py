"""The same answer everywhere: runs, threads, processes, Pythons, versions of the dependencies, kinds of processor."""

import sys


def say(line: str) -> None:
    """A line of the report, out at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()
