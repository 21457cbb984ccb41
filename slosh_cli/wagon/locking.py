"""Wheels that lock and turn again: the set-valued brake torque (theory section 8).

A brake opposes its wheel's rotation with the torque that it can hold. At rest the torque is whatever holds the wheel,
up to that. Each wheel has a value that is positive until it locks or is released: the speed of its tread while it
turns, the part of the torque that is left while it is locked. A wheel just released has exactly zero speed and so
cannot lock again before it has turned.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel

SWITCH_TOLERANCE = 1e-6
"""A wheel's value is reached when it is this close to zero (m/s, or relative to the torque)."""
_RATE_OVER = 1e-6
"""The rate of a brake's torque is its change over this time, s."""


@inner_kernel
def wheel_forces(vehicle, point, time):
    """Creep forces, transmitted brake torques and their derivatives at the point, which is at `time` (s)."""
    wagon, contact, brake, locked, scratch = (
        vehicle.wagon,
        vehicle.contact,
        vehicle.brake,
        vehicle.locked,
        vehicle.scratch,
    )
    normal, creep, torque, v, radius = point.normal, point.creep, point.torque, point.v, wagon.wheel_radius
    first = wagon.first_spin
    speed = v[0]
    for i in range(wagon.wheels):
        spin = v[first + i]
        slip = speed - radius * spin
        force, by_normal, by_slip, by_speed = contact.creep_force(normal[i], slip, speed)
        creep[i] = force
        torque[i], scratch.torque_slope[i] = force * radius, 0.0
        if not locked[i]:
            way = vehicle.turning[i]
            held, scratch.torque_slope[i] = brake.torque(i, time, way * spin)
            torque[i] = way * held
        scratch.creep_by_normal[i] = by_normal
        scratch.creep_by_slip[i] = by_slip
        scratch.creep_by_speed[i] = by_speed


@inner_kernel
def wheel_values(vehicle, point, time, values):
    """Values of the wheels at `point`, which is at `time` (s), into `values` (wheels,); 1 where nothing can happen."""
    wagon, locked, spins = vehicle.wagon, vehicle.locked, point.v
    radius, first = wagon.wheel_radius, wagon.first_spin
    for i in range(wagon.wheels):
        spin = spins[first + i]
        rolling = vehicle.turning[i] * spin
        torque, _ = vehicle.brake.torque(i, time, 0.0 if locked[i] else rolling)
        values[i] = 1.0
        if locked[i]:
            values[i] = 1.0 - abs(point.creep[i]) * radius / torque if torque > 0.0 else -1.0
        elif torque > 0.0:
            values[i] = radius * rolling


@inner_kernel
def wheel_holds(vehicle, wheel, time):
    """Whether the brake holds a wheel that is at rest at the start of a step, at `time` (s).

    It does below its torque, and at it (within `SWITCH_TOLERANCE` of it) while `f R` grows no faster. Forces depend on
    places and speeds, not on accelerations: what one wheel does does not change it for another.
    """
    brake = vehicle.brake
    torque, _ = brake.torque(wheel, time, 0.0)
    if torque <= 0.0:
        return False
    later, _ = brake.torque(wheel, time + _RATE_OVER, 0.0)
    point, wagon, contact = vehicle.points[0], vehicle.wagon, vehicle.contact
    under, heave, speed = vehicle.rail.contact[wheel], wagon.first_wheel + wheel, point.v[0]
    q = point.q
    approach = contact.approach(wheel, point.rail[under], q[heave], q[0], q[wagon.first_spin + wheel])
    normal, slope = contact.normal_force(approach)
    force, by_normal, by_slip, by_speed = contact.creep_force(normal, speed, speed)
    way = 1.0 if force >= 0.0 else -1.0
    over = way * force * wagon.wheel_radius - torque
    if abs(over) > SWITCH_TOLERANCE * torque:
        return over < 0.0
    rising = contact.rising(wheel, q[0], speed, q[wagon.first_spin + wheel], 0.0)
    rate = by_normal * slope * (point.rail_rate[under] + rising - point.v[heave]) + (by_slip + by_speed) * point.a[0]
    return way * rate * wagon.wheel_radius <= (later - torque) / _RATE_OVER


@inner_kernel
def switch_reached(vehicle, time, before, after):
    """Lock or release the wheels whose value went from `before` to `after` (wheels,) beyond zero, at `time` (s).

    A wheel's value that was not armed, which it is once clearly positive, comes about when it is clearly beyond zero.
    Returns whether a wheel was switched.
    """
    wagon, spins = vehicle.wagon, vehicle.points[0].v
    switched = False
    for i in range(wagon.wheels):
        armed = before[i] > SWITCH_TOLERANCE and after[i] <= SWITCH_TOLERANCE
        if armed or after[i] < -SWITCH_TOLERANCE:
            switched = True
            spins[wagon.first_spin + i] = 0.0
            _hold_or_turn(vehicle, i, time)
    return switched


@inner_kernel
def switch_at_start(vehicle, time, before, after, step, shortest):
    """Switch wheels whose event is now: it lies no further than the `shortest` step from the start of `step` (s)."""
    wagon, spins, locked = vehicle.wagon, vehicle.points[0].v, vehicle.locked
    switched = False
    for i in range(wagon.wheels):
        if after[i] < -SWITCH_TOLERANCE and step * before[i] <= shortest * (before[i] - after[i]):
            holds = wheel_holds(vehicle, i, time)
            if holds != locked[i]:
                switched = True
                _hold_or_turn(vehicle, i, time)
                spins[wagon.first_spin + i] = 0.0
    return switched


@inner_kernel
def let_go(vehicle, time):
    """Release the locked wheels that the brake holds no longer after a break of its torque at `time` (s); the others
    are braked against the way that they turn."""
    wagon, spins = vehicle.wagon, vehicle.points[0].v
    for i in range(wagon.wheels):
        if vehicle.locked[i]:
            _hold_or_turn(vehicle, i, time)
        else:
            vehicle.turning[i] = -1.0 if spins[wagon.first_spin + i] < 0.0 else 1.0


@inner_kernel
def _hold_or_turn(vehicle, wheel, time):
    """Lock a wheel that is at rest at `time` (s) where the brake holds it; else the rail turns it the vehicle's way."""
    vehicle.locked[wheel] = wheel_holds(vehicle, wheel, time)
    vehicle.turning[wheel] = -1.0 if vehicle.points[0].v[0] < 0.0 else 1.0
