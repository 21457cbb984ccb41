"""Integrals of sampled powers and forces that jump at a known instant."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Array


def integral(time: Array, values: Array, jump: float) -> float:
    """Trapezoidal integral over all of `time` of samples that jump at `jump` and are smooth on either side.

    The sample nearest to the jump is replaced by what each side extrapolates to.
    """
    at = int(np.argmin(np.abs(time - jump)))
    left, right = values[: at + 1].copy(), values[at:].copy()
    left[-1] = 2 * left[-2] - left[-3]
    right[0] = 2 * right[1] - right[2]
    return float(np.trapezoid(left, time[: at + 1]) + np.trapezoid(right, time[at:]))
