"""Events that end a step: lock, release, creepage floor, pitch limit of a vehicle, stop.

Each event has a value that is positive until it happens. A value is *armed* once it has been clearly positive. Lift-off
and landing are no events: the force of a contact rises from zero with the power 3/2, so that accelerations do not jump.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.track.contact import CREEPAGE_SPEED_FLOOR
from slosh_cli.wagon.locking import SWITCH_TOLERANCE, wheel_values
from slosh_cli.wagon.model import CAR_PITCH, FIRST_BOGIE

SHORTEST_STEP = 1e-9
"""Steps do not go below this, s."""
_LARGEST_PITCH = 0.1
"""Small-angle kinematics say nothing beyond this pitch, rad (theory section 9)."""


@inner_kernel
def _vehicle_values(vehicle, stage, time, values):
    """Values of a vehicle's events at a stage, which is at `time` (s): of its wheels, of the creepage floor, of the
    pitch limit; `values` (wheels + 2,)."""
    wagon, point = vehicle.wagon, vehicle.points[stage]
    wheel_values(vehicle, point, time, values)
    values[wagon.wheels] = point.v[0] - CREEPAGE_SPEED_FLOOR
    pitch = abs(point.q[CAR_PITCH])
    for bogie in range(wagon.bogies):
        pitch = max(pitch, abs(point.q[FIRST_BOGIE + 1 + 2 * bogie]))
    values[wagon.wheels + 1] = 1.0 - pitch / _LARGEST_PITCH


@inner_kernel
def _speed_at(train, stage):
    """Mean speed (m/s) of the vehicles by their mass."""
    vehicles, total = train.vehicles, 0.0
    for k in range(len(vehicles)):
        total += train.shares[k] * vehicles[k].points[stage].v[0]
    return total


@inner_kernel
def read_values(train, stage, time):
    """Values of all events at a stage, which is at `time` (s)."""
    vehicles = train.vehicles
    for k in range(len(vehicles)):
        _vehicle_values(vehicles[k], stage, time, vehicles[k].account.values)
    train.stop_values[1] = _speed_at(train, stage) - train.control.stop_speed


@inner_kernel
def keep_values(train):
    """Let the values in hand be those before the next step."""
    vehicles = train.vehicles
    for k in range(len(vehicles)):
        values, before = vehicles[k].account.values, vehicles[k].account.values_before
        for i in range(values.size):
            before[i] = values[i]
    train.stop_values[0] = train.stop_values[1]


@inner_kernel
def _crossing(before, after, step):
    """Step (s) at the end of which a value that goes from `before` to `after` within `step` is zero; linear."""
    if after < -SWITCH_TOLERANCE and before > SWITCH_TOLERANCE:
        return step * before / (before - after)
    return step


@inner_kernel
def shorter_step(train, step):
    """Step (s) that ends at the first event between the values before and those in hand; `step` where there is none.

    A wheel's event that was not armed and went the wrong way at once asks for a tenth.
    """
    vehicles, best = train.vehicles, min(step, _crossing(train.stop_values[0], train.stop_values[1], step))
    for k in range(len(vehicles)):
        before, after = vehicles[k].account.values_before, vehicles[k].account.values
        for i in range(before.size):
            best = min(best, _crossing(before[i], after[i], step))
            if i < vehicles[k].wagon.wheels and after[i] < -SWITCH_TOLERANCE and abs(before[i]) <= SWITCH_TOLERANCE:
                best = min(best, 0.1 * step)
    return best


@inner_kernel
def reached(before, after):
    """True when an armed event has come about at the end of a step with values `before` and `after`."""
    return before > SWITCH_TOLERANCE and after <= SWITCH_TOLERANCE
