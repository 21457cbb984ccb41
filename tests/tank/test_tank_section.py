"""Cross-sections and the load at rest, against quadrature that knows the outline only."""

import itertools
import math

import numpy as np
import pytest
from tank_examples import BOTTLE, THREE_TROUGHS, V_TROUGH, box, cylinder, ellipse, polygon, regular_polygon

from slosh_cli.outline import cut_below, cut_right, surface_intervals
from slosh_cli.section import EllipticalSection, PolygonalSection, RectangularSection, section_of
from slosh_cli.tank.load import frozen_load

FILLS = (0.02, 0.1, 0.25, 0.5, 0.77, 0.98)


def ellipse_width(across: float, up: float):
    return lambda z: 2.0 * across * np.sqrt(np.maximum(1.0 - ((z - up) / up) ** 2, 0.0))


def polygon_width(points):
    """Total inner width by crossings of a level line, sorted and paired."""

    def width(levels):
        found = []
        for z in levels:
            crossings = sorted(
                y1 + (y2 - y1) * (z - z1) / (z2 - z1)
                for (y1, z1), (y2, z2) in zip(points, (*points[1:], points[0]), strict=True)
                if (z1 > z) != (z2 > z)
            )
            found.append(sum(crossings[1::2]) - sum(crossings[0::2]))
        return np.array(found)

    return width


def by_quadrature(width, depth, breaks=()):
    """Area, centroid and second moment from the width alone, Gauss-Legendre in a variable smooth at the bottom."""
    nodes, weights = np.polynomial.legendre.leggauss(400)
    edges = [0.0, *[level for level in sorted(breaks) if 0.0 < level < depth], depth]
    z, share = [], []
    for low, high in itertools.pairwise(edges):
        angle = (nodes + 1.0) * math.pi / 4.0  # z = low + (high - low) sin^2: square-root ends become smooth
        z.append(low + (high - low) * np.sin(angle) ** 2)
        share.append(weights * math.pi / 4.0 * (high - low) * np.sin(2.0 * angle))
    z, share = np.concatenate(z), np.concatenate(share)
    strip = share * width(z)
    area = strip.sum()
    centroid = (strip * z).sum() / area
    return area, centroid, (strip * (z - centroid) ** 2).sum()


SECTIONS = [
    pytest.param(EllipticalSection(1.5, 1.5), ellipse_width(1.5, 1.5), (), id="circle"),
    pytest.param(EllipticalSection(1.3, 0.4), ellipse_width(1.3, 0.4), (), id="flat ellipse"),
    pytest.param(RectangularSection(2.4, 3.0), lambda z: 2.4 + 0.0 * z, (), id="rectangle"),
    pytest.param(PolygonalSection(V_TROUGH), lambda z: 2.0 * z, (), id="V trough"),
    pytest.param(PolygonalSection(BOTTLE), polygon_width(BOTTLE), (1.0, 1.5), id="bottle"),
    pytest.param(PolygonalSection(THREE_TROUGHS), polygon_width(THREE_TROUGHS), (0.5, 1.0), id="three troughs"),
]


@pytest.mark.parametrize("fill", FILLS)
@pytest.mark.parametrize(("section", "width", "breaks"), SECTIONS)
def test_section_against_quadrature(section, width, breaks, fill):
    depth = fill * section.height
    area, centroid, second = by_quadrature(width, depth, breaks)
    assert section.area(depth) == pytest.approx(area, rel=1e-10)
    assert section.centroid_height(depth) == pytest.approx(centroid, rel=1e-10)
    assert section.second_moment(depth) == pytest.approx(second, rel=1e-9)
    assert section.surface_width(depth) == pytest.approx(float(width(np.array([depth]))[0]), rel=1e-12)


@pytest.mark.parametrize(("section", "width", "breaks"), SECTIONS)
def test_depths_beyond_the_section_are_empty_or_full(section, width, breaks):
    assert section.area(0.0) == section.area(-1.0) == 0.0
    assert section.area(section.height) == section.area(9.0) > 0.0
    assert section.area(1e-9 * section.height) < 1e-8 * section.area(section.height)
    assert section.surface_width(0.0) == 0.0
    assert section.surface_width(section.height) == pytest.approx(0.0, abs=1e-12)


