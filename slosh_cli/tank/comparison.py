"""Given slosh coefficients beside those computed from the tank's geometry, and what cannot be right about them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from slosh_cli.tank.coefficients import SloshMode, SloshTank, computed_modes, given_modes
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.longitudinal import mode_number

LARGEST_MASS_FRACTION = 8.0 / math.pi**2
"""Bound of the first mode's share of the liquid in any tank with flat ends (theory section 4)."""

ROUNDING = 1e-6
"""What figures with few digits may exceed the bound by."""


@dataclass(frozen=True)
class ModeComparison:
    """Mode `n` (half waves along the tank) as computed and, where the scenario states it, as given.

    Fractions are slosh masses over the liquid's mass. A given mode is brought to the computed one's sense of
    the amplitude, a free choice that turns the signs of both couplings.
    """

    n: int
    computed: SloshMode
    computed_fraction: float
    given: SloshMode | None = None
    given_fraction: float | None = None

    def deviations(self) -> dict[str, float]:
        """Given over computed less 1, by quantity; empty without a given mode.

        Only frequency, mass fraction and height are free of the scaling of the amplitude.
        """
        if self.given is None or self.given_fraction is None:
            return {}
        names = ("frequency", "lambda_1", "lambda_02", "mu", "height")
        pairs = {name: (getattr(self.given, name), getattr(self.computed, name)) for name in names}
        pairs["mass_fraction"] = (self.given_fraction, self.computed_fraction)
        return {name: given / computed - 1.0 for name, (given, computed) in pairs.items()}


def compare_modes(tank: SloshTank, count: int | None = None) -> tuple[ModeComparison, ...]:
    """The first `count` odd modes computed from the geometry, with the scenario's own beside them.

    Without a count as many as the scenario asks for or states. Given modes are taken as n = 1, 3, 5, ... in
    their order. Raises TankError where the section cannot be represented.
    """
    given = given_modes(tank)
    wanted = count if count is not None else len(given) or tank.modes
    mass = frozen_load(tank).mass
    rows = []
    for position, computed in enumerate(computed_modes(tank, wanted)):
        stated = given[position] if position < len(given) else None
        rows.append(
            ModeComparison(
                mode_number(position),
                computed,
                computed.slosh_mass / mass,
                None if stated is None else _in_sense_of(computed, stated),
                None if stated is None else stated.slosh_mass / mass,
            )
        )
    return tuple(rows)


def given_fractions(tank: SloshTank) -> tuple[tuple[float, float], ...]:
    """Slosh mass over the liquid's mass of each given mode, and the bound of a tank with flat ends beside it."""
    mass = frozen_load(tank).mass
    return tuple(
        (mode.slosh_mass / mass, LARGEST_MASS_FRACTION / mode_number(position) ** 2)
        for position, mode in enumerate(given_modes(tank))
    )


def impossible_fractions(tank: SloshTank) -> tuple[str, ...]:
    """A sentence for each given mode with more slosh mass than the tank allows."""
    return tuple(
        f"given mode {position} moves {fraction:.4f} of the liquid's mass, but a tank with flat ends "
        f"allows at most 8/(n pi)^2 = {bound:.4f}; check the coefficients or write `coefficients: computed`"
        for position, (fraction, bound) in enumerate(given_fractions(tank), 1)
        if fraction > bound * (1.0 + ROUNDING)
    )


def _in_sense_of(computed: SloshMode, given: SloshMode) -> SloshMode:
    """The given mode with the amplitude counted positive in the same sense as the computed one's."""
    if given.lambda_1 * computed.lambda_1 > 0.0:
        return given
    return SloshMode(given.frequency, -given.lambda_1, -given.lambda_02, given.mu, given.damping_ratio)
