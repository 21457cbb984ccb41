"""Tables of stops: one row per stop, the unit in the column name."""

import csv
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from slosh_cli.results.files import replacing
from slosh_cli.scenario.scalars import plain_number

_FORMULA: Final = tuple("=+-@＝＋－＠")
"""What a spreadsheet takes for the beginning of a formula."""
_CONTROL: Final = tuple("\t\r\n")


def write_table(rows: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write rows that share their columns as CSV (UTF-8); numbers in full, an empty field for None.

    The file at `path` is replaced only when the new one is whole.
    Raises ValueError when there is no row or a row has other columns, FileError when it cannot be written.
    """
    if not rows:
        raise ValueError("A table must have at least one row, but none was given.")
    if any(set(row) != set(rows[0]) for row in rows):
        raise ValueError("A table must have rows with the same fieldnames.")
    write_rows(list(rows[0]), rows, path)


def write_rows(names: Sequence[str], rows: Iterable[Mapping[str, Any]], path: Path) -> int:
    """Write rows as CSV (UTF-8) with the columns `names`, empty where a row has none; returns how many there were.

    Text that a spreadsheet would run as a formula begins with an apostrophe. The file at `path` is replaced only when
    the new one is whole. Raises FileError when it cannot be written.
    """
    count = 0
    with (
        replacing(path) as temporary,
        temporary.open("x", encoding="utf-8", errors="backslashreplace", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([_cell(name) for name in names])
        for row in rows:
            writer.writerow([_cell(row.get(name)) for name in names])
            count += 1
    return count


def _cell(value: Any) -> Any:
    """A value as a cell that no spreadsheet runs: text that begins like a formula is marked as text, numbers stay.

    Line ends inside a text are ``\\n``: the writer puts no quotes round others, and they would end the row.
    """
    if not isinstance(value, str) or not value:
        return value
    runs = value.startswith(_CONTROL) or value.lstrip()[:1] in _FORMULA
    mark = "'" if runs and plain_number(value.strip()) is None else ""
    return mark + "\n".join(value.replace("\r\n", "\n").split("\r"))
