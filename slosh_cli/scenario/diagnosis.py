"""From plain data to a model, or to the complete list of what is wrong with the data."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, Final, TypeVar

from pydantic import ValidationError

from slosh_cli.scenario.base import Part, Path
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.split_numbers import rejoined
from slosh_cli.scenario.tree import Spot, spot_of, value_at
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.unknown_key import UnknownKey
from slosh_cli.scenario.words import Choice, all_of, one_of

_P = TypeVar("_P", bound=Part)

_MOST_GUESSES: Final = 200
"""Different unknown keys that are guessed at; the others are only named, because a guess takes its time."""


def diagnose(model: type[_P], data: Mapping[str, Any], written: Any = None) -> tuple[_P | None, tuple[Finding, ...]]:
    """The validated model, or None and every finding. Quantities in `data` are texts with a unit.

    `written` is the data without usual values: keys that only those have may have been meant by an unknown one.
    """
    try:
        return model.from_text(data), ()
    except ValidationError as error:
        entries = error.errors(include_url=False)
    findings = list(_translated(Spot(part=model), data, entries, data if written is None else written))
    findings = findings or [_wrong_form(entry["loc"], entry["input"], None) for entry in entries]
    guessed = _with_guessed_tags(model, data)
    if guessed is not None:
        findings += diagnose(model, guessed)[1]
    findings = rejoined(findings, lambda path: value_at(data, path), lambda path: _spot_at(model, data, path).leaf)
    values = Values()
    values.add_valid(model, data)
    findings += values.broken()
    return None, tuple(dict.fromkeys(_as_written(model, data, finding) for finding in _without_echoes(findings)))


def _spot_at(model: type[Part], data: Any, path: Path) -> Spot:
    return Spot(part=model).at(data, path) or Spot()


def _as_written(model: type[Part], data: Mapping[str, Any], finding: Finding) -> Finding:
    """A finding about a field at the key that the field was written under."""
    above = finding.path[:-1]
    given, part = value_at(data, above), Spot(part=model).part_at(data, above)
    for alias in part.aliases if part and isinstance(given, dict) else ():
        if finding.path[-1] == alias.field and alias.field not in given and alias.key in given:
            return replace(finding, path=(*above, alias.key))
    return finding


def _with_guessed_tags(model: type[Part], data: Mapping[str, Any]) -> Any:
    """The data with the branches of unions that were probably meant, so that the other keys can be judged.

    None where no branch is to be guessed.
    """
    guessed: Any = None
    for path, spot, value in list(Spot(part=model).inner(data)):
        if not spot.parts or not isinstance(value, dict) or spot.chosen(value) is not None:
            continue
        tag = Choice(tuple(spot.parts)).guess(value.get(spot.key)) or _telling_tag(spot, value)
        if tag:
            guessed = _replaced(guessed or data, path, {**value, spot.key: tag})
    return guessed


def _telling_tag(spot: Spot, value: Mapping[str, Any]) -> str:
    """The one branch of a union that knows a key of `value` which no other has."""
    for name in value:
        owners = [tag for tag, part in spot.parts.items() if name in part.every_key()]
        if len(owners) == 1:
            return owners[0]
    return ""


def _replaced(data: Any, path: Path, value: Any) -> Any:
    """A copy of the data with another value at a path that is there."""
    if not path:
        return value
    step = path[0]
    if isinstance(step, int):
        return [*data[:step], _replaced(data[step], path[1:], value), *data[step + 1 :]]
    return {**data, step: _replaced(data[step], path[1:], value)}


def _without_echoes(findings: list[Finding]) -> list[Finding]:
    """Leave out a missing key where an unknown one beside it was guessed to be that key."""
    guessed = {finding.guess for finding in findings if finding.guess}

    def is_echo(finding: Finding) -> bool:
        missing = finding.missing or ((finding.path,) if finding.given == "nothing" else ())
        return not guessed.isdisjoint(missing)

    return [finding for finding in findings if not is_echo(finding)]


def _translated(root: Spot, data: Mapping[str, Any], entries: Iterable[Any], written: Any) -> Iterator[Finding]:
    """Pydantic's errors in the words of this program."""
    guessed: set[str] = set()
    for entry in entries:
        kind, context = entry["type"], entry.get("ctx", {})
        path = root.data_path(data, entry["loc"], kind)
        if path is None:
            continue
        spot = root.at(data, path) or Spot()
        if spot.branches and not spot.pick and spot.chosen(value_at(data, path)) is None:
            yield _wrong_form(path, value_at(data, path), spot)
        elif kind == "rules":
            yield from context["findings"]
        elif kind == "refused":
            yield Finding(path, context["rule"], context["given"], context["fix"])
        elif kind == "missing":
            yield Finding(path, "is required", "nothing", _how_to_write(str(path[-1]), root.part_at(data, path[:-1])))
        elif kind == "extra_forbidden":
            guessed.add(str(path[-1]))
            yield UnknownKey(root, written, path).finding(guessing=len(guessed) <= _MOST_GUESSES)
        elif kind == "too_short":
            yield from _too_short(path, len(entry["input"]), context["min_length"], spot)
        else:
            yield _wrong_form(path, entry["input"], spot)


