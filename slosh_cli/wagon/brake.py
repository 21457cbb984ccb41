"""The brake of a vehicle: the torque that each wheel's brake can hold (theory sections 8, 12 and 13).

A brake is a block with these kernels: `torque(wheel, time, spin)`, the torque (N m) that the brake of a wheel can hold
or apply at a time (s) and a spin (rad/s), with its derivative by the spin (N m s/rad); `next_break()`, the time (s) of
the next kink or jump of the torque, where steps end, infinite when there is none; `pass_break(time, v, first_spin)`,
which goes beyond it with the vehicle's velocities `v`, and tells whether the torque has a kink or a jump there;
`is_on()`, true from the onset on; for the history `application(time)` and `share(wheel, time)`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel, kernel
from slosh_cli.friction import cast_iron, composite
from slosh_cli.scenario import Scenario
from slosh_cli.wagon.torque import changeover_share, constant_torque

if TYPE_CHECKING:
    from slosh_cli.scenario.schema_application import SlideProtection, Stretches

LAWS = ("table", "cast-iron", "composite")
"""Laws of friction in the order of a brake's `law`."""
_TABLE, _CAST_IRON, _COMPOSITE = range(3)
_cast_iron = inner_kernel(cast_iron)
_composite = inner_kernel(composite)
_FILL, _HOLD, _VENT = range(3)  # what slide protection does with a wheel
_KM_H = 3.6  # of a metre per second
_STEP = ((0.0, 1.0, 0.0, 0.0, 0.0),)


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
    """`count` blocks or friction faces per wheel, each pressed with `force` (N) at full application.

    Friction acts at `arm` (m) from the axis of a wheel of `radius` (m); a constant torque is that `count` with a force,
    an arm and a friction of 1. `law` is a place in `LAWS`; `speeds` (km/h) and `frictions` (points,) are its table, one
    point where it is constant. Between `starts` (stretches,) s the application is
    `base + slope tau + amplitude exp(-rate tau)` with `tau` the time since the stretch's start; `breaks` counts the
    starts passed, so both sides of a jump are exact.

    Slide protection looks at the slip of every wheel each `period` (s), infinite without it, next at `next_sample` (s).
    Since `sampled` (s) it does with each wheel what its `mode` says, from the share `held` on; `vents` counts how
    often it began to vent, `air` sums the shares vented (wheels,).
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
    period: float
    hold_above: float
    vent_above: float
    release_speed: float
    fill_time: float
    vent_time: float
    next_sample: float
    sampled: float
    mode: Integers
    held: Vector
    vents: Integers
    air: Vector

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
    def share(self, wheel, time):
        """The part of it that slide protection leaves to a `wheel` at `time` (s)."""
        held, mode = self.held[wheel], self.mode[wheel]
        if mode == _VENT:
            return held * math.exp((self.sampled - time) / self.vent_time)
        if mode == _HOLD or held == 1.0:
            return held
        return 1.0 - (1.0 - held) * math.exp((self.sampled - time) / self.fill_time)

    @inner_kernel
    def friction(self, speed, force):
        """Friction at a tread's `speed` (m/s) under a `force` (N), and its derivative by the speed (s/m)."""
        v, pressed = max(_KM_H * speed, 0.0), 1e-3 * force
        if self.law == _CAST_IRON:
            value, slope = _cast_iron(v, pressed)
        elif self.law == _COMPOSITE:
            value, slope = _composite(v, pressed)
        else:
            value, slope = _between(self.speeds, self.frictions, v)
        return value, _KM_H * slope if speed >= 0.0 else 0.0

    @inner_kernel
    def torque(self, wheel, time, spin):
        """Nothing before the onset, then what the friction of the force applied gives."""
        if self.breaks == 0:
            return 0.0, 0.0
        force = self.application(time) * self.share(wheel, time) * self.force
        value, by_speed = self.friction(self.radius * spin, force)
        pull = self.count * force * self.arm
        return pull * value, pull * by_speed * self.radius

    @inner_kernel
    def next_break(self):
        """The start of the next stretch or the next look at the slip, whichever is to come first."""
        start = self.starts[self.breaks] if self.breaks < len(self.starts) else math.inf
        return min(start, self.next_sample)

    @inner_kernel
    def pass_break(self, time, v, first_spin):
        """Let the next stretch begin where it is due, and look at the slip where that is."""
        kinks = False
        if self.breaks < len(self.starts) and time >= self.starts[self.breaks]:
            self.breaks += 1
            kinks = True
        if time >= self.next_sample:
            self.next_sample += self.period
            kinks = self.sample(time, v, first_spin) or kinks
        return kinks

    @inner_kernel
    def sample(self, time, v, first_spin):
        """Choose what is done with each wheel from now on; whether that is another thing than before for any."""
        changed, speed = False, v[0]
        for i in range(len(self.mode)):
            share, before, mode = self.share(i, time), self.mode[i], _FILL
            if before == _VENT:
                self.air[i] += self.held[i] - share
            self.held[i] = share
            if speed >= self.release_speed and speed > 0.0:
                slip = 1.0 - self.radius * v[first_spin + i] / speed
                mode = _VENT if slip > self.vent_above else _HOLD if slip > self.hold_above else _FILL
            if mode == _VENT and before != _VENT:
                self.vents[i] += 1
            self.mode[i] = mode
            changed = changed or mode != before
        self.sampled = time
        return changed

    @inner_kernel
    def is_on(self):
        """Whether the brake has set in."""
        return self.breaks > 0


