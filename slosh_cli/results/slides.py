"""Wheels that locked: which, from when, how long, and the flat that they wear (theory section 8)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from slosh_cli.results.validity import Check
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import digits

_STEEL = 7850.0  # kg/m^3
_SEVERE = 55e-9 / 1e-6 / _STEEL
"""Depth worn per metre slid, m/m: 55 ug per m and mm^2, whatever the friction."""
_MILD = 5.3e-9 / _STEEL
"""Volume worn per friction work, m^3/J: 5.3 ug per m and mm^2 and N/mm^2."""
_MILD_UP_TO = 10.4e6
"""Friction per area, Pa, below which wear is mild."""
_STANDING = 1e-3
"""Longest slide, m, of a wheel that locks as its vehicle comes to a stand: it wears nothing."""
_SOURCE = (
    "estimate, not a rule: wear of R8T wheel steel by F. Braghin et al., Wear 261 (2006) 1253-1264 (55 ug per m and "
    "mm^2 above a friction of 10.4 N/mm^2, 5.3 ug per m and N below); a flat cap of depth d has the area 2 pi d "
    "sqrt(R r), the volume pi d^2 sqrt(R r) and the length sqrt(8 R d)"
)


@dataclass(frozen=True)
class Slide:
    """What a locked `wheel` (number from the front) did: locked for `seconds` in all, first at `start` (s) and at a
    `speed` (m/s) of the wagon; its longest slide went over a `distance` (m) and took `work` (J)."""

    wheel: int
    seconds: float
    start: float
    speed: float
    distance: float
    work: float


def slide_check(slides: Sequence[Slide], scenario: Scenario) -> Check:
    """The verdict on the wheels that locked and slid further than it takes to come to a stand."""
    slides = [one for one in slides if one.distance > _STANDING]
    radius, crown = scenario.wagon.wheelset.wheel_radius, scenario.contact.rail_crown_radius
    longest = max((one.seconds for one in slides), default=0.0)
    wheels = ", ".join(_words(one, radius, crown) for one in slides)
    meaning = f"Locked wheels slide on the rail and wear flat: {wheels}. The flats are estimated."
    return Check("locked wheels", "operation", longest, 0.0, meaning, "assumed", _SOURCE)


def _words(one: Slide, radius: float, crown: float) -> str:
    length, depth = flat_of(one.work / one.distance if one.distance > 0.0 else 0.0, one.distance, radius, crown)
    return (
        f"wheel {one.wheel} for {one.seconds:.2f} s (locks {one.start:.2f} s into the run at {one.speed:.2f} m/s, "
        f"slides {digits(one.distance, 3)} m at a stretch: a flat of about {digits(1e3 * length, 2)} mm length and "
        f"{digits(1e3 * depth, 1)} mm depth)"
    )


def flat_of(force: float, distance: float, wheel_radius: float, crown_radius: float) -> tuple[float, float]:
    """Length and depth (m) of the flat that a friction `force` (N) wears over a `distance` (m) slid at a stretch.

    The flat takes the shape of the rail's crown, which is ever new while the wheel stays the same: a cap whose area
    grows with its depth. Wear is severe, at the same rate on every area, until the friction per area is low.
    """
    spread = 2.0 * math.pi * math.sqrt(wheel_radius * crown_radius)
    depth, turn = _SEVERE * distance, force / (_MILD_UP_TO * spread)
    if depth > turn:
        depth = math.sqrt(turn**2 + 2.0 * _MILD * force * (distance - turn / _SEVERE) / spread)
    return math.sqrt(8.0 * wheel_radius * depth), depth
