"""What the file of a train says: its vehicles, the couplings between them, the pipe, the stop."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Final

from pydantic import Field

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Count, Judge, Quantity, Range
from slosh_cli.scenario.loader import Root
from slosh_cli.scenario.points import Points
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.schema_run import Contact, Output, Solver, Track
from slosh_cli.scenario.short import Short
from slosh_cli.scenario.units import at_least, plain, shown
from slosh_cli.scenario.words import Text

_BRANCH: Final = Points(
    Quantity("length", Range(0.0, 10.0), "105 mm"),
    Quantity("force", Range(0.0, 1e9), "590 kN"),
    "[[0 mm, 0 kN], [10 mm, 30 kN], [210 mm, 1180 kN]]",
    least=2,
    first=0.0,
)
SHARED: Final = ("track", "contact", "solver", "output")
"""Parts that a train may have for all its vehicles; where left out they are those of the first one's file."""
TRACK_MODEL: Final = "track.model"
"""A key of the track that each vehicle may have of its own."""
MOST_VEHICLES: Final = 1000
Branch = tuple[tuple[float, float], ...]
"""Travel (m) and force (N) of the corners of a coupling's branch, the first one at (0, 0)."""


def force_at(points: Branch, travel: float) -> float:
    """Force (N) of a branch at a `travel` (m) of zero or more; its last line goes on."""
    (x, y), (x_after, y_after) = next((pair for pair in pairwise(points) if travel < pair[1][0]), points[-2:])
    return y + (y_after - y) / (x_after - x) * (travel - x)


def _never_falls(v: Values) -> Iterator[Finding]:
    for key in ("loading", "unloading"):
        points = v.get(key, ((0.0, 0.0),))
        if points[0][1] != 0.0:
            given = f"`{shown(points[0][1])} N` without travel"
            yield Finding((key,), "must begin without force", given, "write `[0 mm, 0 kN]` as the first point")
        for number, (before, after) in enumerate(pairwise(points), 2):
            if after[1] < before[1]:
                rule, given = f"must never fall, but point {number} does", f"`{shown(after[1])} N`"
                yield Finding((key,), rule, given, f"write `{at_least(before[1])} N` or more there")


def _unloading_below(v: Values) -> Iterator[Finding]:
    if not v.has("loading", "unloading"):
        return
    loading, unloading = v["loading"], v["unloading"]
    end = 2.0 * max(loading[-1][0], unloading[-1][0])
    for travel in sorted({x for x, _ in (*loading, *unloading)} | {end}):
        most, found = force_at(loading, travel), force_at(unloading, travel)
        if found > most * (1.0 + 1e-9):
            given = f"`{shown(found)} N` at {shown(travel)} m, above `{shown(most)} N`"
            fix = f"write `{shown(most)} N` or less there, or exchange the branches"
            yield Finding(("unloading",), "must nowhere be above loading", given, fix)
            return


class Spring(Part):
    """One direction of a coupling: a spring with friction."""

    rules = (_never_falls, _unloading_below)

    loading: Annotated[Branch, _BRANCH] = Field(description="Travel and force as the force grows, m and N.")
    unloading: Annotated[Branch, _BRANCH] = Field(
        description="Travel and force as the force goes, m and N; nowhere above loading."
    )


class LinearCoupling(Part):
    """A coupling without friction or slack, for checks."""

    stiffness: Annotated[float, Quantity("stiffness", Range(0.0, 1e12), "1.0e7 N/m")] = Field(
        description="Stiffness of the whole coupling, N/m."
    )
    damping: Annotated[float, Quantity("damping", Range(0.0, 1e9), "5.0e4 N s/m")] = Field(
        default=0.0, description="Damping of the whole coupling, N s/m."
    )


def _linear_alone(v: Values) -> Iterator[Finding]:
    if v.get("linear.stiffness") is None:
        for key, other in (("compression", "tension"), ("tension", "compression")):
            if not v.wrote(key) and v.wrote(other):
                yield Finding((key,), "is required", "nothing", f"write `{key}:` with loading and unloading under it")
        return
    for key in ("tension", "transition_stiffness", "damping"):
        if v.wrote(key):
            yield Finding((key,), "must not be given beside `linear`", "both", "keep one of them")


def _transition_steepest(v: Values) -> Iterator[Finding]:
    """A branch steeper than the way across would be followed up on the lower and down on the upper one."""
    tables = ("compression.loading", "compression.unloading", "tension.loading", "tension.unloading")
    for key in tables:
        for (x, y), (x_after, y_after) in pairwise(v.get(key, ())):
            slope, transition = (y_after - y) / (x_after - x), v.get("transition_stiffness")
            if transition is not None and slope > transition * (1.0 + 1e-9):
                rule = f"must be at least that of {key} at its steepest, {shown(slope)} N/m, or friction gives energy"
                fix = f"write `transition_stiffness: {at_least(slope)} N/m`, or a gentler branch"
                yield Finding(("transition_stiffness",), rule, f"`{shown(transition)} N/m`", fix)
                return


