"""Wheel-rail forces: Hertz normal contact and Polach's creep force with falling friction.

O. Polach, "Creep forces in simulations of traction vehicles running on adhesion limit", Wear 258 (2005) 992-1000.
"""

from __future__ import annotations

import math

import numpy as np

from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel, kernel
from slosh_cli.scenario import Contact
from slosh_cli.track.hertz import hertz_contact
from slosh_cli.track.surface import RollingSurface, even_surface

CREEPAGE_SPEED_FLOOR = 0.05
"""Creepage is slip over the larger of train speed and this, m/s (theory section 7)."""


class ContactModel(Block):
    """Constants of one wheel-rail contact, SI units.

    `stiffness` C_H in N/m^1.5; `creep_factor` is `G pi c11 (a b / N^(2/3)) / 4` in N^(1/3), so that
    `eps = creep_factor |creepage| / (mu N^(1/3))`; the rest are Polach's friction parameters.
    """

    stiffness: float
    creep_factor: float
    friction: float
    friction_limit_ratio: float
    friction_decay: float
    adhesion_reduction: float
    slip_reduction: float
    surface: RollingSurface

    @inner_kernel
    def approach(self, wheel, rail, heave, place, angle):
        """Approach (m) of a `wheel` at `heave` (m) to the `rail` (m) under it; negative when apart.

        The wagon stands at the `place` (m) along the track, the wheel has turned by `angle` (rad): where rails and
        wheels are even, neither matters (theory section 15). In Newton's iteration an approach changes with them a
        million times less than with the heave, so that they are left out of its slopes, not of its equations.
        """
        if self.surface.uneven == 0:
            return rail - heave
        height, _ = self.surface.rail(wheel, place)
        flat, _ = self.surface.flat(wheel, angle)
        return rail + height - heave - flat

    @inner_kernel
    def rising(self, wheel, place, speed, angle, spin):
        """Rate (m/s) at which the surfaces bring a wheel and its rail together: speed times the rail's slope, less the
        spin (rad/s) times that of the flat."""
        if self.surface.uneven == 0:
            return 0.0
        _, slope = self.surface.rail(wheel, place)
        _, flat_slope = self.surface.flat(wheel, angle)
        return speed * slope - spin * flat_slope

    @kernel
    def normal_force(self, approach):
        """Normal force (N) and its derivative (N/m) for an approach (m) of wheel and rail; zero when apart."""
        closed = max(approach, 0.0)
        root = math.sqrt(closed)
        return self.stiffness * closed * root, 1.5 * self.stiffness * root

    @inner_kernel
    def energy(self, approach):
        """Elastic energy (J) of the contact, `2/5 C_H delta^(5/2)`."""
        return 0.4 * self.stiffness * max(approach, 0.0) ** 2.5

    @kernel
    def creep_force(self, normal, slip, speed):
        """Longitudinal creep force on the wheel, opposing `slip` (m/s, train speed less circumferential speed).

        Returns the force (N, positive rearwards for positive slip) and its derivatives with respect to the normal
        force, the slip and the train speed. `|creepage| = |slip| / max(|speed|, floor)`; theory section 7.
        """
        if normal <= 0.0:
            return 0.0, 0.0, 0.0, 0.0
        direction = 1.0 if slip >= 0.0 else -1.0
        rolling = max(abs(speed), CREEPAGE_SPEED_FLOOR)
        falling = self.friction * (1.0 - self.friction_limit_ratio) * math.exp(-self.friction_decay * abs(slip))
        mu = falling + self.friction * self.friction_limit_ratio
        mu_slope = -self.friction_decay * falling
        eps_per_slip = self.creep_factor / (mu * rolling * np.cbrt(normal))
        eps = eps_per_slip * abs(slip)
        adhesion = self.adhesion_reduction * eps
        sliding = self.slip_reduction * eps
        bracket = adhesion / (1.0 + adhesion * adhesion) + math.atan(sliding)
        bracket_slope = self.adhesion_reduction * (1.0 - adhesion * adhesion) / (
            1.0 + adhesion * adhesion
        ) ** 2 + self.slip_reduction / (1.0 + sliding * sliding)
        scale = 2.0 / math.pi
        force = scale * mu * normal * bracket
        by_normal = scale * mu * (bracket - bracket_slope * eps / 3.0)
        by_slip = scale * normal * (mu_slope * bracket + bracket_slope * (mu * eps_per_slip - eps * mu_slope))
        by_speed = 0.0
        if abs(speed) > CREEPAGE_SPEED_FLOOR:
            by_speed = -scale * mu * normal * bracket_slope * eps / speed
        return direction * force, direction * by_normal, by_slip, direction * by_speed


def contact_model(contact: Contact, wheel_radius: float, surface: RollingSurface | None = None) -> ContactModel:
    """Constants of the contact of a wheel of `wheel_radius` (m) under the scenario's materials and adhesion.

    Without a `surface` rails and wheels are even.
    """
    hertz = hertz_contact(wheel_radius, contact.rail_crown_radius, contact.youngs_modulus, contact.poisson_ratio)
    shear_modulus = contact.youngs_modulus / (2 * (1 + contact.poisson_ratio))
    adhesion = contact.adhesion
    return ContactModel(
        stiffness=hertz.stiffness if contact.stiffness is None else contact.stiffness,
        creep_factor=0.25 * math.pi * shear_modulus * contact.kalker_c11 * hertz.ellipse_area_factor,
        friction=adhesion.mu0,
        friction_limit_ratio=adhesion.A,
        friction_decay=adhesion.B,
        adhesion_reduction=adhesion.kA,
        slip_reduction=adhesion.kS,
        surface=even_surface() if surface is None else surface,
    )
