"""How sure each value of a scenario is: of the file itself, a default, of a preset with its source, or computed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any, Final, Literal, get_args, get_origin

from pydantic import ValidationError

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Part, Path
from slosh_cli.scenario.loader import Root
from slosh_cli.scenario.plain_data import plain_data
from slosh_cli.scenario.presets import DEFAULT, TAKEN, Standing, find_preset
from slosh_cli.scenario.schema import Scenario, TankScenario
from slosh_cli.scenario.schema_train import TrainFile
from slosh_cli.scenario.tree import Spot, value_at
from slosh_cli.scenario.units import shown
from slosh_cli.scenario.yaml_text import parse

YOURS: Final = "yours"
"""The standing of a value that the file itself says."""
_COMPUTED: Final = "computed"
_ORDER: Final = (YOURS, "measured", "published", "assumed", DEFAULT, _COMPUTED)
_NO_INPUT: Final = ("format", "name", "description", TAKEN)
_ABSENT: Final = object()


def standings(scenario: Root | str) -> dict[str, Standing]:
    """Key path -> value as text, standing and source, for a scenario or the text of a resolved one.

    The standing is one of `yours`, `default`, `computed` and those of presets: measured, published, assumed. A value is
    a default where it is the program's own, also where the file says the same; it is of a preset where the preset still
    has that value. Items of lists are counted from 1.
    """
    data = parse(scenario, "the scenario").data if isinstance(scenario, str) else plain_data(scenario, as_text=True)
    model = _model_of(data) if isinstance(scenario, str) else type(scenario)
    inputs = {key: value for key, value in data.items() if key not in _NO_INPUT}
    return dict(_Judge(model, data, dict(data.get(TAKEN) or {})).below(inputs, ()))


def counted_standings(found: Mapping[str, Standing]) -> str:
    """How many of the values have which standing, in a sentence."""
    counts = Counter(one.standing for one in found.values())
    told = [f"{counts[word]} {word}" for word in _ORDER if counts[word]]
    return f"Of {len(found)} values {', '.join(told)}"


def _model_of(data: Mapping[str, Any]) -> type[Root]:
    """What a resolved text describes."""
    if "vehicles" in data:
        return TrainFile
    return Scenario if "wagon" in data else TankScenario


class _Judge:
    """Finds the standing of everything in the plain data of one scenario; `taken` is what came from presets."""

    def __init__(self, model: type[Part], data: Mapping[str, Any], taken: Mapping[str, str]) -> None:
        self.root, self.data, self.taken = Spot(part=model), data, taken

    def below(self, value: Any, path: Path, of_part: tuple[str, str] | None = None) -> Iterator[tuple[str, Standing]]:
        """The values at and below a path; `of_part` is standing and source that a part above has as a whole."""
        whole = of_part or (self._as_a_whole(path) if path else None)
        if isinstance(value, Mapping) and value:
            for key, inner in value.items():
                yield from self.below(inner, (*path, key), whole)
        elif isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
            for place, inner in enumerate(value):
                yield from self.below(inner, (*path, place), whole)
        else:
            yield _dotted(path), Standing(_words(value), *self._judged(value, whole))

    def _judged(self, value: Any, whole: tuple[str, str] | None) -> tuple[str, str]:
        if value in (_COMPUTED, {}):  # a resolved part without values is left to the program
            return _COMPUTED, "by the program, from the other values"
        return whole or (YOURS, "")

    def _as_a_whole(self, path: Path) -> tuple[str, str] | None:
        """Standing and source of what a preset or the program gives at a path; None where neither does."""
        name = self.taken.get(_dotted(path))
        if name is not None:
            return self._of_preset(name, path)
        part = self.root.part_at(self.data, path[:-1])
        if part is None or path[-1] not in part.model_fields:
            return None
        entry, field = part.model_fields[str(path[-1])], str(path[-1])
        is_tag = get_origin(entry.annotation) is Literal and len(get_args(entry.annotation)) == 1
        if entry.is_required() or is_tag or entry.default is None:
            return None
        return (DEFAULT, "the program's own") if self._read(part, field, path) == entry.default else None

    def _of_preset(self, name: str, path: Path) -> tuple[str, str]:
        part = self.root.part_at(self.data, path[:-1])
        try:
            leaves = find_preset(name).leaves.items()
        except ValueRefused:
            return YOURS, f"of the preset {name}, which this version does not know"
        for place, leaf in leaves:
            if part is None or (*place[:-1], part.field_of(str(place[-1]))) != path:
                continue
            field, own = str(path[-1]), part.with_fields({str(place[-1]): leaf.value})
            if part.field_from_text(field, own[field]) == self._read(part, field, path):
                if name == DEFAULT:
                    return DEFAULT, f"{leaf.standing}: {leaf.source}"
                return leaf.standing, f"preset {name}: {leaf.source}"
        return YOURS, f"not what the preset {name} has"

    def _read(self, part: type[Part], field: str, path: Path) -> Any:
        """The value at a path as the model has it."""
        with suppress(ValidationError):
            return part.field_from_text(field, value_at(self.data, path))
        return _ABSENT


def _dotted(path: Path) -> str:
    return ".".join(str(step + 1) if isinstance(step, int) else step for step in path)


def _words(value: Any) -> str:
    """A value as text, numbers to six digits."""
    if isinstance(value, list):
        return f"[{', '.join(_words(item) for item in value)}]" if value else "none"
    if value == {}:
        return _COMPUTED
    number, gap, unit = str(value).partition(" ")
    try:
        return f"{shown(float(number))}{gap}{unit}" if "." in number or "e" in number else str(value)
    except ValueError:
        return str(value)
