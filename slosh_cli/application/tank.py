"""The tank alone: its slosh modes, and how they change with the filling."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping, by_kind, default_folder
from slosh_cli.application.plotting import writers
from slosh_cli.errors import UsageError
from slosh_cli.report import FORMATS
from slosh_cli.results.files import try_targets
from slosh_cli.results.tables import write_table
from slosh_cli.results.validity import Check, plain_checks, warnings_of
from slosh_cli.scenario import Scenario, TankScenario, load_any_scenario
from slosh_cli.tank.chart import FillChart, fill_chart
from slosh_cli.tank.coefficients import SloshMode, tank_modes
from slosh_cli.tank.comparison import ModeComparison, compare_modes
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.inertia import stokes_joukowski_inertia
from slosh_cli.tank.load import FrozenLoad, frozen_load
from slosh_cli.tank.longitudinal import LongitudinalMode, LongitudinalModes

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from slosh_cli.application.plotting import Figures
    from slosh_cli.results.recommendation import Recommendation

COEFFICIENTS_TABLE: Final = "coefficients.csv"
MODE_QUANTITIES: Final = {
    "omega_rad_s": "frequency",
    "lambda_1_kg": "lambda_1",
    "lambda_02_kg_m": "lambda_02",
    "mu_kg": "mu",
    "mass_fraction": "mass_fraction",
    "height_m": "height",
}
"""Key of JSON and CSV -> name of the quantity in `ModeComparison.deviations`."""
_PICTURE: Final = re.compile(r"mode_\d+\.(png|svg)")
_CHART_TABLE: Final = "fill_chart.csv"
_CHART_FILES: Final = (_CHART_TABLE, *(f"fill_chart.{suffix}" for suffix in FORMATS))


@dataclass(frozen=True, eq=False, repr=False)
class TankCoefficients:
    """Slosh modes of a scenario's tank, computed and given, with its frozen load.

    modes: one per half wave n = 1, 3, 5, ...; solved: the computed ones with their shapes and the accuracy reached.
    lidded_inertia: kg m^2, None where it could not be computed.
    """

    scenario: Scenario | TankScenario
    load: FrozenLoad
    modes: Sequence[ModeComparison]
    solved: LongitudinalModes
    lidded_inertia: float | None
    checks: Sequence[Check]
    recommendation: Recommendation
    warnings: Sequence[str]

    def __repr__(self) -> str:
        frequencies = ", ".join(f"{mode.computed.frequency:.4g}" for mode in self.modes)
        return f"TankCoefficients({self.scenario.name}: {frequencies} rad/s)"

    def summary(self) -> dict[str, Any]:
        """The answer in plain Python values, with the keys of `slosh tank coefficients --json` but for `files`."""
        given = [row for row in self.modes if row.given is not None]
        return {
            "name": self.scenario.name,
            "liquid_mass_kg": self.load.mass,
            "centroid_m": self.load.centre_height,
            "pitch_inertia_frozen_kg_m2": self.load.pitch_inertia,
            "pitch_inertia_stokes_joukowski_kg_m2": self.lidded_inertia,
            "modes": [_values(row.n, row.computed, row.computed_fraction) for row in self.modes],
            "given": [_values(row.n, row.given, row.given_fraction) for row in given if row.given is not None],
            "deviations_percent": [
                {"n": row.n, **{key: 100.0 * row.deviations()[name] for key, name in MODE_QUANTITIES.items()}}
                for row in given
            ],
            "accuracy": {
                "frequency_change": self.solved.relative_change,
                "height_change": self.solved.height_change,
                "unknowns": self.solved.unknowns,
            },
            "solve_seconds": self.solved.solve_seconds,
            "checks": plain_checks(self.checks),
            "recommendation": self.recommendation.as_dict(),
            "warnings": list(self.warnings),
        }

    def rows(self) -> list[dict[str, Any]]:
        """One row per mode, computed then given; keys carry the unit."""
        found = self.summary()
        sources = {"computed": "modes", "given": "given"}
        return [{"source": source, **row} for source, key in sources.items() for row in found[key]]

    def to_frame(self) -> pd.DataFrame:
        """The modes as a DataFrame, the unit in the column names."""
        import pandas as pd

        return pd.DataFrame(self.rows())

    def figures(self) -> Figures:
        """What draws the shape of each computed mode."""

        def draw(mode: LongitudinalMode) -> Figure:
            from slosh_cli.report.tank_figures import Heading, mode_figure

            tank = self.scenario.tank
            words = f"{self.scenario.name}: {tank.shape}, {tank.length:g} m long, {100.0 * tank.fill:g} % full, "
            heading = Heading(f"Slosh mode n = {mode.n}", f"{words}{mode.frequency:.4g} rad/s")
            return mode_figure(mode, tank, heading)

        return {f"mode_{mode.n}": partial(draw, mode) for mode in self.solved.modes}

    def keep(self, folder: Path, keeping: Keeping) -> dict[str, Any]:
        """Write the table of all modes into `folder`, then their pictures; returns where those lie that could be."""
        drawn = writers(self.figures())
        names = [COEFFICIENTS_TABLE, *(f"{name}.{suffix}" for name in drawn for suffix in FORMATS)]
        earlier = [file.name for file in folder.glob("mode_*.*") if _PICTURE.fullmatch(file.name)]
        owned = [*names, *(name for name in earlier if name not in names)]
        numbers = {COEFFICIENTS_TABLE: partial(write_table, self.rows())}
        return by_kind(keeping.keep(folder, owned, numbers, drawn), table=COEFFICIENTS_TABLE)


def _values(n: int, mode: SloshMode, fraction: float | None) -> dict[str, Any]:
    values = {key: getattr(mode, name) for key, name in MODE_QUANTITIES.items() if name != "mass_fraction"}
    return {"n": n, **{key: values.get(key, fraction) for key in MODE_QUANTITIES}}


def coefficients(scenario: Scenario | TankScenario | str | Path, modes: int | None = None) -> TankCoefficients:
    """The first `modes` odd longitudinal slosh modes from the tank's geometry, beside the scenario's own.

    Takes the scenario of a stop or of a tank alone, or its file. Without a number as many as the scenario states.
    Raises ScenarioError for a file that cannot be used, TankError where the section cannot be represented.
    """
    if modes is not None and modes < 1:
        raise UsageError(f"modes must be at least 1; given {modes}", "modes")
    import_module("skfem.helpers")  # with the solvers of scipy: loaded before the clock of the finite elements starts
    import_module("scipy.spatial")
    import_module("scipy.sparse.linalg")
    from slosh_cli.results.liquid_range import coefficient_checks, expected_checks, tank_checks
    from slosh_cli.results.recommendation import deceleration_of, recommend

    found = load_any_scenario(scenario) if isinstance(scenario, str | Path) else scenario
    tank = found.tank
    rows = compare_modes(tank, modes)
    deceleration = deceleration_of(found)
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
    return TankCoefficients(found, frozen_load(tank), rows, solved, lidded, verdicts, advice, warnings)


@dataclass(frozen=True, eq=False)
class _TankChart:
    """Slosh modes of a scenario's tank against its filling."""

    scenario: Scenario | TankScenario = field(repr=False)
    chart: FillChart = field(repr=False)

    @property
    def skipped(self) -> Mapping[float, str]:
        """Fillings (depth over height) that could not be represented, and why."""
        return self.chart.skipped

    def rows(self) -> list[dict[str, Any]]:
        """One row per filling and mode, without those that could not be represented."""
        chart = self.chart
        return [
            {
                "fill": float(fill),
                "n": int(n),
                "omega_rad_s": float(chart.frequency[row, column]),
                "mass_fraction": float(chart.mass_fraction[row, column]),
                "height_m": float(chart.height[row, column]),
            }
            for column, fill in enumerate(chart.fill)
            if float(fill) not in chart.skipped
            for row, n in enumerate(chart.numbers)
        ]

    def figures(self) -> Figures:
        """What draws frequency, mass fraction and height against the filling."""

        def draw() -> Figure:
            from slosh_cli.report.tank_figures import Heading, chart_figure

            tank = self.scenario.tank
            words = f"{self.scenario.name}: {tank.shape}, {tank.length:g} m long"
            return chart_figure(self.chart, Heading("Slosh modes against the filling", words), tank.fill)

        return {"fill_chart": draw}

    def keep(self, folder: Path, keeping: Keeping) -> dict[str, Any]:
        """Write the table into `folder`, then the figure; returns where those lie that could be written."""
        numbers = {_CHART_TABLE: partial(write_table, self.rows())}
        return by_kind(keeping.keep(folder, _CHART_FILES, numbers, writers(self.figures())), table=_CHART_TABLE)


def chart_fills(
    scenario: Scenario | TankScenario,
    fills: Sequence[float],
    modes: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> _TankChart:
    """The tank's modes at each of `fills` (depth over height); `progress` is told how many of how many are done."""
    return _TankChart(scenario, fill_chart(scenario.tank, fills, modes or scenario.tank.modes, progress))


def chart_folder(scenario: Scenario | TankScenario, given: Path | None, settings: Sequence[str]) -> Path:
    """The folder of a chart: that `given`, else one of its own. Raises FileError where it cannot take the files."""
    folder = given or default_folder(scenario.name, settings)
    try_targets(folder, _CHART_FILES)
    return folder
