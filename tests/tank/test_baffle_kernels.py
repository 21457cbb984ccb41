"""Each kernel of the walls alone, by hand in a box of 2.5 m by 3 m (theory section 10.6)."""

import math
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from shallow_tools import BOX, CIRCLE, G

from slosh_cli.tank import baffle as kernels
from slosh_cli.tank import section_table as sections
from slosh_cli.tank.baffle import baffles_at
from tests.plain_kernels import as_python

WIDTH, HEIGHT = 2.5, 3.0


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    as_python(monkeypatch, kernels, sections)


@cache
def table(section=BOX):
    return sections.section_table(section, G, 30.0)


def test_walls_by_their_faces():
    """Rows in the order given; empty bands fill up those with fewer openings."""
    walls = baffles_at(6, {1: (), 4: ((0.1, 0.2, 0.5), (1.0, 3.0, 1.0)), 2: ((0.3, 0.4, 0.25),), 5: ()})
    assert walls.at.tolist() == [0, -1, 2, 0, 1, -1, 0]
    assert walls.low.tolist() == [[0.1, 1.0], [0.3, 0.0]]
    assert walls.high.tolist() == [[0.2, 3.0], [0.4, 0.0]]
    assert walls.share.tolist() == [[0.5, 1.0], [0.25, 0.0]]
    for none in (baffles_at(2, {}), baffles_at(2, {1: ()})):
        assert none.low.shape == none.high.shape == none.share.shape == (1, 1)
        assert none.share.tolist() == [[0.0]]
    assert baffles_at(2, {}).at.tolist() == [0, 0, 0]


BANDS = {
    "slot at the bottom": ((0.0, 0.2, 1.0),),
    "two": ((0.25, 0.5, 0.8), (1.0, 1.75, 0.4)),
    "open on top": ((1.2, 3.0, 1.0),),
    "perforated": ((0.0, 3.0, 0.3),),
    "closed and open": ((0.5, 1.0, 0.0), (0.75, 1.5, 0.6)),
}
FIRST = ((0.0, 3.0, 0.9), (0.0, 3.0, 0.05), (0.5, 2.0, 0.02))
"""Of another wall, whose openings are not to be taken."""


def wall(bands):
    """Walls of which the second has these openings."""
    return baffles_at(4, {1: FIRST, 2: bands})


def open_area(bands, depth):
    return WIDTH * sum(share * max(min(high, depth) - low, 0.0) for low, high, share in bands)


def part(bands, depth):
    return open_area(bands, depth) / (WIDTH * depth)


def contraction(share):
    return 1.0 + 0.707 * math.sqrt(1.0 - share)


def falling(bands, lower, higher):
    """INT sqrt(H - z) dA_o between two levels."""
    total = 0.0
    for low, high, share in bands:
        begin, end = max(low, lower), min(high, higher)
        if end > begin:
            total += share * WIDTH * ((higher - begin) ** 1.5 - (higher - end) ** 1.5) / 1.5
    return total


def discharged(bands, lower, higher):
    """`sqrt(2 g) (A_o(h) sqrt(H - h)/(k - f) + INT sqrt(H - z) dA_o/sqrt(k^2 - f^2))`."""
    above, below = part(bands, higher), part(bands, lower) if lower > 0.0 else 1.0
    below = min(above, below)
    submerged = open_area(bands, lower) * math.sqrt(higher - lower) / (contraction(below) - below)
    jet = falling(bands, lower, higher) / math.sqrt(contraction(above) ** 2 - above**2)
    return math.sqrt(2.0 * G) * (submerged + jet)


@pytest.mark.parametrize("name", BANDS)
def test_loss_of_equal_depths(name):
    """`xi = (k - f)^2/f^2`, f the open share of what is wetted."""
    for depth in (0.4, 1.4, 2.9):
        share = part(BANDS[name], depth)
        exact = ((contraction(share) - share) / share) ** 2 if share else math.inf
        assert kernels.baffle_loss(wall(BANDS[name]), 2, table(), depth) == pytest.approx(exact, rel=1e-6)
    assert kernels.baffle_loss(wall(BANDS[name]), 2, table(), 0.0) < 1e-15


