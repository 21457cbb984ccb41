"""Geometry of a tank's cross-section, filled to some depth: area, centroid, second moment, surface width.

Closed forms throughout. `z` is measured up from the lowest point of the section, `y` from its vertical plane
of symmetry. Depths are in metres above the lowest point; beyond the section they are clipped to it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, cast

from slosh_cli.outline import Loop, counter_clockwise, cut_below, moments, surface_intervals


class Section(Protocol):
    """What the load, the finite elements and a shallow-water liquid need to know of a cross-section."""

    @property
    def height(self) -> float:
        """Height of the section, m."""

    def area(self, depth: float) -> float:
        """Wetted area in m^2 at a liquid depth in m."""

    def centroid_height(self, depth: float) -> float:
        """Height of the wetted area's centroid above the lowest point, m."""

    def second_moment(self, depth: float) -> float:
        """Second moment of the wetted area about the horizontal axis through its own centroid, m^4."""

    def surface_width(self, depth: float) -> float:
        """Width of the free surface, m."""


@dataclass(frozen=True)
class EllipticalSection:
    """An upright ellipse; a circle when both semi-axes (m) are the radius."""

    half_width: float
    half_height: float

    @property
    def height(self) -> float:
        """Height of the section, m."""
        return 2.0 * self.half_height

    def half_angle(self, depth: float) -> float:
        """Half the angle, rad, that the wetted part subtends at the centre once the ellipse is drawn as a circle."""
        return 2.0 * math.asin(math.sqrt(min(max(depth / self.height, 0.0), 1.0)))

    def area(self, depth: float) -> float:
        """Wetted area in m^2 at a liquid depth in m."""
        return self.half_width * self.half_height * _segment_area(self.half_angle(depth))

    def centroid_height(self, depth: float) -> float:
        """Height of the wetted area's centroid above the lowest point, m."""
        return self.half_height * (1.0 - _segment_centroid(self.half_angle(depth)))

    def second_moment(self, depth: float) -> float:
        """Second moment of the wetted area about the horizontal axis through its own centroid, m^4."""
        angle = self.half_angle(depth)
        about_centre = (angle - math.sin(4.0 * angle) / 4.0) / 4.0
        about_centroid = about_centre - _segment_area(angle) * _segment_centroid(angle) ** 2
        return self.half_width * self.half_height**3 * max(about_centroid, 0.0)

    def surface_width(self, depth: float) -> float:
        """Width of the free surface, m."""
        return 2.0 * self.half_width * math.sin(self.half_angle(depth))


def _segment_area(angle: float) -> float:
    """Area of the unit circle's segment of half-angle `angle`."""
    if angle < 0.02:  # the difference below would lose its digits
        return 2.0 / 3.0 * angle**3 * (1.0 - angle**2 / 5.0 + 2.0 * angle**4 / 105.0)
    return angle - math.sin(2.0 * angle) / 2.0


def _segment_centroid(angle: float) -> float:
    """Distance of that segment's centroid from the circle's centre (1 for an empty segment)."""
    return 2.0 / 3.0 * math.sin(angle) ** 3 / _segment_area(angle) if angle > 0.0 else 1.0


@dataclass(frozen=True)
class RectangularSection:
    """A box of the given width and height, m."""

    width: float
    height: float

    def _clip(self, depth: float) -> float:
        return min(max(depth, 0.0), self.height)

    def area(self, depth: float) -> float:
        """Wetted area in m^2 at a liquid depth in m."""
        return self.width * self._clip(depth)

    def centroid_height(self, depth: float) -> float:
        """Height of the wetted area's centroid above the lowest point, m."""
        return self._clip(depth) / 2.0

    def second_moment(self, depth: float) -> float:
        """Second moment of the wetted area about the horizontal axis through its own centroid, m^4."""
        return self.width * self._clip(depth) ** 3 / 12.0

    def surface_width(self, depth: float) -> float:
        """Width of the free surface, m (none where the section is empty or full)."""
        return self.width if 0.0 < depth < self.height else 0.0


@dataclass(frozen=True)
class PolygonalSection:
    """A simple polygon, symmetric about y = 0, with corners (y, z) in m and its lowest point at z = 0."""

    points: Loop

    @property
    def height(self) -> float:
        """Height of the section, m."""
        return max(z for _, z in self.points)

    def wetted(self, depth: float) -> tuple[Loop, ...]:
        """The wetted region as counter-clockwise loops."""
        return (counter_clockwise(self.points),) if depth >= self.height else cut_below(self.points, depth)

    def area(self, depth: float) -> float:
        """Wetted area in m^2 at a liquid depth in m."""
        return moments(self.wetted(depth)).area

    def centroid_height(self, depth: float) -> float:
        """Height of the wetted area's centroid above the lowest point, m."""
        wetted = moments(self.wetted(depth))
        return wetted.first / wetted.area if wetted.area > 0.0 else 0.0

    def second_moment(self, depth: float) -> float:
        """Second moment of the wetted area about the horizontal axis through its own centroid, m^4."""
        return max(moments(self.wetted(depth), level=self.centroid_height(depth)).second, 0.0)

    def surface_width(self, depth: float) -> float:
        """Width of the free surface, m (a ceiling exactly at the surface is not part of it)."""
        intervals = surface_intervals(self.points, min(max(depth, 0.0), self.height))
        return sum(right - left for left, right in intervals)


class TankGeometry(Protocol):
    """A tank's shape as a scenario describes it; the dimensions belonging to each shape come on top."""

    @property
    def shape(self) -> str:
        """`horizontal-cylinder`, `rectangular`, `elliptical` or `polygon`."""

    @property
    def length(self) -> float:
        """Inside length between the flat ends, m."""

    @property
    def fill(self) -> float:
        """Liquid depth over section height."""


class _Round(Protocol):
    @property
    def radius(self) -> float: ...


class _Box(Protocol):
    @property
    def width(self) -> float: ...
    @property
    def height(self) -> float: ...


class _Outline(Protocol):
    @property
    def points(self) -> Sequence[tuple[float, float]]: ...


def section_of(tank: TankGeometry) -> Section:
    """The cross-section of a scenario's tank.

    Raises ValueError for a shape this version does not know.
    """
    if tank.shape == "horizontal-cylinder":
        radius = cast(_Round, tank).radius
        return EllipticalSection(radius, radius)
    if tank.shape == "elliptical":
        box = cast(_Box, tank)
        return EllipticalSection(box.width / 2.0, box.height / 2.0)
    if tank.shape == "rectangular":
        box = cast(_Box, tank)
        return RectangularSection(box.width, box.height)
    if tank.shape == "polygon":
        return PolygonalSection(tuple((float(y), float(z)) for y, z in cast(_Outline, tank).points))
    raise ValueError(f"shape must be a known cross-section, but `{tank.shape}` was given")


def liquid_depth(tank: TankGeometry) -> float:
    """Depth of the still liquid above the tank's lowest point, m."""
    return tank.fill * section_of(tank).height


def depth_of_area(section: Section, area: float) -> float:
    """Depth (m) at which a section has a wetted `area` (m^2): the inverse of `Section.area`, clipped to the section."""
    if area <= 0.0 or area >= section.area(section.height):
        return 0.0 if area <= 0.0 else section.height
    if isinstance(section, RectangularSection):
        return area / section.width
    from scipy.optimize import brentq

    height = section.height
    found = brentq(lambda depth: section.area(depth) - area, 0.0, height, xtol=1e-15 * height, rtol=1e-15)
    return float(found)
