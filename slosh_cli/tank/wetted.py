"""The right half of a wetted cross-section, as the closed boundary the finite elements are fitted to.

Every section is symmetric about y = 0, so half of it is enough: symmetric fields have a zero normal
derivative on the plane of symmetry, antisymmetric ones are zero there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from slosh_cli.outline import Loop, cut_below, cut_right, surface_intervals
from slosh_cli.section import EllipticalSection, PolygonalSection, RectangularSection, Section
from slosh_cli.tank.errors import TankError

_SYMMETRY_TOLERANCE = 1e-5  # of the section's size: what a drawing's rounding leaves
_ROUNDING = 1e-9  # of the section's height: what arithmetic leaves


class Side(IntEnum):
    """What a piece of the boundary is."""

    WALL = 0
    SURFACE = 1
    SYMMETRY = 2


@dataclass(frozen=True)
class _Piece:
    """A straight or elliptical piece of the boundary, run from parameter `start` to `end`.

    Straight pieces go from one corner to the other; on an elliptical one the parameter is the angle from the
    lowest point, and `semi_axes` are (horizontal, vertical), m.
    """

    side: Side
    first: tuple[float, float]
    last: tuple[float, float]
    start: float = 0.0
    end: float = 1.0
    semi_axes: tuple[float, float] | None = None

    def point(self, parameter: float) -> tuple[float, float]:
        """The point (y, z) in m at a parameter; exactly the corner at either end."""
        if parameter == self.start:
            return self.first
        if parameter == self.end:
            return self.last
        if self.semi_axes is None:
            share = (parameter - self.start) / (self.end - self.start)
            (y1, z1), (y2, z2) = self.first, self.last
            return y1 + share * (y2 - y1), z1 + share * (z2 - z1)
        across, up = self.semi_axes
        return across * math.sin(parameter), up * (1.0 - math.cos(parameter))

    def direction(self, parameter: float) -> float:
        """Direction of travel at a parameter, as an angle in rad."""
        if self.semi_axes is None:
            return math.atan2(self.last[1] - self.first[1], self.last[0] - self.first[0])
        across, up = self.semi_axes
        return math.atan2(up * math.sin(parameter), across * math.cos(parameter))


@dataclass(frozen=True)
class _Corner:
    """A corner of the boundary: place (m), interior angle (rad), whether it lies on the free surface."""

    y: float
    z: float
    angle: float
    at_surface: bool
    at_symmetry: bool


@dataclass(frozen=True)
class HalfSection:
    """The wetted half section: boundary pieces run counter-clockwise, and its exact area (m^2)."""

    pieces: tuple[_Piece, ...]
    area: float
    depth: float

    @property
    def half_width(self) -> float:
        """Width of the half's free surface, m."""
        return sum(abs(p.last[0] - p.first[0]) for p in self.pieces if p.side is Side.SURFACE)

    def corners(self) -> tuple[_Corner, ...]:
        """All corners, with the interior angle between the pieces that meet there."""
        found = []
        for before, after in zip((self.pieces[-1], *self.pieces[:-1]), self.pieces, strict=True):
            turn = after.direction(after.start) - before.direction(before.end)
            angle = math.pi - math.remainder(turn, 2.0 * math.pi)
            sides = {before.side, after.side}
            found.append(_Corner(*after.first, angle, Side.SURFACE in sides, Side.SYMMETRY in sides))
        return tuple(found)


def half_section(section: Section, depth: float) -> HalfSection:
    """The right half of `section` filled to `depth` m.

    Raises TankError where one surface shape per mode cannot represent the liquid: a section that is not
    symmetric, or a half in which the liquid or its surface is in more than one piece.
    """
    if not 0.0 < depth < section.height:
        raise TankError(f"depth must lie inside the section (0 to {section.height:g} m), but {depth:g} m was given")
    if isinstance(section, EllipticalSection):
        pieces = _elliptical_pieces(section, depth)
    elif isinstance(section, RectangularSection):
        half = section.width / 2.0
        pieces = _straight_pieces(((0.0, 0.0), (half, 0.0), (half, depth), (0.0, depth)), depth, (0.0, half))
    elif isinstance(section, PolygonalSection):
        pieces = _polygonal_pieces(section, depth)
    else:
        raise TankError(f"no wetted boundary is known for a {type(section).__name__}")
    return HalfSection(pieces, section.area(depth) / 2.0, depth)


