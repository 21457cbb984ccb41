"""The compiled time loop: step control, events, sums and recording. Nothing is allocated in it."""

from __future__ import annotations

import math

from slosh_cli.compiled import inner_kernel, kernel, part_kernel
from slosh_cli.solver.cells import LOSS, START_FORCE, START_MOMENT, cells_rise, settle_cells
from slosh_cli.solver.events import (
    BRAKE_EVENT,
    EVENT_COUNT,
    FLOOR_EVENT,
    PITCH_EVENT,
    SHORTEST_STEP,
    STOP_EVENT,
    event_values,
    reached,
    shorter_step,
    switch_at_start,
    wheel_holds,
)
from slosh_cli.solver.ledger import BRAKE, SLOPE, SLOSH_DAMPING, balance
from slosh_cli.solver.method import DIAGONAL, GAMMA, OUTER
from slosh_cli.solver.problem import LOSSES
from slosh_cli.solver.record import interpolate, step_extremes
from slosh_cli.solver.stage import prepare_stage, solve_stage
from slosh_cli.solver.state import (
    EVENTS,
    INITIAL_KINETIC,
    LAST_ERROR,
    MIDDLE_AT,
    NEXT_OUTPUT,
    NEXT_STEP,
    ONSET_POSITION,
    ONSET_TIME,
    PHASE,
    REJECTED,
    ROWS,
    STALLED,
    STEPS,
    TIME,
    TOTAL_START,
)
from slosh_cli.solver.step import take_step
from slosh_cli.tank.modal import surface_rise
from slosh_cli.track.vectors import copy, fill
from slosh_cli.wagon.brake import brake_torque, next_break
from slosh_cli.wagon.coordinates import COORDINATES, WHEEL_SPIN, WHEELS

# why the loop returns
RUNNING, STOPPED, TIME_LIMIT, PITCH_LIMIT, UNSOLVED, STALLED_EVENTS, ROWS_FULL, NOT_FINITE = range(8)

MOST_STALLED = 200
"""Events in a row, each within two of the shortest steps of the last, that end a run."""
GROWTH = 4.0
INTEGRAL, PROPORTIONAL = 0.7 / 3.0, 0.3 / 3.0
"""Exponents of the step control for a local error of order 3: K. Gustafsson, ACM TOMS 17 (1991) 533-554."""
RESTART_STEP = 1e-3
"""First step after a discontinuity, s; error control takes it from there."""


@inner_kernel
def _copy_point(source, target):
    copy(source.q, target.q)
    copy(source.v, target.v)
    copy(source.a, target.a)
    copy(source.rail, target.rail)
    copy(source.rail_rate, target.rail_rate)
    copy(source.rail_second, target.rail_second)
    copy(source.slosh, target.slosh)
    copy(source.slosh_rate, target.slosh_rate)
    copy(source.slosh_second, target.slosh_second)
    copy(source.normal, target.normal)
    copy(source.creep, target.creep)
    copy(source.torque, target.torque)
    copy(source.power, target.power)


@inner_kernel
def _make_consistent(model, scratch, state):
    """Accelerations and forces at `state.start` that satisfy the equations as they are now (implicit step 0)."""
    start, base = state.start, scratch.base
    phase = state.counts[PHASE]
    torque = brake_torque(model.brake, state.clock[TIME], phase)
    _copy_point(start, base)
    prepare_stage(model, scratch, state.work, 0.0, start.v[0], start.a[0], 0.0)
    force, moment = state.push[START_FORCE], state.push[START_MOMENT]
    solved = solve_stage(model, scratch, state.work, base, start, state.locked, 0.0, torque, force, moment)
    balance(model, state.cells_start, start, state.energies)
    copy(state.energies, state.energies_before)
    event_values(model, start, state.locked, torque, state.values_before)
    return solved


@kernel
def begin(model, scratch, state):
    """Make the initial state consistent and open the ledger; True when that worked."""
    fill(state.start.a, 0.0)
    solved = _make_consistent(model, scratch, state)
    state.clock[TOTAL_START] = state.energies[0] + state.energies[1] + state.energies[2]
    state.clock[INITIAL_KINETIC] = state.energies[0]
    return solved


@inner_kernel
def _settle_losses(state, step):
    """Add the step's losses, with the method's own weights."""
    for k in range(LOSSES):
        state.losses_before[k] = state.losses[k]
        state.losses[k] += step * (
            OUTER * (state.start.power[k] + state.middle.power[k]) + DIAGONAL * state.end.power[k]
        )
    state.losses[SLOSH_DAMPING] += state.push[LOSS]


