"""The stop of the wagon as a rigid point mass that never slips: what its brake comes to (theory section 12)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.recommendation import total_mass
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.wagon.brake import Brake, brake_of

_WHEELS = 8
_NODES = 40  # of the quadrature over speed


def tau_at(scenario: Scenario, speed: float) -> float:
    """Force of all brakes, fully applied at a `speed` (m/s), over the weight."""
    force = _WHEELS * scenario.brake_torque(speed) / scenario.wagon.wheelset.wheel_radius
    return force / (total_mass(scenario) * STANDARD_GRAVITY)


def mean_tau(scenario: Scenario) -> float:
    """The same of the constant brake that, fully applied, stops the wagon over the same distance without resistance."""
    last, first = scenario.braking.stop_speed, scenario.braking.initial_speed
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    speeds = 0.5 * (first + last) + 0.5 * (first - last) * nodes
    taus = np.array([tau_at(scenario, float(speed)) for speed in speeds])
    if np.any(taus <= 0.0):
        return 0.0
    return float(np.sum(weights * speeds) / np.sum(weights * speeds / taus))


@dataclass(frozen=True)
class PointStop:
    """`distance` (m) and `time` (s) from the onset to the stop speed, and the mean `deceleration` (m/s^2) on it."""

    distance: float
    time: float
    deceleration: float


def point_stop(scenario: Scenario) -> PointStop | None:
    """The stop with running resistance, the brake's build-up and the track's gradient; None where it does not stop."""
    from scipy.integrate import solve_ivp

    brake, braking = brake_of(scenario), scenario.braking

    def rates(time: float, state: Array) -> list[float]:
        return [float(state[1]), -_slowing(scenario, _share(brake, time), float(state[1]))]

    def above(_: float, state: Array) -> float:
        return float(state[1]) - braking.stop_speed

    above.terminal = True  # type: ignore[attr-defined]
    state, onset = np.array([0.0, braking.initial_speed]), (0.0, braking.initial_speed)
    for begin, end in pairwise([0.0, *brake.starts, scenario.solver.time_limit]):
        if end > begin:
            if begin >= braking.onset > 0.0 and begin == brake.starts[0]:
                onset = float(state[0]), float(state[1])
            inside = end - 1e-12 * end  # the end itself belongs to the next stretch
            found = solve_ivp(rates, (begin, inside), state, events=above, rtol=1e-9, atol=1e-9, max_step=1.0)
            state, last = found.y[:, -1], float(found.t[-1])
            if found.status == 1:
                distance = float(state[0]) - onset[0]
                if last <= braking.onset or distance <= 0.0:
                    return None
                slowed = (onset[1] ** 2 - float(state[1]) ** 2) / (2.0 * distance)
                return PointStop(distance, last - braking.onset, slowed)
    return None


def _share(brake: Brake, time: float) -> float:
    """The application of a brake at a `time` (s)."""
    k = int(np.searchsorted(brake.starts, time, side="right")) - 1
    if k < 0:
        return 0.0
    since = time - float(brake.starts[k])
    fading = float(brake.amplitude[k]) * np.exp(-float(brake.rate[k]) * since)
    return float(brake.base[k] + brake.slope[k] * since + fading)


def _slowing(scenario: Scenario, share: float, speed: float) -> float:
    """Deceleration (m/s^2) at a `share` of the full application and a `speed` (m/s)."""
    wagon, mass = scenario.wagon, total_mass(scenario)
    resistance, radius = wagon.running_resistance, wagon.wheelset.wheel_radius
    drag = resistance.constant + resistance.linear * speed + resistance.quadratic * speed**2
    force = _WHEELS * share * scenario.brake_torque(speed) / radius + drag
    force += STANDARD_GRAVITY * scenario.track.gradient * mass
    return float(force / (mass + 4.0 * wagon.wheelset.spin_inertia / radius**2))
