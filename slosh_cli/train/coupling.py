"""The couplings of a train: rate-independent friction springs with damping (theory section 16).

The force of a coupling's spring follows its compression with `transition` (N/m), but stays between two branches: the
upper one is followed as the neighbours run up, the lower one as they part. A spring whose branches are one is elastic.
"""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel
from slosh_cli.method import DIAGONAL, END, MIDDLE, OUTER, START, step_extremes
from slosh_cli.scenario.schema_train import Branch, Coupling

_ON_A_BRANCH = 1e-9
"""A spring is on a branch when it is this close to it, as a part of how far the branches are apart."""
_RATE_SHARE = 1e-2
"""Of a rate of compression (m/s) in an event's value: springs that turn slower than 1e-4 m/s need no step's end, as the
part of the compression that they miss is below 1e-7 m."""

COUPLING_COLUMNS = 2
"""Numbers at the end of a row of the history: force and compression of the coupling behind the vehicle."""


@inner_kernel
def _branch(places, forces, compression):
    """Force (N) and stiffness (N/m) at a compression (m) on the straight lines through a branch's points, of which the
    first and the last go on."""
    last = len(places) - 1
    k = 0
    while k < last - 1 and compression >= places[k + 1]:
        k += 1
    slope = (forces[k + 1] - forces[k]) / (places[k + 1] - places[k])
    return forces[k] + slope * (compression - places[k]), slope


class Couplings(Block):
    """The couplings of a train from the front, all alike; forces (N) are those of whole couplings, positive when they
    push. None make a single vehicle.

    `upper_places` (m) and `upper_forces` (N) are the points of the upper branch, (points,) each, those of the lower
    one likewise; `transition` N/m, `damping` N s/m. `origin` (couplings,) is how far apart the coupling points of
    neighbours are in their coordinates when they touch, m. `compression` m, `rate` m/s, `spring` N (without damping)
    and `force` N are at the stages of a step, (3, couplings). Of the run: `taken` J, the work that they took, with what
    it was before the step in hand; `least`, `largest` N with their instants (s), `nearest`, `farthest` m; (couplings,).
    `turning`, `turning_before` are the values of the events at which springs turn back. `half` says what part of a
    coupling's force acts on the vehicles as they are modelled. The rest is work space.
    """

    upper_places: Vector
    upper_forces: Vector
    lower_places: Vector
    lower_forces: Vector
    transition: float
    damping: float
    half: float
    origin: Vector
    compression: Matrix
    rate: Matrix
    spring: Matrix
    force: Matrix
    taken: Vector
    taken_before: Vector
    least: Vector
    largest: Vector
    least_time: Vector
    largest_time: Vector
    nearest: Vector
    farthest: Vector
    directions: Integers
    turning: Vector
    turning_before: Vector
    gap: Vector
    stiffness: Vector
    ratio: Vector

    @inner_kernel
    def follow(self, coupling, stage, compression, rate):
        """Take a coupling's spring to a `compression` (m) at a stage, where it has a `rate` (m/s): the force (N), and
        its derivatives by both. The way there is the one from the stage before."""
        before = max(stage - 1, 0)
        high, by_high = _branch(self.upper_places, self.upper_forces, compression)
        low, by_low = _branch(self.lower_places, self.lower_forces, compression)
        moved = compression - self.compression[before, coupling]
        spring, slope = self.spring[before, coupling] + self.transition * moved, self.transition
        if spring >= high:
            spring, slope = high, by_high
        elif spring <= low:
            spring, slope = low, by_low
        if stage > 0:
            self.compression[stage, coupling], self.spring[stage, coupling] = compression, spring
            self.rate[stage, coupling] = rate
        return spring + self.damping * rate, slope, self.damping

    @inner_kernel
    def keep_turning(self):
        """Note at the start of a step which springs are on a branch that they leave when they turn back, 1 for the
        upper and -1 for the lower one, and the values of these events there."""
        for j in range(self.directions.size):
            place, spring = self.compression[0, j], self.spring[0, j]
            high, _ = _branch(self.upper_places, self.upper_forces, place)
            low, _ = _branch(self.lower_places, self.lower_forces, place)
            close = _ON_A_BRANCH * (high - low)
            self.directions[j] = 0
            if close > 0.0 and spring >= high - close:
                self.directions[j] = 1
            elif close > 0.0 and spring <= low + close:
                self.directions[j] = -1
        self.read_turning(START)
        for j in range(self.directions.size):
            self.turning_before[j] = self.turning[j]

    @inner_kernel
    def read_turning(self, stage):
        """Values, at a stage, of the events that springs turn back: their rate as long as they go on, else one."""
        for j in range(self.directions.size):
            way = self.directions[j]
            self.turning[j] = _RATE_SHARE * way * self.rate[stage, j] if way != 0 else 1.0

    @inner_kernel
    def settle(self, step):
        """Add the work of a `step` (s) that is accepted, by the method's own weights; what they took (J)."""
        total = 0.0
        for j in range(self.taken.size):
            work = OUTER * (self.force[START, j] * self.rate[START, j] + self.force[MIDDLE, j] * self.rate[MIDDLE, j])
            self.taken_before[j] = self.taken[j]
            self.taken[j] += step * (work + DIAGONAL * self.force[END, j] * self.rate[END, j])
            total += self.taken[j]
        return total

    @inner_kernel
    def accept(self, time):
        """Note the extremes of the step that ends at `time` (s), and let its end be the next start."""
        for j in range(self.taken.size):
            low, high = step_extremes(self.force[START, j], self.force[MIDDLE, j], self.force[END, j])
            if low < self.least[j]:
                self.least[j], self.least_time[j] = low, time
            if high > self.largest[j]:
                self.largest[j], self.largest_time[j] = high, time
            near, far = step_extremes(self.compression[START, j], self.compression[MIDDLE, j], self.compression[END, j])
            self.nearest[j], self.farthest[j] = max(self.nearest[j], far), min(self.farthest[j], near)
            self.compression[START, j], self.rate[START, j] = self.compression[END, j], self.rate[END, j]
            self.spring[START, j], self.force[START, j] = self.spring[END, j], self.force[END, j]

    @inner_kernel
    def record(self, coupling, row, cubic, parabola):
        """Put a coupling's force and compression within the step at the end of its leading vehicle's `row`; the weights
        are those of `method.hermites` and `method.parabolas`."""
        force, place, rate = self.force, self.compression, self.rate
        row[row.size - 2] = (
            parabola[0] * force[START, coupling]
            + parabola[1] * force[MIDDLE, coupling]
            + parabola[2] * force[END, coupling]
        )
        row[row.size - 1] = (
            cubic[0] * place[START, coupling]
            + cubic[1] * rate[START, coupling]
            + cubic[2] * place[END, coupling]
            + cubic[3] * rate[END, coupling]
        )


