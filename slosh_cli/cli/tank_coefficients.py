"""What `slosh tank coefficients` computes, prints and writes."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import Keeping, by_kind, files_text
from slosh_cli.cli.output import say, say_json, show, warn
from slosh_cli.cli.reading import read_any_scenario
from slosh_cli.results.files import try_targets
from slosh_cli.results.validity import plain, warnings_of
from slosh_cli.tank.coefficients import SloshMode, tank_modes
from slosh_cli.tank.comparison import ModeComparison, compare_modes
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.inertia import stokes_joukowski_inertia
from slosh_cli.tank.load import FrozenLoad, frozen_load
from slosh_cli.tank.longitudinal import LongitudinalMode, LongitudinalModes

if TYPE_CHECKING:
    from rich.table import Table

    from slosh_cli.results.recommendation import Recommendation
    from slosh_cli.results.validity import Check
    from slosh_cli.scenario import Scenario, TankScenario

TABLE: Final = "coefficients.csv"
_PICTURE: Final = re.compile(r"mode_\d+\.(png|svg)")
COLUMNS: Final = {
    "omega_rad_s": "frequency",
    "lambda_1_kg": "lambda_1",
    "lambda_02_kg_m": "lambda_02",
    "mu_kg": "mu",
    "mass_fraction": "mass_fraction",
    "height_m": "height",
}
"""Key of JSON and CSV -> name of the quantity in `ModeComparison.deviations`."""


@dataclass(frozen=True)
class Findings:
    """All that is said about a tank. `lidded_inertia` kg m^2 is None where it could not be computed."""

    name: str
    load: FrozenLoad
    rows: Sequence[ModeComparison]
    solved: LongitudinalModes
    lidded_inertia: float | None
    checks: "Sequence[Check]"
    recommendation: "Recommendation"
    warnings: Sequence[str]


def show_coefficients(
    scenario_file: Path, modes: int | None, overrides: Sequence[str] | None, output: Path | None, *, as_json: bool
) -> ExitCode:
    """Compute, write where a folder is given, and tell."""
    scenario = read_any_scenario(scenario_file, overrides)
    if output is not None:
        try_targets(output, (TABLE,))
    found, keeping = find(scenario, modes), Keeping()
    if not as_json:
        _show(found)
    files = _write(scenario, found, output, keeping) if output is not None else {}
    if as_json:
        answer = as_dict(found)
        say_json(answer | {"warnings": [*answer["warnings"], *keeping.failures], "files": files})
        for warning in found.warnings:
            warn(warning)
    elif files:
        say(files_text(files))
    return keeping.told()


def find(scenario: "Scenario | TankScenario", modes: int | None) -> Findings:
    """Computed and given modes of the scenario's tank, and its load."""
    import_module("skfem.helpers")  # with the solvers of scipy: loaded before the clock of the finite elements starts
    import_module("scipy.spatial")
    import_module("scipy.sparse.linalg")
    from slosh_cli.results.liquid_range import coefficient_checks, expected_checks, tank_checks
    from slosh_cli.results.recommendation import deceleration_of, recommend

    tank = scenario.tank
    rows = compare_modes(tank, modes)
    deceleration = deceleration_of(scenario)
    advice = recommend(tank, deceleration)
    verdicts = coefficient_checks(tank)
    verdicts += tuple(check for check in tank_checks(tank, advice.sentence) if check not in verdicts)
    if deceleration is not None:
        verdicts += expected_checks(tank, deceleration, advice.sentence)
    warnings = warnings_of(verdicts)
    lidded = None
    try:
        lidded = stokes_joukowski_inertia(tank)
    except TankError as error:
        warnings.append(f"no pitch inertia of an ideal liquid under a lid: {error.message}")
    solved = tank_modes(tank, len(rows))  # kept from the comparison
    return Findings(scenario.name, frozen_load(tank), rows, solved, lidded, verdicts, advice, warnings)