class Coupling(Part):
    """What holds two neighbours together: springs with friction for compression and tension, or one that is linear."""

    exactly_one: ClassVar[tuple[tuple[str, ...], ...]] = (("compression", "linear"),)
    rules = (_linear_alone, _transition_steepest)

    compression: Spring | None = Field(default=None, description="The coupling as its neighbours run up.")
    tension: Spring | None = Field(default=None, description="The coupling as its neighbours part.")
    transition_stiffness: Annotated[float, Quantity("stiffness", Range(1e5, 1e12), "1.0e8 N/m")] = Field(
        default=1.0e8, description="Stiffness with which the force goes from one branch to the other, N/m."
    )
    damping: Annotated[float, Quantity("damping", Range(0.0, 1e9), "0 N s/m")] = Field(
        default=0.0, description="Damping beside the springs, N s/m."
    )
    linear: LinearCoupling | None = Field(default=None, description="A linear coupling instead, for checks.")


def _ring_springs(travel: float, force: float, last: float, most: float) -> Spring:
    loading = ((0.0, 0.0), (travel, force), (last, most))
    return Spring.model_construct(loading=loading, unloading=tuple((x, y / 3.0) for x, y in loading))


_GEAR = Spring.model_construct(
    loading=((0.0, 0.0), (0.025, 0.0), (0.027, 240e3), (0.115, 2501.6e3), (0.125, 5001.6e3)),
    unloading=((0.0, 0.0), (0.025, 0.0), (0.027, 50e3), (0.115, 300.8e3), (0.125, 2800.8e3)),
)
COUPLINGS: Final[dict[str, Coupling]] = {
    "screw": Coupling.model_construct(
        compression=_ring_springs(0.010, 30e3, 0.210, 1180e3), tension=_ring_springs(0.005, 30e3, 0.110, 1000e3)
    ),
    "automatic": Coupling.model_construct(compression=_GEAR, tension=_GEAR, transition_stiffness=2.5e8),
}
"""Side buffers and draw gear after EN 15551, both ends of a coupling in series; an automatic coupler with a slack of
25 mm either way, whose gear of 90 mm then meets its stop."""


@dataclass(frozen=True)
class _Settings(Judge):
    def parse(self, value: object) -> Any:
        if isinstance(value, dict):
            return value
        raise ValueRefused("must be a mapping of key paths to values", plain(value), "write `set: {tank.fill: 0.9}`")


class TrainEntry(Part):
    """A vehicle of a train, or several alike."""

    scenario: Annotated[str, Text(longest=500)] = Field(
        description="Path of the scenario from this file, or the name of a packaged one."
    )
    count: Annotated[int, Count(1, MOST_VEHICLES)] = Field(default=1, description="How many of them.")
    set: Annotated[dict[str, Any], _Settings()] = Field(
        default={}, description="Keys of the scenario with values of their own."
    )


class _FirstOnSprings(Track):
    """Stands for the first vehicle's track, with each wheel on the rail's static stiffness."""

    word: ClassVar[str] = "rigid"


_RIGID: Final = _FirstOnSprings.model_construct(model="rigid", rail=None, foundation=None)


class BrakePipe(Part):
    """The pipe along the train that tells the brakes to set in."""

    speed: Annotated[float, Quantity("speed", Range(1.0, 1e5), "280 m/s")] = Field(
        default=280.0, description="Speed of the brake wave from the front, m/s."
    )


class TrainBraking(Part):
    """The stop of a train; torque, blocks and application come with each vehicle."""

    initial_speed: Annotated[float, Quantity("speed", Range(0.01, 150.0), "80 km/h")] = Field(
        description="Speed at the start of the run, m/s."
    )
    onset: Annotated[float, Quantity("time", Range(0.0, 1e4), "0.5 s")] = Field(
        description="When the driver brakes, after the start of the run, s."
    )
    stop_speed: Annotated[float, Quantity("speed", Range(1e-4, 50.0), "0.02 m/s")] = Field(
        default=0.02, description="The run ends when the mean speed of all vehicles falls to this, m/s."
    )


class TrainFile(Root):
    """What the file of a train says."""

    noun: ClassVar[str] = "train"

    vehicles: tuple[TrainEntry, ...] = Field(min_length=1, description="The vehicles from the front.")
    coupling: Annotated[Coupling, Short(COUPLINGS)] = Field(
        default=COUPLINGS["screw"],
        description="The coupling of any two neighbours: `screw`, `automatic`, or its springs in a mapping.",
    )
    brake_pipe: BrakePipe = Field(default=BrakePipe.model_construct(), description="The pipe along the train.")
    braking: TrainBraking = Field(description="The stop of the train.")
    track: Annotated[Track | None, Short({"rigid": _RIGID})] = Field(
        default=None,
        description="The track under one rail; `rigid`: its static stiffness alone. Default: the first vehicle's.",
    )
    contact: Contact | None = Field(default=None, description="Wheel and rail. Default: the first vehicle's.")
    solver: Solver | None = Field(default=None, description="Accuracy, patience. Default: the first vehicle's.")
    output: Output | None = Field(default=None, description="What is written. Default: the first vehicle's.")

    @property
    def settings(self) -> dict[str, Any]:
        """What the train says for all its vehicles, by key path."""
        braking = {f"braking.{key}": getattr(self.braking, key) for key in ("initial_speed", "stop_speed", "onset")}
        parts = {key: getattr(self, key) for key in SHARED if getattr(self, key) is not None}
        if isinstance(self.track, _FirstOnSprings):
            parts[TRACK_MODEL] = parts.pop("track").model
        return braking | parts
