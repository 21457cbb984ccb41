"""Stops whose answers are held against each other, and what another rounding of one input makes of each."""

from __future__ import annotations

import hashlib
import math
import platform
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from slosh_cli import load_scenario, load_train
from slosh_cli.results.result import Result
from slosh_cli.results.simulate import simulate, simulate_train
from slosh_cli.results.train_result import TrainResult
from slosh_cli.scenario.schema import load_tank_scenario
from slosh_cli.tank.coefficients import computed_modes

SCENARIOS = Path(__file__).parents[2] / "scenarios"

STOPS: Mapping[str, tuple[str, ...]] = {
    "paper_80": (),
    "paper_80_solid": (),
    "paper_160": (),
    "paper_160_solid": (),
    "block_brake": (),
    "tank_wagon": (),
    "paper_80, no wheel locks": ("braking.torque=5 kN m",),
    "paper_80, wheels lift and land": ("braking.torque=15 kN m",),
    "paper_160, three wheels lock": ("braking.torque=15 kN m",),
    "paper_80, wet rail": ("contact.adhesion=wet", "braking.torque=20 kN m"),
    "paper_80, computed modes": ("tank.coefficients=computed",),
    "tank_wagon, shallow water": ("tank.liquid.model=shallow-water",),
    "tank_wagon, dispersion": ("tank.liquid.model=shallow-water", "tank.liquid.dispersion=on"),
    "tank_wagon, baffle": ("tank.liquid.model=shallow-water", "tank.baffles=[{position: 7.75 m, opening: 0.2}]"),
    "tank_wagon, uneven rail": ("track.unevenness={sigma: 1.2 mm, seed: 1}",),
    "tank_wagon, slide protection": ("braking.slide_protection={}", "contact.adhesion=wet"),
}
"""Stops by name: the shipped scenario before the comma, with some of its values replaced."""

TRAINS = ("mixed_train", "block_train")
TANKS = ("kolaei_half", "kolaei_three_quarters")
"""Scenarios of a tank alone, whose modes are computed; nothing in them moves with the initial speed."""
LAST_DIGIT = 4e-16
"""Relative change of the initial speed that stands for another rounding: one or two units in the last place."""


def environment() -> dict[str, str]:
    """What this computes with."""
    packages = ("numpy", "scipy", "numba", "llvmlite", "h5py", "pydantic", "scikit-fem")
    return {"python": platform.python_version(), **{name: version(name) for name in packages}}


def numbers(result: Result | TrainResult) -> dict[str, Any]:
    """Distance and extremes of a stop, its status, the count of its steps."""
    found: dict[str, Any] = {"status": str(result.status), "steps": result.steps}
    found |= {name: getattr(result, name) for name in ("braking_distance_m", "braking_time_s")}
    if isinstance(result, TrainResult):
        found["max_compression_N"] = [one.max_compression_N for one in result.couplings]
        found["max_tension_N"] = [one.max_tension_N for one in result.couplings]
        return found
    names = ("min_wheel_load_N", "max_wheel_load_N", "locked_time_s")
    found |= {name: list(getattr(result, name)) for name in names}
    return found | {"max_surface_m": result.max_surface_m}


def digest(result: Result) -> str:
    """A digest that changes with any bit of any channel or number."""
    told = hashlib.sha256(repr(numbers(result)).encode())
    for name, values in result.channels.items():
        told.update(name.encode() + np.ascontiguousarray(values).tobytes())
    return told.hexdigest()


def scenario_of(name: str) -> Any:
    """The scenario of a stop of `STOPS`."""
    return load_scenario(SCENARIOS / f"{name.partition(',')[0]}.yaml", STOPS[name])


def answer(name: str, nudge: float = 0.0) -> dict[str, Any]:
    """The numbers of a stop or train, its initial speed off by the share `nudge`."""
    if name in TANKS:
        modes = computed_modes(load_tank_scenario(SCENARIOS / f"{name}.yaml").tank, 5)
        return {
            "status": "computed",
            "frequency_rad_s": [one.frequency for one in modes],
            "slosh_mass_kg": [one.slosh_mass for one in modes],
            "braking_distance_m": None,
        }
    if name in TRAINS:
        path = SCENARIOS / "trains" / f"{name}.yaml"
        speed = load_train(path).file.braking.initial_speed * (1 + nudge)
        return numbers(simulate_train(load_train(path, [f"braking.initial_speed={speed!r} m/s"])))
    scenario = scenario_of(name)
    speed = scenario.braking.initial_speed * (1 + nudge)
    return numbers(simulate(scenario.with_({"braking.initial_speed": f"{speed!r} m/s"})))


def difference(one: Mapping[str, Any], other: Mapping[str, Any]) -> float:
    """The largest difference of two answers, relative to the largest value of its kind; infinite for other
    ends."""
    if one["status"] != other["status"]:
        return math.inf
    worst = 0.0
    for name in one.keys() - {"status", "steps", "rounding", "rounding_distance"}:
        values, others = (np.atleast_1d(np.array(given[name], dtype=float)) for given in (one, other))
        known = np.isfinite(values)  # a distance that there is none of is not a number
        if not np.array_equal(known, np.isfinite(others)):
            return math.inf
        values, others = values[known], others[known]
        scale = np.max(np.abs(values), initial=0.0)
        if scale > 0.0:
            worst = max(worst, float(np.max(np.abs(values - others))) / scale)
    return worst


def distances_differ(one: Mapping[str, Any], other: Mapping[str, Any]) -> float:
    """The relative difference of two braking distances; infinite where one of them has none, zero where both."""
    values = [given["braking_distance_m"] for given in (one, other)]
    if None in values:
        return 0.0 if values == [None, None] else math.inf
    return abs(values[1] / values[0] - 1)


def collected(names: list[str]) -> dict[str, Any]:
    """The answers of all stops asked for, each with how far another rounding of the initial speed moves it."""
    stops = {}
    for name in names:
        plain = answer(name)
        nudged = [answer(name, nudge) for nudge in (LAST_DIGIT, -LAST_DIGIT)]
        stops[name] = plain | {
            "rounding": max(difference(plain, one) for one in nudged),
            "rounding_distance": max(distances_differ(plain, one) for one in nudged),
        }
    return {"environment": environment(), "stops": stops}
