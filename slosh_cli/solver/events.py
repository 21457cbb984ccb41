"""Events that end a step: lock, release, creepage floor, stop, pitch limit.

Each event has a value that is positive until it happens. A value is *armed* once it has been clearly positive; a
wheel just released has exactly zero speed and so cannot relock before it has turned (model section 11). Lift-off and
landing are no events: the force of a contact rises from zero with the power 3/2, so that accelerations do not jump.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.solver.contacts import brake_holds
from slosh_cli.solver.state import PHASE, TIME
from slosh_cli.track.contact import CREEPAGE_SPEED_FLOOR
from slosh_cli.track.vectors import fill
from slosh_cli.wagon.brake import brake_torque
from slosh_cli.wagon.coordinates import BOGIE_PITCH, CAR_PITCH, WHEEL_SPIN, WHEELS

# places of the event values: four of the brakes, then these
BRAKE_EVENT, FLOOR_EVENT, STOP_EVENT, PITCH_EVENT = 0, 4, 5, 6
EVENT_COUNT = 7
EVENT_TOLERANCE = 1e-6
"""An event is reached when its value is this close to zero (m/s, or relative to torque, pitch limit)."""
SHORTEST_STEP = 1e-9
"""Steps do not go below this, s."""
TORQUE_RATE_OVER = 1e-6
"""The rate of the brakes' torque is its change over this time, s."""
LARGEST_PITCH = 0.1
"""Small-angle kinematics say nothing beyond this pitch, rad (model section 9)."""


@inner_kernel
def event_values(model, point, locked, torque, values):
    """Values of all events at `point` into `values` (EVENT_COUNT,); those that cannot happen are 1."""
    radius = model.wagon.wheel_radius
    fill(values, 1.0)
    speed = point.v[0]
    for i in range(WHEELS):
        if locked[i]:
            values[BRAKE_EVENT + i] = 1.0 - point.creep[i] * radius / torque if torque > 0.0 else -1.0
        elif torque > 0.0:
            values[BRAKE_EVENT + i] = radius * point.v[WHEEL_SPIN + i]
    values[FLOOR_EVENT] = speed - CREEPAGE_SPEED_FLOOR
    values[STOP_EVENT] = speed - model.control.stop_speed
    pitch = abs(point.q[CAR_PITCH])
    for bogie in range(2):
        pitch = max(pitch, abs(point.q[BOGIE_PITCH + 2 * bogie]))
    values[PITCH_EVENT] = 1.0 - pitch / LARGEST_PITCH


@inner_kernel
def shorter_step(before, after, step):
    """Step (s) that ends at the first event between values `before` and `after`; `step` when there is none.

    Linear interpolation; a wheel's event that was not armed and went the wrong way at once asks for a tenth.
    """
    best = step
    for k in range(before.size):
        if after[k] < -EVENT_TOLERANCE:
            if before[k] > EVENT_TOLERANCE:
                best = min(best, step * before[k] / (before[k] - after[k]))
            elif before[k] > -EVENT_TOLERANCE and k < FLOOR_EVENT:
                best = min(best, 0.1 * step)
    return best


@inner_kernel
def reached(before, after, k):
    """True when event `k` has come about at the end of a step with values `before` and `after`.

    A wheel's value that was not armed comes about when it is clearly beyond zero.
    """
    if k < FLOOR_EVENT and after[k] < -EVENT_TOLERANCE:
        return True
    return before[k] > EVENT_TOLERANCE and after[k] <= EVENT_TOLERANCE


@inner_kernel
def wheel_holds(model, state, wheel):
    """Whether the brake holds a wheel at rest from now on.

    Forces depend on places and speeds, not on accelerations: what one wheel does does not change it for another.
    """
    time, phase = state.clock[TIME], state.counts[PHASE]
    torque = brake_torque(model.brake, time, phase)
    rate = (brake_torque(model.brake, time + TORQUE_RATE_OVER, phase) - torque) / TORQUE_RATE_OVER
    return brake_holds(model, state.start, wheel, torque, rate, EVENT_TOLERANCE)


@inner_kernel
def switch_at_start(model, state, before, after, step):
    """Switch wheels whose event is now: it lies no further than the shortest step from the start of the one in hand."""
    switched = False
    for wheel in range(WHEELS):
        k = BRAKE_EVENT + wheel
        if after[k] < -EVENT_TOLERANCE and step * before[k] <= 2.0 * SHORTEST_STEP * (before[k] - after[k]):
            holds = wheel_holds(model, state, wheel)
            if holds != state.locked[wheel]:
                switched = True
                state.locked[wheel] = holds
                state.start.v[WHEEL_SPIN + wheel] = 0.0
    return switched
