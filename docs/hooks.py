"""Hooks of the documentation's build: the validation manual and every table of results come from the cases themselves.

A line ``See `slosh validate CASE`.`` or ``See `slosh validate CASE`, rows on *words*.`` in a page becomes the rows of
that case (with those words in the quantity). In the source tree it reads as it stands. The page ``validation.md`` does
not exist as a file: it is the registry, run when the site is built.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from slosh_cli.validation import registry
from slosh_cli.validation.case import CaseResult
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.markdown import cell, description, row_table, summary_sentence

FOREIGN = re.compile(
    r"<(?:script|img|iframe|source|video)\b[^>]*\bsrc=[\"']?(?:https?:)?//[^\"'\s>]+"
    r"|<link\b(?![^>]*\brel=[\"']?canonical)[^>]*\bhref=[\"']?(?:https?:)?//[^\"'\s>]+"
    r"|(?:@import\s+|url\()[\"']?(?:https?:)?//[^\"'\s)]+"
)
"""What makes a browser fetch from elsewhere: scripts, images, styles, fonts. A link that a reader follows does not."""

ROWS = re.compile(r"^See `slosh validate ([a-z0-9-]+)`(?:, rows on \*(.+?)\*)?\.$", re.MULTILINE)

INTRODUCTION = """# Verification and validation

Every case holds the program against something it did not compute: a closed form, a quadrature, a conventional
discretisation, published numbers, another code. Each has a tolerance with a reason, and at least one deliberate error
in the program that turns it red; a test makes that error and looks. This page is made by running the cases when the
documentation is built; `slosh validate` prints the same.

"""


@cache
def result_of(name: str) -> CaseResult:
    """The result of a case, run once per build."""
    return registry.case_result(registry.chosen([name])[0])


def manual(results: Sequence[CaseResult], left_out: Sequence[CaseData]) -> str:
    """The whole manual: what catches what, then a chapter per case."""
    lines = [INTRODUCTION, summary_sentence(results), ""]
    for data in left_out:
        lines += [f"Not in this page: **{data.name}** ({data.title.lower()}), which needs `{data.needs}`.", ""]
    lines += [
        "## Which error is caught by which case",
        "",
        "| deliberate error in the program | case that turns red |",
        "|---|---|",
    ]
    every = [*(result.data for result in results), *left_out]
    lines += [f"| {catch.error} | {data.name} |" for data in every for catch in data.catches]
    lines.append("")
    for result in results:
        lines.append(chapter(result))
        if result.chart is not None:
            lines.append(f"![{result.data.title}](figures/{result.name}.png)\n")
    return "\n".join(lines)


def chapter(result: CaseResult) -> str:
    """A case as a chapter of the manual: description, tolerances, results, the errors that it catches."""
    lines = [f"## {result.name}", "", *description(result.data), "", *tolerances_of(result.data)]
    lines += ["", *row_table(result.rows)]
    if result.data.catches:
        lines += ["", "Deliberate errors that turn this case red (each is a test):", ""]
        lines += [f"- {catch.error}" for catch in result.data.catches]
    return "\n".join(lines) + "\n"


def tolerances_of(data: CaseData) -> list[str]:
    """The tolerances of a case and their reasons."""
    lines = ["| tolerance | value | kind | reason |", "|---|---|---|---|"]
    for key, entry in data.tolerances.items():
        lines.append(f"| {key.replace('_', ' ')} | {entry.value:g} | {entry.kind} | {cell(entry.reason)} |")
    return lines


def with_rows(text: str, result: Callable[[str], CaseResult] = result_of) -> str:
    """A page with its tables of results put in. Raises ValueError for a table that would be empty."""

    def table(match: re.Match[str]) -> str:
        name, words = match[1], match[2]
        rows = [row for row in result(name).rows if not words or words in row.quantity]
        if not rows:
            raise ValueError(f"case {name} has no row about {words!r}")
        return "\n".join([f"`slosh validate {name}`:", "", *row_table(rows)])

    return ROWS.sub(table, text)


def on_files(files: Any, config: Any) -> Any:
    """Add the validation manual and its figures to the site."""
    from mkdocs.structure.files import File

    from slosh_cli import plot

    results = [result_of(data.name) for data in registry.chosen([])]
    files.append(File.generated(config, "validation.md", content=manual(results, registry.left_out())))
    folder = Path(tempfile.mkdtemp(prefix="slosh-docs-"))
    for result in results:
        for name in plot(result, folder):
            image = (folder / f"{name}.png").read_bytes()
            files.append(File.generated(config, f"figures/{name}.png", content=image))
    return files


def on_page_markdown(markdown: str, **_: Mapping[str, Any]) -> str:
    """Put the tables of results into a page."""
    return with_rows(markdown)


def fetched_from_elsewhere(text: str) -> list[str]:
    """What a page or a style sheet would load from another host."""
    return FOREIGN.findall(text)


def on_post_build(config: Any) -> None:
    """Refuse a site that needs a network. Raises ValueError with what it would fetch."""
    for file in sorted(Path(config["site_dir"]).rglob("*")):
        if file.suffix in (".html", ".css"):
            found = fetched_from_elsewhere(file.read_text(encoding="utf-8"))
            if found:
                raise ValueError(f"{file.name} loads from elsewhere: {', '.join(found)}")