def _too_short(path: Path, given: int, least: int, spot: Spot) -> Iterator[Finding]:
    """A list or mapping with too little in it; pydantic leaves out of its count what is wrong in itself."""
    if given < least:
        what = f"at least {least} {'entry' if least == 1 else 'entries'}"
        fix = f"write each as `- {_sketch(spot.items)}`" if spot.items else "write them under it"
        yield Finding(path, f"must have {what}", "none" if not given else str(given), fix)


def _wrong_form(path: Path, given: Any, spot: Spot | None) -> Finding:
    """A word where there should be a mapping, a mapping for a list, a union without its tag."""
    if spot is not None and spot.key:
        return _wrong_branch(path, given, spot)
    chosen = spot.chosen(given) if spot else None
    if chosen is not None and chosen.part is not None:
        rule = f"must be a mapping with the keys {all_of(chosen.part.every_key())}"
        item = isinstance(path[-1], int)
        fix = f"write the item as `{_sketch(chosen)}`" if item else f"write these keys under `{path[-1]}:`"
        return Finding(path, rule, plain(given), fix)
    if chosen is not None and chosen.items is not None:
        return Finding(path, "must be a list", plain(given), f"write each item as `- {_sketch(chosen.items)}`")
    if chosen is not None and chosen.entries is not None:
        fix = f"write keys with their values under `{path[-1]}:`"
        return Finding(path, "must be a mapping of keys to values", plain(given), fix)
    if spot is not None and spot.branches:
        forms = [_form(branch) for branch in spot.branches.values()]
        fix = f"write {one_of([_sketch(branch) for branch in spot.branches.values()])}"
        return Finding(path, f"must be {', '.join(forms[:-1])} or {forms[-1]}", plain(given), fix)
    return Finding(path, "must have another form", plain(given), "see `slosh schema` for the form")


def _wrong_branch(path: Path, given: Any, spot: Spot) -> Finding:
    tags, key = tuple(spot.parts), spot.key
    if not isinstance(given, dict):
        fix = f"write the {path[-1]}'s keys under it, each on its own line, such as `{key}: {tags[0]}`"
        fix = f"write the item as `{_sketch(spot)}`" if isinstance(path[-1], int) else fix
        return Finding(path, "must be a mapping", plain(given), fix)
    if key not in given:
        return Finding((*path, key), "is required", "nothing", f"write {one_of([f'{key}: {tag}' for tag in tags])}")
    refused = Choice(tags).refusal(given[key])
    return Finding((*path, key), refused.rule, refused.given, refused.fix)


def _form(spot: Spot) -> str:
    """What a value is, in words."""
    if spot.items is not None:
        return "a list"
    if spot.part is not None:
        return f"a mapping with the keys {all_of(spot.part.every_key())}"
    return "a mapping" if spot.parts or spot.entries else "a single value"


def _sketch(spot: Spot) -> str:
    """A value as it is written on one line, of a mapping the keys that it must have."""
    if spot.leaf is not None:
        return spot.leaf.sample()
    if spot.items is not None:
        return f"[{_sketch(spot.items)}]"
    part = next(iter(spot.parts.values()), spot.part)
    return part.sketch(samples=False) if part else "..."


def _how_to_write(name: str, parent: type[Part] | None) -> str:
    if parent is None or name not in parent.model_fields:
        return f"write `{name}: ...`"
    spot = spot_of(parent, name)
    second = next((f" or `{alias.key}: {alias.example}`" for alias in parent.aliases if alias.field == name), "")
    if spot.leaf is not None:
        return spot.leaf.advice(name) + second
    if spot.short is not None:
        return f"write it, such as {one_of([f'{name}: {example}' for example in spot.short.samples()])}"
    if spot.parts:
        shared = [key for key in spot.shared if key != spot.key]
        first = next(iter(spot.parts.values()))
        needed = [key for key in shared if first.model_fields[key].is_required()]
        known = [spot.key, *([all_of(needed)] if needed else [])]
        return f"write `{name}:` with the keys {', '.join(known)} and those of its {spot.key} under it"
    if spot.items is not None:
        return f"write `{name}:` with items such as `- {_sketch(spot.items)}` under it"
    return f"write `{name}:` with the keys {all_of(spot.part.every_key()) if spot.part else '...'} under it"
