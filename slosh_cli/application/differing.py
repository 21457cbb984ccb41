"""What differs between runs: one answer of all of them, and the inputs that are not the same."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any, Final

from slosh_cli.application.runs import AnyRun, trains_of
from slosh_cli.results.result import Result
from slosh_cli.results.stored import History
from slosh_cli.results.train_result import TrainHistory
from slosh_cli.scenario.yaml_text import parse

_NO_INPUT: Final = ("name", "description")
_OF_VEHICLES: Final = ("format", "vehicles", "track", "contact", "solver", "output", "presets", *_NO_INPUT)
"""Parts of a train's own file that its vehicles have, or that are no input."""
_OF_TRAIN: Final = ("presets", "braking.initial_speed", "braking.onset", "braking.stop_speed", *_NO_INPUT)
"""Keys of a vehicle that the train says for all, or that are no input."""


@dataclass(frozen=True)
class Difference:
    """One answer of every run; `name` carries its SI unit where it has one, None stands where a run has no such number.

    unit: as shown, counted in `per` SI units. Of an answer per wheel it is the least or the largest of the wheels.
    Of a place, such as the number of a coupling, no change in per cent is told.
    """

    name: str
    meaning: str
    unit: str
    per: float
    values: tuple[float | None, ...]

    @property
    def label(self) -> str:
        """What people call it: its name without the unit, and whether it is of one wheel."""
        return labelled(self.name, self.meaning)

    def change(self, place: int) -> float | None:
        """Run `place` minus the first run; None where one of both has no number."""
        first, other = self.values[0], self.values[place]
        return None if first is None or other is None else other - first

    def percent(self, place: int) -> float | None:
        """The change in per cent of the first run; None where that is zero, too."""
        change, first = self.change(place), self.values[0]
        return None if change is None or not first or self.name.endswith("_at") else 100.0 * change / abs(first)

    def as_dict(self) -> dict[str, Any]:
        """The answer as JSON has it, in SI units."""
        others = range(1, len(self.values))
        told = {"name": self.name, "meaning": self.meaning, "values": list(self.values)}
        return told | {
            name: [of(k) for k in others] for name, of in (("change", self.change), ("percent", self.percent))
        }


def labelled(name: str, meaning: str) -> str:
    """What people call an answer: its name without the unit, and what it means."""
    for ending in ("_m_s", "_N_m", "_N", "_m", "_s", "_J", "_kg"):
        if name.endswith(ending):
            name = name.removesuffix(ending)
            break
    return f"{name.replace('_', ' ')} ({meaning})"


def differing_inputs(runs: Sequence[AnyRun]) -> dict[str, list[Any]]:
    """Key path -> its value in every run, with its unit as the scenario has it, where these differ.

    None stands where a run has no such key. Name and description do not count. Of trains the keys of vehicles begin
    with their places from the front.
    """
    trains = trains_of(runs)
    if trains is not None:
        return _of_trains(trains)
    found = [_leaves_of(_text(run)) for run in runs]
    return {key: values for key, values in _differing(found) if key not in _NO_INPUT}


def _of_trains(trains: Sequence[TrainHistory]) -> dict[str, list[Any]]:
    files = [_leaves_of(train.scenario_text.split("---\n", 1)[0]) for train in trains]
    told = {key: values for key, values in _differing(files) if not _is_below(key, _OF_VEHICLES)}
    counts: list[Any] = [len(train.vehicles) for train in trains]
    told |= {"vehicles": counts} if len(set(counts)) > 1 else {}
    places: dict[tuple[str, str], tuple[list[int], list[Any]]] = {}
    for place in range(min(counts)):
        each = [_leaves_of(_without_onset(train.vehicles[place].facts["scenario"])) for train in trains]
        for key, values in _differing(each):
            if not _is_below(key, _OF_TRAIN):
                places.setdefault((key, str(values)), ([], values))[0].append(place + 1)
    whole = len(set(counts)) == 1
    for (key, _), (found, values) in places.items():
        told[f"{'all' if whole and len(found) == counts[0] else f'vehicles.{listed(found)}'}.{key}"] = values
    return told


def listed(places: Sequence[int]) -> str:
    """Rising places as `2-21` and `1,5,7`."""
    begins = [places[0], *(after for before, after in pairwise(places) if after > before + 1)]
    ends = [*(before for before, after in pairwise(places) if after > before + 1), places[-1]]
    return ",".join(str(a) if a == b else f"{a}-{b}" for a, b in zip(begins, ends, strict=True))


def _differing(found: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, list[Any]]]:
    for key in dict.fromkeys(key for one in found for key in one):
        values = [one.get(key) for one in found]
        if any(value != values[0] for value in values):
            yield key, values


def _is_below(key: str, parts: Sequence[str]) -> bool:
    return any(key == part or key.startswith(f"{part}.") for part in parts)


def _text(run: AnyRun) -> str:
    from slosh_cli.results.hdf5 import scenario_text

    held = run.scenario_text if isinstance(run, History) else ""
    return scenario_text(run.scenario) if isinstance(run, Result) else held


def _without_onset(text: str) -> str:
    """The text of a vehicle without what tells it from others alike, so that it is read once."""
    return re.sub(r"^  onset: .*\n", "", text, flags=re.MULTILINE)


@lru_cache(maxsize=256)
def _leaves_of(text: str) -> dict[str, Any]:
    return dict(_leaves(parse(text, "the scenario of the run").data))


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping) and value:
        for key, inner in value.items():
            yield from _leaves(inner, f"{path}.{key}" if path else str(key))
    else:
        yield path, value
