"""The paper's wagon as a handful of numbers and a point mass, straight from the scenario."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from slosh_cli.scenario import HorizontalCylinder, Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY


@dataclass(frozen=True)
class PointWagon:
    """A whole wagon that only rolls: mass (kg) with load, wheels as m = 4 I/R^2, resistance a + b V + c V^2 (N)."""

    mass: float
    rotating_mass: float
    wheel_radius: float
    resistance_terms: tuple[float, float, float]

    def resistance(self, speed: float) -> float:
        """Running resistance (N) at `speed` (m/s)."""
        a, b, c = self.resistance_terms
        return a + b * speed + c * speed**2

    @property
    def wheel_load(self) -> float:
        """Static load of one of the eight wheels, N."""
        return STANDARD_GRAVITY * self.mass / 8


def segment_area(radius: float, fill: float) -> float:
    """Area of a circle's part below `fill` of its diameter, m^2."""
    half_angle = np.arccos(1 - 2 * fill)
    return float(radius**2 * (half_angle - np.sin(half_angle) * np.cos(half_angle)))


def _liquid_mass(scenario: Scenario) -> float:
    """Mass of the liquid in a horizontal cylinder, kg."""
    tank = scenario.tank
    if not isinstance(tank, HorizontalCylinder):
        raise TypeError(f"the tank must be a horizontal cylinder, but is {tank.shape}")
    return tank.liquid.density * tank.length * segment_area(tank.radius, tank.fill)


def point_wagon(scenario: Scenario) -> PointWagon:
    """Add the wagon up."""
    wagon = scenario.wagon
    mass = wagon.car_body.mass + 2 * wagon.bogie.mass + 4 * wagon.wheelset.mass + _liquid_mass(scenario)
    radius = wagon.wheelset.wheel_radius
    terms = wagon.running_resistance
    return PointWagon(
        mass, 4 * wagon.wheelset.spin_inertia / radius**2, radius, (terms.constant, terms.linear, terms.quadratic)
    )


def stopping(
    wagon: PointWagon, speed: float, torque: Callable[[float], float], onset: float, stop: float, creepage: float
) -> tuple[float, float]:
    """Braking distance (m) and time (s) from the onset, by quadrature; `torque` (N m) of a wheel at a speed (m/s).

    `(m + m_rot (1 - nu)) dV/dt = -(8 T/R + a + b V + c V^2)` with the creepage nu of braked wheels; at the onset the
    wheels give up `nu m_rot V` of their momentum. Before it only resistance acts, for `onset` s.
    """
    from scipy.integrate import quad
    from scipy.optimize import brentq

    def coasting(v: float) -> float:
        return (wagon.mass + wagon.rotating_mass) / wagon.resistance(v)

    def late(v: float) -> float:
        return float(quad(coasting, v, speed, epsrel=1e-13)[0]) - onset

    v = float(brentq(late, 0.9 * speed, speed, xtol=1e-14))
    v *= 1 + creepage * wagon.rotating_mass / (wagon.mass + wagon.rotating_mass)
    moving = wagon.mass + (1 - creepage) * wagon.rotating_mass

    def slowing(v: float) -> float:
        return moving / (8 * torque(v) / wagon.wheel_radius + wagon.resistance(v))

    distance = quad(lambda v: v * slowing(v), stop, v, epsrel=1e-12)[0]
    return float(distance), float(quad(slowing, stop, v, epsrel=1e-12)[0])
