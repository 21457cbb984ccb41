"""Newton on what is left of a vehicle's stage once rail and bodies are condensed: its contacts and its way along the
track.

The bodies answer linearly to their inputs, as `vehicle.Scratch` has them: `scratch.response` are the answers to unit
inputs, `scratch.free_bodies` the accelerations without any. A pass solves one linear system of the wheel loads and the
acceleration along the track; the spins are eliminated.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.method import BASE
from slosh_cli.solver.dense import factor_dense, solve_dense
from slosh_cli.vectors import fill
from slosh_cli.wagon.locking import wheel_forces
from slosh_cli.wagon.model import FIRST_BOGIE

_NEWTON_SHARE = 1e-2
"""What a Newton update leaves open may be this part of the allowed step error."""
_LOAD_SHARE = 1e-6
"""Newton solves wheel loads to this part of the static load."""
OPEN, SOLVED, LOST = range(3)
"""What an update of `take_update` leaves of a vehicle's equations."""


@inner_kernel
def _frame_input(wagon, wheel):
    """Place among the inputs of the moment on the bogie that carries the brake of `wheel`."""
    return wagon.wheels + 1 + (wagon.frame[wheel] - FIRST_BOGIE) // 2


@inner_kernel
def _read_inputs(vehicle, point):
    """The forces at the iterate as inputs of the bodies."""
    wagon, scratch = vehicle.wagon, vehicle.scratch
    inputs, normal, creep, torque, along = scratch.inputs, point.normal, point.creep, point.torque, wagon.wheels
    resistance, slope = vehicle.line.resisting_force(point.v[0])
    scratch.resistance_slope = slope
    fill(inputs, 0.0)
    inputs[along] = -resistance
    inputs[inputs.size - 1] = vehicle.coupling_force
    for i in range(wagon.wheels):
        inputs[i] = normal[i]
        inputs[along] -= creep[i]
        inputs[_frame_input(wagon, i)] += torque[i]


@inner_kernel
def _body_acceleration(scratch, row):
    """Acceleration of body `row` under the inputs in hand."""
    response, inputs = scratch.response, scratch.inputs
    total = scratch.free_bodies[row]
    for k in range(inputs.size):
        total += response[k, row] * inputs[k]
    return total


@inner_kernel
def _read_gains(vehicle, step):
    """How creep forces and transmitted torques change with wheel load, acceleration along the track and spin gap.

    A creep force changes by `load_gain dN + speed_gain da + spin_gain gap`, its spin's own change eliminated (theory
    section 7); with it the moment on the bogie, by `turn_gain` times that and `turn_by_gap` times the gap.
    """
    wagon, scratch, locked = vehicle.wagon, vehicle.scratch, vehicle.locked
    mass, radius, first = wagon.mass, wagon.wheel_radius, wagon.first_spin
    by_slip, by_speed, by_normal = scratch.creep_by_slip, scratch.creep_by_speed, scratch.creep_by_normal
    for j in range(wagon.wheels):
        torque = step * scratch.torque_slope[j]
        inertia = mass[first + j, first + j] + torque
        slip, along = by_slip[j], by_slip[j] + by_speed[j]
        if locked[j]:
            give, turning, scratch.turn_gain[j], scratch.turn_by_gap[j] = 1.0, 0.0, radius, 0.0
        else:
            give = 1.0 / (1.0 + step * radius * radius * slip / inertia)
            turning = -give * step * radius * slip / inertia
            scratch.turn_gain[j], scratch.turn_by_gap[j] = torque * radius / inertia, torque / inertia
        scratch.load_gain[j] = give * by_normal[j]
        scratch.speed_gain[j] = give * step * along
        scratch.spin_gain[j] = turning


@inner_kernel
def _linearise(vehicle, step):
    """Factor the equations of wheel loads and acceleration at the forces' present slopes, into `scratch.coupled`."""
    _read_gains(vehicle, step)
    wagon, scratch = vehicle.wagon, vehicle.scratch
    response, coupled, between = scratch.response, scratch.coupled, vehicle.rail_work.between
    load_gain, speed_gain, normal_slope = scratch.load_gain, scratch.speed_gain, scratch.normal_slope
    wheels, square = wagon.wheels, step * step
    resistance = step * scratch.resistance_slope
    for i in range(wheels + 1):
        row = wagon.first_wheel + i if i < wheels else 0
        by_speed = -resistance * response[wheels, row]
        for j in range(wheels):
            by_creep = _creep_input(vehicle, j, row)
            by_speed += by_creep * speed_gain[j]
            coupled[i, j] = response[j, row] + by_creep * load_gain[j]
        coupled[i, wheels] = by_speed
    for i in range(wheels):
        stiff = square * normal_slope[i]
        for j in range(wheels):
            coupled[i, j] = stiff * (coupled[i, j] + between[i, j])
        coupled[i, wheels] *= stiff
        coupled[i, i] += 1.0
        coupled[wheels, i] *= -1.0
    coupled[wheels, wheels] = 1.0 - coupled[wheels, wheels]
    factor_dense(coupled, scratch.pivots)


