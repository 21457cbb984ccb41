"""From plain data to a model, or to the complete list of what is wrong with the data."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cache
from typing import Any, TypeVar

from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.alias import aliases_of, field_of, is_written, keys_of, with_fields
from slosh_cli.scenario.base import Part
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
from slosh_cli.scenario.schema_run import Adhesion
from slosh_cli.scenario.schema_tank import SHAPES, Coefficient, Coefficients, TankBase
from slosh_cli.scenario.split_numbers import rejoined
from slosh_cli.scenario.units import plain

R = TypeVar("R", bound=Root)
Path = tuple[str | int, ...]


def diagnose(model: type[R], data: Mapping[str, Any]) -> tuple[R | None, tuple[Finding, ...]]:
    """The validated model, or None and every finding. Quantities in `data` are texts with a unit."""
    try:
        return model.model_validate(data, context=FROM_TEXT), ()
    except ValidationError as error:
        findings = [finding for entry in error.errors() for finding in _translate(model, data, entry)]
    guessed = _with_guessed_shape(data)
    if guessed is not None:
        findings += diagnose(model, guessed)[1]
    findings = rejoined(findings, lambda path: _value_at(data, path), lambda path: _leaf_at(model, data, path))
    findings += broken_rules(_valid_values(model, data), model.rules)
    return None, tuple(dict.fromkeys(_as_written(model, data, finding) for finding in _without_echoes(findings)))


def _as_written(model: type[Root], data: Mapping[str, Any], finding: Finding) -> Finding:
    """A finding about a field at the key that the field was written under."""
    above = finding.path[:-1]
    given = _value_at(data, above)
    for alias in aliases_of(part_at(model, data, above)) if isinstance(given, dict) else ():
        if finding.path[-1] == alias.field and alias.field not in given and alias.key in given:
            return replace(finding, path=(*above, alias.key))
    return finding


def _with_guessed_shape(data: Mapping[str, Any]) -> dict[str, Any] | None:
    """The data with the shape of tank that was probably meant, so that the other keys can be judged."""
    tank = data.get("tank")
    if not isinstance(tank, dict) or (isinstance(tank.get("shape"), str) and tank["shape"] in SHAPES):
        return None
    shape = guess(tank.get("shape", ""), tuple(SHAPES)).strip("`")
    if not shape:
        telling = {"radius": "horizontal-cylinder", "diameter": "horizontal-cylinder", "points": "polygon"}
        shape = next((telling[key] for key in telling if key in tank), "")
    return {**data, "tank": {**tank, "shape": shape}} if shape else None


def dotted(path: Path) -> str:
    """The key path as people write it, ``tank.coefficients.0.mu``."""
    return ".".join(str(step) for step in path)


def _without_echoes(findings: list[Finding]) -> list[Finding]:
    """Leave out a missing key where an unknown one beside it was guessed to be that key."""
    guessed = {finding.guess for finding in findings if finding.guess}
    return [finding for finding in findings if finding.given != "nothing" or finding.path not in guessed]


def _translate(model: type[Root], data: Mapping[str, Any], entry: Any) -> Iterator[Finding]:
    """One error of pydantic in the words of this program."""
    path, kind, context = _data_path(entry["loc"]), entry["type"], entry.get("ctx", {})
    if kind == "rules":
        yield from context["findings"]
    elif kind == "refused":
        yield Finding(path, context["rule"], context["given"], context["fix"])
    elif kind == "missing":
        parent = part_at(model, data, path[:-1])
        yield Finding(path, "is required", "nothing", _how_to_write(str(path[-1]), parent))
    elif kind == "extra_forbidden":
        yield _unknown_key(model, data, path)
    elif kind in ("union_tag_invalid", "union_tag_not_found") or path == ("tank",):
        yield _wrong_shape_of_tank(path, entry["input"])
    else:
        yield _not_a_mapping(path, entry["input"], part_at(model, data, path))


def _data_path(location: tuple[str | int, ...]) -> Path:
    """Pydantic's location without the names of union branches, which are no keys of the file."""
    path = list(location)
    if len(path) > 1 and path[0] == "tank":
        del path[1]
    if len(path) > 2 and path[:2] == ["tank", "coefficients"] and path[2] in ("given", "computed"):
        del path[2]
    return tuple(path)


