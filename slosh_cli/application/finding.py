"""Where an answer passes a value along one key, and where it is least: `slosh find`, `slosh optimum` and scripts."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping, by_kind
from slosh_cli.application.plotting import writers
from slosh_cli.errors import UsageError
from slosh_cli.report import FORMATS
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.study import search
from slosh_cli.study.outcome import FinishedStop
from slosh_cli.study.question import LOCK, Asked, asked_answer, asked_limit, asked_value
from slosh_cli.study.search import Passage, Sample, Sampled
from slosh_cli.study.span import Span, checked_count, spanned
from slosh_cli.study.threads import Threads, available_cores, warm_up

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from slosh_cli.application.plotting import Figures

_SCAN: Final = 17
_DISTANCE: Final = "braking_distance"
_Source = Scenario | TrainScenario | str | Path
_Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Search:
    """What is asked for: an answer along a range, within limits; the scan has `points` stops."""

    span: Span
    asked: Asked
    limits: tuple[Asked, ...]
    points: int
    crossing: int = 1
    most: bool = False

    @property
    def tolerance(self) -> float:
        """That of the solver."""
        base = self.span.base.base
        return (base.vehicles[0] if isinstance(base, TrainScenario) else base).solver.tolerance

    def sampled(self, threads: int | None, progress: _Progress, cancel: Event) -> Sampled:
        """The curve, whose stops are computed side by side when they are asked for."""
        warm_up(self.span.study([self.span.low]).stop(0).scenario)
        workers, done = Threads(threads or available_cores()), 0

        def compute(places: Sequence[float]) -> list[Sample]:
            nonlocal done
            study = self.span.study(places)
            stops = [replace(study.stop(number), history=True) for number in range(len(places))]
            found: list[Sample] = []
            for batch in workers.outcomes(iter(stops), len(stops), cancel):
                found += [self._sample(places[one.index], one) for one in batch]
                done += len(batch)
                progress(done, max(self.points + 12, done + 1))
            return found

        return Sampled(compute, self.span.low, self.span.high)

    def _sample(self, place: float, stop: FinishedStop) -> Sample:
        result = stop.result
        value = self.asked.value(result) if result is not None else None
        kept = {one.words: one.keeps(one.value(result)) for one in self.limits} if result is not None else {}
        signed = -value if self.most and value is not None else value
        return Sample(place, signed, kept, stop.status, str(stop.answer.get("reason") or ""), stop.answer)


@dataclass(frozen=True, eq=False, repr=False)
class Searched:
    """What a search found. `samples` are its stops by the value of the key, in the unit of its range.

    value: the key's value that was asked for, in `unit`; None where no stop has it, and `kind` says why.
    kind of a find: `crossing`, `change` (a lock begins), `jump` (leapt over), `gap` (no answer between), `none`.
    kind of an optimum: `inside`, `end` of the range, `limit`, `jump` or `gap` beside it, `none` within the limits.
    passages: every place where the answer passes the value, of a find. best, flat: the best stop and the values between
    which others are as good, of an optimum.
    """

    search: Search
    samples: tuple[Sample, ...]
    kind: str
    value: float | None
    passages: tuple[Passage, ...] = ()
    best: Sample | None = None
    flat: tuple[float, float] | None = None

    def __repr__(self) -> str:
        return f"Searched({self.search.span.key}: {self.kind}, {self.text or 'no value'})"

    @property
    def unit(self) -> str:
        """Unit of the key's values, empty without one."""
        return self.search.span.unit

    @property
    def text(self) -> str:
        """The value as a scenario has it."""
        return "" if self.value is None else self.search.span.text(self.value, 6)

    @property
    def passage(self) -> Passage | None:
        """The passage that was asked for."""
        number = self.search.crossing - 1
        return self.passages[number] if number < len(self.passages) else None

    def side(self, sample: Sample) -> dict[str, Any]:
        """A stop in plain values: the key's value, the answer in SI, how it ended."""
        value = -sample.value if self.search.most and sample.value is not None else sample.value
        told = {"value": sample.x, "answer": value, "status": sample.status, "reason": sample.reason}
        return (
            told
            | {"braking_distance_m": sample.row.get("braking_distance_m")}
            | ({"limits": dict(sample.limits)} if self.search.limits else {})
        )

    def as_dict(self) -> dict[str, Any]:
        """Plain values, with the keys of `slosh find --json` and `slosh optimum --json` but for `files`."""
        span, asked = self.search.span, self.search.asked
        found: dict[str, Any] = {
            "name": span.base.name, "key": span.key, "unit": span.unit, "low": span.low, "high": span.high,
            "range": span.words, "answer": asked.name, "answer_unit": asked.unit, "kind": self.kind,
            "value": self.value, "stops": len(self.samples),
        }  # fmt: skip
        if self.best is not None:
            found |= {"best": self.side(self.best), "as_good_between": self.flat}
        if asked.sign or asked.name == LOCK:
            found |= {"target": asked.target, "crossings": [self._passage(one) for one in self.passages]}
        ends = {"at_low": self.side(self.samples[0]), "at_high": self.side(self.samples[-1])}
        return found | ends | {"unanswered": sum(one.value is None for one in self.samples)}

    def _passage(self, one: Passage) -> dict[str, Any]:
        kind = "change" if one.kind == "jump" and self.search.asked.name == LOCK else one.kind
        sides = {"below": self.side(one.below), "above": self.side(one.above)}
        return {"kind": kind, "value": one.x, "refined": one.refined} | sides

    def figures(self) -> Figures:
        """What draws the curve with every stop, the value that was found and the limits."""

        def draw() -> Figure:
            from slosh_cli.report.search_figure import search_figure

            return search_figure(self)

        return {self.stem: draw}

    @property
    def stem(self) -> str:
        """Name of its files."""
        asked = self.search.asked
        best = "-".join(["optimum", asked.name, *(one.words for one in self.search.limits)])
        words = asked.words if asked.sign or asked.name == LOCK else best
        words = words.replace("<=", "-to-").replace(">=", "-from-")
        return re.sub(r"[^\w.=-]+", "-", f"{self.search.span.key}-{words}")[:150]


