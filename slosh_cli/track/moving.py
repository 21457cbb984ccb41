"""Kernels of the moving rail: stage matrix, residual, energy; see `mem` for the matrices (model section 6)."""

from __future__ import annotations

from slosh_cli.compiled import kernel
from slosh_cli.track.banded import factor_banded, form_banded, multiply_banded, solve_banded_four
from slosh_cli.track.vectors import fill


@kernel
def prepare_rail(rail, step, speed, acceleration, factors, flexibility):
    """Factor `M + step C(V) + step^2 K(V, A)` and solve it for a unit force at each wheel.

    `step` (s) is the implicit step, V (m/s) and A (m/s^2) the wagon's. Into `factors` (n, 7) go the factors, into
    `flexibility` (n, 4) the rail's accelerations per upward newton at wheels 1 to 4.
    """
    square = step * step
    tension = rail.shear_stiffness - rail.mass * speed * speed
    mass_part = rail.mass + step * rail.damping + square * rail.stiffness
    tension_part = step * rail.shear_damping + square * tension
    drift_part = -2.0 * step * rail.mass * speed - square * (rail.damping * speed + rail.mass * acceleration)
    bending_part = square * rail.bending_stiffness
    twist_part = -square * rail.shear_damping * speed
    for i in range(factors.shape[0]):
        for j in range(7):
            factors[i, j] = (
                mass_part * rail.mass_form[i, j]
                + tension_part * rail.tension_form[i, j]
                + drift_part * rail.drift_form[i, j]
                + bending_part * rail.bending_form[i, j]
                + twist_part * rail.twist_form[i, j]
            )
    factor_banded(factors)
    for i in range(flexibility.shape[0]):
        fill(flexibility[i], 0.0)
    for wheel in range(4):
        flexibility[rail.contact[wheel], wheel] = 1.0
    solve_banded_four(factors, flexibility)


@kernel
def rail_residual(rail, y, rate, second, speed, acceleration, scratch, residual):
    """`M y'' + C(V) y' + K(V, A) y` into `residual` (n,): the wheel forces the rail's motion asks for.

    `y`, `rate`, `second` (n,) are the unknowns and their time derivatives, `scratch` is (n,).
    """
    tension = rail.shear_stiffness - rail.mass * speed * speed
    drift = rail.damping * speed + rail.mass * acceleration
    size = y.size
    fill(residual, 0.0)
    for i in range(size):
        scratch[i] = rail.mass * second[i] + rail.damping * rate[i] + rail.stiffness * y[i]
    multiply_banded(rail.mass_form, scratch, 1.0, residual)
    for i in range(size):
        scratch[i] = rail.shear_damping * rate[i] + tension * y[i]
    multiply_banded(rail.tension_form, scratch, 1.0, residual)
    for i in range(size):
        scratch[i] = -2.0 * rail.mass * speed * rate[i] - drift * y[i]
    multiply_banded(rail.drift_form, scratch, 1.0, residual)
    multiply_banded(rail.bending_form, y, rail.bending_stiffness, residual)
    multiply_banded(rail.twist_form, y, -rail.shear_damping * speed, residual)


@kernel
def rail_ledger(rail, y, rate, speed):
    """Kinetic and elastic energy (J) of the rail and the power (W) its foundation takes.

    The material velocity is `y_t - V y_r` (model section 9).
    """
    strain = form_banded(rail.tension_form, y, y)
    bending = form_banded(rail.bending_form, y, y)
    square = (
        form_banded(rail.mass_form, rate, rate)
        - 2.0 * speed * form_banded(rail.drift_form, rate, y)
        + speed * speed * strain
    )
    square_slope = (
        form_banded(rail.tension_form, rate, rate)
        - 2.0 * speed * form_banded(rail.twist_form, rate, y)
        + speed * speed * bending
    )
    elastic = 0.5 * (
        rail.bending_stiffness * bending
        + rail.shear_stiffness * strain
        + rail.stiffness * form_banded(rail.mass_form, y, y)
    )
    return 0.5 * rail.mass * square, elastic, rail.damping * square + rail.shear_damping * square_slope
