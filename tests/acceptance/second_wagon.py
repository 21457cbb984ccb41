"""Half a wagon with a rigid load on a rigid rail, once more: energies, forces and laws written anew for scipy.

Nothing of the solver is used, and no law of its brakes. Matrices come from the quadratic energies of theory sections
2 and 3 by polarisation: `A_ij = E(e_i + e_j) - E(e_i) - E(e_j)`. Locks and releases begin a new integration.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from slosh_cli.validation.exact.friction import friction_law

GRAVITY = 9.81
# s; car w, theta; bogies w, theta; four wheels' w; their rotations
CAR, BOGIES, WHEELS, SPINS = (1, 2), ((3, 4), (5, 6)), slice(7, 11), slice(11, 15)
SIZE = 15
FRAME = np.array([4, 4, 6, 6])  # pitch of the bogie above each wheel


def pressed(count: int, force: float, arm: float, law) -> Callable:
    """Torques (N m) at treads' speeds (m/s) and an application: blocks at the wheel's radius, or discs at their own.

    `force` in kN; `law` as in `friction_law`.
    """
    mu = friction_law(law)
    return lambda speeds, share: np.array(
        [1e3 * count * mu(3.6 * v, share * force) * share * force * arm for v in speeds]
    )


def ramp(time: float) -> Callable:
    """Full after `time` s, linear until then."""
    return lambda since: min(since / time, 1.0)


def filling(time_95: float, delay: float = 0.0, jump: float = 0.10) -> Callable:
    """0.95 after `time_95` s, from `jump` after `delay` s on; at the jump itself what was before it."""
    rate = np.log((1 - jump) / 0.05) / (time_95 - delay)
    return lambda since: 0.0 if since <= delay else 1 - (1 - jump) * np.exp(-rate * (since - delay))


@dataclass(frozen=True)
class Brake:
    """`torque(speeds, share)` (N m) of a wheel, `application(time since the onset)`, and where the latter has kinks."""

    torque: Callable
    application: Callable = lambda _: 1.0
    kinks: tuple[float, ...] = ()


def hertz(scenario) -> tuple[float, float]:
    """Stiffness (N/m^1.5) and `a b / N^(2/3)` (m^2/N^(2/3)) of a tread on a rail head (Johnson, section 4.2)."""
    steel = scenario.contact
    curvatures = sorted((0.5 / scenario.wagon.wheelset.wheel_radius, 0.5 / steel.rail_crown_radius))
    modulus = steel.youngs_modulus / (2 * (1 - steel.poisson_ratio**2))

    def sides(m):  # m = e^2 = 1 - (b/a)^2
        return (ellipk(m) - ellipe(m)) / m, (ellipe(m) / (1 - m) - ellipk(m)) / m

    m = brentq(lambda m: sides(m)[1] / sides(m)[0] - curvatures[1] / curvatures[0], 1e-6, 0.99, xtol=1e-15)
    a = (1.5 / (np.pi * modulus) * sides(m)[0] / curvatures[0]) ** (1 / 3)
    approach = 1.5 * ellipk(m) / (np.pi * modulus * a)
    return steel.stiffness or approach**-1.5, a**2 * np.sqrt(1 - m)


def frozen(tank) -> tuple[float, float, float]:
    """Mass (kg), height of the centre above the bottom (m), pitch inertia about it (kg m^2): a lying cylinder."""
    R, depth = tank.radius, 2 * tank.radius * tank.fill
    area, first, second = (
        quad(lambda z, p=p: 2 * np.sqrt(max(z * (2 * R - z), 0)) * z**p, 0, depth, epsabs=1e-13)[0] for p in (0, 1, 2)
    )
    mass, centre = tank.liquid.density * tank.length * area, first / area
    return mass, centre, mass * (tank.length**2 / 12 + second / area - centre**2)


def polarised(energy: Callable) -> np.ndarray:
    """Matrix A of a quadratic form, energy(x) = x A x / 2."""
    unit = np.eye(SIZE)
    alone = [energy(row) for row in unit]
    return np.array([[energy(unit[i] + unit[j]) - alone[i] - alone[j] for j in range(SIZE)] for i in range(SIZE)])


class SecondWagon:
    """Matrices and forces of half of a scenario's wagon under a brake."""

    def __init__(self, scenario, brake: Brake) -> None:
        self.scenario, self.wagon, self.brake = scenario, scenario.wagon, brake
        self.radius = self.wagon.wheelset.wheel_radius
        self.load = frozen(scenario.tank)
        self.mass = polarised(self._kinetic)
        self.inverse = np.linalg.inv(self.mass)
        self.stiffness, self.damping = polarised(self._potential), polarised(self._dissipation)
        self.weight = np.zeros(SIZE)
        self.weight[CAR[0]] = -GRAVITY * (self.wagon.car_body.mass + self.load[0]) / 2
        self.weight[[3, 5]] = -GRAVITY * self.wagon.bogie.mass / 2
        self.weight[WHEELS] = -GRAVITY * self.wagon.wheelset.mass / 2
        self.hertz, self.ellipse = hertz(scenario)

    def _kinetic(self, v) -> float:
        """Of half of the wagon (theory sections 2 and 3)."""
        wagon, (load, centre, turning) = self.wagon, self.load
        above = wagon.traction_height - self.radius

        def car(height):
            return v[0] + above * (v[4] + v[6]) / 2 + v[2] * (height - wagon.traction_height)

        body = wagon.car_body
        whole = body.mass * (car(body.centre_height) ** 2 + v[1] ** 2) + body.pitch_inertia * v[2] ** 2
        whole += load * ((car(self.scenario.tank.bottom_height) + centre * v[2]) ** 2 + v[1] ** 2) + turning * v[2] ** 2
        frame = wagon.bogie
        for w, theta in BOGIES:
            along = v[0] + v[theta] * (frame.centre_height - self.radius)
            whole += frame.mass * (along**2 + v[w] ** 2) + frame.pitch_inertia * v[theta] ** 2
        wheels = wagon.wheelset
        whole += wheels.mass * (4 * v[0] ** 2 + v[WHEELS] @ v[WHEELS]) + wheels.spin_inertia * v[SPINS] @ v[SPINS]
        return 0.25 * whole  # one half as in every kinetic energy, and half of the wagon

    def _elongations(self, q):
        """Of the four primary and the two secondary units; a point X ahead sinks by theta X."""
        a, b = self.wagon.bogie.wheelbase / 2, self.wagon.pivot_spacing / 2
        primary = [q[3] - a * q[4] - q[7], q[3] + a * q[4] - q[8], q[5] - a * q[6] - q[9], q[5] + a * q[6] - q[10]]
        secondary = [q[1] - b * q[2] - q[3], q[1] + b * q[2] - q[5]]
        return np.array(primary), np.array(secondary)

    def _potential(self, q) -> float:
        primary, secondary = self._elongations(q)
        stored = self.wagon.primary_suspension.stiffness * primary @ primary
        stored += self.wagon.secondary_suspension.stiffness * secondary @ secondary
        return 0.5 * (stored - self.load[0] / 2 * GRAVITY * self.load[1] * q[2] ** 2)

    def _dissipation(self, v) -> float:
        primary, secondary = self._elongations(v)
        lost = self.wagon.primary_suspension.damping * primary @ primary
        return 0.5 * (lost + self.wagon.secondary_suspension.damping * secondary @ secondary)

    def loads(self, q) -> np.ndarray:
        """Wheel loads in N; `q` (15,) or (15, n)."""
        return self.hertz * np.maximum(-q[WHEELS], 0.0) ** 1.5

    def creep(self, N, slip, speed):
        """Polach's force on the rail, rearwards on the wagon, N."""
        steel, p = self.scenario.contact, self.scenario.contact.adhesion
        N = np.maximum(N, 1e-9)
        mu = p.mu0 * ((1 - p.A) * np.exp(-p.B * np.abs(slip)) + p.A)
        shear = steel.youngs_modulus / 2 / (1 + steel.poisson_ratio)
        eps = shear * np.pi * self.ellipse * N ** (2 / 3) * steel.kalker_c11 * slip / max(abs(speed), 0.05)
        eps = eps / (4 * mu * N)
        return 2 * mu * N / np.pi * (p.kA * eps / (1 + (p.kA * eps) ** 2) + np.arctan(p.kS * eps))

    def tangential(self, time: float, state, braking: bool):
        """Creep forces (4,) in N, and the torques (4,) in N m that the brakes can hold."""
        q, v = state[:SIZE], state[SIZE:]
        spins = v[SPINS]
        f = self.creep(self.loads(q), v[0] - self.radius * spins, v[0])
        if not braking:
            return f, np.zeros(4)
        share = self.brake.application(time - self.scenario.braking.onset)
        return f, self.brake.torque(self.radius * np.maximum(spins, 0.0), share) + np.zeros(4)

    def transmitted(self, time: float, state, braking: bool, locked):
        """Creep forces (4,) in N and torques (4,) in N m; `locked` (4,) says which wheels stand."""
        f, T = self.tangential(time, state, braking)
        return f, np.where(locked, f * self.radius, T)

    def slope(self, time: float, state, braking: bool, locked):
        """Rate of (q, q')."""
        q, v = state[:SIZE], state[SIZE:]
        terms, V = self.wagon.running_resistance, v[0]
        f, T = self.transmitted(time, state, braking, locked)
        force = self.weight - self.stiffness @ q - self.damping @ v
        force[0] -= f.sum() + (terms.constant + terms.linear * V + terms.quadratic * V**2) / 2
        force[WHEELS] += self.loads(q)
        force[SPINS] += f * self.radius - T
        np.add.at(force, FRAME, T)
        return np.concatenate([v, self.inverse @ force])

    def settled(self) -> np.ndarray:
        """The state at t = 0: static equilibrium, wheels that roll."""
        q, V = np.zeros(SIZE), self.scenario.braking.initial_speed
        q[WHEELS] = -((-self.weight.sum() / 4 / self.hertz) ** (2 / 3))
        on_bogie = -self.weight[1] / 2
        on_wheel = (on_bogie - self.weight[3]) / 2
        q[[3, 5]] = q[7] - on_wheel / self.wagon.primary_suspension.stiffness
        q[1] = q[3] - on_bogie / self.wagon.secondary_suspension.stiffness
        v = np.zeros(SIZE)
        v[0], v[SPINS] = V, V / self.radius
        return np.concatenate([q, v])


