"""One implicit stage: rail condensed on the four contacts, Newton on wagon and contacts.

Every stage of the method has the form `q = q_p + d^2 a`, `v = v_p + d a` with the accelerations a unknown and d the
implicit step; d = 0 gives the accelerations consistent with a known state.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.solver.dense import factor_dense, solve_dense
from slosh_cli.tank.modal import liquid_follow, liquid_reaction
from slosh_cli.track.banded import solve_banded_one
from slosh_cli.track.contact import creep_force, normal_force
from slosh_cli.track.moving import prepare_rail, rail_residual
from slosh_cli.track.vectors import copy, fill
from slosh_cli.wagon.coordinates import BOGIE_PITCH, CAR_PITCH, COORDINATES, WHEEL_HEAVE, WHEEL_SPIN, WHEELS

MOST_PASSES = 8
MOST_NEWTON = 12
NEWTON_SHARE = 1e-2
"""What a Newton update leaves open may be this part of the allowed step error."""
LOAD_SHARE = 1e-6
"""Newton solves wheel loads to this part of the static load."""
MISMATCH, MISMATCH_PER_METRE = 1e-4, 10.0
"""A pass over the rail leaves open at most this part of what it changed, and this much more for every metre that the
stage's speed, times the implicit step, lies off the one the factors were made for (seen: 3e-5 at 1 ms)."""

# places in the work counters
NEWTON, FACTORISATIONS, RIGHT_HAND_SIDES, EVENTS = 0, 1, 2, 3


@inner_kernel
def prepare_stage(model, scratch, work, step, speed, acceleration):
    """Matrices shared by all stages of implicit step `step` (s): rail factors and the wagon's linear part."""
    prepare_rail(model.rail, step, speed, acceleration, scratch.rail_factors, scratch.flexibility)
    scratch.factored_speed[0] = speed
    work[FACTORISATIONS] += 1
    work[RIGHT_HAND_SIDES] += 4
    wagon, linear = model.wagon, scratch.linear
    for i in range(COORDINATES):
        for j in range(COORDINATES):
            linear[i, j] = wagon.mass[i, j] + step * (wagon.damping[i, j] + step * wagon.stiffness[i, j])
    uu, up, pp, _, _ = liquid_reaction(model.liquid, scratch.slosh_zero, scratch.slosh_zero, step, 0.0)
    for i in range(COORDINATES):
        linear[i, CAR_PITCH] += up * wagon.tank_row[i]
        linear[CAR_PITCH, i] += up * wagon.tank_row[i]
        for j in range(COORDINATES):
            linear[i, j] += uu * wagon.tank_row[i] * wagon.tank_row[j]
    linear[CAR_PITCH, CAR_PITCH] += pp


@inner_kernel
def _linear_right(model, scratch, base, step, push, turn):
    """Forces on the wagon that do not depend on the stage's accelerations, into `scratch.right`."""
    wagon, right = model.wagon, scratch.right
    for i in range(COORDINATES):
        total = wagon.weight[i]
        for j in range(COORDINATES):
            total -= wagon.damping[i, j] * base.v[j] + wagon.stiffness[i, j] * base.q[j]
        right[i] = total
    _, _, _, force, moment = liquid_reaction(model.liquid, base.slosh, base.slosh_rate, step, base.q[CAR_PITCH])
    for i in range(COORDINATES):
        right[i] += (force + push) * wagon.tank_row[i]
    right[CAR_PITCH] += moment + turn


@inner_kernel
def condense_contacts(scratch, step):
    """Invert `1 + step^2 diag(k_N) G` for the four contacts; `scratch.contact_inverse` (4, 4)."""
    small, inverse = scratch.small, scratch.contact_inverse
    for i in range(WHEELS):
        for j in range(WHEELS):
            small[i, j] = step * step * scratch.normal_slope[i] * scratch.contact_flexibility[i, j]
        small[i, i] += 1.0
    factor_dense(small, scratch.small_pivots)
    for j in range(WHEELS):
        fill(scratch.small_right, 0.0)
        scratch.small_right[j] = 1.0
        solve_dense(small, scratch.small_pivots, scratch.small_right)
        for i in range(WHEELS):
            inverse[i, j] = scratch.small_right[i]


