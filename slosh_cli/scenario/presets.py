"""Presets: named values with sources for parts of a scenario, taken by `use: NAME` before the schema sees the file.

One of them, `DEFAULT`, is taken by itself: a stop has its values where the file says nothing.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path as FilePath
from typing import Any, Final

from slosh_cli.errors import Problem, ValueRefused
from slosh_cli.scenario.base import OWN, USE, Part, Path
from slosh_cli.scenario.document import Document, Origin
from slosh_cli.scenario.tree import Spot, spot_of, value_at
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.yaml_text import parse

TAKEN: Final = "presets"
"""The key under which a resolved scenario states what came from presets."""
DEFAULT: Final = "default"
"""The preset of what a stop has where its file says nothing."""
_FOLDER: Final = FilePath(__file__).resolve().parent.parent / "presets"


@dataclass(frozen=True)
class Standing:
    """A single `value` of a preset as a file has it, its `standing` (published, measured, assumed) and `source`."""

    value: Any
    standing: str
    source: str


@dataclass(frozen=True)
class Preset:
    """A preset: its `name`, `kind` and `title`; `leaves` by their paths from the root of a scenario.

    Products have a UN number `un` and points of degC and kg/m^3, `density_at`.
    """

    name: str
    kind: str
    title: str
    leaves: Mapping[Path, Standing]
    un: int | None = None
    density_at: tuple[tuple[float, float], ...] = ()

    def below(self, path: Path) -> dict[Path, Any]:
        """The values in the part at `path` by their paths from there."""
        depth = len(path)
        return {key[depth:]: leaf.value for key, leaf in self.leaves.items() if key[:depth] == path != key}

    def density(self, celsius: float) -> float:
        """Density of a product at a temperature, kg/m^3, linear between its points; ValueRefused outside of them."""
        points = self.density_at
        for (cold, dense), (warm, light) in pairwise(points):
            if cold <= celsius <= warm:
                return dense + (light - dense) * (celsius - cold) / (warm - cold)
        low, high = points[0][0], points[-1][0]
        rule = f"must be from {low:g} to {high:g} C, where the density of {self.name} is known"
        raise ValueRefused(rule, f"`{celsius:g} C`", "write another temperature, or give the density in the file")


@cache
def every_preset() -> dict[str, Preset]:
    """All presets of the program by name: wagons, bogies, tracks, products, brakes, and the defaults."""
    files = (f"{kind}.yaml" for kind in ("wagons", "bogies", "tracks", "products", "brakes", "defaults"))
    read = (parse((_FOLDER / file).read_text(encoding="utf-8"), file).data for file in files)
    return {name: _preset(name, data) for file in read for name, data in file.items()}


def find_preset(name: object, kind: str = "") -> Preset:
    """The preset of a name, of a `kind` where one is given; ValueRefused with a guess where there is none."""
    known = [preset.name for preset in every_preset().values() if not kind or preset.kind == kind]
    if str(name) in known:
        return every_preset()[str(name)]
    near = difflib.get_close_matches(str(name), known, 1, 0.5)
    fix = f"did you mean `{near[0]}`?" if near else f"write one of {', '.join(known)}"
    raise ValueRefused(f"must be the name of a {kind or 'preset'}{' preset' if kind else ''}", plain(name), fix)


def is_usual(model: type[Part], name: str) -> bool:
    """Whether the preset `DEFAULT` has all that the part `name` of a root must have, so that it may be left out."""
    part, told = spot_of(model, name).part, {inner[0] for inner in find_preset(DEFAULT).below((name,))}
    return part is not None and all(key in told for key, entry in part.model_fields.items() if entry.is_required())


def expand(document: Document, model: type[Part]) -> None:
    """Put the values of presets in place of every `use` of a document, and of its data before overrides.

    What stands beside `use` holds, key by key. A `use` that an override gives holds against the values of the file and
    not against other overrides. Values keep the line of their `use` as their origin, with the name of the preset.
    What a `model` with usual values is left without it then has of the preset `DEFAULT`; `written` stays without.
    """
    if document.original is not None:
        original = Document(document.original, origins={(): Origin()})
        _expand(original, model)
        _fill(original, model)
    taken = _expand(document, model)
    taken |= _fill(document, model)
    if not isinstance(document.data, dict) or not (taken or TAKEN in document.data):
        return
    told = document.data.pop(TAKEN, None)
    if told is not None and not isinstance(told, dict):
        document.data[TAKEN] = told
        return
    kept = {key: name for key, name in (told or {}).items() if _still(document, tuple(str(key).split(".")))}
    if kept | taken:
        document.data[TAKEN] = kept | taken


def _preset(name: str, data: Mapping[str, Any]) -> Preset:
    common = {key: str(data[key]) for key in ("standing", "source")}
    leaves = {
        path: Standing(**(common | value)) if isinstance(value, dict) else Standing(value, **common)
        for path, value in _leaves(data["values"], ())
    }
    points = tuple((float(celsius), float(density)) for celsius, density in data.get("density_at", ()))
    return Preset(str(name), data["kind"], data["title"], leaves, data.get("un"), points)


def _leaves(data: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    if isinstance(data, dict) and "value" not in data:
        for key, value in data.items():
            yield from _leaves(value, (*path, key))
    else:
        yield path, data


def _uses(data: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of the mappings with a `use`, the inner ones first: they are nearer to the value."""
    if not isinstance(data, dict):
        return
    for key, value in data.items():
        if not str(key).startswith(OWN):
            yield from _uses(value, (*path, key))
    if path and USE in data:
        yield path


