"""The stop: speeds, the torque of the brake at full application, and how it is applied (theory sections 8, 12, 13)."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated, Final

from pydantic import Field

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Number, Quantity, Range
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.schema_application import (
    REACHED,
    Application,
    FillingApplication,
    LinearApplication,
    LoadChangeover,
    SlideProtection,
    StepApplication,
)
from slosh_cli.scenario.schema_friction import KM_H, Blocks, Discs
from slosh_cli.scenario.units import shown

_BRAKED_DISTANCES: Final = {
    100.0: (52840.0, 10.0),
    120.0: (83634.0, 19.0),
    140.0: (119179.0, 19.0),
    160.0: (161280.0, 19.0),
}
"""C and D of `S = C/(lambda + D)`, m and per cent, by speed in km/h: UIC 544-1, EN 16834, single vehicle."""
_PERCENTAGES: Final = Range(10.0, 300.0)


def braked_percentage(speed: float, distance: float) -> float | None:
    """The braked weight percentage whose distance from `speed` (m/s) is `distance` (m), `C/S - D`.

    None where no such percentage is defined: at another speed, or beyond those that a wagon can have.
    """
    for known, (constant, added) in _BRAKED_DISTANCES.items():
        if abs(KM_H * speed - known) < 1e-6:
            found = constant / distance - added
            return found if found in _PERCENTAGES else None
    return None


def _known_speed(v: Values) -> Iterator[Finding]:
    if v.has("speed") and min(abs(KM_H * v["speed"] - known) for known in _BRAKED_DISTANCES) > 1e-6:
        rule = "must be 100, 120, 140 or 160 km/h, the speeds at which braked weights are defined (UIC 544-1)"
        yield Finding(("speed",), rule, f"`{shown(KM_H * v['speed'])} km/h`", "write one of them")


class _BrakedWeight(Part):
    """The braked weight percentage on the wagon's sign, lambda."""

    rules = (_known_speed,)

    percentage: Annotated[float, Number(_PERCENTAGES, "65")] = Field(
        description="Braked weight over the wagon's mass, per cent."
    )
    speed: Annotated[float, Quantity("speed", Range(25.0, 50.0), "100 km/h")] = Field(
        description="The speed it is told for: 100, 120, 140 or 160 km/h, m/s."
    )

    @property
    def distance(self) -> float:
        """The distance (m) in which a single wagon stops from `speed`: `C/(lambda + D)`."""
        constant, added = _BRAKED_DISTANCES[round(KM_H * self.speed)]
        return constant / (self.percentage + added)


class Braking(Part):
    """The stop."""

    exactly_one = (("torque", "blocks", "discs", "deceleration", "braked_weight"),)

    initial_speed: Annotated[float, Quantity("speed", Range(0.01, 150.0), "80 km/h")] = Field(
        description="Speed at the start of the run, m/s."
    )
    torque: Annotated[float | None, Quantity("torque", Range(0.0, 1e6), "5 kN m")] = Field(
        default=None, description="Brake torque per wheel at full application, N m (a wheelset has two wheels)."
    )
    blocks: Blocks | None = Field(default=None, description="Brake blocks, in place of the torque.")
    discs: Discs | None = Field(default=None, description="Brake discs, in place of the torque.")
    deceleration: Annotated[float | None, Quantity("acceleration", Range(0.0, 20.0), "0.9 m/s^2")] = Field(
        default=None,
        description="Deceleration of the full brake without resistance and slip, m/s^2, in place of the torque.",
    )
    braked_weight: _BrakedWeight | None = Field(
        default=None, description="Braked weight percentage and the speed it is told for, in place of the torque."
    )
    application: Application = Field(
        default=StepApplication.model_construct(),
        description="How the force builds up: `step`, `P` (95 % after 4 s), `G` (after 24 s), or a mapping with its "
        "form: linear, filling or table.",
    )
    load_changeover: LoadChangeover | None = Field(
        default=None, description="Presses a light wagon less. Default: no changeover."
    )
    slide_protection: SlideProtection | None = Field(
        default=None, description="Wheel slide protection; `{}` has the usual values. Default: none."
    )
    onset: Annotated[float, Quantity("time", Range(0.0, 1e4), "0.5 s")] = Field(
        description="When the brakes set in, after the start of the run, s."
    )
    stop_speed: Annotated[float, Quantity("speed", Range(1e-4, 50.0), "0.02 m/s")] = Field(
        default=0.02, description="The wagon counts as stopped when its speed falls to this, m/s."
    )

    @property
    def rubbing(self) -> Blocks | Discs | None:
        """What rubs, where the brake is told by it."""
        return self.blocks or self.discs

    @property
    def filling_time(self) -> float:
        """From the onset until 95 % of the largest application, s."""
        application = self.application
        if isinstance(application, FillingApplication):
            return application.time_95
        if isinstance(application, LinearApplication):
            return REACHED * application.time
        if isinstance(application, StepApplication):
            return 0.0
        goal = REACHED * max(share for _, share in application.points)
        for (t0, a0), (t1, a1) in pairwise(application.points):
            if a0 < goal <= a1:
                return t0 + (t1 - t0) * (goal - a0) / (a1 - a0)
        return 0.0