@inner_kernel
def _settle_residual(state):
    total = state.energies[0] + state.energies[1] + state.energies[2] - state.clock[TOTAL_START]
    for k in range(BRAKE, SLOPE):
        total += state.losses[k]
    total -= state.losses[SLOPE]
    state.residual[0] = state.residual[1]
    state.residual[1] = total / state.clock[INITIAL_KINETIC]
    state.residual[2] = max(state.residual[2], abs(state.residual[1]))


@inner_kernel
def _settle_extremes(model, state, step):
    """Extremes and means that count from the onset on."""
    start, middle, end = state.start, state.middle, state.end
    left, right = surface_rise(model.liquid, start.slosh), surface_rise(model.liquid, end.slosh)
    low, high = step_extremes(left, surface_rise(model.liquid, middle.slosh), right)
    front, rear = cells_rise(model, state.cells_end)
    state.surface[0] = max(state.surface[0], -low, high, front, rear)
    if state.counts[PHASE] == 0:
        return
    for i in range(WHEELS):
        low, high = step_extremes(start.normal[i], middle.normal[i], end.normal[i])
        state.least[i] = min(state.least[i], max(low, 0.0))
        state.largest[i] = max(state.largest[i], high)
        mean = OUTER * (start.normal[i] + middle.normal[i]) + DIAGONAL * end.normal[i]
        state.load_sum[0] += step * mean
        if state.locked[i]:
            state.locked_time[i] += step
    state.load_sum[1] += step


@inner_kernel
def _has_room(model, state, rows, step):
    """Whether `rows` can take all rows of a step of `step` (s) and the end of the run."""
    needed = 1 + int((state.clock[TIME] + step - state.clock[NEXT_OUTPUT]) / model.control.interval)
    return state.counts[ROWS] + max(needed, 0) + 1 <= rows.shape[0]


@part_kernel
def _record(model, state, rows, step):
    """Rows for the output instants within the step."""
    time, interval = state.clock[TIME], model.control.interval
    while state.clock[NEXT_OUTPUT] <= time + step:
        part = min(max((state.clock[NEXT_OUTPUT] - time) / step, 0.0), 1.0)
        interpolate(model, state, rows[state.counts[ROWS]], time, step, part, state.counts[PHASE])
        rows[state.counts[ROWS], 0] = state.clock[NEXT_OUTPUT]
        state.counts[ROWS] += 1
        state.clock[NEXT_OUTPUT] = round(state.clock[NEXT_OUTPUT] / interval + 1.0) * interval


@inner_kernel
def _apply_events(model, state, before, after):
    """Switch what the reached events switch; returns (something switched, outcome)."""
    switched, outcome = False, RUNNING
    for k in range(EVENT_COUNT):
        if not reached(before, after, k):
            continue
        switched = True
        if k < FLOOR_EVENT:
            wheel = k - BRAKE_EVENT
            state.start.v[WHEEL_SPIN + wheel] = 0.0
            state.locked[wheel] = wheel_holds(model, state, wheel)
        elif k == STOP_EVENT:
            outcome = STOPPED
        elif k == PITCH_EVENT:
            outcome = PITCH_LIMIT
    return switched, outcome


@inner_kernel
def _follow_contacts(state):
    """Count the wheels that left the rail or came back to it in the step in hand."""
    for i in range(WHEELS):
        for normal in (state.middle.normal[i], state.end.normal[i]):
            if (normal <= 0.0) != state.airborne[i]:
                state.airborne[i] = not state.airborne[i]
                state.lifted[0] += 1


@part_kernel
def _accept(model, state, rows, step):
    """Book the step in hand."""
    _settle_losses(state, step)
    _settle_residual(state)
    _record(model, state, rows, step)
    _settle_extremes(model, state, step)
    _follow_contacts(state)
    _copy_point(state.end, state.start)
    settle_cells(state, step)
    copy(state.energies, state.energies_before)
    copy(state.losses, state.losses_before)
    state.residual[0] = state.residual[1]
    state.clock[TIME] += step
    state.clock[MIDDLE_AT] = (GAMMA - 1.0) * step
    state.counts[STEPS] += 1
    if step > 2.0 * SHORTEST_STEP:
        state.counts[STALLED] = 0


@inner_kernel
def _onset(model, state):
    """Pass a break of the brake's torque; the first one is the onset. It may hold a locked wheel no longer."""
    if state.counts[PHASE] == 0:
        state.clock[ONSET_TIME] = state.clock[TIME]
        state.clock[ONSET_POSITION] = state.start.q[0]
    state.counts[PHASE] += 1
    for wheel in range(WHEELS):
        state.locked[wheel] = state.locked[wheel] and wheel_holds(model, state, wheel)


