"""A study from its plan to its table, figures and words: what `slosh sweep` does once it knows what is asked for."""

import re
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import Keeping, default_folder, free_folder
from slosh_cli.cli.output import complain, note, say, say_json, warn

if TYPE_CHECKING:
    from slosh_cli.study.claims import Verdict
    from slosh_cli.study.journal import Journal
    from slosh_cli.study.plan import Study
    from slosh_cli.study.runner import Plan, Workers


_FIGURE: Final = re.compile(r"braking_distance(?:_(?P<number>\d+))?\.(?P<kind>png|svg)")


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

    def workers(self, stops: int) -> AbstractContextManager["Workers"]:
        """Who computes: the cluster, or as many threads as cores, jobs or stops, whichever is least."""
        from slosh_cli.study.threads import Threads, available_cores

        if self.cluster is not None:
            from slosh_cli.study.cluster import Cluster

            return Cluster(self.cluster)
        return nullcontext(Threads(max(1, min(self.jobs or available_cores(), stops))))


def run(task: Task) -> ExitCode:
    """Compute what the journal lacks, write table and figures; raises SloshError where the study cannot be begun."""
    from slosh_cli.study.journal import JOURNAL, Journal, remove
    from slosh_cli.study.key import study_key
    from slosh_cli.study.lock import locked
    from slosh_cli.study.runner import plan

    task.study.check()
    _try_targets(task)
    with locked(task.folder):
        path = task.folder / JOURNAL
        if task.fresh:
            remove(path)
        with Journal(path) as journal:
            planned = plan(task.study, journal, task.folder)
            journal.note_study(study_key(task.study))
            interrupted = _compute(task, planned, journal)
            return _conclude(task, planned, journal, interrupted=interrupted)


def _try_targets(task: Task) -> None:
    """Refuse a folder that cannot take what the study will write. Raises FileError."""
    from slosh_cli.results.files import try_targets
    from slosh_cli.study.journal import JOURNAL
    from slosh_cli.study.lock import LOCK
    from slosh_cli.study.runner import HISTORIES
    from slosh_cli.study.table import TABLE

    try_targets(task.folder, (TABLE, JOURNAL, LOCK, "braking_distance.png", "braking_distance.svg"))
    if task.study.histories:
        try_targets(task.folder / HISTORIES, (f"{'0' * 20}.h5",))


def default_folder_of(study: "Study", overrides: Sequence[str]) -> Path:
    """The folder of a study that was given none: that of an earlier study which it repeats or extends, or a new one."""
    from slosh_cli.errors import SloshError
    from slosh_cli.study.journal import JOURNAL, Journal
    from slosh_cli.study.key import extends, study_key
    from slosh_cli.study.lock import is_held
    from slosh_cli.study.table import TABLE

    def fits(folder: Path) -> bool:
        if is_held(folder):  # and refused, with the holder's name, when it is to be taken
            return True
        if not (folder / JOURNAL).exists():
            return not (folder / TABLE).exists()
        try:
            with Journal(folder / JOURNAL, read_only=True) as journal:
                earlier = journal.study()
        except SloshError:  # told when it is opened for good
            return True
        return earlier is None or extends(study_key(study), earlier)

    return free_folder(default_folder(study.name, overrides), fits)


def _compute(task: Task, planned: "Plan", journal: "Journal") -> bool:
    """Run what is open; returns whether it was interrupted."""
    from slosh_cli.cli.sweep_output import grid_words
    from slosh_cli.cli.sweep_progress import StopsProgress
    from slosh_cli.study.runner import run_study

    reused = f", {planned.reused} of them finished before" if planned.reused else ""
    note(grid_words(task.study) + reused)
    if not planned.open:
        return False
    cancel = threading.Event()
    with task.workers(len(planned.open)) as workers:
        _prepare(task, planned, journal)
        note(f"{len(planned.open)} to run on {workers.words}")
        threading.Thread(target=_import_ahead).start()
        with StopsProgress() as progress, _interruptible(cancel) as interrupted:
            run_study(task.study, planned, journal, workers, cancel=cancel, report=progress)
    return interrupted.is_set()


def _prepare(task: Task, planned: "Plan", journal: "Journal") -> None:
    """Compile or load the kernels where an interrupt is heard; note in the journal who computes."""
    from slosh_cli.compiled import SOURCES

    others = journal.other_sources(SOURCES)
    if others:
        warn(f"{others} stops in the journal are by another build of the solver; --fresh computes them anew")
    journal.begin_session(SOURCES)
    if task.cluster is None:
        from slosh_cli.cli.progress import announce_compilation
        from slosh_cli.study.threads import warm_up

        announce_compilation()
        warm_up(task.study.stop(planned.open[0]).scenario)


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
        interrupted.set()
        cancel.set()
        signal.signal(number, earlier[number])

    earlier: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        earlier = {int(number): signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield interrupted
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)


