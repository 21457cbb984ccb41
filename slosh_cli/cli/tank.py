"""`slosh tank`: the tank alone; its slosh modes, its answer to a deceleration, its modes against the filling."""

from functools import partial
from pathlib import Path
from typing import Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile

_HELP: Final = """The tank alone: slosh modes, forces under a deceleration, charts.

Takes the scenario of a stop or of a tank alone.
"""

_Modes = Annotated[
    int | None,
    typer.Option(
        "--modes", metavar="N", min=1, max=20, show_default=False,
        help="How many odd longitudinal modes (n = 1, 3, 5, ...). Default: as many as the scenario states.",
    ),
]  # fmt: skip
_OptionalFolder = Annotated[
    Path | None,
    typer.Option(
        "--output", "-o", metavar="DIR", show_default=False,
        help="Folder for a table (CSV) and pictures of the modes. Default: none are written.",
    ),
]  # fmt: skip


tank = typer.Typer(help=_HELP, rich_markup_mode=None, no_args_is_help=True)


@tank.command("coefficients")
def _coefficients(
    scenario_file: ScenarioFile,
    modes: _Modes = None,
    overrides: Overrides = None,
    output: _OptionalFolder = None,
    as_json: AsJson = False,
) -> ExitCode:
    """Slosh modes from the tank's geometry, beside the scenario's own."""
    from slosh_cli.cli.tank_coefficients import show_coefficients

    return show_coefficients(scenario_file, modes, overrides, output, as_json=as_json)


@tank.command("excite")
def _excite(
    scenario_file: ScenarioFile,
    deceleration: Annotated[
        str | None,
        typer.Option("--deceleration", metavar="A", help="Deceleration to reach, such as '0.2 g'.", show_default=False),
    ] = None,
    ramp: Annotated[
        str | None,
        typer.Option(
            "--ramp", metavar="TIME", help="Reach it linearly within this time, then hold it. Default: at once.",
            show_default=False,
        ),
    ] = None,
    duration: Annotated[
        str, typer.Option("--duration", metavar="TIME", help="How long to look at the tank.")
    ] = "40 s",
    table: Annotated[
        Path | None,
        typer.Option(
            "--table", metavar="FILE.csv", show_default=False,
            help="Deceleration over time instead: columns time_s and deceleration_m_s2, linear in between.",
        ),
    ] = None,
    interval: Annotated[str, typer.Option("--interval", metavar="TIME", help="Time between rows.")] = "10 ms",
    overrides: Overrides = None,
    output: OutputFolder = None,
    as_json: AsJson = False,
) -> ExitCode:  # fmt: skip
    """Decelerate the tank alone: force, moment and surface over time.

    The tank does not pitch; the liquid model is the scenario's. Writes excite.csv, excite.h5 and a figure.
    """
    from slosh_cli.application.prescription import Prescription
    from slosh_cli.cli.tank_excite import run_excitation

    read = partial(Prescription.read, deceleration, ramp, duration, table, interval, "--{}".format)
    return run_excitation(scenario_file, read, overrides, output, as_json=as_json)


@tank.command("chart")
def _chart(
    scenario_file: ScenarioFile,
    fills: Annotated[
        str, typer.Option("--fills", metavar="LIST", help="Fillings (depth over height): a list or a range.")
    ] = "0.05:0.95:0.05",
    modes: _Modes = None,
    overrides: Overrides = None,
    output: OutputFolder = None,
    as_json: AsJson = False,
) -> ExitCode:
    """Frequency, mass fraction and height of the modes against filling."""
    from slosh_cli.cli.tank_chart import run_chart

    return run_chart(scenario_file, fills, modes, overrides, output, as_json=as_json)
