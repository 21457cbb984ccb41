"""Coupling of the shallow-water liquid to the wagon, within one step of the integrator.

Over a step the liquid is carried through the tank's own motion (its stage velocities, so that momentum balances to
rounding) and pushes back with its mean force and moment over the step, which enter all stages alike. They are first
estimated by carrying the liquid through the step with the tank's last acceleration; what the estimate misses of the
impulse is handed on, so no impulse is ever lost: to the next step where that is as long, in shares where it is shorter
(a step however short would otherwise have to bear all of it). Places and speeds are of second order in the step
(seen: 2.0 in smooth water, pitch too where bores run). The force's course within a step is not resolved: what
the ledger misses falls with orders 1.5 to 0.7, a bore's arrival at a wall being a jump of the force in any step.

What walls push within a step depends on the tank's acceleration in it, like the force of a mass that goes along: the
added mass of what waves reach from the walls in that time. A push from the last acceleration alone lets the coupling
swing up where that is more than a third of the wagon's own mass (P. Causin, J.-F. Gerbeau and F. Nobile, Comput.
Methods Appl. Mech. Eng. 194 (2005) 4506-4527). So where it is not small beside it, the added mass is measured, by
carrying the liquid through the step a second time, and goes into the stages' equations: the push then follows the
stage's own acceleration (a quasi-Newton coupling; J. Degroote, Arch. Comput. Methods Eng. 20 (2013) 185-238).
"""

from __future__ import annotations

import math

from slosh_cli.compiled import inner_kernel
from slosh_cli.solver.method import GAMMA
from slosh_cli.solver.state import PUSH_PLACES
from slosh_cli.tank.section_table import section_at
from slosh_cli.tank.shallow import liquid_energy_in_tank, liquid_evolve
from slosh_cli.track.vectors import copy, fill
from slosh_cli.wagon.coordinates import CAR_PITCH, COORDINATES

# places in State.push: FORCE, MOMENT are means over the step, START_..., END_... the push at its two ends; FOLLOWING
# (kg) is the added mass with which it follows the tank's acceleration, HELD_... the push at acceleration 0
FORCE, MOMENT, LEFT_FORCE, LEFT_MOMENT, OWED_FORCE, OWED_MOMENT, LOSS, DEEPEST, LAST_STEP = range(9)
FOLLOWING, HELD_FORCE, HELD_MOMENT, START_FORCE, START_MOMENT, END_FORCE, END_MOMENT = range(9, PUSH_PLACES)

LOOSE = 0.2
"""A push from the last acceleration will do while waves reach less than this part of what the wagon weighs."""
LEAST_CHANGE = 1e-3
"""The added mass is measured between two accelerations at least this far apart, m/s^2."""


@inner_kernel
def copy_cells(source, target):
    """Copy areas, flows and depths of the liquid's cells."""
    copy(source.area, target.area)
    copy(source.flow, target.flow)
    copy(source.depth, target.depth)


@inner_kernel
def tank_speed(model, point):
    """Speed (m/s) of the tank at the still liquid's centre: what the cells move relative to."""
    speed = model.shallow.centre_height * point.v[CAR_PITCH]
    for i in range(COORDINATES):
        speed += model.wagon.tank_row[i] * point.v[i]
    return speed


@inner_kernel
def momentum_in_tank(model, cells):
    """Momentum (N s) of the liquid relative to the tank."""
    total = 0.0
    for i in range(model.shallow.cells):
        total += cells.flow[i]
    return total * model.shallow.density * model.shallow.spacing


@inner_kernel
def _at_centre(model, accelerations):
    """Acceleration (m/s^2) of the tank at the still liquid's centre."""
    total = model.shallow.centre_height * accelerations[CAR_PITCH]
    for i in range(COORDINATES):
        total += model.wagon.tank_row[i] * accelerations[i]
    return total


