"""Plane polygons cut by a straight line: the wetted part of a polygonal cross-section.

Points are ``(y, z)`` tuples in metres. Everything here is exact up to rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

_Point = tuple[float, float]
Loop = tuple[_Point, ...]


@dataclass(frozen=True)
class _AreaMoments:
    """Area (m^2), first moment (m^3) and second moment (m^4) of a plane region, the moments about z = 0."""

    area: float
    first: float
    second: float


def moments(loops: Sequence[Loop], level: float = 0.0) -> _AreaMoments:
    """Moments of the region inside counter-clockwise loops about the horizontal line z = `level` (Green)."""
    area = first = second = 0.0
    for loop in loops:
        for (y1, z1), (y2, z2) in zip(loop, (*loop[1:], loop[0]), strict=True):
            a, b = z1 - level, z2 - level
            cross = y1 * b - y2 * a
            area += cross / 2.0
            first += cross * (a + b) / 6.0
            second += cross * (a * a + a * b + b * b) / 12.0
    return _AreaMoments(area, first, second)


def counter_clockwise(points: Sequence[_Point]) -> Loop:
    """The same polygon, ordered so that its signed area is positive."""
    loop = tuple(points)
    return loop if moments([loop]).area >= 0.0 else loop[::-1]


def cut_below(points: Loop, level: float) -> tuple[Loop, ...]:
    """The parts of a simple polygon below z = `level`, as counter-clockwise loops, largest first.

    The polygon may be non-convex, so there may be several parts. Vertices on the line count as above it:
    a shelf exactly at the level stays dry.
    """
    loop = counter_clockwise(points)
    below = [z < level for _, z in loop]
    if all(below):
        return (loop,)
    if not any(below):
        return ()
    parts = _join(_chains_below(loop, below, level))
    return tuple(sorted(parts, key=lambda part: -moments([part]).area))


def cut_right(points: Loop) -> tuple[Loop, ...]:
    """The parts of a simple polygon with y > 0, as counter-clockwise loops, largest first."""
    turned = tuple((z, -y) for y, z in points)  # a quarter turn clockwise: y > 0 becomes z < 0
    return tuple(_without_repeats([(-z + 0.0, y) for y, z in part]) for part in cut_below(turned, 0.0))


def _chains_below(loop: Loop, below: list[bool], level: float) -> list[list[_Point]]:
    """Runs of vertices below the level, each with its two crossing points at the ends."""
    count = len(loop)
    chains = []
    for start in range(count):
        if below[start] or not below[(start + 1) % count]:
            continue
        chain = [_crossing(loop[start], loop[(start + 1) % count], level)]
        index = (start + 1) % count
        while below[index]:
            chain.append(loop[index])
            index = (index + 1) % count
        chain.append(_crossing(loop[index - 1], loop[index], level))
        chains.append(chain)
    return chains


def _crossing(start: _Point, end: _Point, level: float) -> _Point:
    (y1, z1), (y2, z2) = start, end
    if z1 == level:
        return start
    if z2 == level:
        return end
    return (y1 + (y2 - y1) * (level - z1) / (z2 - z1), level)


def _join(chains: list[list[_Point]]) -> list[Loop]:
    """Close the chains along the cutting line.

    Run counter-clockwise, every chain starts at the left end of a wetted interval of the line and ends at the
    right end of one; sorted along the line these alternate, because the polygon is simple. Where two parts
    touch, the one on the left ends before the other starts.
    """
    ends = sorted(
        [(chain[0][0], 1, index) for index, chain in enumerate(chains)]
        + [(chain[-1][0], 0, index) for index, chain in enumerate(chains)]
    )
    followed_by = {right[2]: left[2] for left, right in zip(ends[0::2], ends[1::2], strict=True)}
    loops, unused = [], set(range(len(chains)))
    while unused:
        first = current = min(unused)
        points: list[_Point] = []
        while True:
            points += chains[current]
            unused.discard(current)
            current = followed_by[current]
            if current == first:
                break
        cleaned = _without_repeats(points)
        if len(cleaned) > 2:
            loops.append(cleaned)
    return loops


def _without_repeats(points: Sequence[_Point]) -> Loop:
    return tuple(point for point, before in zip(points, (points[-1], *points[:-1]), strict=True) if point != before)


def surface_intervals(points: Loop, level: float) -> tuple[tuple[float, float], ...]:
    """The intervals of y over which a liquid filled up to z = `level` has a free surface, left to right.

    A ceiling exactly at the level is wall, not surface; a shelf exactly at the level is dry.
    """
    loop = counter_clockwise(points)
    below = _crossings([z < level for _, z in loop], loop, level)
    above = _crossings([z <= level for _, z in loop], loop, level)
    overlaps = []
    for low, high in zip(below[0::2], below[1::2], strict=True):
        for low_2, high_2 in zip(above[0::2], above[1::2], strict=True):
            start, end = max(low, low_2), min(high, high_2)
            if end > start:
                overlaps.append((start, end))
    return tuple(sorted(overlaps))


def _crossings(below: list[bool], loop: Loop, level: float) -> list[float]:
    pairs = zip(loop, (*loop[1:], loop[0]), below, (*below[1:], below[0]), strict=True)
    return sorted(_crossing(one, two, level)[0] for one, two, is_below, next_below in pairs if is_below != next_below)
