"""`slosh run`: one stop, its history, its summary and its figures."""

import os
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile
from slosh_cli.cli.output import complain, say_json, warn

if TYPE_CHECKING:
    from slosh_cli.results.result import Result
    from slosh_cli.scenario import Scenario

HISTORY: Final = "run.h5"
SUMMARY: Final = "summary.csv"


def register(app: typer.Typer) -> None:
    """Add the command to the tree."""
    app.command("run")(run)


def run(
    scenario_file: ScenarioFile,
    output: OutputFolder = None,
    overrides: Overrides = None,
    as_json: AsJson = False,
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Write no figures.")] = False,
) -> ExitCode:
    """Simulate one stop: history (HDF5), summary (CSV) and figures.

    The files of an earlier run in the same folder are replaced once the new ones are whole.
    """
    from slosh_cli.cli.reading import read_scenario
    from slosh_cli.cli.summary import show_run
    from slosh_cli.results.result import Status

    scenario = read_scenario(scenario_file, overrides)
    folder = output or Path("outputs") / scenario.name
    _check_folder(folder)
    result = _simulate(scenario)
    files = write_run(result, folder, figures=not no_figures)
    stopped = result.status is Status.STOPPED
    if as_json:
        say_json(result.summary() | {"files": files})
        for warning in result.warnings:
            warn(warning)
        if not stopped:
            complain(f"{result.status}: {result.reason} {result.status.remedy}")
    else:
        show_run(result, files)
    return ExitCode.DONE if stopped else ExitCode.NO_ANSWER


def write_run(result: "Result", folder: Path, *, figures: bool) -> dict[str, Any]:
    """Write all files of a run into `folder`, together; returns where they lie.

    Files of an earlier run stay as they were until the new ones are whole.
    """
    from slosh_cli.report.figures import FIGURES, draw_run
    from slosh_cli.report.saving import FORMATS
    from slosh_cli.results.files import staging
    from slosh_cli.results.hdf5 import write_history
    from slosh_cli.results.tables import write_summary

    earlier = [f"{name}.{suffix}" for name in FIGURES for suffix in FORMATS]
    with staging(folder, owned=earlier) as stage:
        write_history(result, stage / HISTORY)
        write_summary(result, stage / SUMMARY)
        drawn = draw_run(result, stage) if figures else []
    return {
        "history": str(folder / HISTORY),
        "summary": str(folder / SUMMARY),
        "figures": [str(folder / file.name) for file in drawn],
    }


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


def _check_folder(folder: Path) -> None:
    """Refuse a folder that cannot be written before the run, not after it. Raises FileError."""
    from slosh_cli.results.files import FileError

    nearest = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    if not nearest.is_dir():
        raise FileError(f"cannot write into {folder}: {nearest} is not a folder", str(folder))
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise FileError(f"cannot write into {folder}: no permission in {nearest}", str(folder))
