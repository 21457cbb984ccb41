"""One model is recommended for a tank, its filling and a deceleration, whichever model is in use."""

import itertools
import re

import numpy as np
import pytest

from slosh_cli.results.liquid_range import Motion, expected_checks, motion_checks, tank_checks
from slosh_cli.results.recommendation import (
    LINEAR_ERRORS,
    SHALLOW_ERROR,
    linear_error,
    movement_of,
    recommend,
    shallow_error,
    stop_deceleration,
)
from slosh_cli.results.validity import warnings_of
from slosh_cli.scenario import HorizontalCylinder, Liquid, Rectangular, Scenario
from slosh_cli.scenario.schema_tank import Baffle

DEPTH, ROOF, LENGTH = 1.1875, 3.0, 15.5


def tank(kind="cylinder", length=15.5, fill=0.5, model="modal"):
    liquid = Liquid(model=model, density=830.0)
    if kind == "cylinder":
        return HorizontalCylinder(radius=1.5, length=length, fill=fill, liquid=liquid)
    return Rectangular(width=2.4, height=ROOF, length=length, fill=fill, liquid=liquid)


GRID = list(itertools.product(("cylinder", "box"), (4.0, 15.5), (0.2, 0.5, 0.9), (0.05, 0.3, 1.0, 4.0)))


@pytest.mark.parametrize(("kind", "length", "fill", "deceleration"), GRID)
def test_both_models_send_the_user_to_the_same_one(kind, length, fill, deceleration):
    """Whatever is warned of, from either model, before or after: no sentence names another model to use."""
    found = set()
    for model in ("modal", "shallow-water"):
        one = tank(kind, length, fill, model)
        advice = recommend(one, deceleration)
        found.add(advice)
        far = Motion(surface=10.0, head=1.0)
        told = (*tank_checks(one, advice.sentence), *motion_checks(one, far, advice.sentence))
        told += expected_checks(one, deceleration, advice.sentence)
        named = re.findall(r"use tank\.liquid\.model: ([a-z-]+)", " ".join(warnings_of(told)), re.IGNORECASE)
        assert set(named) == ({advice.model} if named else set())
        assert named or model == "shallow-water"  # which struck the roof and is within its range otherwise
        assert "ompare with tank.liquid" not in " ".join(warnings_of(told))
    (advice,) = found
    assert advice.error <= advice.other_error
    assert advice == recommend(one, -deceleration)


def test_the_errors_are_those_of_the_comparisons_with_interfoam():
    """Movement a L/g over the depth, 1.1875 m, at 0.6 and 1.5 m/s^2; modal 0.218 and 0.363, shallow water 0.132."""
    places = [a * LENGTH / 9.81 / DEPTH for a in (0.6, 1.5)]
    assert [x for x, _ in LINEAR_ERRORS[1:]] == pytest.approx(places, abs=1e-3)
    assert [linear_error(x) for x in places] == pytest.approx([0.218, 0.363], abs=1e-3)
    assert shallow_error(0.0) == SHALLOW_ERROR == 0.132
    compared = tank("box", fill=DEPTH / ROOF)
    assert recommend(compared, 0.6).model == recommend(compared, 1.5).model == "shallow-water"


@pytest.mark.parametrize("error", [0.01, 0.132, 0.218, 0.3, 0.6])
def test_movement_and_error_are_inverse(error):
    assert linear_error(movement_of(error)) == pytest.approx(error)


def test_drift_is_what_a_frequency_too_high_makes_of_a_cosine():
    """Share 8/pi^2 of the force at a frequency 3 % too high, over 1.5 periods, beside the right one."""
    t = np.linspace(0.0, 1.5, 20001)
    miss = 8 / np.pi**2 * (np.cos(2 * np.pi * 1.03 * t) - np.cos(2 * np.pi * t))
    rms = np.sqrt(np.mean(miss**2))
    assert np.sqrt(shallow_error(0.03) ** 2 - SHALLOW_ERROR**2) == pytest.approx(rms, rel=0.1)


@pytest.mark.parametrize("fill", [0.2, 0.5, 0.9])
def test_the_model_changes_where_it_is_said_to(fill):
    one = tank(fill=fill)
    limit = recommend(one, None).changeover
    assert recommend(one, 0.99 * limit).model == "modal"
    assert recommend(one, 1.01 * limit).model == "shallow-water"
    assert f"{limit:.2f} m/s^2" in recommend(one, None).sentence


def test_baffles_leave_no_choice():
    walls = tank(model="shallow-water").model_copy(update={"baffles": (Baffle(position=5.0, opening=0.2),)})
    assert recommend(walls, 1e-3).model == "shallow-water"
    assert recommend(walls, None).changeover == 0.0


def test_where_neither_is_good_it_is_said():
    deep = tank("box", length=4.0, fill=0.7)
    advice = recommend(deep, 3.0)
    assert "neither model is good here" in advice.sentence


def test_deceleration_of_a_stop(scenario: Scenario):
    """By hand: 8 x 5 kN m/0.46 m and 1,763 N over 75,968.7 kg and 4 x 120/0.46^2 kg; at most the rail's 0.55 g."""
    drag = 851 + 13.5 * 80 / 3.6 + 1.244 * (80 / 3.6) ** 2
    mass = 21300 + 2 * 1800 + 4 * 1400 + 830 * np.pi * 1.5**2 / 2 * 15.5
    by_torque = (8 * 5000 / 0.46 + drag) / (mass + 4 * 120 / 0.46**2)
    assert stop_deceleration(scenario) == pytest.approx(by_torque, rel=1e-9)
    hard = scenario.with_({"braking.torque": 1e5})
    assert stop_deceleration(hard) == pytest.approx(0.55 * 9.81 + drag / mass, rel=1e-9)


def test_a_run_of_either_model_recommends_the_same(stop):
    runs = [
        stop("paper_80", "tank.coefficients=computed", f"tank.liquid.model={model}", "braking.torque=10 kN m")
        for model in ("modal", "shallow-water")
    ]
    assert runs[0].recommendation == runs[1].recommendation
    assert runs[0].recommendation.model == "shallow-water"
    assert any(runs[0].recommendation.sentence in warning for warning in runs[0].warnings)
    assert runs[0].summary()["recommendation"]["liquid_model"] == "shallow-water"
    solid = stop("paper_80", "tank.coefficients=computed", "tank.liquid.model=rigid", "braking.torque=10 kN m")
    assert solid.recommendation is None


def test_no_packaged_scenario_is_sent_to_and_fro(shipped):
    for name in ("paper_80", "paper_160"):
        one = shipped(name)
        other = one.with_({"tank.liquid.model": "shallow-water"})
        assert recommend(one.tank, 1.0) == recommend(other.tank, 1.0)
