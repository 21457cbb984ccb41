"""The kinds of single value that are words: a choice of a few, a text, a name."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.leaves import Leaf
from slosh_cli.scenario.scalars import well_formed
from slosh_cli.scenario.units import plain


def one_of(options: Sequence[str]) -> str:
    """``a, b or c``, each in back quotes."""
    quoted = [f"`{option}`" for option in options]
    return " or ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)


def all_of(names: Iterable[str]) -> str:
    """``a, b and c``."""
    names = list(names)
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


@dataclass(frozen=True)
class Choice(Leaf):
    """One of a few words."""

    options: tuple[str, ...]

    def sample(self) -> str:
        return self.options[-1]

    def parse(self, value: object) -> str:
        if isinstance(value, str) and value in self.options:
            return value
        raise self.refusal(value)

    def refusal(self, value: object) -> ValueRefused:
        """Why `value` is none of the words, with a guess at the intended one."""
        all_of, likely = one_of(self.options), self.guess(value)
        return ValueRefused(f"must be {all_of}", plain(value), f"write `{likely}`" if likely else f"write {all_of}")

    def guess(self, value: object) -> str:
        """The word closest to `value`, or empty."""
        if not isinstance(value, str):
            return ""
        text = value.lower().replace("_", "-").replace(" ", "-")
        plain_forms = {option.lower().replace("_", "-"): option for option in self.options}
        near = difflib.get_close_matches(text, plain_forms, 1, cutoff=0.6)
        return plain_forms[near[0]] if near else ""

    def json_schema(self) -> dict[str, Any]:
        return {"enum": list(self.options)}


@dataclass(frozen=True)
class Text(Leaf):
    """Text of at most `longest` characters; a `pattern` comes with the `words` that describe it."""

    longest: int
    pattern: str = ""
    words: str = ""
    repair: Callable[[str], str] | None = None

    def sample(self) -> str:
        return "stop-1"

    def parse(self, value: object) -> str:
        rule = f"must be text of at most {self.longest} characters{self.words}"
        if not isinstance(value, str):
            quoted = isinstance(value, int | float)
            written = str(value).lower() if isinstance(value, bool) else str(value)
            fix = f'write it in quotes: `"{written}"`' if quoted else "write text"
            raise ValueRefused(rule, plain(value), fix)
        if len(value) > self.longest:
            raise ValueRefused(rule, f"{len(value)} characters", "shorten it")
        lone = well_formed(value)[1]
        if lone:
            raise ValueRefused("must be text that can be written as UTF-8", f"`{lone}` in it", "write it in UTF-8")
        if any(unicodedata.category(letter) == "Cc" and letter not in "\n\t" for letter in value):
            raise ValueRefused("must be text without control characters", plain(value), "take them out")
        if self.pattern and not re.fullmatch(self.pattern, value):
            better = self.repair(value) if self.repair else ""
            raise ValueRefused(
                rule, plain(value), f"write `{better}`" if better else f"write a name such as `{self.sample()}`"
            )
        return value

    def json_schema(self) -> dict[str, Any]:
        pattern = {"pattern": f"^{self.pattern}$"} if self.pattern else {}
        return {"type": "string", "maxLength": self.longest, **pattern}


def file_safe(text: str) -> str:
    """The nearest name that can be a folder: ``my stop/2`` becomes ``my-stop-2``."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip("-._")[:100]


NAME: Final = Text(
    longest=100,
    pattern=r"[A-Za-z0-9][A-Za-z0-9._-]*",
    words=" that can name a folder: letters, digits, `.`, `-` and `_`, a letter or digit first",
    repair=file_safe,
)
