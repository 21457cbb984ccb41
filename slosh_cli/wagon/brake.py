"""The brake of a vehicle: a law of the torque that each wheel's brake can hold.

A kind of brake is a block with these kernels: `torque(wheel, time, spin)`, the torque (N m) that the brake of a wheel
can hold or apply at a time (s) and a spin (rad/s), with its derivative by the spin (N m s/rad); `next_break()`, the
time (s) of the next discontinuity of the torque, where steps end, infinite when there is none; `pass_break()`, which
goes beyond it; `is_on()`, true from the onset on.
"""

from __future__ import annotations

import math

from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel
from slosh_cli.scenario import Scenario


class StepBrake(Block):
    """A constant torque `full` (N m per wheel) from the `onset` (s) on; `breaks` counts those passed."""

    full: float
    onset: float
    breaks: int

    @inner_kernel
    def torque(self, wheel, time, spin):
        """Nothing before the onset, then `full`."""
        return (self.full if self.breaks > 0 else 0.0), 0.0

    @inner_kernel
    def next_break(self):
        """The onset, as long as it is to come."""
        return self.onset if self.breaks == 0 else math.inf

    @inner_kernel
    def pass_break(self):
        """Let the next stretch begin."""
        self.breaks += 1

    @inner_kernel
    def is_on(self):
        """Whether the brake has set in."""
        return self.breaks > 0


def brake_of(scenario: Scenario) -> StepBrake:
    """The brake of a scenario's wagon, not yet applied."""
    return StepBrake.blank(full=scenario.brake_torque(0.0), onset=scenario.braking.onset)
