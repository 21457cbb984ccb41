"""Runs beside each other: how their answers differ, which inputs differ, their histories in one picture."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.differing import Difference
from slosh_cli.application.runs import AnyRun, trains_of
from slosh_cli.application.train_comparison import train_differences, train_liquid_words
from slosh_cli.errors import UsageError
from slosh_cli.results.answers import Answer, PerWheel, Place, Shown
from slosh_cli.results.result import Record, Result
from slosh_cli.results.train_result import TrainResult
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.train_file import TrainScenario

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

    from slosh_cli.application.keeping import Keeping

_FIGURES: Final = ("compare_speed", "compare_wheel_loads", "compare_slosh", "compare_brake")
_TRAIN_FIGURES: Final = ("compare_train_speed", "compare_train_forces")
_OF_THE_SOLVER: Final = frozenset(
    {"steps", "rejected_steps", "solve_seconds", "energy_residual", "mean_total_wheel_load_N"}
)
"""Answers that tell of the computation and not of the stop."""
_BESIDES: Final = frozenset({"fill", "surface_limit_m", "static_wheel_load_N", "weight_N"})
"""Answers that follow from the inputs: told only where they differ."""


def differences(runs: Sequence[AnyRun]) -> list[Difference]:
    """Every answer of the stops that is a number, for all of `runs`: all of wagons, or all of trains (UsageError)."""
    trains = trains_of(runs)
    if trains is not None:
        return train_differences(trains)
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


def keep_comparison(runs: Sequence[AnyRun], names: Sequence[str], folder: Path, keeping: Keeping) -> list[str]:
    """Draw the histories of `runs` over each other into `folder`; returns the files that are there."""
    from slosh_cli.application.plotting import writers
    from slosh_cli.report import FORMATS

    owned = [f"{name}.{kind}" for name in (*_FIGURES, *_TRAIN_FIGURES) for kind in FORMATS]
    return keeping.keep(folder, owned, {}, writers(dict(_figures(runs, names))))


def _figures(runs: Sequence[AnyRun], names: Sequence[str]) -> Mapping[str, Callable[[], Figure]]:
    """What draws each figure that suits the runs."""
    from slosh_cli.report.compare_figures import compare_figure, suits
    from slosh_cli.report.compare_train_figures import compare_train_figures

    trains = trains_of(runs)
    if trains is not None:
        return compare_train_figures(trains, names)
    wagons = [run for run in runs if isinstance(run, Record)]
    return {name: partial(compare_figure, name, wagons, names) for name in _FIGURES if suits(name, wagons)}


def solid_twin(scenario: Scenario | TrainScenario) -> Scenario | TrainScenario:
    """The same stop with the equivalent solid in every tank. Raises UsageError where all loads are solid already."""
    key = "tank.liquid.model" if isinstance(scenario, Scenario) else "all.tank.liquid.model"
    vehicles = [scenario] if isinstance(scenario, Scenario) else scenario.vehicles
    if all(one.tank.liquid.model == "rigid" for one in vehicles):
        fix = f"leave --twin out, or set {key} to modal"
        raise UsageError(f"--twin compares a liquid with its solid, but the load of {scenario.name} is rigid; {fix}")
    return scenario.with_({key: "rigid"})


def liquid_words(liquid: Record | TrainResult, solid: Record | TrainResult) -> list[str]:
    """What the liquid did to the stop, beside its equivalent solid: distance, forces of a train, unloading, lock."""
    distance = _distance_words(liquid, solid)
    if isinstance(liquid, TrainResult) and isinstance(solid, TrainResult):
        return [distance, *train_liquid_words(liquid, solid)]
    if isinstance(liquid, Record) and isinstance(solid, Record):
        return [distance, _unloading_words(liquid, solid), _lock_words(liquid, solid)]
    raise TypeError("A liquid and its solid must be runs of one kind, but a wagon and a train were given.")


def _distance_words(liquid: Record | TrainResult, solid: Record | TrainResult) -> str:
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
