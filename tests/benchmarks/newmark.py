"""Contestant (a), the textbook: Newmark's average acceleration with fixed steps in a Python loop.

The equations, the mesh and the pieces (wagon, rail matrices, contact forces) are those of the plain implementation in
`tests/reference_code`. With average acceleration a step ends at `u = u_p + (h/2) a`, `q = q_p + (h/2) u`
(N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67-94). The rail is solved by `scipy.linalg.solve_banded` for its free
motion and for a unit load at each wheel, the wagon and its four contacts by Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from reference_code.plain_contact import normal_force
from reference_code.plain_motion import W_DOFS, Brake, Motion, System, _forces, equilibrium
from reference_code.plain_rail import BAND, times
from reference_code.plain_wagon import PHI, S
from scipy.linalg import solve_banded

from slosh_cli.scenario import Scenario

Array = NDArray[np.float64]
MOST_ITERATIONS = 20


@dataclass(frozen=True, eq=False)
class Accelerations:
    """Accelerations of wagon (16,) and rail (n,), wheel loads (4,) N."""

    wagon: Array
    rail: Array
    loads: Array


def _rail_response(system: System, base: Motion, tau: float, speed: float, acceleration: float) -> Array:
    """Rail accelerations without load and per newton under each wheel, (n, 5)."""
    rail = system.rail
    damping, stiffness = rail.damping_matrix(speed), rail.stiffness_matrix(speed, acceleration)
    right = np.empty((rail.size, 5))
    right[:, 0] = -times(damping, base.v) - times(stiffness, base.y + tau * base.v)
    right[:, 1:] = -rail.wheel_loads()
    return solve_banded((BAND, BAND), rail.mass_matrix + tau * damping + tau**2 * stiffness, right, check_finite=False)


def _solve(system: System, brake: Brake, base: Motion, tau: float, guess: Accelerations) -> Accelerations:
    """Newton's method on the wagon's accelerations and the wheel loads; the rail follows speed and acceleration."""
    wagon, under, size = system.wagon, system.rail.wheel_dofs, system.wagon.size
    linear = wagon.mass + tau * wagon.damping + tau**2 * wagon.stiffness
    a, loads = guess.wagon.copy(), guess.loads
    jacobian, residual = np.zeros((size + 4, size + 4)), np.zeros(size + 4)
    made_with = (np.inf, np.inf)
    for _ in range(MOST_ITERATIONS):
        u = base.u + tau * a
        q = base.q + tau * u
        remade = abs(u[S] - made_with[0]) > 1e-7 or abs(a[S] - made_with[1]) > 1e-5
        if remade:
            made_with = (u[S], a[S])
            response = _rail_response(system, base, tau, *made_with)
            free = base.y[under] + tau * base.v[under] + tau**2 * response[under, 0]
            compliance = -(tau**2) * response[under, 1:]
        force, by_velocity, by_load = _forces(system, brake, u, loads)
        normal, slope = normal_force(system.contact, free - compliance @ loads - q[W_DOFS])
        residual[:size] = wagon.mass @ a + wagon.damping @ u + wagon.stiffness @ q - force
        residual[size:] = loads - normal
        jacobian[:size, :size] = linear - tau * by_velocity
        jacobian[:size, size:] = -by_load
        jacobian[size + np.arange(4), W_DOFS] = tau**2 * slope
        jacobian[size:, size:] = np.eye(4) + slope[:, None] * compliance
        change = np.linalg.solve(jacobian, -residual)
        a, loads = a + change[:size], loads + change[size:]
        if not remade and tau * np.abs(change[:size]).max() < 1e-10 and np.abs(change[size:]).max() < 1e-3:
            return Accelerations(a, response[:, 0] + response[:, 1:] @ loads, loads)
    raise ArithmeticError("Newton's method did not converge")


def _step(system: System, brake: Brake, motion: Motion, now: Accelerations, h: float) -> tuple[Motion, Accelerations]:
    tau = 0.5 * h
    base = Motion(
        motion.q + tau * motion.u, motion.u + tau * now.wagon, motion.y + tau * motion.v, motion.v + tau * now.rail
    )
    new = _solve(system, brake, base, tau, now)
    u, v = base.u + tau * new.wagon, base.v + tau * new.rail
    return Motion(base.q + tau * u, u, base.y + tau * v, v), new


def braking_distance(case: Scenario, system: System, step: float) -> tuple[float, int]:
    """Braking distance (m) of a stop on rolling wheels by steps of `step` s, and how many it took.

    Raises ArithmeticError when a wheel comes to rest before the wagon does.
    """
    braking, free_wheels = case.braking, np.zeros(4, dtype=bool)
    motion, loads = equilibrium(system, braking.initial_speed)
    nothing = Accelerations(np.zeros(system.wagon.size), np.zeros(system.rail.size), loads)
    rolling, braked = Brake(False, free_wheels), Brake(True, free_wheels)
    now, before = _solve(system, rolling, motion, 0.0, nothing), round(braking.onset / step)
    for _ in range(before):
        motion, now = _step(system, rolling, motion, now, braking.onset / before)
    onset, steps = motion.q[S], before
    now = _solve(system, braked, motion, 0.0, now)  # the torque jumps: accelerations that agree with it
    while motion.u[S] > braking.stop_speed:
        last, (motion, now) = motion, _step(system, braked, motion, now, step)
        steps += 1
        if motion.u[list(PHI)].min() <= 0.0 < motion.u[S] - braking.stop_speed:
            raise ArithmeticError("a wheel locked")
    part = (last.u[S] - braking.stop_speed) / (last.u[S] - motion.u[S])
    return float(last.q[S] + part * (motion.q[S] - last.q[S]) - onset), steps