@inner_kernel
def _creep_input(vehicle, wheel, row):
    """Acceleration of body `row` per newton of creep force at `wheel`."""
    wagon, scratch = vehicle.wagon, vehicle.scratch
    response, turn = scratch.response, scratch.turn_gain[wheel]
    value = -response[wagon.wheels, row]
    if turn != 0.0:
        value += turn * response[_frame_input(wagon, wheel), row]
    return value


@inner_kernel
def _solve_changes(vehicle, step, along_gap):
    """Changes of wheel loads, acceleration along the track and creep forces that close the gaps.

    `scratch.load_gap` (wheels,) N, `along_gap` m/s^2 and `scratch.spin_gap` (wheels,) N m are what is missing in the
    contacts' laws, along the track and in the spins. Into `scratch.load_change`, `.spin_change`, `.creep_change`;
    returns the acceleration's change. The moments on the bogies change by `turn_gain` and `turn_by_gap`.
    """
    wagon, scratch, locked = vehicle.wagon, vehicle.scratch, vehicle.locked
    right, load_gap, spin_gap = scratch.coupled_right, scratch.load_gap, scratch.spin_gap
    response, spin_gain, normal_slope = scratch.response, scratch.spin_gain, scratch.normal_slope
    radius, wheels, square = wagon.wheel_radius, wagon.wheels, step * step
    for i in range(wheels + 1):
        row = wagon.first_wheel + i if i < wheels else 0
        by_spin = 0.0
        for j in range(wheels):
            by_spin += _creep_input(vehicle, j, row) * spin_gain[j] * spin_gap[j]
            if scratch.turn_by_gap[j] != 0.0:
                by_spin += scratch.turn_by_gap[j] * spin_gap[j] * response[_frame_input(wagon, j), row]
        right[i] = load_gap[i] - square * normal_slope[i] * by_spin if i < wheels else along_gap + by_spin
    solve_dense(scratch.coupled, scratch.pivots, right)
    along = right[wheels]
    for i in range(wheels):
        scratch.load_change[i] = right[i]
        creep = scratch.load_gain[i] * right[i] + scratch.speed_gain[i] * along + spin_gain[i] * spin_gap[i]
        scratch.creep_change[i] = creep
        inertia = wagon.mass[wagon.first_spin + i, wagon.first_spin + i] + step * scratch.torque_slope[i]
        scratch.spin_change[i] = 0.0 if locked[i] else (radius * creep + spin_gap[i]) / inertia
    return along


@inner_kernel
def _turn_spin(vehicle, base, point, wheel, step):
    """Add its change to a spin's acceleration, down to no slip where the slip would change its sign; True if so.

    The creep force bends away from its slope at zero slip on either side: from far out Newton would jump across it to
    and fro, from zero it does not.
    """
    wagon, change, radius = vehicle.wagon, vehicle.scratch.spin_change[wheel], vehicle.wagon.wheel_radius
    spin = wagon.first_spin + wheel
    before = point.v[0] - radius * point.v[spin]
    point.a[spin] += change
    after = base.v[0] + step * point.a[0] - radius * (base.v[spin] + step * point.a[spin])
    if before * after < 0.0 and change != 0.0 and point.normal[wheel] > 0.0 and step > 0.0:
        point.a[spin] += after / (step * radius)
        return True
    return False


@inner_kernel
def _contact_gaps(vehicle, base, point, step, time):
    """What the forces at the iterate leave open in the contacts, the spins and along the track.

    The contacts are taken where the last linear solution put the wheels, not where forces still off their laws would.
    """
    wagon, contact, scratch, locked = vehicle.wagon, vehicle.contact, vehicle.scratch, vehicle.locked
    v, a, normal, between = point.v, point.a, point.normal, vehicle.rail_work.between
    base_q, base_v, free, before = base.q, base.v, scratch.free, scratch.load_before
    radius, square, first_spin = wagon.wheel_radius, step * step, wagon.first_spin
    v[0] = base_v[0] + step * a[0]
    for i in range(first_spin, wagon.coordinates):
        v[i] = base_v[i] + step * a[i]
    wheel_forces(vehicle, point, time)
    _read_inputs(vehicle, point)
    for i in range(wagon.wheels):
        place = wagon.first_wheel + i
        taken, heave = a[place], _body_acceleration(scratch, place)
        ahead, turned = base_q[0] + square * a[0], base_q[first_spin + i] + square * a[first_spin + i]
        approach = contact.approach(i, free[i], base_q[place], ahead, turned) - square * taken
        for j in range(wagon.wheels):
            approach -= square * between[i, j] * (normal[j] - before[j])
        force, slope = contact.normal_force(approach)
        scratch.normal_slope[i] = slope
        scratch.load_gap[i] = force - square * slope * (heave - taken) - normal[i]
        spin = wagon.mass[first_spin + i, first_spin + i] * a[first_spin + i]
        scratch.spin_gap[i] = 0.0 if locked[i] else point.creep[i] * radius - point.torque[i] - spin
    scratch.along_gap = _body_acceleration(scratch, 0) - a[0]


