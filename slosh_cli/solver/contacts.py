"""Newton on what is left of a stage once rail and wagon are condensed: four contacts and the track's coordinate.

The wagon's bodies answer linearly to four wheel loads, a force along the track and a moment on either bogie; their
answers to unit inputs are in `scratch.response` (7, 11), the accelerations without them in `scratch.free_bodies`.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel, part_kernel
from slosh_cli.solver.dense import factor_dense, solve_dense
from slosh_cli.solver.state import BOGIE_INPUT, INPUTS, NEWTON, PUSH_INPUT, UNKNOWNS
from slosh_cli.track.contact import creep_force, normal_force
from slosh_cli.track.vectors import fill
from slosh_cli.wagon.coordinates import BODIES, COORDINATES, WHEEL_HEAVE, WHEEL_SPIN, WHEELS

MOST_NEWTON = 12
NEWTON_SHARE = 1e-2
"""What a Newton update leaves open may be this part of the allowed step error."""
LOAD_SHARE = 1e-6
"""Newton solves wheel loads to this part of the static load."""


@inner_kernel
def running_resistance(wagon, speed):
    """Running resistance (N) on half the wagon and its derivative (N s/m); model section 8."""
    force = wagon.resistance[0] + speed * (wagon.resistance[1] + speed * wagon.resistance[2])
    return force, wagon.resistance[1] + 2.0 * speed * wagon.resistance[2]


@inner_kernel
def _linearise(model, scratch, locked, step):
    """Factor the equations of `UNKNOWNS` at the forces' present slopes, into `scratch.coupled`.

    A creep force changes by `load_gain dN + speed_gain da`, its spin's own change eliminated (model section 7); it
    pushes back on the track's coordinate and, where the wheel is locked, turns the bogie.
    """
    wagon, response, coupled = model.wagon, scratch.response, scratch.coupled
    radius, square = wagon.wheel_radius, step * step
    for j in range(WHEELS):
        inertia = wagon.mass[WHEEL_SPIN + j, WHEEL_SPIN + j]
        slip, along = scratch.creep_by_slip[j], scratch.creep_by_slip[j] + scratch.creep_by_speed[j]
        give = 1.0 if locked[j] else 1.0 / (1.0 + step * radius * radius * slip / inertia)
        scratch.load_gain[j] = give * scratch.creep_by_normal[j]
        scratch.speed_gain[j] = give * step * along
        scratch.spin_gain[j] = 0.0 if locked[j] else -give * step * radius * slip / inertia
    resistance = step * scratch.resistance_slope[0]
    for i in range(UNKNOWNS):
        row = WHEEL_HEAVE + i if i < WHEELS else 0
        by_speed = -resistance * response[PUSH_INPUT, row]
        for j in range(WHEELS):
            by_creep = _creep_input(scratch, locked, radius, j, row)
            by_speed += by_creep * scratch.speed_gain[j]
            coupled[i, j] = response[j, row] + by_creep * scratch.load_gain[j]
        coupled[i, WHEELS] = by_speed
    for i in range(WHEELS):
        stiff = square * scratch.normal_slope[i]
        for j in range(WHEELS):
            coupled[i, j] = stiff * (coupled[i, j] + scratch.contact_flexibility[i, j])
        coupled[i, WHEELS] *= stiff
        coupled[i, i] += 1.0
        coupled[WHEELS, i] *= -1.0
    coupled[WHEELS, WHEELS] = 1.0 - coupled[WHEELS, WHEELS]
    factor_dense(coupled, scratch.pivots)


@inner_kernel
def _creep_input(scratch, locked, radius, wheel, row):
    """Acceleration of body `row` per newton of creep force at `wheel`."""
    value = -scratch.response[PUSH_INPUT, row]
    if locked[wheel]:
        value += radius * scratch.response[BOGIE_INPUT + wheel // 2, row]
    return value


@inner_kernel
def _solve_changes(model, scratch, locked, step, along_gap):
    """Changes of wheel loads, acceleration along the track and creep forces that close the gaps.

    `scratch.load_gap` (4,) N, `along_gap` m/s^2 and `scratch.spin_gap` (4,) N m are what is missing in the contacts'
    laws, along the track and in the spins. Into `scratch.load_change`, `.spin_change`, `.creep_change`; returns the
    acceleration's change.
    """
    wagon, right = model.wagon, scratch.coupled_right
    load_gap, spin_gap = scratch.load_gap, scratch.spin_gap
    radius, square = wagon.wheel_radius, step * step
    for i in range(UNKNOWNS):
        row = WHEEL_HEAVE + i if i < WHEELS else 0
        by_spin = 0.0
        for j in range(WHEELS):
            by_spin += _creep_input(scratch, locked, radius, j, row) * scratch.spin_gain[j] * spin_gap[j]
        right[i] = load_gap[i] - square * scratch.normal_slope[i] * by_spin if i < WHEELS else along_gap + by_spin
    solve_dense(scratch.coupled, scratch.pivots, right)
    along = right[WHEELS]
    for i in range(WHEELS):
        scratch.load_change[i] = right[i]
        creep = scratch.load_gain[i] * right[i] + scratch.speed_gain[i] * along + scratch.spin_gain[i] * spin_gap[i]
        scratch.creep_change[i] = creep
        turning = (radius * creep + spin_gap[i]) / wagon.mass[WHEEL_SPIN + i, WHEEL_SPIN + i]
        scratch.spin_change[i] = 0.0 if locked[i] else turning
    return along


@inner_kernel
def wheel_forces(model, scratch, point, locked, torque):
    """Creep forces, transmitted brake torques and their derivatives at the point's state."""
    radius = model.wagon.wheel_radius
    speed = point.v[0]
    for i in range(WHEELS):
        slip = speed - radius * point.v[WHEEL_SPIN + i]
        force, by_normal, by_slip, by_speed = creep_force(model.contact, point.normal[i], slip, speed)
        point.creep[i] = force
        point.torque[i] = force * radius if locked[i] else torque
        scratch.creep_by_normal[i] = by_normal
        scratch.creep_by_slip[i] = by_slip
        scratch.creep_by_speed[i] = by_speed


