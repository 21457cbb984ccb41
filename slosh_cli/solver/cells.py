"""Coupling of the shallow-water liquid to the wagon, within one step of the integrator.

Over a step the liquid is carried through the tank's own motion (its stage velocities, so that momentum balances to
rounding) and pushes back with its mean force and moment over the step, which enter all stages alike. They are first
estimated by carrying the liquid through the step with the tank's last acceleration; what the estimate misses of the
impulse is handed on, so no impulse is ever lost: to the next step where that is as long, in shares where it is shorter
(a step however short would otherwise have to bear all of it). Places and speeds are of second order in the step
(seen: 2.0 in smooth water, pitch too where bores run). The force's course within a step is not resolved: what
the ledger misses falls with orders 1.5 to 0.7, a bore's arrival at a wall being a jump of the force in any step.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.solver.method import GAMMA
from slosh_cli.tank.section_table import potential_at, stored_level
from slosh_cli.tank.shallow import liquid_energy_in_tank, liquid_evolve
from slosh_cli.track.vectors import copy, fill
from slosh_cli.wagon.coordinates import CAR_PITCH, COORDINATES

# places in State.push
FORCE, MOMENT, LEFT_FORCE, LEFT_MOMENT, OWED_FORCE, OWED_MOMENT, LOSS, DEEPEST, LAST_STEP = range(9)


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
def expect_push(model, scratch, state, step):
    """Estimate the liquid's mean force and moment over the step and let the start's accelerations follow.

    Returns False when the liquid could not be carried through.
    """
    liquid, start, push = model.shallow, state.start, state.push
    acceleration = liquid.centre_height * start.a[CAR_PITCH] - liquid.gravity * (
        start.q[CAR_PITCH] + 0.5 * step * start.v[CAR_PITCH]
    )
    for i in range(COORDINATES):
        acceleration += model.wagon.tank_row[i] * start.a[i]
    copy_cells(state.cells_start, state.cells_end)
    cells, sums = state.cells_end, scratch.cell_sums
    fill(sums, 0.0)
    if not liquid_evolve(liquid, cells.area, cells.flow, cells.depth, acceleration, step, scratch.cell_work, sums):
        return False
    pitch = start.q[CAR_PITCH] + 0.5 * step * start.v[CAR_PITCH]
    paid_over = max(step, push[LAST_STEP])
    force = sums[0] / step + push[LEFT_FORCE] / paid_over - liquid.mass * liquid.gravity * pitch
    moment = sums[1] / step + push[LEFT_MOMENT] / paid_over
    for i in range(COORDINATES):
        start.a[i] += (force - push[FORCE]) * model.tank_push[i] + (moment - push[MOMENT]) * model.tank_turn[i]
    push[FORCE], push[MOMENT] = force, moment
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
    if not liquid_evolve(liquid, cells.area, cells.flow, cells.depth, second, (1.0 - GAMMA) * step, work, sums):
        return False
    impulse = momentum - momentum_in_tank(model, cells) - liquid.mass * (after - before)
    push[OWED_FORCE] = push[LEFT_FORCE] + impulse - step * push[FORCE]
    push[OWED_MOMENT] = push[LEFT_MOMENT] + sums[1] - step * push[MOMENT]
    kinetic_end, potential_end = liquid_energy_in_tank(liquid, cells.area, cells.flow, cells.depth)
    push[LOSS] = sums[2] - (kinetic_end + potential_end - kinetic - potential)
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
    state.push[LEFT_FORCE] = state.push[OWED_FORCE]
    state.push[LEFT_MOMENT] = state.push[OWED_MOMENT]


@inner_kernel
def cells_energy(model, cells, point):
    """Kinetic and potential energy (J) of the liquid, in the track's frame."""
    liquid = model.shallow
    speed, pitch = tank_speed(model, point), point.q[CAR_PITCH]
    kinetic, potential = liquid_energy_in_tank(liquid, cells.area, cells.flow, cells.depth)
    kinetic += speed * momentum_in_tank(model, cells) + 0.5 * liquid.mass * speed * speed
    arm = height = 0.0
    for i in range(liquid.cells):
        arm += cells.area[i] * (i + 0.5 - 0.5 * liquid.cells) * liquid.spacing
        height += potential_at(liquid.table, stored_level(liquid.table, cells.area[i], cells.depth[i]))
    weight = liquid.density * liquid.gravity * liquid.spacing
    return kinetic, potential - weight * (arm * pitch + 0.5 * height * pitch * pitch)


@inner_kernel
def cells_rise(model, cells):
    """Rise (m) of the surface over the still level at the front and at the rear wall, at most to the roof."""
    liquid = model.shallow
    if liquid.cells == 0:
        return 0.0, 0.0
    roof, still = liquid.table.roof, liquid.still_depth
    return min(cells.depth[liquid.cells - 1], roof) - still, min(cells.depth[0], roof) - still
