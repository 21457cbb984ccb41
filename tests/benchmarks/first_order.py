"""Contestant (d): the same semi-discrete equations as a first-order system for `scipy.integrate.solve_ivp`.

State: wagon coordinates and velocities (16 each), rail unknowns and their velocities (n each). The rail's mass matrix
is factored once. Its inverse is full but decays within a few elements; with what is negligible left out the Jacobian
is sparse; it is given in closed form. (With `jac_sparsity` and scipy's own differences neither method comes to an end:
the travelled way and the wheels' angles move nothing, so the increment for their columns grows until it overflows.)
Two kinds of tolerances: `USUAL`, one number for all with atol = rtol/1000 as in scipy's defaults, and `TUNED`, absolute
ones from the program's own scales.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from reference_code.plain_contact import creep_force, normal_force
from reference_code.plain_motion import PHI_DOFS, REACTION_DOFS, W_DOFS, Brake, System, _forces, equilibrium
from reference_code.plain_rail import BAND, times
from reference_code.plain_wagon import PHI, S
from scipy.integrate import solve_ivp
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.sparse import block_array, csc_array, dia_array, diags_array, eye_array

from slosh_cli.method import START
from slosh_cli.scenario import Scenario
from slosh_cli.solver.setup import problem
from slosh_cli.solver.vehicle import Scales

Array = NDArray[np.float64]
NEGLIGIBLE = 1e-4
"""Entries of the inverse mass matrix that the Jacobian leaves out, beside its diagonal."""


class FirstOrder:
    """Right-hand side of the stop; `torque` (N m) is switched on at the onset. Wheels roll throughout."""

    def __init__(self, system: System) -> None:
        self.system, self.torque = system, 0.0
        self.mass_factor = cholesky_banded(system.rail.mass_matrix[:4], check_finite=False)
        self.wagon_inverse = np.linalg.inv(system.wagon.mass)
        self.rail_inverse = _decaying_inverse(_sparse(system.rail.mass_matrix))

    @property
    def split(self) -> list[int]:
        """Where the state's four parts begin, but for the first."""
        size, n = self.system.wagon.size, self.system.rail.size
        return [size, 2 * size, 2 * size + n]

    def __call__(self, _: float, x: Array) -> Array:
        """Rates of all parts of the state."""
        wagon, rail, contact = self.system.wagon, self.system.rail, self.system.contact
        q, u, y, v = np.split(x, self.split)
        loads = contact.hertz * np.maximum(y[rail.wheel_dofs] - q[W_DOFS], 0.0) ** 1.5
        creep = creep_force(contact, loads, u[S] - wagon.wheel_radius * u[PHI_DOFS], u[S])
        force = wagon.weight - wagon.damping @ u - wagon.stiffness @ q
        force[S] -= creep.sum() + self.system.resisting_force(u[S])[0]
        force[W_DOFS] += loads
        force[PHI_DOFS] += creep * wagon.wheel_radius - self.torque
        np.add.at(force, REACTION_DOFS, self.torque)
        a = self.wagon_inverse @ force
        pressure = -times(rail.damping_matrix(u[S]), v) - times(rail.stiffness_matrix(u[S], a[S]), y)
        pressure[rail.wheel_dofs] -= loads
        rail_a = cho_solve_banded((self.mass_factor, False), pressure, check_finite=False)
        return np.concatenate([u, a, v, rail_a])

    def jacobian(self, _: float, x: Array) -> csc_array:
        """Sparse derivatives of the rates by the state; only `m A` is taken as given."""
        wagon, rail = self.system.wagon, self.system.rail
        q, u, y, v = np.split(x, self.split)
        loads, slope = normal_force(self.system.contact, y[rail.wheel_dofs] - q[W_DOFS])
        brake = Brake(self.torque > 0.0, np.zeros(4, dtype=bool))
        force, by_velocity, by_load = _forces(self.system, brake, u, loads)
        a = self.wagon_inverse @ (force - wagon.damping @ u - wagon.stiffness @ q)
        by_load = self.wagon_inverse @ by_load * slope
        by_place = -self.wagon_inverse @ wagon.stiffness
        by_place[:, W_DOFS] -= by_load
        by_rail = np.zeros((wagon.size, rail.size))
        by_rail[:, rail.wheel_dofs] = by_load
        pushed = self.rail_inverse[:, rail.wheel_dofs] @ diags_array(slope)
        to_wheels = csc_array((np.ones(4), (np.arange(4), W_DOFS)), shape=(4, wagon.size))
        to_rail = csc_array((np.ones(4), (np.arange(4), rail.wheel_dofs)), shape=(4, rail.size))
        drift = -2.0 * rail.mass * times(rail.I01, v) - 2.0 * rail.mass * u[S] * times(rail.I11, y)
        drift -= rail.damping * times(rail.I01, y) + rail.shear_damping * times(rail.I12, y)
        by_speed = csc_array(np.outer(self.rail_inverse @ drift, np.eye(wagon.size)[S]))
        blocks = [
            [None, eye_array(wagon.size), None, None],
            [by_place, self.wagon_inverse @ (by_velocity - wagon.damping), by_rail, None],
            [None, None, None, eye_array(rail.size)],
            [
                pushed @ to_wheels,
                -by_speed,
                -self.rail_inverse @ _sparse(rail.stiffness_matrix(u[S], a[S])) - pushed @ to_rail,
                -self.rail_inverse @ _sparse(rail.damping_matrix(u[S])),
            ],
        ]
        return csc_array(block_array(blocks))


