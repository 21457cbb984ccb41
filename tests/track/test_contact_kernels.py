"""How near uneven rails and wheels come to each other, and what their contact stores (theory sections 9 and 15)."""

import math

import numpy as np
import pytest

from slosh_cli.scenario import Contact
from slosh_cli.scenario.schema_run import ADHESIONS
from slosh_cli.track import contact, surface
from slosh_cli.track.contact import ContactModel, contact_model
from slosh_cli.track.surface import RollingSurface, even_surface
from tests.plain_kernels import as_python

STEEL = {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "rail_crown_radius": 0.3, "kalker_c11": 4.12}
RADIUS, DEPTH, EXTENT = 0.46, 5e-4, 0.8


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    as_python(monkeypatch, contact, surface, ContactModel, RollingSurface)


def model(rolling=None):
    return contact_model(Contact(**STEEL, adhesion=ADHESIONS["dry"]), RADIUS, rolling)


def uneven():
    """A rail that rises by 1 mm over 100 m, under two wheels that are 5 m ahead and behind; the second has a flat."""
    shape = np.array([[-1e-3, 1e-5, 0.0, 0.0], [2e-3, 1e-5, 0.0, 0.0]])
    return even_surface(2).replaced(
        uneven=1, ahead=np.array([5.0, -5.0]), knots=np.array([-100.0, 200.0]), shape=shape,
        flat_depth=np.array([0.0, DEPTH]), flat_angle=np.array([0.0, EXTENT]),
    )  # fmt: skip


def height(place, ahead):
    """Of the rail, which sets in over 20 m: `3 u^2 - 2 u^3`."""
    u = min(max(place / 20.0, 0.0), 1.0)
    return (3 * u**2 - 2 * u**3) * 1e-5 * (place + ahead)


def taken_off(angle):
    turned = angle % (2 * math.pi)
    return 0.5 * DEPTH * (1 - math.cos(2 * math.pi * turned / EXTENT)) if turned < EXTENT else 0.0


def test_even_surfaces_come_as_near_as_the_rail_is_above_the_wheel():
    even = model()
    assert even.approach(2, -1e-3, -1.25e-3, 30.0, 4.0) == pytest.approx(2.5e-4, rel=1e-12)
    assert even.approach(2, -1e-3, 1e-3, 30.0, 4.0) == -2e-3
    assert even.rising(2, 30.0, 20.0, 4.0, 50.0) == 0.0


@pytest.mark.parametrize("place", [-3.0, 7.0, 60.0])
@pytest.mark.parametrize("angle", [0.1, 0.3 + 4 * math.pi, 0.7 - 2 * math.pi, 3.0])
def test_uneven_ones_by_the_rail_s_height_and_what_the_flat_takes_off(place, angle):
    """`y + f z - w - r`, and its rate `V d(f z)/ds - phi' dr/dphi`."""
    made = model(uneven())
    speed, spin = 20.0, 35.0
    for wheel, ahead in enumerate((5.0, -5.0)):

        def near(time, wheel=wheel, ahead=ahead):
            off = taken_off(angle + spin * time) if wheel == 1 else 0.0
            return -1e-3 + height(place + speed * time, ahead) + 1.25e-3 - off

        assert made.approach(wheel, -1e-3, -1.25e-3, place, angle) == pytest.approx(near(0.0), abs=1e-15)
        rate = (near(1e-6) - near(-1e-6)) / 2e-6
        assert made.rising(wheel, place, speed, angle, spin) == pytest.approx(rate, rel=1e-6, abs=1e-9)


def test_a_contact_stores_two_fifths_of_its_force_times_its_approach():
    """`2/5 C delta^(5/2)`; nothing when apart."""
    made = model()
    for approach in (1e-6, 1e-4, 4e-4):
        assert made.energy(approach) == pytest.approx(0.4 * made.stiffness * approach**2.5, rel=1e-12)
        step = 1e-4 * approach
        work = (made.energy(approach + step) - made.energy(approach - step)) / (2 * step)
        assert work == pytest.approx(made.normal_force(approach)[0], rel=1e-6)
    for apart in (0.0, -1e-4, -1.0):
        assert made.energy(apart) == 0.0


def test_a_step_ends_where_a_flat_begins():
    """A step that ends within the flat weighs it with its own length: a light wagon's ledger missed 2e-4 so."""
    rolling, spin = uneven(), 40.0
    before, behind = 2 * math.pi - 1.0, 4.0 * EXTENT
    assert rolling.turning_step(1, before, spin) == pytest.approx(1.0 / spin)
    assert rolling.turning_step(1, behind, spin) == pytest.approx((2 * math.pi - behind) / spin)
    near = rolling.turning_step(1, 2 * math.pi - 1e-9, spin)
    assert near == rolling.turning_step(1, 0.1, spin) > 1e-9  # none is shorter than over the flat itself
    assert rolling.turning_step(0, before, spin) == math.inf


def test_a_step_ends_where_a_rail_becomes_uneven():
    even = [[0.0, 0.0, 0.0, 0.0]]
    shape = np.array([*even, [1e-3, 0.0, 0.0, 0.0], *even, *even, [1e-3, 0.0, 0.0, 0.0], *even])
    rolling = uneven().replaced(knots=np.array([10.0, 11.0, 12.0, 20.0, 21.0, 22.0]), shape=shape, longest_way=0.2)
    ways = [rolling.way_ahead(0, place - 5.0) for place in (3.0, 9.9, 10.5, 13.0, 19.9, 22.5)]
    assert ways == pytest.approx([7.0, 0.2, 0.2, 7.0, 0.2, math.inf])
