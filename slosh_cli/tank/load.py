"""The load at rest: mass, centre and pitch inertia of the frozen prism (theory section 3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from slosh_cli.section import TankGeometry, section_of


class LoadedLiquid(Protocol):
    """The liquid of a scenario's tank, as far as the load at rest needs it."""

    @property
    def density(self) -> float:
        """Density, kg/m^3."""


class LoadedTank(TankGeometry, Protocol):
    """A scenario's tank with its liquid."""

    @property
    def liquid(self) -> LoadedLiquid:
        """What the tank holds."""


@dataclass(frozen=True)
class FrozenLoad:
    """The liquid of a whole tank as a rigid prism.

    `mass` in kg, `centre_height` in m above the lowest point of the tank, `pitch_inertia` in kg m^2 about the
    transverse axis through the load's own centre.
    """

    mass: float
    centre_height: float
    pitch_inertia: float


def frozen_load(tank: LoadedTank) -> FrozenLoad:
    """Mass, centre and pitch inertia of the whole tank's liquid, frozen in its still shape.

    The inertia is the integral of density times (x^2 + (z - z_c)^2) over the prism.
    """
    section = section_of(tank)
    depth = tank.fill * section.height
    area, length, density = section.area(depth), tank.length, tank.liquid.density
    inertia = density * (length * section.second_moment(depth) + area * length**3 / 12.0)
    return FrozenLoad(density * area * length, section.centroid_height(depth), inertia)
