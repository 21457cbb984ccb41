"""Equations of motion of wagon, contact and rail, and the solution of one implicit stage.

The wagon's accelerations and the four wheel loads are Newton's unknowns; the rail enters through its
condensed form ``deflection under the wheels = y0 - G N``, exact for the speed and acceleration it was made
with. When Newton's method has moved speed or acceleration, it is made again.
"""

from dataclasses import dataclass

import numpy as np

from . import plain_rail
from .plain_contact import Contact, contact_of, creep_force, creep_force_and_slopes, normal_force
from .plain_rail import Rail, rail_of, times
from .plain_wagon import BOGIE_OF_WHEEL, PHI, THETA_BOGIE, W_WHEEL, S, Wagon, half_wagon

MAX_ITERATIONS = 40
PHI_DOFS, W_DOFS = list(PHI), list(W_WHEEL)
REACTION_DOFS = [THETA_BOGIE[bogie] for bogie in BOGIE_OF_WHEEL]


class NotConvergedError(ArithmeticError):
    """A stage was not solved within the allowed iterations."""


@dataclass(frozen=True)
class Brake:
    """What the brakes do during a step: whether they are on, and which wheels stand still, (4,)."""

    on: bool
    locked: np.ndarray


@dataclass(frozen=True)
class Motion:
    """Positions and velocities of wagon (q, u) and rail (y, v)."""

    q: np.ndarray
    u: np.ndarray
    y: np.ndarray
    v: np.ndarray


@dataclass(frozen=True)
class Stage:
    """A solved stage: the motion, the wagon's and rail's accelerations, wheel loads and creep forces (4,)."""

    motion: Motion
    a: np.ndarray
    rail_a: np.ndarray
    N: np.ndarray
    f: np.ndarray


@dataclass(frozen=True)
class System:
    """Everything that stays the same during a stop."""

    wagon: Wagon
    rail: Rail
    contact: Contact
    torque: float
    resistance: tuple[float, float, float]  # of the half wagon, polynomial in speed

    def resisting_force(self, V: float) -> tuple[float, float]:
        """Running resistance of the half wagon and its slope."""
        a, b, c = self.resistance
        return a + b * V + c * V**2, b + 2.0 * c * V

    def transmitted_torque(self, brake: Brake, f: np.ndarray) -> np.ndarray:
        """Torque between wheel and bogie: nominal while it turns, what holds it while it is locked."""
        rolling = self.torque if brake.on else 0.0
        return np.where(brake.locked, f * self.wagon.wheel_radius, rolling)

    def slip(self, u: np.ndarray) -> np.ndarray:
        """Slip velocity of each wheel, s' - R phi'."""
        return u[S] - self.wagon.wheel_radius * u[PHI_DOFS]

    def creep(self, motion: Motion, N: np.ndarray) -> np.ndarray:
        """Creep force of each wheel."""
        return creep_force(self.contact, N, self.slip(motion.u), motion.u[S])


def system_of(scenario, element_length: float | None = None) -> System:
    """Assemble wagon, rail and contact of a scenario."""
    wagon = half_wagon(scenario)
    running = scenario.wagon.running_resistance
    return System(
        wagon,
        rail_of(scenario, wagon.axle_positions, element_length),
        contact_of(scenario),
        scenario.braking.torque,
        (running.constant / 2.0, running.linear / 2.0, running.quadratic / 2.0),
    )


def equilibrium(system: System, speed: float) -> tuple[Motion, np.ndarray]:
    """Wagon at rest on its springs and rail in its steady shape at ``speed``, and the wheel loads.

    Only the vertical and pitch coordinates take part: the liquid surface stays level in the tank (beta = 0).
    """
    wagon, rail = system.wagon, system.rail
    shapes = plain_rail.solve(rail.stiffness_matrix(speed, 0.0), rail.wheel_loads())
    compliance = shapes[rail.wheel_dofs]
    bodies = slice(1, PHI[0])
    stiffness, weight = wagon.stiffness[bodies, bodies], wagon.weight[bodies]
    lift = np.zeros((len(weight), 4))
    lift[np.array(W_DOFS) - 1, range(4)] = 1.0
    N = np.full(4, -weight.sum() / 4.0)
    for _ in range(MAX_ITERATIONS):
        approach = np.cbrt(N / system.contact.hertz) ** 2
        slope = 2.0 / 3.0 * approach / N
        # K q - lift N = weight, lift^T q = -G N - delta(N), linearised about the present N
        matrix = np.block([[stiffness, -lift], [lift.T, compliance + np.diag(slope)]])
        solution = np.linalg.solve(matrix, np.concatenate([weight, slope * N - approach]))
        change = solution[len(weight) :] - N
        N = N + change
        if np.max(np.abs(change)) < 1e-8 * np.max(N):
            break
    else:
        raise ArithmeticError("static equilibrium of wagon and rail was not found")
    q, u = np.zeros(wagon.size), np.zeros(wagon.size)
    q[bodies] = solution[: len(weight)]
    u[S], u[PHI_DOFS] = speed, speed / wagon.wheel_radius
    return Motion(q, u, -shapes @ N, np.zeros(rail.size)), N


