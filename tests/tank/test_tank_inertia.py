"""Added mass and the pitch inertia under a lid: closed forms, an independent solution, and the sum rule."""

import math

import numpy as np
import pytest
from rigid_part import added_mass, free_masses
from tank_examples import BOTTLE, V_TROUGH, box, cylinder, ellipse, polygon

from slosh_cli.scenario import Liquid
from slosh_cli.section import liquid_depth, section_of
from slosh_cli.tank import inertia
from slosh_cli.tank.coefficients import computed_modes
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.inertia import stokes_joukowski_inertia
from slosh_cli.tank.load import frozen_load

HARMONICS = 2.0 * np.arange(20000) + 1.0

BOXES = [
    pytest.param(box(0.5), id="half-filled"),
    pytest.param(box(0.3, length=15.5), id="long"),
    pytest.param(box(0.02, length=15.5), id="a puddle"),
    pytest.param(box(0.9, width=0.5, height=1.0, length=0.2), id="a slice"),
]


@pytest.mark.parametrize("tank", BOXES)
def test_added_mass_of_a_rectangular_tank(tank):
    """m_l - (8 rho B / L) sum tanh(k h) / k^3, from chi = cosh(k z) / cosh(k h)."""
    depth, mass = liquid_depth(tank), frozen_load(tank).mass
    k = HARMONICS * math.pi / tank.length
    exact = mass - 8.0 * 998.2 * tank.width / tank.length * (np.tanh(k * depth) / k**3).sum()
    assert added_mass(tank) == pytest.approx(exact, abs=1e-5 * mass)


def test_added_mass_against_finite_elements_along_the_tank():
    """Another plane of the same box: d phi/dn = n_x on floor and ends, phi = 0 above, mass = rho INT grad(phi)^2."""
    from skfem import Basis, BilinearForm, ElementTriP2, FacetBasis, LinearForm, MeshTri, condense, solve
    from skfem.helpers import dot, grad

    tank = box(0.5)
    length, depth = tank.length, 1.5
    corner = 0.5 * (1.0 - np.cos(np.linspace(0.0, math.pi, 41)))
    mesh = MeshTri.init_tensor(length * corner, depth * (1.0 - (1.0 - np.linspace(0.0, 1.0, 31)) ** 2))
    basis = Basis(mesh, ElementTriP2())
    ends = [mesh.facets_satisfying(lambda x, at=at: np.isclose(x[0], at)) for at in (0.0, length)]
    push = sum(
        normal * LinearForm(lambda v, w: v).assemble(FacetBasis(mesh, ElementTriP2(), facets=facets))
        for normal, facets in zip((-1.0, 1.0), ends, strict=True)
    )
    stiffness = BilinearForm(lambda u, v, w: dot(grad(u), grad(v))).assemble(basis)
    surface = basis.get_dofs(mesh.facets_satisfying(lambda x: np.isclose(x[1], depth)))
    potential = solve(*condense(stiffness, push, D=surface))
    assert added_mass(tank) == pytest.approx(998.2 * tank.width * (push @ potential), rel=1e-4)


@pytest.mark.parametrize("tank", BOXES)
def test_pitch_inertia_under_a_lid_of_a_rectangular_tank(tank):
    """From psi = sinh(k (z - h/2)) / (k cosh(k h / 2))."""
    depth, frozen = liquid_depth(tank), frozen_load(tank).pitch_inertia
    k = HARMONICS * math.pi / tank.length
    slip = (depth - 2.0 * np.tanh(k * depth / 2.0) / k) / k**4
    exact = frozen - 998.2 * 32.0 * tank.width / tank.length * slip.sum()
    assert stokes_joukowski_inertia(tank) == pytest.approx(exact, abs=1e-5 * frozen)


def test_a_square_of_liquid_resists_as_saint_venants_torsion_says():
    """The flow in a turning square is the warping of a twisted bar: J/J_l = 1 - torsion constant / polar moment."""
    tank = box(0.5, width=1.0, height=2.0, length=1.0)
    torsion_constant, polar_moment = 0.1405770, 1.0 / 6.0  # of a unit square; Timoshenko and Goodier, art. 109
    share = stokes_joukowski_inertia(tank) / frozen_load(tank).pitch_inertia
    assert share == pytest.approx(1.0 - torsion_constant / polar_moment, rel=1e-5)


