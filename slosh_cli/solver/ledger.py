"""The energy ledger: what there is, and the power with which it comes and goes (theory section 9)."""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.method import DIAGONAL, END, MIDDLE, OUTER, START
from slosh_cli.solver.vehicle import (
    BRAKE,
    CREEP,
    FOUNDATION,
    GRADIENT,
    LOSSES,
    RESISTANCE,
    SLOPE,
    SLOSH_DAMPING,
    SUSPENSION,
)
from slosh_cli.track.moving import rail_ledger
from slosh_cli.vectors import fill
from slosh_cli.wagon.model import CAR_PITCH

KINETIC, _ELASTIC, SLOSH = range(3)
"""Places in the stored energies."""


@inner_kernel
def balance(vehicle, stage, energies):
    """Energies (J) of a vehicle at a stage into `energies` (3,), powers (W) into its point's `power`."""
    wagon, point, ride = vehicle.wagon, vehicle.points[stage], vehicle.ride
    mass, stiffness, damping, weight = wagon.mass, wagon.stiffness, wagon.damping, wagon.weight
    q, v, power = point.q, point.v, point.power
    kinetic = elastic = gravity = loss = momentum_along = 0.0
    for i in range(q.size):
        momentum = force = damped = 0.0
        for j in range(q.size):
            momentum += mass[i, j] * v[j]
            force += stiffness[i, j] * q[j]
            damped += damping[i, j] * v[j]
        momentum_along += mass[i, 0] * v[i]
        kinetic += 0.5 * v[i] * momentum
        elastic += 0.5 * q[i] * force
        loss += v[i] * damped
        gravity -= weight[i] * q[i]
    tilt = 0.5 * wagon.gravity_stiffness * q[CAR_PITCH] * q[CAR_PITCH]
    rail_kinetic, rail_elastic, foundation = rail_ledger(vehicle.rail, point.rail, point.rail_rate, v[0])
    slosh_kinetic, slosh_potential, slosh_loss = vehicle.liquid.energy(ride, stage)
    fill(power, 0.0)
    power[SUSPENSION], power[FOUNDATION], power[SLOSH_DAMPING] = loss, foundation, slosh_loss
    resistance, _ = vehicle.line.resisting_force(v[0])
    power[RESISTANCE] = resistance * v[0]
    power[GRADIENT] = -ride.pull[stage] * (momentum_along + vehicle.liquid.momentum(ride, stage))
    energies[KINETIC] = kinetic + rail_kinetic + slosh_kinetic
    energies[_ELASTIC] = elastic - tilt + rail_elastic + _balance_contacts(vehicle, point)
    energies[SLOSH] = gravity + tilt + slosh_potential


@inner_kernel
def _balance_contacts(vehicle, point):
    """Elastic energy (J) of the contacts; their powers and the brakes' into the point's."""
    wagon, contact, under = vehicle.wagon, vehicle.contact, vehicle.rail.contact
    rail, q, v, power = point.rail, point.q, point.v, point.power
    slopes, speed, energy = rail.size // 2, v[0], 0.0
    for i in range(wagon.wheels):
        spin = v[wagon.first_spin + i]
        power[BRAKE] += point.torque[i] * (spin - v[wagon.frame[i]])
        power[CREEP] += point.creep[i] * (speed - wagon.wheel_radius * spin)
        power[SLOPE] += point.normal[i] * speed * rail[slopes + under[i]]
        heave, angle = q[wagon.first_wheel + i], q[wagon.first_spin + i]
        power[SLOPE] += point.normal[i] * contact.rising(i, q[0], speed, angle, spin)
        energy += contact.energy(contact.approach(i, rail[under[i]], heave, q[0], angle))
    return energy


@inner_kernel
def settle_losses(vehicle, step):
    """Add the losses of a `step` (s) that is accepted, with the method's own weights."""
    account, points = vehicle.account, vehicle.points
    losses, before = account.losses, account.losses_before
    start, middle, end = points[START].power, points[MIDDLE].power, points[END].power
    for k in range(LOSSES):
        before[k] = losses[k]
        losses[k] += step * (OUTER * (start[k] + middle[k]) + DIAGONAL * end[k])
    losses[SLOSH_DAMPING] += vehicle.liquid.taken()


@inner_kernel
def stored(energies):
    """What is stored, J."""
    return energies[KINETIC] + energies[_ELASTIC] + energies[SLOSH]


@inner_kernel
def settle_residual(train, step):
    """What the ledgers of all vehicles and couplings miss after a `step` (s), over the initial kinetic energy."""
    vehicles, total = train.vehicles, -train.total_start
    total += train.couplings.half * train.couplings.settle(step)
    for k in range(len(vehicles)):
        energies, losses = vehicles[k].account.energies, vehicles[k].account.losses
        total += stored(energies)
        for loss in range(BRAKE, SLOPE):
            total += losses[loss]
        total -= losses[SLOPE]
    train.residual_before = train.residual
    train.residual = total / train.initial_kinetic
    train.largest_residual = max(train.largest_residual, abs(train.residual))
