"""Where an answer passes a value along one key, and where it is least: on stops as they are, with jumps and gaps.

An answer over a key has jumps (another number of locking wheels), several passages and stretches without an answer. So
the range is scanned first; only what lies between two neighbours of the scan is refined.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final, Literal

import numpy as np

PRECISION: Final = 1e-4
"""Width of a bracket, relative to the value of the key, at which a search ends."""
_OF_RANGE: Final = 1e-6
"""The same relative to the range, for values near zero."""
_NOISE: Final = 10.0
"""Tolerances of the solver by which two neighbouring stops may differ and still be on one curve."""
_STEEPER: Final = 5.0
"""A jump is so many times what the slope beside it explains."""
_EDGE_STEPS: Final = 5
"""Halvings of the stretch between a stop with an answer and one without."""


@dataclass(frozen=True)
class Sample:
    """One stop of a search: the key's value `x`, the answer's `value` (None without one), `limits` by their words.

    `status` and `reason` say how the stop ended; `row` is its row of a study's table.
    """

    x: float
    value: float | None
    limits: Mapping[str, bool]
    status: str
    reason: str
    row: Mapping[str, Any]

    @property
    def admitted(self) -> bool:
        """Whether it has an answer within all limits."""
        return self.value is not None and all(self.limits.values())


@dataclass(frozen=True)
class Passage:
    """Where an answer passes a value, between two neighbouring stops.

    kind: `crossing` (the value is taken at `x`), `jump` (it is leapt over), `gap` (stops between have no answer).
    refined: whether the two are as near as `PRECISION`; else they are neighbours of the scan.
    """

    kind: Literal["crossing", "jump", "gap"]
    x: float
    below: Sample
    above: Sample
    refined: bool


class Sampled:
    """The stops along a range so far; `at` computes those that are missing, `compute` does it side by side."""

    def __init__(self, compute: Callable[[Sequence[float]], list[Sample]], low: float, high: float) -> None:
        self.low, self.high = low, high
        self._compute = compute
        self._found: dict[float, Sample] = {}

    def at(self, *places: float) -> list[Sample]:
        """The stops at places, in their order."""
        tidy = [min(max(float(f"{place:.12g}"), self.low), self.high) for place in places]
        missing = sorted(set(tidy) - self._found.keys())
        if missing:
            self._found |= {one.x: one for one in self._compute(missing)}
        return [self._found[place] for place in tidy]

    def scan(self, count: int) -> None:
        """Stops at even steps from end to end, then where stops without an answer begin."""
        self.at(*np.linspace(self.low, self.high, count))
        for pair in list(pairwise(self.samples)):
            first, second = pair
            for _ in range(_EDGE_STEPS if (first.value is None) != (second.value is None) else 0):
                (middle,) = self.at(0.5 * (first.x + second.x))
                same = (middle.value is None) == (first.value is None)
                first, second = (middle, second) if same else (first, middle)

    @property
    def samples(self) -> list[Sample]:
        """Every stop so far, by the key's value."""
        return [self._found[place] for place in sorted(self._found)]

    def width(self, place: float) -> float:
        """What counts as one place there."""
        return _OF_RANGE * (self.high - self.low) + PRECISION * abs(place)


def passages(sampled: Sampled, target: float) -> list[Passage]:
    """Where the answer passes `target`, between the stops that there are, from low to high.

    An answer that is `target` at every stop passes it nowhere: no wheel locks from one end to the other.
    """
    answered = [one for one in sampled.samples if one.value is not None]
    order = {one.x: number for number, one in enumerate(sampled.samples)}
    found = []
    for first, second in pairwise(answered):
        if _over(first, target) != _over(second, target):
            beside = order[second.x] - order[first.x] == 1
            found.append(_passage(first, second, target, "crossing" if beside else "gap"))
    exact = next((one for one in answered if one.value == target), None)
    touched = exact is not None and any(one.value != target for one in answered)
    return found or ([Passage("crossing", exact.x, exact, exact, True)] if exact and touched else [])


def refined(sampled: Sampled, passage: Passage, target: float, tolerance: float) -> Passage:
    """The same passage between stops as near as `PRECISION`; a jump shows. `tolerance` is that of the solver."""
    if passage.refined or passage.kind == "gap":
        return passage
    first, second = passage.below, passage.above
    with suppress(_NoAnswer):
        _close_in(sampled, first, second, target)
    inside = [one for one in sampled.samples if first.x <= one.x <= second.x]
    answered = [one for one in inside if one.value is not None]
    pairs = [pair for pair in pairwise(answered) if _over(pair[0], target) != _over(pair[1], target)]
    below, above = min(pairs, key=lambda pair: pair[1].x - pair[0].x)
    if any(one.value is None and below.x < one.x < above.x for one in inside):
        return _passage(below, above, target, "gap", refined=True)
    jump = is_jump(sampled, below, above, tolerance)
    return _passage(below, above, target, "jump" if jump else "crossing", refined=True)


