"""From plain data to a model, or to the complete list of what is wrong with the data."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache, lru_cache
from typing import Annotated, Any, Final, TypeVar

from pydantic import Field, TypeAdapter, ValidationError

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.alias import aliases_of, field_of, is_written, keys_of, with_fields
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.document import Path
from slosh_cli.scenario.leaves import (
    FROM_TEXT,
    Choice,
    Count,
    Leaf,
    Number,
    Quantity,
    Text,
    Version,
    guess,
    not_an_option,
    one_of,
)
from slosh_cli.scenario.polygon import EXAMPLE
from slosh_cli.scenario.rules import Finding, Values, broken_rules, values_of
from slosh_cli.scenario.schema import Root
from slosh_cli.scenario.split_numbers import rejoined
from slosh_cli.scenario.tree import (
    Spot,
    data_path,
    leaf_of,
    part_at,
    places_of,
    spot_at,
    spot_of,
    unions,
    value_at,
)
from slosh_cli.scenario.units import plain

R = TypeVar("R", bound=Root)

MOST_GUESSES: Final = 200
"""Different unknown keys that are guessed at; the others are only named, because a guess takes its time."""
LONGEST_GUESSED: Final = 60
"""Letters of a key that is guessed at."""


def diagnose(model: type[R], data: Mapping[str, Any]) -> tuple[R | None, tuple[Finding, ...]]:
    """The validated model, or None and every finding. Quantities in `data` are texts with a unit."""
    try:
        return model.model_validate(data, context=FROM_TEXT), ()
    except ValidationError as error:
        findings = list(_translated(model, data, error.errors(include_url=False)))
    guessed = _with_guessed_tags(model, data)
    if guessed is not None:
        findings += diagnose(model, guessed)[1]
    findings = rejoined(findings, lambda path: value_at(data, path), lambda path: _leaf_at(model, data, path))
    findings += broken_rules(_valid_values(model, data), model.rules)
    return None, tuple(dict.fromkeys(_as_written(model, data, finding) for finding in _without_echoes(findings)))


def _as_written(model: type[Root], data: Mapping[str, Any], finding: Finding) -> Finding:
    """A finding about a field at the key that the field was written under."""
    above = finding.path[:-1]
    given = value_at(data, above)
    for alias in aliases_of(part_at(model, data, above)) if isinstance(given, dict) else ():
        if finding.path[-1] == alias.field and alias.field not in given and alias.key in given:
            return replace(finding, path=(*above, alias.key))
    return finding


def _leaf_at(model: type[Part], data: Any, path: Path) -> Leaf | None:
    """The leaf of the field at `path`, None where there is none."""
    part = part_at(model, data, path[:-1])
    return leaf_of(part.model_fields[str(path[-1])]) if part and path[-1] in part.model_fields else None


def _with_guessed_tags(model: type[Root], data: Mapping[str, Any]) -> dict[str, Any] | None:
    """The data with the shape of tank, say, that was probably meant, so that the other keys can be judged."""
    guessed: dict[str, Any] | None = None
    for path, spot in unions(model):
        value = value_at(data, path)
        if not isinstance(value, dict) or spot.chosen(value) is not None:
            continue
        tag = guess(value.get(spot.key, ""), tuple(spot.parts)).strip("`") or _telling_tag(spot, value)
        if tag:
            guessed = _replaced(guessed or dict(data), path, {**value, spot.key: tag})
    return guessed


def _telling_tag(spot: Spot, value: Mapping[str, Any]) -> str:
    """The one branch of a union that knows a key of `value` which no other has."""
    for name in value:
        owners = [tag for tag, part in spot.parts.items() if name in keys_of(part)]
        if len(owners) == 1:
            return owners[0]
    return ""


def _replaced(data: Mapping[str, Any], path: Path, value: Any) -> dict[str, Any]:
    step, *rest = path
    return {**data, str(step): _replaced(data[str(step)], tuple(rest), value) if rest else value}


def dotted(path: Path) -> str:
    """The key path as people write it, ``tank.coefficients.0.mu``."""
    return ".".join(str(step) for step in path)


def _without_echoes(findings: list[Finding]) -> list[Finding]:
    """Leave out a missing key where an unknown one beside it was guessed to be that key."""
    guessed = {finding.guess for finding in findings if finding.guess}
    return [finding for finding in findings if finding.given != "nothing" or finding.path not in guessed]


def _translated(model: type[Root], data: Mapping[str, Any], entries: Iterable[Any]) -> Iterator[Finding]:
    """Pydantic's errors in the words of this program."""
    guessed: set[str] = set()
    for entry in entries:
        path, kind, context = data_path(model, data, entry["loc"]), entry["type"], entry.get("ctx", {})
        if kind == "rules":
            yield from context["findings"]
        elif kind == "refused":
            yield Finding(path, context["rule"], context["given"], context["fix"])
        elif kind == "missing":
            parent = part_at(model, data, path[:-1])
            yield Finding(path, "is required", "nothing", _how_to_write(str(path[-1]), parent))
        elif kind == "extra_forbidden":
            guessed.add(str(path[-1]))
            yield _UnknownKey(model, data, path).finding(guessing=len(guessed) <= MOST_GUESSES)
        else:
            yield _wrong_form(path, entry["input"], spot_at(model, data, path))


