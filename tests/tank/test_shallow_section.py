"""The table of a cross-section against exact geometry, and the slot above its roof."""

import numpy as np
import pytest
from shallow_tools import HEXAGON, SECTIONS, G, depths, inverse_error, liquid_in, moving, places
from tank_examples import BOTTLE, THREE_TROUGHS

from slosh_cli.section import PolygonalSection
from slosh_cli.tank.section_table import potential_at, pressure_height, section_at


def circle_by_hand(z, radius=1.5):
    """Area, width, first moment INT_0^z b z dz of a circular segment."""
    width = 2 * np.sqrt(2 * radius * z - z * z)
    area = radius**2 * np.arccos(1 - z / radius) - (radius - z) * width / 2
    return area, width, radius * area - width**3 / 12


def ellipse_by_hand(z):
    """Half axes 1.4 m across and 0.9 m up: a circle of 0.9 m drawn out sideways."""
    area, width, first = circle_by_hand(z, 0.9)
    return 1.4 / 0.9 * area, 1.4 / 0.9 * width, 1.4 / 0.9 * first


BY_HAND = {
    "circle": circle_by_hand,
    "ellipse": ellipse_by_hand,
    "box": lambda z: (2.5 * z, 2.5 + 0 * z, 1.25 * z**2),
    "trough": lambda z: (z**2, 2 * z, 2 / 3 * z**3),
}


def largest(found, exact):
    return np.abs(found - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize("name", BY_HAND)
def test_area_width_and_moments_of_simple_sections(name):
    liquid = liquid_in(SECTIONS[name], 10, 0.5)
    z = np.linspace(1e-4, 1 - 1e-4, 3001) * liquid.table.depth[-1]
    area, width, first = BY_HAND[name](z)
    found = np.array([section_at(liquid.table, depth) for depth in z])
    assert largest(found[:, 0], area) < 1e-8
    assert largest(found[:, 1], z * area - first) < 1e-10
    assert largest(found[1:-1, 2], width[1:-1]) < 1e-5
    assert largest(np.array([potential_at(liquid.table, depth) for depth in z]), first) < 1e-8


POLYGONS = {
    "hexagon": HEXAGON,
    "three troughs": PolygonalSection(THREE_TROUGHS),
    "bottle with level ledges": PolygonalSection(BOTTLE),
}


@pytest.mark.parametrize("name", POLYGONS)
def test_area_and_moment_of_polygons(name):
    """Corners are nodes of the table, also where the width jumps at a level ledge (at 1 m of the bottle's 2 m)."""
    section = POLYGONS[name]
    liquid = liquid_in(section, 10, 0.5 * section.height)
    for part in (0.11, 0.3, 0.49, 0.4999, 0.5001, 0.51, 0.77, 0.98):
        depth = part * section.height
        area = section.area(depth)
        first = area * section.centroid_height(depth)
        found = section_at(liquid.table, depth)
        assert found == pytest.approx((area, depth * area - first, section.surface_width(depth)), rel=1e-7)


@pytest.mark.parametrize("name", SECTIONS)
def test_area_is_pressure_s_slope_and_grows_all_the_way_into_the_slot(name):
    """Well-balanced fluxes rest on I1' = A; a depth is found back from its area."""
    liquid = liquid_in(SECTIONS[name], 10, 0.5)
    roof, small = liquid.table.roof, 1e-5
    z = np.linspace(0.01, 1.3, 777) * roof
    values = np.array([section_at(liquid.table, depth)[:2] for depth in z])
    ahead, back = (np.array([section_at(liquid.table, d)[1] for d in z + sign * small]) for sign in (1, -1))
    assert largest((ahead - back) / (2 * small), values[:, 0]) < 1e-6
    assert np.all(np.diff(values[:, 0]) > 0)
    assert inverse_error(liquid) < 1e-13


@pytest.mark.parametrize("name", SECTIONS)
@pytest.mark.parametrize("depth", [0.2, 0.9, 1.7])
def test_pressure_on_an_end_wall_acts_at_its_exact_height(name, depth):
    """Also with a head above the roof, where the whole wall bears it (the slot's own width apart)."""
    section = SECTIONS[name]
    depth *= section.height
    z = (np.arange(4000) + 0.5) * min(depth, section.height) / 4000
    load = np.array([section.surface_width(level) for level in z]) * (depth - z)
    exact = float(np.sum(load * z) / np.sum(load))
    assert pressure_height(liquid_in(section, 10, 0.5).table, depth) == pytest.approx(exact, rel=3e-3)


@pytest.mark.parametrize("slot_speed", [15.0, 30.0, 60.0])
@pytest.mark.parametrize("name", ["circle", "box"])
def test_pressure_waves_in_the_full_section_run_at_the_slot_speed(name, slot_speed):
    liquid = liquid_in(SECTIONS[name], 400, 1.0, slot_speed=slot_speed)
    still, place, time = liquid.table.depth[-1] + 0.5, places(liquid), 4.0 / slot_speed
    tank = moving(liquid, still + 0.05 * np.exp(-((place / 0.5) ** 2)))
    tank.advance(0.0, time)
    rise = np.where(place > 0, tank.depth - still, 0.0)
    speed = float(rise @ place / rise.sum()) / time
    # sqrt(g A/b) with the liquid in the slot: (0.5 b + A)/A faster than the slot's nominal speed, squared
    expected = slot_speed * np.sqrt(1 + 0.5 * liquid.table.slot_width / liquid.table.area[-1])
    assert speed == pytest.approx(expected, rel=5e-3)
    assert speed == pytest.approx(slot_speed, rel=2e-2)


def test_head_in_the_slot_is_the_pressure_under_the_roof():
    liquid = liquid_in(SECTIONS["circle"], 10, 0.5)
    area = liquid.table.area[-1] + 0.7 * liquid.table.slot_width
    assert depths(liquid, np.full(10, area))[0] == pytest.approx(liquid.table.depth[-1] + 0.7, rel=1e-14)
    assert liquid.table.slot_width == pytest.approx(G * np.pi * 1.5**2 / 30.0**2, rel=1e-12)
