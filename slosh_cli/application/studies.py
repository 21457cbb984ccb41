"""Studies from their plan to their table, figures and claims: what `slosh sweep` and scripts carry out."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping, default_folder, free_folder
from slosh_cli.errors import SloshError, UsageError
from slosh_cli.report.study_pages import Page, View, figure_files, named, pages
from slosh_cli.results.result import Status
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.study.build import grid, paper_wagon
from slosh_cli.study.claims import applies, verdicts
from slosh_cli.study.journal import JOURNAL, Journal
from slosh_cli.study.key import extends, study_key
from slosh_cli.study.lock import LOCK, is_held, locked
from slosh_cli.study.plan import SOLID, Study
from slosh_cli.study.runner import HISTORIES, Plan, Workers, answer, plan, run_study
from slosh_cli.study.table import TABLE, columns, rows
from slosh_cli.study.threads import Threads, available_cores, warm_up

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from slosh_cli.application.plotting import Figures
    from slosh_cli.study.claims import Verdict

_AS_FITS: Final = View()
_MOST_PAGES: Final = 12


@dataclass(frozen=True)
class OpenStudy:
    """A study that is being carried out: its folder is locked, its journal open, every stop looked up in it."""

    study: Study
    planned: Plan
    journal: Journal

    @property
    def folder(self) -> Path:
        """The study's folder."""
        return self.planned.folder

    @property
    def warnings(self) -> list[str]:
        """What to know of the stops that were finished before."""
        damaged = len(self.journal.unsound)
        rows = "1 stop does" if damaged == 1 else f"{damaged} stops do"
        return [f"{rows} not match the checksum in {self.journal.path}: computed again"] if damaged else []

    def begin_session(self) -> int:
        """Note in the journal who computes; returns how many stops in it are by another build of the solver."""
        from slosh_cli.compiled import SOURCES

        others = self.journal.other_sources(SOURCES)
        self.journal.begin_session(SOURCES)
        return others

    def warm_up(self) -> None:
        """Load or compile the kernels of every liquid here and now, where an interrupt is heard."""
        for index in self.study.liquids.values():
            warm_up(self.study.stop(index).scenario)

    def compute(self, workers: Workers, cancel: Event, progress: Callable[[int, int], None]) -> None:
        """Run what is open, told to `progress` as done and total, until all is done or `cancel` is set."""
        run_study(self.study, self.planned, self.journal, workers, cancel=cancel, report=progress)

    def rows(self) -> Iterator[dict[str, Any]]:
        """The rows of all stops that have been computed, read as they are asked for."""
        return rows(self.study, lambda index: answer(self.study, self.planned, self.journal, index))

    def claims(self) -> dict[str, list[Verdict]]:
        """What the paper says of its Figure 3 by model of the liquid, where the study is that figure."""
        if not applies(self.study, paper_wagon()):
            return {}
        found = list(self.rows())
        models = dict.fromkeys(str(row["liquid"]) for row in found)
        return {model: verdicts(found, model) for model in models if model != SOLID}

    def keep_table(self, keeping: Keeping) -> str | None:
        """Write the table, in place of that and the figures of an earlier study; returns its path if it could be."""
        from slosh_cli.results.tables import write_rows

        names = partial(columns, self.study)
        write = {TABLE: lambda path: write_rows(names(self.rows()), self.rows(), path)}
        files = keeping.keep(self.folder, [TABLE, *figure_files(self.folder)], write, {})
        if not files:  # a table of other stops than the journal's must not stand beside it
            with suppress(OSError):
                (self.folder / TABLE).unlink()
        return next(iter(files), None)

    def keep_figures(self, keeping: Keeping, more: Callable[[int, int], None], view: View = _AS_FITS) -> list[str]:
        """Draw the figures; returns those that are there, as paths.

        `more` is told how many would be needed and how many are drawn, where these differ.
        """
        with keeping.part("the figures"):
            drawn = _pages(self.study, self.rows(), more, view)
            if drawn:
                from slosh_cli.report.study_figures import draw_study

                draw_study(drawn, self.folder)
        unwritten = self.planned.unwritten
        if unwritten:
            keeping.failures.append(f"{len(unwritten)} histories: {unwritten[0]}; the same command tries them again")
        return [str(self.folder / name) for name in figure_files(self.folder)]


@contextmanager
def opened(study: Study, folder: Path, *, fresh: bool = False) -> Iterator[OpenStudy]:
    """Take `folder` for the study and look its stops up; `fresh` forgets what was computed before.

    Raises SloshError where the study cannot be begun: no sound value, a folder in use, files that cannot be written.
    """
    from slosh_cli.results.files import try_targets

    study.check()
    try_targets(folder, (TABLE, JOURNAL, LOCK, "braking_distance.png", "braking_distance.svg"))
    if study.histories:
        try_targets(folder / HISTORIES, (f"{'0' * 20}.h5",))
    with locked(folder):
        if fresh:
            Journal.remove(folder / JOURNAL)
        with Journal(folder / JOURNAL) as journal:
            planned = plan(study, journal, folder)
            journal.note_study(study_key(study))
            yield OpenStudy(study, planned, journal)


