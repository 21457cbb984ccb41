"""Tables of a scenario: points of two values, straight between them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.leaves import Leaf
from slosh_cli.scenario.units import plain

_MOST = 1000


@dataclass(frozen=True)
class Points(Leaf):
    """Points [x, y] of rising x, at least `least` of them; `x` and `y` say what each of the two values is.

    With a `first` the first x has to be that. Parsed, it is a tuple of pairs of SI numbers.
    """

    x: Leaf
    y: Leaf
    example: str
    least: int = 1
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
        if not self.least <= len(value) <= _MOST:
            given = f"{len(value)}"
            raise ValueRefused(f"must have from {self.least} to {_MOST} points", given, f"write `{self.example}`")
        points = tuple(self._point(number, point, python) for number, point in enumerate(value, 1))
        for number, (before, after) in enumerate(pairwise(points), 1):
            if after[0] <= before[0]:
                words = f"{plain(value[number - 1][0])} and then {plain(value[number][0])}"
                fix = f"write a larger first value in point {number + 1}, or leave the point out"
                raise ValueRefused(f"must rise from point to point, but point {number + 1} does not", words, fix)
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
        return {"type": "array", "items": point, "minItems": self.least, "maxItems": _MOST}