def _wrong_shape_of_tank(path: Path, given: Any) -> Finding:
    if not isinstance(given, dict):
        fix = "write the tank's keys under it, each on its own line, such as `shape: horizontal-cylinder`"
        return Finding(path, "must be a mapping", plain(given), fix)
    if "shape" not in given:
        listed = one_of([f"shape: {shape}" for shape in SHAPES])
        return Finding((*path, "shape"), "is required", "nothing", f"write {listed}")
    refused = not_an_option(given["shape"], tuple(SHAPES))
    return Finding((*path, "shape"), refused.rule, refused.given, refused.fix)


def _not_a_mapping(path: Path, given: Any, part: type[Part] | None) -> Finding:
    if part is None:
        return Finding(path, "must have another form", plain(given), "see `slosh schema` for the form")
    keys = _listed(keys_of(part))
    return Finding(
        path, f"must be a mapping with the keys {keys}", plain(given), f"write these keys under `{path[-1]}:`"
    )


def _listed(names: Any) -> str:
    names = list(names)
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _unknown_key(model: type[Root], data: Mapping[str, Any], path: Path) -> Finding:
    """A key that is not in the schema, with a guess: another place for it, a similar key, another shape."""
    part, name = part_at(model, data, path[:-1]), str(path[-1])
    fields = keys_of(part) if part else ()
    both = next((alias for alias in aliases_of(part) if alias.key == name), None)
    if both is not None:
        return Finding(path, f"must not be given beside `{both.field}`", "both", "keep one of them")
    rule = f"is not a key of `{dotted(path[:-1])}`" if len(path) > 1 else "is not a key of a scenario"
    owners = [shape for shape, tank in SHAPES.items() if name in keys_of(tank)]
    given, fix = f"`{name}`", f"take it out; the keys here are {_listed(fields)}"
    if part is not None and part in SHAPES.values():
        rule = f"is not a key of a tank of shape {_shape_of(part)}"
        given += f", which belongs to shape {' or '.join(owners)}" if owners else ""
    parent = _value_at(data, path[:-1])
    absent = {key.lower(): key for key in fields if not isinstance(parent, dict) or not is_written(part, key, parent)}
    near = _similar(name, absent)
    places = sorted(_places_of(model, name), key=lambda place: place[: len(path) - 1] != path[:-1])
    elsewhere = [place for place in places if _value_at(data, place) is None]
    if elsewhere:
        return Finding(path, rule, given, f"move it to `{dotted(elsewhere[0])}`", _field(model, data, elsewhere[0]))
    if near:
        guessed = (*path[:-1], absent[near[0]])
        return Finding(path, rule, given, f"write `{absent[near[0]]}`", _field(model, data, guessed))
    taken = _similar(name, fields)
    if taken:
        fix = f"write `{taken[0]}`, which is there already, or take it out"
    elif places:
        fix = f"take it out, or did you mean `{dotted(places[0])}`?"
    return Finding(path, rule, given, fix)


def _field(model: type[Root], data: Mapping[str, Any], path: Path) -> Path:
    """The path of the field that a key stands for."""
    return (*path[:-1], field_of(part_at(model, data, path[:-1]), str(path[-1])))


def _similar(name: str, keys: Iterable[str]) -> list[str]:
    """At most one of `keys`; short names may differ in half of their letters."""
    return difflib.get_close_matches(name.lower().replace("-", "_"), keys, 1, 0.5 if len(name) < 4 else 0.6)


def _shape_of(part: type[BaseModel]) -> str:
    return next(shape for shape, tank in SHAPES.items() if tank is part)


def _value_at(data: Any, path: Path) -> Any:
    for step in path:
        try:
            data = data[step]
        except (KeyError, IndexError, TypeError):
            return None
    return data


