"""The rail that travels with the wagon against a conventional one that stays in the ground."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.fixed_rail import fixed_rail, roll
from slosh_cli.validation.exact.paper_track import beam
from slosh_cli.validation.runs import stop


@dataclass(frozen=True, eq=False)
class _Ground:
    """Wheel deflections (steps, 4) in m of the fixed rail from t = 0 on, its unknowns and the seconds it took."""

    deflections: Array
    unknowns: int
    seconds: float


def compute(data: CaseData) -> Outcome:
    """Roll the wheel loads of a stop over a fixed rail and compare what each wheel sees beneath it."""
    found, panels = Findings(data), []
    for name, setting in data.reference["stops"].items():
        result = stop(setting["scenario"], *setting["overrides"])
        ground = _on_the_ground(result, setting)
        scale = float(np.abs(ground.deflections).max())
        swing = float(np.abs(ground.deflections - ground.deflections[0]).max())
        for i in WHEELS:
            seen = result.channels[wheel(i, "rail_deflection")]
            gap = float(np.abs(seen - ground.deflections[:, i - 1]).max())
            found.limit(f"{name}: rail under wheel {i}, largest difference over the deflection", gap / scale, name)
        found.note(f"{name}: change of deflection while braking over deflection", swing / scale)
        _costs(found, name, result, ground, setting)
        panels.append(_panel(name, result, ground))
    return found.outcome(Chart(panels))


def _on_the_ground(result: Result, setting: Mapping[str, Any]) -> _Ground:
    """The same loads in the same places on the fixed rail, which first settles to them at the initial speed."""
    case: Scenario = result.scenario
    step, run_in, ends = setting["step"], setting["run_in"], setting["ends"]
    length = setting["element_length"]
    speed = case.braking.initial_speed
    before = -np.arange(round(run_in / step), 0, -1) * step
    s = np.concatenate([speed * before, np.interp(_fine(result, step), result.time, result.channels["position"])])
    wheelbase, pivots = case.wagon.bogie.wheelbase, case.wagon.pivot_spacing
    arms = np.array([pivots + wheelbase, pivots - wheelbase, wheelbase - pivots, -wheelbase - pivots]) / 2
    loads = np.column_stack([_loads(result, i, step, before.size) for i in WHEELS])
    places = s[:, None] + arms - (s[0] + arms.min()) + ends
    rail = fixed_rail(beam(case.track), length, round((places.max() + ends) / length))
    began = time.perf_counter()
    deflections = roll(rail, places, loads, step)
    seconds = time.perf_counter() - began
    every = round(case.output.interval / step)
    return _Ground(deflections[before.size :: every][: result.time.size], rail.unknowns, seconds)


def _fine(result: Result, step: float) -> Array:
    return np.arange(round(result.time[-1] / step) + 1) * step


def _loads(result: Result, i: int, step: float, steps_before: int) -> Array:
    from scipy.interpolate import CubicSpline

    force = result.channels[wheel(i, "normal_force")]
    return np.concatenate([np.full(steps_before, force[0]), CubicSpline(result.time, force)(_fine(result, step))])


def _costs(found: Findings, name: str, result: Result, ground: _Ground, setting: Mapping[str, Any]) -> None:
    """What a whole stop would ask of the fixed rail, beside what it asks of the moving one."""
    from slosh_cli.solver.setup import problem

    moving = 2 * problem(result.scenario).vehicle.rail.nodes
    found.note(f"{name}: unknowns of the fixed rail over those of the moving one", ground.unknowns / moving)
    per_second = ground.seconds / float(result.time[-1])
    found.note(f"{name}: fixed rail alone, seconds of computing per second of braking", per_second)
    found.note(
        f"{name}: moving rail with wagon, contact and liquid, the same", result.solve_seconds / float(result.time[-1])
    )
    travel = stop("paper-160-liquid").channels["position"][-1]
    there = 2 * (float(travel) + 2 * setting["ends"]) / setting["element_length"]
    found.note(f"{name}: unknowns ratio for the paper's stop from 160 km/h ({travel:.0f} m)", there / moving)


def _panel(name: str, result: Result, ground: _Ground) -> Panel:
    curves = []
    for i in (1, 4):
        seen = 1e3 * result.channels[wheel(i, "rail_deflection")]
        curves.append(curve(f"wheel {i}, fixed rail", result.time, 1e3 * ground.deflections[:, i - 1], exact=True))
        curves.append(curve(f"wheel {i}, moving elements", result.time, seen))
    return Panel("time / s", "rail under the wheel / mm", curves, title=f"{name} track")
