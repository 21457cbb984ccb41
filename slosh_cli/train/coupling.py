"""The couplings of a train: rate-independent friction springs with damping (theory section 16).

The force of a coupling's spring follows its compression with `transition` (N/m), but stays between two branches: the
upper one is followed as the neighbours run up, the lower one as they part. A spring whose branches are one is elastic.
"""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel
from slosh_cli.method import DIAGONAL, END, MIDDLE, OUTER, START, step_extremes
from slosh_cli.scenario.schema_train import Branch, Coupling

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
    one likewise; `transition` N/m, `damping` N s/m. `half` says what part of a coupling's force acts on the vehicles as
    they are modelled; `rubs` is 1 where the branches differ. `origin` (couplings,) is how far apart the coupling points
    of neighbours are in their coordinates when they touch, m. `compression` m, `rate` m/s, `spring` N (without damping)
    and `force` N are at the stages of a step, (3, couplings), `turn` N where a spring turned back on the way there. Of
    the run: `taken` J, the work that they took, with what it was before the step in hand; `least`, `largest` N with
    their instants (s), `nearest`, `farthest` m; (couplings,). The rest is work space.
    """

    upper_places: Vector
    upper_forces: Vector
    lower_places: Vector
    lower_forces: Vector
    transition: float
    damping: float
    half: float
    rubs: int
    origin: Vector
    compression: Matrix
    rate: Matrix
    spring: Matrix
    force: Matrix
    turn: Matrix
    taken: Vector
    taken_before: Vector
    least: Vector
    largest: Vector
    least_time: Vector
    largest_time: Vector
    nearest: Vector
    farthest: Vector
    gap: Vector
    stiffness: Vector
    ratio: Vector

    @inner_kernel
    def follow(self, coupling, stage, apart, compression, rate):
        """Take a coupling's spring to a `compression` (m) at a stage, where it has a `rate` (m/s): the force (N), and
        its derivatives by both. The way there is the one from the stage before, `apart` s ago.

        Where the rate changes its sign on that way the spring first goes to where it turns back: at the end of a rate
        that changes evenly.
        """
        before = max(stage - 1, 0)
        place, spring, rate_before = (
            self.compression[before, coupling],
            self.spring[before, coupling],
            self.rate[before, coupling],
        )
        slope, by_rate = self.transition, 0.0
        if rate_before * rate < 0.0:
            change = rate_before - rate
            turn = compression + 0.5 * apart * rate * rate / change
            by_rate = 0.5 * apart * rate * (rate_before + change) / (change * change)
            spring, slope = self._pulled(spring, turn - place, turn)
            place = turn
        turned = spring
        spring, last = self._pulled(spring, compression - place, compression)
        if last == self.transition:
            by_rate *= slope - self.transition
        else:
            slope, by_rate = last, 0.0
        if stage > 0:
            self.compression[stage, coupling], self.spring[stage, coupling] = compression, spring
            self.rate[stage, coupling], self.turn[stage, coupling] = rate, turned
        return spring + self.damping * rate, slope, self.damping + by_rate

    @inner_kernel
    def _pulled(self, spring, moved, compression):
        """Force (N) of a spring `moved` (m) one way to a `compression` (m), and the stiffness there (N/m)."""
        high, by_high = _branch(self.upper_places, self.upper_forces, compression)
        low, by_low = _branch(self.lower_places, self.lower_forces, compression)
        spring += self.transition * moved
        if spring >= high:
            return high, by_high
        if spring <= low:
            return low, by_low
        return spring, self.transition

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
    def _extremes(self, coupling):
        """Least and largest force (N) of a coupling in the step in hand.

        A spring with friction goes from stage to stage one way, but for where it turns back.
        """
        start, middle, end = self.force[START, coupling], self.force[MIDDLE, coupling], self.force[END, coupling]
        if self.rubs == 0:
            return step_extremes(start, middle, end)
        one, two = self.turn[MIDDLE, coupling], self.turn[END, coupling]
        return min(start, one, middle, two, end), max(start, one, middle, two, end)

    @inner_kernel
    def accept(self, time):
        """Note the extremes of the step that ends at `time` (s), and let its end be the next start."""
        for j in range(self.taken.size):
            low, high = self._extremes(j)
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
        low, high = self._extremes(coupling)
        between = (
            parabola[0] * force[START, coupling]
            + parabola[1] * force[MIDDLE, coupling]
            + parabola[2] * force[END, coupling]
        )
        row[row.size - 2] = min(max(between, low), high)
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
    stages = {name: np.zeros((3, count)) for name in ("compression", "rate", "spring", "force", "turn")}
    return Couplings.blank(
        count,
        upper_places=upper[0],
        upper_forces=upper[1],
        lower_places=lower[0],
        lower_forces=lower[1],
        transition=transition,
        damping=damping,
        half=half,
        rubs=int(not np.array_equal(upper, lower)),
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