class _NoAnswer(Exception):  # noqa: N818  (a stop inside the bracket has none)
    pass


def _close_in(sampled: Sampled, first: Sample, second: Sample, target: float) -> None:
    """Compute stops between two on different sides until two such are near. Raises _NoAnswer at a gap."""
    from scipy.optimize import bisect, brentq

    flat = target in (first.value, second.value)  # on a plateau there is no slope to follow

    def miss(place: float) -> float:
        (one,) = sampled.at(place)
        if one.value is None:
            raise _NoAnswer
        return (1.0 if _over(one, target) else -1.0) if flat else one.value - target

    solve = bisect if flat else brentq
    width = _OF_RANGE * (sampled.high - sampled.low)
    solve(miss, first.x, second.x, xtol=width, rtol=PRECISION, disp=False)


def is_jump(sampled: Sampled, below: Sample, above: Sample, tolerance: float) -> bool:
    """Whether two near stops differ by far more than the slopes beside them, and the solver's noise, explain."""
    assert below.value is not None
    assert above.value is not None
    step, width = abs(above.value - below.value), above.x - below.x
    if step <= _NOISE * tolerance * max(abs(above.value), abs(below.value)):
        return False
    before, after = sampled.at(below.x - 4.0 * width, above.x + 4.0 * width)
    slopes = [0.0]
    for near, far in ((below, before), (above, after)):
        if far.value is not None and near.value is not None and far.x != near.x:
            slopes.append(abs((far.value - near.value) / (far.x - near.x)))
    return step > _STEEPER * width * max(slopes)


def least(sampled: Sampled, tolerance: float) -> Sample | None:
    """The stop within all limits whose value is least, from ever finer steps about the best; None where there is none.

    Limits and jumps leave no curve that a parabola could follow, so the neighbourhood of the best is scanned again.
    """
    while True:
        best, before, after = _best(sampled.samples)
        if best is None or before is None or after is None:
            return best
        sides = [one for one in (before, after) if one is not best]
        near = max(abs(one.x - best.x) for one in sides) <= sampled.width(best.x)
        if near or (len(sides) == 2 and all(_alike(one, best, tolerance) for one in sides)):
            return best
        gaps = [(min(one.x, best.x), max(one.x, best.x)) for one in sides if abs(one.x - best.x) > sampled.width(one.x)]
        sampled.at(*(low + (high - low) * part for low, high in gaps for part in (0.25, 0.5, 0.75)))


def _best(samples: Sequence[Sample]) -> tuple[Sample | None, Sample | None, Sample | None]:
    """The best stop within its limits and its neighbours, itself where it is at an end."""
    admitted = [(one.value, number) for number, one in enumerate(samples) if one.value is not None and one.admitted]
    if not admitted:
        return None, None, None
    _, number = min(admitted)
    return samples[number], samples[max(number - 1, 0)], samples[min(number + 1, len(samples) - 1)]


def flat(sampled: Sampled, best: Sample, tolerance: float) -> tuple[float, float]:
    """From where to where stops beside the best are as good as far as the solver can tell."""
    samples = sampled.samples
    number = samples.index(best)
    first = last = number
    while first > 0 and _alike(samples[first - 1], best, tolerance):
        first -= 1
    while last + 1 < len(samples) and _alike(samples[last + 1], best, tolerance):
        last += 1
    return samples[first].x, samples[last].x


def _alike(one: Sample, best: Sample, tolerance: float) -> bool:
    """Whether a stop is as good as the best, as far as the solver can tell."""
    if one.value is None or best.value is None or not one.admitted:
        return False
    return abs(one.value - best.value) <= tolerance * abs(best.value)


def beside(sampled: Sampled, best: Sample, tolerance: float) -> str:
    """What holds the best where it is: `inside`, `end` of the range, `limit`, `jump` or `gap`."""
    if best.x in (sampled.low, sampled.high):
        return "end"
    samples = sampled.samples
    number = samples.index(best)
    for first, second in ((samples[number - 1], best), (best, samples[number + 1])):
        other = second if first is best else first
        if other.value is None or not other.admitted:
            return "gap" if other.value is None else "limit"
        near = second.x - first.x <= 2.0 * sampled.width(best.x)
        if near and is_jump(sampled, first, second, tolerance):
            return "jump"
    return "inside"


def _over(one: Sample, target: float) -> bool:
    assert one.value is not None
    return one.value > target


def _passage(
    below: Sample, above: Sample, target: float, kind: Literal["crossing", "jump", "gap"], *, refined: bool = False
) -> Passage:
    assert below.value is not None
    assert above.value is not None
    part = (target - below.value) / (above.value - below.value) if kind == "crossing" else 0.5
    return Passage(kind, below.x + part * (above.x - below.x), below, above, refined)
