"""The first triangulation of a wetted half section: Delaunay refinement by size and shape.

After Ruppert (J. Algorithms 18, 1995), in batches: too large or too thin triangles get a point at their
circumcentre; a boundary edge such a point would crowd is halved instead. No two points come closer than a
share of the wanted size, so it ends at sharp corners too.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from slosh_cli.tank.errors import TankError
from slosh_cli.tank.mesh import Bools, Boundary, ElementSize, Floats, Ints, SectionMesh, element_size
from slosh_cli.tank.wetted import HalfSection

_LARGEST_TURN = np.radians(25.0)  # of the boundary's direction along one edge
_LARGEST = 0.7  # circumradius over wanted size beyond which a triangle is too large
_THINNEST = 1.35  # circumradius over shortest edge beyond which a triangle is too thin (21.7 degrees)
_CLOSEST = 0.35  # of the wanted size: no two points are put closer to each other
_FLAT = 1e-10  # twice the area over the longest edge squared: what rounding makes of points in a line
_PASSES = 100

_Edge = tuple[int, int, int, float, float]  # two points, boundary piece, the points' parameters on it


def triangulate(half: HalfSection, wavenumber: float, held_surface: bool = False) -> SectionMesh:
    """A mesh of the half section fit for fields of up to `wavenumber` (1/m) along the tank.

    `held_surface`: the potential is given on the free surface, which makes the contact line more singular.
    Raises TankError where the boundary cannot be meshed (it crosses itself, or corners nearly coincide).
    """
    draft = _Draft(half, element_size(half, wavenumber, held_surface))
    for _ in range(_PASSES):
        triangles = draft.triangles()
        missing = draft.missing_edges(triangles)
        if len(missing):
            draft.halve(missing)
        elif not draft.improve(triangles):
            break
    return draft.finish()


@dataclass
class _Draft:
    """Points and boundary edges of a mesh in the making."""

    half: HalfSection
    size: ElementSize
    points: list[tuple[float, float]] = field(default_factory=list)
    edges: list[_Edge] = field(default_factory=list)

    def __post_init__(self) -> None:
        for piece in self.half.pieces:
            self.points.append(piece.first)
        for index, piece in enumerate(self.half.pieces):
            following = (index + 1) % len(self.half.pieces)
            self._divide((index, following, index, piece.start, piece.end))

    def _divide(self, edge: _Edge) -> None:
        """Halve an edge until it is as short as wanted and nearly straight."""
        piece = self.half.pieces[edge[2]]
        ends = np.array([self.points[edge[0]], self.points[edge[1]]])
        wanted = self.size(np.vstack([ends, ends.mean(axis=0)]))
        turn = abs(piece.direction(edge[4]) - piece.direction(edge[3]))
        if np.linalg.norm(ends[1] - ends[0]) <= wanted.mean() and turn <= _LARGEST_TURN:
            self.edges.append(edge)
            return
        for part in self._halves(edge):
            self._divide(part)

    def _halves(self, edge: _Edge) -> tuple[_Edge, _Edge]:
        first, last, piece, start, end = edge
        middle = (start + end) / 2.0
        self.points.append(self.half.pieces[piece].point(middle))
        new = len(self.points) - 1
        return (first, new, piece, start, middle), (new, last, piece, middle, end)

    def halve(self, which: Ints) -> None:
        """Halve boundary edges given by their positions."""
        chosen = set(which.tolist())
        kept = [edge for index, edge in enumerate(self.edges) if index not in chosen]
        for index in sorted(chosen):
            kept.extend(self._halves(self.edges[index]))
        self.edges = kept

    def _arrays(self) -> tuple[Floats, Ints]:
        return np.array(self.points), np.array([edge[:2] for edge in self.edges])

    def triangles(self) -> Ints:
        """Delaunay triangles inside the boundary, counter-clockwise."""
        from scipy.spatial import Delaunay

        points, edges = self._arrays()
        triangles = np.asarray(Delaunay(points).simplices, dtype=np.int64)
        doubled = _doubled_areas(points[triangles])
        triangles[doubled < 0.0] = triangles[doubled < 0.0][:, ::-1]
        triangles = triangles[np.abs(doubled) > _FLAT * _longest_squared(points[triangles])]
        return triangles[_inside(points[triangles].mean(axis=1), points[edges])]

    def missing_edges(self, triangles: Ints) -> Ints:
        """Positions of boundary edges that are no triangle's edge."""
        count = len(self.points)
        corners = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges = np.sort(np.array([edge[:2] for edge in self.edges]), axis=1)
        present = np.isin(edges[:, 0] * count + edges[:, 1], corners[:, 0] * count + corners[:, 1])
        return np.flatnonzero(~present)

    def improve(self, triangles: Ints) -> bool:
        """Add points where triangles are too large or too thin; False when there is nothing left to do."""
        points, edges = self._arrays()
        centres, radius, shortest = _circumcircles(points[triangles])
        wanted = self.size(points[triangles].mean(axis=1))
        bad = (radius > _LARGEST * wanted) | (radius > _THINNEST * shortest)
        centres, radius, triangles = centres[bad], radius[bad], triangles[bad]
        ends = points[edges]
        crowding = _crowded(centres, ends)
        inside = _inside(centres, ends)
        free = inside & ~crowding.any(axis=1) & (radius >= _CLOSEST * self.size(centres))
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        divisible = length > 2.0 * _CLOSEST * self.size(ends.mean(axis=1))
        to_halve = np.flatnonzero(crowding.any(axis=0) & divisible)
        if len(to_halve):
            self.halve(to_halve)
        new = _well_apart(centres[free], radius[free])
        self.points.extend((float(y), float(z)) for y, z in new)
        return bool(len(to_halve) or len(new))

    def finish(self) -> SectionMesh:
        """The mesh, checked to cover the region inside the boundary edges exactly."""
        points, edges = self._arrays()
        triangles = self.triangles()
        covered = _doubled_areas(points[triangles]).sum() / 2.0
        (y1, z1), (y2, z2) = points[edges[:, 0]].T, points[edges[:, 1]].T
        expected = float((y1 * z2 - y2 * z1).sum()) / 2.0
        if len(self.missing_edges(triangles)) or abs(covered - expected) > 1e-9 * expected:
            raise TankError("the cross-section could not be meshed; check its corners for near coincidences")
        pieces = np.array([edge[2] for edge in self.edges])
        parameters = np.array([edge[3:] for edge in self.edges])
        return SectionMesh(self.half, points, triangles, Boundary(edges, pieces, parameters))


