"""What `slosh tank chart` computes and writes."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import say, say_json, warn
from slosh_cli.cli.reading import read_any_scenario
from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.study.axis import values_of
from slosh_cli.tank.chart import FillChart, fill_chart

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario, TankScenario

TABLE: Final = "fill_chart.csv"
LEAST, MOST = 0.02, 0.98
"""Fillings that the finite elements can represent."""


def run_chart(
    scenario_file: Path,
    fills: str,
    modes: int | None,
    overrides: Sequence[str] | None,
    output: Path | None,
    *,
    as_json: bool,
) -> ExitCode:
    """Compute, write and tell."""
    scenario = read_any_scenario(scenario_file, overrides)
    levels = read_fills(fills)
    folder = output or Path("outputs") / scenario.name
    with _progress() as progress:
        chart = fill_chart(scenario.tank, levels, modes or scenario.tank.modes, progress)
    skipped = [f"filling {level:g} is left out: {reason}" for level, reason in chart.skipped.items()]
    files = _write(scenario, chart, folder)
    if as_json:
        rows = [row | {"n": int(row["n"])} for row in _rows(chart)]
        say_json({"name": scenario.name, "rows": rows, "warnings": skipped, "files": files})
    else:
        say(f"{scenario.name}: {len(levels) - len(skipped)} fillings, n = {', '.join(map(str, chart.numbers))}")
        say(f"\n  table    {files['table']}\n  figures  {', '.join(files['figures'])}")
    for line in skipped:
        warn(line)
    return ExitCode.DONE


def read_fills(text: str) -> list[float]:
    """Fillings of a list or a range, in increasing order. Raises UsageError."""
    rule = f"--fills must be numbers between {LEAST} and {MOST}, such as `0.05:0.95:0.05` or `0.2,0.5`"
    try:
        fills = sorted({float(value) for value in values_of(text)})
    except ValueRefused as refused:
        raise UsageError(f"--fills {refused}", "--fills") from refused
    except ValueError as error:
        raise UsageError(f"{rule}; given `{text}`", "--fills") from error
    if not all(LEAST <= fill <= MOST for fill in fills):
        raise UsageError(f"{rule}; given `{text}`", "--fills")
    return fills


def _rows(chart: FillChart) -> list[dict[str, float]]:
    """One row per filling and mode, without those that could not be represented."""
    return [
        {
            "fill": float(fill),
            "n": float(n),
            "omega_rad_s": float(chart.frequency[row, column]),
            "mass_fraction": float(chart.mass_fraction[row, column]),
            "height_m": float(chart.height[row, column]),
        }
        for column, fill in enumerate(chart.fill)
        if float(fill) not in chart.skipped
        for row, n in enumerate(chart.numbers)
    ]


def _write(scenario: "Scenario | TankScenario", chart: FillChart, folder: Path) -> dict[str, Any]:
    from slosh_cli.report.tank_figures import Heading, draw_chart
    from slosh_cli.results.files import staging
    from slosh_cli.results.tables import write_table

    rows = [row | {"n": int(row["n"])} for row in _rows(chart)]
    if not rows:
        raise UsageError(f"no filling could be represented: {'; '.join(chart.skipped.values())}", "--fills")
    tank = scenario.tank
    heading = Heading("Slosh modes against the filling", f"{scenario.name}: {tank.shape}, {tank.length:g} m long")
    with staging(folder) as stage:
        write_table(rows, stage / TABLE)
        drawn = draw_chart(chart, heading, tank.fill, stage)
    return {"table": str(folder / TABLE), "figures": [str(folder / file.name) for file in drawn]}


@contextmanager
def _progress() -> Iterator[Callable[[int, int], None] | None]:
    """A bar on a terminal, silence elsewhere."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("fillings", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