def test_a_nearly_empty_ellipse_keeps_its_digits():
    section = EllipticalSection(1.0, 1.0)
    depth = 1e-12  # a parabola
    assert section.area(depth) == pytest.approx(4.0 / 3.0 * math.sqrt(2.0) * depth**1.5, rel=1e-10, abs=0.0)
    assert section.surface_width(depth) == pytest.approx(2.0 * math.sqrt(2.0 * depth), rel=1e-10, abs=0.0)


def test_many_sided_polygon_tends_to_the_circle_with_the_square_of_the_sides():
    circle = EllipticalSection(1.2, 1.2)
    errors = []
    for sides in (40, 80, 160):
        corners = regular_polygon(sides)
        section = PolygonalSection(corners)
        errors.append(abs(section.area(section.height / 2.0) / circle.area(1.2) - 1.0))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([2.0, 2.0], abs=0.02)
    assert errors[-1] < 3e-4


def test_a_non_convex_section_is_cut_into_its_parts():
    parts = cut_below(THREE_TROUGHS, 0.75)
    assert [len(part) for part in parts] == [3, 3, 3]
    assert surface_intervals(THREE_TROUGHS, 0.75) == ((-2.0, -1.25), (-0.5, 0.5), (1.25, 2.0))
    assert cut_right(parts[-1]) == (((0.0, 0.5), (0.5, 0.75), (0.0, 0.75)),)


def test_parts_that_only_touch_stay_apart():
    parts = cut_below(THREE_TROUGHS, 1.0)
    assert len(parts) == 3
    assert sorted(min(y for y, _ in part) for part in parts) == [-2.0, -1.0, 1.0]


def test_a_ceiling_at_the_surface_is_wall_and_a_shelf_at_the_surface_is_dry():
    assert surface_intervals(BOTTLE, 1.0) == ((-0.5, 0.5),)
    upside_down = tuple((y, 2.0 - z) for y, z in BOTTLE)
    assert surface_intervals(upside_down, 1.0) == ((-0.5, 0.5),)
    assert PolygonalSection(upside_down).area(1.0) == pytest.approx(0.5 * (2.0 + 1.0) * 0.5 + 0.5)


def test_the_order_of_the_corners_does_not_matter():
    forwards, backwards = PolygonalSection(BOTTLE), PolygonalSection(BOTTLE[::-1])
    for depth in (0.3, 1.2, 1.8, 2.0):
        assert forwards.area(depth) == pytest.approx(backwards.area(depth))
        assert forwards.second_moment(depth) == pytest.approx(backwards.second_moment(depth))


def test_scenario_tanks_have_their_sections():
    assert section_of(cylinder()) == EllipticalSection(1.2, 1.2)
    assert section_of(box()) == RectangularSection(2.4, 3.0)
    assert section_of(ellipse()) == EllipticalSection(1.3, 1.0)
    assert section_of(polygon(BOTTLE)).area(2.0) == PolygonalSection(BOTTLE).area(2.0)


def test_an_unknown_shape_is_refused():
    class Sphere:
        shape, length, fill = "sphere", 1.0, 0.5

    with pytest.raises(ValueError, match="`sphere`"):
        section_of(Sphere())


def test_half_filled_cylinder_as_the_handbook_has_it():
    load = frozen_load(cylinder(0.5, 1.5, 15.5))
    mass = 998.2 * math.pi * 1.5**2 / 2.0 * 15.5
    depth_of_centre = 4.0 * 1.5 / (3.0 * math.pi)
    about_centre = mass * (1.5**2 / 4.0 - depth_of_centre**2 + 15.5**2 / 12.0)
    assert load.mass == pytest.approx(mass, rel=1e-14)
    assert load.centre_height == pytest.approx(1.5 - depth_of_centre, rel=1e-14)
    assert load.pitch_inertia == pytest.approx(about_centre, rel=1e-13)


def test_the_load_of_a_bottle_against_a_sum_over_small_blocks():
    tank = polygon(BOTTLE, fill=0.7, length=3.0)
    z = (np.arange(2800) + 0.5) * (1.4 / 2800)
    block = 998.2 * polygon_width(BOTTLE)(z) * (1.4 / 2800)  # per metre of length
    x = (np.arange(600) + 0.5) * (3.0 / 600) - 1.5
    mass = block.sum() * 3.0
    centre = (block * z).sum() * 3.0 / mass
    inertia = (block[:, None] * (x[None, :] ** 2 + (z[:, None] - centre) ** 2)).sum() * (3.0 / 600)
    load = frozen_load(tank)
    assert (load.mass, load.centre_height, load.pitch_inertia) == pytest.approx((mass, centre, inertia), rel=1e-5)
