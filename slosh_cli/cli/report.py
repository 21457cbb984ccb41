"""`slosh report`: one HTML page of a run, a train or a study."""

from pathlib import Path
from typing import Annotated

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import option
from slosh_cli.cli.output import say


def report_command(
    source: Annotated[
        Path, typer.Argument(metavar="FILE.h5|STUDY", help="History of a run, or a study's folder.", show_default=False)
    ],
    output: Annotated[
        Path | None, option("--output -o", "FILE.html", "The page. Default: report.html beside the source.")
    ] = None,
) -> ExitCode:
    """One HTML page of a run, a train or a study.

    It replays a run, needs no network and can be mailed.
    """
    from slosh_cli.application.reporting import write_report

    say(str(write_report(source, output)))
    return ExitCode.DONE
