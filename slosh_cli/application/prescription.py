"""A deceleration of the tank as people prescribe it: a level with a ramp, or a table."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.scenario import parse_quantity

if TYPE_CHECKING:
    from slosh_cli.scenario.csv_table import Table
    from slosh_cli.solver.excite import Deceleration

_COLUMNS: Final = ("time_s", "deceleration_m_s2")
_MOST_ROWS: Final = 1_000_000
_LARGEST: Final = 1000.0
"""Decelerations beyond this, m/s^2, are a slip in the unit."""

Amount = str | float
"""A quantity with its unit (``"0.2 g"``), or an SI number."""


@dataclass(frozen=True)
class Prescription:
    """A deceleration over `duration` s, told every `interval` s; `settings` tell it apart from others."""

    deceleration: Deceleration
    duration: float
    interval: float
    settings: str

    @classmethod
    def read(
        cls,
        deceleration: Amount | None,
        ramp: Amount | None,
        duration: Amount,
        table: Path | None,
        interval: Amount,
        spelt: Callable[[str], str] = str,
    ) -> Prescription:
        """The prescription that is asked for; `spelt` says what messages call an argument.

        Raises UsageError where it makes no sense, ScenarioError for a table that cannot be used.
        """
        span, step = _positive(duration, spelt("duration")), _positive(interval, spelt("interval"))
        if span / step > _MOST_ROWS:
            remedy = f"lengthen {spelt('interval')} or shorten {spelt('duration')}"
            raise UsageError(f"a history has at most {_MOST_ROWS} rows; {remedy}", spelt("interval"))
        found, where = _course(deceleration, ramp, table, spelt)
        if found.largest(span) == 0.0:
            rule = f"the tank must be decelerated at some time within {spelt('duration')}"
            raise UsageError(f"{where}: {rule}", where)
        if found.largest(span) > _LARGEST:
            raise UsageError(f"{where}: must stay below {_LARGEST:g} m/s^2, or the unit is another one", where)
        content = None if table is None else hashlib.sha256(table.read_bytes()).hexdigest()
        return cls(found, span, step, json.dumps([deceleration, ramp, duration, interval, content]))


def _course(
    deceleration: Amount | None, ramp: Amount | None, table: Path | None, spelt: Callable[[str], str]
) -> tuple[Deceleration, str]:
    """The deceleration over time, and what messages call it."""
    from slosh_cli.solver.excite import Deceleration

    level, ramped = spelt("deceleration"), spelt("ramp")
    if (deceleration is None) == (table is None):
        raise UsageError(f"say how the tank is decelerated: {level} '0.2 g', or {spelt('table')} FILE.csv", "excite")
    if table is not None:
        if ramp is not None:
            raise UsageError(f"{ramped} goes with {level}; a table has its own course", ramped)
        return Deceleration.table(_rows_of(table)), str(table)
    reached = _si(deceleration or 0.0, "acceleration", level)
    within = 0.0 if ramp is None else _si(ramp, "time", ramped)
    if within < 0.0:
        raise UsageError(f"{ramped} must not be negative; given `{ramp}`", ramped)
    return Deceleration.ramped(reached, within), level


def _rows_of(file: Path) -> list[tuple[float, float]]:
    """Rows (s, m/s^2) of a CSV file with the columns of _COLUMNS; raises ScenarioError with file and line."""
    from slosh_cli.scenario.csv_table import read_table

    table = read_table(file, _COLUMNS, _times_do_not_fall)
    return list(zip(*(table.columns[column] for column in _COLUMNS), strict=True))


def _times_do_not_fall(table: Table) -> None:
    times = table.columns[_COLUMNS[0]]
    for line, before, time in zip(table.lines[1:], times, times[1:], strict=False):
        if time < before:
            given = f"{time:g} s after {before:g} s"
            table.refuse(line, _COLUMNS[0], "must not fall from row to row", given, "sort the rows by time")


def _si(amount: Amount, dimension: str, name: str) -> float:
    if not isinstance(amount, str):
        if not math.isfinite(amount):
            raise UsageError(f"{name} must be finite; given `{amount}`", name)
        return float(amount)
    try:
        return parse_quantity(amount, dimension)
    except ValueRefused as refused:
        raise UsageError(f"{name} {refused}", name) from refused


def _positive(amount: Amount, name: str) -> float:
    value = _si(amount, "time", name)
    if value <= 0.0:
        raise UsageError(f"{name} must be positive; given `{amount}`", name)
    return value
