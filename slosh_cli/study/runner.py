"""Runs a study: what the journal lacks is computed, what is finished is committed at once."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any, Final, Protocol

from slosh_cli.errors import ScenarioError
from slosh_cli.results.files import FileError
from slosh_cli.results.train_result import TrainResult
from slosh_cli.study.journal import Journal
from slosh_cli.study.key import history_key
from slosh_cli.study.outcome import FinishedStop, without_result
from slosh_cli.study.plan import Stop, Study

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario
    from slosh_cli.scenario.train_file import TrainScenario

HISTORIES: Final = "histories"
"""Folder of the history files inside the study's."""

_Report = Callable[[int, int], None]
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

    def outcomes(self, stops: Iterable[Stop], total: int, cancel: Event) -> Generator[list[FinishedStop], None, None]:
        """Outcomes of the `total` stops as they come, in any order, until all are done or `cancel` is set."""
        ...


@dataclass
class Plan:
    """Every stop of a study by its index: its key, or why its combination of values is no sound scenario.

    `histories` are the files of their histories within `folder`, where they are kept; `unwritten` says why some could
    not be. `open` are the indices that have to be computed, `reused` counts those that are there already.
    """

    folder: Path
    keys: list[str | None] = field(default_factory=list)
    histories: dict[int, str] = field(default_factory=dict)
    unsound: dict[int, str] = field(default_factory=dict)
    open: list[int] = field(default_factory=list)
    reused: int = 0
    unwritten: list[str] = field(default_factory=list)


def _history_file(scenario: Scenario | TrainScenario) -> str:
    """Path of a stop's history file within the study's folder: another for every change that the history shows."""
    return f"{HISTORIES}/{history_key(scenario)[:20]}.h5"


def plan(study: Study, journal: Journal | None, folder: Path) -> Plan:
    """Look every stop up in the journal. Raises ScenarioError where a value can be in no sound scenario.

    A stop whose history is asked for counts as done when its file lies in `folder`, too.
    """
    study.check()
    found, seen = Plan(folder), set()
    for index in range(study.size):
        try:
            stop = study.stop(index)
        except ScenarioError as error:
            found.keys.append(None)
            found.unsound[index] = error.problems[0].text(study.file)
            continue
        found.keys.append(stop.key)
        history = _history_file(stop.scenario) if study.histories else ""
        if history:
            found.histories[index] = history
        if journal is not None and _is_done(journal, stop.key, folder / history if history else None):
            found.reused += 1
        elif (stop.key, history) not in seen:
            found.open.append(index)
            seen.add((stop.key, history))
    return found


def _is_done(journal: Journal, key: str, history: Path | None) -> bool:
    if key not in journal or history is None or history.exists():
        return key in journal
    return "steps" not in (journal.answer(key) or {})  # it ended without a result: there is no history to write


def answer(study: Study, plan: Plan, journal: Journal, index: int) -> dict[str, Any] | None:
    """The row of a stop, None while it has not been computed; it names the stop's history where there is one."""
    key = plan.keys[index]
    if key is None:
        return without_result(study.conditions(index), plan.unsound[index])
    row = journal.answer(key)
    if row is not None and index in plan.histories and (plan.folder / plan.histories[index]).exists():
        row["history"] = plan.histories[index]
    return row


def run_study(study: Study, plan: Plan, journal: Journal, workers: Workers, *, cancel: Event, report: _Report) -> int:
    """Compute the open stops of a study, committed to the journal as they come; returns how many came.

    Ends early, without losing what has come, when `cancel` is set. A history that cannot be written costs nothing but
    itself; the plan says so. Raises FileError when the journal cannot be written.
    """
    done, total = 0, len(plan.open)
    if not total:
        return 0
    report(0, total)
    stops = (study.stop(index, plan.keys[index]) for index in plan.open)
    with closing(workers.outcomes(stops, total, cancel)) as outcomes:
        for batch in outcomes:
            if batch:
                journal.add(batch)
                done += len(batch)
            report(done, total)
            for outcome in batch:
                _write_history(outcome, plan)
    return done


def _write_history(outcome: FinishedStop, plan: Plan) -> None:
    if outcome.result is not None:
        from slosh_cli.results.hdf5 import write_history, write_train

        path = plan.folder / _history_file(outcome.result.scenario)
        try:
            if isinstance(outcome.result, TrainResult):
                write_train(outcome.result, path)
            else:
                write_history(outcome.result, path)
        except FileError as error:
            plan.unwritten.append(str(error))
