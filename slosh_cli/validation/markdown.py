"""Cases and their results as Markdown: the report of a run, and the chapters of the manual."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from slosh_cli.validation.case import CaseResult, Row
from slosh_cli.validation.data_file import CaseData

PASSED, FELL_SHORT = "passed", "fell short"


def number(value: float | str | None, digits: int = 7) -> str:
    """A value as a person reads it."""
    if value is None:
        return ""
    return value if isinstance(value, str) else f"{value:.{digits}g}"


def verdict_of(row: Row) -> str:
    """What a row says: it passed, fell short, or is for information."""
    if row.tolerance is None:
        return "for information"
    return PASSED if row.passed else FELL_SHORT


def report(results: Sequence[CaseResult], left_out: Sequence[CaseData], heading: str) -> str:
    """The report of a run: a table of cases, then every case with all its rows and its figure."""
    lines = [
        f"# {heading}",
        "",
        summary_sentence(results),
        "",
        "| case | verdict | rows | seconds |",
        "|---|---|---|---|",
    ]
    for result in results:
        verdict = PASSED if result.passed else FELL_SHORT
        lines.append(f"| [{result.name}](#{result.name}) | {verdict} | {len(result.rows)} | {result.seconds:.1f} |")
    lines += [f"| {data.name} | left out: needs {data.needs} | | |" for data in left_out]
    for result in results:
        lines += ["", f"## {result.name}", "", *description(result.data), "", *row_table(result.rows)]
        if result.chart is not None:
            lines += ["", f"![{cell(result.data.title)}]({result.name}.png)"]
    return "\n".join(lines) + "\n"


def summary_sentence(results: Sequence[CaseResult]) -> str:
    """How many cases passed, and which did not."""
    short = [result.name for result in results if not result.passed]
    counted = f"{len(results) - len(short)} of {len(results)} cases passed"
    return counted + (f"; fell short: {', '.join(short)}." if short else ".")


def description(data: CaseData) -> list[str]:
    """What a case asks, how it goes about it, where the reference comes from, what is known to be wrong in it."""
    lines = [f"**{data.title}.** {data.question}", "", data.method, "", f"Source: {data.source}."]
    if data.errata:
        lines += ["", "What to know about the source:", "", *(f"- {text}" for text in data.errata)]
    return lines


def row_table(rows: Iterable[Row]) -> list[str]:
    """All rows of a case."""
    lines = ["| quantity | ours | reference | deviation | tolerance | verdict |", "|---|---|---|---|---|---|"]
    for row in rows:
        cells = [row.quantity, number(row.value), number(row.reference), number(row.deviation, 2)]
        cells += [number(row.tolerance, 2), verdict_of(row)]
        lines.append("| " + " | ".join(cell(text) for text in cells) + " |")
    return lines


def cell(text: str) -> str:
    """A text as the cell of a table."""
    return text.replace("|", "\\|")
