"""Contestant (b): a conventional rail fixed in the ground under the same wheel loads, `slosh_cli.validation.exact`.

It is given the wheel loads of the finished stop, so its time is that of the rail alone. Its matrix is as long as the
whole braking distance; every step costs the same, so `PART` of the stop is run on the whole length and scaled by time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario
from slosh_cli.validation.exact.fixed_rail import FixedRail, fixed_rail, roll
from slosh_cli.validation.exact.paper_track import beam

Array = NDArray[np.float64]
STEP = 5e-4
"""Step of the validation case `mem-vs-fem`, s."""
PART = 1.0
"""Seconds of the stop that are run."""
ENDS = 25.0
"""Rail beyond the outer wheels at either end, m, as in the moving domain."""


@dataclass(frozen=True, eq=False)
class Passage:
    """Rail, places (steps, 4) m and loads (steps, 4) N of the wheels; `share` of the whole stop's steps."""

    rail: FixedRail
    places: Array
    loads: Array
    share: float

    def deflections(self) -> Array:
        """Deflection (m) under each wheel at every step."""
        return roll(self.rail, self.places, self.loads, STEP)


def passage(result: Result, element_length: float, length: float | None = None, until: float = PART) -> Passage:
    """The first `until` s of a stop on a rail of `length` m; without it, as long as the whole stop needs."""
    case, time = result.scenario, np.arange(round(until / STEP)) * STEP
    wheelbase, pivots = case.wagon.bogie.wheelbase, case.wagon.pivot_spacing
    arms = np.array([pivots + wheelbase, pivots - wheelbase, wheelbase - pivots, -wheelbase - pivots]) / 2
    places = CubicSpline(result.time, result.channels["position"])(time)[:, None] + arms - arms.min() + ENDS
    loads = [CubicSpline(result.time, result.channels[wheel(i, "normal_force")])(time) for i in WHEELS]
    whole = float(result.channels["position"][-1]) + np.ptp(arms) + 2 * ENDS
    rail = fixed_rail(beam(case.track), element_length, round((length or whole) / element_length))
    return Passage(rail, places, np.column_stack(loads), until / float(result.time[-1]))


def accuracy(result: Result, element_lengths: list[float], finest: float) -> dict[float, float]:
    """Largest deviation from the `finest` mesh over the largest deflection by element length.

    Over a tenth of a second around a place where the wheels have left the start behind.
    """
    short = 120.0
    exact = passage(result, finest, short, 0.8).deflections()[-200:]
    found = {}
    for element_length in element_lengths:
        deviation = passage(result, element_length, short, 0.8).deflections()[-200:] - exact
        found[element_length] = float(np.abs(deviation).max() / np.abs(exact).max())
    return found


def moving_accuracy(case: Scenario, finer: Scenario) -> float:
    """The same measure for the moving rail: steady shapes under unit loads on the stop's mesh and a finer one."""
    from slosh_cli.method import START
    from slosh_cli.solver.setup import problem

    vehicles = [problem(one).vehicle for one in (case, finer)]
    coarse, fine = (vehicle.points[START].rail[vehicle.rail.contact] for vehicle in vehicles)
    return float(np.abs(coarse - fine).max() / np.abs(fine).max())