def find_search(
    source: _Source, vary: str, until: str, overrides: Sequence[str] = (), points: int = _SCAN, crossing: int = 1
) -> Search:
    """The search that is asked for. Raises UsageError and ScenarioError for what cannot be used."""
    if crossing < 1:
        raise UsageError(f"--crossing must be at least 1; given `{crossing}`; write `--crossing 1`", "--crossing")
    span = spanned(source, vary, overrides)
    return Search(span, asked_value(until, _is_train(span), "--until"), (), checked_count(points), crossing)


def optimum_search(
    source: _Source, vary: str, within: Sequence[str] = (), least: str | None = None, most: str | None = None,
    overrides: Sequence[str] = (), points: int = _SCAN,
) -> Search:  # fmt: skip
    """The search that is asked for; errors as of `find_search`."""
    if least is not None and most is not None:
        raise UsageError("--least and --most ask for two optima; leave one of them out", "--most")
    span = spanned(source, vary, overrides)
    asked = asked_answer(most or least or _DISTANCE, _is_train(span), "--most" if most else "--least")
    limits = tuple(asked_limit(text, _is_train(span), "--within") for text in within)
    return Search(span, asked, limits, checked_count(points), most=most is not None)


def _is_train(span: Span) -> bool:
    return isinstance(span.base.base, TrainScenario)


def carry_out_search(
    asked: Search, *, threads: int | None = None, progress: _Progress = lambda *_: None, cancel: Event | None = None
) -> Searched:
    """Scan the range, then come near to what is asked for."""
    sampled = asked.sampled(threads, progress, cancel or Event())
    sampled.scan(asked.points)
    return _found(asked, sampled) if asked.asked.sign or asked.asked.name == LOCK else _optimum(asked, sampled)


def _found(asked: Search, sampled: Sampled) -> Searched:
    target = asked.asked.target
    passages = search.passages(sampled, target)
    number = asked.crossing - 1
    if number >= len(passages):
        return Searched(asked, tuple(sampled.samples), "none", None, tuple(passages))
    mine = passages[number] = search.refined(sampled, passages[number], target, asked.tolerance)
    kind = "change" if asked.asked.name == LOCK and mine.kind != "gap" else mine.kind
    value = mine.x if kind in ("crossing", "change") else None
    return Searched(asked, tuple(sampled.samples), kind, value, tuple(passages))


def _optimum(asked: Search, sampled: Sampled) -> Searched:
    best = search.least(sampled, asked.tolerance)
    if best is None:
        return Searched(asked, tuple(sampled.samples), "none", None)
    kind, alike = search.beside(sampled, best, asked.tolerance), search.flat(sampled, best, asked.tolerance)
    return Searched(asked, tuple(sampled.samples), kind, best.x, best=best, flat=alike)


def keep_search(found: Searched, folder: Path, keeping: Keeping, *, figures: bool = True) -> dict[str, Any]:
    """Write the table of every stop and the figure into `folder`; returns where those lie that could be."""
    from slosh_cli.results.tables import write_rows

    key = re.sub(r"[^A-Za-z0-9]+", "_", f"{found.search.span.key}_{found.unit}").strip("_")
    rows = [{key: one.x} | dict(one.row) for one in found.samples]
    names = list(dict.fromkeys(name for row in rows for name in row))
    stem = found.stem
    table, drawn = f"{stem}.csv", writers(found.figures()) if figures else {}
    owned = [table, *(f"{stem}.{suffix}" for suffix in FORMATS)]
    return by_kind(keeping.keep(folder, owned, {table: partial(write_rows, names, rows)}, drawn), table=table)


def find(
    scenario: _Source, vary: str, until: str, *, crossing: int = 1, points: int = _SCAN, threads: int | None = None,
    progress: _Progress = lambda *_: None, cancel: Event | None = None,
) -> Searched:  # fmt: skip
    """The value of a key at which an answer of the stop passes a value, on the model itself.

    `vary` is ``"braking.torque=2:30 kN m"``, or the key alone for half to double the scenario's own; `until` is
    ``"first_lock"`` or ``"max_wheel_unloading=0.6"``. The range is scanned with `points` stops, then the `crossing`-th
    passage is closed in to 1e-4 of the value. A jump is told as one, with both sides.
    Raises ScenarioError and UsageError for what cannot be used, before anything runs.
    """
    asked = find_search(scenario, vary, until, points=points, crossing=crossing)
    return carry_out_search(asked, threads=threads, progress=progress, cancel=cancel)


def optimum(
    scenario: _Source, vary: str, *, within: str | Sequence[str] = (), least: str | None = None,
    most: str | None = None, points: int = _SCAN, threads: int | None = None, progress: _Progress = lambda *_: None,
    cancel: Event | None = None,
) -> Searched:  # fmt: skip
    """The value of a key with the shortest braking distance, or the `least` or `most` of another answer.

    `within` are limits that the stop has to keep, ``"max_wheel_unloading<=0.6"``; arguments and errors are those of
    `find` else.
    """
    limits = [within] if isinstance(within, str) else within
    asked = optimum_search(scenario, vary, limits, least, most, points=points)
    return carry_out_search(asked, threads=threads, progress=progress, cancel=cancel)
