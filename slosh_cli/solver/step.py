"""One trial step of TR-BDF2 (`method`) of all vehicles, with its error estimate."""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.method import BASE, DIAGONAL, END, GAMMA, MIDDLE, OUTER, START, difference, line, predict
from slosh_cli.solver.contacts import respond
from slosh_cli.solver.coupled import guess_couplings
from slosh_cli.solver.dense import solve_symmetric
from slosh_cli.solver.ledger import balance
from slosh_cli.solver.stage import prepare_stage, read_ride, solve_stage
from slosh_cli.track.banded import solve_one
from slosh_cli.track.moving import rail_residual
from slosh_cli.wagon.model import CAR_PITCH

_FARTHEST_GUESS = 4.0
"""No stage is guessed from accelerations on a line that has to be drawn out to more than this many times its length."""


@inner_kernel
def _predict_base(vehicle, more, weight, weight_more, implicit):
    """The base of a stage from the start and the stage `more`, weighted (s)."""
    start, other, base = vehicle.points[START], vehicle.points[more], vehicle.points[BASE]
    predict(start.q, start.v, start.a, other.v, other.a, weight, weight_more, implicit, base.q, base.v)
    predict(
        start.rail, start.rail_rate, start.rail_second, other.rail_rate, other.rail_second,
        weight, weight_more, implicit, base.rail, base.rail_rate,
    )  # fmt: skip
    vehicle.liquid.predict(more, weight, weight_more, implicit)


@inner_kernel
def _guess(vehicle, stage, part):
    """Start the iteration of a stage from accelerations and loads on the line from the start to the middle."""
    start, middle, point = vehicle.points[START], vehicle.points[MIDDLE], vehicle.points[stage]
    line(start.a, middle.a, part, point.a)
    line(start.rail_second, middle.rail_second, part, point.rail_second)
    line(start.normal, middle.normal, part, point.normal)


@inner_kernel
def _part_of_middle(train, step):
    """Where the middle of `step` (s) lies on the line from the start to the middle in hand; 0 where that is far."""
    if abs(train.middle_at) * _FARTHEST_GUESS <= GAMMA * step:
        return 0.0
    return GAMMA * step / train.middle_at


@inner_kernel
def _expect(vehicle, step):
    """Let the liquid get ready for the step, and the start's accelerations follow; False when it could not."""
    wagon, point = vehicle.wagon, vehicle.points[START]
    vehicle.scratch.pull = vehicle.line.pull_at(point.q[0])  # the last stage solved may be of a step that was rejected
    read_ride(vehicle, point)
    ready, force, moment = vehicle.liquid.expect(vehicle.ride, step)
    if force != 0.0 or moment != 0.0:
        a, by_force, by_moment = point.a, wagon.tank_push, wagon.tank_turn
        for i in range(a.size):
            a[i] += force * by_force[i] + moment * by_moment[i]
    return ready


@inner_kernel
def _prepare(vehicle, step):
    """Factor for the stages of `step` (s), with what the speed will be in the middle of it."""
    start = vehicle.points[START]
    speed = start.v[0] + 0.5 * (1.0 + GAMMA) * step * start.a[0]
    prepare_stage(vehicle, DIAGONAL * step, speed, start.a[0])


@inner_kernel
def take_step(train, step):
    """Try a step of `step` (s) from the start.

    Returns the error over the allowed one, negative where a stage could not be solved. Fills middle and end, their
    powers, and the energies at the end. The powers at the start must be known.
    """
    vehicles, time, implicit = train.vehicles, train.time, DIAGONAL * step
    for k in range(len(vehicles)):
        if not _expect(vehicles[k], step):
            return -1.0
    part = _part_of_middle(train, step)
    for k in range(len(vehicles)):
        _prepare(vehicles[k], step)
        _predict_base(vehicles[k], START, implicit, 0.0, implicit)
        _guess(vehicles[k], MIDDLE, part)
    guess_couplings(train, MIDDLE, part)
    train.middle_at = 0.0
    if not solve_stage(train, MIDDLE, implicit, time + GAMMA * step):
        return -1.0
    train.middle_at = GAMMA * step
    for k in range(len(vehicles)):
        _predict_base(vehicles[k], MIDDLE, OUTER * step, OUTER * step, implicit)
        _guess(vehicles[k], END, 1.0 / GAMMA)
    guess_couplings(train, END, 1.0 / GAMMA)
    if not solve_stage(train, END, implicit, time + step):
        return -1.0
    return _rate(train, step)


