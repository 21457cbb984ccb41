"""What `slosh sweep` does and says once it knows what is asked for."""

import signal
import threading
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.interrupts import note_heard
from slosh_cli.cli.keeping import told
from slosh_cli.cli.output import note, say, say_json, warn
from slosh_cli.report.study_pages import View, pages

if TYPE_CHECKING:
    from slosh_cli.application.studies import OpenStudy
    from slosh_cli.study.plan import Study

_ENDINGS: Final = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


_LARGE: Final = 2000
"""Stops whose planning is told of."""


@dataclass(frozen=True)
class Task:
    """A study and the way it is to be run."""

    study: "Study"
    folder: Path
    jobs: int | None
    cluster: str | None
    fresh: bool
    as_json: bool
    began: float
    view: View


def carry_out(task: Task) -> ExitCode:
    """Compute what the journal lacks, write table and figures; raises SloshError where the study cannot be begun."""
    from slosh_cli.application.studies import opened

    pages(task.study, (), task.view)  # a view that cannot be is refused before anything runs
    _announce_plan(task)
    with opened(task.study, task.folder, fresh=task.fresh) as work:
        interrupted = _compute(task, work)
        return _conclude(task, work, interrupted=interrupted)


def _announce_plan(task: Task) -> None:
    """Say that a large study is planned: every stop is checked, which takes its time before the first one runs."""
    if task.study.size > _LARGE:
        note(f"{task.study.size:,} stops; each is checked and looked up in the journal before the first one runs")


def _compute(task: Task, work: "OpenStudy") -> bool:
    """Run what is open; returns whether it was interrupted."""
    from slosh_cli.application.studies import workers_for
    from slosh_cli.cli.progress import StopsProgress
    from slosh_cli.cli.sweep_output import grid_words

    planned = work.planned
    reused = f", {planned.reused} of them finished before" if planned.reused else ""
    note(grid_words(task.study) + reused)
    for warning in work.warnings:
        warn(warning)
    if not planned.open:
        return False
    cancel = threading.Event()
    with workers_for(len(planned.open), task.jobs, task.cluster) as workers:
        _prepare(task, work)
        note(f"{len(planned.open)} to run on {workers.words}")
        threading.Thread(target=_import_ahead).start()
        with StopsProgress() as progress, _interruptible(cancel) as interrupted:
            work.compute(workers, cancel, progress)
    return interrupted.is_set()


def _prepare(task: Task, work: "OpenStudy") -> None:
    """Compile or load the kernels where an interrupt is heard; note in the journal who computes."""
    from slosh_cli.cli.progress import announce_solver

    others = work.begin_session()
    if others:
        warn(f"{others} stops in the journal are by another build of the solver; --fresh computes them anew")
    if task.cluster is None:
        announce_solver(work.study.liquids)
        work.warm_up()


def _import_ahead() -> None:
    """Import what the end needs while the stops run: kernels leave the interpreter to others."""
    with suppress(Exception):  # told where it is needed
        import_module("rich.table")
        import_module("slosh_cli.report.study_figures")


@contextmanager
def _interruptible(cancel: threading.Event) -> Iterator[threading.Event]:
    """Turn the first Ctrl-C (or the end of a batch job) into `cancel`; yields an event that tells whether it came.

    What is in hand can so be brought to an end in good order. A second Ctrl-C interrupts at once.
    """
    interrupted = threading.Event()

    def stop(number: int, _frame: object) -> None:
        note_heard()
        interrupted.set()
        cancel.set()
        signal.signal(number, earlier[number])

    earlier: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        earlier = {int(number): signal.signal(number, stop) for number in _ENDINGS}
    try:
        yield interrupted
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)


def _conclude(task: Task, work: "OpenStudy", *, interrupted: bool) -> ExitCode:
    """Write the table and the figures, and tell what came out."""
    from slosh_cli.cli.sweep_output import claim_text, show_study, tell_troubles
    from slosh_cli.results.result import Status

    keeping = Keeping()
    if work.journal.restored:
        warn(f"{work.journal.path} was removed while the study ran; it has been written anew with every finished stop")
    counts = Counter(Status(row["status"]) for row in work.rows())
    written, failed = counts.total(), sum(counts[status] for status in counts if status.is_failure)
    table = work.keep_table(keeping)
    if interrupted:
        again = "the command without --fresh" if task.fresh else "the same command"
        finished = f"{written} of {task.study.size} stops are finished and kept in {task.folder}"
        note(f"{finished}; {again} goes on from there.")
        told(keeping)
        raise KeyboardInterrupt
    claims = claim_text(work.claims())
    if not task.as_json:
        show_study(task.study, work.rows(), task.view)
        if claims:
            say(claims)
    figures = work.keep_figures(keeping, _some_of_them, task.view)
    if task.as_json:
        _say_answer(task, written - failed, failed, work.planned.reused, table, figures, keeping.failures)
        if claims:
            note(claims)
    else:
        _say_files(table, figures)
        reused = f"{work.planned.reused} of them from the journal"
        say(f"{written} stops in {time.perf_counter() - task.began:.1f} s, {reused}")
    tell_troubles(task.study, work.rows, counts)
    return told(keeping, ExitCode.NO_ANSWER if failed else ExitCode.DONE)


def _some_of_them(needed: int, drawn: int) -> None:
    note(f"{needed} figures would be needed; the first {drawn} are drawn, the table has everything")


def _say_files(table: str | None, figures: Sequence[str]) -> None:
    say("\n".join(["", *([f"  table    {table}"] if table else []), *(f"  figure   {figure}" for figure in figures)]))


def _say_answer(
    task: Task, done: int, failed: int, reused: int, table: str | None, figures: list[str], warnings: list[str]
) -> None:
    say_json(
        {
            "name": task.study.name,
            "runs": task.study.size,
            "done": done,
            "failed": failed,
            "reused": reused,
            "table": table,
            "figures": figures,
            "wall_seconds": time.perf_counter() - task.began,
            **({"warnings": warnings} if warnings else {}),
        }
    )


def estimate(task: Task) -> ExitCode:
    """How many stops, how many of them are finished, and about how long the others take."""
    from slosh_cli.application.studies import workers_for
    from slosh_cli.cli.progress import duration
    from slosh_cli.cli.sweep_output import grid_words
    from slosh_cli.study.estimate import seconds_per_stop
    from slosh_cli.study.journal import JOURNAL, Journal
    from slosh_cli.study.runner import plan

    _announce_plan(task)
    path = task.folder / JOURNAL
    known = path.exists() and not task.fresh
    with Journal(path, read_only=True) if known else nullcontext() as journal:
        planned = plan(task.study, journal, task.folder)
        each = seconds_per_stop(task.study, planned, journal)
    with workers_for(max(len(planned.open), 1), task.jobs, task.cluster) as workers:
        words = workers.words
        total = each * len(planned.open) / workers.threads
    if task.as_json:
        _say_answer(task, 0, 0, planned.reused, None, [], [])
    tell = note if task.as_json else say
    tell(grid_words(task.study))
    tell(f"{planned.reused} finished before, {len(planned.open)} to run: about {duration(total)} on {words}")
    return ExitCode.DONE
