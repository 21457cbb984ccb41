"""Runs beside each other: how their answers differ, which inputs differ, their histories in one picture."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.errors import UsageError
from slosh_cli.results.answers import Answer, PerWheel, Place, Shown
from slosh_cli.results.files import FileError
from slosh_cli.results.result import Record, Result
from slosh_cli.results.stored import History
from slosh_cli.scenario.yaml_text import parse

if TYPE_CHECKING:
    from slosh_cli.application.keeping import Keeping
    from slosh_cli.scenario import Scenario

_MOST: Final = 6
"""Runs that can be told apart in one picture."""
_FIGURES: Final = ("compare_speed", "compare_wheel_loads", "compare_slosh", "compare_brake")
_OF_THE_SOLVER: Final = frozenset(
    {"steps", "rejected_steps", "solve_seconds", "energy_residual", "mean_total_wheel_load_N"}
)
"""Answers that tell of the computation and not of the stop."""
_BESIDES: Final = frozenset({"fill", "surface_limit_m", "static_wheel_load_N", "weight_N"})
"""Answers that follow from the inputs: told only where they differ."""


@dataclass(frozen=True)
class Difference:
    """One answer of every run; `name` carries its SI unit where it has one, None stands where a run has no such number.

    unit: as shown, counted in `per` SI units. Of an answer per wheel it is the least or the largest of the wheels.
    """

    name: str
    meaning: str
    unit: str
    per: float
    values: tuple[float | None, ...]

    @property
    def label(self) -> str:
        """What people call it: its name without the unit, and whether it is of one wheel."""
        words = self.name
        for ending in ("_m_s", "_N_m", "_N", "_m", "_s"):
            if words.endswith(ending):
                words = words.removesuffix(ending)
                break
        return f"{words.replace('_', ' ')} ({self.meaning})"

    def change(self, place: int) -> float | None:
        """Run `place` minus the first run; None where one of both has no number."""
        first, other = self.values[0], self.values[place]
        return None if first is None or other is None else other - first

    def percent(self, place: int) -> float | None:
        """The change in per cent of the first run; None where that is zero, too."""
        change, first = self.change(place), self.values[0]
        return None if change is None or not first else 100.0 * change / abs(first)

    def as_dict(self) -> dict[str, Any]:
        """The answer as JSON has it, in SI units."""
        others = range(1, len(self.values))
        told = {"name": self.name, "meaning": self.meaning, "values": list(self.values)}
        return told | {
            name: [of(k) for k in others] for name, of in (("change", self.change), ("percent", self.percent))
        }


def differences(runs: Sequence[Record]) -> list[Difference]:
    """Every answer of the stops that is a number, for all of `runs`."""
    found = []
    for one in Result.in_table(Shown.SUMMARY, Place.DISTANCE):
        if one.unit and one.name not in _OF_THE_SOLVER and one.kind is not bool:
            values = tuple(_number(one, getattr(run, one.name, None)) for run in runs)
            alike = one.name in _BESIDES and len(set(values)) == 1
            if any(value is not None for value in values) and not alike:
                found.append(_difference(one, values))
    return found


def _difference(one: Answer, values: tuple[float | None, ...]) -> Difference:
    most = (
        ""
        if one.kind != PerWheel
        else "least of the wheels: "
        if one.name.startswith("min_")
        else "largest of the wheels: "
    )
    told = one.line
    per = told.per if told else 1.0
    unit = {1.0: one.unit, 0.01: "%"}.get(per, f"k{one.unit}")
    return Difference(one.name, most + one.meaning, "" if unit == "1" else unit, per, values)


def _number(one: Answer, value: Any) -> float | None:
    if isinstance(value, tuple):
        value = (min if one.name.startswith("min_") else max)(value, default=None)
    return float(value) if value is not None and math.isfinite(value) else None


def differing_inputs(runs: Sequence[Record]) -> dict[str, list[Any]]:
    """Key path -> its value in every run, with its unit as the scenario has it, where these differ.

    None stands where a run has no such key. Name and description do not count.
    """
    found = [dict(_leaves(parse(_text(run), run.name).data)) for run in runs]
    keys = dict.fromkeys(key for one in found for key in one if key not in ("name", "description"))
    values = {key: [one.get(key) for one in found] for key in keys}
    return {key: told for key, told in values.items() if any(value != told[0] for value in told)}


def _text(run: Record) -> str:
    from slosh_cli.results.hdf5 import scenario_text

    return (
        run.scenario_text
        if isinstance(run, History)
        else scenario_text(run.scenario)
        if isinstance(run, Result)
        else ""
    )


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping) and value:
        for key, inner in value.items():
            yield from _leaves(inner, f"{path}.{key}" if path else str(key))
    else:
        yield path, value


def read_runs(files: Sequence[Path]) -> list[History]:
    """The runs of history files. Raises UsageError and FileError for files that cannot be compared, with what to do."""
    from slosh_cli.results.hdf5 import is_train_history, read_history

    if not 2 <= len(files) <= _MOST:
        raise UsageError(f"two to {_MOST} runs can be compared; given {len(files)}; write `slosh compare A.h5 B.h5`")
    known: dict[Path, Path] = {}
    for file in files:
        if (twice := known.setdefault(file.resolve(), file)) is not file:
            raise UsageError(f"{twice} and {file} are the same file; give another run to compare with", str(file))
    for file in files:
        if is_train_history(file):
            fix = f"draw it with `slosh plot {file}`"
            raise UsageError(f"{file} is the run of a train, and only runs of single wagons can be compared; {fix}")
    runs = []
    for file in files:
        try:
            runs.append(read_history(file))
        except FileError as error:
            fix = "" if file.is_dir() else "; give history files (run.h5) that `slosh run` wrote"
            raise FileError(f"{error.message}{fix}", where=str(file)) from error
    return runs


def keep_comparison(runs: Sequence[Record], names: Sequence[str], folder: Path, keeping: Keeping) -> list[str]:
    """Draw the histories of `runs` over each other into `folder`; returns the files that are there."""
    from slosh_cli.report import FORMATS
    from slosh_cli.report.compare_figures import compare_figure, suits

    def draw(name: str, place: Path) -> None:
        from slosh_cli.report.saving import save, styled

        with styled():
            save(compare_figure(name, runs, names), place, name)

    owned = [f"{name}.{kind}" for name in _FIGURES for kind in FORMATS]
    return keeping.keep(folder, owned, {}, {name: partial(draw, name) for name in _FIGURES if suits(name, runs)})


def solid_twin(scenario: Scenario) -> Scenario:
    """The same stop with the equivalent solid. Raises UsageError where the load is that solid already."""
    if scenario.tank.liquid.model == "rigid":
        fix = "leave --twin out, or set tank.liquid.model to modal"
        raise UsageError(f"--twin compares a liquid with its solid, but the load of {scenario.name} is rigid; {fix}")
    return scenario.with_({"tank.liquid.model": "rigid"})


def liquid_words(liquid: Record, solid: Record) -> list[str]:
    """What the liquid did to the stop, beside its equivalent solid: distance, unloading, lock."""
    return [_distance_words(liquid, solid), _unloading_words(liquid, solid), _lock_words(liquid, solid)]


def _distance_words(liquid: Record, solid: Record) -> str:
    mine, other = liquid.braking_distance_m, solid.braking_distance_m
    if mine is None or other is None:
        ended = " and ".join(
            f"the {name} ended as {run.status}" for name, run in (("liquid", liquid), ("solid", solid))
            if run.braking_distance_m is None
        )  # fmt: skip
        return f"no difference of the distances can be told: {ended}"
    if abs(mine - other) < 5e-3:
        return f"the distance is the same to the centimetre: {mine:.2f} m"
    way = "longer" if mine > other else "shorter"
    percent = 100.0 * abs(mine - other) / other
    by = f"{abs(mine - other):.2f} m ({percent:.2f} %) {way}"
    return f"the liquid makes the stop {by}: {mine:.2f} m, with the solid {other:.2f} m"


def _unloading_words(liquid: Record, solid: Record) -> str:
    mine, other = 100.0 * liquid.max_wheel_unloading, 100.0 * solid.max_wheel_unloading
    return f"largest wheel unloading: {mine:.1f} % with the liquid, {other:.1f} % with the solid"


def _lock_words(liquid: Record, solid: Record) -> str:
    told = []
    for name, run in (("liquid", liquid), ("solid", solid)):
        speed = run.speed_at_first_lock_m_s
        longest = f"{max(run.locked_time_s):.2f} s at most"
        told.append(
            f"no wheel locks with the {name}" if speed is None
            else f"with the {name} a wheel first locks at {speed * 3.6:.1f} km/h ({longest})"
        )  # fmt: skip
    return "; ".join(told)
