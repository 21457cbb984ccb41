"""The compiled time loop: step control, events, sums and recording. Nothing is allocated in it."""

from __future__ import annotations

import math

from slosh_cli.arrays import Cube
from slosh_cli.compiled import inner_kernel, kernel
from slosh_cli.method import BASE, END, GAMMA, MIDDLE, START
from slosh_cli.solver.booking import accept, copy_point
from slosh_cli.solver.events import SHORTEST_STEP, keep_values, reached, read_values, shorter_step
from slosh_cli.solver.ledger import KINETIC, balance, stored
from slosh_cli.solver.stage import prepare_stage, solve_stage
from slosh_cli.solver.step import take_step
from slosh_cli.solver.train import Train
from slosh_cli.vectors import copy
from slosh_cli.wagon.locking import let_go, switch_at_start, switch_reached

RUNNING, STOPPED, TIME_LIMIT, PITCH_LIMIT, UNSOLVED, STALLED_EVENTS, ROWS_FULL, NOT_FINITE = range(8)
"""Why the loop returns."""

_MOST_STALLED = 200
"""Events in a row, each within two of the shortest steps of the last, that end a run."""
_GROWTH = 4.0
_INTEGRAL, _PROPORTIONAL = 0.7 / 3.0, 0.3 / 3.0
"""Exponents of the step control for a local error of order 3: K. Gustafsson, ACM TOMS 17 (1991) 533-554."""
_BEGUN = 1e-7
"""Less of an application than this is rounding of its onset."""
_RESTART_STEP = 1e-3
"""First step after a discontinuity, s; error control takes it from there."""


@inner_kernel
def _make_consistent(train):
    """Accelerations and forces at the start that satisfy the equations as they are now (implicit step 0)."""
    vehicles = train.vehicles
    for k in range(len(vehicles)):
        vehicle, start = vehicles[k], vehicles[k].points[START]
        copy_point(start, vehicle.points[BASE])
        vehicle.liquid.predict(START, 0.0, 0.0, 0.0)
        prepare_stage(vehicle, 0.0, start.v[0], start.a[0])
    solved = solve_stage(train, START, 0.0, train.time)
    for k in range(len(vehicles)):
        account = vehicles[k].account
        balance(vehicles[k], START, account.energies)
        copy(account.energies, account.energies_before)
    read_values(train, START, train.time)
    keep_values(train)
    return solved


@inner_kernel
def _open_ledger(train):
    """What there is at t = 0."""
    for k in range(len(train.vehicles)):
        energies = train.vehicles[k].account.energies
        train.total_start += stored(energies)
        train.initial_kinetic += energies[KINETIC]


@inner_kernel
def _has_room(train, rows, step):
    """Whether `rows` can take all rows of a step of `step` (s) and the end of the run."""
    needed = 1 + int((train.time + step - train.next_output) / train.control.interval)
    return train.rows + max(needed, 0) + 1 <= rows.shape[0]


@inner_kernel
def _apply_events(train):
    """Switch what the reached events switch; returns (something switched, outcome)."""
    vehicles, switched, outcome = train.vehicles, False, RUNNING
    if reached(train.stop_values[0], train.stop_values[1]):
        switched, outcome = True, STOPPED
    for k in range(len(vehicles)):
        account, wheels = vehicles[k].account, vehicles[k].wagon.wheels
        before, after = account.values_before, account.values
        if switch_reached(vehicles[k], train.time, before, after) or reached(before[wheels], after[wheels]):
            switched = True
        if reached(before[wheels + 1], after[wheels + 1]):
            switched, outcome = True, PITCH_LIMIT
    return switched, outcome


@inner_kernel
def _next_break(train):
    """Time (s) of the next break of any brake."""
    vehicles, following = train.vehicles, math.inf
    for k in range(len(vehicles)):
        following = min(following, vehicles[k].brake.next_break())
    return following


