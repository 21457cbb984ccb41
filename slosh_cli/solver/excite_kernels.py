# mypy: disallow-untyped-defs=False, disallow-untyped-calls=False, check-untyped-defs=False
"""Compiled loops of a tank that is moved as prescribed, with the kernels of the liquids that a wagon carries."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from slosh_cli.compiled import kernel
from slosh_cli.solver.method import DIAGONAL, GAMMA, OUTER
from slosh_cli.tank.modal import ModalLiquid, liquid_follow, liquid_force, surface_rise
from slosh_cli.tank.shallow import ShallowLiquid, liquid_evolve
from slosh_cli.track.vectors import fill

Array = NDArray[np.float64]


@kernel
def _swing(liquid, amplitude, rate, second, work, step, deceleration, slope):
    """One step (s) of TR-BDF2, as the wagon's `take_step` does it; the deceleration (m/s^2) has a `slope` (m/s^3)."""
    base, base_rate, middle = work[3], work[4], work[5]
    implicit = DIAGONAL * step
    for n in range(amplitude.size):
        base_rate[n] = rate[n] + implicit * second[n]
        base[n] = amplitude[n] + implicit * (rate[n] + base_rate[n])
    tank = -(deceleration + slope * GAMMA * step)
    liquid_follow(liquid, base, base_rate, implicit, 0.0, tank, 0.0, middle)
    for n in range(amplitude.size):
        middle_rate = base_rate[n] + implicit * middle[n]
        base_rate[n] = rate[n] + OUTER * step * (second[n] + middle[n])
        base[n] = amplitude[n] + OUTER * step * (rate[n] + middle_rate) + implicit * base_rate[n]
    tank = -(deceleration + slope * step)
    liquid_follow(liquid, base, base_rate, implicit, 0.0, tank, 0.0, second)
    for n in range(amplitude.size):
        rate[n] = base_rate[n] + implicit * second[n]
        amplitude[n] = base[n] + implicit * implicit * second[n]


@kernel
def _record(liquid, amplitude, second, row):
    row[0], row[1] = liquid_force(liquid, amplitude, second)
    row[2] = surface_rise(liquid, amplitude)


@kernel
def modal_history(
    liquid: ModalLiquid, lengths: Array, first: Array, last: Array, steps: NDArray[np.int64], work: Array, rows: Array
) -> None:
    """Modes from rest through stretches of time in which the deceleration is linear.

    Stretch s lasts `lengths[s]` (s), in `steps[s]` steps, from a deceleration `first[s]` to `last[s]` (m/s^2).
    `rows` (stretches + 1, 3) receives slosh force N, moment N m and rise of the surface in front m at their ends, just
    after a jump where there is one. `work` is (6, modes), zeroed.
    """
    amplitude, rate, second = work[0], work[1], work[2]
    for s in range(lengths.size):
        liquid_follow(liquid, amplitude, rate, 0.0, 0.0, -first[s], 0.0, second)
        _record(liquid, amplitude, second, rows[s])
        step = lengths[s] / steps[s]
        slope = (last[s] - first[s]) / lengths[s]
        for k in range(steps[s]):
            _swing(liquid, amplitude, rate, second, work, step, first[s] + slope * k * step, slope)
    _record(liquid, amplitude, second, rows[lengths.size])


@kernel
def cells_history(
    liquid: ShallowLiquid,
    area: Array,
    flow: Array,
    depth: Array,
    lengths: Array,
    means: Array,
    work: Array,
    sums: Array,
    rows: Array,
) -> int:
    """Cells through stretches of `lengths` (s) with the mean decelerations `means` (m/s^2); returns how many.

    Row s of `rows` (stretches, 6) receives the impulse N s of the force and N m s of the moment on the tank during the
    stretch, and at its end the depths m at the front and the rear wall, the volume m^3 and the largest depth m. `work`
    is (WORK_ROWS, cells + 1), `sums` (4,). Fewer stretches than given are returned where the liquid's speed is no
    longer finite.
    """
    for s in range(lengths.size):
        fill(sums, 0.0)
        if not liquid_evolve(liquid, area, flow, depth, -means[s], lengths[s], work, sums):
            return s
        row = rows[s]
        row[0], row[1] = sums[0], sums[1]
        row[2], row[3] = depth[liquid.cells - 1], depth[0]
        total = deepest = 0.0
        for i in range(liquid.cells):
            total += area[i]
            deepest = max(deepest, depth[i])
        row[4], row[5] = total * liquid.spacing, deepest
    return lengths.size
