"""One trial step of TR-BDF2 with its error estimate.

The trapezoidal rule to `t + gamma h`, then BDF2 to `t + h`, gamma = 2 - sqrt 2, written as a singly diagonally
implicit method of order 2, L-stable, with an embedded third-order companion: R. E. Bank et al., IEEE Trans. CAD 4
(1985) 436-451; M. E. Hosea and L. F. Shampine, Appl. Numer. Math. 20 (1996) 21-37.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel, part_kernel, vector_kernel
from slosh_cli.solver.cells import FOLLOWING, HELD_FORCE, HELD_MOMENT, carry_cells, expect_push, missed_speed
from slosh_cli.solver.contacts import respond
from slosh_cli.solver.dense import solve_symmetric
from slosh_cli.solver.ledger import balance
from slosh_cli.solver.method import DIAGONAL, ERROR_END, ERROR_MIDDLE, ERROR_START, GAMMA, OUTER
from slosh_cli.solver.stage import prepare_stage, solve_stage
from slosh_cli.solver.state import MIDDLE_AT, PHASE, RIGHT_HAND_SIDES
from slosh_cli.track.banded import solve_one
from slosh_cli.track.moving import rail_residual
from slosh_cli.wagon.brake import brake_torque
from slosh_cli.wagon.coordinates import BODIES, CAR_PITCH, COORDINATES, WHEEL_HEAVE, WHEEL_SPIN, WHEELS

FARTHEST_GUESS = 4.0
"""No stage is guessed from accelerations on a line that has to be drawn out to more than this many times its length."""


@vector_kernel
def _predict(values, rates, seconds, more_rates, more_seconds, weight, weight_more, diagonal, base, base_rates):
    """Coordinates and velocities of a stage but for its own accelerations, into `base`, `base_rates`."""
    for i in range(values.size):
        base_rates[i] = rates[i] + weight * seconds[i] + weight_more * more_seconds[i]
        base[i] = values[i] + weight * rates[i] + weight_more * more_rates[i] + diagonal * base_rates[i]


@inner_kernel
def _predict_point(start, more, weight, weight_more, diagonal, base):
    _predict(start.q, start.v, start.a, more.v, more.a, weight, weight_more, diagonal, base.q, base.v)
    _predict(
        start.rail, start.rail_rate, start.rail_second, more.rail_rate, more.rail_second,
        weight, weight_more, diagonal, base.rail, base.rail_rate,
    )  # fmt: skip
    _predict(
        start.slosh, start.slosh_rate, start.slosh_second, more.slosh_rate, more.slosh_second,
        weight, weight_more, diagonal, base.slosh, base.slosh_rate,
    )  # fmt: skip


@vector_kernel
def _line(start, other, part, point):
    """The line from `start` to `other` at its fraction `part`, into `point`."""
    for i in range(point.size):
        point[i] = start[i] + part * (other[i] - start[i])


@inner_kernel
def _guess(start, other, part, point):
    """Start a stage's iteration from accelerations and wheel loads on the line from `start` to `other`."""
    _line(start.a, other.a, part, point.a)
    _line(start.rail_second, other.rail_second, part, point.rail_second)
    _line(start.normal, other.normal, part, point.normal)


@inner_kernel
def _part_of_middle(state, step):
    """Where the middle of `step` (s) lies on the line from the start to the `middle` in hand; 0 where that is far."""
    if abs(state.clock[MIDDLE_AT]) * FARTHEST_GUESS <= GAMMA * step:
        return 0.0
    return GAMMA * step / state.clock[MIDDLE_AT]


@part_kernel
def take_step(model, scratch, state, time, step):
    """Try a step of `step` (s) from `state.start` at `time` (s).

    Returns the error over the allowed one, negative where a stage could not be solved. Fills `state.middle` and
    `state.end`, their powers, and the energies at the end. `state.start.power` must be known.
    """
    start, middle, end = state.start, state.middle, state.end
    work, locked, phase = state.work, state.locked, state.counts[PHASE]
    wet = model.shallow.cells > 0
    if wet and not expect_push(model, scratch, state, step):
        return -1.0
    implicit = DIAGONAL * step
    speed = start.v[0] + 0.5 * (1.0 + GAMMA) * step * start.a[0]
    base, push = scratch.base, state.push
    prepare_stage(model, scratch, work, implicit, speed, start.a[0], push[FOLLOWING])
    force, moment = push[HELD_FORCE], push[HELD_MOMENT]
    _predict_point(start, start, implicit, 0.0, implicit, base)
    _guess(start, middle, _part_of_middle(state, step), middle)
    state.clock[MIDDLE_AT] = 0.0
    torque = brake_torque(model.brake, time + GAMMA * step, phase)
    if not solve_stage(model, scratch, work, base, middle, locked, implicit, torque, force, moment):
        return -1.0
    state.clock[MIDDLE_AT] = GAMMA * step
    _predict_point(start, middle, OUTER * step, OUTER * step, implicit, base)
    _guess(start, middle, 1.0 / GAMMA, end)
    torque = brake_torque(model.brake, time + step, phase)
    if not solve_stage(model, scratch, work, base, end, locked, implicit, torque, force, moment):
        return -1.0
    error = _error(model, scratch, work, start, middle, end, locked, step, push[FOLLOWING])
    if wet:
        if not carry_cells(model, scratch, state, step):
            return -1.0
        allowed = model.control.speed_scale[0] * model.control.local_tolerance
        error = max(error, missed_speed(model, push, step, allowed) / allowed)
    if error <= 1.0:
        balance(model, state.cells_start, middle, state.energies)
        balance(model, state.cells_end, end, state.energies)
    return error


