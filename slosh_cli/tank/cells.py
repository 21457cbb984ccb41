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
Methods Appl. Mech. Eng. 194 (2005) 4506-4527). So where it is not small beside it, the added mass is measured, by a
second run of the liquid through the step, and goes into the stages' equations: the push follows the stage's own
acceleration (J. Degroote, Arch. Comput. Methods Eng. 20 (2013) 185-238). Dispersion always has one.
"""

from __future__ import annotations

import math

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.compiled import inner_kernel
from slosh_cli.method import END, GAMMA, MIDDLE, START
from slosh_cli.tank.cell_state import Cells
from slosh_cli.tank.liquid import Slosh
from slosh_cli.tank.shallow import WORK_ROWS, ShallowLiquid, liquid_energy_in_tank, liquid_evolve
from slosh_cli.tank.still import CellColumns
from slosh_cli.tank.surface_record import SurfaceRecord, surface_record
from slosh_cli.vectors import fill

_LOOSE = 0.2
"""A push from the last acceleration will do while waves reach less than this part of what the wagon weighs."""
_LEAST_CHANGE = 1e-3
"""The added mass is measured between two accelerations at least this far apart, m/s^2."""


class CellLiquid(Slosh):
    """The shallow-water liquid of half a tank in a wagon, by `liquid`'s contract.

    `start`, `end` are its cells at a step's ends; `work` (WORK_ROWS, cells + 1) and `sums` (4,) are scratch, `surface`
    is its record. The wagon's accelerations at the still liquid's centre are `by_force` per newton along x at the
    tank's bottom centre and `by_moment` per newton metre on the car's pitch, `along_by_force` is that of the track's
    coordinate.
    The account with the wagon: `force` (N) and `moment` (N m) are means over the step, `start_...`, `end_...` the push
    at its two ends; `following` (kg) is the added mass with which it follows the tank's acceleration, `held_...` the
    push at acceleration 0; `left_...` is owed from earlier steps, `owed_...` with this one (N s, N m s); `loss` (J) is
    what bores took; `deepest` (m) the largest depth of any cell so far, above the roof a head of pressure.
    """

    shallow: ShallowLiquid
    start: Cells
    end: Cells
    work: Matrix
    sums: Vector
    surface: SurfaceRecord
    by_force: float
    by_moment: float
    along_by_force: float
    force: float
    moment: float
    left_force: float
    left_moment: float
    owed_force: float
    owed_moment: float
    loss: float
    deepest: float
    last_step: float
    following: float
    held_force: float
    held_moment: float
    start_force: float
    start_moment: float
    end_force: float
    end_moment: float

    @inner_kernel
    def expect(self, ride, step):
        """Estimate the mean force and moment over the step; False when the liquid could not be carried through."""
        liquid, sums = self.shallow, self.sums
        centre, weight = liquid.centre_height, liquid.mass * liquid.gravity
        pitch = ride.pitch[START] + 0.5 * step * ride.pitch_rate[START]
        acceleration = ride.acceleration[START] + centre * ride.pitch_acceleration[START] - liquid.gravity * pitch
        if not _mean_push(self, acceleration, step):
            return False, 0.0, 0.0
        lightness = self.by_force + centre * self.by_moment
        heaviness = self.start.reached_mass(liquid, step) * lightness
        if heaviness > _LOOSE:
            sums[0] = _whole_impulse(self, acceleration, step)
        paid_over = max(step, self.last_step)
        force = sums[0] / step + self.left_force / paid_over - weight * pitch
        moment = sums[1] / step + self.left_moment / paid_over
        self.following, self.held_force, self.held_moment = liquid.riding, force, moment
        if heaviness > _LOOSE:
            change = (force - self.start_force) * self.by_force + (moment - self.start_moment) * self.by_moment
            if not _follow(self, step, acceleration, change / (1.0 + heaviness), force, moment):
                return False, 0.0, 0.0
        if self.following > 0.0:
            centre_before = ride.acceleration[START] + centre * ride.pitch_acceleration[START]
            taken = (self.held_force - self.start_force) * self.by_force
            taken += (self.held_moment - self.start_moment) * self.by_moment
            taken *= self.following / (1.0 + self.following * lightness)
            force, moment = self.held_force - taken, self.held_moment - centre * taken
            before = self.following * centre_before
            self.held_force += before
            self.held_moment += centre * before
        change_of_force, change_of_moment = force - self.start_force, moment - self.start_moment
        self.start_force, self.start_moment = force, moment
        return True, change_of_force, change_of_moment

    @inner_kernel
    def inertia(self, implicit):
        """The added mass, at the still liquid's centre; without a step (`implicit` 0) there is none."""
        following = self.following if implicit > 0.0 else 0.0
        centre = self.shallow.centre_height
        return following, centre * following, centre * centre * following

    @inner_kernel
    def push(self, base, implicit, pitch, pull):
        """The mean push of the step at acceleration 0, without a step that at the start."""
        if implicit > 0.0:
            led = self.following * pull
            return self.held_force + led, self.held_moment + self.shallow.centre_height * led
        return self.start_force, self.start_moment

    @inner_kernel
    def error(self, step, implicit, speed, pitch, pitch_rate):
        """The added mass alone: what the liquid itself misses is `carry`'s."""
        centre = self.shallow.centre_height
        along = self.following * (speed + centre * pitch_rate)
        return 0.0, along, centre * along

    @inner_kernel
    def carry(self, ride, step, allowed):
        """Carry the liquid through the step as the tank moved; book what the push owes it and what bores took."""
        liquid, sums = self.shallow, self.sums
        centre, gravity, pitch = liquid.centre_height, liquid.gravity, ride.pitch
        self.start.copy_to(self.end)
        cells = self.end
        area, flow, depth = cells.area, cells.flow, cells.depth
        before = ride.speed[START] + centre * ride.pitch_rate[START]
        halfway = ride.speed[MIDDLE] + centre * ride.pitch_rate[MIDDLE]
        after = ride.speed[END] + centre * ride.pitch_rate[END]
        kinetic, potential = liquid_energy_in_tank(liquid, area, flow, depth)
        momentum = cells.momentum(liquid)
        fill(sums, 0.0)
        first = (halfway - before) / (GAMMA * step) - 0.5 * gravity * (pitch[START] + pitch[MIDDLE])
        second = (after - halfway) / ((1.0 - GAMMA) * step) - 0.5 * gravity * (pitch[MIDDLE] + pitch[END])
        first -= 0.5 * (ride.pull[START] + ride.pull[MIDDLE])
        second -= 0.5 * (ride.pull[MIDDLE] + ride.pull[END])
        given = 0.5 * step * (GAMMA * ride.pull[START] + ride.pull[MIDDLE] + (1.0 - GAMMA) * ride.pull[END])
        if not liquid_evolve(liquid, area, flow, depth, first, GAMMA * step, self.work, sums):
            return -1.0
        momentum_halfway = cells.momentum(liquid)
        if not liquid_evolve(liquid, area, flow, depth, second, (1.0 - GAMMA) * step, self.work, sums):
            return -1.0
        momentum_end = cells.momentum(liquid)
        impulse = momentum - momentum_end - liquid.mass * (after - before - given)
        last = self.following * (ride.acceleration[END] + centre * ride.pitch_acceleration[END])
        mean = self.following * ((after - before - given) / step)
        self.force, self.moment = self.held_force - mean, self.held_moment - centre * mean
        self.end_force, self.end_moment = self.held_force - last, self.held_moment - centre * last
        self.owed_force = self.left_force + impulse - step * self.force
        self.owed_moment = self.left_moment + sums[1] - step * self.moment
        kinetic_end, potential_end = liquid_energy_in_tank(liquid, area, flow, depth)
        self.loss = sums[2] - (kinetic_end + potential_end - kinetic - potential)
        # the walls' pressures turn the tank about the still centre, the liquid feels nothing of it (theory section 10)
        mean_pitch, turn = 0.5 * (pitch[START] + pitch[END]), pitch[END] - pitch[START]
        weights, weights_end = self.start.weights_moment(liquid), cells.weights_moment(liquid)
        centred = self.force + liquid.mass * gravity * mean_pitch
        apart = self.moment - 0.5 * (weights + weights_end) - centre * centred
        # what flows down the tilted bottom are the fluxes of mass, what gravity drives there are the cells' own flows
        flown = 0.5 * step * (GAMMA * momentum + momentum_halfway + (1.0 - GAMMA) * momentum_end)
        self.loss -= apart * turn + mean_pitch * (gravity * flown - (weights_end - weights))
        return _missed_speed(self, step, allowed)

    @inner_kernel
    def energy(self, ride, stage):
        """The liquid's energies in the track's frame; before a step's end the cells are those of its start."""
        liquid, cells = self.shallow, self.end if stage == END else self.start
        pitch, speed = ride.pitch[stage], ride.speed[stage] + liquid.centre_height * ride.pitch_rate[stage]
        kinetic, potential = liquid_energy_in_tank(liquid, cells.area, cells.flow, cells.depth)
        kinetic += speed * cells.momentum(liquid) + 0.5 * liquid.mass * speed * speed
        tilt = 0.5 * liquid.mass * liquid.gravity * liquid.centre_height * pitch
        return kinetic, potential - (cells.weights_moment(liquid) + tilt) * pitch, 0.0

    @inner_kernel
    def momentum(self, ride, stage):
        """That of all the liquid, which the wagon does not carry along the track."""
        liquid, cells = self.shallow, self.end if stage == END else self.start
        speed = ride.speed[stage] + liquid.centre_height * ride.pitch_rate[stage]
        return liquid.mass * speed + cells.momentum(liquid)

    @inner_kernel
    def highest(self):
        """At the end of the step."""
        return max(self.end.rise(self.shallow))

    @inner_kernel
    def record(self, row, first, part, cubic, parabola):
        """Force and moment, means over the step, then the rise of the surface at the front and at the rear wall."""
        row[first], row[first + 1] = self.force, self.moment
        (front, rear), (front_end, rear_end) = self.start.rise(self.shallow), self.end.rise(self.shallow)
        row[first + 2], row[first + 3] = (1.0 - part) * front + part * front_end, (1.0 - part) * rear + part * rear_end
        self.surface.note(self.start.area, self.end.area, part)

    @inner_kernel
    def taken(self):
        """What bores took."""
        return self.loss

    @inner_kernel
    def accept(self, step):
        """The end becomes the start; what is owed is left for the next step."""
        self.end.copy_to(self.start)
        for i in range(self.end.depth.size):
            self.deepest = max(self.deepest, self.end.depth[i])
        self.last_step = step
        self.start_force, self.start_moment = self.end_force, self.end_moment
        self.left_force, self.left_moment = self.owed_force, self.owed_moment