@kernel
def frictions_of(brake: Brake, applied: Vector, shares: Matrix, speeds: Matrix, found: Matrix) -> None:
    """Friction of each wheel, `found` (rows, wheels), under the parts `applied` (rows,) and `shares` of the force."""
    for row in range(len(applied)):
        for i in range(found.shape[1]):
            force = applied[row] * shares[row, i] * brake.force
            found[row, i] = brake.friction(speeds[row, i], force)[0]


@kernel
def holding_torque(brake: Brake, wheel: int, time: float) -> float:
    """Torque (N m) that the brake of a `wheel` at rest can hold at `time` (s)."""
    torque: float = brake.torque(wheel, time, 0.0)[0]
    return torque


def torque_brake(torque: float, onset: float, stretches: Stretches = _STEP, wheels: int = 4, **given: Any) -> Brake:
    """A brake, not yet applied, that can hold a constant `torque` (N m per wheel) from the `onset` (s) on.

    `stretches` say how it builds up; other fields of the brake may be given.
    """
    starts, base, slope, amplitude, rate = np.array(stretches).T
    build_up: dict[str, Any] = {"starts": onset + starts, "base": base, "slope": slope}
    build_up |= {"amplitude": amplitude, "rate": rate}
    pressed: dict[str, Any] = {"count": torque, "force": 1.0, "arm": 1.0, "held": np.ones(wheels)}
    idle: dict[str, Any] = {"speeds": np.zeros(1), "frictions": np.ones(1), "air": np.zeros(wheels)}
    idle |= {"mode": np.zeros(wheels, np.int64), "vents": np.zeros(wheels, np.int64)}
    idle |= {"period": math.inf, "next_sample": math.inf}
    return Brake.blank(**(pressed | idle | build_up | given))


def brake_of(scenario: Scenario) -> Brake:
    """The brake of a scenario's wagon, not yet applied."""
    braking, radius = scenario.braking, scenario.wagon.wheelset.wheel_radius
    left = changeover_share(scenario)
    stretches = tuple(
        (start, left * base, left * slope, left * amplitude, rate)
        for start, base, slope, amplitude, rate in braking.application.stretches
    )
    fields: dict[str, Any] = {"radius": radius, **_protection(braking.slide_protection, braking.onset)}
    if braking.rubbing is None:
        return torque_brake(constant_torque(scenario), braking.onset, stretches, **fields)
    rubbing = braking.rubbing
    law = rubbing.friction
    if law.law == "table":
        fields |= {"speeds": _KM_H * np.array(law.points)[:, 0], "frictions": np.array(law.points)[:, 1]}
    fields |= {"force": rubbing.force, "arm": rubbing.arm(radius), "law": LAWS.index(law.law)}
    return torque_brake(rubbing.count, braking.onset, stretches, **fields)


def _protection(given: SlideProtection | None, onset: float) -> dict[str, float]:
    return {} if given is None else {**vars(given), "next_sample": onset, "sampled": onset}
