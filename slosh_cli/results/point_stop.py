"""The stop of the wagon as a rigid point mass that never slips: what its brake comes to (theory section 12)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.line import gradient_at
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.wagon.torque import brake_torque, moved_mass, total_mass

_WHEELS = 8
_NODES = 40  # of the quadrature over speed


def tau_at(scenario: Scenario, speed: float) -> float:
    """Force of all brakes, fully applied at a `speed` (m/s), over the weight."""
    force = _WHEELS * brake_torque(scenario, speed) / scenario.wagon.wheelset.wheel_radius
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

    braking = scenario.braking
    starts = [braking.onset + stretch[0] for stretch in braking.application.stretches]

    def rates(time: float, state: Array) -> list[float]:
        place, speed = float(state[0]), float(state[1])
        return [speed, -_slowing(scenario, _applied(scenario, time), place, speed)]

    def above(_: float, state: Array) -> float:
        return float(state[1]) - braking.stop_speed

    above.terminal = True  # type: ignore[attr-defined]
    state, onset = np.array([0.0, braking.initial_speed]), (0.0, braking.initial_speed)
    for begin, end in pairwise([0.0, *starts, scenario.solver.time_limit]):
        if begin == braking.onset:
            onset = float(state[0]), float(state[1])
        if end <= begin:
            continue
        inside = end - 1e-12 * end  # the end itself belongs to the next stretch
        found = solve_ivp(rates, (begin, inside), state, events=above, rtol=1e-9, atol=1e-9, max_step=1.0)
        state = found.y[:, -1]
        if found.status == 1:
            return _ended(found.t[-1] - braking.onset, state - np.array([onset[0], 0.0]), onset[1])
    return None


def _ended(time: float, state: Array, first: float) -> PointStop | None:
    """The stop whose `state` is the way and the speed after a `time` (s) from the onset, `first` m/s there."""
    distance, last = float(state[0]), float(state[1])
    if time <= 0.0 or distance <= 0.0:
        return None
    return PointStop(distance, float(time), (first**2 - last**2) / (2.0 * distance))


def _applied(scenario: Scenario, time: float) -> float:
    """The application at a `time` (s), without the load changeover."""
    share, since = 0.0, time - scenario.braking.onset
    for start, base, slope, amplitude, rate in scenario.braking.application.stretches:
        if since >= start:
            share = base + slope * (since - start) + amplitude * math.exp(-rate * (since - start))
    return share


def _slowing(scenario: Scenario, applied: float, place: float, speed: float) -> float:
    """Deceleration (m/s^2) with a part of the brake `applied`, at a `place` (m) and a `speed` (m/s)."""
    wagon, mass = scenario.wagon, total_mass(scenario)
    resistance, radius = wagon.running_resistance, wagon.wheelset.wheel_radius
    drag = resistance.constant + resistance.linear * speed + resistance.quadratic * speed**2
    force = _WHEELS * brake_torque(scenario, speed, applied) / radius + drag
    force += STANDARD_GRAVITY * gradient_at(scenario, place) * mass
    return float(force / moved_mass(scenario))