def cell_liquid(
    shallow: ShallowLiquid, columns: CellColumns, *, by_force: float, by_moment: float, along_by_force: float
) -> CellLiquid:
    """The liquid whose cells, at rest, are `columns`, in a wagon with the accelerations of `CellLiquid`."""
    return CellLiquid.blank(
        shallow=shallow,
        start=Cells(**dict(zip(("area", "flow", "depth"), columns, strict=True))),
        end=Cells.blank(shallow.cells),
        work=np.zeros((WORK_ROWS, shallow.cells + 1)),
        sums=np.zeros(4),
        surface=surface_record(shallow),
        by_force=by_force,
        by_moment=by_moment,
        along_by_force=along_by_force,
        recorded=4,
    )


@inner_kernel
def _mean_push(self, acceleration, step):
    """Carry the liquid through the step with the tank's constant `acceleration`: its impulses in `sums`.

    Returns False when it could not be carried through.
    """
    cells = self.end
    self.start.copy_to(cells)
    fill(self.sums, 0.0)
    return liquid_evolve(self.shallow, cells.area, cells.flow, cells.depth, acceleration, step, self.work, self.sums)


@inner_kernel
def _whole_impulse(self, acceleration, step):
    """Impulse (N s) of the walls in a step of constant `acceleration`, by what the liquid's momentum lost in it.

    The walls' pressures miss a part of it in cells whose surface is steep, as the section's area is not linear there.
    """
    liquid = self.shallow
    change = self.end.momentum(liquid) - self.start.momentum(liquid)
    return -change - liquid.mass * acceleration * step


