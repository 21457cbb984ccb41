"""What `slosh tank coefficients` prints."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from slosh_cli.application.keeping import Keeping
from slosh_cli.application.tank import COEFFICIENTS_TABLE, MODE_QUANTITIES, TankCoefficients, coefficients
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import files_text, told
from slosh_cli.cli.output import say, say_json, show, warn
from slosh_cli.cli.reading import read_any_scenario
from slosh_cli.results.files import try_targets
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.comparison import ModeComparison

if TYPE_CHECKING:
    from rich.table import Table


def show_coefficients(
    scenario_file: Path, modes: int | None, overrides: Sequence[str] | None, output: Path | None, *, as_json: bool
) -> ExitCode:
    """Compute, write where a folder is given, and tell."""
    scenario = read_any_scenario(scenario_file, overrides)
    if output is not None:
        try_targets(output, (COEFFICIENTS_TABLE,))
    found, keeping = coefficients(scenario, modes), Keeping()
    if not as_json:
        _show(found)
    files = found.keep(output, keeping) if output is not None else {}
    if as_json:
        answer = found.summary()
        say_json(answer | {"warnings": [*answer["warnings"], *keeping.failures], "files": files})
        for warning in found.warnings:
            warn(warning)
    elif files:
        say(files_text(files))
    return told(keeping)


def _show(found: TankCoefficients) -> None:
    from rich.text import Text

    alarms = [Text(f"warning: {warning}", style="bold yellow") for warning in found.warnings]
    show(_facts(found), "", _modes(found), "", *alarms, Text(found.recommendation.sentence))


def _facts(found: TankCoefficients) -> "Table":
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    table.title, table.title_justify, table.title_style = f"{found.scenario.name}: the tank alone", "left", "bold"
    lidded = "-" if found.lidded_inertia is None else f"{found.lidded_inertia:.6g} kg m^2"
    for row in (
        ("liquid mass", f"{found.load.mass:.6g} kg"),
        ("centre above the tank bottom", f"{found.load.centre_height:.4f} m"),
        ("pitch inertia about the centre, frozen", f"{found.load.pitch_inertia:.6g} kg m^2"),
        ("the same, ideal liquid under a lid (Stokes-Joukowski)", lidded),
        ("last change of frequency | height", f"{found.solved.relative_change:.1e} | {found.solved.height_change:.1e}"),
        ("finite elements", f"{found.solved.unknowns} unknowns, {found.solved.solve_seconds:.2f} s"),
    ):
        table.add_row(*row)
    return table


def _modes(found: TankCoefficients) -> "Table":
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    table.add_column("n", justify="right")
    table.add_column("", no_wrap=True)
    heads = ("omega\nrad/s", "lambda_1\nkg", "lambda_02\nkg m", "mu\nkg", "mass\nfraction", "height\nm")
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    for row in found.modes:
        for cells in _lines(row):
            table.add_row(*cells)
    return table


def _lines(row: ModeComparison) -> Iterator[list[str]]:
    """The computed mode and, where there is one, the given mode and its deviation."""
    yield [str(row.n), "computed", *_numbers(row.computed, row.computed_fraction)]
    if row.given is not None and row.given_fraction is not None:
        yield ["", "given", *_numbers(row.given, row.given_fraction)]
        yield ["", "given, %", *(f"{100.0 * row.deviations()[name]:+.2f}" for name in MODE_QUANTITIES.values())]


def _numbers(mode: SloshMode, fraction: float) -> list[str]:
    return [
        f"{mode.frequency:.6g}",
        f"{mode.lambda_1:.6g}",
        f"{mode.lambda_02:.6g}",
        f"{mode.mu:.6g}",
        f"{fraction:.5f}",
        f"{mode.height:.4f}",
    ]
