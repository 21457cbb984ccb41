"""Tanks for the tests, and the sections they have."""

import math

from slosh_cli.scenario import Elliptical, HorizontalCylinder, Liquid, Polygon, Rectangular

WATER = Liquid(model="modal", density=998.2)

V_TROUGH = ((0.0, 0.0), (1.0, 1.0), (-1.0, 1.0))
# a wide lower part with a ceiling at 1 m, a neck 1 m wide, and a wider top
BOTTLE = ((-1.0, 0.0), (1.0, 0.0), (1.5, 1.0), (0.5, 1.0), (0.5, 1.5), (1.0, 2.0),
          (-1.0, 2.0), (-0.5, 1.5), (-0.5, 1.0), (-1.5, 1.0))  # fmt: skip
# three troughs, the middle one shallower, joined above 1 m
THREE_TROUGHS = ((-2.0, 0.0), (-1.0, 1.0), (0.0, 0.5), (1.0, 1.0), (2.0, 0.0), (2.0, 2.0), (-2.0, 2.0))


def cylinder(
    fill: float = 0.5, radius: float = 1.2, length: float = 5.75, liquid: Liquid = WATER
) -> HorizontalCylinder:
    return HorizontalCylinder(radius=radius, length=length, fill=fill, liquid=liquid)


def box(fill: float = 0.5, width: float = 2.4, height: float = 3.0, length: float = 5.75) -> Rectangular:
    return Rectangular(width=width, height=height, length=length, fill=fill, liquid=WATER)


def ellipse(fill: float = 0.5, width: float = 2.6, height: float = 2.0, length: float = 5.75) -> Elliptical:
    return Elliptical(width=width, height=height, length=length, fill=fill, liquid=WATER)


def polygon(points: tuple[tuple[float, float], ...], fill: float = 0.5, length: float = 5.75) -> Polygon:
    return Polygon(points=points, length=length, fill=fill, liquid=WATER)


def regular_polygon(sides: int, radius: float = 1.2) -> tuple[tuple[float, float], ...]:
    """Corners of a regular polygon in a circle, one side at the bottom."""
    angles = [(position + 0.5) * 2.0 * math.pi / sides for position in range(sides)]
    lowest = radius * math.cos(math.pi / sides)
    return tuple((radius * math.sin(angle), lowest - radius * math.cos(angle)) for angle in angles)
