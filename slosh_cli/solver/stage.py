"""One implicit stage: rail and bodies condensed on the contacts, Newton on these, for all vehicles together.

Every stage of the method has the form `q = q_p + d^2 a`, `v = v_p + d a` with the accelerations a unknown and d the
implicit step; d = 0 gives the accelerations consistent with a known state. But for the contacts, the brakes and the
running resistance all is linear in a: rail and bodies are solved once a step for unit forces, and Newton's unknowns are
the wheel loads, the acceleration along the track and those of the wheels' spins.
"""

from __future__ import annotations

import math

from slosh_cli.compiled import inner_kernel, vector_kernel
from slosh_cli.method import BASE, move
from slosh_cli.solver.contacts import LOST, OPEN, SOLVED, find_update, take_update
from slosh_cli.solver.coupled import close_couplings
from slosh_cli.solver.dense import factor_symmetric, solve_symmetric
from slosh_cli.track.banded import solve_one
from slosh_cli.track.moving import prepare_rail, rail_residual
from slosh_cli.vectors import fill
from slosh_cli.wagon.locking import wheel_forces
from slosh_cli.wagon.model import CAR_PITCH, FIRST_BOGIE

_MOST_PASSES = 8
_MOST_UPDATES = 12
_COUPLING_SHARE = 1e-6
"""Newton solves coupling forces to this part of the first vehicle's static wheel load."""
RAIL_SHARE = 1e-5
"""A pass over the rail may leave open this part of the static load, or less at tighter tolerances."""


@inner_kernel
def prepare_stage(vehicle, step, speed, acceleration):
    """What all stages of implicit step `step` (s) share: rail factors, the bodies' linear part and their responses."""
    scratch, account = vehicle.scratch, vehicle.account
    prepare_rail(vehicle.rail, vehicle.rail_work, step, speed, acceleration)
    scratch.factored_speed, scratch.factored_acceleration = speed, acceleration
    account.factorisations += 1
    account.right_hand_sides += vehicle.wagon.wheels
    _prepare_bodies(vehicle, step)
    _prepare_responses(vehicle)


@inner_kernel
def _prepare_bodies(vehicle, step):
    """Factor `M + step C + step^2 K` of the bodies with what follows of the liquid."""
    wagon, linear = vehicle.wagon, vehicle.scratch.linear
    mass, damping, stiffness, tank_row, bodies = (
        wagon.mass,
        wagon.damping,
        wagon.stiffness,
        wagon.tank_row,
        wagon.first_spin,
    )
    uu, up, pp = vehicle.liquid.inertia(step)
    for i in range(bodies):
        for j in range(bodies):
            linear[i, j] = mass[i, j] + step * (damping[i, j] + step * stiffness[i, j])
            linear[i, j] += uu * tank_row[i] * tank_row[j]
    for i in range(bodies):
        linear[i, CAR_PITCH] += up * tank_row[i]
        linear[CAR_PITCH, i] += up * tank_row[i]
    linear[CAR_PITCH, CAR_PITCH] += pp
    factor_symmetric(linear)


@inner_kernel
def _prepare_responses(vehicle):
    """The bodies' answers to a unit of each input."""
    wagon, scratch = vehicle.wagon, vehicle.scratch
    response, wheels, last = scratch.response, wagon.wheels, scratch.response.shape[0] - 1
    for k in range(response.shape[0]):
        fill(response[k], 0.0)
    for i in range(wheels):
        response[i, wagon.first_wheel + i] = 1.0
    response[wheels, 0] = 1.0
    for bogie in range(wagon.bogies):
        response[wheels + 1 + bogie, FIRST_BOGIE + 1 + 2 * bogie] = 1.0
    for i in range(wagon.first_spin):
        response[last, i] = wagon.coupling_row[i]
    for k in range(response.shape[0]):
        solve_symmetric(scratch.linear, response[k])


@inner_kernel
def _free_accelerations(vehicle, base, point, step):
    """The bodies' accelerations under all that does not depend on the stage's own, into `scratch.free_bodies`.

    Gravity's pull along the track is that of the place where the guessed acceleration leads.
    """
    wagon, right, q, v = vehicle.wagon, vehicle.scratch.free_bodies, base.q, base.v
    mass, damping, stiffness, weight, tank_row = (
        wagon.mass,
        wagon.damping,
        wagon.stiffness,
        wagon.weight,
        wagon.tank_row,
    )
    vehicle.scratch.pull = pull = vehicle.line.pull_at(q[0] + step * step * point.a[0])
    for i in range(right.size):
        total = weight[i] + pull * mass[i, 0]
        for j in range(right.size):
            total -= damping[i, j] * v[j] + stiffness[i, j] * q[j]
        right[i] = total
    force, moment = vehicle.liquid.push(BASE, step, q[CAR_PITCH], pull)
    for i in range(right.size):
        right[i] += force * tank_row[i]
    right[CAR_PITCH] += moment
    solve_symmetric(vehicle.scratch.linear, right)


