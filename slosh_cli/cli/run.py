"""`slosh run`: one stop, its history, its summary and its figures."""

import threading
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile
from slosh_cli.cli.output import note, say
from slosh_cli.errors import UsageError

if TYPE_CHECKING:
    from slosh_cli.results.result import Result
    from slosh_cli.scenario import Scenario


_TWIN = "Run the equivalent solid too, into the folder solid of the run's, and say what the liquid did."


def run_command(
    scenario_file: ScenarioFile,
    output: OutputFolder = None,
    overrides: Overrides = None,
    as_json: AsJson = False,
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Write no figures.")] = False,
    twin: Annotated[bool, typer.Option("--twin", help=_TWIN)] = False,
) -> ExitCode:
    """One stop of a wagon or a train: history (HDF5), CSV, figures.

    Without -o the folder's name carries what was --set, and a number where it holds the run of another scenario; a run
    of the same scenario, or with -o any run in that folder, is replaced.
    """
    from slosh_cli.scenario.train_file import is_train_file

    if is_train_file(scenario_file):
        from slosh_cli.cli.train import run_train

        if twin:
            fix = "vary it with `slosh sweep --vary all.tank.liquid.model=modal,rigid`"
            raise UsageError(f"--twin is for single wagons, and {scenario_file} is a train; {fix}", "--twin")
        return run_train(scenario_file, output, overrides, as_json=as_json, figures=not no_figures)
    from slosh_cli.application.keeping import Keeping, folder_of_run
    from slosh_cli.application.stop import RUN_FILES, keep_run
    from slosh_cli.cli.keeping import answered
    from slosh_cli.cli.reading import load_given
    from slosh_cli.cli.summary import show_run
    from slosh_cli.scenario import load_scenario

    scenario = load_given(load_scenario, scenario_file, overrides)
    solid = _solid(scenario) if twin else None
    folder = folder_of_run(scenario, output, overrides, RUN_FILES, note)
    result = _simulate(scenario)
    keeping = Keeping()
    if not as_json:
        show_run(result)
    files = keep_run(result, folder, keeping, figures=not no_figures)
    if solid is None:
        return answered(result, files, keeping, as_json=as_json)
    other = _simulate(solid)
    kept = keep_run(other, folder / "solid", keeping, figures=not no_figures)
    told = _beside(result, other, kept, as_json=as_json)
    code = answered(result, files, keeping, as_json=as_json, more={"twin": told})
    return code if other.braking_distance_m is not None or code is not ExitCode.DONE else ExitCode.NO_ANSWER


def _solid(scenario: "Scenario") -> "Scenario":
    from slosh_cli.application.comparison import solid_twin

    return solid_twin(scenario)


def _beside(liquid: "Result", solid: "Result", files: Mapping[str, Any], *, as_json: bool) -> dict[str, Any]:
    """Say what the liquid did; returns it with the answers and files of the solid, as JSON has them."""
    from slosh_cli.application.comparison import differences, liquid_words

    words = liquid_words(liquid, solid)
    if not as_json:
        say("\n".join(["", "what the liquid did:", *(f"  {one}" for one in words), f"  solid: {files.get('history')}"]))
    found = [one.as_dict() for one in differences([solid, liquid])]
    return {"words": words, "answers": found, "solid": solid.summary() | {"files": files}}


def _simulate(scenario: "Scenario") -> "Result":
    """Run the solver with a progress bar; an interrupt stops the solver before it goes on to the user."""
    from slosh_cli.application.stop import simulate
    from slosh_cli.cli.progress import RunProgress, announce_solver
    from slosh_cli.results.effort import why_long

    announce_solver([scenario.tank.liquid.model])
    cancel = threading.Event()
    with RunProgress(scenario.name, why_long([scenario])) as progress:
        try:
            return simulate(scenario, progress=progress, cancel=cancel)
        except KeyboardInterrupt:
            cancel.set()
            raise
