"""The bytes and the text of files that people give: scenarios, studies, tables."""

from __future__ import annotations

import difflib
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from slosh_cli.errors import Problem, ScenarioError


@dataclass(frozen=True)
class Kind:
    """A kind of file: what people call it, the endings it has, how large it may be, what else to do."""

    noun: str
    endings: tuple[str, ...]
    most_bytes: int
    otherwise: str


_SCENARIO: Final = Kind(
    "scenario", (".yaml", ".yml"), 1_000_000, "check the path, or write a scenario to start from with `slosh init`"
)
"""A scenario has a few thousand bytes."""


def text_of(path: Path) -> str:
    """The text of a scenario or study; ScenarioError where there is none to read."""
    raw = bytes_of(path, _SCENARIO)
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        given = f"the byte {raw[error.start]:#04x} at position {error.start}"
        raise unreadable(path, "must be text in UTF-8", given, "save the file as UTF-8", line) from None


def bytes_of(path: Path, kind: Kind) -> bytes:
    """All of a file; ScenarioError where there is none, or too much of it."""
    try:
        other = other_than_file(path)
        if other:
            folder = other == "a folder"
            fix = f"name the {kind.noun} file in it" if folder else f"save the {kind.noun} to a file and name that"
            raise unreadable(path, "must be a file", other, fix)
        with path.open("rb") as stream:
            raw = stream.read(kind.most_bytes + 1)
    except FileNotFoundError:
        raise unreadable(path, "must exist", "a path with no file", _similar(path, kind)) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise unreadable(path, "must be readable", f"`{reason}`", "check the path and its permissions") from None
    if len(raw) > kind.most_bytes:
        given, fix = f"more than {kind.most_bytes} bytes", f"name a {kind.noun} file"
        raise unreadable(path, f"must have at most {kind.most_bytes} bytes", given, fix)
    return raw


def other_than_file(path: Path) -> str:
    """What is at the path in place of a file, in words; empty for a file and for nothing at all. Raises OSError.

    A pipe may never end, and can be read once only.
    """
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        return ""
    kinds = {stat.S_ISREG: "", stat.S_ISDIR: "a folder", stat.S_ISFIFO: "a pipe", stat.S_ISSOCK: "a socket"}
    return next((words for is_kind, words in kinds.items() if is_kind(mode)), "a device")


def unreadable(path: Path, rule: str, given: str, fix: str, line: int | None = None) -> ScenarioError:
    """The refusal of a file as a whole, or of what begins at one of its lines."""
    return ScenarioError(str(path), (Problem(line, "", rule, given, fix),))


def _similar(path: Path, kind: Kind) -> str:
    """What to write instead of a path that does not exist."""
    try:
        names = [entry.name for entry in path.parent.iterdir() if entry.suffix in kind.endings]
    except OSError:
        names = []
    near = difflib.get_close_matches(path.name, names, 1)
    return f"write `{path.parent / near[0]}`" if near else kind.otherwise
