"""The rail as a beam on a Pasternak foundation, in coordinates that move with the wagon.

Unknowns are deflection and slope at the nodes (cubic Hermite); matrices are kept in LAPACK band storage
(3 sub- and 3 super-diagonals). The first and last node carry no deflection but are free to turn.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg.blas import dgbmv
from scipy.linalg.lapack import dgbsv

BAND = 3


@dataclass(frozen=True)
class Rail:
    """Band matrices of shape-function products and coefficients of the rail equation.

    ``I01`` is the integral of N^T N', the digits counting derivatives, and so on; each (7, n).
    """

    I00: np.ndarray
    I01: np.ndarray
    I11: np.ndarray
    I12: np.ndarray
    I22: np.ndarray
    wheel_dofs: np.ndarray  # (4,), the deflection under each wheel; the slope is the next one
    mass: float
    bending: float
    stiffness: float
    shear: float
    damping: float
    shear_damping: float

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.I00.shape[1]

    @property
    def mass_matrix(self) -> np.ndarray:
        """Band mass matrix."""
        return self.mass * self.I00

    def damping_matrix(self, V: float) -> np.ndarray:
        """Band damping matrix at speed V."""
        return self.damping * self.I00 + self.shear_damping * self.I11 - 2.0 * self.mass * V * self.I01

    def stiffness_matrix(self, V: float, A: float) -> np.ndarray:
        """Band stiffness matrix at speed V and acceleration A."""
        return (
            self.bending * self.I22
            + self.stiffness * self.I00
            + (self.shear - self.mass * V**2) * self.I11
            - (self.damping * V + self.mass * A) * self.I01
            - self.shear_damping * V * self.I12
        )

    def wheel_loads(self) -> np.ndarray:
        """Columns that put a unit upward force under each wheel, (n, 4)."""
        columns = np.zeros((self.size, 4))
        columns[self.wheel_dofs, range(4)] = 1.0
        return columns


def times(band: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Band matrix times vector."""
    n = band.shape[1]
    return dgbmv(n, n, BAND, BAND, 1.0, band, vector)


def solve(band: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solve a band system for the columns of ``right``."""
    work = np.zeros((3 * BAND + 1, band.shape[1]))
    work[BAND:] = band
    _, _, solution, info = dgbsv(BAND, BAND, work, right)
    if info != 0:
        raise ArithmeticError(f"rail matrix is singular (LAPACK dgbsv returned {info})")
    return solution


def hermite(xi: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cubic Hermite functions, first and second derivative at ``xi`` in [0, 1], each (len(xi), 4)."""
    eta = 1.0 - xi
    N = np.stack([eta**2 * (1 + 2 * xi), h * xi * eta**2, xi**2 * (3 - 2 * xi), -h * xi**2 * eta], 1)
    dN = np.stack([-6 * xi * eta / h, eta * (1 - 3 * xi), 6 * xi * eta / h, xi * (3 * xi - 2)], 1)
    ddN = np.stack([(12 * xi - 6) / h**2, (6 * xi - 4) / h, (6 - 12 * xi) / h**2, (6 * xi - 2) / h], 1)
    return N, dN, ddN


def mesh_nodes(domain: float, element_length: float, wheels: np.ndarray) -> np.ndarray:
    """Nodes over ``[-domain/2, domain/2]``: equal elements between the wheels, none longer than asked for."""
    marks = np.concatenate([[-0.5 * domain], np.sort(wheels), [0.5 * domain]])
    if np.any(np.diff(marks) <= 0):
        raise ValueError(f"track domain must reach beyond the wheels, but is {domain} m long")
    pieces = []
    for left, right in pairwise(marks):
        count = int(np.ceil((right - left) / element_length - 1e-9))
        pieces.append(np.linspace(left, right, count + 1)[:-1])
    return np.concatenate([*pieces, marks[-1:]])


def _assemble(nodes: np.ndarray) -> list[np.ndarray]:
    """Dense global matrices of the five integrals by four-point Gauss quadrature (exact for degree 7)."""
    points, weights = np.polynomial.legendre.leggauss(4)
    xi, weights = 0.5 * (points + 1.0), 0.5 * weights
    matrices = [np.zeros((2 * len(nodes), 2 * len(nodes))) for _ in range(5)]
    for element, h in enumerate(np.diff(nodes)):
        N, dN, ddN = hermite(xi, h)
        where = slice(2 * element, 2 * element + 4)
        for matrix, (left, right) in zip(matrices, [(N, N), (N, dN), (dN, dN), (dN, ddN), (ddN, ddN)], strict=True):
            matrix[where, where] += h * (left * weights[:, None]).T @ right
    return matrices


def _band(dense: np.ndarray) -> np.ndarray:
    """LAPACK band storage: ``band[BAND + i - j, j] = dense[i, j]``."""
    n = len(dense)
    band = np.zeros((2 * BAND + 1, n))
    for offset in range(-BAND, BAND + 1):
        diagonal = np.diagonal(dense, -offset)
        start = max(0, -offset)
        band[BAND + offset, start : start + len(diagonal)] = diagonal
    return band


def rail_of(scenario, wheels: np.ndarray, element_length: float | None = None) -> Rail:
    """Rail under a wagon whose axles sit at ``wheels`` (m ahead of its centre, wheel 1 first)."""
    rail, foundation, domain = scenario.track.rail, scenario.track.foundation, scenario.track.domain
    nodes = mesh_nodes(domain.length, element_length or domain.element_length, wheels)
    free = np.delete(np.arange(2 * len(nodes)), [0, 2 * len(nodes) - 2])
    bands = [_band(matrix[np.ix_(free, free)]) for matrix in _assemble(nodes)]
    wheel_nodes = [int(np.argmin(np.abs(nodes - position))) for position in wheels]
    return Rail(
        *bands,
        wheel_dofs=np.array([2 * node - 1 for node in wheel_nodes]),
        mass=rail.mass_per_length,
        bending=rail.youngs_modulus * rail.second_moment,
        stiffness=foundation.stiffness,
        shear=foundation.shear_stiffness,
        damping=foundation.damping,
        shear_damping=foundation.shear_damping,
    )
