"""The torque of a brake at full application, by hand (theory section 12)."""

import math

import pytest

from slosh_cli.errors import PhysicsError
from slosh_cli.wagon.torque import (
    _braking_force,
    _stopping_distance,
    brake_torque,
    changeover_share,
    constant_torque,
    moved_mass,
    nominal_torque,
    total_mass,
)

LOAD = 830 * 15.5 * math.pi * 1.5**2 / 2
GROSS = 21.3e3 + 2 * 1.8e3 + 4 * 1.4e3 + LOAD
MOVED = GROSS + 4 * 120.0 / 0.46**2
FREE = (0.0, 0.0, 0.0)
DELAY, BUILD_UP = 0.2, 4.0
"""Of the build-up that belongs to a braked weight, s."""
MASS, SPEED = 50e3, 30.0


def test_masses_of_the_paper_s_wagon(shipped):
    """Half a cylinder of 1.5 m and 15.5 m; four wheelsets of 120 kg m^2."""
    wagon = shipped("paper_80_solid")
    assert total_mass(wagon) == pytest.approx(GROSS, rel=1e-9)
    assert moved_mass(wagon) == pytest.approx(MOVED, rel=1e-9)


def changed_over(shipped, gross_mass, *more):
    changeover = f"braking.load_changeover={{gross_mass: {gross_mass!r} kg, empty_share: 0.6}}"
    return shipped("paper_80_solid", changeover, *more)


def test_the_changeover_counts_below_its_mass_only(shipped):
    mass = total_mass(shipped("paper_80_solid"))
    assert changeover_share(shipped("paper_80_solid")) == 1.0
    assert changeover_share(changed_over(shipped, mass)) == 1.0
    assert changeover_share(changed_over(shipped, mass + 1.0)) == 0.6


def test_torque_of_a_part_of_the_brake(shipped):
    """A told torque knows no speed; blocks have the friction of the force that is left, at rest where a wheel turns
    back."""
    told = shipped("paper_80_solid")
    assert (brake_torque(told, 20.0), brake_torque(told, 20.0, 0.25)) == (5e3, 1250.0)
    assert brake_torque(changed_over(shipped, 100e3), 20.0, 0.5) == pytest.approx(0.5 * 0.6 * 5e3)
    assert nominal_torque(changed_over(shipped, 100e3)) == pytest.approx(0.6 * 5e3)
    blocks = "braking.blocks={count: 2, force: 25 kN, friction: cast-iron}"
    light = changed_over(shipped, 100e3, blocks)

    def by_hand(force, speed):
        friction = 0.6 * (1.62 * force + 100) / (8.1 * force + 100) * (speed + 100) / (5 * speed + 100)
        return 2 * friction * force * 1e3 * 0.46

    assert brake_torque(light, 20.0, 0.5) == pytest.approx(by_hand(7.5, 72.0), rel=1e-12)
    assert brake_torque(light, 0.0) == brake_torque(light, -9.0) == pytest.approx(by_hand(15.0, 0.0), rel=1e-12)
    assert brake_torque(light, 0.5) == pytest.approx(by_hand(15.0, 1.8), rel=1e-12)
    assert nominal_torque(light) == pytest.approx(by_hand(15.0, 80.0), rel=1e-12)


def test_torque_of_a_deceleration_and_of_a_braked_weight(shipped):
    """Without the changeover; eight wheels share the force."""
    slowed = changed_over(shipped, 100e3, "braking.deceleration=0.9 m/s^2")
    assert constant_torque(slowed) == pytest.approx(0.46 * 0.9 * MOVED / 8, rel=1e-9)
    free = "wagon.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s^2/m^2}"
    signed = shipped("paper_80_solid", "braking.braked_weight={percentage: 65, speed: 100 km/h}", free)
    speed = 100 / 3.6
    deceleration = 8 * constant_torque(signed) / 0.46 / MOVED
    way = speed * (DELAY + BUILD_UP / 2) + speed**2 / (2 * deceleration) - deceleration * BUILD_UP**2 / 24
    assert way == pytest.approx(52840 / 75, rel=1e-8)
    told = shipped("paper_80_solid", "braking.torque=7 kN m")
    assert constant_torque(told) == 7e3


@pytest.mark.parametrize("deceleration", [0.3, 1.0, 7.4])
def test_a_stop_beyond_the_build_up_has_its_closed_form(deceleration):
    way = SPEED * (DELAY + BUILD_UP / 2) + SPEED**2 / (2 * deceleration) - deceleration * BUILD_UP**2 / 24
    assert _stopping_distance(MASS, FREE, SPEED, MASS * deceleration) == pytest.approx(way, rel=1e-9)
    assert _braking_force(MASS, FREE, SPEED, way) == pytest.approx(MASS * deceleration, rel=1e-8)


@pytest.mark.parametrize("deceleration", [20.0, 400.0])
def test_a_stop_within_the_build_up_has_its_closed_form(deceleration):
    """`V - a t^2/(2 T)` is zero at `sqrt(2 T V/a)`."""
    time = math.sqrt(2 * BUILD_UP * SPEED / deceleration)
    way = SPEED * (DELAY + time) - deceleration * time**3 / (6 * BUILD_UP)
    assert time < BUILD_UP
    assert _stopping_distance(MASS, FREE, SPEED, MASS * deceleration) == pytest.approx(way, rel=1e-8)
    assert _braking_force(MASS, FREE, SPEED, way) == pytest.approx(MASS * deceleration, rel=1e-6)


@pytest.mark.parametrize(
    ("resistance", "way"),
    [
        ((5e4, 0.0, 0.0), 30.0**2 / 2),  # evenly slowed by 1 m/s^2
        ((0.0, 1e4, 0.0), 30.0 / 0.2),  # V T, which it only comes near
        ((1e7, 0.0, 0.0), 30.0**2 / 400),  # within the delay
        ((5e5, 0.0, 0.0), 30.0**2 / 20),  # within the build-up
        ((5e5, 1e5, 0.0), 15.0 - 2.5 * math.log(7.0)),  # there, too: `m/b (V - c/b ln(1 + b V/c))`
        ((5e4, 0.0, 500.0), math.log(1 + 0.01 * 900) / 0.02),
    ],
)
def test_resistance_alone_has_its_closed_forms(resistance, way):
    found = _stopping_distance(MASS, resistance, SPEED, 0.0)
    assert found == (math.inf if resistance[0] == 0.0 else pytest.approx(way, rel=1e-8))
    creeping = _stopping_distance(MASS, (0.0, 1e4, 0.0), SPEED, 1e-3)
    assert creeping == pytest.approx(30.0 / 0.2, rel=1e-4)


def test_a_distance_longer_than_resistance_leaves_is_refused():
    resistance = (5e4, 0.0, 0.0)
    assert 0.0 <= _braking_force(MASS, resistance, SPEED, 449.9) < 0.01 * MASS
    with pytest.raises(PhysicsError, match="less than the 451 m") as refused:
        _braking_force(MASS, resistance, SPEED, 451.0)
    assert refused.value.where == "braking.braked_weight"
