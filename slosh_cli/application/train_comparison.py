"""Trains beside each other: how their answers differ, and what the liquid in their tanks did."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from slosh_cli.application.differing import Difference, listed
from slosh_cli.results.train_result import TrainHistory, TrainResult

_PER: Final[Mapping[str, tuple[str, float]]] = {"N": ("kN", 1e3), "1": ("", 1.0)}
"""Units as shown, and the SI units that one of them counts."""
_DECLARED: Final = (
    "braking_distance_m", "braking_time_s", "max_compression_N", "compression_at", "max_compression_s",
    "max_tension_N", "tension_at", "max_tension_s",
)  # fmt: skip
_OF_VEHICLES: Final = (
    ("min_wheel_load_N", "N", "least load of any wheel of any vehicle since its onset"),
    ("min_wheel_load_at", "1", "vehicle with that wheel, counted from the front"),
    ("max_wheel_unloading", "%", "largest 1 - N/N0 of any wheel of any vehicle"),
    ("locked_vehicles", "1", "vehicles with a wheel that locked"),
    ("longest_lock_s", "s", "how long the wheel was locked that was so longest"),
    ("max_surface_m", "m", "largest rise of the free surface at an end wall of any tank"),
)


def train_differences(trains: Sequence[TrainHistory]) -> list[Difference]:
    """Every answer of the trains' stops that is a number, for all of `trains`."""
    table = {one.name: one for one in TrainResult.table()}
    asked = [(name, table[name].unit, table[name].meaning) for name in _DECLARED]
    found, answers = [], [dict(train.facts) | _least_and_most(train) for train in trains]
    for name, unit, meaning in (*asked, *_OF_VEHICLES):
        values = tuple(_number(each.get(name)) for each in answers)
        shown, per = ("%", 0.01) if unit == "%" else _PER.get(unit, (unit, 1.0))
        if any(value is not None for value in values):
            found.append(Difference(name, meaning, shown, per, values))
    return found


def _least_and_most(train: TrainHistory) -> dict[str, Any]:
    """What follows from the answers of the vehicles; a train without couplings has no place of a force."""
    facts = [one.facts for one in train.vehicles]
    least = [float(np.min(one["min_wheel_load_N"])) for one in facts]
    locked = [float(np.max(one["locked_time_s"])) for one in facts]
    told: dict[str, Any] = {
        "min_wheel_load_N": min(least),
        "min_wheel_load_at": int(np.argmin(least)) + 1,
        "max_wheel_unloading": max(one["max_wheel_unloading"] for one in facts),
        "locked_vehicles": sum(time > 0.0 for time in locked),
        "longest_lock_s": max(locked),
        "max_surface_m": max(one["max_surface_m"] for one in facts),
    }
    nowhere = ("compression_at", "tension_at", "max_compression_N", "max_tension_N")
    return told if train.couplings else told | dict.fromkeys(nowhere)


def _number(value: Any) -> float | None:
    return float(value) if value is not None and math.isfinite(value) else None


def train_liquid_words(liquid: TrainResult, solid: TrainResult) -> list[str]:
    """What the liquid did to forces, wheel loads and locks of a train, beside the same train with solid loads."""
    words = []
    for way in ("compression", "tension") if liquid.couplings else ():
        mine, other = (f"max_{way}_N", f"{way}_at")
        forces = [getattr(run, mine) / 1e3 for run in (liquid, solid)]
        change = f", {100.0 * (forces[0] - forces[1]) / forces[1]:+.1f} %" if forces[1] > 0.0 else ""
        places = [getattr(run, other) for run in (liquid, solid)]
        words.append(
            f"largest {way}: {forces[0]:.1f} kN with the liquid (coupling {places[0]}), "
            f"{forces[1]:.1f} kN with the solid (coupling {places[1]}){change}"
        )
    unloading = [100.0 * run.max_wheel_unloading for run in (liquid, solid)]
    words.append(f"largest wheel unloading: {unloading[0]:.1f} % with the liquid, {unloading[1]:.1f} % with the solid")
    return [*words, "; ".join(_locks(name, run) for name, run in (("liquid", liquid), ("solid", solid)))]


def _locks(name: str, run: TrainResult) -> str:
    places = [place for place, one in enumerate(run.vehicles, 1) if max(one.locked_time_s) > 0.0]
    if not places:
        return f"no wheel locks with the {name}"
    which = f"{'vehicle' if len(places) == 1 else 'vehicles'} {listed(places)}"
    return f"with the {name} wheels lock in {which} ({run.longest_lock_s:.3g} s at most)"
