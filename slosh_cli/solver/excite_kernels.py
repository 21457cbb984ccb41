# mypy: disallow-untyped-defs=False, disallow-untyped-calls=False, check-untyped-defs=False
"""Compiled loops of a tank that is moved as prescribed, with the kernels of the liquids that a wagon carries."""

from __future__ import annotations

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.compiled import inner_kernel, kernel
from slosh_cli.method import BASE, DIAGONAL, END, GAMMA, MIDDLE, OUTER, START
from slosh_cli.tank.modal import ModalLiquid
from slosh_cli.tank.shallow import ShallowLiquid, liquid_evolve
from slosh_cli.vectors import fill

_NO_PROFILE = 6
"""So many numbers has a row without the depths of the cells."""


@inner_kernel
def _swing(liquid, step, deceleration, slope):
    """One step (s) of TR-BDF2, as the wagon's `take_step` does it; the deceleration (m/s^2) has a `slope` (m/s^3)."""
    implicit = DIAGONAL * step
    liquid.predict(START, implicit, 0.0, implicit)
    liquid.follow(MIDDLE, BASE, implicit, 0.0, -(deceleration + slope * GAMMA * step), 0.0)
    liquid.predict(MIDDLE, OUTER * step, OUTER * step, implicit)
    liquid.follow(END, BASE, implicit, 0.0, -(deceleration + slope * step), 0.0)
    liquid.accept(step)


@inner_kernel
def _record(liquid, row):
    row[0], row[1] = liquid.force(START)
    row[2] = liquid.rise(START)
    for n in range(liquid.mu.size):
        row[3 + n] = liquid.amplitude[START, n]


@kernel
def modal_history(
    liquid: ModalLiquid, lengths: Vector, first: Vector, last: Vector, steps: Integers, rows: Matrix
) -> None:
    """Modes from where they are through stretches of time in which the deceleration is linear.

    Stretch s lasts `lengths[s]` (s), in `steps[s]` steps, from a deceleration `first[s]` to `last[s]` (m/s^2).
    `rows` (stretches + 1, 3 + modes) receives slosh force N, moment N m, rise of the surface in front m and amplitudes
    m at their ends, just after a jump where there is one.
    """
    for s in range(lengths.size):
        liquid.predict(START, 0.0, 0.0, 0.0)
        liquid.follow(START, BASE, 0.0, 0.0, -first[s], 0.0)
        _record(liquid, rows[s])
        step = lengths[s] / steps[s]
        slope = (last[s] - first[s]) / lengths[s]
        for k in range(steps[s]):
            _swing(liquid, step, first[s] + slope * k * step, slope)
    _record(liquid, rows[lengths.size])


@kernel
def cells_history(
    liquid: ShallowLiquid,
    area: Vector,
    flow: Vector,
    depth: Vector,
    lengths: Vector,
    means: Vector,
    work: Matrix,
    sums: Vector,
    rows: Matrix,
) -> int:
    """Cells through stretches of `lengths` (s) with the mean decelerations `means` (m/s^2); returns how many.

    Row s of `rows` (stretches, 6) receives the impulse N s of the force and N m s of the moment on the tank during the
    stretch, and at its end the depths m at the front and the rear wall, the volume m^3 and the largest depth m; where
    it has 7 + cells columns, the shift m of the centre of mass, forward, and the depths m of all cells too. `work`
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
        total = deepest = arm = 0.0
        for i in range(liquid.cells):
            total += area[i]
            arm += area[i] * (i + 0.5 - 0.5 * liquid.cells)
            deepest = max(deepest, depth[i])
        row[4], row[5] = total * liquid.spacing, deepest
        if row.size > _NO_PROFILE:
            row[6] = liquid.spacing * arm / total
            for i in range(liquid.cells):
                row[7 + i] = depth[i]
    return lengths.size
