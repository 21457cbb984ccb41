"""The torque that a scenario's brake gives at full application (theory section 12)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from slosh_cli.errors import PhysicsError
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.amounts import tare_of
from slosh_cli.tank.load import frozen_load

_DELAY, _BUILD_UP = 0.2, 4.0
"""Of the build-up that belongs to the braked weight percentage, s: idle, then even."""
_KM_H = 3.6  # of a metre per second
_WHEELS = 8


def total_mass(scenario: Scenario) -> float:
    """Mass of the whole wagon with its load, kg."""
    return tare_of(scenario.wagon) + frozen_load(scenario.tank).mass


def moved_mass(scenario: Scenario) -> float:
    """The same with what the wheels' rotation adds along the track, kg."""
    wheelset = scenario.wagon.wheelset
    return total_mass(scenario) + 4.0 * wheelset.spin_inertia / wheelset.wheel_radius**2


def changeover_share(scenario: Scenario) -> float:
    """The part of the application that the load changeover leaves; 1 without one."""
    changeover = scenario.braking.load_changeover
    return changeover.empty_share if changeover and total_mass(scenario) < changeover.gross_mass else 1.0


def brake_torque(scenario: Scenario, speed: float, applied: float = 1.0) -> float:
    """Torque (N m) of a wheel that rolls at `speed` (m/s) with a part of the brake `applied`; of it the load changeover
    leaves its share."""
    rubbing, left = scenario.braking.rubbing, applied * changeover_share(scenario)
    if rubbing is None:
        return left * constant_torque(scenario)
    force = left * rubbing.force
    friction, _ = rubbing.friction.friction(_KM_H * max(speed, 0.0), 1e-3 * force)
    return rubbing.count * friction * force * rubbing.arm(scenario.wagon.wheelset.wheel_radius)


def nominal_torque(scenario: Scenario) -> float:
    """The same at the initial speed."""
    return brake_torque(scenario, scenario.braking.initial_speed)


def constant_torque(scenario: Scenario) -> float:
    """Torque (N m) of a wheel, told as it is, by a deceleration or by a braked weight; without the changeover."""
    braking, radius = scenario.braking, scenario.wagon.wheelset.wheel_radius
    if braking.deceleration is not None:
        return radius * braking.deceleration * moved_mass(scenario) / _WHEELS
    if braking.braked_weight is not None:
        terms = scenario.wagon.running_resistance
        resistance = (terms.constant, terms.linear, terms.quadratic)
        sign = braking.braked_weight
        return radius * _braking_force(moved_mass(scenario), resistance, sign.speed, sign.distance) / _WHEELS
    assert braking.torque is not None
    return braking.torque


@lru_cache(maxsize=64)
def _braking_force(mass: float, resistance: tuple[float, float, float], speed: float, distance: float) -> float:
    """Braking force (N) that stops a rigid wagon within `distance` (m), built up as for a braked weight percentage."""

    def too_far(force: float) -> float:
        return _stopping_distance(mass, resistance, speed, force) - distance

    most = mass * speed / _BUILD_UP  # stops within the build-up
    if too_far(0.0) < 0.0:
        raise PhysicsError(
            f"The running resistance alone stops the wagon in less than the {distance:.0f} m of its braked weight: "
            "lower wagon.running_resistance or a larger percentage.",
            "braking.braked_weight",
        )
    while too_far(most) > 0.0:
        most *= 2.0
    return float(brentq(too_far, 0.0, most, xtol=1e-9 * most, rtol=1e-12))


def _stopping_distance(mass: float, resistance: tuple[float, float, float], speed: float, force: float) -> float:
    """Distance (m) from the command to rest; infinite where nothing stops the wagon."""
    constant, linear, quadratic = resistance

    def slowing(v: float, applied: float) -> float:
        return (applied * force + constant + linear * v + quadratic * v * v) / mass

    def rates(time: float, state: np.ndarray) -> tuple[float, float]:
        return state[1], -slowing(max(state[1], 0.0), min(max(time - _DELAY, 0.0) / _BUILD_UP, 1.0))

    def at_rest(_: float, state: np.ndarray) -> float:
        return float(state[1])

    at_rest.terminal = True  # type: ignore[attr-defined]
    place, v = 0.0, speed
    for begin, end in ((0.0, _DELAY), (_DELAY, _DELAY + _BUILD_UP)):
        part = solve_ivp(rates, (begin, end), (place, v), rtol=1e-11, atol=1e-11, events=at_rest)
        place, v = part.y[:, -1]
        if part.status == 1:
            return float(place)
    if slowing(0.0, 1.0) <= 0.0:
        return float("inf")
    return float(place + quad(lambda u: u / slowing(u, 1.0), 0.0, v, epsrel=1e-11)[0])
