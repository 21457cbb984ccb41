"""Rows of a vehicle's history: interpolation of a step at the output instants."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from slosh_cli.compiled import inner_kernel
from slosh_cli.method import END, MIDDLE, START, hermite_weights, hermites, parabola_weights, parabolas
from slosh_cli.solver.ledger import SLOSH
from slosh_cli.solver.vehicle import LOSSES, Vehicle


class Columns(NamedTuple):
    """Where the quantities of a row begin: coordinates with two derivatives, of wheels, brake, energies, liquid."""

    place: int
    speed: int
    acceleration: int
    normal: int
    creep: int
    torque: int
    rail: int
    held_torque: int
    share: int
    application: int
    energies: int
    losses: int
    residual: int
    liquid: int
    end: int


def columns_of(vehicle: Vehicle) -> Columns:
    """The columns of a vehicle's rows; the time is in front."""
    wagon = vehicle.wagon
    sizes = [*3 * [wagon.coordinates], *6 * [wagon.wheels], 1, SLOSH + 1, LOSSES, 1, vehicle.liquid.recorded]
    return Columns(*(1 + int(before) for before in np.cumsum([0, *sizes])))


@inner_kernel
def _recorded_creep(vehicle, wheel, normal, slip, speed, weights):
    """Creep force (N) of a wheel: the parabola through the stages' own, whose impulse is that of the equations.

    A creepage interpolated between the stages would not do: the law makes much of little. Only where a wheel leaves the
    rail or lands within the step does the law speak, with the `normal` force (N), `slip` and `speed` of the row.
    """
    start, middle, end = vehicle.points[START], vehicle.points[MIDDLE], vehicle.points[END]
    if min(start.normal[wheel], middle.normal[wheel], end.normal[wheel], normal) > 0.0:
        return weights[0] * start.creep[wheel] + weights[1] * middle.creep[wheel] + weights[2] * end.creep[wheel]
    creep, _, _, _ = vehicle.contact.creep_force(normal, slip, speed)
    return creep


@inner_kernel
def interpolate(vehicle, row, time, step, part, residual):
    """Interpolate the step (s) from the start, at `time` (s), to the end at its fraction `part` into `row`.

    In the order of `Columns`; `residual` is the ledger's there.
    """
    start, middle, end = vehicle.points[START], vehicle.points[MIDDLE], vehicle.points[END]
    wagon, account, size = vehicle.wagon, vehicle.account, vehicle.wagon.coordinates
    row[0] = time + part * step
    cubic, parabola = hermite_weights(step, part), parabola_weights(part)
    hermites(start.q, start.v, end.q, end.v, cubic, row, 1)
    hermites(start.v, start.a, end.v, end.a, cubic, row, 1 + size)
    parabolas(start.a, middle.a, end.a, parabola, row, 1 + 2 * size)
    _follow_grip(vehicle, row, step, parabola)
    _interpolate_wheels(vehicle, row, time + part * step, cubic, parabola)
    first = 2 + 3 * size + 6 * wagon.wheels
    before, after = account.energies_before, account.energies
    for k in range(SLOSH + 1):
        row[first + k] = (1.0 - part) * before[k] + part * after[k]
    first += SLOSH + 1
    hermites(account.losses_before, start.power, account.losses, end.power, cubic, row, first)
    row[first + LOSSES] = residual
    vehicle.liquid.record(row, first + LOSSES + 1, part, cubic, parabola)


@inner_kernel
def _follow_grip(vehicle, row, step, weights):
    """Spins of the wheels that grip: their slip is the parabola through the stages' own.

    Where the creep force brings a wheel to the wagon's speed sooner than a step (s) lasts, the spin's rate at the ends
    of the step says little of what is between: a cubic through it may run ahead of the wagon.
    """
    start, middle, end = vehicle.points[START], vehicle.points[MIDDLE], vehicle.points[END]
    wagon, by_slip, radius = vehicle.wagon, vehicle.scratch.creep_by_slip, vehicle.wagon.wheel_radius
    speeds = 1 + wagon.coordinates
    for i in range(wagon.wheels):
        spin = wagon.first_spin + i
        if vehicle.locked[i] or step * radius * radius * by_slip[i] < wagon.mass[spin, spin]:
            continue
        slip = weights[0] * (start.v[0] - radius * start.v[spin]) + weights[1] * (middle.v[0] - radius * middle.v[spin])
        slip += weights[2] * (end.v[0] - radius * end.v[spin])
        row[speeds + spin] = (row[speeds] - slip) / radius


@inner_kernel
def _interpolate_wheels(vehicle, row, time, cubic, parabola):
    """Forces, torques, the rail at the wheels, the application; the coordinates are in the `row` already."""
    start, end, wagon, contact = vehicle.points[START], vehicle.points[END], vehicle.wagon, vehicle.contact
    size, wheels, radius, under = wagon.coordinates, wagon.wheels, wagon.wheel_radius, vehicle.rail.contact
    first, speed = 1 + 3 * size, row[1 + size]
    for i in range(wheels):
        node, spin = under[i], row[1 + size + wagon.first_spin + i]
        rail = (
            cubic[0] * start.rail[node]
            + cubic[1] * start.rail_rate[node]
            + cubic[2] * end.rail[node]
            + cubic[3] * end.rail_rate[node]
        )
        heave, angle = row[1 + wagon.first_wheel + i], row[1 + wagon.first_spin + i]
        normal, _ = contact.normal_force(contact.approach(i, rail, heave, row[1], angle))
        creep = _recorded_creep(vehicle, i, normal, speed - radius * spin, speed, parabola)
        way = vehicle.turning[i]
        torque, _ = vehicle.brake.torque(i, time, way * spin)
        if way * spin < 0.0 < torque:  # the step ends a little after the instant at which the brake stops the wheel
            row[1 + size + wagon.first_spin + i] = 0.0
        row[first + i] = normal
        row[first + wheels + i] = creep
        row[first + 2 * wheels + i] = creep * radius if vehicle.locked[i] else way * torque
        row[first + 3 * wheels + i] = rail
        row[first + 4 * wheels + i] = torque
        row[first + 5 * wheels + i] = vehicle.brake.share(i, time)
    row[first + 6 * wheels] = vehicle.brake.application(time)
