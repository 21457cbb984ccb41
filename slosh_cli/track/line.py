"""Forces along the track that act on a vehicle as a whole: running resistance, and gravity on a gradient."""

from __future__ import annotations

import math

from slosh_cli.arrays import Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel
from slosh_cli.vectors import cell_of

_SHORTEST_WAY = 0.5
"""m; half of the least distance between two points."""


class Line(Block):
    """The running resistance `a + b V + c V^2` of a half vehicle: `resistance` (3,) in N, N s/m and N s^2/m^2; and the
    `pull` (m/s^2) of gravity along the track, forward, on every mass. Where the gradient changes, `pulls` (n,) are
    those at the `places` (n,) m of the vehicle, linear between them (theory section 14). The vehicle starts `behind`
    (m) the one whose places are those of the line.

    A vehicle that may be pushed back opposes that too; below the speed `standing` (m/s) its constant resistance fades.
    It is zero for one that only runs forward.
    """

    resistance: Vector
    pull: float
    places: Vector
    behind: float
    pulls: Vector
    standing: float

    @inner_kernel
    def pull_at(self, place):
        """Acceleration (m/s^2) that gravity gives to every mass, forward, where the vehicle stands at a `place` (m)."""
        places, pulls = self.places, self.pulls
        if places.size < 2:
            return self.pull
        cell = cell_of(places, place)
        part = (place - places[cell]) / (places[cell + 1] - places[cell])
        return pulls[cell] + min(max(part, 0.0), 1.0) * (pulls[cell + 1] - pulls[cell])

    @inner_kernel
    def way_ahead(self, place):
        """Way (m) that a step from a `place` (m) may take: to the next point of the gradient's table."""
        places = self.places
        if places.size < 2 or place >= places[places.size - 1]:
            return math.inf
        following = places[0] if place < places[0] else places[cell_of(places, place) + 1]
        return max(following - place, _SHORTEST_WAY)

    @inner_kernel
    def resisting_force(self, speed):
        """Running resistance (N) at `speed` (m/s) and its derivative (N s/m); theory section 8."""
        constant, linear, quadratic = self.resistance[0], self.resistance[1], self.resistance[2]
        if speed < self.standing > 0.0:
            fading = abs(speed) < self.standing
            part = speed / self.standing if fading else -1.0
            slope = linear + 2.0 * abs(speed) * quadratic + (constant / self.standing if fading else 0.0)
            return part * constant + speed * (linear + abs(speed) * quadratic), slope
        return constant + speed * (linear + speed * quadratic), linear + 2.0 * speed * quadratic
