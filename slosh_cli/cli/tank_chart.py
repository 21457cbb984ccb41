"""What `slosh tank chart` reads, says and writes."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from slosh_cli.application.keeping import Keeping
from slosh_cli.application.tank import chart_fills, chart_folder
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import files_text, told
from slosh_cli.cli.output import say, say_json, warn
from slosh_cli.cli.progress import counting
from slosh_cli.cli.reading import read_any_scenario
from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.study.axis import expanded

_ALL: Final = "0.05:0.95:0.05"
"""Fillings that are shown when none are asked for."""
_LEAST, _MOST = 0.02, 0.995
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
    levels = _read_fills(fills)
    settings = [*(overrides or ()), *([f"fills={fills}"] if fills != _ALL else [])]
    folder = chart_folder(scenario, output, settings)
    with counting("fillings") as progress:
        found = chart_fills(scenario, levels, modes, progress)
    skipped = [f"filling {level:g} is left out: {reason}" for level, reason in found.skipped.items()]
    rows, keeping = found.rows(), Keeping()
    if not rows:
        raise UsageError(f"no filling could be represented: {'; '.join(found.skipped.values())}", "--fills")
    if not as_json:
        numbers = ", ".join(map(str, found.chart.numbers))
        say(f"{scenario.name}: {len(levels) - len(skipped)} fillings, n = {numbers}")
    files = found.keep(folder, keeping)
    if as_json:
        say_json({"name": scenario.name, "rows": rows, "warnings": [*skipped, *keeping.failures], "files": files})
    else:
        say(files_text(files))
    for line in skipped:
        warn(line)
    return told(keeping)


def _read_fills(text: str) -> list[float]:
    """Fillings of a list or a range, in increasing order. Raises UsageError."""
    rule = f"--fills must be numbers between {_LEAST} and {_MOST}, such as `0.05:0.95:0.05` or `0.2,0.5`"
    try:
        fills = sorted({float(value) for value in expanded(text)})
    except ValueRefused as refused:
        raise UsageError(f"--fills {refused}", "--fills") from refused
    except ValueError as error:
        raise UsageError(f"{rule}; given `{text}`", "--fills") from error
    if not all(_LEAST <= fill <= _MOST for fill in fills):
        raise UsageError(f"{rule}; given `{text}`", "--fills")
    return fills
