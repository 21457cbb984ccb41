"""Runs a study: what the journal lacks is computed, what is finished is committed at once."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event
from typing import Any, Final, Protocol

from slosh_cli.errors import ScenarioError
from slosh_cli.study.journal import Journal
from slosh_cli.study.outcome import Outcome, without_result
from slosh_cli.study.plan import Stop, Study

HISTORIES: Final = "histories"
"""Folder of the history files inside the study's."""

Report = Callable[[int, int], None]
"""Called with the number of stops finished in this run and of those it has to do."""


class Workers(Protocol):
    """Something that computes stops."""

    @property
    def words(self) -> str:
        """What computes, for people."""
        ...

    @property
    def threads(self) -> int:
        """How many stops are computed at a time."""
        ...

    def outcomes(self, stops: Iterable[Stop], total: int, cancel: Event) -> Generator[list[Outcome], None, None]:
        """Outcomes of the `total` stops as they come, in any order, until all are done or `cancel` is set."""
        ...


@dataclass
class Plan:
    """Every stop of a study by its index: its key, or why its combination of values is no sound scenario.

    `open` are the indices that have to be computed, `reused` counts those the journal holds already.
    """

    keys: list[str | None] = field(default_factory=list)
    unsound: dict[int, str] = field(default_factory=dict)
    open: list[int] = field(default_factory=list)
    reused: int = 0


def history_file(key: str) -> str:
    """Path of a stop's history file within the study's folder."""
    return f"{HISTORIES}/{key[:20]}.h5"


def plan(study: Study, journal: Journal | None, folder: Path) -> Plan:
    """Look every stop up in the journal. Raises ScenarioError where a value can be in no sound scenario.

    A stop whose history is asked for counts as done when its file lies in `folder`, too.
    """
    study.check()
    found, seen = Plan(), set()
    for index in range(study.size):
        try:
            key = study.stop(index).key
        except ScenarioError as error:
            found.keys.append(None)
            found.unsound[index] = error.problems[0].text(study.file)
            continue
        found.keys.append(key)
        if journal is not None and _is_done(study, journal, folder, key):
            found.reused += 1
        elif key not in seen:
            found.open.append(index)
            seen.add(key)
    return found


def _is_done(study: Study, journal: Journal, folder: Path, key: str) -> bool:
    if key not in journal or not study.histories or (folder / history_file(key)).exists():
        return key in journal
    return "steps" not in (journal.answer(key) or {})  # it ended without a result: there is no history to write


def answer(study: Study, plan: Plan, journal: Journal, index: int) -> dict[str, Any] | None:
    """The row of a stop, None while it has not been computed."""
    key = plan.keys[index]
    if key is None:
        return without_result(study.conditions(index), plan.unsound[index])
    row = journal.answer(key)
    if row is not None and study.histories and "steps" in row:
        row["history"] = history_file(key)
    return row


def run_study(
    study: Study, plan: Plan, journal: Journal, workers: Workers, folder: Path, *, cancel: Event, report: Report
) -> int:
    """Compute the open stops of a study, committed to the journal as they come; returns how many came.

    Ends early, without losing what has come, when `cancel` is set. Raises FileError when journal or histories
    cannot be written.
    """
    done, total = 0, len(plan.open)
    if not total:
        return 0
    report(0, total)
    stops = (study.stop(index, plan.keys[index]) for index in plan.open)
    with closing(workers.outcomes(stops, total, cancel)) as outcomes:
        for batch in outcomes:
            for outcome in batch:
                _write_history(outcome, folder)
            if batch:
                journal.add(batch)
                done += len(batch)
                report(done, total)
    return done


def _write_history(outcome: Outcome, folder: Path) -> None:
    if outcome.result is not None:
        from slosh_cli.results.hdf5 import write_history

        write_history(outcome.result, folder / history_file(outcome.key))
