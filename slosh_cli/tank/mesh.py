"""Triangular meshes of a wetted half section, graded towards the contact line of surface and wall.

The first one comes from the triangulation module by wanted element size. Refinement halves every edge and
puts new boundary points on the true boundary, curved or straight.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from slosh_cli.tank.wetted import HalfSection, Side

if TYPE_CHECKING:
    from skfem import MeshTri1, MeshTri2

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_ELEMENTS_ACROSS = 4.0  # largest element: the root of the area over this
_ELEMENTS_DOWN = 2.0  # the same for shallow liquids, with the depth
_MOST_ACROSS = 12.0  # but no smaller than this share of the root of the area
_GRADING = 0.45  # growth of the element size with distance from where it is kept small
_BEND = 0.4  # largest element over radius of curvature
_SIDE = 2.0  # largest element over the length of the side of a polygon it stands on
_SMALLEST_SIDE = 0.02  # smallest element for the sake of a short side, over the root of the area
_DECAY = 0.45  # largest element at the surface, in decay lengths of the shortest mode
_SINGULARITY = 3e-5  # share of the first mesh's error a singular corner may have


@dataclass(frozen=True)
class ElementSize:
    """Wanted element size over the half section: small at singular corners and below the surface."""

    largest: float
    centres: Floats  # (corners, 2)
    smallest: Floats  # (corners,)
    depth: float
    at_surface: float

    def __call__(self, points: Floats) -> Floats:
        """Wanted size in m at `points` (n, 2)."""
        distance = np.linalg.norm(points[:, None, :] - self.centres[None, :, :], axis=2)
        near_corners = (self.smallest[None, :] + _GRADING * distance).min(axis=1, initial=self.largest)
        below_surface = self.at_surface + _GRADING * np.maximum(self.depth - points[:, 1], 0.0)
        return np.asarray(np.minimum(near_corners, below_surface), dtype=np.float64)


def element_size(half: HalfSection, wavenumber: float, held_surface: bool = False) -> ElementSize:
    """Element sizes for fields of up to `wavenumber` 1/m along the tank.

    At a corner of angle a the potential is as r^(pi/a), or r^(pi/2a) at the contact line with `held_surface`,
    the potential given there; the error is as the size there to twice that power. Corners of the wall weigh
    less the flatter they are. The field decays downwards as exp(-wavenumber depth).
    """
    scale = math.sqrt(half.area)
    kept_small = _singular_corners(half, scale, held_surface) + _bends(half) + _short_sides(half, scale)
    return ElementSize(
        max(min(scale / _ELEMENTS_ACROSS, half.depth / _ELEMENTS_DOWN), scale / _MOST_ACROSS),
        np.array([place for place, _ in kept_small], dtype=np.float64).reshape(-1, 2),
        np.array([size for _, size in kept_small], dtype=np.float64),
        half.depth,
        _DECAY / wavenumber if wavenumber > 0.0 else math.inf,
    )


def _singular_corners(half: HalfSection, scale: float, held_surface: bool) -> list[tuple[tuple[float, float], float]]:
    """Corners that limit the accuracy, each with the element size (m) that makes up for it."""
    found = []
    for corner in half.corners():
        if corner.at_surface and corner.at_symmetry:
            continue
        exponent = math.pi / corner.angle / (2.0 if held_surface and corner.at_surface else 1.0)
        weight = 1.0 if corner.at_surface else (1.0 - exponent) ** 2 if exponent < 1.999 else 0.0
        if weight > _SINGULARITY:
            size = 0.5 * scale * (_SINGULARITY / weight) ** (1.0 / min(2.0 * exponent, 4.0))
            found.append(((corner.y, corner.z), size))
    return found


def _bends(half: HalfSection) -> list[tuple[tuple[float, float], float]]:
    """Where curved walls bend most, each with an element size (m) in keeping with the radius there."""
    found = []
    for piece in half.pieces:
        if piece.semi_axes is None:
            continue
        across, up = piece.semi_axes
        for angle in (piece.start, min(math.pi / 2.0, piece.end), piece.end):
            radius = math.hypot(across * math.cos(angle), up * math.sin(angle)) ** 3 / (across * up)
            found.append((piece.point(angle), _BEND * radius))
    return found


def _short_sides(half: HalfSection, scale: float) -> list[tuple[tuple[float, float], float]]:
    """Sides shorter than the elements would be, each with an element size (m) in keeping; very short ones not."""
    found = []
    for piece in half.pieces:
        if piece.semi_axes is None:
            size = max(_SIDE * math.dist(piece.first, piece.last), _SMALLEST_SIDE * scale)
            middle = ((piece.first[0] + piece.last[0]) / 2.0, (piece.first[1] + piece.last[1]) / 2.0)
            found.append((middle, size))
    return found


@dataclass(frozen=True)
class Boundary:
    """Boundary edges: end points (m, 2), piece (m,) and the two ends' parameters on that piece (m, 2)."""

    nodes: Ints
    piece: Ints
    parameters: Floats