def part_of(field: FieldInfo, value: Any = None) -> type[Part] | None:
    """The class of a field that holds a mapping; for the tank it depends on the shape in `value`."""
    annotation = field.annotation
    if isinstance(annotation, type) and issubclass(annotation, Part):
        return annotation
    if field.discriminator == "shape":
        shape = value.get("shape") if isinstance(value, dict) else None
        return SHAPES.get(shape) if isinstance(shape, str) else None
    return None


def part_at(model: type[Part], data: Any, path: Path) -> type[Part] | None:
    """The class of the mapping at `path`, None where the schema has no mapping there."""
    part: type[Part] | None = model
    for step in path:
        data = _value_at(data, (step,))
        if isinstance(step, int):
            part = Coefficient
            continue
        if part is None or step not in part.model_fields:
            return None
        field = part.model_fields[step]
        part = part_of(field, data)
        if part is None and step == "coefficients":
            part = Coefficient
    return part


def _places_of(model: type[Part], name: str, prefix: Path = ()) -> Iterator[Path]:
    """Paths at which the schema knows `name`, single values only, dimensions of the tank left out."""
    if prefix and name in keys_of(model) and (name not in model.model_fields or not part_of(model.model_fields[name])):
        yield (*prefix, name)
    for key, field in model.model_fields.items():
        part = part_of(field) or (TankBase if key == "tank" else None)
        if part is not None:
            yield from _places_of(part, name, (*prefix, key))


def _leaf_at(model: type[Part], data: Any, path: Path) -> Leaf | None:
    """The leaf of the field at `path`, None where there is none."""
    part = part_at(model, data, path[:-1])
    return leaf_of(part.model_fields[str(path[-1])]) if part and path[-1] in part.model_fields else None


@cache
def leaves_of(model: type[Part]) -> tuple[tuple[str, Leaf | None], ...]:
    """Name and leaf of every field of a part; see `leaf_of`."""
    return tuple((name, leaf_of(field)) for name, field in model.model_fields.items())


def leaf_of(field: FieldInfo) -> Leaf | None:
    """The leaf in a field's annotation, None for mappings and lists of mappings."""
    return next((entry for entry in field.metadata if isinstance(entry, Leaf)), None)


def _how_to_write(name: str, parent: type[Part] | None) -> str:
    if parent is None or name not in parent.model_fields:
        return f"write `{name}: ...`"
    field = parent.model_fields[name]
    leaf, part = leaf_of(field), part_of(field)
    second = next((f" or `{alias.key}: {alias.example}`" for alias in aliases_of(parent) if alias.field == name), "")
    if isinstance(leaf, Version):
        return f"write `{name}: {leaf.supported}`"
    if leaf is not None:
        return f"write it, such as `{name}: {_example(leaf)}`{second}"
    if name == "adhesion":
        return "write `adhesion: dry`, `adhesion: wet` or a coefficient of friction, such as `adhesion: 0.15`"
    keys = _listed(keys_of(part)) if part else "shape, its dimensions, length, fill, bottom_height and liquid"
    return f"write `{name}:` with the keys {keys} under it"


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
            found = _valid_value(field, data[name], key)
        elif field.is_required():
            continue
        else:
            default = field.get_default()
            found = values_of(default, f"{key}.") if isinstance(default, Part) else Values({key: default}, frozenset())
        values.update(found.values)
        explicit |= found.explicit
    return Values(values, frozenset(explicit))


def _valid_value(field: FieldInfo, value: Any, key: str) -> Values:
    nothing: frozenset[str] = frozenset()
    leaf, part = leaf_of(field), part_of(field, value)
    try:
        if leaf is not None:
            return Values({key: leaf.parse(value)}, nothing)
        if key.endswith(".coefficients"):
            return Values({key: _COEFFICIENTS.validate_python(value, context=FROM_TEXT)}, nothing)
    except (ValueRefused, ValidationError):
        return Values({}, nothing)
    if key.endswith(".shape"):
        return Values({key: value}, nothing)
    if isinstance(value, Adhesion) or part is None or not isinstance(value, dict):
        return Values({}, nothing)
    return _valid_values(part, value, f"{key}.")


_COEFFICIENTS: TypeAdapter[Any] = TypeAdapter(Coefficients)
