"""Contestant (c), the multibody code exudyn: wagon and liquid on a rigid rail, `slosh_cli.validation.exact`.

Rigid bodies with finite rotations, trapezoidal rule with fixed steps in C++; Hertz and Polach are Python functions it
calls. Another model than the others' (no rail), so its error is taken from its own limit.
"""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np

from slosh_cli.scenario import Scenario
from slosh_cli.tank.coefficients import slosh_modes
from slosh_cli.validation.exact.exudyn_wagon import exudyn_stop

LEFT_OUT = "(c) left out: exudyn is not installed; python -m pip install --require-hashes -r .ci/validation.lock"
LONG_ENOUGH = 40.0
"""Seconds after which the wagon stands in any case."""


def is_installed() -> bool:
    """Whether exudyn can be imported."""
    return find_spec("exudyn") is not None


def braking_distance(case: Scenario, step: float) -> tuple[float, int]:
    """Braking distance (m) of the stop by steps of `step` s, and how many they were.

    The trapezoidal rule spreads a jump of torque over the step it falls in; half a step off the grid its middle is
    where the brake sets in, so nothing of second order is lost.
    """
    onset = case.braking.onset + 0.5 * step
    late = case.with_({"braking.onset": f"{onset!r} s"})
    (mode,) = slosh_modes(case.tank)
    found = exudyn_stop(late, mode, round(LONG_ENOUGH / step) * step, step)
    end = int(np.argmax(found.speed <= case.braking.stop_speed))
    part = (found.speed[end - 1] - case.braking.stop_speed) / (found.speed[end - 1] - found.speed[end])
    time = np.append(found.time[:end], found.time[end - 1] + part * (found.time[end] - found.time[end - 1]))
    way = np.trapezoid(np.append(found.speed[:end], case.braking.stop_speed), time)
    return float(
        way - np.trapezoid([found.speed[0], np.interp(onset, time, found.speed[: end + 1])], [0.0, onset])
    ), end
