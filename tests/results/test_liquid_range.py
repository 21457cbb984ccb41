"""Verdicts on what a liquid's motion does to its model."""

import pytest

from slosh_cli.results.liquid_range import Motion, motion_checks
from slosh_cli.results.simulate import simulate
from slosh_cli.scenario import HorizontalCylinder, Liquid, load_scenario

SLOT = "liquid in the slot over the room above the liquid"


def slot_check(fill, head, slot_speed=30.0, **how):
    liquid = Liquid(model="shallow-water", density=830.0, slot_speed=slot_speed)
    tank = HorizontalCylinder(radius=1.5, length=15.5, fill=fill, liquid=liquid)
    return next((check for check in motion_checks(tank, Motion(1.0, head, **how), "") if check.name == SLOT), None)


@pytest.mark.parametrize(("fill", "slot_speed"), [(0.5, 30.0), (0.9, 30.0), (0.98, 100.0)])
def test_what_the_slot_may_hold_is_its_width_times_half_the_head_over_the_room(fill, slot_speed):
    """By hand for a circle: the slot is g A/c^2 wide, and the head falls evenly along the tank."""
    import numpy as np

    whole, cosine = np.pi * 1.5**2, 1.0 - 2.0 * fill
    wetted = 1.5**2 * (np.arccos(cosine) - cosine * np.sqrt(1.0 - cosine**2))
    held = 9.81 * whole / slot_speed**2 * 2.0 / 2.0
    found = slot_check(fill, 2.0, slot_speed)
    assert found.value == pytest.approx(held / (whole - wetted), rel=1e-9)
    assert found.within is (fill == 0.5)
    assert found.kind == "model"


def test_columns_hold_nothing_in_the_slot():
    assert slot_check(0.98, 2.0, slot_alone=False) is None


def test_a_nearly_full_stop_is_outside_its_model_a_half_full_one_that_strikes_the_roof_is_not():
    stop = {"tank.coefficients": "computed", "tank.liquid.model": "shallow-water"}
    paper = load_scenario("paper-80-liquid").with_(stop)
    half = simulate(paper.with_({"braking.torque": "10 kN m"}))
    full = simulate(paper.with_({"tank.fill": 0.95}))
    assert half.in_model_range
    assert not any("slot above the roof may hold" in text for text in half.warnings)
    assert not full.in_model_range
    assert any("slot above the roof may hold" in text for text in full.warnings)
