"""One implicit stage: rail and wagon condensed on the four contacts, Newton on these.

Every stage of the method has the form `q = q_p + d^2 a`, `v = v_p + d a` with the accelerations a unknown and d the
implicit step; d = 0 gives the accelerations consistent with a known state. But for the contacts, the brakes and the
running resistance all is linear in a: rail and wagon are solved once a step for unit forces, and Newton's unknowns are
the wheel loads, the acceleration along the track and those of the wheels' spins.
"""

from __future__ import annotations

import math

from slosh_cli.compiled import inner_kernel, vector_kernel
from slosh_cli.solver.contacts import solve_wheels, wheel_forces
from slosh_cli.solver.dense import factor_symmetric, solve_symmetric
from slosh_cli.solver.state import BOGIE_INPUT, FACTORISATIONS, INPUTS, PUSH_INPUT, RIGHT_HAND_SIDES
from slosh_cli.tank.modal import liquid_follow, liquid_reaction
from slosh_cli.track.banded import solve_one
from slosh_cli.track.moving import prepare_rail, rail_residual
from slosh_cli.track.vectors import fill
from slosh_cli.wagon.coordinates import BODIES, BOGIE_PITCH, CAR_PITCH, WHEEL_HEAVE, WHEELS

MOST_PASSES = 8
RAIL_SHARE = 1e-5
"""A pass over the rail may leave open this part of the static load, or less at tighter tolerances."""


@inner_kernel
def prepare_stage(model, scratch, work, step, speed, acceleration, following):
    """What all stages of implicit step `step` (s) share: rail factors, the wagon's linear part and its responses.

    `following` (kg) is the mass that a liquid beside the stages adds to the tank at the still liquid's centre.
    """
    prepare_rail(
        model.rail, step, speed, acceleration, scratch.rail_rows, scratch.rail_factors, scratch.flexibility
    )  # fmt: skip
    scratch.factored[0], scratch.factored[1] = speed, acceleration
    work[FACTORISATIONS] += 1
    work[RIGHT_HAND_SIDES] += 4
    wagon, linear = model.wagon, scratch.linear
    uu, up, pp, _, _ = liquid_reaction(model.liquid, scratch.slosh_zero, scratch.slosh_zero, step, 0.0)
    centre = model.shallow.centre_height
    uu, up, pp = uu + following, up + centre * following, pp + centre * centre * following
    for i in range(BODIES):
        for j in range(BODIES):
            linear[i, j] = wagon.mass[i, j] + step * (wagon.damping[i, j] + step * wagon.stiffness[i, j])
            linear[i, j] += uu * wagon.tank_row[i] * wagon.tank_row[j]
    for i in range(BODIES):
        linear[i, CAR_PITCH] += up * wagon.tank_row[i]
        linear[CAR_PITCH, i] += up * wagon.tank_row[i]
    linear[CAR_PITCH, CAR_PITCH] += pp
    factor_symmetric(linear)
    for k in range(INPUTS):
        fill(scratch.response[k], 0.0)
    for i in range(WHEELS):
        scratch.response[i, WHEEL_HEAVE + i] = 1.0
        for j in range(WHEELS):
            scratch.contact_flexibility[i, j] = scratch.flexibility[model.rail.contact[i], 0, j]
    scratch.response[PUSH_INPUT, 0] = 1.0
    scratch.response[BOGIE_INPUT, BOGIE_PITCH] = 1.0
    scratch.response[BOGIE_INPUT + 1, BOGIE_PITCH + 2] = 1.0
    for k in range(INPUTS):
        solve_symmetric(linear, scratch.response[k])


@inner_kernel
def _free_accelerations(model, scratch, base, step, push, turn):
    """The bodies' accelerations under all that does not depend on the stage's own, into `scratch.free_bodies`."""
    wagon, right = model.wagon, scratch.free_bodies
    for i in range(BODIES):
        total = wagon.weight[i]
        for j in range(BODIES):
            total -= wagon.damping[i, j] * base.v[j] + wagon.stiffness[i, j] * base.q[j]
        right[i] = total
    _, _, _, force, moment = liquid_reaction(model.liquid, base.slosh, base.slosh_rate, step, base.q[CAR_PITCH])
    for i in range(BODIES):
        right[i] += (force + push) * wagon.tank_row[i]
    right[CAR_PITCH] += moment + turn
    solve_symmetric(scratch.linear, right)


