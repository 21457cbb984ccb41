"""The terminal summary of a run."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from slosh_cli.cli.output import say, show
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
    for quantity, value in fact_rows(result):
        table.add_row(quantity, value)
    return table


def fact_rows(result: Result) -> list[tuple[str, str]]:
    """Quantity and value of everything that holds for the run as a whole."""
    liquid = result.liquid_model != "rigid"
    surface = f"{_number(result.max_surface_m, '.2f', 'm')} (room: {_number(result.surface_limit_m, '.2f', 'm')})"
    return [
        ("status", str(result.status)),
        ("braking distance", _number(result.braking_distance_m, ".2f", "m")),
        ("braking time", _number(result.braking_time_s, ".2f", "s")),
        *([("surface rise at an end wall, largest", surface)] if liquid else []),
        ("within the range of its model", _range(result)),
        *([("model of the liquid that suits", _suiting(result))] if result.recommendation else []),
        ("wheel unloading, largest", _number(100.0 * result.max_wheel_unloading, ".1f", "% (usual limit: 60 %)")),
        ("mean sum of wheel loads / weight - 1", _number(_excess(result), ".1e")),
        ("energy ledger, largest residual", _number(result.energy_residual, ".1e", "of the initial energy")),
        ("steps", f"{result.steps} accepted, {result.rejected_steps} rejected"),
        (
            "solver time",
            f"{result.solve_seconds:.2f} s, {result.microseconds_per_step:.0f} microseconds per step",
        ),
    ]


def _range(result: Result) -> str:
    """Yes, or the checks that say no."""
    outside = [check.name for check in result.checks if check.kind == "model" and not check.within]
    return f"no: {', '.join(outside)}" if outside else "yes"


def _suiting(result: Result) -> str:
    """The recommended model, with the expected errors of the force on the tank where it is another one."""
    advice = result.recommendation
    if advice is None or advice.model == result.liquid_model:
        return "the one in use"
    return f"{advice.model} (expected error of the force {advice.errors} of mass times deceleration)"


def _wheels(result: Result) -> "Table":
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for column in ("wheel", "at rest / kN", "least / kN", "most / kN", "unloading / %", "locked / s"):
        table.add_column(column, justify="right")
    for row in wheel_rows(result):
        table.add_row(*row)
    return table


def wheel_rows(result: Result) -> list[Sequence[str]]:
    """Per wheel: number, load at rest, least and most load, unloading, time locked."""
    columns = zip(
        WHEELS,
        result.static_wheel_load_N,
        result.min_wheel_load_N,
        result.max_wheel_load_N,
        result.locked_time_s,
        strict=True,
    )
    return [
        (
            str(i),
            f"{rest / 1e3:.1f}",
            f"{least / 1e3:.1f}",
            f"{most / 1e3:.1f}",
            f"{100.0 * (1.0 - least / rest):.1f}",
            f"{locked:.2f}",
        )
        for i, rest, least, most, locked in columns
    ]


def _title(result: Result) -> str:
    speed, torque = result.initial_speed_m_s * 3.6, result.torque_N_m / 1e3
    return f"{result.name}: {speed:.4g} km/h, {torque:.4g} kN m per wheel, load: {result.liquid_model}"


def _excess(result: Result) -> float:
    return result.mean_total_wheel_load_N / result.weight_N - 1.0


def _number(value: float | None, form: str, unit: str = "") -> str:
    if value is None or not math.isfinite(value):
        return "-"
    return f"{value:{form}} {unit}".rstrip()


def _where(files: Mapping[str, Any]) -> str:
    lines = [""] + [f"  {kind}  {files[kind]}" for kind in ("history", "summary") if kind in files]
    figures = [Path(file) for file in files["figures"]]
    if figures:
        names = ", ".join(dict.fromkeys(file.stem for file in figures))
        kinds = ", ".join(dict.fromkeys(file.suffix for file in figures))
        lines.append(f"  figures  {figures[0].parent}: {names} ({kinds})")
    return "\n".join(lines)
