"""The command line: the only part of the program that prints and sets exit codes."""

from slosh_cli.cli.shell import main

__all__ = ["main"]
