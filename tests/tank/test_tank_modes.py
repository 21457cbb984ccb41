"""Longitudinal modes against exact solutions, their own identities and published transverse modes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tank_examples import BOTTLE, THREE_TROUGHS, V_TROUGH, box, cylinder, ellipse, polygon, regular_polygon

from slosh_cli.scenario import Liquid
from slosh_cli.section import EllipticalSection, PolygonalSection, RectangularSection, liquid_depth, section_of
from slosh_cli.tank.coefficients import SloshMode, computed_modes, slosh_modes, tank_modes
from slosh_cli.tank.eigenproblem import HalfSectionElements
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.longitudinal import TOLERANCE, longitudinal_mode, longitudinal_modes
from slosh_cli.tank.triangulation import triangulate
from slosh_cli.tank.wetted import half_section
from slosh_cli.validation.exact.tank import rectangle, trough

GRAVITY = 9.81
LENGTH = 5.75
NUMBERS = (1, 3, 5)
SETTLING = ("frequency", "lambda_02", "mu")


def couplings(mode):
    return mode.lambda_1, mode.lambda_02, mode.mu


@pytest.mark.parametrize("fill", [0.02, 0.2, 0.5, 0.98])
def test_rectangular_tank(fill):
    tank = box(fill)
    mass = frozen_load(tank).mass
    for n, mode in zip(NUMBERS, computed_modes(tank, 3), strict=True):
        exact = rectangle(n, 2.4, 3.0 * fill, LENGTH, 998.2)
        assert mode.frequency == pytest.approx(exact.frequency, rel=1e-6)
        assert mode.height == pytest.approx(exact.height, rel=1e-5)
        assert mode.slosh_mass / mass == pytest.approx(exact.slosh_mass / mass, rel=1e-5)
        assert couplings(mode) == pytest.approx(couplings(exact), rel=1e-5)


def test_the_rectangular_mass_fraction_has_its_closed_form():
    tank = box(0.5)
    for n, mode in zip(NUMBERS, computed_modes(tank, 3), strict=True):
        k = n * math.pi / LENGTH
        fraction = 8.0 / (n * math.pi) ** 2 * math.tanh(k * 1.5) / (k * 1.5)
        assert mode.slosh_mass / frozen_load(tank).mass == pytest.approx(fraction, rel=1e-5)


def test_small_heights_of_a_shallow_liquid_settle_too():
    """At 9 cm in a 4.9 m tank the force acts 0.03 to 2 mm above the floor: a small difference of large integrals."""
    section, depth, length = RectangularSection(2.5687, 0.44586), 0.0934, 4.8742
    for mode in longitudinal_modes(section, depth, length, 5).modes:
        assert mode.height == pytest.approx(rectangle(mode.n, 2.5687, depth, length, 1.0).height, rel=1e-5)


def test_right_angled_trough():
    tank = polygon(V_TROUGH, fill=0.7)
    for n, mode in zip(NUMBERS, computed_modes(tank, 3), strict=True):
        exact = trough(n, 0.7, LENGTH, 998.2)
        assert mode.frequency == pytest.approx(exact.frequency, rel=1e-6)
        assert couplings(mode) == pytest.approx(couplings(exact), rel=1e-6)


@pytest.mark.parametrize(
    ("section", "depth", "exact"),
    [
        (RectangularSection(2.4, 3.0), 1.5, rectangle(5, 2.4, 1.5, LENGTH, 1.0)),
        (PolygonalSection(V_TROUGH), 0.7, trough(5, 0.7, LENGTH, 1.0)),
    ],
)
def test_frequency_and_couplings_converge_with_the_fourth_power_of_the_element_size(section, depth, exact):
    mesh = triangulate(half_section(section, depth), 1.0)
    errors = []
    for _ in range(4):
        mode = longitudinal_mode(HalfSectionElements(mesh), 5, LENGTH)
        errors.append([abs(getattr(mode, name) / getattr(exact, name) - 1.0) for name in SETTLING])
        mesh = mesh.refined()
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx([4.0, 4.0, 4.0], abs=0.2)
    assert max(errors[-1]) < 1e-6


@pytest.mark.parametrize("fill", [0.3, 0.5, 0.75, 0.95])
def test_curved_and_singular_sections_converge_as_fast(fill):
    mesh = triangulate(half_section(EllipticalSection(1.2, 1.2), 2.4 * fill), 3.0)
    frequencies = []
    for _ in range(4):
        frequencies.append(longitudinal_mode(HalfSectionElements(mesh), 3, LENGTH).frequency)
        mesh = mesh.refined()
    changes = np.abs(np.diff(frequencies))
    assert np.log2(changes[1] / changes[2]) == pytest.approx(4.0, abs=0.3)
    assert changes[2] / frequencies[-1] < 1e-6


TANKS = {
    "cylinder, low": cylinder(0.02),
    "cylinder, half": cylinder(0.5),
    "cylinder, three quarters": cylinder(0.75),
    "cylinder, nearly full": cylinder(0.98),
    "ellipse": ellipse(0.6),
    "box": box(0.5),
    "trough": polygon(V_TROUGH, 0.7),
    "bottle, at the ceiling": polygon(BOTTLE, 0.5),
    "bottle, in the neck": polygon(BOTTLE, 0.6),
    "bottle, at the top": polygon(BOTTLE, 0.9),
    "three troughs, joined": polygon(THREE_TROUGHS, 0.7),
    "three troughs, the outer two": polygon(THREE_TROUGHS, 0.2),
    "36-gon": polygon(regular_polygon(36), 0.6),
}


@pytest.mark.parametrize("name", TANKS)
def test_coupling_from_the_surface_is_that_from_the_end_walls(name):
    for mode in tank_modes(TANKS[name], 3).modes:
        assert mode.lambda_1_from_ends == pytest.approx(mode.lambda_1, rel=1e-8)


@pytest.mark.parametrize("name", TANKS)
def test_every_tank_settles_and_keeps_below_the_bound(name):
    tank = TANKS[name]
    found = tank_modes(tank, 3)
    volume = section_of(tank).area(liquid_depth(tank)) * tank.length
    assert found.relative_change < TOLERANCE
    assert [mode.n for mode in found.modes] == [1, 3, 5]
    for mode in found.modes:
        assert 0.0 < mode.lambda_1**2 / mode.mu / volume < 8.0 / (mode.n * math.pi) ** 2
        width = section_of(tank).surface_width(liquid_depth(tank))
        assert mode.lambda_1 == pytest.approx(-2.0 * (tank.length / mode.n / math.pi) ** 2 * width, rel=1e-10)


@pytest.mark.parametrize("distance", [0.8, -2.5])
def test_moving_the_origin_down_adds_distance_times_lambda_1(distance):
    here = half_section(PolygonalSection(BOTTLE), 1.2)
    lifted = replace(
        here,
        depth=here.depth + distance,
        pieces=tuple(
            replace(
                piece, first=(piece.first[0], piece.first[1] + distance), last=(piece.last[0], piece.last[1] + distance)
            )
            for piece in here.pieces
        ),
    )
    before, after = (
        longitudinal_mode(HalfSectionElements(triangulate(half, 2.0)), 3, LENGTH) for half in (here, lifted)
    )
    assert after.lambda_1 == pytest.approx(before.lambda_1, rel=1e-9)
    assert after.lambda_02 == pytest.approx(before.lambda_02 + distance * before.lambda_1, rel=1e-6)


def test_lambda_02_from_the_pressure_on_every_wall_of_the_tank():
    """Whole boundary integral of phi (z n_x - x n_z), the normal speed of a unit pitch, by Simpson's rule."""
    tank = polygon(V_TROUGH, fill=0.7)
    shape = tank_modes(tank, 1).modes[0].shape
    k = math.pi / LENGTH
    triangles = np.stack([shape.y, shape.z], axis=1)[shape.triangles]
    one, two = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    area = (one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]) / 2.0
    means = shape.potential[shape.triangles].mean(axis=1), triangles[:, :, 1].mean(axis=1)
    assert np.all(area > 0.0)
    ends = -2.0 * (area * means[0] * means[1]).sum()  # cos is 1 at the rear wall and -1 at the front one
    edges = np.sort(shape.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, times = np.unique(edges, axis=0, return_counts=True)
    rim = unique[times == 1]
    y, z = shape.y[rim], shape.z[rim]
    on_rim = ~np.all(y == 0.0, axis=1)  # the two halves meet there
    length_z = np.abs(y[on_rim, 1] - y[on_rim, 0])
    upwards = np.where(np.all(z[on_rim] > 0.7 - 1e-9, axis=1), 1.0, -1.0)
    sides = (shape.potential[rim[on_rim]].mean(axis=1) * length_z * upwards).sum()
    x = np.linspace(-LENGTH / 2.0, LENGTH / 2.0, 2001)
    x_cos = np.trapezoid(x * np.cos(k * (x + LENGTH / 2.0)), x)
    by_hand = 998.2 * (ends - x_cos * sides)
    assert computed_modes(tank, 1)[0].lambda_02 == pytest.approx(by_hand, rel=2e-3)


def test_shapes_have_unit_mean_and_are_symmetric():
    for mode in tank_modes(cylinder(0.75), 3).modes:
        shape = mode.shape
        assert np.trapezoid(shape.surface_rise, shape.surface_y) == pytest.approx(np.ptp(shape.surface_y), rel=2e-4)
        assert shape.surface_y == pytest.approx(-shape.surface_y[::-1])
        assert shape.surface_rise == pytest.approx(shape.surface_rise[::-1])
        assert np.all(np.diff(shape.surface_y) > 0.0)
        assert np.ptp(shape.surface_y) == pytest.approx(2.0 * math.sqrt(1.2**2 - 0.6**2))
        assert np.unique(shape.triangles).size == shape.y.size == shape.z.size == shape.potential.size


def test_circle_and_round_ellipse_are_the_same_tank():
    assert computed_modes(ellipse(0.6, 2.4, 2.4), 2) == computed_modes(cylinder(0.6, 1.2), 2)


def test_many_sided_polygon_tends_to_the_cylinder():
    round_tank = computed_modes(cylinder(0.5), 1)[0]
    errors = []
    for sides in (24, 48, 96):
        mode = computed_modes(polygon(regular_polygon(sides)), 1)[0]
        errors.append(abs(mode.frequency / round_tank.frequency - 1.0))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.2)
    assert errors[-1] < 1e-3


