"""The solutions that cases compare with, against each other and against what is known of them."""

import numpy as np
import pytest

from slosh_cli.validation.exact import exudyn_bodies
from slosh_cli.validation.exact.fixed_rail import element_matrices, fixed_rail, roll
from slosh_cli.validation.exact.quadrature import integral
from slosh_cli.validation.exact.steady_rail import Beam, closed_form, fourier_integral

PAPER = Beam(bending=6.12e6, mass=60.0, stiffness=1e7, shear=666875.0)


@pytest.mark.parametrize("speed", [0.0, 100.0, 400.0])
@pytest.mark.parametrize("r", [0.0, 0.7, -2.0])
def test_closed_form_and_fourier_integral_agree_without_damping(speed, r):
    assert fourier_integral(PAPER, r, speed) == pytest.approx(
        float(closed_form(PAPER, r, speed)), abs=1e-6 * float(closed_form(PAPER, 0.0, speed))
    )


def test_textbook_element_bends_as_a_cubic_does():
    mass, tension, bending = element_matrices(0.7)
    rigid, turned = np.array([1, 0, 1, 0]), np.array([0, 1, 0.7, 1])
    assert rigid @ mass @ rigid == pytest.approx(0.7)
    assert turned @ tension @ turned == pytest.approx(0.7)
    assert bending @ rigid == pytest.approx(np.zeros(4), abs=1e-12)
    assert bending @ turned == pytest.approx(np.zeros(4), abs=1e-12)
    square = np.array([0, 0, 0.49, 1.4])
    assert square @ bending @ square == pytest.approx(4 * 0.7)


def test_fixed_rail_at_rest_is_the_closed_form():
    rail = fixed_rail(PAPER, 0.25, 240)
    under = roll(rail, np.full((2, 1), 30.0), np.full((2, 1), 1e5), 1e-3)
    assert -under[:, 0] / 1e5 == pytest.approx([float(closed_form(PAPER, 0.0, 0.0))] * 2, rel=2e-5)


def test_fixed_rail_reaches_the_steady_state_of_a_moving_load():
    damped = Beam(bending=6.12e6, mass=600.0, stiffness=1e6, shear=666875.0, damping=4e4)
    speed, step = 45.0, 5e-4
    places = 20.0 + speed * step * np.arange(3200)[:, None]
    under = roll(fixed_rail(damped, 0.25, 440), places, np.ones_like(places), step)
    assert -under[-1, 0] == pytest.approx(fourier_integral(damped, 0.0, speed), rel=2e-4)


def test_integral_of_a_jump():
    time = np.linspace(0.0, 2.0, 201)
    values = np.where(time < 0.5, time, 3.0 - time)
    assert integral(time, values, 0.5) == pytest.approx(0.125 + 4.5 - 1.875, rel=1e-12)
    assert np.trapezoid(values, time) != pytest.approx(0.125 + 4.5 - 1.875, rel=1e-3)


@pytest.mark.parametrize(
    "keys",
    [
        "torque: 5 kN m, application: {form: linear, time: 4 s}",
        "torque: 5 kN m, application: P",
        "torque: 5 kN m, slide_protection: {}",
        "blocks: {count: 2, force: 25 kN, friction: 0.27}",
    ],
)
def test_the_second_code_refuses_brakes_that_it_does_not_know(shipped, keys):
    case = shipped("paper_80", f"braking={{initial_speed: 80 km/h, onset: 0.5 s, {keys}}}")
    with pytest.raises(ValueError, match="constant torque applied at once"):
        exudyn_bodies.WheelContact(case)


def test_the_second_code_refuses_a_gradient_and_takes_the_wagon_of_the_paper(shipped):
    exudyn_bodies.WheelContact(shipped("paper_80"))
    with pytest.raises(ValueError, match="the line must be level"):
        exudyn_bodies.WheelContact(shipped("paper_80", "track.gradient=0.01"))
