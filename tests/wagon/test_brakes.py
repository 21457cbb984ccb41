"""Brakes that build up and fade, against quadratures and closed forms (theory section 12)."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from slosh_cli.compiled import kernel
from slosh_cli.method import START
from slosh_cli.scenario.schema_application import (
    FillingApplication,
    LinearApplication,
    StepApplication,
    TableApplication,
)
from slosh_cli.solver import advance as loop
from slosh_cli.solver.record import columns_of
from slosh_cli.solver.setup import problem
from slosh_cli.validation.exact.wagon import point_wagon
from slosh_cli.wagon.brake import LAWS, torque_brake
from tests.solver.linear_systems import with_parts

STIFF = (
    "braking.initial_speed=100 km/h",
    "braking.onset=0.1 s",
    "braking.stop_speed=1 mm/s",
    "contact.kalker_c11=100",
    "output.interval=100 s",
)
STIFF_WAGON = (
    "wagon.primary_suspension.stiffness=2e9 N/m",
    "wagon.primary_suspension.damping=1e6 N s/m",
    "wagon.secondary_suspension.stiffness=2e9 N/m",
    "wagon.secondary_suspension.damping=1e6 N s/m",
    "track.foundation.stiffness=1e10 N/m^2",
    "contact.stiffness=1e14 N/m^1.5",
)


@kernel
def friction_at(brake, speed, force):
    return brake.friction(speed, force)


@kernel
def torque_at(brake, time, spin):
    return brake.torque(0, time, spin)


@kernel
def share_at(brake, time):
    return brake.application(time)


TABLE, CAST_IRON, COMPOSITE = range(len(LAWS))


def rubbing(law=TABLE, speeds=(0.0,), frictions=(0.3,), force=30e3, onset=0.1):
    """Two blocks per wheel."""
    table = {"speeds": np.array(speeds), "frictions": np.array(frictions)}
    return torque_brake(2.0, onset, force=force, arm=0.46, radius=0.46, law=law, **table)


def shares(application, times):
    """The application at rising times, each break passed when it is due."""
    brake, found = torque_brake(1.0, 0.0, application.stretches), []
    for time in times:
        while brake.breaks < len(brake.starts) and brake.starts[brake.breaks] <= time:
            brake.breaks += 1
        found.append(share_at(brake, time))
    return found


def stop_with(case, brake):
    """Distance from the onset, and the wagon at the end of a run with `brake`."""
    train = with_parts(problem(case), brake=brake).train
    vehicle = train.vehicles[0]
    rows = np.zeros((8, 1, columns_of(vehicle).end))
    outcome = loop.RUNNING
    while outcome == loop.RUNNING:
        outcome = loop.advance(train, rows, 100)
    assert outcome == loop.STOPPED
    return vehicle.points[START].q[0] - vehicle.account.onset_position, vehicle


@pytest.mark.parametrize(
    ("law", "km_h", "expected"),
    [(CAST_IRON, 0.0, 0.2599), (CAST_IRON, 80.0, 0.0936), (COMPOSITE, 0.0, 0.3163), (COMPOSITE, 80.0, 0.2346)],
)
def test_friction_laws_give_the_numbers_of_the_theory(law, km_h, expected):
    assert friction_at(rubbing(law), km_h / 3.6, 30e3)[0] == pytest.approx(expected, abs=5.1e-5)


def test_mean_of_cast_iron_over_the_distance():
    """20 kN, from 100 km/h to rest: the constant friction that stops in the same distance."""
    brake, start = rubbing(CAST_IRON), 100 / 3.6
    way = quad(lambda v: v / friction_at(brake, v, 20e3)[0], 0.0, start)[0]
    assert start**2 / 2 / way == pytest.approx(0.1191, abs=5e-5)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("spin", [-1.0, 3.0, 30.0, 80.0])
def test_slope_of_the_torque_over_spin(law, spin):
    brake = rubbing(LAWS.index(law), (0.0, 40.0, 100.0), (0.4, 0.3, 0.1))
    brake.breaks = 1
    above, below = (torque_at(brake, 1.0, spin + step)[0] for step in (1e-4, -1e-4))
    assert torque_at(brake, 1.0, spin)[1] == pytest.approx((above - below) / 2e-4, rel=1e-6, abs=1e-6)


def test_friction_table_is_straight_between_points_and_constant_beyond():
    brake = rubbing(TABLE, (10.0, 40.0, 100.0), (0.4, 0.3, 0.1))
    found = [friction_at(brake, v / 3.6, 1e3)[0] for v in (-5.0, 0.0, 25.0, 70.0, 100.0, 130.0)]
    assert found == pytest.approx([0.4, 0.4, 0.35, 0.2, 0.1, 0.1])


def test_applications():
    assert shares(StepApplication(), [-1.0, 0.0, 9.0]) == [0.0, 1.0, 1.0]
    assert shares(LinearApplication(time=4.0), [0.0, 1.0, 4.0, 9.0]) == pytest.approx([0.0, 0.25, 1.0, 1.0])
    assert shares(FillingApplication(time_95=4.0), [0.0, 4.0, 1e3]) == pytest.approx([0.1, 0.95, 1.0])
    late = FillingApplication(time_95=4.0, delay=1.0, jump=0.2)
    rate = math.log(0.8 / 0.05) / 3.0
    assert shares(late, [0.0, 0.99, 1.0, 2.0, 4.0]) == pytest.approx([0.0, 0.0, 0.2, 1 - 0.8 * math.exp(-rate), 0.95])
    falling = TableApplication(points=[(0.0, 0.3), (2.0, 0.9), (4.0, 0.1)])
    assert shares(falling, [0.0, 1.0, 3.0, 4.0, 9.0]) == pytest.approx([0.3, 0.6, 0.5, 0.1, 0.1])


EXACT = [(TABLE, (0.0,), (0.2,)), (CAST_IRON, (), ()), (COMPOSITE, (), ()), (TABLE, (0.0, 100.0), (0.25, 0.15))]


@pytest.mark.parametrize(("law", "speeds", "frictions"), EXACT, ids=["constant", "cast iron", "composite", "table"])
def test_stop_is_the_quadrature_of_each_law(shipped, law, speeds, frictions):
    """`ds = V dV/a(V)`: dry rail, a small force, so no wheel slips."""
    case = shipped("paper_80_solid", *STIFF, *STIFF_WAGON)
    wagon = point_wagon(case)
    brake = rubbing(law, speeds or (0.0,), frictions or (1.0,), force=6e3)
    distance, vehicle = stop_with(case, brake)
    mass = wagon.mass + wagon.rotating_mass

    def by_speed(v):
        pull = 8 * 2 * friction_at(brake, v, 6e3)[0] * 6e3 * 0.46 / wagon.wheel_radius
        return v * mass / (pull + wagon.resistance(v))

    start = speed_after(wagon, 100 / 3.6, 0.1)
    assert distance == pytest.approx(quad(by_speed, 1e-3, start, epsrel=1e-12)[0], rel=1e-4)
    assert not vehicle.locked.any()


def speed_after(wagon, speed, time):
    """Speed of a wagon that only rolls for a `time` short enough for one middle point."""
    mass = wagon.mass + wagon.rotating_mass
    middle = speed - 0.5 * time * wagon.resistance(speed) / mass
    return speed - time * wagon.resistance(middle) / mass


def test_linear_application_lengthens_the_stop_as_in_closed_form(shipped):
    """By `V0 tau/2 - A tau^2/24`, without resistance."""
    none = ("constant=0 N", "linear=0 N s/m", "quadratic=0 N s^2/m^2")
    free = [f"wagon.running_resistance.{one}" for one in none]
    case = shipped("paper_80_solid", *STIFF, *STIFF_WAGON, *free)
    wagon, torque, tau = point_wagon(case), 4e3, 4.0
    slowing = 8 * torque / wagon.wheel_radius / (wagon.mass + wagon.rotating_mass)
    step, _ = stop_with(case, torque_brake(torque, 0.1))
    built_up, _ = stop_with(case, torque_brake(torque, 0.1, LinearApplication(time=tau).stretches))
    longer = 100 / 3.6 * tau / 2 - slowing * tau**2 / 24
    assert built_up - step == pytest.approx(longer, rel=1e-3)


def test_cast_iron_locks_wheels_at_the_end_and_a_falling_table_releases_them(shipped):
    case = shipped("paper_80_solid", *STIFF[:2], "output.interval=100 s", "contact.adhesion=0.15")
    _, vehicle = stop_with(case, rubbing(CAST_IRON, force=30e3))
    assert vehicle.locked.any()
    assert vehicle.account.locked_time.max() < 10.0
    falling = TableApplication(points=[(0.0, 1.0), (3.0, 1.0), (4.0, 0.1)])
    _, freed = stop_with(case, torque_brake(12e3, 0.1, falling.stretches))
    assert not freed.locked.any()
    assert freed.account.locked_time.max() > 1.0
