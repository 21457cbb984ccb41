"""The report of a study: its figures, its worst cases and its table."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from slosh_cli.report.html import page_table, page_text, short_number
from slosh_cli.results.files import FileError

_MOST_STOPS: Final = 2000
_NOTE: Final = "A click on a column's name sorts. Six digits are shown; the CSV has all of them."
_WORST: Final = (
    ("longest braking distance", "braking_distance_m", "m"),
    ("largest wheel unloading", "max_wheel_unloading", "1"),
    ("largest rise of the surface", "max_surface_m", "m"),
    ("largest compression in the train", "max_compression_N", "N"),
    ("largest tension in the train", "max_tension_N", "N"),
)


def study_page(folder: Path) -> str:
    """The page of a study's folder. Raises FileError where the folder holds no study."""
    from slosh_cli.report.study_pages import figure_files
    from slosh_cli.study.table import TABLE

    head, rows = _study_rows(folder / TABLE, folder)
    worst = list(_worst_cases(head, rows))
    tables = [
        page_table("Worst cases", ("what", "value", "unit", "stop"), worst, "The stop of the study that is furthest."),
        page_table(
            "Stops",
            head,
            rows,
            _NOTE,
            sortable=True,
        ),
    ]
    figures = {name: folder / name for name in figure_files(folder) if name.endswith(".png")}
    return page_text({"title": f"Study {folder.resolve().name}", "tables": tables}, {}, figures)


def _study_rows(file: Path, folder: Path) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of a study's table."""
    if not file.exists():
        raise FileError(f"{folder} holds no study: it lacks {file.name}; `slosh sweep` writes one", where=str(folder))
    try:
        with file.open(encoding="utf-8", newline="") as opened:
            head, *rows = csv.reader(opened)
    except (OSError, ValueError, csv.Error) as error:
        raise FileError(f"cannot read {file} as the table of a study: {error}", where=str(file)) from error
    if not rows or any(len(row) != len(head) for row in rows):
        raise FileError(f"{file} must have rows as wide as its head, but has none or others", where=str(file))
    if len(rows) > _MOST_STOPS:
        raise FileError(f"{file} has {len(rows)} stops; a report shows at most {_MOST_STOPS}", where=str(file))
    if "status" not in head:
        raise FileError(f"{file} is not the table of a study: it lacks the column status", where=str(file))
    return head, rows


def _worst_cases(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[tuple[str, str, str, str]]:
    """The stops that are furthest, for each answer that the table has; first how many did not stop."""
    status = head.index("status")
    yield "runs that did not stop", str(sum(row[status] != "stopped" for row in rows)), "1", f"of {len(rows)}"
    first = _places(head)
    for what, column, unit in _WORST:
        numbers = (
            [(float(row[head.index(column)]), row) for row in rows if row[head.index(column)]] if column in head else []
        )
        numbers = [one for one in numbers if np.isfinite(one[0])]
        if numbers:
            value, row = max(numbers, key=lambda one: one[0])
            yield what, f"{value:.6g}", unit, ", ".join(f"{name} {short_number(row[k])}" for k, name in first)


def _places(head: Sequence[str]) -> list[tuple[int, str]]:
    """Columns that tell which stop of the grid a row is: all that are no answer of a stop, a wagon's or a train's."""
    from slosh_cli.results.answers import Place, Shown
    from slosh_cli.results.result import Result
    from slosh_cli.results.train_result import TrainResult

    told = {"ratio_to_solid", "history"}
    for kind in (Result, TrainResult):
        for one in kind.in_table(Shown.STUDY, Place.DISTANCE):
            told |= set(one.columns)
    return [(k, name) for k, name in enumerate(head) if name not in told]
