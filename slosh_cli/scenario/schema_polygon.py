"""The outline of a polygonal cross-section: read, checked and brought into one standard form."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.leaves import Leaf, Quantity
from slosh_cli.scenario.units import parse_quantity, plain, shown

_EXAMPLE = "[[-1.2, 0.0], [1.2, 0.0], [1.2, 2.0], [-1.2, 2.0]]"
_MOST = 1000
_TOLERANCE = 1e-6
"""Of the outline's size: closer points count as one, and corners this far off their mirror image pass."""


@dataclass(frozen=True)
class Outline(Leaf):
    """Corners [y, z] in metres (bare numbers, or texts with a unit); nothing further out than `largest`.

    The parsed outline runs counter-clockwise seen with y to the right and z up, is not closed by a repeated
    corner, is symmetric about y = 0 and has its lowest point at z = 0.
    """

    largest: float

    def sample(self) -> str:
        return _EXAMPLE

    def parse(self, value: object) -> tuple[tuple[float, float], ...]:
        if not isinstance(value, list | tuple):
            raise ValueRefused(
                "must be a list of corners [y, z] in m", plain(value), f"write corners, such as `points: {_EXAMPLE}`"
            )
        if len(value) > _MOST:
            raise ValueRefused(f"must have at most {_MOST} corners", f"{len(value)}", "leave out corners")
        points = [self._corner(index, corner) for index, corner in enumerate(value)]
        if len(points) > 1 and points[0] == points[-1]:
            points.pop()
        size = max((abs(number) for point in points for number in point), default=0.0)
        _check_corners(points, _TOLERANCE * size)
        _check_simple(points)
        if _area(points) < 0.0:
            points.reverse()
        _check_place(points, _TOLERANCE * size)
        _check_symmetric(points, _TOLERANCE * size)
        return tuple(points)

    def json_schema(self) -> dict[str, Any]:
        number = {
            "oneOf": [
                {"type": "number"},
                {"type": "string", "pattern": Quantity.PATTERN},
            ]
        }
        corner = {"type": "array", "items": number, "minItems": 2, "maxItems": 2}
        return {"type": "array", "items": corner, "minItems": 3, "maxItems": _MOST, "x-unit": "m"}

    def _corner(self, index: int, corner: object) -> tuple[float, float]:
        rule = f"must be a list of corners [y, z] in m, but corner {index + 1} is not"
        if not isinstance(corner, list | tuple) or len(corner) != 2:
            raise ValueRefused(rule, plain(corner), "write the corner as `[y, z]`, such as `[1.2, 0.0]`")
        y, z = (self._coordinate(index, number) for number in corner)
        return y, z

    def _coordinate(self, index: int, number: object) -> float:
        rule = f"must have coordinates in m within {shown(self.largest)} m, but corner {index + 1} has not"
        if isinstance(number, str):
            try:
                number = parse_quantity(number, "length", lambda value: abs(value) <= self.largest, "1.2 m")
            except ValueRefused as refused:
                raise ValueRefused(rule, refused.given, refused.fix) from None
        if isinstance(number, bool) or not isinstance(number, int | float) or not abs(number) <= self.largest:
            raise ValueRefused(rule, plain(number), "write a number of metres, such as `1.2`")
        return float(number)


def _check_corners(points: list[tuple[float, float]], tolerance: float) -> None:
    if len(points) < 3:
        raise ValueRefused(
            "must have at least three corners", f"{len(points)}", f"write more, such as `points: {_EXAMPLE}`"
        )
    for index, (here, there) in enumerate(zip(points, [*points[1:], points[0]], strict=True)):
        if math.dist(here, there) <= tolerance:
            place = f"corners {index + 1} and {(index + 1) % len(points) + 1} at {_at(here)}"
            raise ValueRefused("must have corners apart from each other", place, "leave one of them out")


