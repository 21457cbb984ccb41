"""Tables of numbers that people give as CSV: the one reader for all of them.

The separator is comma, semicolon or tab, whichever the head uses; numbers are those of a scenario, with a decimal
comma where the separator is another one. Lines that begin with ``#``, empty lines and further columns are left alone.
"""

from __future__ import annotations

import codecs
import csv
import difflib
import io
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from slosh_cli.errors import Problem, ScenarioError
from slosh_cli.scenario.scalars import plain_number
from slosh_cli.scenario.source import Kind, bytes_of, unreadable
from slosh_cli.scenario.units import plain

_TABLE: Final = Kind("CSV", (".csv", ".tsv", ".txt"), 64_000_000, "check the path")
_MOST_ROWS: Final = 1_000_000
_KEPT: Final = 100
"""Problems that are kept; the others are counted."""

_SEPARATORS: Final = {",": "comma", ";": "semicolon", "\t": "tab"}
_SEPARATORS_LISTED: Final = "comma, semicolon or tab as the separator"
_HINT: Final = re.compile(r'"?sep=([,;\t])"?\s*', re.IGNORECASE)
"""The line in which Excel names the separator."""
_BOMS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_LONGEST_HEAD: Final = 500_000
_SAVE_AS: Final = "save the sheet as `CSV UTF-8` and name that file"


@dataclass
class Table:
    """Columns of numbers with the line of every row, and what is wrong with them so far.

    `columns` holds as many numbers for each name as there are `lines`; nan where a cell is wrong.
    """

    file: str
    lines: list[int]
    columns: dict[str, list[float]]
    problems: list[Problem] = field(default_factory=list)
    more: int = 0

    def refuse(self, line: int | None, column: str, rule: str, given: str, fix: str) -> None:
        """Note a problem; `line` is None for the table as a whole."""
        if len(self.problems) < _KEPT:
            self.problems.append(Problem(line, column, rule, given, fix))
        else:
            self.more += 1


def read_table(path: Path, names: Sequence[str], judge: Callable[[Table], None] | None = None) -> Table:
    """The columns `names` of a CSV file, at least one row of them.

    `judge` may note further problems of the table. Raises ScenarioError with everything that is wrong.
    """
    text = _text_of(path)
    separator, hints = _separator(text, names)
    records = _records(path, _Lines(text, hints), separator)
    head_line, head = next(records, (0, []))
    if not head_line:
        fix = f"write the head `{','.join(names)}` and the rows below it"
        raise unreadable(path, f"must have the columns {_listed(names)}", "an empty file", fix)
    table = Table(str(path), [], {name: [] for name in names})
    places = _places(table, head_line, head, names)
    if places:
        _fill(table, records, head, separator, places)
        if not table.lines:
            fix = f"write rows of {len(head)} numbers below line {head_line}"
            table.refuse(None, "", "must have at least one row below its head", "none", fix)
        if judge is not None:
            judge(table)
    if table.problems:
        raise ScenarioError(str(path), sorted(table.problems, key=lambda problem: problem.line or 0), table.more)
    return table


def one_column(path: Path, choices: Sequence[str]) -> str:
    """Which of `choices` the head of a CSV file has. Raises ScenarioError unless it is exactly one."""
    text = _text_of(path)
    separator, hints = _separator(text, choices)
    line, head = next(_records(path, _Lines(text, hints), separator), (0, []))
    found = [name for name in choices if name in head]
    if len(found) != 1:
        given = f"the head {plain(','.join(head))}" if head else "an empty file"
        rule = f"must have exactly one of the columns {_listed(choices)}"
        raise unreadable(path, rule, given, f"write one of them into the head, say `{choices[0]}`", line or None)
    return found[0]


def _text_of(path: Path) -> str:
    raw = bytes_of(path, _TABLE)
    if raw.startswith(b"PK\x03\x04") or raw.startswith(b"\xd0\xcf\x11\xe0"):
        raise unreadable(path, "must be a CSV file", "a spreadsheet", _SAVE_AS)
    encoding = next((encoding for mark, encoding in _BOMS if raw.startswith(mark)), "utf-8")
    try:
        text = raw.decode(encoding)
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        given = f"the byte {raw[error.start]:#04x} at position {error.start}"
        raise unreadable(path, "must be text in UTF-8", given, _SAVE_AS, line) from None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise unreadable(path, "must be text in UTF-8", "a zero byte", _SAVE_AS, line)
    return text