@dataclass(frozen=True)
class _FiniteElementMesh:
    """The same triangles with straight edges and with edges bent to the wall, and the facets by side.

    Both number nodes, edges and unknowns alike.
    """

    straight: MeshTri1
    curved: MeshTri2
    facets: dict[Side, Ints]


@dataclass(frozen=True)
class SectionMesh:
    """Triangles over a half section: points (n, 2) in m, corners (t, 3) counter-clockwise, boundary edges."""

    half: HalfSection
    points: Floats
    triangles: Ints
    boundary: Boundary

    def refined(self) -> SectionMesh:
        """Every triangle cut in four; new points on the boundary lie on the true boundary."""
        edges = np.sort(self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, inverse = np.unique(edges, axis=0, return_inverse=True)
        middle = len(self.points) + inverse.reshape(-1, 3)
        points = np.vstack([self.points, self.points[unique].mean(axis=1)])
        boundary = self.boundary
        at_edge = len(self.points) + _row_of(unique, np.sort(boundary.nodes, axis=1))
        points[at_edge] = self.boundary_middles()
        a, b, c = self.triangles.T
        ab, bc, ca = middle.T
        triangles = np.vstack([np.column_stack(t) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        centre = boundary.parameters.mean(axis=1)
        halves = Boundary(
            np.vstack(
                [
                    np.column_stack([boundary.nodes[:, 0], at_edge]),
                    np.column_stack([at_edge, boundary.nodes[:, 1]]),
                ]
            ),
            np.tile(boundary.piece, 2),
            np.vstack(
                [
                    np.column_stack([boundary.parameters[:, 0], centre]),
                    np.column_stack([centre, boundary.parameters[:, 1]]),
                ]
            ),
        )
        return replace(self, points=points, triangles=triangles, boundary=halves)

    def boundary_middles(self) -> Floats:
        """Points on the true boundary half-way along each boundary edge, (m, 2)."""
        centre = self.boundary.parameters.mean(axis=1)
        pieces = self.half.pieces
        return np.array([pieces[p].point(float(t)) for p, t in zip(self.boundary.piece, centre, strict=True)])

    def side_edges(self, side: Side) -> Bools:
        """Which boundary edges belong to a side, (m,)."""
        sides = np.array([piece.side for piece in self.half.pieces])
        return np.asarray(sides[self.boundary.piece] == side, dtype=np.bool_)

    def for_finite_elements(self) -> _FiniteElementMesh:
        """The mesh as scikit-fem takes it."""
        from skfem import MeshTri1, MeshTri2

        straight = MeshTri1(self.points.T.copy(), self.triangles.T.copy())
        curved = MeshTri2.from_mesh(straight)
        facet = _row_of(straight.facets.T, np.sort(self.boundary.nodes, axis=1))
        places = curved.doflocs.copy()
        places[:, curved.dofs.facet_dofs[0, facet]] = self.boundary_middles().T
        sides = {side: facet[self.side_edges(side)] for side in Side}
        return _FiniteElementMesh(straight, replace(curved, doflocs=places), sides)


def _row_of(sorted_rows: Ints, wanted: Ints) -> Ints:
    """Positions of the rows `wanted` (m, 2) among `sorted_rows` (n, 2), whatever their order."""
    width = int(sorted_rows.max()) + 1
    keys = sorted_rows[:, 0].astype(np.int64) * width + sorted_rows[:, 1]
    order = np.argsort(keys)
    found = order[np.searchsorted(keys[order], wanted[:, 0].astype(np.int64) * width + wanted[:, 1])]
    return np.asarray(found, dtype=np.int64)