@inner_kernel
def _pass_breaks(train):
    """Pass the breaks of the brakes' torques that are due; the first of a brake is its onset.

    Returns whether a torque has a kink or a jump there.
    """
    vehicles, kinks = train.vehicles, False
    for k in range(len(vehicles)):
        vehicle, brake = vehicles[k], vehicles[k].brake
        if train.time < brake.next_break():
            continue
        if not brake.is_on():
            vehicle.account.onset_time = train.time
            vehicle.account.onset_position = vehicle.points[START].q[0]
        if brake.pass_break(train.time, vehicle.points[START].v, vehicle.wagon.first_spin):
            let_go(vehicle, train.time)
            kinks = True
    return kinks


@inner_kernel
def _resolving_step(vehicle):
    """Longest step (s) from the start that resolves what the vehicle rolls over: its line, its rails, its flats."""
    wagon, q, v, surface = vehicle.wagon, vehicle.points[START].q, vehicle.points[START].v, vehicle.contact.surface
    way = vehicle.line.way_ahead(q[0])
    if surface.uneven == 0:
        return way / abs(v[0])
    step = math.inf
    for i in range(wagon.wheels):
        way = min(way, surface.way_ahead(i, q[0]))
        step = min(step, surface.turning_step(i, q[wagon.first_spin + i], v[wagon.first_spin + i]))
    return min(step, way / abs(v[0]))


@inner_kernel
def _full_slowing(vehicle, time, step):
    """Deceleration (m/s^2) of a vehicle; where its brake builds up within the `step` (s), that of the full brake.

    While the deceleration grows from nothing to A in steps h, the energy that these leave out adds up to that of one
    growth by A: with `A h` within the bound it stays below the tolerance, with `a h` of the instant it would not.
    """
    slowing, applied = abs(vehicle.points[START].a[0]), vehicle.brake.application(time)
    if _BEGUN < applied < vehicle.brake.application(time + step):
        return slowing / applied
    return slowing


@inner_kernel
def _limited_step(train):
    """The step to try, not past a break or the time limit; and whether it ends at the break."""
    control, vehicles = train.control, train.vehicles
    step, slowing = min(train.next_step, control.longest_step), 0.0
    for k in range(len(vehicles)):
        slowing = max(slowing, _full_slowing(vehicles[k], train.time, step))
    if slowing * step > control.most_slowing:
        step = control.most_slowing / slowing
    for k in range(len(vehicles)):
        step = min(step, _resolving_step(vehicles[k]))
    until = min(_next_break(train), control.time_limit) - train.time
    if step >= until * (1.0 - 1e-9):
        return until
    if 2.0 * step > until:
        return 0.5 * until
    return step


@inner_kernel
def _next_step(step, error, error_before, rejected):
    """Next step by the errors of this and the last one (Gustafsson's PI control), not longer after a rejection."""
    factor = 0.9 * max(error, 1e-6) ** (-_PROPORTIONAL - _INTEGRAL) * max(error_before, 1e-2) ** _PROPORTIONAL
    return step * min(1.0 if rejected else _GROWTH, factor)


@inner_kernel
def _event_step(train, step):
    """Shorter step where an event falls inside the one in hand (its middle stage is looked at too)."""
    read_values(train, MIDDLE, train.time + GAMMA * step)
    shorter = min(step, shorter_step(train, GAMMA * step))
    if shorter >= GAMMA * step:
        shorter = step
    read_values(train, END, train.time + step)
    return min(shorter, shorter_step(train, step))


@inner_kernel
def _switch_at_start(train, step):
    """Switch the wheels whose event is no further than the shortest step from the start, or before it, as that of one
    that was let go and then turned the other way; True where there are any."""
    vehicles, switched = train.vehicles, False
    for k in range(len(vehicles)):
        before, after = vehicles[k].account.values_before, vehicles[k].account.values
        switched = switch_at_start(vehicles[k], train.time, before, after, step, 2.0 * SHORTEST_STEP) or switched
    return switched


