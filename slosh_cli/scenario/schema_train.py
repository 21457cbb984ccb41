"""The couplings between the vehicles of a train."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Final

from pydantic import Field

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Leaf, Quantity, Range
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.units import at_least, plain, shown

_LENGTH: Final = Quantity("length", Range(0.0, 10.0), "105 mm")
_FORCE: Final = Quantity("force", Range(0.0, 1e9), "590 kN")
_SAMPLE: Final = "[[0 mm, 0 kN], [10 mm, 30 kN], [210 mm, 1180 kN]]"
_MOST_POINTS: Final = 100

Points = tuple[tuple[float, float], ...]
"""Travel (m) and force (N) of the corners of a branch, the first one at (0, 0)."""


@dataclass(frozen=True)
class _Branch(Leaf):
    """Points [travel, force] from [0, 0] on: the travel grows, the force never falls."""

    def sample(self) -> str:
        return _SAMPLE

    def written(self, value: Any, *, as_text: bool) -> Any:
        return [[_LENGTH.written(x, as_text=as_text), _FORCE.written(y, as_text=as_text)] for x, y in value]

    def parse(self, value: object) -> Points:
        return self._read(value, Quantity.parse)

    def parse_python(self, value: object) -> Points:
        return self._read(value, Quantity.parse_python)

    def _read(self, value: object, read: Any) -> Points:
        rule, fix = "must be a list of points [travel, force]", f"write points, such as `{_SAMPLE}`"
        if not isinstance(value, list | tuple) or not 2 <= len(value) <= _MOST_POINTS:
            raise ValueRefused(f"{rule}, two to {_MOST_POINTS} of them", plain(value), fix)
        points = []
        for number, point in enumerate(value, start=1):
            if not isinstance(point, list | tuple) or len(point) != 2:
                raise ValueRefused(f"{rule}, but point {number} is not", plain(point), fix)
            try:
                points.append((read(_LENGTH, point[0]), read(_FORCE, point[1])))
            except ValueRefused as refused:
                raise ValueRefused(f"{refused.rule} at point {number}", refused.given, refused.fix) from None
        _check_points(points)
        return tuple(points)

    def json_schema(self) -> dict[str, Any]:
        pair = {"type": "array", "prefixItems": [_LENGTH.json_schema(), _FORCE.json_schema()], "minItems": 2}
        return {"type": "array", "items": pair | {"maxItems": 2}, "minItems": 2, "maxItems": _MOST_POINTS}


def _check_points(points: list[tuple[float, float]]) -> None:
    if points[0] != (0.0, 0.0):
        given = f"a first point at {_at(points[0])}"
        raise ValueRefused("must begin without travel and force", given, "write `[0 mm, 0 kN]` as the first point")
    for before, after in pairwise(points):
        if after[0] <= before[0]:
            given = f"{_at(after)} after {_at(before)}"
            raise ValueRefused("must have points of growing travel", given, "sort the points by their travel")
        if after[1] < before[1]:
            given = f"{_at(after)} after {_at(before)}"
            raise ValueRefused("must have forces that never fall", given, f"write `{shown(before[1])} N` or more there")


def _at(point: tuple[float, float]) -> str:
    return f"[{shown(point[0])} m, {shown(point[1])} N]"


def force_at(points: Points, travel: float) -> float:
    """Force (N) of a branch at a `travel` (m) of zero or more; its last line goes on."""
    (x, y), (x_after, y_after) = next((pair for pair in pairwise(points) if travel < pair[1][0]), points[-2:])
    return y + (y_after - y) / (x_after - x) * (travel - x)


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

    rules = (_unloading_below,)

    loading: Annotated[Points, _Branch()] = Field(description="Travel and force as the force grows, m and N.")
    unloading: Annotated[Points, _Branch()] = Field(
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
