"""A deceleration of the tank as people prescribe it: a level with a ramp, a table, or its motion."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.scenario import parse_quantity

if TYPE_CHECKING:
    from slosh_cli.scenario.csv_table import Table
    from slosh_cli.solver.deceleration import Deceleration

_TIME: Final = "time_s"
_COLUMNS: Final = (_TIME, "deceleration_m_s2")
_MOTIONS: Final = {"displacement_m": 4, "velocity_m_s": 2, "acceleration_m_s2": 1}
"""Columns of a motion, positive forward, with the fewest rows."""
_STARTS: Final = ("rest", "moving")
_MOST_ROWS: Final = 1_000_000
_LARGEST: Final = 1000.0
"""Decelerations beyond this, m/s^2, are a slip in the unit."""

Amount = str | float
"""A quantity with its unit (``"0.2 g"``), or an SI number."""


@dataclass(frozen=True)
class Prescription:
    """A deceleration over `duration` s, told every `interval` s, with the surface `probes` m from the rear wall.

    `settings` tell it apart from others.
    """

    deceleration: Deceleration
    duration: float
    interval: float
    settings: str
    probes: tuple[float, ...] = ()

    @classmethod
    def read(
        cls,
        deceleration: Amount | None,
        ramp: Amount | None,
        duration: Amount,
        table: Path | None,
        interval: Amount,
        spelt: Callable[[str], str] = str,
        motion: Path | None = None,
        start: str | None = None,
        probes: Sequence[Amount] = (),
    ) -> Prescription:
        """The prescription that is asked for; `spelt` says what messages call an argument.

        `start` is `rest` where the liquid stands before a `motion`, `moving` where it moves along with the tank.

        Raises UsageError where it makes no sense, ScenarioError for a table that cannot be used.
        """
        span, step = _positive(duration, spelt("duration")), _positive(interval, spelt("interval"))
        if span / step > _MOST_ROWS:
            remedy = f"lengthen {spelt('interval')} or shorten {spelt('duration')}"
            raise UsageError(f"a history has at most {_MOST_ROWS} rows; {remedy}", spelt("interval"))
        if motion is None:
            if start is not None:
                raise UsageError(f"{spelt('start')} goes with {spelt('motion')}", spelt("start"))
            found, where = _course(deceleration, ramp, table, spelt)
        elif any(other is not None for other in (deceleration, ramp, table)):
            others = ", ".join(map(spelt, ("deceleration", "ramp", "table")))
            raise UsageError(f"{spelt('motion')} says how the tank moves; leave out {others}", spelt("motion"))
        else:
            found, where = _motion(motion, start or _STARTS[0], spelt("start")), str(motion)
        if found.largest(span) == 0.0:
            rule = f"the tank must be decelerated at some time within {spelt('duration')}"
            raise UsageError(f"{where}: {rule}", where)
        if found.largest(span) > _LARGEST:
            raise UsageError(f"{where}: must stay below {_LARGEST:g} m/s^2, or the unit is another one", where)
        file = table or motion
        content = None if file is None else hashlib.sha256(file.read_bytes()).hexdigest()
        told: list[object] = [deceleration, ramp, duration, interval, content]
        if motion is not None or probes:
            told += [motion and (start or _STARTS[0]), list(probes)]
        places = tuple(dict.fromkeys(_si(place, "length", spelt("probe")) for place in probes))
        return cls(found, span, step, json.dumps(told), places)


def _course(
    deceleration: Amount | None, ramp: Amount | None, table: Path | None, spelt: Callable[[str], str]
) -> tuple[Deceleration, str]:
    """The deceleration over time, and what messages call it."""
    from slosh_cli.solver.deceleration import Deceleration

    level, ramped = spelt("deceleration"), spelt("ramp")
    if (deceleration is None) == (table is None):
        given = f"{level} '0.2 g', {spelt('table')} FILE.csv or {spelt('motion')} FILE.csv"
        raise UsageError(f"say how the tank is decelerated: {given}", "excite")
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


def _motion(file: Path, start: str, called: str) -> Deceleration:
    """That of a tank whose motion is in a CSV file. Raises ScenarioError with file and line, UsageError for `start`."""
    import numpy as np

    from slosh_cli.scenario.csv_table import one_column, read_table
    from slosh_cli.solver.deceleration import Deceleration

    if start not in _STARTS:
        raise UsageError(f"{called} must be {' or '.join(_STARTS)}; given `{start}`", called)
    column = one_column(file, tuple(_MOTIONS))
    table = read_table(file, (_TIME, column), _begins_and_rises)
    times, values = (np.array(table.columns[name]) for name in (_TIME, column))
    if times.size < _MOTIONS[column]:
        rule = f"{column} needs at least {_MOTIONS[column]} rows; given {times.size}"
        raise UsageError(f"{file}: {rule}", str(file))
    return Deceleration.of_motion(column, times, values, at_rest=start == "rest")


def _begins_and_rises(table: Table) -> None:
    times = table.columns[_TIME]
    if times and times[0] != 0.0:
        table.refuse(table.lines[0], _TIME, "must begin at 0 s", f"{times[0]:g} s", "count time from the first row")
    for line, before, time in zip(table.lines[1:], times, times[1:], strict=False):
        if time <= before:
            given = f"{time:g} s after {before:g} s"
            table.refuse(line, _TIME, "must rise from row to row", given, "sort the rows by time, each once")


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
