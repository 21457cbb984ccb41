"""Brakes that build up and fade: laws, applications, locks (theory section 12). Stops: `slosh validate brakes`."""

import math

import numpy as np
import pytest

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
from slosh_cli.wagon.brake import LAWS, torque_brake
from tests.solver.linear_systems import with_parts


@kernel
def friction_at(brake, speed, force):
    return brake.friction(speed, force)


@kernel
def torque_at(brake, time, spin):
    return brake.torque(0, time, spin)


@kernel
def share_at(brake, time):
    return brake.application(time)


SLOW = ("braking.initial_speed=100 km/h", "braking.onset=0.1 s", "output.interval=100 s")
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


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("spin", [-1.0, 3.0, 30.0, 80.0])
def test_slope_of_the_torque_over_spin(law, spin):
    brake = rubbing(LAWS.index(law), (0.0, 40.0, 100.0), (0.4, 0.3, 0.1))
    brake.breaks = 1
    above, below = (torque_at(brake, 1.0, spin + step)[0] for step in (1e-4, -1e-4))
    assert torque_at(brake, 1.0, spin)[1] == pytest.approx((above - below) / 2e-4, rel=1e-6, abs=1e-6)


def test_friction_table_is_straight_between_points_and_constant_beyond():
    brake = rubbing(TABLE, (10.0, 40.0, 100.0), (0.4, 0.34, 0.1))
    found = [friction_at(brake, v / 3.6, 1e3)[0] for v in (-5.0, 0.0, 25.0, 70.0, 100.0, 130.0)]
    assert found == pytest.approx([0.4, 0.4, 0.37, 0.22, 0.1, 0.1])


def test_applications():
    assert shares(StepApplication(), [-1.0, 0.0, 9.0]) == [0.0, 1.0, 1.0]
    assert shares(LinearApplication(time=4.0), [0.0, 1.0, 4.0, 9.0]) == pytest.approx([0.0, 0.25, 1.0, 1.0])
    assert shares(FillingApplication(time_95=4.0), [0.0, 4.0, 1e3]) == pytest.approx([0.1, 0.95, 1.0])
    late = FillingApplication(time_95=4.0, delay=1.0, jump=0.2)
    rate = math.log(0.8 / 0.05) / 3.0
    assert shares(late, [0.0, 0.99, 1.0, 2.0, 4.0]) == pytest.approx([0.0, 0.0, 0.2, 1 - 0.8 * math.exp(-rate), 0.95])
    falling = TableApplication(points=[(0.0, 0.3), (2.0, 0.9), (4.0, 0.1)])
    assert shares(falling, [0.0, 1.0, 3.0, 4.0, 9.0]) == pytest.approx([0.3, 0.6, 0.5, 0.1, 0.1])


def test_cast_iron_locks_wheels_at_the_end_and_a_falling_table_releases_them(shipped):
    case = shipped(
        "paper_80_solid",
        "braking.initial_speed=100 km/h",
        "braking.onset=0.1 s",
        "output.interval=100 s",
        "contact.adhesion=0.15",
    )
    _, vehicle = stop_with(case, rubbing(CAST_IRON, force=30e3))
    assert vehicle.locked.any()
    assert vehicle.account.locked_time.max() < 10.0
    falling = TableApplication(points=[(0.0, 1.0), (3.0, 1.0), (4.0, 0.1)])
    _, freed = stop_with(case, torque_brake(12e3, 0.1, falling.stretches))
    assert not freed.locked.any()
    assert freed.account.locked_time.max() > 1.0