class _Lines:
    """Lines of a text for a CSV reader, which takes several for a record whose quotes hold line ends.

    Between two records empty lines and comments are passed over, and above the first one as many `hints`.
    """

    def __init__(self, text: str, hints: int = 0) -> None:
        self._stream = io.StringIO(text, newline="")
        self._number = 0
        self._hints = hints
        self._between = True
        self.begun = 0

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        for line in self._stream:
            self._number += 1
            if not self._between:
                return line
            if line.strip() and not line.lstrip().startswith("#"):
                if self._hints:
                    self._hints -= 1
                    continue
                self._between = False
                self.begun = self._number
                return line
        raise StopIteration

    def end_record(self) -> None:
        """The next line begins a record."""
        self._between = True


def _separator(text: str, names: Sequence[str]) -> tuple[str, int]:
    """The separator, and how many lines above the head name it as Excel does (``sep=;``).

    Without such a line it is the one with which most of the columns looked for are in the head.
    """
    start = text[:_LONGEST_HEAD]
    hint = _HINT.fullmatch(next(_Lines(start), ""))
    if hint is not None:
        return hint[1], 1
    heads = {separator: _head(start, separator) for separator in _SEPARATORS}
    return max(heads, key=lambda separator: (len(set(names) & set(heads[separator])), len(heads[separator]))), 0


def _head(text: str, separator: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader(_Lines(text), delimiter=separator), [])]
    except csv.Error:
        return []


def _places(table: Table, line: int, head: list[str], names: Sequence[str]) -> list[int]:
    """Where in a row the columns looked for are."""
    rule = f"must have the columns {_listed(names)}, once each"
    for name in names:
        if head.count(name) > 1:
            table.refuse(line, name, rule, f"`{name}` {head.count(name)} times", "keep one of them")
    missing = [name for name in names if name not in head]
    if missing:
        near = difflib.get_close_matches(missing[0], [cell for cell in head if cell not in names], 1, 0.7)
        fix = f"write the head `{','.join(names)}`, with {_SEPARATORS_LISTED}"
        fix = f"write `{missing[0]}` instead of `{near[0]}`" if near else fix
        table.refuse(line, "", rule, f"the head {plain(','.join(head))}", fix)
    return [] if table.problems else [head.index(name) for name in names]


def _records(path: Path, lines: _Lines, separator: str) -> Iterator[tuple[int, list[str]]]:
    """Line and cells of every row that has any."""
    reader = csv.reader(lines, delimiter=separator, strict=True)
    while True:
        try:
            row = next(reader, None)
        except csv.Error as error:
            rule, fix = "must be valid CSV", "close every quote, and double a quote inside quotes"
            raise unreadable(path, rule, f"`{error}`", fix, lines.begun) from None
        lines.end_record()
        if row is None:
            return
        cells = [cell.strip() for cell in row]
        if any(cells):
            yield lines.begun, cells


def _fill(
    table: Table,
    records: Iterator[tuple[int, list[str]]],
    head: list[str],
    separator: str,
    places: list[int],
) -> None:
    """Read the rows into the columns."""
    marks = _DecimalMarks(separator)
    for line, cells in records:
        if len(table.lines) == _MOST_ROWS:
            table.refuse(line, "", f"must have at most {_MOST_ROWS} rows", "more", "leave out rows")
            return
        table.lines.append(line)
        if len(cells) > len(head) and any(cells[len(head) :]):
            fix = "put a decimal point into numbers, or part the cells by semicolons" if separator == "," else ""
            fix = fix or "leave out what is beyond the head"
            rule = f"must have as many cells as the head, {len(head)}, parted by {_SEPARATORS[separator]}"
            table.refuse(line, "", rule, f"{len(cells)}", fix)
        for (name, column), place in zip(table.columns.items(), places, strict=True):
            cell = cells[place] if place < len(cells) else ""
            number = marks.number(cell)
            if number is None:
                table.refuse(line, name, "must be a finite number", *marks.advice(cell))
            column.append(float("nan") if number is None else number)


class _DecimalMarks:
    """Reads numbers with one decimal mark: the first one met, a comma only where cells are parted by something else."""

    def __init__(self, separator: str) -> None:
        self._separator = separator
        self._mark = "." if separator == "," else ""

    def number(self, cell: str) -> float | None:
        found = "," if "," in cell else "." if "." in cell else ""
        self._mark = self._mark or found
        if found and found != self._mark:
            return None
        return plain_number(cell.replace(",", ".")) if found == "," else plain_number(cell)

    def advice(self, cell: str) -> tuple[str, str]:
        """(given, fix) of a cell that is no number."""
        given = plain(cell) if cell else "an empty cell"
        if self._separator == "," and "," in cell:
            return given, "write a decimal point, or part the cells by semicolons"
        if ("," in cell or "." in cell) and not {self._mark} >= set(re.findall(r"[,.]", cell)):
            return given, f"write every number with the decimal mark of those above, `{self._mark}`, and no other"
        return given, "write the number alone, such as `0.981`: no unit, no blanks or underscores inside"


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