def couplings(coupling: Coupling | None, origin: Vector, half: float) -> Couplings:
    """Couplings that touch where their neighbours' coupling points are `origin` (couplings,) m apart; the vehicles are
    modelled as `half` of themselves. None have no law."""
    count = len(origin)
    upper, lower, transition, damping = _law(coupling)
    stages = {name: np.zeros((3, count)) for name in ("compression", "rate", "spring", "force")}
    return Couplings.blank(
        count,
        upper_places=upper[0],
        upper_forces=upper[1],
        lower_places=lower[0],
        lower_forces=lower[1],
        transition=transition,
        damping=damping,
        half=half,
        origin=np.array(origin),
        **stages,
    )


def _law(coupling: Coupling | None) -> tuple[Matrix, Matrix, float, float]:
    """The points (m, N) of the upper and the lower branch, (2, points) each; transition N/m, damping N s/m."""
    if coupling and coupling.compression and coupling.tension:
        push, pull = coupling.compression, coupling.tension
        upper, lower = _joined(pull.unloading, push.loading), _joined(pull.loading, push.unloading)
        return upper, lower, coupling.transition_stiffness, coupling.damping
    stiffness = coupling.linear.stiffness if coupling and coupling.linear else 0.0
    line = np.array([[-1.0, 1.0], [-stiffness, stiffness]])
    return line, line, stiffness, coupling.linear.damping if coupling and coupling.linear else 0.0


def _joined(tension: Branch, compression: Branch) -> Matrix:
    """One branch (2, points) of the tables of tension, mirrored, and of compression, which share (0, 0)."""
    return np.concatenate([-np.array(tension)[:0:-1], np.array(compression)]).T