def test_a_full_section_has_the_openings_of_its_roof():
    """Pressure above the roof wets no more of the wall."""
    walls = wall(BANDS["open on top"])
    full, beyond = (kernels.baffle_loss(walls, 2, table(), depth) for depth in (3.0, 9.0))
    assert beyond == pytest.approx(full, rel=1e-12)
    assert full == pytest.approx(((contraction(0.6) - 0.6) / 0.6) ** 2, rel=1e-2)


@pytest.mark.parametrize("name", BANDS)
@pytest.mark.parametrize(
    "levels", [(0.0, 0.3), (0.0, 1.5), (0.4, 1.3), (0.45, 0.46), (0.8, 2.9), (1.3, 1.6), (1.8, 2.8)]
)
def test_discharge_in_a_box(name, levels):
    lower, higher = levels
    found = kernels.discharge(wall(BANDS[name]), 2, table(), G, lower, higher - lower)
    assert found == pytest.approx(discharged(BANDS[name], lower, higher), rel=2e-5, abs=1e-12)


def test_discharge_goes_with_the_root_of_gravity():
    four, one = (kernels.discharge(wall(BANDS["two"]), 2, table(), g, 0.4, 0.9) for g in (4.0, 1.0))
    assert four == pytest.approx(2.0 * one, rel=1e-12)


def pushed(bands, lower, higher):
    """Force and moment of two levels on the solid part, by the heads `min(H - h, H - z)`, over density and gravity."""
    edges = sorted({0.0, lower, higher, *(z for low, high, _ in bands for z in (low, high) if z < higher)})
    force = moment = 0.0
    for low, high in pairwise(edges):
        solid = WIDTH * (1.0 - sum(share for a, b, share in bands if a <= low and high <= b))
        for root in (-1.0, 1.0):  # Gauss's two points are exact for cubics
            z = 0.5 * (low + high) + 0.5 * root / math.sqrt(3.0) * (high - low)
            force += 0.5 * (high - low) * solid * min(higher - lower, higher - z)
            moment += 0.5 * (high - low) * solid * min(higher - lower, higher - z) * z
    return force, moment


@pytest.mark.parametrize("name", BANDS)
@pytest.mark.parametrize("levels", [(0.0, 1.5), (0.4, 1.3), (0.8, 2.9), (0.3, 0.6), (1.8, 2.8)])
def test_the_solid_part_is_pushed_at_the_centre_of_the_heads(name, levels):
    bands = BANDS[name]
    force, moment = pushed(bands, *levels)
    for depths in (levels, levels[::-1]):
        assert kernels.solid_height(wall(bands), 2, table(), *depths) == pytest.approx(moment / force, rel=2e-5)


def test_equal_levels_push_at_the_middle_of_what_is_solid():
    """In the limit; a wall that is open all over, or in all that is wetted, has half the depth."""
    assert kernels.solid_height(wall(BANDS["perforated"]), 2, table(), 1.2, 1.2) == pytest.approx(0.6, rel=1e-5)
    centre = (1.2 * 0.6 - 0.2 * 0.1) / 1.0
    assert kernels.solid_height(wall(BANDS["slot at the bottom"]), 2, table(), 1.2, 1.2) == pytest.approx(
        centre, rel=1e-5
    )
    for bands, levels in ((((0.0, 3.0, 1.0),), (0.4, 1.2)), (BANDS["slot at the bottom"], (0.1, 0.15))):
        assert kernels.solid_height(wall(bands), 2, table(), *levels) == pytest.approx(0.5 * levels[1], rel=1e-12)
    dry = kernels.solid_height(wall(BANDS["open on top"]), 2, table(), 0.0, 0.0)
    assert dry == pytest.approx(1e-6, rel=0.01)  # of a film of a millionth of the height, a third of three metres