@inner_kernel
def _reached_mass(liquid, cells, step):
    """Mass (kg) that bears on walls and baffles when the tank's acceleration changes for `step` (s).

    The mean force of that time is that of half the length which waves run. The surface's slope within a cell follows an
    acceleration at once, so that half a cell counts in any step. A baffle counts by the part of a flow that it bars.
    """
    total = 0.0
    for face in range(liquid.cells + 1):
        wall = face in (0, liquid.cells) or liquid.loss[face] == math.inf
        if not wall and liquid.loss[face] == 0.0:
            continue
        for cell in range(max(face - 1, 0), min(face + 1, liquid.cells)):
            area, _, width = section_at(liquid.table, cells.depth[cell])
            if area > 0.0:
                wave = math.sqrt(liquid.gravity * area / width)
                bars = 1.0
                if not wall:
                    bars -= 2.0 / (1.0 + math.sqrt(1.0 + liquid.loss[face] * abs(cells.flow[cell]) / (area * wave)))
                total += bars * area * (liquid.spacing + step * wave)
    return min(0.5 * liquid.density * total, liquid.mass)


@inner_kernel
def _mean_push(model, scratch, state, acceleration, step):
    """Carry the liquid through the step with the tank's constant `acceleration`: its impulses in `scratch.cell_sums`.

    Returns False when it could not be carried through.
    """
    cells, sums = state.cells_end, scratch.cell_sums
    copy_cells(state.cells_start, cells)
    fill(sums, 0.0)
    return liquid_evolve(
        model.shallow, cells.area, cells.flow, cells.depth, acceleration, step, scratch.cell_work, sums
    )


@inner_kernel
def _whole_impulse(model, state, acceleration, step):
    """Impulse (N s) of the walls in a step of constant `acceleration`, by what the liquid's momentum lost in it.

    The walls' pressures miss a part of it in cells whose surface is steep, as the section's area is not linear there.
    """
    change = momentum_in_tank(model, state.cells_end) - momentum_in_tank(model, state.cells_start)
    return -change - model.shallow.mass * acceleration * step


@inner_kernel
def _start_with(model, start, push, force, moment):
    """Let the start's accelerations follow a push of `force` and `moment`."""
    for i in range(COORDINATES):
        start.a[i] += (force - push[START_FORCE]) * model.tank_push[i] + (
            moment - push[START_MOMENT]
        ) * model.tank_turn[i]
    push[START_FORCE], push[START_MOMENT] = force, moment


@inner_kernel
def _weights_moment(liquid, cells):
    """Moment (N m) of the liquid's weight about the tank's middle, nose-down."""
    arm = 0.0
    for i in range(liquid.cells):
        arm += cells.area[i] * (i + 0.5 - 0.5 * liquid.cells)
    return liquid.density * liquid.gravity * liquid.spacing * liquid.spacing * arm


@inner_kernel
def expect_push(model, scratch, state, step):
    """Estimate the liquid's mean force and moment over the step and let the start's accelerations follow.

    Returns False when the liquid could not be carried through.
    """
    liquid, start, push, sums = model.shallow, state.start, state.push, scratch.cell_sums
    acceleration = liquid.centre_height * start.a[CAR_PITCH] - liquid.gravity * (
        start.q[CAR_PITCH] + 0.5 * step * start.v[CAR_PITCH]
    )
    for i in range(COORDINATES):
        acceleration += model.wagon.tank_row[i] * start.a[i]
    if not _mean_push(model, scratch, state, acceleration, step):
        return False
    by_force, by_moment = _at_centre(model, model.tank_push), _at_centre(model, model.tank_turn)
    heaviness = _reached_mass(liquid, state.cells_start, step) * (by_force + liquid.centre_height * by_moment)
    if heaviness > LOOSE:
        sums[0] = _whole_impulse(model, state, acceleration, step)
    pitch = start.q[CAR_PITCH] + 0.5 * step * start.v[CAR_PITCH]
    paid_over = max(step, push[LAST_STEP])
    force = sums[0] / step + push[LEFT_FORCE] / paid_over - liquid.mass * liquid.gravity * pitch
    moment = sums[1] / step + push[LEFT_MOMENT] / paid_over
    if heaviness > LOOSE:
        change = (force - push[START_FORCE]) * by_force + (moment - push[START_MOMENT]) * by_moment
        return _follow(model, scratch, state, step, acceleration, change / (1.0 + heaviness), force, moment)
    push[FOLLOWING] = 0.0
    push[HELD_FORCE], push[HELD_MOMENT] = force, moment
    _start_with(model, start, push, force, moment)
    return True


