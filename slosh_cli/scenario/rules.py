"""What is valid in a scenario, and the rules that tie several of its values together.

A rule is checked as soon as the values it needs are valid, whatever else is wrong, so that a person
sees everything at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

from pydantic import ValidationError

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Part, Path
from slosh_cli.scenario.tree import Spot, spot_of
from slosh_cli.scenario.words import all_of


@dataclass(frozen=True)
class Finding:
    """One mistake at one path of the data: the rule, what was given and what to write.

    Of an unknown key, `guess` is the path of the key that was probably meant. Where something is missing, `missing` has
    the paths of the keys that would do.
    """

    path: Path
    rule: str
    given: str
    fix: str
    guess: Path = ()
    missing: tuple[Path, ...] = ()


@dataclass
class Values:
    """Valid values by dotted key path, defaults included, and the paths that were written out.

    A list of parts is there as a whole and part by part (``axles`` and ``axles.0.load``). `ruled` are the parts that
    have rules, with their paths. Key paths given to the methods begin at `prefix`.
    """

    values: dict[str, Any] = field(default_factory=dict)
    explicit: set[str] = field(default_factory=set)
    ruled: list[tuple[str, type[Part]]] = field(default_factory=list)
    prefix: str = ""

    def has(self, *keys: str) -> bool:
        """Whether there are valid values for all the keys."""
        return all(self.prefix + key in self.values for key in keys)

    def wrote(self, key: str) -> bool:
        """Whether the key was written out."""
        return self.prefix + key in self.explicit

    def get(self, key: str, default: Any = None) -> Any:
        """The value, or the default where there is none that is valid."""
        return self.values.get(self.prefix + key, default)

    def __getitem__(self, key: str) -> Any:
        return self.values[self.prefix + key]

    def broken(self) -> Iterator[Finding]:
        """Everything that the rules of the parts have against the values."""
        for prefix, model in self.ruled:
            above: Path = tuple(int(step) if step.isdecimal() else step for step in prefix.split(".")[:-1])
            here = replace(self, prefix=prefix)
            for group in model.exactly_one:
                yield from here._not_exactly_one(group, above, spot_of(model, group[0]))
            for rule in model.rules:
                for finding in rule(here):
                    yield replace(finding, path=(*above, *finding.path))

    def _not_exactly_one(self, group: tuple[str, ...], above: Path, first: Spot) -> Iterator[Finding]:
        written = [name for name in group if self.wrote(name) and self.get(name, ...) is not None]
        for name in written[1:]:
            yield Finding((*above, name), f"must not be given beside `{written[0]}`", "both", "keep one of them")
        if not written:
            sample = first.leaf.sample() if first.leaf else "..."
            fix = f"write one of them, such as `{group[0]}: {sample}`"
            missing = tuple((*above, name) for name in group)
            yield Finding(above, f"must have one of the keys {all_of(group)}", "none", fix, missing=missing)

    def add(self, part: Part, prefix: str = "") -> None:
        """Take in all values of a validated part."""
        model = type(part)
        self._begin(model, prefix)
        keys = _keys_of(model, prefix)
        self.explicit.update([keys[name] for name in part.model_fields_set])
        for name, value in vars(part).items():
            if isinstance(value, Part):
                self.add(value, f"{keys[name]}.")
            else:
                self._take(value, keys[name])

    def add_valid(self, model: type[Part], data: Mapping[str, Any], prefix: str = "") -> None:
        """Take in what is valid in data that as a whole is not; keys with an invalid value are left out."""
        self._begin(model, prefix)
        data = model.with_fields(data)
        for name, entry in model.model_fields.items():
            key = prefix + name
            if name in data:
                self.explicit.add(key)
                self._add_valid(spot_of(model, name), model, name, data[name], key)
            elif not entry.is_required():
                self._take_valid(entry.get_default(), key)

    def _begin(self, model: type[Part], prefix: str) -> None:
        if model.rules or model.exactly_one:
            self.ruled.append((prefix, model))

    def _take(self, value: Any, key: str) -> None:
        """A valid value that is no part; of a list of parts all that is in it."""
        self.values[key] = value
        if type(value) is tuple and value and isinstance(value[0], Part):
            for number, item in enumerate(value):
                self.add(item, f"{key}.{number}.")

    def _take_valid(self, value: Any, key: str) -> None:
        if isinstance(value, Part):
            self.add(value, f"{key}.")
        else:
            self._take(value, key)

    def _add_valid(self, spot: Spot, model: type[Part], name: str, value: Any, key: str) -> None:
        chosen = spot.chosen(value)
        try:
            if spot.leaf is not None:
                self.values[key] = spot.leaf.parse(value)
            elif chosen is not None and chosen.part is not None and isinstance(value, dict):
                self.add_valid(chosen.part, value, f"{key}.")
            else:
                self._take_valid(model.field_from_text(name, value), key)
        except (ValueRefused, ValidationError):
            for number, item in enumerate(value if isinstance(value, list) else ()):
                found = chosen.items.chosen(item) if chosen and chosen.items else None
                if found is not None and found.part is not None and isinstance(item, dict):
                    self.add_valid(found.part, item, f"{key}.{number}.")


@lru_cache(maxsize=1024)
def _keys_of(model: type[Part], prefix: str) -> dict[str, str]:
    return {name: prefix + name for name in model.model_fields}
