"""What to say of a key that the schema does not know."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final

from slosh_cli.scenario.base import Path
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.tree import Spot, value_at
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.words import all_of

_LONGEST_GUESSED: Final = 60
"""Letters of a key that is guessed at."""


class UnknownKey:
    """A key that is not in the schema, with a guess: another place for it, a similar key, another branch of a union."""

    def __init__(self, root: Spot, data: Mapping[str, Any], path: Path) -> None:
        self.root, self.data, self.path = root, data, path
        self.name = str(path[-1])
        self.above = path[:-1]
        self.part = root.part_at(data, self.above)
        self.fields = self.part.every_key() if self.part else ()

    def finding(self, *, guessing: bool) -> Finding:
        """What is wrong with the key; a guess takes its time and can be left out."""
        both = next((alias for alias in self.part.aliases if alias.key == self.name), None) if self.part else None
        if both is not None:
            return Finding(self.path, f"must not be given beside `{both.field}`", "both", "keep one of them")
        rule, given = self._rule_and_given()
        if not guessing or len(self.name) > _LONGEST_GUESSED:
            return Finding(self.path, rule, given, "take it out")
        fix, meant = self._fix_and_meant()
        return Finding(self.path, rule, given, fix, self._field(meant))

    def _field(self, path: Path) -> Path:
        """The path of the field that a key stands for."""
        part = self.root.part_at(self.data, path[:-1])
        return (*path[:-1], part.field_of(str(path[-1]))) if part and path else path

    def _rule_and_given(self) -> tuple[str, str]:
        given = plain(self.name)
        if not self.above:
            return f"is not a key of a {self.part.noun if self.part else 'mapping'}", given
        spot, place = self.root.at(self.data, self.above), ".".join(map(str, self.above))
        if spot is None or not spot.parts:
            return f"is not a key of `{place}`", given
        tag = value_at(self.data, (*self.above, spot.key))
        owners = [tag for tag, part in spot.parts.items() if self.name in part.every_key()]
        if owners:
            given += f", which belongs to {spot.key} {' or '.join(owners)}"
        last, named = str(self.above[-1]), self.root.part_at(self.data, self.above[:-1]) is not None
        what = f"{'an' if last[0] in 'aeiou' else 'a'} {last}" if named else f"`{place}`,"
        return f"is not a key of {what} of {spot.key} {tag}", given

    def _fix_and_meant(self) -> tuple[str, Path]:
        """What to write, and the path of the key that was probably meant, where one was."""
        parent = value_at(self.data, self.above)
        known = parent if isinstance(parent, dict) else {}
        absent = {key.lower(): key for key in self.fields if self.part and not self.part.is_written(key, known)}
        near = _similar(self.name, tuple(absent))
        depth = len(self.above)
        places = sorted(self.root.places(self.name, self.data), key=lambda place: place[:depth] != self.above)
        elsewhere = [place for place in places if value_at(self.data, place) is None]
        if elsewhere:
            return f"move it to `{'.'.join(map(str, elsewhere[0]))}`", elsewhere[0]
        if near:
            return f"write `{absent[near[0]]}`", (*self.above, absent[near[0]])
        taken = _similar(self.name, self.fields)
        if taken:
            return f"write `{taken[0]}`, which is there already, or take it out", ()
        if places:
            return f"take it out, or did you mean `{'.'.join(map(str, places[0]))}`?", ()
        return f"take it out; the keys here are {all_of(self.fields)}", ()


@lru_cache(maxsize=400)
def _similar(name: str, keys: tuple[str, ...]) -> list[str]:
    """At most one of `keys`; short names may differ in half of their letters."""
    return difflib.get_close_matches(name.lower().replace("-", "_"), keys, 1, 0.5 if len(name) < 4 else 0.6)