def _expand(document: Document, model: type[Part]) -> dict[str, str]:
    """Expand every `use`; which preset gave the field at each key path."""
    taken: dict[str, str] = {}
    for path in list(_uses(document.data)):
        mapping = value_at(document.data, path)
        origin = document.origin((*path, USE))
        names = mapping.pop(USE)
        document.origins.pop((*path, USE), None)
        for name in reversed(names if isinstance(names, list) and names else [names]):
            try:
                preset = find_preset(name)
                values = preset.below(path)
                if not values:
                    raise _wrong_place(preset, path)
            except ValueRefused as error:
                key = ".".join(map(str, (*path, USE)))
                document.unfilled.append(path)
                document.problems.append(Problem(origin.line, key, error.rule, error.given, error.fix, origin.override))
                continue
            given = Origin(origin.line, origin.override, preset.name)
            taken |= _taken(document, model, {(*path, *inner): value for inner, value in values.items()}, given)
    return taken


def _fill(document: Document, model: type[Part]) -> dict[str, str]:
    """Give a part its usual values where it has none; the key paths of those that are taken.

    A part that has other keys, which nobody can know, has to be there.
    """
    data = document.data
    if not model.has_usual or not isinstance(data, dict):
        return {}
    usual = find_preset(DEFAULT)
    leaves = {
        path: leaf.value for path, leaf in usual.leaves.items() if path[0] in data or is_usual(model, str(path[0]))
    }
    document.written = deepcopy(data)
    return _taken(document, model, leaves, Origin(preset=DEFAULT))


def _taken(document: Document, model: type[Part], values: Mapping[Path, Any], origin: Origin) -> dict[str, str]:
    """Put values of a preset at their places; which of them hold, by the key path of the field."""
    taken: dict[str, str] = {}
    for place, value in values.items():
        if _take(document, model, place, deepcopy(value), origin):
            part = Spot(part=model).part_at(document.data, place[:-1])
            field = part.field_of(str(place[-1])) if part else place[-1]
            taken[".".join(map(str, (*place[:-1], field)))] = origin.preset
    return taken


def _still(document: Document, path: Path) -> bool:
    """Whether the value at a path is what a preset gave: it is there, and no override has changed it."""
    value = document.data
    for step in path:
        if isinstance(value, Part):
            return True  # a part that was kept as it is
        if not isinstance(value, dict) or step not in value:
            return False
        value = value[step]
    return not document.overridden(path)


def _wrong_place(preset: Preset, path: Path) -> ValueRefused:
    where = ".".join(map(str, path)) or "a scenario"
    fitting = [other.name for other in every_preset().values() if other.below(path)]
    fix = f"write one of {', '.join(fitting)}" if fitting else f"take `{USE}` out; no preset has values for this part"
    return ValueRefused(f"must be a preset with values for `{where}`", f"`{preset.name}`, a {preset.kind}", fix)


def _take(document: Document, model: type[Part], place: Path, value: Any, origin: Origin) -> bool:
    """Put one value of a preset at its place, unless what stands there holds against it; whether it was put."""
    holds = document.data
    for depth, step in enumerate(place):
        if not isinstance(holds, dict):
            return False  # the part is told in short, by a word or a value
        spot = Spot(part=model).at(document.data, place[:depth])
        chosen = spot.chosen(holds) if spot else None
        rivals = chosen.part.rivals(str(step)) if chosen and chosen.part else []
        for other in (str(step), *rivals) if depth == len(place) - 1 else rivals:
            there = (*place[:depth], other)
            if other not in holds:
                continue
            if not origin.override or document.overridden(there):
                return False
            document.remove(there)
        if depth == len(place) - 1:
            break
        there = place[: depth + 1]
        told_in_short = isinstance(holds.get(step), str) and origin.override and not document.overridden(there)
        if step not in holds or told_in_short:
            holds[step] = {}
            document.origins[there] = origin
        holds = holds[step]
    holds[place[-1]] = value
    document.origins[place] = origin
    return True
