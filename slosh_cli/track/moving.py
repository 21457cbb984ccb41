"""Kernels of the moving rail: stage matrix, residual, energy; see `mem` for the matrices (model section 6)."""

from __future__ import annotations

import numpy as np

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
from slosh_cli.track.mem import BENDING, DRIFT, MASS, TENSION, TWIST

# places in the rows of a rail's matrices
STAGE, DAMPING, STIFFNESS, MATRICES = range(0, 4 * ENTRIES, ENTRIES)


@vector_kernel
def _matrices(rail, step, speed, acceleration, rows):
    """`M + step C(V) + step^2 K(V, A)`, C(V) and K(V, A) of model section 6 into `rows` (r, 36)."""
    tension = rail.shear_stiffness - rail.mass * speed * speed
    drift = -rail.damping * speed - rail.mass * acceleration
    twice = -2.0 * rail.mass * speed
    twist = -rail.shear_damping * speed
    for run in range(rows.shape[0]):
        form, row = rail.forms[run], rows[run]
        for k in range(ENTRIES):
            mass, stretch, convection = form[MASS + k], form[TENSION + k], form[DRIFT + k]
            damping = rail.damping * mass + rail.shear_damping * stretch + twice * convection
            stiffness = rail.stiffness * mass + tension * stretch + drift * convection
            stiffness += rail.bending_stiffness * form[BENDING + k] + twist * form[TWIST + k]
            row[STAGE + k] = rail.mass * mass + step * (damping + step * stiffness)
            row[DAMPING + k], row[STIFFNESS + k] = damping, stiffness


@kernel
def prepare_rail(rail, step, speed, acceleration, rows, factors, flexibility):
    """Factor `M + step C(V) + step^2 K(V, A)` and solve it for a unit force at each wheel.

    `step` (s) is the implicit step, V (m/s) and A (m/s^2) the wagon's. Into `factors` (12, n) go the factors, into
    `flexibility` (n, 2, 4) the rail's accelerations per upward newton at wheels 1 to 4; `rows` (r, 36) is work space.
    """
    _matrices(rail, step, speed, acceleration, rows)
    factor_rows(rail.runs, rows, factors)
    for i in range(flexibility.shape[0]):
        for wheel in range(4):
            flexibility[i, 0, wheel] = flexibility[i, 1, wheel] = 0.0
    for wheel in range(4):
        flexibility[rail.contact[wheel], 0, wheel] = 1.0
    solve_four(factors, flexibility)


@vector_kernel
def rail_residual(rail, y, rate, second, step, speed, acceleration, rows, residual):
    """`M a + C(V) v + K(V, A) u` into `residual` (2 n,): the wheel forces the rail's motion asks for.

    `second` (2 n,) is a; u and v are what `y` and `rate` (2 n,) become with it in an implicit step of `step` (s):
    `u = y + step^2 a`, `v = rate + step a`. `rows` (r, 36) is work space.
    """
    _matrices(rail, step, speed, acceleration, rows)
    nodes = np.uint64(y.size // 2)
    for k in range(rail.runs.shape[0]):
        run, row = rail.runs[k], rows[k]
        stage, damping, stiffness = entries(row, STAGE), entries(row, DAMPING), entries(row, STIFFNESS)
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

    The material velocity is `y_t - V y_r` (model section 9).
    """
    twice, speed_square = 2.0 * speed, speed * speed
    square = square_slope = elastic = 0.0
    for k in range(rail.runs.shape[0]):
        run, form = rail.runs[k], rail.forms[k]
        v_v, v_u, u_u = pair_sums(run, rate, rate), pair_sums(run, rate, y), pair_sums(run, y, y)
        stretch, bend = weighed(form, TENSION, u_u), weighed(form, BENDING, u_u)
        square += weighed(form, MASS, v_v) - twice * weighed(form, DRIFT, v_u) + speed_square * stretch
        square_slope += weighed(form, TENSION, v_v) - twice * weighed(form, TWIST, v_u) + speed_square * bend
        elastic += rail.bending_stiffness * bend + rail.shear_stiffness * stretch
        elastic += rail.stiffness * weighed(form, MASS, u_u)
    return 0.5 * rail.mass * square, 0.5 * elastic, rail.damping * square + rail.shear_damping * square_slope
