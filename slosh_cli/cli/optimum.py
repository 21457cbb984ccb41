"""`slosh optimum`: the value of a key with the shortest distance, or the best of another answer, within limits."""

from typing import Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.find import Scanned, Varied
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile, Threaded, option

_WITHIN: Final = "A limit to keep: --within 'max_wheel_unloading<=0.6', 'locked_time<=0 s'. May be repeated."
_LEAST: Final = "The answer to make least. Default: braking_distance."


def optimum_command(
    scenario_file: ScenarioFile,
    vary: Varied,
    within: Annotated[list[str] | None, option("--within", "ANSWER<=VALUE", _WITHIN)] = None,
    least: Annotated[str | None, option("--least", "ANSWER", _LEAST)] = None,
    most: Annotated[str | None, option("--most", "ANSWER", "The answer to make largest instead.")] = None,
    points: Scanned = 17,
    jobs: Threaded = None,
    overrides: Overrides = None,
    output: OutputFolder = None,
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Write no figures.")] = False,
    as_json: AsJson = False,
) -> ExitCode:
    """Find the best value of a key: the shortest stop within limits.

    The range is scanned, then the neighbourhood of the best stop ever more finely. It is told what holds the optimum
    where it is: a limit, a jump, an end of the range.
    """
    from slosh_cli.application.finding import optimum_search
    from slosh_cli.cli.search_output import search_and_tell

    search = optimum_search(scenario_file, vary, within or (), least, most, overrides or (), points)
    return search_and_tell(search, jobs, output, overrides, figures=not no_figures, as_json=as_json)
