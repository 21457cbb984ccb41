"""What the rail tests compare with: exact element integrals, closed forms and Fourier integrals (theory section 6).

Nothing here uses the formulas under test; the exact solutions are those that `slosh validate` compares with.
"""

from itertools import pairwise, product

import numpy as np
from numpy.polynomial import Polynomial

from slosh_cli.scenario import Domain, Foundation, Rail, Track
from slosh_cli.track.mem import BENDING, DRIFT, TENSION, TWIST
from slosh_cli.track.mem import MASS as MASS_FORM
from slosh_cli.validation.exact import steady_rail

WHEELS = np.array([4.0, 0.0, -2.0, -4.0])
"""Wheel 2 is the loaded one: it stands in the middle of the domain, and every spacing is a multiple of 1 m."""
LOADED = 1
EI, MASS, K, SHEAR = 200e9 * 3.06e-5, 60.0, 1.0e7, 666875.0
FORMS = {MASS_FORM: (0, 0), TENSION: (1, 1), DRIFT: (0, 1), BENDING: (2, 2), TWIST: (1, 2)}
"""Order of the derivatives of the left and right shape function in each form."""


def track(element_length=0.5, length=80.0, shear=SHEAR, damping=0.0, shear_damping=0.0, stiffness=K):
    """The paper's track, undamped unless asked for."""
    return Track(
        rail=Rail(youngs_modulus=200e9, second_moment=3.06e-5, mass_per_length=MASS),
        foundation=Foundation(stiffness=stiffness, shear_stiffness=shear, damping=damping, shear_damping=shear_damping),
        domain=Domain(length=length, element_length=element_length),
    )


def dense(runs, rows):
    """Full matrix (2 n, 2 n) from rows (r, 12) that are equal in each of the `runs` of nodes."""
    nodes = int(runs[-1, 1])
    full = np.zeros((2, nodes, 2, nodes))
    for (first, end, *_), row in zip(runs.astype(int), rows.reshape(-1, 2, 3, 2), strict=True):
        for node, place in product(range(first, end), (-1, 0, 1)):
            if 0 <= node + place < nodes:
                full[:, node, :, node + place] = row[:, place + 1]
    return full.reshape(2 * nodes, 2 * nodes)


def form_of(rail, form):
    """A form of the rail as a full matrix."""
    return dense(rail.runs, rail.forms[:, form : form + 12])


def free(nodes):
    """The unknowns that are not held: all but the deflections at both ends."""
    return np.delete(np.arange(2 * nodes), [0, nodes - 1])


def hermite(length):
    """The four cubics of an element of `length` as exact polynomials of the local x, from their four conditions."""
    conditions = [[1, 0, 0, 0], [0, 1, 0, 0], [1, length, length**2, length**3], [0, 1, 2 * length, 3 * length**2]]
    return [Polynomial(np.linalg.solve(np.array(conditions, dtype=float), row)) for row in np.eye(4)]


def exact_form(nodes, left, right):
    """INT (d^left N_i) (d^right N_j) over all elements between `nodes`, in the program's order, nothing held."""
    full = np.zeros((2 * nodes.size, 2 * nodes.size))
    for e, (a, b) in enumerate(pairwise(nodes)):
        shapes = hermite(b - a)
        for i, j in product(range(4), repeat=2):
            integral = (shapes[i].deriv(left) * shapes[j].deriv(right)).integ()
            full[2 * e + i, 2 * e + j] += integral(b - a) - integral(0.0)
    order = np.arange(2 * nodes.size).reshape(-1, 2).T.ravel()
    return full[np.ix_(order, order)]


def held_values(values, slopes):
    """Nodal values and slopes in the program's order, the deflections of both ends held at zero."""
    return np.concatenate([[0.0], values[1:-1], [0.0], slopes])


def closed_form(r, speed, shear=SHEAR, stiffness=K):
    """Undamped steady deflection (m, down) per newton at distance `r` from a load moving at `speed`."""
    return steady_rail.closed_form(steady_rail.Beam(EI, MASS, stiffness, shear), r, speed)


def fourier_deflection(r, speed, shear, damping, shear_damping):
    """Steady deflection (m, down) per newton with damping, by quadrature."""
    return steady_rail.fourier_integral(steady_rail.Beam(EI, MASS, K, shear, damping, shear_damping), r, speed)
