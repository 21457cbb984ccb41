"""Rail as an Euler-Bernoulli beam on a damped Pasternak foundation, by the moving element method.

The mesh travels with the wagon (`r = x - s(t)`), so the wheels stay on fixed nodes and the motion enters through
the matrices (theory section 6; C. G. Koh et al., "Moving element method for train-track dynamics", Int. J. Numer.
Meth. Engng 56 (2003) 1549-1567). Cubic Hermite elements, nodal unknowns deflection (m, up) and slope (rad).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from slosh_cli.arrays import Integers, Matrix, Tesseract, Unsigned, Vector
from slosh_cli.blocks import Block
from slosh_cli.scenario import Track
from slosh_cli.track.banded import END, ENTRIES, FIRST, factor_rows, solve_four

_UNBENDING = 1e300
"""N m^2; a bending stiffness past all others."""
MASS, TENSION, DRIFT, BENDING, TWIST, _FORMS = range(0, 6 * ENTRIES, ENTRIES)
"""Where each form's entries begin in `RailModel.forms`."""


class RailModel(Block):
    """Semi-discrete rail. Unknowns (2 n,): the deflections of all n nodes, then their slopes.

    Five forms, one after the other in rows of nodes as `banded` describes them: `forms` (r, 60) for `runs` (r, 4). With
    N the shape functions they are `MASS` INT N N, `TENSION` INT N' N', `DRIFT` INT N N', `BENDING` INT N'' N'', `TWIST`
    INT N' N''. The deflection at either end is held: its rows are zero but for a mass of its own, so that it stays
    at zero. `contact` (wheels,) are the nodes under the wheels. A rail of springs has one node per wheel and `MASS` one
    for each alone; mass, stiffness and damping are then those of a wheel's spring.
    """

    runs: Unsigned
    forms: Matrix
    contact: Integers
    nodes: int
    mass: float  # kg/m
    bending_stiffness: float  # N m^2
    stiffness: float  # N/m^2
    shear_stiffness: float  # N
    damping: float  # N s/m^2
    shear_damping: float  # N s


def _spans(wheels: Vector, length: float, element_length: float) -> tuple[Vector, Integers]:
    """Ends (m, ascending) of the spans between wheels and domain ends, and their numbers of elements."""
    middle = 0.5 * (wheels.max() + wheels.min())
    fixed = np.concatenate([[middle - 0.5 * length], np.sort(wheels), [middle + 0.5 * length]])
    if np.any(np.diff(fixed) <= 0):
        raise ValueError(f"the wheels do not fit into a domain of {length} m")
    return fixed, np.maximum(np.rint(np.diff(fixed) / element_length).astype(np.int64), 1)


def fitted_nodes(wheels: Vector, length: float, element_length: float) -> Vector:
    """Nodes (m, ascending) of a domain of `length` centred on the wheels, one node at every wheel.

    Between fixed points the number of elements is the rounded quotient, so elements differ from
    `element_length` by what the wheel spacing demands. Raises ValueError where the wheels do not fit.
    """
    fixed, elements = _spans(wheels, length, element_length)
    pieces = [
        np.linspace(left, right, number, endpoint=False)
        for (left, right), number in zip(pairwise(fixed), elements, strict=True)
    ]
    return np.concatenate([*pieces, fixed[-1:]])


def _hermite(lengths: Vector) -> tuple[Vector, Vector, Vector, Vector]:
    """Shape functions, first and second derivatives at 4 Gauss points of each element (4, 4, n); the weights (4, n)."""
    points, weights = np.polynomial.legendre.leggauss(4)
    x = 0.5 * (points + 1)
    value = np.array([1 - 3 * x**2 + 2 * x**3, x * (1 - x) ** 2, x**2 * (3 - 2 * x), x**2 * (x - 1)])
    slope = np.array([6 * x**2 - 6 * x, 1 - 4 * x + 3 * x**2, 6 * x - 6 * x**2, 3 * x**2 - 2 * x])
    curve = np.array([12 * x - 6, 6 * x - 4, 6 - 12 * x, 6 * x - 2])
    size = lengths ** np.array([[[0]], [[1]], [[0]], [[1]]])  # functions 2 and 4 are those of the slopes
    value, slope, curve = (unit[:, :, None] * size / lengths**k for k, unit in enumerate((value, slope, curve)))
    return value, slope, curve, 0.5 * lengths * weights[:, None]


def _element_forms(lengths: Vector) -> Vector:
    """The five 4 x 4 matrices of each element in the order of `RailModel`; (5, n, 4, 4)."""
    value, slope, curve, w = _hermite(lengths)
    pairs = ((value, value), (slope, slope), (value, slope), (curve, curve), (slope, curve))
    return np.array([np.einsum("ign,jgn,gn->nij", left, right, w) for left, right in pairs])


def _rows(forms: Vector, left: int | None, right: int | None) -> Vector:
    """The rows (60,) of a node between elements of the spans `left` and `right`; without one it is an end."""
    rows = np.zeros((len(forms), 2, 6))
    if left is not None:
        rows[:, :, :4] += forms[:, left, 2:]
    if right is not None:
        rows[:, :, 2:] += forms[:, right, :2]
    if left is None or right is None:
        rows[:, 0] = 0.0
        rows[0, 0, 2] = 1.0
    return rows.ravel()