@inner_kernel
def _follow(self, step, acceleration, change, force, moment):
    """Measure the added mass between `acceleration`, where `force` and `moment` push, and one changed by `change`.

    Its force acts at the still liquid's centre. Returns False when the liquid could not be carried through.
    """
    liquid, sums = self.shallow, self.sums
    if abs(change) < _LEAST_CHANGE:
        change = math.copysign(_LEAST_CHANGE, change)
    impulse, turning = sums[0], sums[1]
    if not _mean_push(self, acceleration + change, step):
        return False
    answer = (_whole_impulse(self, acceleration + change, step) - impulse) / step
    self.following = min(max(-answer / change, 0.0), liquid.mass)
    self.held_force = force + answer + self.following * change
    self.held_moment = moment + (sums[1] - turning) / step + liquid.centre_height * self.following * change
    return True


@inner_kernel
def _missed_speed(self, step, allowed):
    """Speed (m/s) that the wagon, with the liquid that follows it, lacks by what the push of `step` (s) misses.

    That is what the push then owes, unless earlier steps left more than is `allowed` (m/s) as the wagon is followed
    now: no step, however short, could mend that, and the step's own miss counts.
    """
    lightness = self.by_force + self.shallow.centre_height * self.by_moment
    by_impulse = self.along_by_force / (1.0 + self.following * lightness)
    missed = self.owed_force
    if self.following > 0.0 or abs(self.left_force) * by_impulse > allowed:
        missed -= self.left_force * (1.0 - step / max(step, self.last_step))
    return abs(missed) * by_impulse
