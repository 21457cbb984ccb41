"""Friction of blocks and pads as the railways' formulas give it, and stops under a brake that builds up evenly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, sqrt

import numpy as np


def friction_law(law: str | float | Sequence[Sequence[float]]) -> Callable[[float, float], float]:
    """Coefficient of friction at a tread's speed (km/h) under a force (kN).

    `law` is a name (`cast-iron` after Karwatzki, `composite`), a constant, or rows of speed (km/h) and coefficient.
    """
    if law == "cast-iron":
        return lambda v, F: 0.6 * (1.62 * F + 100) / (8.1 * F + 100) * (v + 100) / (5 * v + 100)
    if law == "composite":
        return lambda v, F: 0.44 * (0.1 * F + 20) / (0.4 * F + 20) * (v + 150) / (2 * v + 150)
    if isinstance(law, (int, float)):
        constant = float(law)
        return lambda _v, _F: constant
    speeds, values = np.array(law, dtype=float).T
    return lambda v, _F: float(np.interp(v, speeds, values))


def ramped_stop(speed: float, deceleration: float, build_up: float, pull: float = 0.0) -> float:
    """Distance (m) from `speed` (m/s) under a deceleration (m/s^2) that grows evenly for `build_up` s, then stays.

    `pull` is the deceleration by gravity, positive uphill. Level and longer than the build-up it is
    `V T/2 + V^2/(2 A) - A T^2/24`. Infinite where gravity pulls harder than the brake.
    """
    A, T = deceleration, build_up
    if T > 0.0:
        standing = _first_zero(speed, pull, A / (2 * T))
        if standing <= T:
            return speed * standing - pull * standing**2 / 2 - A * standing**3 / (6 * T)
    if A + pull <= 0.0:
        return inf
    then = speed - (pull + A / 2) * T
    return speed * T - pull * T**2 / 2 - A * T**2 / 6 + then**2 / (2 * (A + pull))


def _first_zero(speed: float, pull: float, bend: float) -> float:
    """The positive root of `speed - pull t - bend t^2`."""
    return 2 * speed / (pull + sqrt(pull**2 + 4 * bend * speed))