@inner_kernel
def solve_stage(train, stage, step, time):
    """Solve one stage of all vehicles, at `time` (s); each one's point enters with a guess of accelerations and loads.

    The base points hold the stage's coordinates and velocities without their own accelerations. Returns True when
    converged: rails, wagons, contacts and liquids then satisfy their equations together.
    """
    vehicles, tolerance = train.vehicles, train.control.local_tolerance
    for k in range(len(vehicles)):
        _free_accelerations(vehicles[k], vehicles[k].points[BASE], vehicles[k].points[stage], step)
    for _ in range(_MOST_PASSES):
        for k in range(len(vehicles)):
            _open_pass(vehicles[k], vehicles[k].points[stage], step)
        outcome, updates = OPEN, 0
        while outcome == OPEN and updates < _MOST_UPDATES:
            outcome = _update(train, stage, step, time, updates == 0)
            updates += 1
        if outcome != SOLVED:
            return False
        settled = True
        for k in range(len(vehicles)):
            allowed = min(RAIL_SHARE, tolerance) * vehicles[k].scales.load
            settled = _close_pass(vehicles[k], vehicles[k].points[stage], step) <= allowed and settled
        if settled:
            for k in range(len(vehicles)):
                _finish(vehicles[k], vehicles[k].points[stage], step, time)
            return True
    return False


@inner_kernel
def _update(train, stage, step, time, first):
    """One update of Newton's for all vehicles; whether they are then solved, open or lost."""
    vehicles, outcome = train.vehicles, SOLVED
    for k in range(len(vehicles)):
        vehicle, point = vehicles[k], vehicles[k].points[stage]
        change = find_update(vehicle, point, step, time, first)
        found = take_update(vehicle, point, step, change, first, train.control.local_tolerance)
        if found == LOST:
            return LOST
        if found == OPEN:
            outcome = OPEN
    if not close_couplings(train, stage, step, _COUPLING_SHARE * vehicles[0].scales.load):
        return OPEN
    return outcome


@inner_kernel
def _open_pass(vehicle, point, step):
    """Where the rail would be under the wheels, `scratch.free`, if the loads stayed as they are."""
    base, rail, scratch, work = vehicle.points[BASE], vehicle.rail, vehicle.scratch, vehicle.rail_work
    contact, missing, square = rail.contact, work.missing, step * step
    rail_residual(
        rail, base.rail, base.rail_rate, point.rail_second, step, base.v[0] + step * point.a[0], point.a[0], work.rows,
        missing,
    )  # fmt: skip
    for i in range(contact.size):
        missing[contact[i]] += point.normal[i]
        scratch.load_before[i] = point.normal[i]
    solve_one(work.factors, missing)
    vehicle.account.right_hand_sides += 1
    scratch.acceleration_before = point.a[0]
    scratch.moved = scratch.deepest = 0.0
    for i in range(contact.size):
        under = contact[i]
        change = square * missing[under]
        place = base.rail[under] + square * point.rail_second[under]
        scratch.free[i] = place - change
        scratch.moved, scratch.deepest = max(scratch.moved, abs(change)), max(scratch.deepest, abs(place))


@inner_kernel
def _close_pass(vehicle, point, step):
    """Correct the rail by what the pass found; returns a bound on the load (N) that it leaves open."""
    rail, scratch = vehicle.rail, vehicle.scratch
    before = scratch.acceleration_before
    _correct_rail(
        vehicle.rail_work.missing, point.rail_second, vehicle.rail_work.flexibility, point.normal, scratch.load_before
    )
    size = 0.0
    for i in range(vehicle.wagon.wheels):
        load_size = abs(point.normal[i] - scratch.load_before[i])
        size = max(size, scratch.moved * scratch.normal_slope[i], load_size)
    speed = vehicle.points[BASE].v[0] + step * before
    open_load = _stage_mismatch(rail, scratch, step, speed, before) * size
    return open_load + _motion_mismatch(rail, step, point.v[0], scratch.deepest, point.a[0] - before)


