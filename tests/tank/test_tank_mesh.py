"""Meshes of wetted half sections: they cover the region, follow the wall and say no where they must."""

import math
import pickle

import numpy as np
import pytest
from tank_examples import BOTTLE, THREE_TROUGHS, V_TROUGH, regular_polygon

from slosh_cli.section import EllipticalSection, PolygonalSection, RectangularSection
from slosh_cli.tank.eigenproblem import HalfSectionElements
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.triangulation import triangulate
from slosh_cli.tank.wetted import Side, half_section

CIRCLE = EllipticalSection(1.2, 1.2)
SECTIONS = {
    "circle": CIRCLE,
    "flat ellipse": EllipticalSection(1.5, 0.25),
    "tall ellipse": EllipticalSection(0.25, 1.5),
    "box": RectangularSection(2.4, 3.0),
    "low wide box": RectangularSection(3.0, 0.5),
    "V trough": PolygonalSection(V_TROUGH),
    "bottle": PolygonalSection(BOTTLE),
    "36-gon": PolygonalSection(regular_polygon(36)),
    "120-gon": PolygonalSection(regular_polygon(120)),
}


def doubled_areas(mesh):
    corners = mesh.points[mesh.triangles]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]


def smallest_angle(mesh):
    corners = mesh.points[mesh.triangles]
    angles = []
    for i in range(3):
        one, two = corners[:, (i + 1) % 3] - corners[:, i], corners[:, (i + 2) % 3] - corners[:, i]
        cosine = (one * two).sum(axis=1) / np.linalg.norm(one, axis=1) / np.linalg.norm(two, axis=1)
        angles.append(np.degrees(np.arccos(cosine)).min())
    return min(angles)


@pytest.mark.parametrize("fill", [0.02, 0.07, 0.25, 0.5, 0.75, 0.93, 0.98])
@pytest.mark.parametrize("name", SECTIONS)
def test_every_shape_and_fill_is_covered(name, fill):
    section = SECTIONS[name]
    half = half_section(section, fill * section.height)
    mesh = triangulate(half, 5.0 * math.pi / 5.75)
    elements = HalfSectionElements(mesh)
    assert doubled_areas(mesh).min() > 0.0
    assert smallest_angle(mesh) > min(21.0, 0.9 * math.degrees(min(c.angle for c in half.corners())))
    assert len(mesh.triangles) < 5000
    assert elements.area_of.sum() == pytest.approx(section.area(half.depth) / 2.0, rel=3e-5)
    assert elements.surface_of.sum() == pytest.approx(section.surface_width(half.depth) / 2.0, rel=1e-12)


def test_curved_edges_give_the_area_with_the_fourth_power_of_their_length():
    mesh = triangulate(half_section(CIRCLE, 1.5), 1.0)
    errors = []
    for _ in range(3):
        errors.append(abs(HalfSectionElements(mesh).area_of.sum() / (CIRCLE.area(1.5) / 2.0) - 1.0))
        mesh = mesh.refined()
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([4.0, 4.0], abs=0.1)


def test_refinement_halves_every_edge_and_stays_on_the_wall():
    mesh = triangulate(half_section(CIRCLE, 1.7), 1.0)
    finer = mesh.refined()
    assert len(finer.triangles) == 4 * len(mesh.triangles)
    assert len(finer.boundary.nodes) == 2 * len(mesh.boundary.nodes)
    on_wall = finer.points[np.unique(finer.boundary.nodes[finer.side_edges(Side.WALL)])]
    assert np.hypot(on_wall[:, 0], on_wall[:, 1] - 1.2) == pytest.approx(1.2, rel=1e-12)
    on_surface = finer.points[finer.boundary.nodes[finer.side_edges(Side.SURFACE)]]
    assert np.all(on_surface[:, :, 1] == 1.7)
    on_symmetry = finer.points[finer.boundary.nodes[finer.side_edges(Side.SYMMETRY)]]
    assert np.all(on_symmetry[:, :, 0] == 0.0)


def test_the_mesh_is_finer_at_the_contact_line():
    mesh = triangulate(half_section(CIRCLE, 0.9 * 2.4), 1.0)
    ends = mesh.points[mesh.boundary.nodes[mesh.side_edges(Side.SURFACE)]]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    order = np.argsort(ends[:, :, 0].mean(axis=1))
    assert length[order[-1]] < 0.1 * length[order[0]]


def test_a_surface_just_above_a_corner_is_meshed():
    for gap in (1e-3, 1e-5, 1e-7, 1e-12):
        mesh = triangulate(half_section(PolygonalSection(BOTTLE), 1.0 + gap), 1.0)
        assert doubled_areas(mesh).sum() / 4.0 == pytest.approx(0.5 * 1.25 + 0.25 * gap, rel=1e-6)


def test_half_of_two_separate_troughs_is_one_trough():
    half = half_section(PolygonalSection(THREE_TROUGHS), 0.4)
    assert half.half_width == pytest.approx(0.4)
    assert {piece.side for piece in half.pieces} == {Side.WALL, Side.SURFACE}


def test_interior_angles_of_the_bottle():
    corners = {
        (round(c.y, 9), c.z): math.degrees(c.angle) for c in half_section(PolygonalSection(BOTTLE), 1.7).corners()
    }
    slope = math.degrees(math.atan2(1.0, 0.5))
    assert corners[0.5, 1.0] == pytest.approx(270.0)
    assert corners[1.0, 0.0] == pytest.approx(180.0 - slope)
    assert corners[1.5, 1.0] == pytest.approx(slope)
    assert corners[0.5, 1.5] == pytest.approx(225.0)
    assert corners[0.7, 1.7] == pytest.approx(45.0)


def refusal(points, depth):
    with pytest.raises(TankError) as caught:
        half_section(PolygonalSection(points), depth)
    return str(caught.value)


def test_liquid_in_separate_troughs_is_refused():
    message = refusal(THREE_TROUGHS, 0.75)
    assert "one piece on each side" in message
    assert "2 separate troughs" in message


def test_a_surface_divided_by_the_wall_is_refused():
    hanging_roof = ((-2.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.2, 2.0), (1.0, 1.0), (0.8, 2.0),
                    (-0.8, 2.0), (-1.0, 1.0), (-1.2, 2.0), (-2.0, 2.0))  # fmt: skip
    message = refusal(hanging_roof, 1.5)
    assert "free surface must be in one piece" in message
    assert "divides it into 2" in message
    assert half_section(PolygonalSection(hanging_roof), 0.9).half_width == pytest.approx(2.0)


def test_a_lopsided_section_is_refused_with_the_corner():
    assert "corner (1.2, 2) m has no mirror image" in refusal(((-1.0, 0.0), (1.0, 0.0), (1.2, 2.0), (-1.0, 2.0)), 1.0)


def test_corners_in_the_middle_of_a_straight_side_need_no_mirror_image():
    points = ((-1.0, 0.0), (1.0, 0.0), (1.0, 0.7), (1.0, 2.0), (-1.0, 2.0))
    assert half_section(PolygonalSection(points), 1.0).area == pytest.approx(1.0)


@pytest.mark.parametrize("depth", [0.0, 2.4, -0.1, 3.0])
def test_a_depth_outside_the_section_is_refused(depth):
    with pytest.raises(TankError, match="depth must lie inside"):
        half_section(CIRCLE, depth)


def test_the_error_survives_pickling():
    error = pickle.loads(pickle.dumps(TankError("a reason")))
    assert (error.code, str(error)) == ("tank", "a reason")