@inner_kernel
def _finite(train):
    vehicles, total = train.vehicles, 0.0
    for k in range(len(vehicles)):
        q, v = vehicles[k].points[END].q, vehicles[k].points[END].v
        for i in range(q.size):
            total += q[i] + v[i]
    return math.isfinite(total)


@inner_kernel
def _note_event(train):
    """Let the next step begin anew after a switch: with consistent accelerations, and short."""
    train.events += 1
    train.stalled += 1
    train.jumped = 1
    train.next_step = _RESTART_STEP
    train.last_error = 1.0
    train.middle_at = 0.0


@inner_kernel
def _reject(train, step, error):
    """Try a shorter step than the `step` (s) in hand, which erred too much or could not be solved."""
    train.rejected += 1
    train.shortened = 1
    train.trying = train.next_step = step * (0.25 if not error > 1.0 else max(0.2, 0.9 * error ** (-1.0 / 3.0)))
    return UNSOLVED if train.trying < SHORTEST_STEP else RUNNING


@inner_kernel
def _meet_event(train, step, shorter):
    """Try the `shorter` step (s), at whose end an event lies that falls inside the `step` in hand."""
    train.event_tries += 1
    train.rejected += 1
    if _switch_at_start(train, step):
        train.trying = 0.0
        _note_event(train)
        return RUNNING
    # a straight line may creep towards a bent event from beyond it: halving does not
    train.trying = max(shorter if train.event_tries < 3 else min(shorter, 0.5 * step), train.control.event_time)
    return RUNNING


@inner_kernel
def _judge(train, rows, step, error):
    """Reject the `step` (s) in hand, shorten it to an event, or accept it and pass the events at its end.

    Returns how the run goes on.
    """
    if not (0.0 <= error <= 1.0):
        return _reject(train, step, error)
    shorter = _event_step(train, step)
    if shorter < step and step > train.control.event_time:
        return _meet_event(train, step, shorter)
    if not _finite(train):
        return NOT_FINITE
    begun = train.time
    accept(train, rows, step)
    train.trying = 0.0
    train.next_step = _next_step(step, error, train.last_error, train.shortened > 0)
    train.last_error = error
    following = _next_break(train)
    if begun + step >= following * (1.0 - 1e-14):
        train.time = following
    switched, outcome = _apply_events(train)
    keep_values(train)
    if switched and outcome == RUNNING:
        _note_event(train)
    return outcome


@inner_kernel
def _choose(train, rows):
    """Choose the step to try, unless there is one; a break of the brakes that is due is passed first.

    Returns how the run goes on.
    """
    if train.trying > 0.0:
        return RUNNING
    if train.time >= train.control.time_limit:
        return TIME_LIMIT
    if train.time >= _next_break(train) - SHORTEST_STEP:  # several vehicles break at once but for rounding
        train.time = max(train.time, _next_break(train))
        if _pass_breaks(train):
            _note_event(train)
        return RUNNING
    step = _limited_step(train)
    if not _has_room(train, rows, step):
        return ROWS_FULL
    train.trying, train.event_tries, train.shortened = step, 0, 0
    return RUNNING


@kernel
def advance(train: Train, rows: Cube, most_tries: int) -> int:
    """Run until the train stops, something ends the run, `rows` is full, or `most_tries` more steps were tried."""
    for _ in range(most_tries):
        if train.jumped > 0:
            if not _make_consistent(train):
                return UNSOLVED
            if train.stalled > _MOST_STALLED:
                return STALLED_EVENTS
            train.jumped = 0
            if train.initial_kinetic == 0.0:
                _open_ledger(train)
        outcome: int = _choose(train, rows)
        step = train.trying
        if outcome == RUNNING and step > 0.0:
            outcome = _judge(train, rows, step, take_step(train, step))
        if outcome != RUNNING:
            return outcome
    return RUNNING