@inner_kernel
def _limited_step(model, state):
    """The step to try, not past a break or the time limit; and whether it ends at the break."""
    time = state.clock[TIME]
    step = min(state.clock[NEXT_STEP], model.control.longest_step)
    slowing = abs(state.start.a[0])
    if slowing * step > model.control.most_slowing:
        step = model.control.most_slowing / slowing
    until = min(next_break(model.brake, state.counts[PHASE]), model.control.time_limit) - time
    if step >= until * (1.0 - 1e-9):
        return until
    if 2.0 * step > until:
        return 0.5 * until
    return step


@inner_kernel
def _next_step(step, error, error_before, rejected):
    """Next step by the errors of this and the last one (Gustafsson's PI control), not longer after a rejection."""
    factor = 0.9 * max(error, 1e-6) ** (-PROPORTIONAL - INTEGRAL) * max(error_before, 1e-2) ** PROPORTIONAL
    return step * min(1.0 if rejected else GROWTH, factor)


@inner_kernel
def _event_step(model, state, step, time):
    """Shorter step where an event falls inside the one in hand (its middle stage is looked at too)."""
    phase = state.counts[PHASE]
    torque = brake_torque(model.brake, time + GAMMA * step, phase)
    event_values(model, state.middle, state.locked, torque, state.values)
    shorter = min(step, shorter_step(state.values_before, state.values, GAMMA * step))
    if shorter >= GAMMA * step:
        shorter = step
    torque = brake_torque(model.brake, time + step, phase)
    event_values(model, state.end, state.locked, torque, state.values)
    return min(shorter, shorter_step(state.values_before, state.values, step))


@inner_kernel
def _finite(point):
    total = 0.0
    for i in range(COORDINATES):
        total += point.q[i] + point.v[i]
    return math.isfinite(total)


@inner_kernel
def _after_events(model, scratch, state):
    """Restart after a switch: consistent accelerations, a short step, protection against chatter."""
    state.work[EVENTS] += 1
    state.counts[STALLED] += 1
    state.clock[NEXT_STEP] = RESTART_STEP
    state.clock[LAST_ERROR] = 1.0
    state.clock[MIDDLE_AT] = 0.0
    if not _make_consistent(model, scratch, state):
        return UNSOLVED
    if state.counts[STALLED] > MOST_STALLED:
        return STALLED_EVENTS
    return RUNNING


@kernel
def advance(model, scratch, state, rows, most_steps):
    """Run until the wagon stops, something ends the run, `rows` is full, or `most_steps` more were taken."""
    tries = 0
    for _ in range(most_steps):
        time = state.clock[TIME]
        if time >= model.control.time_limit:
            return TIME_LIMIT
        if time >= next_break(model.brake, state.counts[PHASE]):
            _onset(model, state)
            outcome = _after_events(model, scratch, state)
            if outcome != RUNNING:
                return outcome
        step = _limited_step(model, state)
        if not _has_room(model, state, rows, step):
            return ROWS_FULL
        accepted = switched = False
        tries = 0
        rejected = False
        while not (accepted or switched):
            error = take_step(model, scratch, state, time, step)
            if not (0.0 <= error <= 1.0):
                state.counts[REJECTED] += 1
                rejected = True
                step *= 0.25 if not error > 1.0 else max(0.2, 0.9 * error ** (-1.0 / 3.0))
                state.clock[NEXT_STEP] = step
                if step < SHORTEST_STEP:
                    return UNSOLVED
                continue
            shorter = _event_step(model, state, step, time)
            accepted = shorter >= step or step <= 2.0 * SHORTEST_STEP
            if not accepted:
                tries += 1
                state.counts[REJECTED] += 1
                if shorter < 2.0 * SHORTEST_STEP:
                    switched = switch_at_start(model, state, state.values_before, state.values, step)
                # a straight line may creep towards a bent event from beyond it: halving does not
                step = max(shorter if tries < 3 else min(shorter, 0.5 * step), 2.0 * SHORTEST_STEP)
        if switched:
            outcome = _after_events(model, scratch, state)
            if outcome != RUNNING:
                return outcome
            continue
        if not _finite(state.end):
            return NOT_FINITE
        _accept(model, state, rows, step)
        state.clock[NEXT_STEP] = _next_step(step, error, state.clock[LAST_ERROR], rejected)
        state.clock[LAST_ERROR] = error
        if time + step >= next_break(model.brake, state.counts[PHASE]) * (1.0 - 1e-14):
            state.clock[TIME] = next_break(model.brake, state.counts[PHASE])
        switched, outcome = _apply_events(model, state, state.values_before, state.values)
        for k in range(EVENT_COUNT):
            state.values_before[k] = state.values[k]
        if outcome != RUNNING:
            return outcome
        if switched:
            outcome = _after_events(model, scratch, state)
            if outcome != RUNNING:
                return outcome
    return RUNNING
