"""The pitch inertia under a lid: closed forms."""

import math

import numpy as np
import pytest
from tank_examples import box, cylinder

from slosh_cli.scenario.schema_tank import Liquid
from slosh_cli.tank import inertia
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.inertia import stokes_joukowski_inertia
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.section import liquid_depth

HARMONICS = 2.0 * np.arange(20000) + 1.0

BOXES = [
    pytest.param(box(0.5), id="half-filled"),
    pytest.param(box(0.3, length=15.5), id="long"),
    pytest.param(box(0.02, length=15.5), id="a puddle"),
    pytest.param(box(0.9, width=0.5, height=1.0, length=0.2), id="a slice"),
]


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


@pytest.mark.parametrize("fill", [0.02, 0.3, 0.7, 0.98])
def test_less_turns_under_a_lid_than_in_a_frozen_load(fill):
    tank = cylinder(fill)
    assert 0.0 < stokes_joukowski_inertia(tank) < frozen_load(tank).pitch_inertia


def test_it_scales_with_the_density():
    heavy = cylinder(0.4, liquid=Liquid(model="modal", density=2.0 * 998.2))
    assert stokes_joukowski_inertia(heavy) == pytest.approx(2.0 * stokes_joukowski_inertia(cylinder(0.4)))


def test_what_never_settles_is_refused(monkeypatch):
    monkeypatch.setattr(inertia, "_MOST_UNKNOWNS", 100)
    with pytest.raises(TankError, match="must settle"):
        stokes_joukowski_inertia(cylinder(0.9))