@inner_kernel
def brake_holds(model, point, wheel, torque, torque_rate, tolerance):
    """Whether a brake that can bear `torque` (N m), changing by `torque_rate` (N m/s), holds a wheel that is at rest.

    It does below its torque, and at it (within `tolerance`, a part of it) while `f R` grows no faster: model section 8.
    """
    if torque <= 0.0:
        return False
    contact, under, speed = model.contact, model.rail.contact[wheel], point.v[0]
    heave = WHEEL_HEAVE + wheel
    normal, slope = normal_force(contact, point.rail[under] - point.q[heave])
    force, by_normal, by_slip, by_speed = creep_force(contact, normal, speed, speed)
    radius = model.wagon.wheel_radius
    over = force * radius - torque
    if abs(over) > tolerance * torque:
        return over < 0.0
    rate = by_normal * slope * (point.rail_rate[under] - point.v[heave]) + (by_slip + by_speed) * point.a[0]
    return rate * radius <= torque_rate


@inner_kernel
def _inputs(model, scratch, point):
    """The forces in the order of the wagon's inputs, into `scratch.inputs` (7,)."""
    inputs = scratch.inputs
    resistance, scratch.resistance_slope[0] = running_resistance(model.wagon, point.v[0])
    inputs[PUSH_INPUT] = -resistance
    inputs[BOGIE_INPUT] = inputs[BOGIE_INPUT + 1] = 0.0
    for i in range(WHEELS):
        inputs[i] = point.normal[i]
        inputs[PUSH_INPUT] -= point.creep[i]
        inputs[BOGIE_INPUT + i // 2] += point.torque[i]


@inner_kernel
def _body_acceleration(scratch, row):
    """Acceleration of body `row` under the inputs in hand."""
    total = scratch.free_bodies[row]
    for k in range(INPUTS):
        total += scratch.response[k, row] * scratch.inputs[k]
    return total


@inner_kernel
def _turn_spin(scratch, base, point, wheel, radius, step):
    """Add its change to a spin's acceleration, down to no slip where the slip would change its sign; True if so.

    The creep force bends away from its slope at zero slip on either side: from far out Newton would jump across it to
    and fro, from zero it does not.
    """
    spin = WHEEL_SPIN + wheel
    before = point.v[0] - radius * point.v[spin]
    point.a[spin] += scratch.spin_change[wheel]
    after = base.v[0] + step * point.a[0] - radius * (base.v[spin] + step * point.a[spin])
    if before * after < 0.0 and scratch.spin_change[wheel] != 0.0 and point.normal[wheel] > 0.0 and step > 0.0:
        point.a[spin] += after / (step * radius)
        return True
    return False


@inner_kernel
def _contact_gaps(model, scratch, base, point, locked, step, torque):
    """What the forces at the iterate leave open in the contacts and the spins; returns the same along the track.

    The contacts are taken where the last linear solution put the wheels, not where forces still off their laws would.
    """
    radius, square = model.wagon.wheel_radius, step * step
    point.v[0] = base.v[0] + step * point.a[0]
    for i in range(WHEEL_SPIN, COORDINATES):
        point.v[i] = base.v[i] + step * point.a[i]
    wheel_forces(model, scratch, point, locked, torque)
    _inputs(model, scratch, point)
    for i in range(WHEELS):
        taken, heave = point.a[WHEEL_HEAVE + i], _body_acceleration(scratch, WHEEL_HEAVE + i)
        approach = scratch.free[i] - base.q[WHEEL_HEAVE + i] - square * taken
        for j in range(WHEELS):
            approach -= square * scratch.contact_flexibility[i, j] * (point.normal[j] - scratch.load_before[j])
        force, slope = normal_force(model.contact, approach)
        scratch.normal_slope[i] = slope
        scratch.load_gap[i] = force - square * slope * (heave - taken) - point.normal[i]
        spin = model.wagon.mass[WHEEL_SPIN + i, WHEEL_SPIN + i] * point.a[WHEEL_SPIN + i]
        scratch.spin_gap[i] = 0.0 if locked[i] else point.creep[i] * radius - torque - spin
    return _body_acceleration(scratch, 0) - point.a[0]


@part_kernel
def solve_wheels(model, scratch, work, base, point, locked, step, torque):
    """Solve the contacts for the rail's free displacements `scratch.free` (4,) under `scratch.load_before`.

    Returns True when converged; leaves loads, and the wagon's accelerations, speeds and places at the solution.
    """
    control, radius = model.control, model.wagon.wheel_radius
    size_before = load_before = 0.0
    for i in range(WHEELS):
        if locked[i]:
            point.a[WHEEL_SPIN + i] = 0.0
    for iteration in range(MOST_NEWTON):
        work[NEWTON] += 1
        along_gap = _contact_gaps(model, scratch, base, point, locked, step, torque)
        _linearise(model, scratch, locked, step)
        change = _solve_changes(model, scratch, locked, step, along_gap)
        _change_inputs(scratch, locked, radius, step, change)
        for i in range(BODIES):
            point.a[i] = _body_acceleration(scratch, i)
        size, load_size, crossed = abs(change) / control.speed_scale[0], 0.0, False
        for i in range(WHEELS):
            point.normal[i] += scratch.load_change[i]
            load_size = max(load_size, abs(scratch.load_change[i]))
            size = max(size, abs(scratch.spin_change[i]) / control.speed_scale[WHEEL_SPIN + i])
            crossed = _turn_spin(scratch, base, point, i, radius, step) or crossed
        if not size + load_size < 1e12:
            return False
        # Newton's updates shrink ever faster: the next is at most this one times its ratio to the last
        rate = min(size / size_before, 1.0) if iteration > 0 and size_before > 0.0 else 1.0
        load_rate = min(load_size / load_before, 1.0) if iteration > 0 and load_before > 0.0 else 1.0
        small = rate * size * max(step, 1e-6) <= NEWTON_SHARE * control.local_tolerance
        if small and not crossed and load_rate * load_size <= LOAD_SHARE * control.load_scale:
            for i in range(COORDINATES):
                point.q[i] = base.q[i] + step * step * point.a[i]
                point.v[i] = base.v[i] + step * point.a[i]
            return True
        size_before, load_before = size, load_size
    return False


@inner_kernel
def _change_inputs(scratch, locked, radius, step, along):
    """Add the changes that `_solve_changes` found to the wagon's inputs; `along` is that of the acceleration."""
    inputs = scratch.inputs
    inputs[PUSH_INPUT] -= step * scratch.resistance_slope[0] * along
    for i in range(WHEELS):
        inputs[i] += scratch.load_change[i]
        inputs[PUSH_INPUT] -= scratch.creep_change[i]
        if locked[i]:
            inputs[BOGIE_INPUT + i // 2] += radius * scratch.creep_change[i]


@inner_kernel
def respond(model, scratch, locked, step, accelerations):
    """Add to the free `accelerations` (15,) what the contacts answer to `scratch.load_gap`, `scratch.spin_gap`."""
    along = _solve_changes(model, scratch, locked, step, accelerations[0])
    fill(scratch.inputs, 0.0)
    _change_inputs(scratch, locked, model.wagon.wheel_radius, step, along)
    for i in range(BODIES):
        for k in range(INPUTS):
            accelerations[i] += scratch.response[k, i] * scratch.inputs[k]
    for i in range(WHEELS):
        accelerations[WHEEL_SPIN + i] = scratch.spin_change[i]
