"""Hertz contact against the elastic half space itself, and the check numbers of theory section 7."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipe, ellipkm1

from slosh_cli.scenario import Adhesion, Contact
from slosh_cli.track.contact import contact_model
from slosh_cli.track.hertz import _elliptic_integrals, hertz_contact
from slosh_cli.validation.exact.creep import half_space

DRY = Adhesion(mu0=0.55, A=0.40, B=0.60, kA=1.00, kS=0.40)


def steel_contact(**changes):
    given = {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "rail_crown_radius": 0.3, "kalker_c11": 4.12}
    return Contact(**{**given, "adhesion": DRY, **changes})


def test_check_numbers():
    """Theory section 7: R 0.46 m, crown 0.30 m, 210 GPa, 0.3 -> C_H = 9.413e10, a = 7.0 mm, b = 5.3 mm at 93 kN."""
    hertz = hertz_contact(0.46, 0.30, 210e9, 0.3)
    assert hertz.stiffness == pytest.approx(9.413e10, rel=1e-4)
    assert hertz.semi_axes(93e3) == (pytest.approx(7.0e-3, abs=5e-5), pytest.approx(5.3e-3, abs=5e-5))


@pytest.mark.parametrize("axis_ratio", [1.0, 1.0 + 1e-9, 1.001, 1.3, 3.0, 50.0, 1e4])
def test_elliptic_integrals_are_scipys(axis_ratio):
    first, second, difference = _elliptic_integrals(axis_ratio)
    assert first == pytest.approx(ellipkm1(axis_ratio**-2), rel=2e-15)
    assert second == pytest.approx(ellipe(1 - axis_ratio**-2), rel=2e-15)
    assert difference == pytest.approx(first - second, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize(("wheel", "crown"), [(0.46, 0.30), (0.30, 0.46), (0.46, 0.08), (0.5, 3.0), (0.5, 0.5001)])
@pytest.mark.parametrize("force", [1e3, 93e3, 300e3])
def test_ellipse_and_approach_are_those_of_the_half_space(wheel, crown, force):
    hertz = hertz_contact(wheel, crown, 210e9, 0.3)
    modulus = 1 / (2 * (1 - 0.3**2) / 210e9)
    approach, along, across = half_space(hertz.semi_axes(force), force, modulus)
    flat, sharp = sorted([1 / (2 * wheel), 1 / (2 * crown)])
    assert along == pytest.approx(flat, rel=1e-6)
    assert across == pytest.approx(sharp, rel=1e-6)
    assert (force / hertz.stiffness) ** (2 / 3) == pytest.approx(approach, rel=1e-6)


def test_equal_radii_are_a_sphere_on_a_plane():
    hertz = hertz_contact(0.5, 0.5, 210e9, 0.3)
    modulus = 210e9 / (2 * (1 - 0.3**2))
    assert hertz.stiffness == pytest.approx(4 / 3 * modulus * np.sqrt(0.5), rel=1e-6)
    assert hertz.semi_axes(1e5) == pytest.approx([(3 * 1e5 * 0.5 / (4 * modulus)) ** (1 / 3)] * 2, rel=1e-6)


def test_given_stiffness_replaces_the_computed_one():
    assert contact_model(steel_contact(), 0.46).stiffness == pytest.approx(9.413e10, rel=1e-4)
    assert contact_model(steel_contact(stiffness=5e10), 0.46).stiffness == 5e10


def test_normal_force_is_one_sided_and_stores_two_fifths():
    model = contact_model(steel_contact(stiffness=9e10), 0.46)
    for apart in (0.0, -1e-12, -1e-3, -10.0):
        assert model.normal_force(apart) == (0.0, 0.0)
    for approach in (1e-8, 1e-5, 1e-4, 3e-4):
        force, slope = model.normal_force(approach)
        assert force == pytest.approx(9e10 * approach**1.5, rel=1e-13)
        step = 1e-4 * approach
        difference = model.normal_force(approach + step)[0] - model.normal_force(approach - step)[0]
        assert slope == pytest.approx(difference / (2 * step), rel=1e-7)
        energy = quad(lambda x: model.normal_force(x)[0], 0.0, approach)[0]
        assert energy == pytest.approx(0.4 * 9e10 * approach**2.5, rel=1e-7)
