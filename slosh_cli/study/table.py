"""The table of a study: one row per stop in the order of the grid, liquid beside solid."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import groupby
from typing import Any, Final

from slosh_cli.results.answers import Place, Shown
from slosh_cli.study.axis import Axis
from slosh_cli.study.plan import LIQUID, SOLID, SPEED, TORQUE, Study

TABLE: Final = "braking_distance.csv"

_Row = dict[str, Any]

_RATIO: Final = "ratio_to_solid"
_PLACES: Final = ((Place.NAME, Place.STATUS), (Place.RANGE, Place.RUN), (Place.WORDS, Place.WORDS))
"""The head of the table, what the stops came to, and the words at its end."""
_OF_THE_HEAD: Final = (SPEED, TORQUE, LIQUID)


def column_of(axis: Axis) -> str:
    """Name of an axis in the table: its key path and unit, ``wagon_pivot_spacing_m``; a name in Python too."""
    return re.sub(r"[^A-Za-z0-9]+", "_", f"{axis.key}_{axis.unit}").strip("_")


def columns(study: Study, rows: Iterable[_Row] = ()) -> list[str]:
    """The columns of a study's table, in order: the ones every study has and what else `rows` hold."""
    varied = [column_of(axis) for axis in _own_axes(study)]
    head, answers, words = (
        [column for one in study.answers.in_table(Shown.STUDY, *places) for column in one.columns] for places in _PLACES
    )
    ratio = [_RATIO] if any(axis.key == LIQUID for axis in study.axes) else []
    known = [*head, *varied, *ratio, *answers]
    others = dict.fromkeys(name for row in rows for name in row)
    end = [*words, *(["history"] if study.histories else [])]
    return [*known, *(name for name in others if name not in known and name not in end), *end]


def _own_axes(study: Study) -> list[Axis]:
    """The axes that have a column of their own: all but speed, torque and liquid."""
    return [axis for axis in study.axes if axis.key not in _OF_THE_HEAD]


def rows(study: Study, answer: Callable[[int], Mapping[str, Any] | None]) -> Iterator[_Row]:
    """Rows in the order of the grid, one group of liquids in memory at a time.

    `answer` gives the row of a stop by its index, None for one that has not been computed: it is left out.
    """
    for _, group in groupby(range(study.size), key=lambda index: _point(study, index)):
        found = [(index, answer(index)) for index in group]
        known = [_row(study, index, given) for index, given in found if given is not None]
        solid = next((row for row in known if row.get("liquid") == SOLID), None)
        for row in known:
            yield row if solid is None and "liquid" not in row else row | {_RATIO: _ratio(row, solid)}


def _point(study: Study, index: int) -> tuple[int, ...]:
    """The place of a stop in the grid without its liquid."""
    pairs = zip(study.axes, study.positions(index), strict=True)
    return tuple(place for axis, place in pairs if axis.key != LIQUID)


def _row(study: Study, index: int, given: Mapping[str, Any]) -> _Row:
    places = dict(zip((axis.key for axis in study.axes), study.positions(index), strict=True))
    return dict(given) | {column_of(axis): axis.plain(places[axis.key]) for axis in _own_axes(study)}


def _ratio(row: _Row, solid: _Row | None) -> float | None:
    """Braking distance over that of the equivalent solid; None for the solid itself and without both answers."""
    if solid is None or row is solid:
        return None
    mine, other = row.get("braking_distance_m"), solid.get("braking_distance_m")
    return mine / other if mine is not None and other is not None else None