def workers_for(stops: int, threads: int | None = None, cluster: str | None = None) -> AbstractContextManager[Workers]:
    """Who computes: the cluster, or as many threads as cores, `threads` or `stops`, whichever is least."""
    if cluster is not None:
        from slosh_cli.study.cluster import Cluster

        return Cluster(cluster)
    return nullcontext(Threads(max(1, min(threads or available_cores(), stops))))


def study_folder(study: Study, given: Path | None, settings: Sequence[str] | None, note: Callable[[str], None]) -> Path:
    """The folder of a study: that `given`, that of an earlier study which it repeats or extends, or a new one."""

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

    return given or free_folder(default_folder(study.name, settings), fits, note)


def _pages(
    study: Study, found: Iterator[dict[str, Any]], more: Callable[[int, int], None], view: View = _AS_FITS
) -> list[Page]:
    """The figures of a study, no more than can be looked at."""
    drawn = pages(study, found, view)
    if len(drawn) > _MOST_PAGES:
        more(len(drawn), _MOST_PAGES)
    return drawn[:_MOST_PAGES]


@dataclass(frozen=True, eq=False, repr=False)
class StudyResult:
    """A grid of stops. `rows` are those of its table in the order of the grid, unit in the column names.

    reused: stops that an earlier study in the same folder had computed. claims: what became of the paper's claims, by
    model of the liquid, where the study is its Figure 3. files: where the table and the figures lie, if they were to be
    kept; warnings say what could not be, and what of an earlier study could not be used.
    """

    study: Study
    rows: Sequence[Mapping[str, Any]]
    reused: int
    claims: Mapping[str, Sequence[Verdict]]
    files: Mapping[str, Any]
    warnings: Sequence[str]

    def __repr__(self) -> str:
        return f"StudyResult({self.study.name}: {len(self.rows)} stops, {len(self.failed)} failed)"

    @property
    def failed(self) -> list[Mapping[str, Any]]:
        """The rows of the stops that ended without anything to tell; `reason` says why."""
        return [row for row in self.rows if Status(row["status"]).is_failure]

    def to_frame(self) -> pd.DataFrame:
        """The table as a DataFrame, as `slosh sweep` writes it."""
        import pandas as pd

        names = columns(self.study, map(dict, self.rows))
        return pd.DataFrame([dict(row) for row in self.rows], columns=names)

    def figures(self) -> Figures:
        """What draws braking distance against what varies; several figures where one would be crowded."""

        def draw(page: Page) -> Figure:
            from slosh_cli.report.study_figures import study_figure

            return study_figure(page)

        found = _pages(self.study, map(dict, self.rows), lambda *_: None)
        return {name: partial(draw, page) for name, page in named(found).items()}


def sweep(
    scenario: Scenario | TrainScenario | str | Path | None = None,
    vary: Mapping[str, Any] | None = None,
    *,
    threads: int | None = None,
    cluster: str | None = None,
    folder: str | Path | None = None,
    histories: bool = False,
    fresh: bool = False,
    progress: Callable[[int, int], None] = lambda *_: None,
    cancel: Event | None = None,
) -> StudyResult:
    """Run a grid of stops, liquid and equivalent solid each; without a scenario of the paper's wagon.

    `vary` is key path -> values: a list or a range as a text (``"2.5:30:2.5 kN m"``), or a sequence of texts and SI
    numbers; without it a few values around the scenario's own speed and torque, without a scenario the grid of the
    paper's Figure 3. The file of a study will do for a scenario. With a
    `folder` the files are those of `slosh sweep`, and stops that lie there already are not computed again. `threads`
    default to the cores; `cluster` is the address of a Dask scheduler instead. `progress` is told how many stops of how
    many are done; once `cancel` is set, the result has the stops that were done by then.
    Raises ScenarioError and UsageError for what cannot be used, before anything runs.
    """
    if histories and folder is None:
        raise UsageError("histories are files: give a folder to keep them in", "folder")
    study = grid(scenario, vary, histories=histories)
    keeping, files = Keeping(), {}
    place = nullcontext(str(folder)) if folder is not None else tempfile.TemporaryDirectory(prefix="slosh-")
    with place as name, opened(study, Path(name), fresh=fresh) as work:
        keeping.failures += work.warnings
        if work.planned.open:
            with workers_for(len(work.planned.open), threads, cluster) as workers:
                work.begin_session()
                if cluster is None:
                    work.warm_up()
                work.compute(workers, cancel or Event(), progress)
        if folder is not None:
            table = work.keep_table(keeping)
            files = {"table": table, "figures": work.keep_figures(keeping, lambda *_: None)}
        found = tuple(work.rows())
        return StudyResult(study, found, work.planned.reused, work.claims(), files, tuple(keeping.failures))
