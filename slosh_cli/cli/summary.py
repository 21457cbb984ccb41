"""The terminal summary of a run."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.output import say, show
from slosh_cli.results.answers import Answer, PerWheel, Told
from slosh_cli.results.channels import WHEELS
from slosh_cli.results.result import Result, Status

if TYPE_CHECKING:
    from rich.table import Table


def show_run(result: Result) -> None:
    """Print what a run found and what it warns of, to stdout."""
    from rich.text import Text

    stopped = result.status is Status.STOPPED
    lines = [] if stopped else [f"No braking distance: {result.status}. {result.reason}".rstrip()]
    lines += [] if stopped else [result.status.remedy]
    alarms = [Text(line, style="bold red") for line in lines]
    alarms += [Text(f"warning: {warning}", style="bold yellow") for warning in result.warnings]
    show(_facts(result), "", _wheels(result), *([""] if alarms else []), *alarms)


def show_files(files: Mapping[str, Any]) -> None:
    """Print where the files of a run lie, past the line breaking of tables: a path is copied from here."""
    say(_where(files))


def _facts(result: Result) -> "Table":
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    table.title, table.title_justify, table.title_style = _title(result), "left", "bold"
    for one, line in _lines(per_wheel=False):
        text = _WORDS[one.name](result, line) if one.name in _WORDS else _text(getattr(result, one.name), line)
        if text:
            table.add_row(line.label, text)
    return table


def _lines(*, per_wheel: bool) -> list[tuple[Answer, Told]]:
    """The answers that the terminal shows, in its order."""
    found = [(one, one.line) for one in Result.table() if one.line and (one.kind == PerWheel) == per_wheel]
    return sorted(found, key=lambda pair: pair[1].at)


def _text(value: Any, line: Told) -> str:
    if not line.form:
        return str(value)
    if value is None or not math.isfinite(value):
        return "-"
    return f"{value / line.per:{line.form}} {line.unit}".rstrip()


def _surface(result: Result, line: Told) -> str:
    room = f"(room: {_text(result.surface_limit_m, line)})"
    return f"{_text(result.max_surface_m, line)} {room}" if result.has_liquid else ""


def _range(result: Result, _: Told) -> str:
    """Yes, or the checks that say no."""
    outside = [check.name for check in result.checks if check.kind == "model" and not check.within]
    return f"no: {', '.join(outside)}" if outside else "yes"


def _suiting(result: Result, _: Told) -> str:
    """The recommended model, with the expected errors of the force on the tank where it is another one."""
    advice = result.recommendation
    if advice is None:
        return ""
    if advice.model == result.liquid_model:
        return "the one in use"
    return f"{advice.model} (expected error of the force {advice.errors} of mass times deceleration)"


_WORDS: Final[Mapping[str, Callable[[Result, Told], str]]] = {
    "max_surface_m": _surface,
    "in_model_range": _range,
    "recommendation": _suiting,
    "unevenness_d1_m": lambda run, line: _text(run.unevenness_d1_m, line) if run.unevenness_d1_m is not None else "",
    "mean_total_wheel_load_N": lambda run, line: _text(run.mean_total_wheel_load_N / run.weight_N - 1.0, line),
    "steps": lambda run, _: f"{run.steps} accepted, {run.rejected_steps} rejected",
    "solve_seconds": lambda run, _: f"{run.solve_seconds:.2f} s, {run.microseconds_per_step:.0f} microseconds per step",
}
"""What the terminal says of an answer where it is more than its number; nothing where that is empty."""


def _wheels(result: Result) -> "Table":
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    found = _lines(per_wheel=True)
    for column in ("wheel", *(line.label for _, line in found)):
        table.add_column(column, justify="right")
    columns = [[f"{value / line.per:{line.form}}" for value in getattr(result, one.name)] for one, line in found]
    for i, *cells in zip(WHEELS, *columns, strict=True):
        table.add_row(str(i), *cells)
    return table


def _title(result: Result) -> str:
    speed = result.initial_speed_m_s * 3.6
    return f"{result.name}: {speed:.4g} km/h, {result.torque_words}, load: {result.liquid_model}"


def _where(files: Mapping[str, Any]) -> str:
    width = max(map(len, files))
    lines = ["", *(f"  {kind:{width}}  {file}" for kind, file in files.items() if kind != "figures")]
    figures = [Path(file) for file in files["figures"]]
    if figures:
        names = ", ".join(dict.fromkeys(file.stem for file in figures))
        kinds = ", ".join(dict.fromkeys(file.suffix for file in figures))
        lines.append(f"  {'figures':{width}}  {figures[0].parent}: {names} ({kinds})")
    return "\n".join(lines)
