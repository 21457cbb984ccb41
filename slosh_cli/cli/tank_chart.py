"""What `slosh tank chart` computes and writes."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import Keeping, by_kind, default_folder, files_text
from slosh_cli.cli.output import say, say_json, warn
from slosh_cli.cli.reading import read_any_scenario
from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.results.files import try_targets
from slosh_cli.study.axis import values_of
from slosh_cli.tank.chart import FillChart, fill_chart

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario, TankScenario

TABLE: Final = "fill_chart.csv"
_FILES: Final = (TABLE, "fill_chart.png", "fill_chart.svg")
ALL: Final = "0.05:0.95:0.05"
"""Fillings that are shown when none are asked for."""
LEAST, MOST = 0.02, 0.995
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
    folder = output or default_folder(
        scenario.name, [*(overrides or ()), *([f"fills={fills}"] if fills != ALL else [])]
    )
    try_targets(folder, _FILES)
    with _progress() as progress:
        chart = fill_chart(scenario.tank, levels, modes or scenario.tank.modes, progress)
    skipped = [f"filling {level:g} is left out: {reason}" for level, reason in chart.skipped.items()]
    rows, keeping = [row | {"n": int(row["n"])} for row in _rows(chart)], Keeping()
    if not rows:
        raise UsageError(f"no filling could be represented: {'; '.join(chart.skipped.values())}", "--fills")
    if not as_json:
        say(f"{scenario.name}: {len(levels) - len(skipped)} fillings, n = {', '.join(map(str, chart.numbers))}")
    files = _write(scenario, chart, rows, folder, keeping)
    if as_json:
        say_json({"name": scenario.name, "rows": rows, "warnings": [*skipped, *keeping.failures], "files": files})
    else:
        say(files_text(files))
    for line in skipped:
        warn(line)
    return keeping.told()


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


def _write(
    scenario: "Scenario | TankScenario", chart: FillChart, rows: list[dict[str, Any]], folder: Path, keeping: Keeping
) -> dict[str, Any]:
    from slosh_cli.results.tables import write_table

    def draw(folder: Path) -> None:
        from slosh_cli.report.tank_figures import Heading, draw_chart

        tank = scenario.tank
        heading = Heading("Slosh modes against the filling", f"{scenario.name}: {tank.shape}, {tank.length:g} m long")
        draw_chart(chart, heading, tank.fill, folder)

    files = keeping.keep(folder, _FILES, {TABLE: lambda path: write_table(rows, path)}, {"fill_chart": draw})
    return by_kind(files, table=TABLE)


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
