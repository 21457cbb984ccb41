"""`slosh run`: one stop, its history, its summary and its figures."""

import threading
from typing import TYPE_CHECKING, Annotated

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile
from slosh_cli.cli.output import note

if TYPE_CHECKING:
    from slosh_cli.results.result import Result
    from slosh_cli.scenario import Scenario


def run_command(
    scenario_file: ScenarioFile,
    output: OutputFolder = None,
    overrides: Overrides = None,
    as_json: AsJson = False,
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Write no figures.")] = False,
) -> ExitCode:
    """One stop of a wagon or a train: history (HDF5), CSV, figures.

    Without -o the folder's name carries what was --set, and a number where it holds the run of another scenario; a run
    of the same scenario, or with -o any run in that folder, is replaced.
    """
    from slosh_cli.scenario.train_file import is_train_file

    if is_train_file(scenario_file):
        from slosh_cli.cli.train import run_train

        return run_train(scenario_file, output, overrides, as_json=as_json, figures=not no_figures)
    from slosh_cli.application.keeping import Keeping, folder_of_run
    from slosh_cli.application.stop import RUN_FILES, keep_run
    from slosh_cli.cli.keeping import answered
    from slosh_cli.cli.reading import load_given
    from slosh_cli.cli.summary import show_run
    from slosh_cli.scenario import load_scenario

    scenario = load_given(load_scenario, scenario_file, overrides)
    folder = folder_of_run(scenario, output, overrides, RUN_FILES, note)
    result = _simulate(scenario)
    keeping = Keeping()
    if not as_json:
        show_run(result)
    files = keep_run(result, folder, keeping, figures=not no_figures)
    return answered(result, files, keeping, as_json=as_json)


def _simulate(scenario: "Scenario") -> "Result":
    """Run the solver with a progress bar; an interrupt stops the solver before it goes on to the user."""
    from slosh_cli.application.stop import simulate
    from slosh_cli.cli.progress import RunProgress, announce_solver

    announce_solver([scenario.tank.liquid.model])
    cancel = threading.Event()
    with RunProgress(scenario.name) as progress:
        try:
            return simulate(scenario, progress=progress, cancel=cancel)
        except KeyboardInterrupt:
            cancel.set()
            raise
