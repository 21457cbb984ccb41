"""Tables of a scenario: points of two values, straight between them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.leaves import Leaf
from slosh_cli.scenario.units import plain


@dataclass(frozen=True)
class Points(Leaf):
    """Points [x, y] of rising x, `least` to `most` of them; `x` and `y` say what each of the two values is.

    Points are at least `apart` from each other in x. With a `first` the first x has to be that. Parsed, it is a tuple
    of pairs of SI numbers.
    """

    x: Leaf
    y: Leaf
    example: str
    least: int = 1
    most: int = 1000
    apart: float = 0.0
    first: float | None = None

    def sample(self) -> str:
        return self.example

    def parse(self, value: object) -> tuple[tuple[float, float], ...]:
        return self._read(value, python=False)

    def parse_python(self, value: object) -> tuple[tuple[float, float], ...]:
        return self._read(value, python=True)

    def _read(self, value: object, *, python: bool) -> tuple[tuple[float, float], ...]:
        rule = "must be a list of points [x, y]"
        if not isinstance(value, list | tuple):
            raise ValueRefused(rule, plain(value), f"write points, such as `{self.example}`")
        if not self.least <= len(value) <= self.most:
            given = f"{len(value)}"
            raise ValueRefused(f"must have from {self.least} to {self.most} points", given, f"write `{self.example}`")
        points = tuple(self._point(number, point, python) for number, point in enumerate(value, 1))
        for number, (before, after) in enumerate(pairwise(points), 1):
            if after[0] <= before[0] or after[0] - before[0] < self.apart:
                words = f"{plain(value[number - 1][0])} and then {plain(value[number][0])}"
                fix = f"write a larger first value in point {number + 1}, or leave the point out"
                by = f" by {self.apart:g} {getattr(self.x, 'unit', '')} or more" if self.apart else ""
                rule = f"must rise from point to point{by}, but point {number + 1} does not"
                raise ValueRefused(rule, words, fix)
        if self.first is not None and points[0][0] != self.first:
            fix = f"write `{self.example}`, or add a point in front"
            raise ValueRefused(f"must begin at {self.first:g}", plain(value[0][0]), fix)
        return points

    def _point(self, number: int, point: object, python: bool) -> tuple[float, float]:
        if not isinstance(point, list | tuple) or len(point) != 2:
            rule = f"must be a list of points [x, y], but point {number} is not"
            raise ValueRefused(rule, plain(point), f"write the points like those of `{self.example}`")
        try:
            x, y = (
                leaf.parse_python(value) if python else leaf.parse(value)
                for leaf, value in zip((self.x, self.y), point, strict=True)
            )
        except ValueRefused as refused:
            raise ValueRefused(f"point {number}: {refused.rule}", refused.given, refused.fix) from None
        return x, y

    def written(self, value: Any, *, as_text: bool) -> Any:
        return [[self.x.written(x, as_text=as_text), self.y.written(y, as_text=as_text)] for x, y in value]

    def json_schema(self) -> dict[str, Any]:
        point = {
            "type": "array", "prefixItems": [self.x.json_schema(), self.y.json_schema()], "minItems": 2, "maxItems": 2,
        }  # fmt: skip
        return {"type": "array", "items": point, "minItems": self.least, "maxItems": self.most}


@dataclass(frozen=True)
class NumberOrPoints(Leaf):
    """A single value, or points that tell it: parsed, what the one or the other is."""

    number: Leaf
    points: Points

    def sample(self) -> str:
        return self.number.sample()

    def parse(self, value: object) -> Any:
        return self._of(value).parse(value)

    def parse_python(self, value: object) -> Any:
        return self._of(value).parse_python(value)

    def written(self, value: Any, *, as_text: bool) -> Any:
        return self._of(value).written(value, as_text=as_text)

    def _of(self, value: object) -> Leaf:
        if isinstance(value, dict):
            rule = "must be a number or a list of points [x, y]"
            raise ValueRefused(rule, plain(value), f"write `{self.number.sample()}` or `{self.points.sample()}`")
        return self.points if isinstance(value, list | tuple) else self.number

    def json_schema(self) -> dict[str, Any]:
        return {"anyOf": [self.number.json_schema(), self.points.json_schema()]}