@inner_kernel
def find_update(vehicle, point, step, time, first):
    """Newton's update of the stage's `point`, which is at `time` (s): it changes the acceleration along the track by
    the value returned, the rest by what `_solve_changes` leaves. The `first` one lets locked wheels stand."""
    wagon = vehicle.wagon
    for i in range(wagon.wheels):
        if first and vehicle.locked[i]:
            point.a[wagon.first_spin + i] = 0.0
    vehicle.account.newton += 1
    _contact_gaps(vehicle, vehicle.points[BASE], point, step, time)
    _linearise(vehicle, step)
    return _solve_changes(vehicle, step, vehicle.scratch.along_gap)


@inner_kernel
def take_update(vehicle, point, step, change, first, tolerance):
    """Take the update that `find_update` found: whether the equations are then solved, open or lost.

    `tolerance` is the allowed local error; the `first` update tells nothing of how fast the next ones shrink. Loads,
    and the bodies' accelerations, speeds and places are at the solution where it is reached.
    """
    wagon, scratch, scales, base = vehicle.wagon, vehicle.scratch, vehicle.scales, vehicle.points[BASE]
    _change_inputs(vehicle, step, change)
    for i in range(wagon.first_spin):
        point.a[i] = _body_acceleration(scratch, i)
    size, load_size, crossed = abs(change) / scales.speed[0], 0.0, False
    for i in range(wagon.wheels):
        point.normal[i] += scratch.load_change[i]
        load_size = max(load_size, abs(scratch.load_change[i]))
        size = max(size, abs(scratch.spin_change[i]) / scales.speed[wagon.first_spin + i])
        crossed = _turn_spin(vehicle, base, point, i, step) or crossed
    if not size + load_size < 1e12:
        return LOST
    # Newton's updates shrink ever faster: the next is at most this one times its ratio to the last
    size_before, load_before = scratch.size_before, scratch.load_size_before
    rate = min(size / size_before, 1.0) if not first and size_before > 0.0 else 1.0
    load_rate = min(load_size / load_before, 1.0) if not first and load_before > 0.0 else 1.0
    scratch.size_before, scratch.load_size_before = size, load_size
    small = rate * size * max(step, 1e-6) <= _NEWTON_SHARE * tolerance
    if not small or crossed or load_rate * load_size > _LOAD_SHARE * scales.load:
        return OPEN
    q, v, a, base_q, base_v = point.q, point.v, point.a, base.q, base.v
    for i in range(q.size):
        q[i] = base_q[i] + step * step * a[i]
        v[i] = base_v[i] + step * a[i]
    return SOLVED


@inner_kernel
def _change_inputs(vehicle, step, along):
    """Add the changes that `_solve_changes` found to the inputs; `along` is that of the acceleration."""
    wagon, scratch = vehicle.wagon, vehicle.scratch
    inputs, push = scratch.inputs, wagon.wheels
    inputs[push] -= step * scratch.resistance_slope * along
    for i in range(wagon.wheels):
        inputs[i] += scratch.load_change[i]
        inputs[push] -= scratch.creep_change[i]
        turn = scratch.turn_gain[i] * scratch.creep_change[i] + scratch.turn_by_gap[i] * scratch.spin_gap[i]
        if turn != 0.0:
            inputs[_frame_input(wagon, i)] += turn


@inner_kernel
def respond(vehicle, step, accelerations):
    """Add to the bodies' free `accelerations` (coordinates,) what the contacts answer to `scratch.load_gap` and
    `scratch.spin_gap`; those of the spins follow."""
    wagon, scratch = vehicle.wagon, vehicle.scratch
    response, inputs = scratch.response, scratch.inputs
    along = _solve_changes(vehicle, step, accelerations[0])
    fill(inputs, 0.0)
    _change_inputs(vehicle, step, along)
    for i in range(wagon.first_spin):
        for k in range(inputs.size):
            accelerations[i] += response[k, i] * inputs[k]
    for i in range(wagon.wheels):
        accelerations[wagon.first_spin + i] = scratch.spin_change[i]


@inner_kernel
def compliance(vehicle, step, accelerations):
    """Accelerations (coordinates,) per newton of coupling force at a stage of implicit `step` (s), its contacts closed.

    The stage's accelerations are those without a coupling force and this times the force, as long as the contacts keep
    their slopes: a train's couplings then see a vehicle as one number.
    """
    wagon, scratch = vehicle.wagon, vehicle.scratch
    unit = scratch.response[scratch.response.shape[0] - 1]
    fill(accelerations, 0.0)
    for i in range(wagon.first_spin):
        accelerations[i] = unit[i]
    for i in range(wagon.wheels):
        scratch.load_gap[i] = -step * step * scratch.normal_slope[i] * unit[wagon.first_wheel + i]
        scratch.spin_gap[i] = 0.0
    respond(vehicle, step, accelerations)