def _check_simple(points: list[tuple[float, float]]) -> None:
    """No two sides may touch, except neighbours in their common corner; folded-back neighbours do."""
    count = len(points)
    sides = [(points[i], points[(i + 1) % count]) for i in range(count)]
    for i in range(count):
        for j in range(i + 1, count):
            neighbours = j == i + 1 or (i == 0 and j == count - 1)
            if _folds(sides[i], sides[j], count) if neighbours else _touch(*sides[i], *sides[j]):
                given = f"side {i + 1}, {_at(sides[i][0])} to {_at(sides[i][1])}, meeting side {j + 1}, "
                given += f"{_at(sides[j][0])} to {_at(sides[j][1])}"
                raise ValueRefused("must not cross or touch itself", given, "list the corners in order around it")


def _check_place(points: list[tuple[float, float]], tolerance: float) -> None:
    lowest = min(z for _, z in points)
    if abs(lowest) > tolerance:
        exact = f"{abs(lowest):.12g}"
        fix = f"add {exact} to every z" if lowest < 0 else f"take {exact} off every z"
        raise ValueRefused("must have its lowest point at z = 0", f"a lowest z of {shown(lowest)} m", fix)


def _check_symmetric(points: list[tuple[float, float]], tolerance: float) -> None:
    """Every side must have its mirror image about y = 0; corners on straight runs do not count."""
    corners = _without_straight(points, tolerance)
    count = len(corners)
    mirrored: list[int] = []
    for y, z in corners:
        partner = min(range(count), key=lambda i: math.dist(corners[i], (-y, z)))
        if math.dist(corners[partner], (-y, z)) > 4.0 * tolerance:
            fix = f"write a corner [{-y:.12g}, {z:.12g}] too, or move the outline"
            raise ValueRefused("must be symmetric about y = 0", f"corner {_at((y, z))} without its mirror image", fix)
        mirrored.append(partner)
    for i in range(count):
        here, there = mirrored[i], mirrored[(i + 1) % count]
        if (here - there) % count not in (1, count - 1):
            given = f"side {_at(corners[i])} to {_at(corners[(i + 1) % count])} without its mirror image"
            raise ValueRefused("must be symmetric about y = 0", given, "list the corners in order around it")


def _without_straight(points: list[tuple[float, float]], tolerance: float) -> list[tuple[float, float]]:
    count = len(points)
    kept = []
    for i, here in enumerate(points):
        before, after = points[i - 1], points[(i + 1) % count]
        if abs(_cross(before, here, after)) > tolerance * math.dist(before, after):
            kept.append(here)
    return kept


def _area(points: list[tuple[float, float]]) -> float:
    """Signed, positive counter-clockwise, m^2."""
    following = [*points[1:], points[0]]
    return 0.5 * sum(y0 * z1 - y1 * z0 for (y0, z0), (y1, z1) in zip(points, following, strict=True))


def _cross(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _folds(first: tuple[Any, Any], second: tuple[Any, Any], count: int) -> bool:
    """Whether two neighbouring sides lie on each other; of a triangle, whether it is flat."""
    common = second[0] if first[1] == second[0] else first[0]
    one = first[0] if common == first[1] else first[1]
    two = second[1] if common == second[0] else second[0]
    flat = abs(_cross(common, one, two)) <= 1e-12 * math.dist(common, one) * math.dist(common, two)
    along = (one[0] - common[0]) * (two[0] - common[0]) + (one[1] - common[1]) * (two[1] - common[1])
    return flat and (along > 0.0 or count == 3)


def _touch(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], d: tuple[float, float]) -> bool:
    """Whether the closed segments ab and cd have a point in common."""
    abc, abd, cda, cdb = _cross(a, b, c), _cross(a, b, d), _cross(c, d, a), _cross(c, d, b)
    if (abc > 0) != (abd > 0) and (cda > 0) != (cdb > 0) and abc and abd and cda and cdb:
        return True
    spans = ((a, b, c, abc), (a, b, d, abd), (c, d, a, cda), (c, d, b, cdb))
    return any(not side and _between(p, q, point) for p, q, point, side in spans)


def _between(p: tuple[float, float], q: tuple[float, float], point: tuple[float, float]) -> bool:
    return all(min(p[i], q[i]) <= point[i] <= max(p[i], q[i]) for i in (0, 1))


def _at(point: tuple[float, float]) -> str:
    return f"[{shown(point[0])}, {shown(point[1])}]"
