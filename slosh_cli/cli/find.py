"""`slosh find`: the value of a key at which an answer passes a value."""

from typing import Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile, Threaded, option

_VARY: Final = """Key and range: --vary 'braking.torque=2:30 kN m'; the key alone stands for half to double the file's
own value. Of a train: all.KEY, vehicles.N.KEY or a key of its own."""
Varied = Annotated[str, option("--vary", "KEY=LOW:HIGH", _VARY)]
_UNTIL: Final = "What is sought: first_lock, max_wheel_unloading=0.6, 'braking_distance=700 m'; any answer will do."
_CROSSING: Final = "Which of several crossings, from the low end. Default: 1."
_POINTS: Final = "Stops of the scan, 5 to 1000. Default: 17. More find what is narrower."
Scanned = Annotated[int, option("--points", "N", _POINTS)]


def find_command(
    scenario_file: ScenarioFile,
    vary: Varied,
    until: Annotated[str, option("--until", "ANSWER=VALUE", _UNTIL)],
    crossing: Annotated[int, option("--crossing", "N", _CROSSING)] = 1,
    points: Scanned = 17,
    jobs: Threaded = None,
    overrides: Overrides = None,
    output: OutputFolder = None,
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Write no figures.")] = False,
    as_json: AsJson = False,
) -> ExitCode:
    """Find the value of a key at which an answer passes a value.

    The range is scanned, then the crossing is closed in on the model itself, to 1e-4 of the value. Where the answer
    jumps over the value, both sides of the jump are told.
    """
    from slosh_cli.application.finding import find_search
    from slosh_cli.cli.search_output import search_and_tell

    search = find_search(scenario_file, vary, until, overrides or (), points, crossing)
    return search_and_tell(search, jobs, output, overrides, figures=not no_figures, as_json=as_json)