def as_dict(found: Findings) -> dict[str, Any]:
    """The findings as the JSON object has them."""
    return {
        "name": found.name,
        "liquid_mass_kg": found.load.mass,
        "centroid_m": found.load.centre_height,
        "pitch_inertia_frozen_kg_m2": found.load.pitch_inertia,
        "pitch_inertia_stokes_joukowski_kg_m2": found.lidded_inertia,
        "modes": [_values(row.n, row.computed, row.computed_fraction) for row in found.rows],
        "given": [_values(row.n, row.given, row.given_fraction) for row in found.rows if row.given is not None],
        "deviations_percent": [
            {"n": row.n, **{key: 100.0 * row.deviations()[name] for key, name in COLUMNS.items()}}
            for row in found.rows
            if row.given is not None
        ],
        "accuracy": {
            "frequency_change": found.solved.relative_change,
            "height_change": found.solved.height_change,
            "unknowns": found.solved.unknowns,
        },
        "solve_seconds": found.solved.solve_seconds,
        "checks": plain(found.checks),
        "recommendation": found.recommendation.as_dict(),
        "warnings": list(found.warnings),
    }


def _values(n: int, mode: SloshMode, fraction: float | None) -> dict[str, Any]:
    values = {key: getattr(mode, name) for key, name in COLUMNS.items() if name != "mass_fraction"}
    return {"n": n, **{key: values.get(key, fraction) for key in COLUMNS}}


def _show(found: Findings) -> None:
    from rich.text import Text

    alarms = [Text(f"warning: {warning}", style="bold yellow") for warning in found.warnings]
    show(_facts(found), "", _modes(found), "", *alarms, Text(found.recommendation.sentence))


def _facts(found: Findings) -> "Table":
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    table.title, table.title_justify, table.title_style = f"{found.name}: the tank alone", "left", "bold"
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


def _modes(found: Findings) -> "Table":
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    table.add_column("n", justify="right")
    table.add_column("", no_wrap=True)
    heads = ("omega\nrad/s", "lambda_1\nkg", "lambda_02\nkg m", "mu\nkg", "mass\nfraction", "height\nm")
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    for row in found.rows:
        for cells in _lines(row):
            table.add_row(*cells)
    return table


def _lines(row: ModeComparison) -> Iterator[list[str]]:
    """The computed mode and, where there is one, the given mode and its deviation."""
    yield [str(row.n), "computed", *_numbers(row.computed, row.computed_fraction)]
    if row.given is not None and row.given_fraction is not None:
        yield ["", "given", *_numbers(row.given, row.given_fraction)]
        yield ["", "given, %", *(f"{100.0 * row.deviations()[name]:+.2f}" for name in COLUMNS.values())]


def _numbers(mode: SloshMode, fraction: float) -> list[str]:
    return [
        f"{mode.frequency:.6g}",
        f"{mode.lambda_1:.6g}",
        f"{mode.lambda_02:.6g}",
        f"{mode.mu:.6g}",
        f"{fraction:.5f}",
        f"{mode.height:.4f}",
    ]


def _write(scenario: "Scenario | TankScenario", found: Findings, folder: Path, keeping: Keeping) -> dict[str, Any]:
    """Table of all modes, then a picture of each."""
    from slosh_cli.results.tables import write_table

    def draw(mode: LongitudinalMode, folder: Path) -> None:
        from slosh_cli.report.tank_figures import Heading, draw_mode

        tank = scenario.tank
        words = f"{found.name}: {tank.shape}, {tank.length:g} m long, {100.0 * tank.fill:g} % full, "
        draw_mode(mode, tank, Heading(f"Slosh mode n = {mode.n}", f"{words}{mode.frequency:.4g} rad/s"), folder)

    answer = as_dict(found)
    rows = [{"source": "computed", **row} for row in answer["modes"]]
    rows += [{"source": "given", **row} for row in answer["given"]]
    drawn = {f"mode_{mode.n}": partial(draw, mode) for mode in found.solved.modes}
    names = [TABLE, *(f"{name}.{suffix}" for name in drawn for suffix in ("png", "svg"))]
    earlier = [file.name for file in folder.glob("mode_*.*") if _PICTURE.fullmatch(file.name)]
    owned = [*names, *(name for name in earlier if name not in names)]
    return by_kind(keeping.keep(folder, owned, {TABLE: lambda path: write_table(rows, path)}, drawn), table=TABLE)