@inner_kernel
def _stage_mismatch(rail, scratch, step, speed, acceleration):
    """Bound on what a pass leaves open, over its change, because the factors were made for another V and A.

    For a wave of number p the difference is `2 m d dV p + ...`, the matrix `m + d^2 (k + T p^2 + EI p^4)` (theory
    section 6). With `s = m + d^2 (k - T^2/(4 EI))` the quotient is largest at `p^4 = s/(3 d^2 EI)`, that of the terms
    with p^2 at `p^4 = s/(d^2 EI)`.
    """
    faster = abs(speed - scratch.factored_speed)
    drift = step * (2.0 * rail.mass + step * rail.damping) * faster
    drift += step * step * rail.mass * abs(acceleration - scratch.factored_acceleration)
    slack = min(rail.shear_stiffness - rail.mass * speed * speed, 0.0)
    support = rail.mass + step * step * (rail.stiffness - 0.25 * slack * slack / rail.bending_stiffness)
    bending = step * step * rail.bending_stiffness
    if drift == 0.0 or bending == 0.0:
        return 0.0
    tension = step * step * 2.0 * rail.mass * speed * faster
    return 0.75 * drift * (support / (3.0 * bending)) ** 0.25 / support + 0.5 * tension / math.sqrt(support * bending)


@inner_kernel
def _motion_mismatch(rail, step, speed, deepest, change):
    """Bound on the load (N) a pass leaves open because the wagon's acceleration changed after the rail's residual.

    It acts on the rail as `m change y_r`, and through V as `2 m step change (V y_rr - y_rt)`, at most on the whole
    dip, `deepest` (m).
    """
    wave_number = (0.25 * rail.stiffness / rail.bending_stiffness) ** 0.25
    return 2.0 * rail.mass * abs(change) * deepest * (1.0 + 2.0 * step * abs(speed) * wave_number)


@vector_kernel
def _correct_rail(missing, second, flexibility, normal, before):
    """The rail's accelerations after a pass: what was missing, and the wheel loads' change, four wheels at a time."""
    nodes = second.size // 2
    for k in range(2):
        these, less = second[k * nodes : (k + 1) * nodes], missing[k * nodes : (k + 1) * nodes]
        for group in range(flexibility.shape[0]):
            unit_of, first = flexibility[group], 4 * group
            by_one, by_two = _load_change(normal, before, first), _load_change(normal, before, first + 1)
            by_three, by_four = _load_change(normal, before, first + 2), _load_change(normal, before, first + 3)
            if group > 0:
                for i in range(nodes):
                    unit = unit_of[i, k]
                    these[i] -= unit[0] * by_one + unit[1] * by_two + unit[2] * by_three + unit[3] * by_four
                continue
            for i in range(nodes):
                unit = unit_of[i, k]
                these[i] -= less[i] + unit[0] * by_one + unit[1] * by_two + unit[2] * by_three + unit[3] * by_four


@inner_kernel
def _load_change(normal, before, wheel):
    """Change of a wheel's load; zero where there is no such wheel."""
    return normal[wheel] - before[wheel] if wheel < normal.size else 0.0


@inner_kernel
def _finish(vehicle, point, step, time):
    """Bring every part of the point to the solved accelerations."""
    wagon, base = vehicle.wagon, vehicle.points[BASE]
    move(base.rail, base.rail_rate, point.rail_second, step, point.rail, point.rail_rate)
    for i in range(wagon.wheels):
        point.normal[i] = max(point.normal[i], 0.0)
    read_ride(vehicle, point)
    acceleration, turning = vehicle.ride.acceleration[point.stage], point.a[CAR_PITCH]
    vehicle.liquid.follow(point.stage, BASE, step, base.q[CAR_PITCH], acceleration, turning)
    wheel_forces(vehicle, point, time)


@inner_kernel
def read_ride(vehicle, point):
    """The tank's motion at the point, for the liquid; gravity's pull is that of the last stage that was solved."""
    ride, stage, tank_row, q, v, a = vehicle.ride, point.stage, vehicle.wagon.tank_row, point.q, point.v, point.a
    speed = acceleration = 0.0
    for i in range(vehicle.wagon.first_spin):
        speed += tank_row[i] * v[i]
        acceleration += tank_row[i] * a[i]
    ride.pull[stage] = vehicle.scratch.pull
    ride.speed[stage], ride.acceleration[stage] = speed, acceleration - ride.pull[stage]
    ride.pitch[stage], ride.pitch_rate[stage] = q[CAR_PITCH], v[CAR_PITCH]
    ride.pitch_acceleration[stage] = a[CAR_PITCH]