def _conclude(task: Task, planned: "Plan", journal: "Journal", *, interrupted: bool) -> ExitCode:
    """Write the table and the figures, and tell what came out."""
    from slosh_cli.cli.sweep_output import claim_text, failure_lines, show_study, verdict_lines
    from slosh_cli.results.result import Status
    from slosh_cli.results.tables import write_rows
    from slosh_cli.study.runner import answer
    from slosh_cli.study.table import TABLE, columns, rows

    study, keeping = task.study, Keeping()

    def found() -> Iterator[dict[str, Any]]:
        return rows(study, lambda index: answer(study, planned, journal, index))

    def write(path: Path) -> None:
        write_rows(columns(study, found()), found(), path)

    statuses = [Status(row["status"]) for row in found()]
    written, failed = len(statuses), sum(status.is_failure for status in statuses)
    unanswered = sum(status is not Status.STOPPED for status in statuses)
    owned = [TABLE, *_figures(task.folder)]
    table = next(iter(keeping.keep(task.folder, owned, {TABLE: write}, {})), None)
    if interrupted:
        again = "the command without --fresh" if task.fresh else "the same command"
        note(f"{written} of {study.size} stops are finished and kept in {task.folder}; {again} goes on from there.")
        keeping.told()
        raise KeyboardInterrupt
    verdicts = _verdicts(task, found())
    if not task.as_json:
        show_study(study, found())
        if verdicts:
            say(claim_text(verdicts))
    with keeping.part("the figures"):
        _draw(task, found())
    if planned.unwritten:
        keeping.failures.append(
            f"{len(planned.unwritten)} histories: {planned.unwritten[0]}; the same command tries them again"
        )
    figures = [str(task.folder / name) for name in _figures(task.folder)]
    if task.as_json:
        _say_answer(task, written - failed, failed, planned.reused, table, figures, keeping.failures)
        if verdicts:
            note(claim_text(verdicts))
    else:
        lines = [f"  table    {table}"] if table else []
        say("\n".join(["", *lines, *(f"  figure   {figure}" for figure in figures)]))
        say(f"{written} stops in {time.perf_counter() - task.began:.1f} s, {planned.reused} of them from the journal")
    outside = verdict_lines(found())
    if outside:
        note("\n".join(outside))
    if unanswered:
        tell = complain if failed else note
        tell("\n".join([f"{unanswered} of {written} stops ended without an answer:", *failure_lines(study, found())]))
    return keeping.told(ExitCode.NO_ANSWER if failed else ExitCode.DONE)


def _figures(folder: Path) -> list[str]:
    """Names of the figures of studies in `folder`, by their numbers."""
    found = [(match, file.name) for file in folder.iterdir() if (match := _FIGURE.fullmatch(file.name))]
    return [name for _, name in sorted(found, key=lambda one: (int(one[0]["number"] or 0), one[0]["kind"]))]


def _draw(task: Task, rows: Iterator[dict[str, Any]]) -> None:
    from slosh_cli.cli.sweep_figures import pages

    drawn = pages(task.study, rows)
    if not drawn:
        return
    from slosh_cli.report.study_figures import MOST_PAGES, draw_study

    if len(drawn) > MOST_PAGES:
        note(f"{len(drawn)} figures would be needed; the first {MOST_PAGES} are drawn, the table has everything")
    draw_study(drawn[:MOST_PAGES], task.folder)


def _verdicts(task: Task, rows: Iterator[dict[str, Any]]) -> "dict[str, list[Verdict]]":
    """What the paper says of its Figure 3 by model of the liquid, where the study is that figure."""
    from slosh_cli.study.build import paper_wagon
    from slosh_cli.study.claims import applies, verdicts
    from slosh_cli.study.plan import LIQUID, SOLID

    if not applies(task.study, paper_wagon()):
        return {}
    models = next(axis.values for axis in task.study.axes if axis.key == LIQUID)
    found = list(rows)
    return {model: verdicts(found, model) for model in models if model != SOLID}


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
    from slosh_cli.cli.sweep_estimate import seconds_per_stop
    from slosh_cli.cli.sweep_output import grid_words
    from slosh_cli.cli.sweep_progress import duration
    from slosh_cli.study.journal import JOURNAL, Journal
    from slosh_cli.study.runner import plan

    path = task.folder / JOURNAL
    known = path.exists() and not task.fresh
    with Journal(path, read_only=True) if known else nullcontext() as journal:
        planned = plan(task.study, journal, task.folder)
        each = seconds_per_stop(task.study, planned, journal)
    with task.workers(max(len(planned.open), 1)) as workers:
        words = workers.words
        total = each * len(planned.open) / workers.threads
    if task.as_json:
        _say_answer(task, 0, 0, planned.reused, None, [], [])
    tell = note if task.as_json else say
    tell(grid_words(task.study))
    tell(f"{planned.reused} finished before, {len(planned.open)} to run: about {duration(total)} on {words}")
    return ExitCode.DONE