SHAPES = {
    "cylinder, a fifth": cylinder(0.2),
    "cylinder, half": cylinder(0.5),
    "cylinder, three quarters": cylinder(0.75),
    "ellipse": ellipse(0.4),
    "trough": polygon(V_TROUGH, 0.6),
    "bottle": polygon(BOTTLE, 0.4),
}


@pytest.mark.parametrize("name", SHAPES)
def test_added_mass_and_all_slosh_masses_make_up_the_liquid(name):
    """What is missing after N modes along the tank falls as N^-2, by (8 rho B / L) sum over n > N of 1 / k^3."""
    tank = SHAPES[name]
    mass = frozen_load(tank).mass
    masses = free_masses(tank, 16, 16)
    rigid = added_mass(tank)
    counts = np.array([2, 4, 8, 16])
    missing = np.array([1.0 - (rigid + masses[:count].sum()) / mass for count in counts])
    assert np.all(missing > 0.0)
    width = section_of(tank).surface_width(liquid_depth(tank))
    numbers = HARMONICS[16:]
    rest = 8.0 * 998.2 * width / tank.length * (tank.length / math.pi) ** 3 * (numbers**-3.0).sum() / mass
    assert missing[-1] == pytest.approx(rest, rel=0.3)
    assert missing[-1] < 2e-3


@pytest.mark.parametrize("name", ["cylinder, half", "trough"])
def test_the_sum_over_modes_closes_with_the_square_of_their_number(name):
    tank = SHAPES[name]
    mass = frozen_load(tank).mass
    masses, rigid = free_masses(tank, 16, 6), added_mass(tank)
    missing = np.array([1.0 - (rigid + masses[:count].sum()) / mass for count in (4, 8, 16)])
    assert np.log2(missing[:-1] / missing[1:]) == pytest.approx([2.0, 2.0], abs=0.15)


def test_only_the_first_column_counts_in_a_box():
    tank = box(0.5)
    masses = free_masses(tank, 3, 4)
    assert masses[:, 0] == pytest.approx([mode.slosh_mass for mode in computed_modes(tank, 3)], rel=1e-5)
    assert np.abs(masses[:, 1:]).max() < 1e-6 * masses[0, 0]


def test_the_first_column_are_the_modes_of_the_coefficients():
    tank = cylinder(0.75)
    expected = [mode.slosh_mass for mode in computed_modes(tank, 3)]
    assert free_masses(tank, 3, 3)[:, 0] == pytest.approx(expected, rel=3e-5)


@pytest.mark.parametrize("fill", [0.02, 0.3, 0.7, 0.98])
def test_rigid_parts_lie_between_nothing_and_the_frozen_load(fill):
    tank = cylinder(fill)
    load = frozen_load(tank)
    assert 0.0 < added_mass(tank) < load.mass
    assert 0.0 < stokes_joukowski_inertia(tank) < load.pitch_inertia


def test_more_of_the_liquid_moves_rigidly_the_fuller_the_tank():
    shares = [added_mass(cylinder(fill)) / frozen_load(cylinder(fill)).mass for fill in (0.1, 0.3, 0.5, 0.7, 0.9)]
    assert np.all(np.diff(shares) > 0.0)


def test_a_nearly_full_tank_needs_no_huge_mesh(monkeypatch):
    """The potential given on the surface is as r^0.55 at its edge; only a mesh graded for that settles early."""
    monkeypatch.setattr(inertia, "_MOST_UNKNOWNS", 15_000)
    assert added_mass(cylinder(0.98)) / frozen_load(cylinder(0.98)).mass == pytest.approx(0.53432, abs=1e-5)


def test_both_scale_with_the_density():
    heavy = cylinder(0.4, liquid=Liquid(model="modal", density=2.0 * 998.2))
    assert added_mass(heavy) == pytest.approx(2.0 * added_mass(cylinder(0.4)))
    assert stokes_joukowski_inertia(heavy) == pytest.approx(2.0 * stokes_joukowski_inertia(cylinder(0.4)))


def test_what_never_settles_is_refused(monkeypatch):
    monkeypatch.setattr(inertia, "_MOST_UNKNOWNS", 100)
    with pytest.raises(TankError, match="must settle"):
        added_mass(cylinder(0.9))
