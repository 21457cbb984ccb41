"""`slosh run`: one stop, its history, its summary and its figures."""

import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile
from slosh_cli.cli.output import note, say

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
    from slosh_cli.application.keeping import Keeping, folder_of_run
    from slosh_cli.application.twin import EarlierTwin
    from slosh_cli.cli.keeping import answered

    job = _job(scenario_file, overrides)
    solid = _solid(job.scenario) if twin else None
    folder = folder_of_run(job.scenario, output, overrides, job.files, note)
    earlier = EarlierTwin(folder)
    result, keeping = job.simulate(job.scenario), Keeping()
    if not as_json:
        job.show(result)
    files = job.keep(result, folder, keeping, figures=not no_figures)
    if solid is None:
        if words := earlier.drop():
            note(words)
        return answered(result, files, keeping, as_json=as_json)
    other = job.simulate(solid)
    kept = job.keep(other, earlier.folder, keeping, figures=not no_figures)
    told = _beside(result, other, kept, as_json=as_json)
    code = answered(result, files, keeping, as_json=as_json, more={"twin": told})
    return code if other.braking_distance_m is not None or code is not ExitCode.DONE else ExitCode.NO_ANSWER


class _Job(NamedTuple):  # a wagon's stop or a train's: its scenario, the files of its run, and what is done with them
    scenario: Any
    files: Sequence[str]
    simulate: Callable[[Any], Any]
    show: Callable[[Any], None]
    keep: Callable[..., dict[str, Any]]


def _job(file: Path, overrides: Sequence[str] | None) -> _Job:
    from slosh_cli.scenario.train_file import is_train_file, load_train

    if is_train_file(file):
        from slosh_cli.application.train import TRAIN_FILES, keep_train
        from slosh_cli.cli.train import show_train, solve_train

        return _Job(load_train(file, overrides or ()), TRAIN_FILES, solve_train, show_train, keep_train)
    from slosh_cli.application.stop import RUN_FILES, keep_run
    from slosh_cli.cli.reading import load_given
    from slosh_cli.cli.summary import show_run
    from slosh_cli.scenario import load_scenario

    return _Job(load_given(load_scenario, file, overrides), RUN_FILES, _simulate, show_run, keep_run)


def _solid(scenario: Any) -> Any:
    from slosh_cli.application.comparison import solid_twin

    return solid_twin(scenario)


def _beside(liquid: Any, solid: Any, files: Mapping[str, Any], *, as_json: bool) -> dict[str, Any]:
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
