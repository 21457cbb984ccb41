"""Masses, contact and static state of half a wagon for the second code: plain numbers and functions, no exudyn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.load import frozen_load
from slosh_cli.validation.exact.creep import PolachParameters, adhesion, ellipse
from slosh_cli.wagon.torque import brake_torque


@dataclass(frozen=True)
class Bodies:
    """Half masses (kg), pitch inertia (kg m^2) and heights (m) of the car with the liquid that does not slosh, and of
    the slosh body; `slosh_height` counts from the car's centre.

    `attachment` is how far below the car's centre the secondary springs act: there the weight's overturning moment is
    the `m_l g z_c theta` of theory section 3.
    """

    car: float
    car_inertia: float
    car_height: float
    slosh: float
    slosh_height: float
    attachment: float

    @staticmethod
    def of(scenario: Scenario, mode: SloshMode) -> Bodies:
        """Split the load into what slides and what does not, keeping mass, centre and pitch inertia."""
        body, load = scenario.wagon.car_body, frozen_load(scenario.tank)
        bottom = scenario.tank.bottom_height
        slosh, slosh_height = mode.slosh_mass, bottom + mode.height
        rest = load.mass - slosh
        rest_height = (load.mass * (bottom + load.centre_height) - slosh * slosh_height) / rest
        rest_inertia = load.pitch_inertia + load.mass * (bottom + load.centre_height - slosh_height) ** 2
        rest_inertia -= rest * (rest_height - slosh_height) ** 2
        mass = body.mass + rest
        height = (body.mass * body.centre_height + rest * rest_height) / mass
        inertia = body.pitch_inertia + body.mass * (body.centre_height - height) ** 2
        inertia += rest_inertia + rest * (rest_height - height) ** 2
        overturning = load.mass * load.centre_height - slosh * (slosh_height - height)
        attachment = overturning / (mass + slosh)
        return Bodies(mass / 2, inertia / 2, height, slosh / 2, slosh_height - height, attachment)


class WheelContact:
    """Hertz and Polach on a rigid rail, resistance and brake, as generalised forces on one wheel (x, y, rotation).

    Raises ValueError for a brake that builds up or fades and for a gradient: the second code would leave them out.
    """

    def __init__(self, scenario: Scenario) -> None:
        _refuse_what_is_left_out(scenario)
        steel, p = scenario.contact, scenario.contact.adhesion
        self.radius = scenario.wagon.wheelset.wheel_radius
        a, b, approach = ellipse(self.radius, steel.rail_crown_radius, steel.youngs_modulus, steel.poisson_ratio, 1.0)
        self.stiffness = approach**-1.5
        shear = steel.youngs_modulus / (2 * (1 + steel.poisson_ratio))
        self.gradient = shear * np.pi * a * b * steel.kalker_c11 / 4  # times N^(-1/3)
        self.adhesion = PolachParameters(p.kA, p.kS, p.mu0, p.A, p.B)
        self.resistance = scenario.wagon.running_resistance
        self.torque, self.onset = brake_torque(scenario, 0.0), scenario.braking.onset

    def braking(self, time: float) -> float:
        """Torque on the wheel, N m; the stop is over before a wheel locks.

        Half of it at the onset itself: the trapezoidal rule would else begin to brake half a step late.
        """
        if abs(time - self.onset) < 1e-9:
            return 0.5 * self.torque
        return self.torque if time > self.onset else 0.0

    def forces(self, _: Any, time: float, __: int, q: Array, rate: Array) -> Array:
        """Forward and upward force (N) and moment (N m, nose-up) on a wheel that moves as `q`, `rate` say."""
        normal = self.stiffness * max(-q[1], 0.0) ** 1.5
        creep = 0.0
        if normal > 0.0:
            slip = rate[0] + self.radius * rate[2]  # the wheel turns clockwise: rotation is negative
            nu = abs(slip) / max(abs(rate[0]), 0.05)
            share = adhesion(self.adhesion, self.gradient * normal ** (-1 / 3), nu, abs(slip) / nu) if nu > 0 else 0.0
            creep = np.sign(slip) * share * normal
        terms = self.resistance
        rolling = (terms.constant + terms.linear * rate[0] + terms.quadratic * rate[0] ** 2) / 8
        return np.array([-creep - rolling, normal, self.braking(time) - creep * self.radius])


def _refuse_what_is_left_out(scenario: Scenario) -> None:
    braking = scenario.braking
    at_once = braking.application.stretches == ((0.0, 1.0, 0.0, 0.0, 0.0),)
    if not at_once or braking.rubbing is not None or braking.slide_protection is not None:
        raise ValueError("the brake must be a constant torque applied at once: the second code knows no other")
    track = scenario.track
    if any(gradient for _, gradient in track.gradient_points) or track.unevenness or scenario.wagon.wheel_flats:
        raise ValueError("the line must be level, rails and wheels even: the second code knows no others")
    if scenario.wagon.secondary_suspension == "none":
        raise ValueError("the bogies must have a secondary suspension: the second code knows no others")


def settled(scenario: Scenario, bodies: Bodies, contact: WheelContact) -> tuple[float, float, float]:
    """Heave (m) of car, bogies and wheels under the weight, from the unloaded geometry."""
    wagon = scenario.wagon
    on_secondary = STANDARD_GRAVITY * (bodies.car + bodies.slosh) / 2
    on_primary = (on_secondary + STANDARD_GRAVITY * wagon.bogie.mass / 2) / 2
    load = on_primary + STANDARD_GRAVITY * wagon.wheelset.mass / 2
    wheel = -((load / contact.stiffness) ** (2 / 3))
    bogie = wheel - on_primary / wagon.primary_suspension.stiffness
    secondary = wagon.secondary_suspension
    return bogie - (0.0 if secondary == "none" else on_secondary / secondary.stiffness), bogie, wheel