@inner_kernel
def solve_stage(model, scratch, work, base, point, locked, step, torque, push, turn):
    """Solve one stage; `point` enters with a guess of its accelerations and wheel loads.

    `base` holds the stage's coordinates and velocities without their own accelerations; `push` (N) and `turn` (N m)
    are force and moment on the tank from a liquid that is carried along beside the stages, but for what follows the
    tank's acceleration. Returns True when
    converged: rail, wagon, contacts and liquid then satisfy their equations together.
    """
    rail, contact, control = model.rail, model.rail.contact, model.control
    square = step * step
    _free_accelerations(model, scratch, base, step, push, turn)
    allowed = min(RAIL_SHARE, control.local_tolerance) * control.load_scale
    for _ in range(MOST_PASSES):
        speed, acceleration = base.v[0] + step * point.a[0], point.a[0]
        rail_residual(
            rail, base.rail, base.rail_rate, point.rail_second, step, speed, acceleration, scratch.rail_rows,
            scratch.missing,
        )  # fmt: skip
        for i in range(WHEELS):
            scratch.missing[contact[i]] += point.normal[i]
            scratch.load_before[i] = point.normal[i]
        solve_one(scratch.rail_factors, scratch.missing)
        work[RIGHT_HAND_SIDES] += 1
        moved = deepest = 0.0
        for i in range(WHEELS):
            change = square * scratch.missing[contact[i]]
            place = base.rail[contact[i]] + square * point.rail_second[contact[i]]
            scratch.free[i] = place - change
            moved, deepest = max(moved, abs(change)), max(deepest, abs(place))
        if not solve_wheels(model, scratch, work, base, point, locked, step, torque):
            return False
        _correct_rail(scratch, point)
        size = 0.0
        for i in range(WHEELS):
            load_size = abs(point.normal[i] - scratch.load_before[i])
            size = max(size, moved * scratch.normal_slope[i], load_size)
        open_load = _stage_mismatch(rail, scratch, step, speed, acceleration) * size
        open_load += _motion_mismatch(rail, step, point.v[0], deepest, point.a[0] - acceleration)
        if open_load <= allowed:
            _finish(model, scratch, base, point, locked, step, torque)
            return True
    return False


@inner_kernel
def _stage_mismatch(rail, scratch, step, speed, acceleration):
    """Bound on what a pass leaves open, over its change, because the factors were made for another V and A.

    For a wave of number p the difference is `2 m d dV p + ...`, the matrix `m + d^2 (k + T p^2 + EI p^4)` (model
    section 6). With `s = m + d^2 (k - T^2/(4 EI))` the quotient is largest at `p^4 = s/(3 d^2 EI)`, that of the terms
    with p^2 at `p^4 = s/(d^2 EI)`.
    """
    faster = abs(speed - scratch.factored[0])
    drift = step * (2.0 * rail.mass + step * rail.damping) * faster
    drift += step * step * rail.mass * abs(acceleration - scratch.factored[1])
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
def _move(place, rate, second, step, moved, moved_rate):
    """Places and rates of a stage from the accelerations `second`."""
    for i in range(place.size):
        moved[i] = place[i] + step * step * second[i]
        moved_rate[i] = rate[i] + step * second[i]


@vector_kernel
def _correct_rail(scratch, point):
    """The rail's accelerations after a pass: what was missing, and the wheel loads' change."""
    missing, second, flexibility = scratch.missing, point.rail_second, scratch.flexibility
    by_one, by_two = point.normal[0] - scratch.load_before[0], point.normal[1] - scratch.load_before[1]
    by_three, by_four = point.normal[2] - scratch.load_before[2], point.normal[3] - scratch.load_before[3]
    nodes = flexibility.shape[0]
    for k in range(2):
        these, less = second[k * nodes : (k + 1) * nodes], missing[k * nodes : (k + 1) * nodes]
        for i in range(nodes):
            unit = flexibility[i, k]
            these[i] -= less[i] + unit[0] * by_one + unit[1] * by_two + unit[2] * by_three + unit[3] * by_four


@inner_kernel
def _finish(model, scratch, base, point, locked, step, torque):
    """Bring every part of the point to the solved accelerations."""
    square = step * step
    _move(base.rail, base.rail_rate, point.rail_second, step, point.rail, point.rail_rate)
    for i in range(WHEELS):
        point.normal[i] = max(point.normal[i], 0.0)
    pitch = base.q[CAR_PITCH]
    tank = 0.0
    for i in range(BODIES):
        tank += model.wagon.tank_row[i] * point.a[i]
    liquid_follow(model.liquid, base.slosh, base.slosh_rate, step, pitch, tank, point.a[CAR_PITCH], point.slosh_second)
    for n in range(point.slosh.size):
        point.slosh[n] = base.slosh[n] + square * point.slosh_second[n]
        point.slosh_rate[n] = base.slosh_rate[n] + step * point.slosh_second[n]
    wheel_forces(model, scratch, point, locked, torque)
