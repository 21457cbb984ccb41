"""A study from its plan to its table, figures and words: what `slosh sweep` does once it knows what is asked for."""

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import complain, note, say, say_json, warn

if TYPE_CHECKING:
    from slosh_cli.study.claims import Verdict
    from slosh_cli.study.journal import Journal
    from slosh_cli.study.plan import Study
    from slosh_cli.study.runner import Plan, Workers


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
    from slosh_cli.study.lock import locked
    from slosh_cli.study.runner import plan

    task.study.check()
    with locked(task.folder):
        path = task.folder / JOURNAL
        if task.fresh:
            remove(path)
        with Journal(path) as journal:
            planned = plan(task.study, journal, task.folder)
            interrupted = _compute(task, planned, journal)
            return _conclude(task, planned, journal, interrupted=interrupted)


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
            run_study(task.study, planned, journal, workers, task.folder, cancel=cancel, report=progress)
    return interrupted.is_set()


def _prepare(task: Task, planned: "Plan", journal: "Journal") -> None:
    """Compile or load the kernels where an interrupt is heard; note in the journal who computes."""
    from slosh_cli.compiled import CACHE_FOLDER

    sources = CACHE_FOLDER.name
    others = journal.other_sources(sources)
    if others:
        warn(f"{others} stops in the journal are by another build of the solver; --fresh computes them anew")
    journal.begin_session(sources)
    if task.cluster is None:
        from slosh_cli.cli.progress import announce_compilation
        from slosh_cli.study.threads import warm_up

        announce_compilation()
        warm_up(task.study.stop(planned.open[0]).scenario)


def _import_ahead() -> None:
    """Import what the end needs while the stops run: kernels leave the interpreter to others."""
    import rich.table

    import slosh_cli.report.study_figures

    del rich, slosh_cli


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
    from slosh_cli.study.runner import answer
    from slosh_cli.study.table import TABLE, columns, rows, write_study_table

    study, table = task.study, task.folder / TABLE

    def found() -> Iterator[dict[str, Any]]:
        return rows(study, lambda index: answer(study, planned, journal, index))

    written = write_study_table(columns(study, found()), found(), table)
    if interrupted:
        again = "the command without --fresh" if task.fresh else "the same command"
        note(f"{written} of {study.size} stops are finished and kept in {task.folder}; {again} goes on from there.")
        raise KeyboardInterrupt
    figures = _draw(task, found())
    claims = claim_text(_verdicts(task, found()))
    failures = failure_lines(study, found())
    outside = "\n".join(verdict_lines(found()))
    failed = sum(row["status"] != "stopped" for row in found())
    if task.as_json:
        _say_answer(task, written - failed, failed, planned.reused, table, figures)
        if claims:
            note(claims)
    else:
        show_study(study, found())
        if claims:
            say(claims)
        say("\n" + "\n".join([f"  table    {table}", *(f"  figure   {figure}" for figure in figures)]))
        say(f"{written} stops in {time.perf_counter() - task.began:.1f} s, {planned.reused} of them from the journal")
    if outside:
        note(outside)
    if failed:
        complain(f"{failed} of {written} stops ended without an answer:\n" + "\n".join(failures))
    return ExitCode.NO_ANSWER if failed else ExitCode.DONE


def _draw(task: Task, rows: Iterator[dict[str, Any]]) -> list[Path]:
    from slosh_cli.cli.sweep_figures import pages

    drawn = pages(task.study, rows)
    if not drawn:
        return []
    from slosh_cli.report.study_figures import MOST_PAGES, draw_study

    if len(drawn) > MOST_PAGES:
        note(f"{len(drawn)} figures would be needed; the first {MOST_PAGES} are drawn, the table has everything")
    return draw_study(drawn[:MOST_PAGES], task.folder)


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


def _say_answer(task: Task, done: int, failed: int, reused: int, table: Path | None, figures: list[Path]) -> None:
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
        _say_answer(task, 0, 0, planned.reused, None, [])
    tell = note if task.as_json else say
    tell(grid_words(task.study))
    tell(f"{planned.reused} finished before, {len(planned.open)} to run: about {duration(total)} on {words}")
    return ExitCode.DONE
