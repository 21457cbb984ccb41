"""The brake of a vehicle: the torque that each wheel's brake can hold (theory sections 8 and 12).

A brake is a block with these kernels: `torque(wheel, time, spin)`, the torque (N m) that the brake of a wheel can hold
or apply at a time (s) and a spin (rad/s), with its derivative by the spin (N m s/rad); `next_break()`, the time (s) of
the next kink or jump of the torque, where steps end, infinite when there is none; `pass_break()`, which goes beyond
it; `is_on()`, true from the onset on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from slosh_cli.arrays import Array, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel
from slosh_cli.scenario import Scenario

CONSTANT, CAST_IRON, COMPOSITE, TABLE = range(4)
"""Laws of the friction of a brake."""
_KM_H = 3.6  # of a metre per second
_REACHED = 0.95  # share of the full force at a filling's `time_95`


@inner_kernel
def _ratio(a, b, c, d, x):
    """`(a x + b)/(c x + d)` and its derivative by `x`."""
    below = c * x + d
    return (a * x + b) / below, (a * d - b * c) / (below * below)


@inner_kernel
def _between(places, values, x):
    """The value and slope at `x` of the straight lines through a table, which is constant beyond its ends."""
    last = len(places) - 1
    if x < places[0] or last == 0:
        return values[0], 0.0
    if x >= places[last]:
        return values[last], 0.0
    k = np.searchsorted(places, x, side="right") - 1
    slope = (values[k + 1] - values[k]) / (places[k + 1] - places[k])
    return values[k] + slope * (x - places[k]), slope


class Brake(Block):
    """`count` shoes or friction faces per wheel, each pressed with `force` (N) at full application.

    Friction acts at `arm` (m) from the axis; a constant torque is that `count` with a force, an arm and a friction of
    1. `law` is one of this module's; `speeds` (km/h) and `frictions` (points,) are its table, one point where it is
    constant. Between `starts` (stretches,) s the application is `base + slope tau + amplitude exp(-rate tau)` with
    `tau` the time since the stretch's start; `breaks` counts the starts passed, so both sides of a jump are exact.
    """

    count: float
    force: float
    arm: float
    radius: float
    law: int
    speeds: Vector
    frictions: Vector
    starts: Vector
    base: Vector
    slope: Vector
    amplitude: Vector
    rate: Vector
    breaks: int

    @inner_kernel
    def application(self, time):
        """The part of the full force that presses at `time` (s)."""
        if self.breaks == 0:
            return 0.0
        k = self.breaks - 1
        since = time - self.starts[k]
        share = self.base[k] + self.slope[k] * since
        if self.amplitude[k] != 0.0:
            share += self.amplitude[k] * math.exp(-self.rate[k] * since)
        return share

    @inner_kernel
    def friction(self, speed, force):
        """Friction at a tread's `speed` (m/s) under a `force` (N), and its derivative by the speed (s/m)."""
        v, pressed = max(_KM_H * speed, 0.0), 1e-3 * force
        if self.law == CAST_IRON:
            by_speed, slope = _ratio(1.0, 100.0, 5.0, 100.0, v)
            factor = 0.6 * (1.62 * pressed + 100.0) / (8.1 * pressed + 100.0)
        elif self.law == COMPOSITE:
            by_speed, slope = _ratio(1.0, 150.0, 2.0, 150.0, v)
            factor = 0.44 * (0.1 * pressed + 20.0) / (0.4 * pressed + 20.0)
        else:
            by_speed, slope = _between(self.speeds, self.frictions, v)
            factor = 1.0
        return factor * by_speed, factor * slope * _KM_H if speed >= 0.0 else 0.0

    @inner_kernel
    def torque(self, wheel, time, spin):
        """Nothing before the onset, then what the friction of the force applied gives."""
        if self.breaks == 0:
            return 0.0, 0.0
        force = self.application(time) * self.force
        friction, by_speed = self.friction(self.radius * spin, force)
        pull = self.count * force * self.arm
        return pull * friction, pull * by_speed * self.radius

    @inner_kernel
    def next_break(self):
        """The start of the next stretch, as long as one is to come."""
        return self.starts[self.breaks] if self.breaks < len(self.starts) else math.inf

    @inner_kernel
    def pass_break(self):
        """Let the next stretch begin."""
        self.breaks += 1

    @inner_kernel
    def is_on(self):
        """Whether the brake has set in."""
        return self.breaks > 0


@dataclass(frozen=True, eq=False)
class Application:
    """The stretches of an application, (stretches,) each: `starts` s from the onset, else as `Brake` has them."""

    starts: Array
    base: Array
    slope: Array
    amplitude: Array
    rate: Array

    @classmethod
    def step(cls) -> Application:
        """All of it at once."""
        return cls._stretches((0.0, 1.0, 0.0, 0.0, 0.0))

    @classmethod
    def linear(cls, time: float) -> Application:
        """Evenly within `time` (s)."""
        return cls.table([(0.0, 0.0), (time, 1.0)])

    @classmethod
    def filling(cls, time_95: float, delay: float = 0.0, jump: float = 0.1) -> Application:
        """Nothing for `delay` (s), `jump` at once, then ever slower, with 0.95 at `time_95` (s)."""
        rate = math.log((1.0 - jump) / (1.0 - _REACHED)) / (time_95 - delay)
        filled = (delay, 1.0, 0.0, jump - 1.0, rate)
        return cls._stretches((0.0, 0.0, 0.0, 0.0, 0.0), filled) if delay > 0.0 else cls._stretches(filled)

    @classmethod
    def table(cls, points: list[tuple[float, float]]) -> Application:
        """Straight lines through points of rising time since the onset (s) and share; constant after the last.

        Before a first point later than the onset nothing is applied.
        """
        rows = [
            (start, share, (after - share) / (end - start), 0.0, 0.0)
            for (start, share), (end, after) in pairwise(points)
        ]
        rows.append((*points[-1], 0.0, 0.0, 0.0))
        return cls._stretches(*([] if points[0][0] == 0.0 else [(0.0, 0.0, 0.0, 0.0, 0.0)]), *rows)

    @classmethod
    def _stretches(cls, *rows: tuple[float, float, float, float, float]) -> Application:
        return cls(*np.array(rows).T)

    def reduced(self, share: float) -> Application:
        """`share` of this application, as a load changeover leaves to an empty wagon."""
        return replace(self, base=share * self.base, slope=share * self.slope, amplitude=share * self.amplitude)

    def brake(self, torque: float, onset: float) -> Brake:
        """The brake that applies a constant `torque` (N m per wheel) so from the `onset` (s) on."""
        constant: dict[str, Any] = {"law": CONSTANT, "speeds": np.zeros(1), "frictions": np.ones(1)}
        return Brake(count=torque, force=1.0, arm=1.0, radius=0.0, breaks=0, **constant, **self.fields(onset))

    def fields(self, onset: float) -> dict[str, Any]:
        """The fields of a brake that sets in at `onset` (s)."""
        given = {name: getattr(self, name) for name in ("base", "slope", "amplitude", "rate")}
        return {"starts": onset + self.starts} | given


def brake_of(scenario: Scenario) -> Brake:
    """The brake of a scenario's wagon, not yet applied."""
    return Application.step().brake(scenario.brake_torque(0.0), scenario.braking.onset)
