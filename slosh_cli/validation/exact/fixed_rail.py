"""A conventional finite element rail: fixed in the ground, the loads roll over it.

No frame moves here, so there is not one term with the speed in it: `M y'' + C y' + K y` and loads that wander from
element to element. Cubic Hermite elements of equal length, Newmark's method with average acceleration
(`beta = 1/4`, `gamma = 1/2`), one factorisation for all steps (Bathe, Finite Element Procedures, sections 4.2, 9.2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.validation.exact.steady_rail import Beam


def element_matrices(length: float) -> tuple[Array, Array, Array]:
    """Textbook mass, tension and bending matrices of a beam element for unit mass, tension and bending stiffness."""
    h = length
    mass = np.array(
        [
            [156, 22 * h, 54, -13 * h],
            [22 * h, 4 * h**2, 13 * h, -3 * h**2],
            [54, 13 * h, 156, -22 * h],
            [-13 * h, -3 * h**2, -22 * h, 4 * h**2],
        ]
    )
    tension = np.array(
        [
            [36, 3 * h, -36, 3 * h],
            [3 * h, 4 * h**2, -3 * h, -(h**2)],
            [-36, -3 * h, 36, -3 * h],
            [3 * h, -(h**2), -3 * h, 4 * h**2],
        ]
    )
    bending = np.array(
        [
            [12, 6 * h, -12, 6 * h],
            [6 * h, 4 * h**2, -6 * h, 2 * h**2],
            [-12, -6 * h, 12, -6 * h],
            [6 * h, 2 * h**2, -6 * h, 4 * h**2],
        ]
    )
    return mass * h / 420, tension / (30 * h), bending / h**3


@dataclass(frozen=True, eq=False)
class FixedRail:
    """A rail of `elements` elements of `length` (m) from x = 0 on, its ends clamped; upper bands for LAPACK."""

    mass: Array
    damping: Array
    stiffness: Array
    length: float
    elements: int

    @property
    def unknowns(self) -> int:
        """Deflection (m) and slope at every node."""
        return 2 * (self.elements + 1)


def fixed_rail(beam: Beam, length: float, elements: int) -> FixedRail:
    """Assemble `M = m INT N N`, `C = alpha INT N N + lam INT N' N'` and
    `K = EI INT N'' N'' + k_sm INT N' N' + k INT N N`.
    """
    mass, tension, bending = element_matrices(length)
    size = 2 * (elements + 1)
    bands = {name: np.zeros((4, size)) for name in ("mass", "damping", "stiffness")}
    element = {
        "mass": beam.mass * mass,
        "damping": beam.damping * mass + beam.shear_damping * tension,
        "stiffness": beam.bending * bending + beam.shear * tension + beam.stiffness * mass,
    }
    for name, band in bands.items():
        for i in range(4):
            for j in range(i, 4):
                np.add.at(band[3 + i - j], 2 * np.arange(elements) + j, element[name][i, j])
    # the clamped ends: next to unit mass and stiffness they do not move
    for held in (0, 1, size - 2, size - 1):
        bands["stiffness"][3, held] *= 1e12
    return FixedRail(**bands, length=length, elements=elements)


def _times(band: Array, vector: Array) -> Array:
    """Product of a symmetric matrix in upper bands with a vector."""
    result = band[3] * vector
    for k in (1, 2, 3):
        upper = band[3 - k, k:]
        result[:-k] += upper * vector[k:]
        result[k:] += upper * vector[:-k]
    return np.asarray(result)


def _shape(rail: FixedRail, x: float) -> tuple[int, Array]:
    """First unknown of the element under `x` and the values of its four cubics there."""
    element = min(int(x / rail.length), rail.elements - 1)
    p = x / rail.length - element
    values = [1 - 3 * p**2 + 2 * p**3, rail.length * p * (1 - p) ** 2, p**2 * (3 - 2 * p), rail.length * p**2 * (p - 1)]
    return 2 * element, np.array(values)


def roll(rail: FixedRail, places: Array, loads: Array, step: float) -> Array:
    """Deflection (m, up) under each of the loads, (steps, loads).

    `places` (steps, loads) in m along the rail and `loads` (steps, loads) in N downwards, at every `step` s; the rail
    starts at rest in the static shape under the first row.
    """
    from scipy.linalg import cho_solve_banded, cholesky_banded

    def pushed(row: int) -> Array:
        force = np.zeros(rail.unknowns)
        for x, load in zip(places[row], loads[row], strict=True):
            first, values = _shape(rail, x)
            force[first : first + 4] -= load * values
        return force

    def under(row: int, shape: Array) -> list[float]:
        spots = (_shape(rail, x) for x in places[row])
        return [float(shape[first : first + 4] @ values) for first, values in spots]

    effective = rail.mass * (4 / step**2) + rail.damping * (2 / step) + rail.stiffness
    factor = cholesky_banded(effective)
    y = cho_solve_banded((cholesky_banded(rail.stiffness), False), pushed(0))
    rate, second = np.zeros_like(y), np.zeros_like(y)
    result = [under(0, y)]
    for row in range(1, len(places)):
        inertia = _times(rail.mass, 4 / step**2 * y + 4 / step * rate + second)
        after = cho_solve_banded((factor, False), pushed(row) + inertia + _times(rail.damping, 2 / step * y + rate))
        new_rate = 2 / step * (after - y) - rate
        second = 4 / step**2 * (after - y) - 4 / step * rate - second
        y, rate = after, new_rate
        result.append(under(row, y))
    return np.array(result)