def _wrong_form(path: Path, given: Any, spot: Spot | None) -> Finding:
    """A word where there should be a mapping, a mapping for a list, a union without its tag."""
    if spot is not None and spot.key:
        return _wrong_branch(path, given, spot)
    chosen = spot.chosen(given) if spot else None
    if chosen is not None and chosen.part is not None:
        rule = f"must be a mapping with the keys {_listed(keys_of(chosen.part))}"
        item = isinstance(path[-1], int)
        fix = f"write the item as `{_sketch(chosen.part)}`" if item else f"write these keys under `{path[-1]}:`"
        return Finding(path, rule, plain(given), fix)
    if chosen is not None and chosen.items is not None:
        part = chosen.items.part
        return Finding(
            path, "must be a list", plain(given), f"write each item as `- {_sketch(part) if part else '...'}`"
        )
    return Finding(path, "must have another form", plain(given), "see `slosh schema` for the form")


def _wrong_branch(path: Path, given: Any, spot: Spot) -> Finding:
    tags, key = tuple(spot.parts), spot.key
    if not isinstance(given, dict):
        fix = f"write the {path[-1]}'s keys under it, each on its own line, such as `{key}: {tags[0]}`"
        return Finding(path, "must be a mapping", plain(given), fix)
    if key not in given:
        return Finding((*path, key), "is required", "nothing", f"write {one_of([f'{key}: {tag}' for tag in tags])}")
    refused = not_an_option(given[key], tags)
    return Finding((*path, key), refused.rule, refused.given, refused.fix)


def _sketch(part: type[Part] | None) -> str:
    """The keys that a mapping must have, as it is written on one line."""
    if part is None:
        return "..."
    needed = [name for name, field in part.model_fields.items() if field.is_required()]
    return f"{{{', '.join(f'{name}: ...' for name in needed)}}}"


def _listed(names: Iterable[str]) -> str:
    names = list(names)
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


class _UnknownKey:
    """A key that is not in the schema, with a guess: another place for it, a similar key, another branch of a union."""

    def __init__(self, model: type[Root], data: Mapping[str, Any], path: Path) -> None:
        self.model, self.data, self.path = model, data, path
        self.name = str(path[-1])
        self.above = path[:-1]
        self.part = part_at(model, data, self.above)
        self.fields = keys_of(self.part) if self.part else ()

    def finding(self, *, guessing: bool) -> Finding:
        both = next((alias for alias in aliases_of(self.part) if alias.key == self.name), None)
        if both is not None:
            return Finding(self.path, f"must not be given beside `{both.field}`", "both", "keep one of them")
        rule, given = self._rule_and_given()
        if not guessing or len(self.name) > LONGEST_GUESSED:
            return Finding(self.path, rule, given, "take it out")
        fix, meant = self._fix_and_meant()
        return Finding(self.path, rule, given, fix, self._field(meant))

    def _field(self, path: Path) -> Path:
        """The path of the field that a key stands for."""
        return (*path[:-1], field_of(part_at(self.model, self.data, path[:-1]), str(path[-1]))) if path else ()

    def _rule_and_given(self) -> tuple[str, str]:
        given = plain(self.name)
        if not self.above:
            return "is not a key of a scenario", given
        spot = spot_at(self.model, self.data, self.above)
        if spot is None or not spot.parts:
            return f"is not a key of `{dotted(self.above)}`", given
        tag = value_at(self.data, (*self.above, spot.key))
        owners = [tag for tag, part in spot.parts.items() if self.name in keys_of(part)]
        if owners:
            given += f", which belongs to {spot.key} {' or '.join(owners)}"
        return f"is not a key of a {self.above[-1]} of {spot.key} {tag}", given

    def _fix_and_meant(self) -> tuple[str, Path]:
        """What to write, and the path of the key that was probably meant, where one was."""
        parent = value_at(self.data, self.above)
        known = parent if isinstance(parent, dict) else {}
        absent = {key.lower(): key for key in self.fields if not is_written(self.part, key, known)}
        near = _similar(self.name, tuple(absent))
        depth = len(self.above)
        places = sorted(places_of(self.model, self.name), key=lambda place: place[:depth] != self.above)
        elsewhere = [place for place in places if value_at(self.data, place) is None]
        if elsewhere:
            return f"move it to `{dotted(elsewhere[0])}`", elsewhere[0]
        if near:
            return f"write `{absent[near[0]]}`", (*self.above, absent[near[0]])
        taken = _similar(self.name, self.fields)
        if taken:
            return f"write `{taken[0]}`, which is there already, or take it out", ()
        if places:
            return f"take it out, or did you mean `{dotted(places[0])}`?", ()
        return f"take it out; the keys here are {_listed(self.fields)}", ()