@vector_kernel
def _difference(start, middle, end, step, result):
    for i in range(start.size):
        result[i] = step * (ERROR_START * start[i] + ERROR_MIDDLE * middle[i] + ERROR_END * end[i])


@part_kernel
def _rail_error(model, scratch, work, start, middle, end, step, implicit, place):
    """Rail part of the filtered error: accelerations-like vector into `scratch.missing`, places into `place`."""
    rail = model.rail
    error, error_rate = scratch.rail_error, scratch.rail_error_rate
    _difference(start.rail_rate, middle.rail_rate, end.rail_rate, step, error)
    _difference(start.rail_second, middle.rail_second, end.rail_second, step, error_rate)
    for i in range(error.size):
        error[i] *= -implicit
    rail_residual(
        rail, error, scratch.rail_zero, error_rate, 0.0, end.v[0], end.a[0], scratch.rail_rows, scratch.missing
    )  # fmt: skip
    solve_one(scratch.rail_factors, scratch.missing)
    work[RIGHT_HAND_SIDES] += 1
    for i in range(WHEELS):
        under = rail.contact[i]
        place[i] = -error[under] / implicit + implicit * scratch.missing[under]


@inner_kernel
def _slosh_error(model, start, middle, end, step, implicit, q_error, v_error, right, following):
    """Slosh part of the filtered error on the wagon's right-hand side; returns the size of the modes' own error.

    `following` (kg) is the mass that a liquid of cells adds to the tank.
    """
    liquid, size = model.liquid, 0.0
    tank = 0.0
    for i in range(COORDINATES):
        tank += model.wagon.tank_row[i] * v_error[i]
    if following > 0.0:
        along = following * (tank + model.shallow.centre_height * v_error[CAR_PITCH])
        for i in range(COORDINATES):
            right[i] += along * model.wagon.tank_row[i]
        right[CAR_PITCH] += model.shallow.centre_height * along
    for n in range(start.slosh.size):
        place = step * (
            ERROR_START * start.slosh_rate[n] + ERROR_MIDDLE * middle.slosh_rate[n] + ERROR_END * end.slosh_rate[n]
        )
        rate = step * (
            ERROR_START * start.slosh_second[n]
            + ERROR_MIDDLE * middle.slosh_second[n]
            + ERROR_END * end.slosh_second[n]
        )
        inertia = liquid.mu[n] + implicit * liquid.damping[n] + implicit * implicit * liquid.stiffness[n]
        arm = liquid.lambda_02[n] - implicit * implicit * liquid.pitch_weight[n]
        own = (
            liquid.mu[n] * rate
            + liquid.lambda_1[n] * tank
            + liquid.lambda_02[n] * v_error[CAR_PITCH]
            - implicit * (liquid.stiffness[n] * place - liquid.pitch_weight[n] * q_error[CAR_PITCH])
        )
        to_tank = liquid.lambda_1[n] * (rate - own / inertia)
        for i in range(COORDINATES):
            right[i] += to_tank * model.wagon.tank_row[i]
        right[CAR_PITCH] += liquid.lambda_02[n] * rate + implicit * liquid.pitch_weight[n] * place - arm * own / inertia
        size = max(size, abs(rate))
    return size


@part_kernel
def _error(model, scratch, work, start, middle, end, locked, step, following):
    """Error of the step over the allowed one, filtered by `(1 - d J)^-1` so that stiff parts do not rule it."""
    control, wagon = model.control, model.wagon
    implicit = DIAGONAL * step
    q_error, v_error, right = scratch.q_error, scratch.v_error, scratch.right
    _difference(start.v, middle.v, end.v, step, q_error)
    _difference(start.a, middle.a, end.a, step, v_error)
    for i in range(COORDINATES):
        total = 0.0
        for j in range(COORDINATES):
            total += wagon.mass[i, j] * v_error[j] - implicit * wagon.stiffness[i, j] * q_error[j]
        right[i] = total
    slosh = _slosh_error(model, start, middle, end, step, implicit, q_error, v_error, right, following)
    _rail_error(model, scratch, work, start, middle, end, step, implicit, scratch.free)
    solve_symmetric(scratch.linear, right[:BODIES])
    for i in range(WHEELS):
        apart = scratch.free[i] - q_error[WHEEL_HEAVE + i] - implicit * right[WHEEL_HEAVE + i]
        scratch.load_gap[i] = implicit * scratch.normal_slope[i] * apart
        scratch.spin_gap[i] = 0.0 if locked[i] else right[WHEEL_SPIN + i]
    respond(model, scratch, locked, implicit, right)
    size = slosh / control.slosh_scale
    for i in range(COORDINATES):
        place = q_error[i] + implicit * right[i]
        size = max(size, abs(right[i]) / control.speed_scale[i], abs(place) / control.place_scale[i])
    return size / control.local_tolerance
