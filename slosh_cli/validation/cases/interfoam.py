"""Liquid force and moment of a braked tank beside OpenFOAM's interFoam: shallow water, and the modal liquid with it."""

from __future__ import annotations

from math import pi, sqrt, tanh
from typing import Any

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import RectangularSection
from slosh_cli.tank import shallow
from slosh_cli.tank.baffle import baffles_at
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.section_table import section_table
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.cases import kolaei
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData, data_rows

_STEP = 0.02


def compute(data: CaseData) -> Outcome:
    """Both histories: the shallow-water liquid decides, the modal one stands beside it."""
    found, panels, tank = Findings(data), [], data.reference
    for deceleration in tank["decelerations"]:
        rows = data_rows(f"interfoam_{deceleration}.csv")
        time, force, moment = (
            np.array([float(row[name]) for row in rows]) for name in ("time_s", "force_N_per_m", "moment_N")
        )
        weight = tank["density"] * tank["depth"] * tank["length"] * deceleration
        middle, flowing, turning = _shallow(tank, deceleration, time.size)
        linear = np.interp(middle, kolaei._times(), _modal(tank, deceleration)) * weight
        given = np.interp(middle, time, force)
        name = f"at {deceleration} m/s^2"
        miss = _rms(flowing - given) / weight
        found.limit(f"rms of the force over m a, shallow water, {name}", miss, f"force_{deceleration}")
        found.compare(f"peak moment / N, shallow water, {name}", float(turning.max()), float(moment.max()), "moment")
        found.note(f"rms of the force over m a, modal, one mode, {name}", _rms(linear - given) / weight)
        curves = (
            curve("interFoam", time, force / weight, exact=True),
            curve("shallow water", middle, flowing / weight),
            curve("modal, one mode", middle, linear / weight),
        )
        panels.append(Panel("time / s", "force over m a", curves, title=f"{deceleration} m/s^2"))
    return found.outcome(Chart(panels))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _modal(tank: Any, deceleration: float) -> Array:
    """Force over m a of the first mode of potential flow in a rectangular tank."""
    k = pi / tank["length"]
    steepness = k * tank["depth"]
    fraction = 8 / pi**2 * tanh(steepness) / steepness
    mode = SloshMode(sqrt(STANDARD_GRAVITY * k * tanh(steepness)), 1.0, 0.0, 1 / fraction)
    return kolaei.normalised_force((mode,), 1.0, deceleration, 0.0)


def _shallow(tank: Any, deceleration: float, steps: int) -> tuple[Array, Array, Array]:
    """Middles of the steps (s), mean force (N) and moment (N m) per metre of width over each."""
    section, cells, depth = RectangularSection(1.0, tank["height"]), tank["cells"], tank["depth"]
    liquid = shallow.ShallowLiquid(
        cells=cells,
        spacing=tank["length"] / cells,
        density=tank["density"],
        gravity=STANDARD_GRAVITY,
        centre_height=section.centroid_height(depth),
        mass=tank["density"] * section.area(depth) * tank["length"],
        still_depth=depth,
        baffles=baffles_at(cells, {}),
        table=section_table(section, STANDARD_GRAVITY, tank["slot_speed"]),
        columns=1,
        disperses=0,
        riding=0.0,
    )
    area, flow, deep = np.full(cells, section.area(depth)), np.zeros(cells), np.full(cells, depth)
    evolve: Any = shallow.liquid_evolve
    work, pushes = np.zeros((shallow.WORK_ROWS, cells + 1)), np.zeros((steps, 4))
    for push in pushes:
        evolve(liquid, area, flow, deep, -deceleration, _STEP, work, push)
    middles = np.asarray((np.arange(steps) + 0.5) * _STEP, dtype=np.float64)
    return middles, pushes[:, 0] / _STEP, pushes[:, 1] / _STEP
