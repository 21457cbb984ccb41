"""Kernels of the moving rail: stage matrix, residual, energy; see `mem` for the matrices (model section 6)."""

from __future__ import annotations

from slosh_cli.compiled import kernel, vector_kernel
from slosh_cli.track.banded import factor_banded, solve_banded_four
from slosh_cli.track.vectors import fill


@vector_kernel
def _stage_matrix(rail, step, speed, acceleration, matrix):
    """`M + step C(V) + step^2 K(V, A)` into `matrix` (7, n)."""
    square = step * step
    tension = rail.shear_stiffness - rail.mass * speed * speed
    mass_part = rail.mass + step * rail.damping + square * rail.stiffness
    tension_part = step * rail.shear_damping + square * tension
    drift_part = -2.0 * step * rail.mass * speed - square * (rail.damping * speed + rail.mass * acceleration)
    bending_part = square * rail.bending_stiffness
    twist_part = -square * rail.shear_damping * speed
    for k in range(7):
        for i in range(matrix.shape[1]):
            matrix[k, i] = (
                mass_part * rail.mass_form[k, i]
                + tension_part * rail.tension_form[k, i]
                + drift_part * rail.drift_form[k, i]
                + bending_part * rail.bending_form[k, i]
                + twist_part * rail.twist_form[k, i]
            )


@kernel
def prepare_rail(rail, step, speed, acceleration, factors, flexibility):
    """Factor `M + step C(V) + step^2 K(V, A)` and solve it for a unit force at each wheel.

    `step` (s) is the implicit step, V (m/s) and A (m/s^2) the wagon's. Into `factors` (7, n) go the factors, into
    `flexibility` (4, n) the rail's accelerations per upward newton at wheels 1 to 4.
    """
    _stage_matrix(rail, step, speed, acceleration, factors)
    factor_banded(factors)
    for wheel in range(4):
        fill(flexibility[wheel], 0.0)
        flexibility[wheel, rail.contact[wheel]] = 1.0
    solve_banded_four(factors, flexibility)


@vector_kernel
def rail_residual(rail, y, rate, second, speed, acceleration, parts, residual):
    """`M y'' + C(V) y' + K(V, A) y` into `residual` (n,): the wheel forces the rail's motion asks for.

    `y`, `rate`, `second` (n,) are the unknowns and their time derivatives; `parts` (3, n) is work space.
    """
    tension = rail.shear_stiffness - rail.mass * speed * speed
    drift = rail.damping * speed + rail.mass * acceleration
    twice = 2.0 * rail.mass * speed
    twist = rail.shear_damping * speed
    size = y.size
    by_mass, by_tension, by_drift = parts[0], parts[1], parts[2]
    for i in range(size):
        by_mass[i] = rail.mass * second[i] + rail.damping * rate[i] + rail.stiffness * y[i]
        by_tension[i] = rail.shear_damping * rate[i] + tension * y[i]
        by_drift[i] = -twice * rate[i] - drift * y[i]
        residual[i] = 0.0
    for k in range(7):
        first, last = max(0, 3 - k), min(size, size + 3 - k)
        here, there = slice(first, last), slice(first + k - 3, last + k - 3)
        result, place = residual[here], y[there]
        mass_part, tension_part, drift_part = by_mass[there], by_tension[there], by_drift[there]
        mass_form, tension_form, drift_form = (
            rail.mass_form[k, here],
            rail.tension_form[k, here],
            rail.drift_form[k, here],
        )
        bending_form, twist_form = rail.bending_form[k, here], rail.twist_form[k, here]
        for i in range(result.size):
            result[i] += (
                mass_form[i] * mass_part[i]
                + tension_form[i] * tension_part[i]
                + drift_form[i] * drift_part[i]
                + (rail.bending_stiffness * bending_form[i] - twist * twist_form[i]) * place[i]
            )


@vector_kernel
def rail_ledger(rail, y, rate, speed):
    """Kinetic and elastic energy (J) of the rail and the power (W) its foundation takes.

    The material velocity is `y_t - V y_r` (model section 9).
    """
    size = y.size
    twice, speed_square = 2.0 * speed, speed * speed
    square = square_slope = elastic = 0.0
    for k in range(7):
        first, last = max(0, 3 - k), min(size, size + 3 - k)
        here, there = slice(first, last), slice(first + k - 3, last + k - 3)
        y_i, rate_i, y_j, rate_j = y[here], rate[here], y[there], rate[there]
        mass_form, tension_form, drift_form = (
            rail.mass_form[k, here],
            rail.tension_form[k, here],
            rail.drift_form[k, here],
        )
        bending_form, twist_form = rail.bending_form[k, here], rail.twist_form[k, here]
        for i in range(y_i.size):
            stretch, bend = tension_form[i] * y_j[i], bending_form[i] * y_j[i]
            square += (
                rate_i[i] * (mass_form[i] * rate_j[i] - twice * drift_form[i] * y_j[i])
                + speed_square * y_i[i] * stretch
            )
            square_slope += (
                rate_i[i] * (tension_form[i] * rate_j[i] - twice * twist_form[i] * y_j[i])
                + speed_square * y_i[i] * bend
            )
            elastic += y_i[i] * (
                rail.bending_stiffness * bend + rail.shear_stiffness * stretch + rail.stiffness * mass_form[i] * y_j[i]
            )
    return 0.5 * rail.mass * square, 0.5 * elastic, rail.damping * square + rail.shear_damping * square_slope
