"""The plane eigenproblem of sloshing over a wetted half section (theory section 4), by quadratic elements.

`(d_yy + d_zz - k^2) phi = 0` in the liquid, `d phi/dn = 0` on the wall, `d phi/dz = kappa phi` on the free
surface with `kappa = omega^2/g`. In the weak form, for all v,

    integral(grad phi . grad v + k^2 phi v) dA = kappa integral(phi v) dy over the surface.

scikit-fem and scipy are imported where they are used: a run with given coefficients does without them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Any

import numpy as np

from slosh_cli.tank.mesh import Floats, Ints, SectionMesh
from slosh_cli.tank.wetted import Side

_QUADRATURE = 6  # exact for products of two quadratics on elements with a curved edge

_LANCZOS = 12  # vectors kept by the Lanczos iteration; a first mode is found in as many solves and a few


class Parity(IntEnum):
    """How the potential continues across the plane of symmetry."""

    SYMMETRIC = 1
    ANTISYMMETRIC = -1


@dataclass(frozen=True)
class _SurfaceModes:
    """The lowest modes of one wavenumber: `kappa` (m,) in 1/m, `potential` (unknowns, m) of unit mean square
    over the surface."""

    kappa: Floats
    potential: Floats


class HalfSectionElements:
    """The assembled operators of one mesh; sparse matrices over its unknowns (nodes and edge middles)."""

    def __init__(self, mesh: SectionMesh) -> None:
        from skfem import Basis, ElementTriP2, FacetBasis

        self.section_mesh = mesh
        self.mesh = mesh.for_finite_elements()
        at_surface = self.mesh.facets[Side.SURFACE]
        self.basis = Basis(self.mesh.curved, ElementTriP2(), intorder=_QUADRATURE)
        self.surface = FacetBasis(self.mesh.straight, ElementTriP2(), facets=at_surface, intorder=_QUADRATURE)
        self.stiffness, self.mass = self._area_matrices()
        self.surface_mass = self._surface_matrix()
        self.surface_unknowns = self._unknowns_on(at_surface)
        self.symmetry_unknowns = self._unknowns_on(self.mesh.facets[Side.SYMMETRY])

    def _unknowns_on(self, facets: Ints) -> Ints:
        return np.asarray(self.basis.get_dofs(facets).flatten(), dtype=np.int64)

    def _area_matrices(self) -> tuple[Any, Any]:
        from skfem import BilinearForm
        from skfem.helpers import dot, grad

        stiffness = BilinearForm(lambda u, v, _: dot(grad(u), grad(v)))
        mass = BilinearForm(lambda u, v, _: u * v)
        return stiffness.assemble(self.basis), mass.assemble(self.basis)

    def _surface_matrix(self) -> Any:
        from skfem import BilinearForm

        return BilinearForm(lambda u, v, _: u * v).assemble(self.surface)

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return int(self.basis.N)

    @cached_property
    def area_of(self) -> Floats:
        """Weights (unknowns,) whose product with a field is its integral over the half area."""
        return self._area_weights(lambda v, _: v)

    @cached_property
    def area_of_height_times(self) -> Floats:
        """Weights for the integral of z times a field over the half area."""
        return self._area_weights(lambda v, w: w.x[1] * v)

    @cached_property
    def area_of_slope(self) -> Floats:
        """Weights for the integral of a field's d/dz over the half area (the boundary's with n_z)."""
        return self._area_weights(lambda v, _: v.grad[1])

    def _area_weights(self, integrand: Any) -> Floats:
        from skfem import LinearForm

        return np.asarray(LinearForm(integrand).assemble(self.basis), dtype=np.float64)

    @cached_property
    def surface_of(self) -> Floats:
        """Weights for the integral of a field over the half surface."""
        return np.asarray(self.surface_mass @ np.ones(self.size), dtype=np.float64)

    def modes(self, wavenumber: float, count: int = 1, parity: Parity = Parity.SYMMETRIC) -> _SurfaceModes:
        """The `count` lowest modes with `wavenumber` (1/m) along the tank.

        A symmetric problem with wavenumber 0 has the constant as a mode without frequency and is refused
        with ValueError.
        """
        if wavenumber == 0.0 and parity is Parity.SYMMETRIC:
            raise ValueError("wavenumber must be above 0 for symmetric modes, but 0 was given")
        operator = (self.stiffness + wavenumber**2 * self.mass).tocsc()
        free = np.arange(self.size)
        if parity is Parity.ANTISYMMETRIC:
            free = np.setdiff1d(free, self.symmetry_unknowns)
            operator = operator[free][:, free]
        surface = np.intersect1d(self.surface_unknowns, free)
        surface = surface[np.argsort(self.basis.doflocs[0, surface])]  # along y: the mass matrix is narrow
        mass = self.surface_mass[surface][:, surface]
        kappa, potential = _lowest(operator, np.searchsorted(free, surface), mass, count)
        whole = np.zeros((self.size, count))
        whole[free] = potential
        return _SurfaceModes(kappa, whole)


def _lowest(matrix: Any, surface: Ints, mass: Any, count: int) -> tuple[Floats, Floats]:
    """Lowest modes by Lanczos iteration on the inverse operator as the surface sees it.

    With the surface's mass matrix `mass` = R R^T, `u = R^T phi` obeys `R^T inverse R u = u / kappa`: an
    ordinary symmetric problem in the surface unknowns alone, whose positions in `matrix` are `surface`.
    """
    from scipy.sparse.linalg import LinearOperator, eigsh

    solve, root = factorised(matrix), _banded_root(mass)
    transposed = root.T.tocsr()

    def potential_of(vector: Floats) -> Floats:
        load = np.zeros(matrix.shape[0])
        load[surface] = root @ vector
        return np.asarray(solve(load))

    def from_surface(vector: Floats) -> Floats:
        return np.asarray(transposed @ potential_of(vector.ravel())[surface], dtype=np.float64)

    operator = LinearOperator(mass.shape, matvec=from_surface, dtype=np.float64)
    start = np.asarray(transposed @ np.ones(len(surface)), dtype=np.float64)
    basis = min(len(surface), max(_LANCZOS, 2 * count + 8))
    inverse, vectors = eigsh(operator, k=count, which="LA", v0=start, ncv=basis, tol=0.0)
    order = np.argsort(-inverse)
    potentials = [potential_of(vectors[:, one]) / inverse[one] for one in order]
    return 1.0 / inverse[order], np.column_stack(potentials)


def _banded_root(mass: Any) -> Any:
    """Sparse Cholesky factor of the surface's mass matrix: neighbours along y couple two apart at most."""
    from scipy.linalg import cholesky_banded
    from scipy.sparse import diags_array

    bands = np.zeros((3, mass.shape[0]))
    for offset in range(3):
        bands[offset, : mass.shape[0] - offset] = mass.diagonal(-offset)
    factor = cholesky_banded(bands, lower=True)
    rows: Any = [factor[k, : mass.shape[0] - k] for k in range(3)]
    return diags_array(rows, offsets=[0, -1, -2]).tocsr()


def factorised(matrix: Any) -> Callable[[Floats], Floats]:
    """A function that solves with a sparse symmetric positive definite matrix (in compressed columns)."""
    from scipy.sparse.linalg import splu

    symmetric = {"SymmetricMode": True}
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric).solve
