"""Forces along the track that act on a vehicle as a whole: running resistance, and gravity on a gradient."""

from __future__ import annotations

from slosh_cli.arrays import Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel


class Line(Block):
    """The running resistance `a + b V + c V^2` of a half vehicle: `resistance` (3,) in N, N s/m and N s^2/m^2; and the
    `pull` (m/s^2) of gravity along the level track, forward, on every mass."""

    resistance: Vector
    pull: float

    @inner_kernel
    def pull_at(self, place):
        """Acceleration (m/s^2) that gravity gives to every mass, forward, where the vehicle stands at a `place` (m)."""
        return self.pull

    @inner_kernel
    def resisting_force(self, speed):
        """Running resistance (N) at `speed` (m/s) and its derivative (N s/m); theory section 8."""
        constant, linear, quadratic = self.resistance[0], self.resistance[1], self.resistance[2]
        return constant + speed * (linear + speed * quadratic), linear + 2.0 * speed * quadratic