def condense(system: System, base: Motion, tau: float, V: float, A: float) -> tuple[np.ndarray, np.ndarray]:
    """Rail accelerations at a stage, without load (n,) and per unit downward load under each wheel (n, 4).

    Stage values are ``v = base.v + tau a`` and ``y = base.y + tau v``.
    """
    rail = system.rail
    damping, stiffness = rail.damping_matrix(V), rail.stiffness_matrix(V, A)
    right = np.empty((rail.size, 5), order="F")
    right[:, 0] = -times(damping, base.v) - times(stiffness, base.y + tau * base.v)
    right[:, 1:] = -rail.wheel_loads()
    accelerations = plain_rail.solve(rail.mass_matrix + tau * damping + tau**2 * stiffness, right)
    return accelerations[:, 0], accelerations[:, 1:]


def _forces(system: System, brake: Brake, u: np.ndarray, N: np.ndarray):
    """Force on the wagon (weight, contact, brake, resistance) and its slopes in u and in N."""
    wagon, radius = system.wagon, system.wagon.wheel_radius
    f, f_N, f_slip, f_speed = creep_force_and_slopes(system.contact, N, system.slip(u), u[S])
    rolling = ~brake.locked
    by_creep = np.zeros((wagon.size, 4))  # generalised force per unit creep force
    by_creep[S] = -1.0
    by_creep[PHI_DOFS, range(4)] = radius * rolling
    by_creep[REACTION_DOFS, range(4)] = radius * brake.locked
    by_load = by_creep * f_N
    by_load[W_DOFS, range(4)] += 1.0
    slopes = np.zeros((4, wagon.size))  # of the creep forces in u
    slopes[:, S] = f_slip + f_speed
    slopes[range(4), PHI_DOFS] = -radius * f_slip
    by_velocity = by_creep @ slopes
    force = wagon.weight + by_creep @ f
    force[W_DOFS] += N
    if brake.on:
        force[PHI_DOFS] -= system.torque * rolling
        np.add.at(force, REACTION_DOFS, system.torque * rolling)
    resistance, slope = system.resisting_force(u[S])
    force[S] -= resistance
    by_velocity[S, S] -= slope
    return force, by_velocity, by_load


def solve_stage(system: System, brake: Brake, base: Motion, tau: float, guess) -> Stage:
    """Find the accelerations for which ``u = base.u + tau a``, ``q = base.q + tau u`` satisfy all equations.

    ``guess`` (a State or Stage) lends its ``a`` and ``N`` to begin with. Raises NotConvergedError when
    Newton's method does not converge.
    """
    wagon, wheel_dofs = system.wagon, system.rail.wheel_dofs
    size, a, N = wagon.size, guess.a, guess.N
    residual = np.zeros(size + 4)
    linear = wagon.mass + tau * wagon.damping + tau**2 * wagon.stiffness
    held = np.array(PHI_DOFS)[brake.locked]
    made_with = (np.inf, np.inf)
    for _ in range(MAX_ITERATIONS):
        u = base.u + tau * a
        q = base.q + tau * u
        remade = abs(u[S] - made_with[0]) > 1e-7 or abs(a[S] - made_with[1]) > 1e-5
        if remade:
            made_with = (u[S], a[S])
            free, per_load = condense(system, base, tau, *made_with)
            y0 = base.y[wheel_dofs] + tau * base.v[wheel_dofs] + tau**2 * free[wheel_dofs]
            compliance = -(tau**2) * per_load[wheel_dofs]
        force, by_velocity, by_load = _forces(system, brake, u, N)
        normal, contact_slope = normal_force(system.contact, y0 - compliance @ N - q[W_DOFS])
        residual[:size] = wagon.mass @ a + wagon.damping @ u + wagon.stiffness @ q - force
        residual[size:] = N - normal
        approach = np.zeros((4, size))
        approach[range(4), W_DOFS] = tau**2 * contact_slope
        jacobian = np.block(
            [
                [linear - tau * by_velocity, -by_load],
                [approach, np.eye(4) + contact_slope[:, None] * compliance],
            ]
        )
        jacobian[held] = np.eye(size + 4)[held]  # a locked wheel does not turn
        residual[held] = a[held]
        change = np.linalg.solve(jacobian, -residual)
        a, N = a + change[:size], N + change[size:]
        small = tau * np.max(np.abs(change[:size])) < 1e-10 and np.max(np.abs(change[size:])) < 1e-3
        if small and not remade:
            N = np.maximum(N, 0.0)
            rail_a = free + per_load @ N
            u, v = base.u + tau * a, base.v + tau * rail_a
            motion = Motion(base.q + tau * u, u, base.y + tau * v, v)
            return Stage(motion, a, rail_a, N, system.creep(motion, N))
    raise NotConvergedError("Newton's method did not converge in a stage")
