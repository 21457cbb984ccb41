"""Kernels of the moving rail: stage matrix, residual, energy; see `mem` for the matrices (theory section 6)."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Matrix, Tesseract, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import kernel, vector_kernel
from slosh_cli.track.banded import (
    AFTER,
    BEFORE,
    END,
    ENTRIES,
    FIRST,
    by_deflection,
    by_slope,
    entries,
    factor_rows,
    pair_sums,
    solve_four,
    weighed,
)
from slosh_cli.track.mem import BENDING, DRIFT, MASS, TENSION, TWIST, RailModel, unit_loads

# places in the rows of a rail's matrices
_STAGE, _DAMPING, _STIFFNESS, MATRICES = range(0, 4 * ENTRIES, ENTRIES)


@vector_kernel
def _matrices(rail, step, speed, acceleration, rows):
    """`M + step C(V) + step^2 K(V, A)`, C(V) and K(V, A) of theory section 6 into `rows` (r, 36)."""
    forms, inertia, foundation, bending = rail.forms, rail.mass, rail.stiffness, rail.bending_stiffness
    loss, shear_loss = rail.damping, rail.shear_damping
    tension = rail.shear_stiffness - inertia * speed * speed
    drift = -loss * speed - inertia * acceleration
    twice = -2.0 * inertia * speed
    twist = -shear_loss * speed
    for run in range(rows.shape[0]):
        form, row = forms[run], rows[run]
        for k in range(ENTRIES):
            mass, stretch, convection = form[MASS + k], form[TENSION + k], form[DRIFT + k]
            damping = loss * mass + shear_loss * stretch + twice * convection
            stiffness = foundation * mass + tension * stretch + drift * convection
            stiffness += bending * form[BENDING + k] + twist * form[TWIST + k]
            row[_STAGE + k] = inertia * mass + step * (damping + step * stiffness)
            row[_DAMPING + k], row[_STIFFNESS + k] = damping, stiffness


class RailWork(Block):
    """Work space over a rail: nothing in it outlives a step.

    `rows` (r, 36) hold the matrices, `factors` (12, n) those of a stage's; `flexibility` (groups, n, 2, 4) the rail's
    accelerations per upward newton at each wheel, four wheels to a group; `between` (wheels, wheels) what of them is
    under the wheels; the rest are vectors (2 n,).
    """

    rows: Matrix
    factors: Matrix
    flexibility: Tesseract
    between: Matrix
    missing: Vector
    error: Vector
    error_rate: Vector
    zero: Vector


def rail_work(rail: RailModel) -> RailWork:
    """Work space for `rail`."""
    return RailWork.blank(
        2 * rail.nodes,
        rows=np.zeros((rail.runs.shape[0], MATRICES)),
        factors=np.zeros((ENTRIES, rail.nodes)),
        flexibility=unit_loads(rail),
        between=np.zeros((rail.contact.size, rail.contact.size)),
    )


@kernel
def prepare_rail(rail, work, step, speed, acceleration):
    """Factor `M + step C(V) + step^2 K(V, A)` and solve it for a unit force at each wheel.

    `step` (s) is the implicit step, V (m/s) and A (m/s^2) the wagon's. The results are in `work`.
    """
    contact, flexibility, between = rail.contact, work.flexibility, work.between
    _matrices(rail, step, speed, acceleration, work.rows)
    factor_rows(rail.runs, work.rows, work.factors)
    wheels = contact.size
    for group in range(flexibility.shape[0]):
        unit = flexibility[group]
        for i in range(unit.shape[0]):
            for wheel in range(4):
                unit[i, 0, wheel] = unit[i, 1, wheel] = 0.0
        for wheel in range(4 * group, min(4 * group + 4, wheels)):
            unit[contact[wheel], 0, wheel - 4 * group] = 1.0
        solve_four(work.factors, unit)
    for i in range(wheels):
        for j in range(wheels):
            between[i, j] = flexibility[j // 4, contact[i], 0, j % 4]


@vector_kernel
def rail_residual(rail, y, rate, second, step, speed, acceleration, rows, residual):
    """`M a + C(V) v + K(V, A) u` into `residual` (2 n,): the wheel forces the rail's motion asks for.

    `second` (2 n,) is a; u and v are what `y` and `rate` (2 n,) become with it in an implicit step of `step` (s):
    `u = y + step^2 a`, `v = rate + step a`. `rows` (r, 36) is work space.
    """
    _matrices(rail, step, speed, acceleration, rows)
    nodes = np.uint64(y.size // 2)
    runs = rail.runs
    for k in range(runs.shape[0]):
        run, row = runs[k], rows[k]
        stage, damping, stiffness = entries(row, _STAGE), entries(row, _DAMPING), entries(row, _STIFFNESS)
        first, first_before, first_after = run[FIRST], run[BEFORE], run[AFTER]
        for i in range(run[END] - first):
            before, here, after = first_before + i, first + i, first_after + i
            residual[here] = (
                by_deflection(stage, second, nodes, before, here, after)
                + by_deflection(damping, rate, nodes, before, here, after)
                + by_deflection(stiffness, y, nodes, before, here, after)
            )
            residual[nodes + here] = (
                by_slope(stage, second, nodes, before, here, after)
                + by_slope(damping, rate, nodes, before, here, after)
                + by_slope(stiffness, y, nodes, before, here, after)
            )


@kernel
def rail_ledger(rail, y, rate, speed):
    """Kinetic and elastic energy (J) of the rail and the power (W) its foundation takes.

    The material velocity is `y_t - V y_r` (theory section 9).
    """
    runs, forms = rail.runs, rail.forms
    bending, shear, foundation = rail.bending_stiffness, rail.shear_stiffness, rail.stiffness
    twice, speed_square = 2.0 * speed, speed * speed
    square = square_slope = elastic = 0.0
    for k in range(runs.shape[0]):
        run, form = runs[k], forms[k]
        v_v, v_u, u_u = pair_sums(run, rate, rate), pair_sums(run, rate, y), pair_sums(run, y, y)
        stretch, bend = weighed(form, TENSION, u_u), weighed(form, BENDING, u_u)
        square += weighed(form, MASS, v_v) - twice * weighed(form, DRIFT, v_u) + speed_square * stretch
        square_slope += weighed(form, TENSION, v_v) - twice * weighed(form, TWIST, v_u) + speed_square * bend
        elastic += bending * bend + shear * stretch
        elastic += foundation * weighed(form, MASS, u_u)
    return 0.5 * rail.mass * square, 0.5 * elastic, rail.damping * square + rail.shear_damping * square_slope