@dataclass(frozen=True)
class Histories:
    """At each `time` (n,) s: states (30, n), wheel loads and torques (4, n) in N and N m.

    `changes`: time (s) of every lock and release, the wheel from 0 on, and whether it stands from then on.
    """

    time: np.ndarray
    states: np.ndarray
    loads: np.ndarray
    torques: np.ndarray
    distance: float
    changes: tuple[tuple[float, int, bool], ...]


def _events(wagon: SecondWagon, braking: bool, locked):
    """The stop, and for each wheel what turns negative when it locks or is released."""

    def stands(_, x):
        return x[SIZE] - wagon.scenario.braking.stop_speed

    def wheel(i):
        def changes(t, x):
            if not locked[i]:
                return x[SIZE + 11 + i]
            f, T = wagon.tangential(t, x, braking)
            return T[i] - f[i] * wagon.radius

        return changes

    events = [stands, *(wheel(i) for i in range(4))]
    for event in events:
        event.terminal, event.direction = True, -1
    return events


def second_stop(scenario, brake: Brake, times, rtol: float = 1e-9, method: str = "Radau") -> Histories:
    """The stop at those of `times` (s) that it lasts to; every piece ends at a kink of the application or a lock."""
    wagon, onset = SecondWagon(scenario, brake), scenario.braking.onset
    scale = np.repeat([1e-3, 1.0], SIZE)  # m or rad, and m/s or rad/s
    ends = [onset, *(onset + kink for kink in brake.kinks), scenario.solver.time_limit]
    state, begin, pieces, changes = wagon.settled(), 0.0, [], []
    locked, at_onset, stopped = np.zeros(4, bool), 0.0, False
    while not stopped:
        end = min(one for one in ends if one > begin)
        still = (begin >= onset, locked.copy())
        run = solve_ivp(
            lambda t, x, still=still: wagon.slope(t, x, *still), (begin, end), state, method,
            rtol=rtol, atol=rtol * scale, events=_events(wagon, *still), dense_output=True,
        )  # fmt: skip
        assert run.success, run.message
        within = times[(times > begin if pieces else times >= begin) & (times <= run.t[-1])]  # a jump's left side
        states = run.sol(within) if within.size else np.empty((2 * SIZE, 0))
        torques = [wagon.transmitted(t, x, *still)[1] for t, x in zip(within, states.T, strict=True)]
        pieces.append((within, states, np.array(torques).reshape(-1, 4).T))
        state, begin = run.y[:, -1].copy(), run.t[-1]
        at_onset = state[0] if begin == onset else at_onset
        stopped = bool(run.t_events[0].size) or begin == scenario.solver.time_limit
        for i in range(4):
            if run.t_events[1 + i].size:
                locked[i] = not locked[i]
                state[SIZE + 11 + i] = 0.0
                changes.append((begin, i, bool(locked[i])))
    time, states, torques = (np.concatenate(part, axis=-1) for part in zip(*pieces, strict=True))
    return Histories(time, states, wagon.loads(states[:SIZE]), torques, float(state[0] - at_onset), tuple(changes))