@inner_kernel
def _follow(model, scratch, state, step, acceleration, change, force, moment):
    """Measure the added mass between `acceleration`, where `force` and `moment` push, and one changed by `change`.

    Its force acts at the still liquid's centre. Returns False when the liquid could not be carried through.
    """
    liquid, start, push, sums = model.shallow, state.start, state.push, scratch.cell_sums
    if abs(change) < LEAST_CHANGE:
        change = math.copysign(LEAST_CHANGE, change)
    impulse, turning = sums[0], sums[1]
    if not _mean_push(model, scratch, state, acceleration + change, step):
        return False
    answer = (_whole_impulse(model, state, acceleration + change, step) - impulse) / step
    following = min(max(-answer / change, 0.0), liquid.mass)
    held_force = force + answer + following * change
    held_moment = moment + (sums[1] - turning) / step + liquid.centre_height * following * change
    by_force, by_moment = _at_centre(model, model.tank_push), _at_centre(model, model.tank_turn)
    taken = (held_force - push[START_FORCE]) * by_force + (held_moment - push[START_MOMENT]) * by_moment
    taken *= following / (1.0 + following * (by_force + liquid.centre_height * by_moment))
    before = following * _at_centre(model, start.a)
    push[FOLLOWING] = following
    push[HELD_FORCE] = held_force + before
    push[HELD_MOMENT] = held_moment + liquid.centre_height * before
    _start_with(model, start, push, held_force - taken, held_moment - liquid.centre_height * taken)
    return True


@inner_kernel
def carry_cells(model, scratch, state, step):
    """Carry the liquid through the step as the tank really moved; book what the push owes it and what bores took.

    Returns False when the liquid could not be carried through.
    """
    liquid, push, sums = model.shallow, state.push, scratch.cell_sums
    start, middle, end = state.start, state.middle, state.end
    copy_cells(state.cells_start, state.cells_end)
    cells = state.cells_end
    before = tank_speed(model, start)
    halfway = tank_speed(model, middle)
    after = tank_speed(model, end)
    kinetic, potential = liquid_energy_in_tank(liquid, cells.area, cells.flow, cells.depth)
    momentum = momentum_in_tank(model, cells)
    fill(sums, 0.0)
    first = (halfway - before) / (GAMMA * step) - 0.5 * liquid.gravity * (start.q[CAR_PITCH] + middle.q[CAR_PITCH])
    second = (after - halfway) / ((1.0 - GAMMA) * step) - 0.5 * liquid.gravity * (
        middle.q[CAR_PITCH] + end.q[CAR_PITCH]
    )
    work = scratch.cell_work
    if not liquid_evolve(liquid, cells.area, cells.flow, cells.depth, first, GAMMA * step, work, sums):
        return False
    momentum_halfway = momentum_in_tank(model, cells)
    if not liquid_evolve(liquid, cells.area, cells.flow, cells.depth, second, (1.0 - GAMMA) * step, work, sums):
        return False
    impulse = momentum - momentum_in_tank(model, cells) - liquid.mass * (after - before)
    mean, last = push[FOLLOWING] * ((after - before) / step), push[FOLLOWING] * _at_centre(model, end.a)
    push[FORCE], push[MOMENT] = push[HELD_FORCE] - mean, push[HELD_MOMENT] - liquid.centre_height * mean
    push[END_FORCE], push[END_MOMENT] = push[HELD_FORCE] - last, push[HELD_MOMENT] - liquid.centre_height * last
    push[OWED_FORCE] = push[LEFT_FORCE] + impulse - step * push[FORCE]
    push[OWED_MOMENT] = push[LEFT_MOMENT] + sums[1] - step * push[MOMENT]
    kinetic_end, potential_end = liquid_energy_in_tank(liquid, cells.area, cells.flow, cells.depth)
    push[LOSS] = sums[2] - (kinetic_end + potential_end - kinetic - potential)
    # the walls' pressures turn the tank about the still centre, the liquid feels nothing of it (model section 10)
    pitch, turn = 0.5 * (start.q[CAR_PITCH] + end.q[CAR_PITCH]), end.q[CAR_PITCH] - start.q[CAR_PITCH]
    weights, weights_end = _weights_moment(liquid, state.cells_start), _weights_moment(liquid, cells)
    centred = push[FORCE] + liquid.mass * liquid.gravity * pitch
    apart = push[MOMENT] - 0.5 * (weights + weights_end) - liquid.centre_height * centred
    # what flows down the tilted bottom are the fluxes of mass, what gravity drives there are the cells' own flows
    flown = 0.5 * step * (GAMMA * momentum + momentum_halfway + (1.0 - GAMMA) * momentum_in_tank(model, cells))
    push[LOSS] -= apart * turn + pitch * (liquid.gravity * flown - (weights_end - weights))
    return True