def _elliptical_pieces(section: EllipticalSection, depth: float) -> tuple[_Piece, ...]:
    angle = section.half_angle(depth)
    bottom, contact, middle = (0.0, 0.0), (section.surface_width(depth) / 2.0, depth), (0.0, depth)
    wall = _Piece(Side.WALL, bottom, contact, 0.0, angle, (section.half_width, section.half_height))
    return wall, _Piece(Side.SURFACE, contact, middle), _Piece(Side.SYMMETRY, middle, bottom)


def _polygonal_pieces(section: PolygonalSection, depth: float) -> tuple[_Piece, ...]:
    _require_symmetry(section)
    points = _snapped(section, depth)
    halves = [half for part in cut_below(points, depth) for half in cut_right(part)]
    if len(halves) != 1:
        raise TankError(
            f"the liquid must be in one piece on each side of the plane of symmetry, but at a depth of "
            f"{depth:g} m it fills {len(halves)} separate troughs there; choose another fill or give the "
            f"coefficients"
        )
    surface = tuple((max(left, 0.0), right) for left, right in surface_intervals(points, depth) if right > 0.0)
    if len(surface) != 1:
        raise TankError(
            f"the free surface must be in one piece on each side of the plane of symmetry, but at a depth of "
            f"{depth:g} m the tank's wall divides it into {len(surface)}; choose another fill or give the "
            f"coefficients"
        )
    return _straight_pieces(halves[0], depth, surface[0])


def _require_symmetry(section: PolygonalSection) -> None:
    """Every corner's mirror image must lie on the outline."""
    corners = np.array(section.points)
    sides = np.roll(corners, -1, axis=0) - corners
    mirrored = corners * (-1.0, 1.0)
    offset = mirrored[:, None, :] - corners[None, :, :]
    along = np.clip((offset * sides).sum(axis=2) / (sides**2).sum(axis=1), 0.0, 1.0)
    distance = np.linalg.norm(offset - along[:, :, None] * sides, axis=2).min(axis=1)
    worst = int(distance.argmax())
    if distance[worst] > _SYMMETRY_TOLERANCE * np.abs(corners).max():
        y, z = corners[worst]
        raise TankError(
            f"the section must be symmetric about y = 0, but its corner ({y:g}, {z:g}) m has no mirror image"
        )


def _snapped(section: PolygonalSection, depth: float) -> Loop:
    """The corners, with those that lie on a cutting line but for rounding put exactly on it."""
    near_middle = _SYMMETRY_TOLERANCE * max(abs(y) for y, _ in section.points)
    near_surface = _ROUNDING * section.height
    return tuple(
        (0.0 if abs(y) <= near_middle else y, depth if abs(z - depth) <= near_surface else z) for y, z in section.points
    )


def _straight_pieces(loop: Loop, depth: float, surface: tuple[float, float]) -> tuple[_Piece, ...]:
    """The sides of a half polygon; a side at the surface's height is surface only where liquid meets air."""
    left, right = surface
    pieces = []
    for first, last in zip(loop, (*loop[1:], loop[0]), strict=True):
        if first[0] == 0.0 == last[0]:
            pieces.append(_Piece(Side.SYMMETRY, first, last))
        elif first[1] == depth == last[1]:  # runs right to left
            inner = [(y, depth) for y in (right, left) if last[0] < y < first[0]]
            for one, two in zip((first, *inner), (*inner, last), strict=True):
                open_here = left < (one[0] + two[0]) / 2.0 < right
                pieces.append(_Piece(Side.SURFACE if open_here else Side.WALL, one, two))
        else:
            pieces.append(_Piece(Side.WALL, first, last))
    return tuple(pieces)
