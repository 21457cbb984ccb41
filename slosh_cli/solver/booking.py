"""What is booked of a step that is accepted: losses, extremes, rows of the history, and the next start."""

from __future__ import annotations

from slosh_cli.arrays import Cube
from slosh_cli.compiled import inner_kernel, kernel
from slosh_cli.method import (
    DIAGONAL,
    END,
    GAMMA,
    MIDDLE,
    OUTER,
    START,
    hermite_weights,
    parabola_weights,
    step_extremes,
)
from slosh_cli.solver.events import SHORTEST_STEP
from slosh_cli.solver.ledger import settle_losses, settle_residual
from slosh_cli.solver.record import interpolate
from slosh_cli.solver.train import Train
from slosh_cli.vectors import copy


@inner_kernel
def copy_point(source, target):
    copy(source.q, target.q)
    copy(source.v, target.v)
    copy(source.a, target.a)
    copy(source.rail, target.rail)
    copy(source.rail_rate, target.rail_rate)
    copy(source.rail_second, target.rail_second)
    copy(source.normal, target.normal)
    copy(source.creep, target.creep)
    copy(source.torque, target.torque)
    copy(source.power, target.power)


@inner_kernel
def _settle_extremes(vehicle, step):
    """Extremes and means that count from the onset on."""
    account = vehicle.account
    account.surface = max(account.surface, vehicle.liquid.highest())
    if not vehicle.brake.is_on():
        return
    start, middle, end = vehicle.points[START].normal, vehicle.points[MIDDLE].normal, vehicle.points[END].normal
    for i in range(start.size):
        low, high = step_extremes(start[i], middle[i], end[i])
        account.least[i] = min(account.least[i], max(low, 0.0))
        account.largest[i] = max(account.largest[i], high)
        mean = OUTER * (start[i] + middle[i]) + DIAGONAL * end[i]
        account.load_seconds += step * mean
        turned = max(vehicle.points[START].torque[i], vehicle.points[END].torque[i])
        account.largest_torque[i] = max(account.largest_torque[i], turned)
    account.seconds += step


@inner_kernel
def _settle_slides(vehicle, time, step):
    """How long locked wheels slide from `time` (s) on, how far and with what work; they are as in the step in hand.

    A vehicle that stands while its train still moves does not slide.
    """
    account, points = vehicle.account, vehicle.points
    start, middle, end = points[START], points[MIDDLE], points[END]
    stands = min(abs(start.v[0]), abs(end.v[0])) < vehicle.line.standing
    for i in range(vehicle.wagon.wheels):
        if stands or not vehicle.locked[i]:
            account.sliding[i] = account.sliding_work[i] = 0.0
            continue
        if account.locked_time[i] == 0.0:
            account.lock_time[i], account.lock_speed[i] = time, start.v[0]
        account.locked_time[i] += step
        power = (
            OUTER * (start.creep[i] * start.v[0] + middle.creep[i] * middle.v[0]) + DIAGONAL * end.creep[i] * end.v[0]
        )
        account.sliding[i] += end.q[0] - start.q[0]
        account.sliding_work[i] += step * power
        if account.sliding[i] > account.slid[i]:
            account.slid[i], account.slid_work[i] = account.sliding[i], account.sliding_work[i]


@kernel
def record(train: Train, rows: Cube, step: float, part: float) -> None:
    """Interpolate the step at its fraction `part` into the next of the `rows` (rows, vehicles, columns)."""
    vehicles, residual = train.vehicles, (1.0 - part) * train.residual_before + part * train.residual
    for k in range(len(vehicles)):
        interpolate(vehicles[k], rows[train.rows, k], train.time, step, part, residual)
    cubic, parabola = hermite_weights(step, part), parabola_weights(part)
    for j in range(train.couplings.taken.size):
        train.couplings.record(j, rows[train.rows, j], cubic, parabola)
    train.rows += 1


@inner_kernel
def _record_step(train, rows, step):
    """Rows for the output instants within the step."""
    time, interval = train.time, train.control.interval
    while train.next_output <= time + step:
        part = min(max((train.next_output - time) / step, 0.0), 1.0)
        record(train, rows, step, part)
        for k in range(rows.shape[1]):
            rows[train.rows - 1, k, 0] = train.next_output
        train.next_output = round(train.next_output / interval + 1.0) * interval


@inner_kernel
def _follow_contacts(vehicle):
    """Count the wheels that left the rail or came back to it in the step in hand."""
    for i in range(vehicle.wagon.wheels):
        for stage in range(MIDDLE, END + 1):
            if (vehicle.points[stage].normal[i] <= 0.0) != vehicle.airborne[i]:
                vehicle.airborne[i] = not vehicle.airborne[i]
                vehicle.account.lifted += 1


@inner_kernel
def accept(train, rows, step):
    """Book the step in hand."""
    vehicles = train.vehicles
    for k in range(len(vehicles)):
        settle_losses(vehicles[k], step)
    settle_residual(train, step)
    _record_step(train, rows, step)
    for k in range(len(vehicles)):
        vehicle, account = vehicles[k], vehicles[k].account
        _settle_extremes(vehicle, step)
        _settle_slides(vehicle, train.time, step)
        _follow_contacts(vehicle)
        vehicle.liquid.accept(step)
        copy_point(vehicle.points[END], vehicle.points[START])
        copy(account.energies, account.energies_before)
        copy(account.losses, account.losses_before)
    train.couplings.accept(train.time + step)
    train.residual_before = train.residual
    train.time += step
    train.middle_at = (GAMMA - 1.0) * step
    train.steps += 1
    if step > 2.0 * SHORTEST_STEP:
        train.stalled = 0