@inner_kernel
def settle_cells(state, step):
    """Accept the liquid's `step`: its end is the next start, what is owed is left for the next one.

    The largest depth (m) of any cell so far is kept; above the roof it is a head of pressure.
    """
    copy_cells(state.cells_end, state.cells_start)
    for i in range(state.cells_end.depth.size):
        state.push[DEEPEST] = max(state.push[DEEPEST], state.cells_end.depth[i])
    state.push[LAST_STEP] = step
    state.push[START_FORCE], state.push[START_MOMENT] = state.push[END_FORCE], state.push[END_MOMENT]
    state.push[LEFT_FORCE] = state.push[OWED_FORCE]
    state.push[LEFT_MOMENT] = state.push[OWED_MOMENT]


@inner_kernel
def missed_speed(model, push, step, allowed):
    """Speed (m/s) that the wagon, with the liquid that follows it, lacks by what the push of `step` (s) misses.

    That is what the push then owes, unless earlier steps left more than is `allowed` (m/s) as the wagon is followed
    now: no step, however short, could mend that, and the step's own miss counts.
    """
    lightness = _at_centre(model, model.tank_push) + model.shallow.centre_height * _at_centre(model, model.tank_turn)
    by_impulse = model.tank_push[0] / (1.0 + push[FOLLOWING] * lightness)
    missed = push[OWED_FORCE]
    if push[FOLLOWING] > 0.0 or abs(push[LEFT_FORCE]) * by_impulse > allowed:
        missed -= push[LEFT_FORCE] * (1.0 - step / max(step, push[LAST_STEP]))
    return abs(missed) * by_impulse


@inner_kernel
def cells_energy(model, cells, point):
    """Kinetic and potential energy (J) of the liquid, in the track's frame."""
    liquid = model.shallow
    speed, pitch = tank_speed(model, point), point.q[CAR_PITCH]
    kinetic, potential = liquid_energy_in_tank(liquid, cells.area, cells.flow, cells.depth)
    kinetic += speed * momentum_in_tank(model, cells) + 0.5 * liquid.mass * speed * speed
    tilt = 0.5 * liquid.mass * liquid.gravity * liquid.centre_height * pitch
    return kinetic, potential - (_weights_moment(liquid, cells) + tilt) * pitch


@inner_kernel
def cells_rise(model, cells):
    """Rise (m) of the surface over the still level at the front and at the rear wall, at most to the roof."""
    liquid = model.shallow
    if liquid.cells == 0:
        return 0.0, 0.0
    roof, still = liquid.table.roof, liquid.still_depth
    return min(cells.depth[liquid.cells - 1], roof) - still, min(cells.depth[0], roof) - still