@lru_cache(maxsize=2 * MOST_GUESSES)
def _similar(name: str, keys: tuple[str, ...]) -> list[str]:
    """At most one of `keys`; short names may differ in half of their letters."""
    return difflib.get_close_matches(name.lower().replace("-", "_"), keys, 1, 0.5 if len(name) < 4 else 0.6)


def _how_to_write(name: str, parent: type[Part] | None) -> str:
    if parent is None or name not in parent.model_fields:
        return f"write `{name}: ...`"
    field = parent.model_fields[name]
    leaf, spot = leaf_of(field), spot_of(parent, name)
    second = next((f" or `{alias.key}: {alias.example}`" for alias in aliases_of(parent) if alias.field == name), "")
    if leaf is not None:
        such_as = "" if isinstance(leaf, Version) else "it, such as "
        return f"write {such_as}`{name}: {_example(leaf)}`{second}"
    if field.examples:
        return f"write it, such as {one_of([f'{name}: {example}' for example in field.examples])}"
    if spot.parts:
        shared = [key for key in spot.shared if key != spot.key]
        first = next(iter(spot.parts.values()))
        needed = [key for key in shared if first.model_fields[key].is_required()]
        return f"write `{name}:` with the keys {spot.key}, {_listed(needed)} and those of its {spot.key} under it"
    if spot.items is not None:
        return f"write `{name}:` with items such as `- {_sketch(spot.items.part)}` under it"
    return f"write `{name}:` with the keys {_listed(keys_of(spot.part)) if spot.part else '...'} under it"


def _example(leaf: Leaf) -> str:
    match leaf:
        case Quantity() | Number():
            return leaf.example
        case Choice():
            return leaf.options[-1]
        case Count():
            return str(leaf.low)
        case Version():
            return str(leaf.supported)
        case Text():
            return "stop-1"
        case _:
            return EXAMPLE


def _valid_values(model: type[Part], data: Any, prefix: str = "") -> Values:
    """What is valid in data that as a whole is not; keys with an invalid value are left out."""
    values: dict[str, Any] = {}
    explicit: set[str] = set()
    data = with_fields(model, data)
    for name, field in model.model_fields.items():
        key = prefix + name
        if name in data:
            explicit.add(key)
            found = _valid_value(model, name, data[name], key)
        elif field.is_required():
            continue
        else:
            found = _value(field.get_default(), key)
        values.update(found.values)
        explicit |= found.explicit
    return Values(values, frozenset(explicit))


def _value(value: Any, key: str) -> Values:
    """A valid value, of a part all that is in it."""
    return values_of(value, f"{key}.") if isinstance(value, Part) else Values({key: value}, frozenset())


def _valid_value(model: type[Part], name: str, value: Any, key: str) -> Values:
    field = model.model_fields[name]
    leaf, chosen = leaf_of(field), spot_of(model, name).chosen(value)
    part = chosen.part if chosen else None
    try:
        if leaf is not None:
            return Values({key: leaf.parse(value)}, frozenset())
        if part is not None and isinstance(value, dict):
            return _valid_values(part, value, f"{key}.")
        return _value(_adapter(model, name).validate_python(value, context=FROM_TEXT), key)
    except (ValueRefused, ValidationError):
        return Values({}, frozenset())


@cache
def _adapter(model: type[Part], name: str) -> TypeAdapter[Any]:
    """What validates a single field of a part."""
    field = model.model_fields[name]
    by_key = [Field(discriminator=field.discriminator)] if isinstance(field.discriminator, str) else []
    notes = (*field.metadata, *by_key)
    kind: Any = Annotated[field.annotation, *notes] if notes else field.annotation
    return TypeAdapter(kind)