def rail_model(track: Track, wheels: Vector) -> RailModel:
    """The rail under `wheels` (m, their positions relative to the wagon's centre), by the model of the track.

    Raises ValueError where the wheels do not fit, or a length of the domain is still to be computed.
    """
    if track.model == "rigid":
        return _springs(track, wheels.size)
    length, element_length = track.domain.length, track.domain.element_length
    if length is None or element_length is None:
        raise ValueError("length and element_length of the domain must be given here")
    fixed, elements = _spans(wheels, length, element_length)
    of_spans = _element_forms(np.diff(fixed) / elements)
    ends, spans = np.cumsum([0, *elements]), len(elements)
    bounds, forms = [], []
    for span, (first, end) in enumerate(pairwise(ends)):
        bounds += [(first, first + 1), (first + 1, end)]
        forms += [_rows(of_spans, span - 1 if span else None, span), _rows(of_spans, span, span)]
    bounds.append((ends[-1], ends[-1] + 1))
    forms.append(_rows(of_spans, spans - 1, None))
    runs = np.array([(first, end, max(first - 1, 0), min(first + 1, ends[-1])) for first, end in bounds])
    filled = runs[:, FIRST] < runs[:, END]
    contact = ends[np.searchsorted(fixed, wheels)]
    foundation = track.foundation
    return RailModel(
        runs=runs[filled].astype(np.uint64),
        forms=np.array(forms)[filled],
        contact=contact,
        nodes=int(runs[filled][-1, END]),
        mass=track.rail.mass_per_length,
        bending_stiffness=track.rail.youngs_modulus * track.rail.second_moment,
        stiffness=foundation.stiffness,
        shear_stiffness=foundation.shear_stiffness,
        damping=foundation.damping,
        shear_damping=foundation.shear_damping,
    )


def _springs(track: Track, wheels: int) -> RailModel:
    """The rail's static stiffness under each wheel, with what moves and what damps in the shape of a static load.

    That shape is `y = y0 (r2 exp(-r1 |x|) - r1 exp(-r2 |x|))/(r2 - r1)`, with r1 and r2 the roots of
    `EI r^4 - k_sm r^2 + k = 0`; with their sum s and product p its integrals are `INT y^2 = y0^2 (s^2 + p)/(p s)` and
    `INT y'^2 = y0^2 p/s`, the stiffness is `2 EI p s` (theory section 6). Each wheel has a node of its own.
    """
    foundation, bending = track.foundation, track.rail.youngs_modulus * track.rail.second_moment
    product = np.sqrt(foundation.stiffness / bending)
    total = np.sqrt(foundation.shear_stiffness / bending + 2.0 * product)
    length, slopes = (total * total + product) / (product * total), product / total
    forms = np.zeros((1, _FORMS))
    forms[0, MASS + 2] = forms[0, MASS + 9] = 1.0
    return RailModel(
        runs=np.array([[0, wheels, 0, 0]], dtype=np.uint64),
        forms=forms,
        contact=np.arange(wheels),
        nodes=wheels,
        mass=track.rail.mass_per_length * length,
        bending_stiffness=_UNBENDING,  # nothing bends, and what bounds the waves of a rail finds none
        stiffness=2.0 * bending * product * total,
        shear_stiffness=0.0,
        damping=foundation.damping * length + foundation.shear_damping * slopes,
        shear_damping=0.0,
    )


def critical_speed(rail: RailModel) -> float:
    """Lowest speed (m/s) at which a moving load meets a free wave of the undamped track (theory section 6)."""
    return float(np.sqrt((rail.shear_stiffness + 2 * np.sqrt(rail.stiffness * rail.bending_stiffness)) / rail.mass))


def steady_rows(rail: RailModel, speed: float) -> Vector:
    """Rows (r, 12) of the K of theory section 6 at constant `speed` (m/s)."""
    mass, stretch, drift, bend, twist = np.split(rail.forms, _FORMS // ENTRIES, axis=1)
    tension = rail.shear_stiffness - rail.mass * speed**2
    return (
        rail.bending_stiffness * bend
        + rail.stiffness * mass
        + tension * stretch
        - rail.damping * speed * drift
        - rail.shear_damping * speed * twist
    )


def steady_shapes(rail: RailModel, speed: float) -> Matrix:
    """Steady rail shapes (2 n, wheels) at constant `speed` (m/s) under a downward unit force at each wheel, m/N."""
    factors, loads = np.zeros((ENTRIES, rail.nodes)), unit_loads(rail)
    factor_rows(rail.runs, steady_rows(rail, speed), factors)
    for group in loads:
        solve_four(factors, group)
    shapes = -loads.transpose(2, 1, 0, 3).reshape(2 * rail.nodes, -1)
    return shapes[:, : rail.contact.size]


def unit_loads(rail: RailModel) -> Tesseract:
    """An upward unit force at each wheel: (groups of four wheels, nodes, 2, 4), the last group filled up with zeros."""
    loads = np.zeros((-(-rail.contact.size // 4), rail.nodes, 2, 4))
    for wheel, node in enumerate(rail.contact):
        loads[wheel // 4, node, 0, wheel % 4] = 1.0
    return loads
