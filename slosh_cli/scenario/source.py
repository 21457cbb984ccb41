"""The text of a scenario file."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Final

from slosh_cli.errors import Problem, ScenarioError

LONGEST_FILE: Final = 1_000_000
"""Bytes; a scenario has a few thousand."""


def text_of(path: Path) -> str:
    """The text of a file; ScenarioError where there is none to read."""
    try:
        if path.is_dir():
            raise _unreadable(path, "must be a file", "a folder", "name the scenario file in it")
        with path.open("rb") as stream:
            raw = stream.read(LONGEST_FILE + 1)
    except FileNotFoundError:
        raise _unreadable(path, "must exist", "a path with no file", _similar(path)) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise _unreadable(path, "must be readable", f"`{reason}`", "check the path and its permissions") from None
    if len(raw) > LONGEST_FILE:
        given, fix = f"more than {LONGEST_FILE} bytes", "name a scenario file"
        raise _unreadable(path, f"must have at most {LONGEST_FILE} bytes", given, fix)
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        given = f"the byte {raw[error.start]:#04x} at position {error.start}"
        raise _unreadable(path, "must be text in UTF-8", given, "save the file as UTF-8", line) from None


def _unreadable(path: Path, rule: str, given: str, fix: str, line: int | None = None) -> ScenarioError:
    return ScenarioError(str(path), (Problem(line, "", rule, given, fix),))


def _similar(path: Path) -> str:
    """What to write instead of a path that does not exist."""
    try:
        names = [entry.name for entry in path.parent.iterdir() if entry.suffix in (".yaml", ".yml")]
    except OSError:
        names = []
    near = difflib.get_close_matches(path.name, names, 1)
    if near:
        return f"write `{path.parent / near[0]}`"
    return "check the path, or write a scenario to start from with `slosh init`"