def test_long_waves_follow_the_shallow_water_formula():
    tank = cylinder(0.5, 1.5, 150.0)
    section = section_of(tank)
    speed_squared = GRAVITY * section.area(1.5) / section.surface_width(1.5)
    assert computed_modes(tank, 1)[0].frequency == pytest.approx(math.pi / 150.0 * math.sqrt(speed_squared), rel=2e-4)


@pytest.mark.parametrize("fill", [0.05, 0.5, 0.95])
def test_ten_modes_come_as_well_as_one(fill):
    ten, one = computed_modes(cylinder(fill), 10), computed_modes(cylinder(fill), 1)
    assert len(ten) == 10
    assert ten[0].frequency == pytest.approx(one[0].frequency, rel=1e-5)
    assert np.all(np.diff([mode.frequency for mode in ten]) > 0.0)
    assert sum(mode.slosh_mass for mode in ten) < frozen_load(cylinder(fill)).mass


def test_the_liquid_sets_mass_and_damping_only():
    light, heavy = (
        computed_modes(cylinder(liquid=Liquid(model="modal", density=density, damping_ratio=ratio)), 1)[0]
        for density, ratio in ((500.0, 0.0), (1000.0, 0.01))
    )
    assert heavy.frequency == light.frequency
    assert heavy.lambda_1 == pytest.approx(2.0 * light.lambda_1)
    assert heavy.lambda_02 == pytest.approx(2.0 * light.lambda_02)
    assert heavy.mu == pytest.approx(2.0 * light.mu)
    assert (light.damping_ratio, heavy.damping_ratio) == (0.0, 0.01)


def test_a_scenario_gets_the_modes_it_asks_for():
    three = cylinder().model_copy(update={"modes": 3})
    assert slosh_modes(three) == computed_modes(three, 3)
    assert slosh_modes(cylinder(liquid=Liquid(model="rigid", density=998.2))) == ()


def test_given_coefficients_are_used_as_they_are():
    class Given:
        frequency, lambda_1, lambda_02, mu, damping_ratio = 0.69, 137071.0, -68461.0, 442163.0, 0.004

    tank = cylinder().model_copy(update={"coefficients": (Given(),)})
    assert slosh_modes(tank) == (SloshMode(0.69, 137071.0, -68461.0, 442163.0, 0.004),)