def _sparse(band: Array) -> csc_array:
    """A band matrix of the plain implementation as a sparse one."""
    n = band.shape[1]
    return csc_array(dia_array((band, np.arange(BAND, -BAND - 1, -1)), shape=(n, n)))


def _decaying_inverse(mass: csc_array) -> csc_array:
    """Inverse of the rail's mass matrix without what is below `NEGLIGIBLE` beside its row and column."""
    inverse = np.linalg.inv(mass.toarray())
    size = np.sqrt(np.abs(np.diag(inverse)))
    return csc_array(np.where(np.abs(inverse) > NEGLIGIBLE * np.outer(size, size), inverse, 0.0))


def allowances(scales: Scales, size: int, rail: int, sag: float) -> Array:
    """Scales of the state's parts for absolute tolerances: the program's own, and its share of the rail's sag (m)."""
    share = scales.speed[1] / scales.place[1]  # 1/s, from a place's scale to its rate's
    places = np.where(np.isfinite(scales.place), scales.place, scales.speed * 1.0)
    modes = size - places.size
    slosh = np.full(modes, scales.slosh)
    deflection = np.full(rail, 32.0 * sag)
    return np.concatenate([places, slosh, scales.speed, slosh, deflection, deflection * share])


USUAL, TUNED = "usual", "tuned"


def _options(equations: FirstOrder, case: Scenario, use: str, tolerance: float) -> dict[str, object]:
    if use == USUAL:
        return {"rtol": tolerance, "atol": 1e-3 * tolerance}
    vehicle = problem(case).vehicle
    sag = float(np.abs(vehicle.points[START].rail).max())
    scales = allowances(vehicle.scales, equations.system.wagon.size, equations.system.rail.size, sag)
    return {"rtol": 1e-3 * tolerance, "atol": tolerance * scales}


def braking_distance(
    case: Scenario, system: System, method: Literal["BDF", "Radau"], use: str, tolerance: float, until: float = 100.0
) -> tuple[float | None, dict[str, int]]:
    """Braking distance (m) of the stop and the work it took; None where it ends by `until` (s) without a stop.

    Raises ArithmeticError when the integration fails or a wheel does not roll on (beyond what tolerances blur).
    """
    equations, work = FirstOrder(system), {"evaluations": 0, "jacobians": 0, "factorisations": 0, "steps": 0}
    options = _options(equations, case, use, tolerance)
    motion, _ = equilibrium(system, case.braking.initial_speed)
    x, size, onset = np.concatenate([motion.q, motion.u, motion.y, motion.v]), system.wagon.size, 0.0

    def slow(_: float, state: Array) -> float:
        return float(state[size] - case.braking.stop_speed)

    slow.terminal = True  # type: ignore[attr-defined]
    brake_on = case.braking.onset
    for torque, begin, end in ((0.0, 0.0, min(brake_on, until)), (case.braking.torque, brake_on, until)):
        if end <= begin:
            break
        equations.torque, onset = torque, float(x[S])
        found = solve_ivp(
            equations, (begin, end), x, method=method, events=slow, jac=equations.jacobian, first_step=1e-4, **options
        )
        backwards = -0.01 * case.braking.initial_speed / system.wagon.wheel_radius
        if found.status < 0 or found.y[size + np.array(PHI)].min() < backwards:
            raise ArithmeticError(f"solve_ivp ended with: {found.message}")
        x = found.y[:, -1]
        work["evaluations"] += int(found.nfev)
        work["jacobians"] += int(found.njev)
        work["factorisations"] += int(found.nlu)
        work["steps"] += found.t.size - 1
    return (float(x[S]) - onset if found.status == 1 else None), work