def _doubled_areas(corners: Floats) -> Floats:
    """Twice the signed areas of triangles (t, 3, 2)."""
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.asarray(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], dtype=np.float64)


def _squared_edges(corners: Floats) -> Floats:
    """Squared edge lengths of triangles, (t, 3)."""
    return np.asarray(((np.roll(corners, -1, axis=1) - corners) ** 2).sum(axis=2), dtype=np.float64)


def _longest_squared(corners: Floats) -> Floats:
    return np.asarray(_squared_edges(corners).max(axis=1), dtype=np.float64)


def _circumcircles(corners: Floats) -> tuple[Floats, Floats, Floats]:
    """Circumcentres (t, 2), circumradii and shortest edges (t,) of triangles."""
    origin = corners[:, 0]
    one, two = corners[:, 1] - origin, corners[:, 2] - origin
    doubled = 2.0 * _doubled_areas(corners)
    squared_one, squared_two = (one**2).sum(axis=1), (two**2).sum(axis=1)
    offset = np.column_stack(
        [
            (two[:, 1] * squared_one - one[:, 1] * squared_two) / doubled,
            (one[:, 0] * squared_two - two[:, 0] * squared_one) / doubled,
        ]
    )
    return origin + offset, np.linalg.norm(offset, axis=1), np.sqrt(_squared_edges(corners).min(axis=1))


def _inside(points: Floats, ends: Floats) -> Bools:
    """Whether points (n, 2) lie inside the closed boundary of edges (m, 2, 2): a ray along +y."""
    y, z = points[:, :1], points[:, 1:]
    (y1, z1), (y2, z2) = ends[:, 0].T, ends[:, 1].T
    straddles = (z1 > z) != (z2 > z)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = y1 + (z - z1) * (y2 - y1) / (z2 - z1)
    return np.asarray((straddles & (y < crossing)).sum(axis=1) % 2 == 1, dtype=np.bool_)


def _crowded(points: Floats, ends: Floats) -> Bools:
    """Whether points (n, 2) lie in the circles over edges (m, 2, 2) as diameters, (n, m)."""
    to_first = points[:, None, :] - ends[None, :, 0, :]
    to_last = points[:, None, :] - ends[None, :, 1, :]
    return np.asarray((to_first * to_last).sum(axis=2) < 0.0, dtype=np.bool_)


def _well_apart(centres: Floats, radius: Floats) -> Floats:
    """A subset of candidate points, largest circles first, none inside another's circle shrunk a little."""
    order = np.argsort(-radius, kind="stable")
    left, kept = list(order), []
    while left:
        index = left[0]
        kept.append(index)
        distance = np.linalg.norm(centres[left] - centres[index], axis=1)
        left = [other for other, apart in zip(left, distance, strict=True) if apart >= 0.9 * radius[index]]
    return np.asarray(centres[kept], dtype=np.float64).reshape(-1, 2)