@inner_kernel
def _rate(train, step):
    """Error of the step over the allowed one, negative where a liquid could not be carried through it.

    Where it is small enough, the powers of middle and end and the energies at the end are filled in.
    """
    vehicles, error, tolerance = train.vehicles, 0.0, train.control.local_tolerance
    for k in range(len(vehicles)):
        vehicle = vehicles[k]
        error = max(error, _error(vehicle, step, tolerance))
        allowed = vehicle.scales.speed[0] * tolerance
        missed = vehicle.liquid.carry(vehicle.ride, step, allowed)
        if missed < 0.0:
            return -1.0
        error = max(error, missed / allowed)
    if error <= 1.0:
        for k in range(len(vehicles)):
            balance(vehicles[k], MIDDLE, vehicles[k].account.energies)
            balance(vehicles[k], END, vehicles[k].account.energies)
    return error


@inner_kernel
def _rail_error(vehicle, step, implicit, place):
    """Rail part of the filtered error: accelerations-like vector into `rail_work.missing`, places into `place`."""
    rail, work = vehicle.rail, vehicle.rail_work
    start, middle, end = vehicle.points[START], vehicle.points[MIDDLE], vehicle.points[END]
    error, error_rate, missing = work.error, work.error_rate, work.missing
    difference(start.rail_rate, middle.rail_rate, end.rail_rate, step, error)
    difference(start.rail_second, middle.rail_second, end.rail_second, step, error_rate)
    for i in range(error.size):
        error[i] *= -implicit
    rail_residual(rail, error, work.zero, error_rate, 0.0, end.v[0], end.a[0], work.rows, missing)
    solve_one(work.factors, missing)
    vehicle.account.right_hand_sides += 1
    for i in range(place.size):
        under = rail.contact[i]
        place[i] = -error[under] / implicit + implicit * missing[under]


@inner_kernel
def _bodies_error(vehicle, step, implicit):
    """Right-hand side of the bodies' filtered error into `scratch.right`; returns the liquid's own, a speed (m/s)."""
    wagon, scratch, points = vehicle.wagon, vehicle.scratch, vehicle.points
    mass, stiffness, tank_row = wagon.mass, wagon.stiffness, wagon.tank_row
    q_error, v_error, right = scratch.q_error, scratch.v_error, scratch.right
    difference(points[START].v, points[MIDDLE].v, points[END].v, step, q_error)
    difference(points[START].a, points[MIDDLE].a, points[END].a, step, v_error)
    tank = 0.0
    for i in range(right.size):
        total = 0.0
        for j in range(right.size):
            total += mass[i, j] * v_error[j] - implicit * stiffness[i, j] * q_error[j]
        right[i] = total
        tank += tank_row[i] * v_error[i]
    size, force, moment = vehicle.liquid.error(step, implicit, tank, q_error[CAR_PITCH], v_error[CAR_PITCH])
    for i in range(right.size):
        right[i] += force * tank_row[i]
    right[CAR_PITCH] += moment
    return size


@inner_kernel
def _error(vehicle, step, tolerance):
    """Error of the step over the allowed one, filtered by `(1 - d J)^-1` so that stiff parts do not rule it."""
    wagon, scratch, scales, locked = vehicle.wagon, vehicle.scratch, vehicle.scales, vehicle.locked
    q_error, right, implicit = scratch.q_error, scratch.right, DIAGONAL * step
    size = _bodies_error(vehicle, step, implicit) / scales.slosh
    _rail_error(vehicle, step, implicit, scratch.free)
    solve_symmetric(scratch.linear, right[: wagon.first_spin])
    for i in range(wagon.wheels):
        heave = wagon.first_wheel + i
        apart = scratch.free[i] - q_error[heave] - implicit * right[heave]
        scratch.load_gap[i] = implicit * scratch.normal_slope[i] * apart
        scratch.spin_gap[i] = 0.0 if locked[i] else right[wagon.first_spin + i]
    respond(vehicle, implicit, right)
    speeds, places = scales.speed, scales.place
    for i in range(right.size):
        place = q_error[i] + implicit * right[i]
        size = max(size, abs(right[i]) / speeds[i], abs(place) / places[i])
    return size / tolerance
