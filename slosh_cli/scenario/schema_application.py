"""How a brake builds up, and what changes that on the way: load changeover, slide protection (theory sections 12, 13).

A class of an application gives its `stretches` from the onset on; between their starts the application is
`base + slope tau + amplitude exp(-rate tau)`, tau since the stretch's start.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated, Final, Literal, TypeAlias

from pydantic import Field

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Number, Quantity, Range
from slosh_cli.scenario.points import Points
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.schema_friction import KM_H
from slosh_cli.scenario.short import Short
from slosh_cli.scenario.units import at_least, at_most, shown

Stretches: TypeAlias = tuple[tuple[float, float, float, float, float], ...]
"""Of an application: (start s, base, slope 1/s, amplitude, rate 1/s) each."""
REACHED: Final = 0.95
"""Part of the full force at a filling's `time_95`."""


class StepApplication(Part):
    """All of the brake at once, as in the paper."""

    form: Literal["step"] = Field(default="step", description="Application: everything at once.")

    @property
    def stretches(self) -> Stretches:
        """One, of the full force."""
        return ((0.0, 1.0, 0.0, 0.0, 0.0),)


class LinearApplication(Part):
    """A brake that builds up evenly."""

    form: Literal["linear"] = Field(default="linear", description="Application: evenly.")
    time: Annotated[float, Quantity("time", Range(1e-3, 300.0), "4 s")] = Field(
        description="From the onset to the full force, s."
    )

    @property
    def stretches(self) -> Stretches:
        """A ramp and what follows."""
        return ((0.0, 0.0, 1.0 / self.time, 0.0, 0.0), (self.time, 1.0, 0.0, 0.0, 0.0))


def _filled_after_delay(v: Values) -> Iterator[Finding]:
    if v.has("delay", "time_95") and v["delay"] >= v["time_95"]:
        rule = f"must be below time_95, {at_most(v['time_95'])} s"
        yield Finding(("delay",), rule, f"`{shown(v['delay'])} s`", "write a shorter delay or a later time_95")


class FillingApplication(Part):
    """Brake cylinders that fill: fast at first, then ever slower."""

    rules = (_filled_after_delay,)

    form: Literal["filling"] = Field(default="filling", description="Application: cylinders that fill.")
    time_95: Annotated[float, Quantity("time", Range(0.05, 300.0), "4 s")] = Field(
        description="From the onset until 95 % of the full force, s. UIC 540: 3 to 5 s in P, 18 to 30 s in G."
    )
    delay: Annotated[float, Quantity("time", Range(0.0, 100.0), "0 s")] = Field(
        default=0.0, description="Before anything presses, s."
    )
    jump: Annotated[float, Number(Range(0.0, REACHED, below=True), "0.1")] = Field(
        default=0.1, description="Part of the full force that presses at once after the delay."
    )

    @property
    def stretches(self) -> Stretches:
        """`1 - (1 - jump) exp(-c (t - delay))`, with 0.95 at `time_95`."""
        rate = math.log((1.0 - self.jump) / (1.0 - REACHED)) / (self.time_95 - self.delay)
        filled = (self.delay, 1.0, 0.0, self.jump - 1.0, rate)
        return ((0.0, 0.0, 0.0, 0.0, 0.0), filled) if self.delay > 0.0 else (filled,)


class TableApplication(Part):
    """A brake that presses as points of time and share say; where it falls, it is released."""

    form: Literal["table"] = Field(default="table", description="Application: points of time and share.")
    points: Annotated[
        tuple[tuple[float, float], ...],
        Points(
            Quantity("time", Range(0.0, 1e4), "1 s"),
            Number(Range(0.0, 1.0), "0.3"),
            "[[0 s, 0], [1 s, 0.3], [5 s, 1]]",
            first=0.0,
        ),
    ] = Field(description="Points [time since the onset, part of the full force]; constant after the last.")

    @property
    def stretches(self) -> Stretches:
        """Straight lines, and the last share for ever."""
        lines = tuple((t0, a0, (a1 - a0) / (t1 - t0), 0.0, 0.0) for (t0, a0), (t1, a1) in pairwise(self.points))
        return (*lines, (*self.points[-1], 0.0, 0.0, 0.0))


def _filling(time_95: float) -> FillingApplication:
    """A filling after UIC 540."""
    return FillingApplication.model_construct(time_95=time_95)


Application: TypeAlias = Annotated[
    Annotated[StepApplication | LinearApplication | FillingApplication | TableApplication, Field(discriminator="form")],
    Short({"step": StepApplication.model_construct(), "P": _filling(4.0), "G": _filling(24.0)}),
]


class LoadChangeover(Part):
    """A brake that presses less in a light wagon."""

    gross_mass: Annotated[float, Quantity("mass", Range(1e3, 1e6), "48 t")] = Field(
        description="Mass of wagon and load below which the wagon counts as empty, kg; usual: 48 t."
    )
    empty_share: Annotated[float, Number(Range(0.05, 1.0), "0.58")] = Field(
        description="Part of the application that is left then; usual: 0.58."
    )


def _thresholds(v: Values) -> Iterator[Finding]:
    if v.has("hold_above", "vent_above") and v["hold_above"] > v["vent_above"]:
        rule = f"must be at most vent_above, {at_most(v['vent_above'])}"
        yield Finding(("hold_above",), rule, f"`{shown(v['hold_above'])}`", "write less, or a larger vent_above")
    for key in ("fill_time", "vent_time"):
        if v.has(key, "period") and v[key] < v["period"]:
            rule = f"must be at least the period, {at_least(v['period'])} s: the valve would ring between samples"
            yield Finding((key,), rule, f"`{shown(v[key])} s`", "write a longer time or a shorter period")


class SlideProtection(Part):
    """Wheel slide protection: vents the brake of a wheelset that slips (theory section 13)."""

    rules = (_thresholds,)

    period: Annotated[float, Quantity("time", Range(1e-3, 1.0), "20 ms")] = Field(
        default=0.02, description="Time between two looks at the slip, s."
    )
    hold_above: Annotated[float, Number(Range(0.0, 1.0), "0.10")] = Field(
        default=0.1, description="Slip over the wagon's speed above which the force is held."
    )
    vent_above: Annotated[float, Number(Range(0.0, 1.0), "0.20")] = Field(
        default=0.2, description="Slip over the wagon's speed above which the force is vented."
    )
    release_speed: Annotated[float, Quantity("speed", Range(0.0, 50.0), "5 km/h")] = Field(
        default=5.0 / KM_H, description="Speed of the wagon below which it always fills, m/s."
    )
    fill_time: Annotated[float, Quantity("time", Range(1e-3, 100.0), "0.4 s")] = Field(
        default=0.4, description="Time constant of filling, s."
    )
    vent_time: Annotated[float, Quantity("time", Range(1e-3, 100.0), "0.15 s")] = Field(
        default=0.15, description="Time constant of venting, s."
    )
