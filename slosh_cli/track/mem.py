"""Rail as an Euler-Bernoulli beam on a damped Pasternak foundation, by the moving element method.

The mesh travels with the wagon (`r = x - s(t)`), so the wheels stay on fixed nodes and the motion enters through
the matrices (model section 6; C. G. Koh et al., "Moving element method for train-track dynamics", Int. J. Numer.
Meth. Engng 56 (2003) 1549-1567). Cubic Hermite elements, nodal unknowns deflection (m, up) and slope (rad).
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slosh_cli.scenario import Track

Array = NDArray[np.float64]
HALF_BAND = 3
"""Diagonals on either side of the main one in every rail matrix."""


class RailModel(NamedTuple):
    """Semi-discrete rail. Unknowns (n,): slope at the left end, deflection and slope node by node, last slope.

    The five forms are stored by diagonals, `form[HALF_BAND + j - i, i]`, shape (7, n), with N the shape functions:
    `mass_form` INT N N, `tension_form` INT N' N', `drift_form` INT N N', `bending_form` INT N'' N'',
    `twist_form` INT N' N''. `contact` (4,) are the unknowns under wheels 1 to 4; the slope follows each.
    """

    mass_form: Array
    tension_form: Array
    drift_form: Array
    bending_form: Array
    twist_form: Array
    contact: NDArray[np.int64]
    mass: float  # kg/m
    bending_stiffness: float  # N m^2
    stiffness: float  # N/m^2
    shear_stiffness: float  # N
    damping: float  # N s/m^2
    shear_damping: float  # N s


def fitted_nodes(wheels: Array, length: float, element_length: float) -> Array:
    """Nodes (m, ascending) of a domain of `length` centred on the wheels, one node at every wheel.

    Between fixed points the number of elements is the rounded quotient, so elements differ from
    `element_length` by what the wheel spacing demands. Raises ValueError where the wheels do not fit.
    """
    middle = 0.5 * (wheels.max() + wheels.min())
    fixed = np.concatenate([[middle - 0.5 * length], np.sort(wheels), [middle + 0.5 * length]])
    if np.any(np.diff(fixed) <= 0):
        raise ValueError(f"the wheels do not fit into a domain of {length} m")
    pieces = [
        np.linspace(left, right, max(1, round((right - left) / element_length)), endpoint=False)
        for left, right in pairwise(fixed)
    ]
    return np.concatenate([*pieces, fixed[-1:]])


def _hermite(lengths: Array) -> tuple[Array, Array, Array, Array]:
    """Shape functions, first and second derivatives at 4 Gauss points of each element (4, 4, n); the weights (4, n)."""
    points, weights = np.polynomial.legendre.leggauss(4)
    x = 0.5 * (points + 1)
    value = np.array([1 - 3 * x**2 + 2 * x**3, x * (1 - x) ** 2, x**2 * (3 - 2 * x), x**2 * (x - 1)])
    slope = np.array([6 * x**2 - 6 * x, 1 - 4 * x + 3 * x**2, 6 * x - 6 * x**2, 3 * x**2 - 2 * x])
    curve = np.array([12 * x - 6, 6 * x - 4, 6 - 12 * x, 6 * x - 2])
    size = lengths ** np.array([[[0]], [[1]], [[0]], [[1]]])  # functions 2 and 4 are those of the slopes
    value, slope, curve = (unit[:, :, None] * size / lengths**k for k, unit in enumerate((value, slope, curve)))
    return value, slope, curve, 0.5 * lengths * weights[:, None]


def _element_forms(lengths: Array) -> Array:
    """The five 4 x 4 matrices of each element in the order of `RailModel`; (5, n, 4, 4)."""
    value, slope, curve, w = _hermite(lengths)
    pairs = ((value, value), (slope, slope), (value, slope), (curve, curve), (slope, curve))
    return np.array([np.einsum("ign,jgn,gn->nij", left, right, w) for left, right in pairs])


def rail_model(track: Track, wheels: Array) -> RailModel:
    """Assemble the rail under `wheels` (m, positions of wheels 1 to 4 relative to the wagon's centre)."""
    nodes = fitted_nodes(wheels, track.domain.length, track.domain.element_length)
    unknowns = 2 * nodes.size - 2  # the deflection at either end is held at zero
    forms = np.zeros((5, 2 * HALF_BAND + 1, unknowns))
    # unknown k of node i (k = 0 deflection, 1 slope); -1 where held
    numbers = np.arange(2 * nodes.size).reshape(-1, 2) - 1
    numbers[-1] = -1, unknowns - 1
    places = np.hstack([numbers[:-1], numbers[1:]])
    rows, columns = np.broadcast_arrays(places[:, :, None], places[:, None, :])
    free = (rows >= 0) & (columns >= 0)
    bands = HALF_BAND + columns[free] - rows[free]
    for form, of_elements in zip(forms, _element_forms(np.diff(nodes)), strict=True):
        np.add.at(form, (bands, rows[free]), of_elements[free])
    contact = np.array([numbers[np.argmin(np.abs(nodes - wheel)), 0] for wheel in wheels], dtype=np.int64)
    foundation = track.foundation
    return RailModel(
        mass_form=forms[0],
        tension_form=forms[1],
        drift_form=forms[2],
        bending_form=forms[3],
        twist_form=forms[4],
        contact=contact,
        mass=track.rail.mass_per_length,
        bending_stiffness=track.rail.youngs_modulus * track.rail.second_moment,
        stiffness=foundation.stiffness,
        shear_stiffness=foundation.shear_stiffness,
        damping=foundation.damping,
        shear_damping=foundation.shear_damping,
    )


def critical_speed(rail: RailModel) -> float:
    """Lowest speed (m/s) at which a moving load meets a free wave of the undamped track (model section 6)."""
    return float(np.sqrt((rail.shear_stiffness + 2 * np.sqrt(rail.stiffness * rail.bending_stiffness)) / rail.mass))


def steady_matrix(rail: RailModel, speed: float) -> Array:
    """Banded K of model section 6 at constant `speed` (m/s), laid out like the forms; (7, n)."""
    tension = rail.shear_stiffness - rail.mass * speed**2
    return (
        rail.bending_stiffness * rail.bending_form
        + rail.stiffness * rail.mass_form
        + tension * rail.tension_form
        - rail.damping * speed * rail.drift_form
        - rail.shear_damping * speed * rail.twist_form
    )


def steady_shapes(rail: RailModel, speed: float) -> Array:
    """Steady rail shapes (n, 4) at constant `speed` (m/s) under a downward unit force at each wheel, m/N."""
    from scipy.linalg import solve_banded

    banded = steady_matrix(rail, speed)
    size = banded.shape[1]
    diagonals = np.zeros((2 * HALF_BAND + 1, size))
    for offset in range(-HALF_BAND, HALF_BAND + 1):  # LAPACK stores a diagonal by columns
        rows = np.arange(max(0, -offset), min(size, size - offset))
        diagonals[HALF_BAND - offset, rows + offset] = banded[HALF_BAND + offset, rows]
    loads = np.zeros((size, rail.contact.size))
    loads[rail.contact, np.arange(rail.contact.size)] = -1.0
    return np.asarray(solve_banded((HALF_BAND, HALF_BAND), diagonals, loads))
