"""The errors of the program: what a person did wrong, said so that they can put it right.

Every class survives pickling with its text intact, because a worker's failure has to reach the person
who started the study as the same message.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, ClassVar, Final

MOST_SHOWN: Final = 20
"""Problems that a message spells out; of the others it gives the number."""
_LONGEST: Final = 400
"""Letters of one piece of a message; more is somebody's file, not a message."""


class SloshError(Exception):
    """Base of all errors of the program.

    `code` names the kind (it goes into ``--json`` output), `message` is the text for people and `where` the
    place it is about: ``file:line``, an option, or empty.
    """

    code: ClassVar[str] = "error"

    def __init__(self, message: str, where: str = "") -> None:
        super().__init__(message, where)
        self.message = message
        self.where = where

    def __str__(self) -> str:
        return self.message


class UsageError(SloshError):
    """The command line asks for something that cannot be done as written."""

    code: ClassVar[str] = "usage"


class ValueRefused(UsageError):  # noqa: N818 - reads as what happened to the value
    """One value breaks one rule.

    `rule` says what the value must be, `given` what was found, `fix` what to write instead.
    """

    def __init__(self, rule: str, given: str, fix: str) -> None:
        super().__init__(f"{rule}; given {given}; {fix}")
        self.rule = rule
        self.given = given
        self.fix = fix

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return type(self), (self.rule, self.given, self.fix)


@dataclass(frozen=True)
class Problem:
    """One mistake in a scenario.

    `line` counts from 1 and is None where no line can be named: an unreadable file, or a value that came
    from an override, in which case `override` holds the way to write it (``--set braking.torque``).
    """

    line: int | None
    key: str
    rule: str
    given: str
    fix: str
    override: str = ""

    def where(self, file: str) -> str:
        """The place in one word: the override, ``file:line`` or the bare file."""
        if self.override:
            return printable(shortened(self.override))
        return file if self.line is None else f"{file}:{self.line}"

    def text(self, file: str) -> str:
        """The whole message on one line, ``where: key.path: rule; given ...; what to write``."""
        key = "" if self.override.endswith(self.key) else shortened(self.key)
        parts = [self.where(file), key, f"{shortened(self.rule)}; given {shortened(self.given)}; {shortened(self.fix)}"]
        return printable(": ".join(part for part in parts if part))


def shortened(text: str) -> str:
    """`text`, or the beginning of it where it is longer than a piece of a message may be."""
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def printable(text: str, kept: str = "") -> str:
    """`text` with line ends and control characters spelt out, but for those `kept`.

    A message keeps to its line, and nothing of it steers a terminal.
    """
    if text.isprintable():
        return text
    return "".join(letter if letter.isprintable() or letter in kept else repr(letter)[1:-1] for letter in text)


class ScenarioError(SloshError):
    """A scenario, study or table cannot be used.

    `problems` lists what is wrong with it, not only the first mistake; `more` counts those left out of it. The message
    spells the first ones out.
    """

    code: ClassVar[str] = "scenario"

    def __init__(self, file: str, problems: Iterable[Problem], more: int = 0) -> None:
        self.file = file
        self.problems = tuple(problems)
        self.more = more
        lines = [problem.text(file) for problem in self.problems[:MOST_SHOWN]]
        rest = len(self.problems) - len(lines) + more
        if rest:
            lines.append(f"and {rest:,} more {'problem' if rest == 1 else 'problems'}")
        super().__init__("\n".join(lines), self.problems[0].where(file) if self.problems else file)

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return type(self), (self.file, self.problems, self.more)


class PhysicsError(SloshError):
    """A scenario is well formed but describes something that the equations have no answer for."""

    code: ClassVar[str] = "physics"