@pytest.mark.parametrize("excess", [0.0, 0.3, 5.0, -0.7, -1.25])
def test_level_of_a_larger_pressure_in_a_box(excess):
    """`I1 = b h^2/2`; nothing is left where the pressure would be negative."""
    level = kernels._level(1.0, WIDTH, WIDTH, excess)
    assert level == pytest.approx(math.sqrt(1.0 + 2.0 * excess / WIDTH), rel=1e-12, abs=1e-12)


def test_level_at_the_ends():
    assert kernels._level(1.0, WIDTH, WIDTH, -9.0) == 0.0
    assert kernels._level(0.25, 0.0, WIDTH, 0.0) == 0.25
    assert kernels._level(0.0, 0.0, WIDTH, 0.2) == pytest.approx(math.sqrt(0.4 / WIDTH), rel=1e-12)


def passing(bands, flow, upstream, downstream, excess, excess_2):
    depths = upstream, WIDTH * upstream, WIDTH, excess, downstream, WIDTH * downstream, WIDTH, excess_2
    return kernels.passing_part(wall(bands), 2, table(), G, flow, *depths)


@pytest.mark.parametrize("name", BANDS)
@pytest.mark.parametrize(
    ("flow", "upstream", "downstream", "excess", "excess_2"),
    [(2.0, 1.5, 1.3, 0.8, -0.4), (0.3, 1.3, 1.3, 0.1, -0.1), (4.0, 1.6, 0.9, 0.2, 0.1), (6.0, 1.4, 1.4, 1.5, 0.9)],
)
def test_the_part_that_passes_is_the_discharge_under_the_levels_that_it_leaves(
    name, flow, upstream, downstream, excess, excess_2
):
    """Levels of a closed wall, or of the waves that stop the flow, come nearer by what passes, from either side."""
    bands = BANDS[name]
    found = passing(bands, flow, upstream, downstream, excess, excess_2)
    high, low = (
        math.sqrt(depth**2 + 2.0 * more / WIDTH) for depth, more in ((upstream, excess), (downstream, excess_2))
    )
    waves = math.sqrt(G * upstream) + math.sqrt(G * downstream)
    gap = max(high - low, waves * flow / (G * WIDTH * (upstream + downstream)))
    assert 0.0 < found < 1.0
    through = discharged(bands, low + 0.5 * found * gap, low + 0.5 * found * gap + (1.0 - found) * gap)
    assert found * flow == pytest.approx(through, rel=1e-6)
    assert passing(bands, -flow, upstream, downstream, excess, excess_2) == found


def test_all_passes_an_open_wall_and_nothing_one_that_is_open_above_the_liquid():
    levels = 1.3, 1.2, 0.1, -0.1
    assert passing(((0.0, 3.0, 1.0),), 2.0, *levels) == pytest.approx(1.0, abs=1e-6)
    assert passing(((2.5, 3.0, 1.0),), 2.0, *levels) == 0.0
    assert passing(BANDS["two"], 0.0, *levels) == pytest.approx(1.0, abs=1e-6)


def test_a_smaller_opening_lets_less_pass():
    shares = np.linspace(0.05, 0.95, 19)
    parts = [passing(((0.0, 3.0, float(share)),), 3.0, 1.4, 1.2, 0.5, -0.2) for share in shares]
    assert np.all(np.diff(parts) > 0.0)


def test_waves_of_a_section_are_those_of_its_own_width():
    """`c = sqrt(g A/b)` of either side: with areas and widths apart as in a circle."""
    sides = [(depth, float(CIRCLE.area(depth)), float(CIRCLE.surface_width(depth)), 0.0) for depth in (1.2, 1.0)]
    levels, walls, flow = (*sides[0], *sides[1]), wall(((0.0, 3.0, 0.2),)), 5.0
    found = kernels.passing_part(walls, 2, table(CIRCLE), G, flow, *levels)
    waves = math.sqrt(G * levels[1] / levels[2]) + math.sqrt(G * levels[5] / levels[6])
    gap = waves * flow / (G * (levels[1] + levels[5]))
    assert gap > 0.3
    through = kernels.discharge(walls, 2, table(CIRCLE), G, 1.0 + 0.5 * found * gap, (1.0 - found) * gap)
    assert found * flow == pytest.approx(through, rel=1e-6)