@inner_kernel
def contact_jacobian(model, scratch, locked, step):
    """Wagon matrix with the contacts' linearisation added, factored into `scratch.jacobian`.

    The change of a wheel load is `dN_i = p_i - step^2 sum_j inverse_ij k_j da_wj`.
    """
    jacobian, inverse = scratch.jacobian, scratch.contact_inverse
    radius = model.wagon.wheel_radius
    for i in range(COORDINATES):
        copy(scratch.linear[i], jacobian[i])
    for i in range(WHEELS):
        spin, bogie = WHEEL_SPIN + i, BOGIE_PITCH + 2 * (i // 2)
        for j in range(WHEELS):
            load = -step * step * inverse[i, j] * scratch.normal_slope[j]
            jacobian[WHEEL_HEAVE + i, WHEEL_HEAVE + j] -= load
            creep = scratch.creep_by_normal[i] * load
            jacobian[0, WHEEL_HEAVE + j] += creep
            if locked[i]:
                jacobian[bogie, WHEEL_HEAVE + j] -= radius * creep
            else:
                jacobian[spin, WHEEL_HEAVE + j] -= radius * creep
        by_position = step * (scratch.creep_by_slip[i] + scratch.creep_by_speed[i])
        by_spin = -step * radius * scratch.creep_by_slip[i]
        jacobian[0, 0] += by_position
        if locked[i]:
            jacobian[bogie, 0] -= radius * by_position
        else:
            jacobian[0, spin] += by_spin
            jacobian[spin, 0] -= radius * by_position
            jacobian[spin, spin] -= radius * by_spin
    jacobian[0, 0] += step * scratch.resistance_slope[0]
    factor_dense(jacobian, scratch.pivots)


@inner_kernel
def running_resistance(wagon, speed):
    """Running resistance (N) on half the wagon and its derivative (N s/m); model section 8."""
    force = wagon.resistance[0] + speed * (wagon.resistance[1] + speed * wagon.resistance[2])
    return force, wagon.resistance[1] + 2.0 * speed * wagon.resistance[2]


@inner_kernel
def _wheel_forces(model, scratch, point, locked, torque):
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
def _wagon_residual(model, scratch, point, locked):
    """Forces missing in the wagon's equations, into `scratch.update` (the Newton right-hand side)."""
    wagon, update = model.wagon, scratch.update
    resistance, scratch.resistance_slope[0] = running_resistance(wagon, point.v[0])
    for i in range(COORDINATES):
        total = scratch.right[i]
        for j in range(COORDINATES):
            total -= scratch.linear[i, j] * point.a[j]
        update[i] = total
    update[0] -= resistance
    for i in range(WHEELS):
        update[WHEEL_HEAVE + i] += point.normal[i]
        update[0] -= point.creep[i]
        update[BOGIE_PITCH + 2 * (i // 2)] += point.torque[i]
        if not locked[i]:
            update[WHEEL_SPIN + i] += point.creep[i] * wagon.wheel_radius - point.torque[i]


@inner_kernel
def add_load_change(model, scratch, locked, update, load):
    """Add to the wagon's right-hand side what known wheel-load changes `load` (4,) contribute."""
    radius = model.wagon.wheel_radius
    for i in range(WHEELS):
        creep = scratch.creep_by_normal[i] * load[i]
        update[WHEEL_HEAVE + i] += load[i]
        update[0] -= creep
        if locked[i]:
            update[BOGIE_PITCH + 2 * (i // 2)] += radius * creep
        else:
            update[WHEEL_SPIN + i] += radius * creep


@inner_kernel
def _newton(model, scratch, work, base, point, locked, step, torque, free):
    """Solve wagon and contacts for the rail's free displacements `free` (4,) under `scratch.load_before`.

    Returns True when converged; leaves `point.a`, `q`, `v` and forces at the solution.
    """
    control = model.control
    square = step * step
    size_before = load_before = 0.0
    for iteration in range(MOST_NEWTON):
        work[NEWTON] += 1
        for i in range(COORDINATES):
            point.q[i] = base.q[i] + square * point.a[i]
            point.v[i] = base.v[i] + step * point.a[i]
        for i in range(WHEELS):
            approach = free[i] - point.q[WHEEL_HEAVE + i]
            for j in range(WHEELS):
                change = point.normal[j] - scratch.load_before[j]
                approach -= square * scratch.contact_flexibility[i, j] * change
            force, scratch.normal_slope[i] = normal_force(model.contact, approach)
            scratch.load_gap[i] = force - point.normal[i]
        condense_contacts(scratch, step)
        for i in range(WHEELS):
            scratch.load_change[i] = 0.0
            for j in range(WHEELS):
                scratch.load_change[i] += scratch.contact_inverse[i, j] * scratch.load_gap[j]
        _wheel_forces(model, scratch, point, locked, torque)
        _wagon_residual(model, scratch, point, locked)
        add_load_change(model, scratch, locked, scratch.update, scratch.load_change)
        contact_jacobian(model, scratch, locked, step)
        solve_dense(scratch.jacobian, scratch.pivots, scratch.update)
        size = 0.0
        for i in range(COORDINATES):
            point.a[i] += scratch.update[i]
            size = max(size, abs(scratch.update[i]) / control.speed_scale[i])
        load_size = 0.0
        for i in range(WHEELS):
            change = scratch.load_change[i]
            for j in range(WHEELS):
                slope = scratch.normal_slope[j]
                change -= square * scratch.contact_inverse[i, j] * slope * scratch.update[WHEEL_HEAVE + j]
            point.normal[i] += change
            load_size = max(load_size, abs(change))
        if not size < 1e12:
            return False
        # Newton's updates shrink ever faster: the next is at most this one times its ratio to the last
        rate = min(size / size_before, 1.0) if iteration > 0 else 1.0
        load_rate = min(load_size / load_before, 1.0) if iteration > 0 and load_before > 0.0 else 1.0
        small = rate * size * max(step, 1e-6) <= NEWTON_SHARE * control.local_tolerance
        if small and load_rate * load_size <= LOAD_SHARE * control.load_scale:
            return True
        size_before, load_before = size, load_size
    return False


@inner_kernel
def solve_stage(model, scratch, work, base, point, locked, step, torque, push, turn):
    """Solve one stage; `point` enters with a guess of its accelerations and wheel loads.

    `base` holds the stage's coordinates and velocities without their own accelerations; `push` (N) and `turn` (N m)
    are force and moment on the tank from a liquid that is carried along beside the stages. Returns True when
    converged: rail, wagon, contacts and liquid then satisfy their equations together.
    """
    rail, contact, control = model.rail, model.rail.contact, model.control
    square = step * step
    _linear_right(model, scratch, base, step, push, turn)
    for i in range(WHEELS):
        for j in range(WHEELS):
            scratch.contact_flexibility[i, j] = scratch.flexibility[contact[i], j]
    allowed = min(LOAD_SHARE, control.local_tolerance) * control.load_scale
    for _ in range(MOST_PASSES):
        speed = base.v[0] + step * point.a[0]
        for i in range(point.rail.size):
            point.rail[i] = base.rail[i] + square * point.rail_second[i]
            point.rail_rate[i] = base.rail_rate[i] + step * point.rail_second[i]
        rail_residual(
            rail,
            point.rail,
            point.rail_rate,
            point.rail_second,
            speed,
            point.a[0],
            scratch.combination,
            scratch.missing,
        )
        for i in range(WHEELS):
            scratch.missing[contact[i]] += point.normal[i]
            scratch.load_before[i] = point.normal[i]
        solve_banded_one(scratch.rail_factors, scratch.missing)
        work[RIGHT_HAND_SIDES] += 1
        moved = 0.0
        for i in range(WHEELS):
            change = square * scratch.missing[contact[i]]
            scratch.free[i] = point.rail[contact[i]] - change
            moved = max(moved, abs(change))
        if not _newton(model, scratch, work, base, point, locked, step, torque, scratch.free):
            return False
        for i in range(point.rail.size):
            second = point.rail_second[i] - scratch.missing[i]
            for j in range(WHEELS):
                second -= scratch.flexibility[i, j] * (point.normal[j] - scratch.load_before[j])
            point.rail_second[i] = second
        stiffest = 0.0
        load_size = 0.0
        for i in range(WHEELS):
            stiffest = max(stiffest, scratch.normal_slope[i])
            load_size = max(load_size, abs(point.normal[i] - scratch.load_before[i]))
        rate = MISMATCH + MISMATCH_PER_METRE * step * abs(point.v[0] - scratch.factored_speed[0])
        if rate * max(moved * stiffest, load_size) <= allowed:
            _finish(model, scratch, base, point, locked, step, torque)
            return True
    return False


@inner_kernel
def _finish(model, scratch, base, point, locked, step, torque):
    """Bring every part of the point to the solved accelerations."""
    square = step * step
    for i in range(point.rail.size):
        point.rail[i] = base.rail[i] + square * point.rail_second[i]
        point.rail_rate[i] = base.rail_rate[i] + step * point.rail_second[i]
    for i in range(COORDINATES):
        point.q[i] = base.q[i] + square * point.a[i]
        point.v[i] = base.v[i] + step * point.a[i]
    for i in range(WHEELS):
        point.normal[i] = max(point.normal[i], 0.0)
    pitch = base.q[CAR_PITCH]
    tank = 0.0
    for i in range(COORDINATES):
        tank += model.wagon.tank_row[i] * point.a[i]
    liquid_follow(model.liquid, base.slosh, base.slosh_rate, step, pitch, tank, point.a[CAR_PITCH], point.slosh_second)
    for n in range(point.slosh.size):
        point.slosh[n] = base.slosh[n] + square * point.slosh_second[n]
        point.slosh_rate[n] = base.slosh_rate[n] + step * point.slosh_second[n]
    _wheel_forces(model, scratch, point, locked, torque)
