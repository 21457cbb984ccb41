"""`slosh run`: one stop, its history, its summary and its figures."""

import threading
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import Keeping, by_kind, default_folder, free_folder
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile
from slosh_cli.cli.output import complain, say_json, warn

if TYPE_CHECKING:
    from slosh_cli.results.result import Result
    from slosh_cli.scenario import Scenario

_HISTORY: Final = "run.h5"
_SUMMARY: Final = "summary.csv"


def register(app: typer.Typer) -> None:
    """Add the command to the tree."""
    app.command("run")(_run)


def _run(
    scenario_file: ScenarioFile,
    output: OutputFolder = None,
    overrides: Overrides = None,
    as_json: AsJson = False,
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Write no figures.")] = False,
) -> ExitCode:
    """Simulate one stop: history (HDF5), summary (CSV) and figures.

    Without -o the folder's name carries what was --set, and a number where it holds the run of another scenario; a run
    of the same scenario, or with -o any run in that folder, is replaced.
    """
    from slosh_cli.cli.reading import read_scenario
    from slosh_cli.cli.summary import show_files, show_run
    from slosh_cli.results.files import try_targets
    from slosh_cli.results.result import Status

    scenario = read_scenario(scenario_file, overrides)
    folder = output or _default(scenario, overrides)
    try_targets(folder, _files())
    result = _simulate(scenario)
    stopped, keeping = result.status is Status.STOPPED, Keeping()
    if not as_json:
        show_run(result)
    files = _write_run(result, folder, keeping, figures=not no_figures)
    if as_json:
        answer = result.summary()
        say_json(answer | {"warnings": [*answer["warnings"], *keeping.failures], "files": files})
        for warning in result.warnings:
            warn(warning)
        if not stopped:
            complain(f"{result.status}: {result.reason} {result.status.remedy}")
    else:
        show_files(files)
    return keeping.told(ExitCode.DONE if stopped else ExitCode.NO_ANSWER)


def _write_run(result: "Result", folder: Path, keeping: Keeping, *, figures: bool) -> dict[str, Any]:
    """Write history and summary of a run into `folder`, then its figures; returns where those lie that could be.

    What an earlier run left in `folder` goes.
    """
    from slosh_cli.report import FIGURE_NAMES
    from slosh_cli.results.answers import Shown
    from slosh_cli.results.hdf5 import write_history
    from slosh_cli.results.tables import write_table

    def draw(name: str, folder: Path) -> None:
        from slosh_cli.report.figures import draw_run

        draw_run(result, folder, names=(name,))

    numbers = {
        _SUMMARY: lambda path: write_table([result.row(Shown.SUMMARY)], path),
        _HISTORY: lambda path: write_history(result, path),
    }
    drawn = {name: partial(draw, name) for name in FIGURE_NAMES if figures}
    files = keeping.keep(folder, _files(), numbers, drawn)
    return by_kind(files, history=_HISTORY, summary=_SUMMARY)


def _files() -> list[str]:
    """Names of all files that a run may write."""
    from slosh_cli.report import FIGURE_NAMES, FORMATS

    return [_HISTORY, _SUMMARY, *(f"{name}.{suffix}" for name in FIGURE_NAMES for suffix in FORMATS)]


def _default(scenario: "Scenario", overrides: list[str] | None) -> Path:
    """The folder of a run that was given none: of its own, unless what lies there is a run of the same scenario."""
    from slosh_cli.results.hdf5 import is_of

    def fits(folder: Path) -> bool:
        return not (folder / _HISTORY).exists() or is_of(folder / _HISTORY, scenario)

    return free_folder(default_folder(scenario.name, overrides), fits)


def _simulate(scenario: "Scenario") -> "Result":
    """Run the solver with a progress bar; an interrupt stops the solver before it goes on to the user."""
    from slosh_cli.cli.progress import RunProgress, announce_compilation
    from slosh_cli.results.simulate import simulate

    announce_compilation()
    cancel = threading.Event()
    with RunProgress(scenario.name) as progress:
        try:
            return simulate(scenario, progress=progress, cancel=cancel)
        except KeyboardInterrupt:
            cancel.set()
            raise
