"""The terminal summaries of a tank alone."""

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from slosh_cli.cli.output import show

if TYPE_CHECKING:
    from rich.table import Table

    from slosh_cli.application.excitation import ExcitationResult
    from slosh_cli.application.tank import TankCoefficients
    from slosh_cli.tank.coefficients import SloshMode
    from slosh_cli.tank.comparison import ModeComparison


def show_coefficients(found: "TankCoefficients") -> None:
    """Print the load, the modes and what to know of them, to stdout."""
    from rich.text import Text

    alarms = [Text(f"warning: {warning}", style="bold yellow") for warning in found.warnings]
    show(_facts(found), "", _modes(found), "", *alarms, Text(found.recommendation.sentence))


def _facts(found: "TankCoefficients") -> "Table":
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


def _modes(found: "TankCoefficients") -> "Table":
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


def _lines(row: "ModeComparison") -> Iterator[list[str]]:
    """The computed mode and, where there is one, the given mode and its deviation."""
    from slosh_cli.application.tank import MODE_QUANTITIES

    yield [str(row.n), "computed", *_numbers(row.computed, row.computed_fraction)]
    if row.given is not None and row.given_fraction is not None:
        yield ["", "given", *_numbers(row.given, row.given_fraction)]
        yield ["", "given, %", *(f"{100.0 * row.deviations()[name]:+.2f}" for name in MODE_QUANTITIES.values())]


def _numbers(mode: "SloshMode", fraction: float) -> list[str]:
    return [
        f"{mode.frequency:.6g}",
        f"{mode.lambda_1:.6g}",
        f"{mode.lambda_02:.6g}",
        f"{mode.mu:.6g}",
        f"{fraction:.5f}",
        f"{mode.height:.4f}",
    ]


def show_excitation(result: "ExcitationResult", answer: Mapping[str, Any]) -> None:
    """Print the extremes of an excitation and what to know of them, to stdout."""
    from rich.table import Table
    from rich.text import Text

    from slosh_cli.solver.excite import extreme

    found, tank = result.histories, result.scenario.tank
    number: Callable[[float, str], str] = lambda value, unit: f"{value:.5g} {unit}".rstrip()  # noqa: E731
    table = Table.grid(padding=(0, 2))
    table.title, table.title_justify, table.title_style = result.conditions, "left", "bold"
    room, depth = result.room, tank.height * tank.fill
    for row in (
        ("force / (m |a|), largest in magnitude", number(answer["max_normalised_force"], "")),
        ("force / (m |a|), least", number(answer["min_normalised_force"], "")),
        ("force, largest in magnitude", number(extreme(found.force) / 1e3, "kN (forward +)")),
        ("moment about the bottom centre, likewise", number(answer["max_moment_N_m"] / 1e3, "kN m (nose-down +)")),
        ("surface at an end wall, likewise", f"{found.max_surface:+.3f} m (room: {room:.2f} m, depth: {depth:.2f} m)"),
        ("mass error", f"{found.mass_error:.1e}"),
        ("last change of the histories", f"{found.accuracy:.1e}"),
    ):
        table.add_row(*row)
    alarms = [Text(f"warning: {warning}", style="bold yellow") for warning in answer["warnings"]]
    if not alarms and answer["recommendation"]:
        alarms = [Text(answer["recommendation"]["sentence"])]
    show(table, *([""] if alarms else []), *alarms)
