"""Wheel slide protection: vents, holds and fills the brake of each wheelset by its slip (theory section 13)."""

import math

import numpy as np
import pytest

from slosh_cli.compiled import kernel
from slosh_cli.results.channels import wheel
from slosh_cli.wagon.brake import torque_brake

WET = ("braking.blocks={count: 2, force: 40 kN, friction: cast-iron}", "braking.application=P", "contact.adhesion=wet")
LIGHT = ("tank.fill=0.02", "braking.initial_speed=100 km/h")
PROTECTED = "braking.slide_protection={}"


@kernel
def pass_break(brake, time, v):
    return brake.pass_break(time, v, 1)


@kernel
def share_at(brake, wheel, time):
    return brake.share(wheel, time)


def watched(slips, speed=20.0):
    """A brake of four wheels, and velocities at which they slip so."""
    given = {"radius": 0.5, "hold_above": 0.1, "vent_above": 0.2, "release_speed": 1.4, "fill_time": 0.4}
    brake = torque_brake(1e4, 0.0, period=0.02, vent_time=0.15, next_sample=0.0, **given)
    return brake, np.array([speed, *((1.0 - slip) * speed / 0.5 for slip in slips)])


def test_share_follows_its_closed_forms_between_samples():
    brake, v = watched([0.05, 0.15, 0.25, 1.0])
    assert pass_break(brake, 0.0, v)
    found = [share_at(brake, i, 0.02) for i in range(4)]
    assert found == pytest.approx([1.0, 1.0, math.exp(-0.02 / 0.15), math.exp(-0.02 / 0.15)], rel=1e-14)
    assert not pass_break(brake, 0.02, v)
    v[1:] = 40.0
    assert pass_break(brake, 0.04, v)
    vented = math.exp(-0.04 / 0.15)
    filled = 1.0 - (1.0 - vented) * math.exp(-0.01 / 0.4)
    assert [share_at(brake, i, 0.05) for i in range(4)] == pytest.approx([1.0, 1.0, filled, filled], rel=1e-14)
    assert list(brake.vents) == [0, 0, 1, 1]
    assert list(brake.air) == pytest.approx([0.0, 0.0, 1.0 - vented, 1.0 - vented], rel=1e-13)


def test_below_the_release_speed_it_fills_whatever_slips():
    brake, v = watched([1.0] * 4, speed=1.3)
    pass_break(brake, 0.0, v)
    assert [share_at(brake, i, 0.02) for i in range(4)] == [1.0] * 4
    assert not brake.vents.any()


@pytest.fixture(scope="module")
def stops(stop):
    """Stops of the nearly empty wagon on a wet rail: without protection, with it, with the sampling halved."""
    finer = "braking.slide_protection={period: 10 ms}"
    return [stop("paper_80_solid", *WET, *LIGHT, *more) for more in ([], [PROTECTED], [finer])]


def test_no_wheel_locks_above_the_release_speed_and_the_stop_is_no_longer(stops):
    locked, protected, _ = stops
    assert max(locked.locked_time_s) > 1.0
    fast = protected.channels["speed"] > 5.0 / 3.6
    for i in (1, 2, 3, 4):
        assert protected.channels[wheel(i, "speed")][fast].min() > 0.01
    assert protected.braking_distance_m < locked.braking_distance_m
    assert protected.slide_protection_cycles > 10
    assert 0.0 < protected.slide_protection_air <= protected.slide_protection_cycles
    assert locked.slide_protection_cycles is None


def test_half_the_period_moves_the_distance_by_less_than_half_a_per_cent(stops):
    _, protected, finer = stops
    assert finer.braking_distance_m == pytest.approx(protected.braking_distance_m, rel=5e-3)
    assert max(protected.energy_residual, finer.energy_residual) < 1e-4


def test_histories_hold_the_share(stops):
    share = stops[1].channels[wheel(4, "slide_protection_share")]
    assert share.min() < 0.5
    assert share.max() == 1.0
    assert wheel(4, "slide_protection_share") not in stops[0].channels


def test_friction_sees_the_force_that_slide_protection_leaves(stops):
    """`T = n mu(v, p a F) p a F R`: less force, more friction."""
    for i in (1, 4):
        told = {name: stops[1].channels[wheel(i, name)] for name in ("slide_protection_share", "speed", "held_torque")}
        force = 40.0 * stops[1].channels["brake_application"] * told["slide_protection_share"]
        speed = 3.6 * np.maximum(told["speed"], 0.0)
        mu = 0.6 * (1.62 * force + 100) / (8.1 * force + 100) * (speed + 100) / (5 * speed + 100)
        np.testing.assert_allclose(told["held_torque"], 2e3 * mu * force * 0.46, rtol=1e-9, atol=1e-6)
