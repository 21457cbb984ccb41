"""`slosh validate`: every claim of the program held against something it did not compute."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, option
from slosh_cli.cli.output import note, say, say_json, show

if TYPE_CHECKING:
    from rich.table import Table

    from slosh_cli.validation.case import CaseResult
    from slosh_cli.validation.data_file import CaseData

_FOLDER: Final = "Folder for report and figures. Default: outputs/validation, in it a folder of its own for NAMEs."


def validate_command(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME]...", help="Cases to run; all without a name.", show_default=False),
    ] = None,
    as_json: AsJson = False,
    list_only: Annotated[bool, typer.Option("--list", help="List the cases and their questions; run none.")] = False,
    output: Annotated[Path | None, option("--output -o", "DIR", _FOLDER)] = None,
) -> ExitCode:
    """Check the program against published and exact results.

    Closed forms, quadratures, published numbers, other codes. Exit code 1 when a case misses its stated tolerance.
    """
    from slosh_cli.application.validation import validation_folder
    from slosh_cli.validation.registry import chosen, left_out

    cases = chosen(names or [])
    missing = [] if names else left_out()
    if list_only:
        _list(cases, missing, as_json=as_json)
        return ExitCode.DONE
    folder = validation_folder(cases, output, part=bool(names))
    return _carry_out(names or [], missing, folder, as_json=as_json)


def _carry_out(names: Sequence[str], missing: "Sequence[CaseData]", folder: Path, *, as_json: bool) -> ExitCode:
    """Run the cases, write report and figures, tell what came out."""
    from slosh_cli.application.keeping import Keeping
    from slosh_cli.application.validation import keep_validation, validate
    from slosh_cli.cli.keeping import told
    from slosh_cli.cli.progress import announce_solver, counting

    announce_solver(("modal", "rigid"))
    with counting("cases") as progress:
        results = validate(names, progress)
    if not as_json:
        _show(results, missing, detailed=bool(names))
    keeping = Keeping()
    files = keep_validation(results, missing, folder, keeping)
    if as_json:
        answer = {"cases": [result.as_dict() for result in results], "left_out": [data.name for data in missing]}
        say_json({**answer, "files": files, **({"warnings": keeping.failures} if keeping.failures else {})})
    elif "report" in files:
        say(f"  report   {files['report']}")
    return told(keeping, ExitCode.DONE if all(result.passed for result in results) else ExitCode.FELL_SHORT)


def _list(cases: "Sequence[CaseData]", missing: "Sequence[CaseData]", *, as_json: bool) -> None:
    if as_json:
        fields = [{"name": data.name, "title": data.title, "question": data.question} for data in cases]
        say_json({"cases": fields, "left_out": [data.name for data in missing]})
        return
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    for data in cases:
        table.add_row(data.name, f"{data.title}. {data.question}")
    show(table)
    _say_missing(missing)


def _show(results: "Sequence[CaseResult]", missing: "Sequence[CaseData]", *, detailed: bool) -> None:
    """Named cases and those that fell short row by row, then one line per case."""
    from slosh_cli.validation.markdown import summary_sentence

    for result in results:
        if detailed or not result.passed:
            show(_rows(result), "")
    show(_overview(results))
    _say_missing(missing)
    if not detailed:
        note("`slosh validate NAME` prints every row of a case.")
    say(summary_sentence(results))


def _rows(result: "CaseResult") -> "Table":
    from rich.table import Table
    from rich.text import Text

    from slosh_cli.validation.markdown import number, verdict_of

    table = Table(
        title=f"{result.name}: {result.data.title}", title_justify="left", title_style="bold", show_edge=False
    )
    table.add_column("quantity")
    for column in ("ours", "reference", "deviation", "tolerance"):
        table.add_column(column, justify="right")
    table.add_column("verdict")
    for row in result.rows:
        style = "" if row.passed else "bold red"
        cells = [
            row.quantity,
            number(row.value),
            number(row.reference),
            number(row.deviation, 2),
            number(row.tolerance, 2),
        ]
        # plain texts: a bracket in a quantity is no markup
        table.add_row(*(Text(cell) for cell in (*cells, verdict_of(row))), style=style)
    return table


def _overview(results: "Sequence[CaseResult]") -> "Table":
    from rich.table import Table

    from slosh_cli.validation.markdown import FELL_SHORT, PASSED

    table = Table(show_edge=False)
    table.add_column("case")
    table.add_column("rows that count", justify="right")
    table.add_column("worst deviation over tolerance", justify="right")
    table.add_column("s", justify="right")
    table.add_column("verdict")
    for result in results:
        counting = [row for row in result.rows if row.tolerance is not None]
        shares = [row.deviation / row.tolerance for row in counting if row.deviation is not None and row.tolerance]
        worst = f"{max(shares):.2g}" if shares else ""
        verdict, style = (PASSED, "") if result.passed else (FELL_SHORT, "bold red")
        table.add_row(result.name, str(len(counting)), worst, f"{result.seconds:.1f}", verdict, style=style)
    return table


def _say_missing(missing: "Sequence[CaseData]") -> None:
    from slosh_cli.version import install_command

    for data in missing:
        note(f"{data.name} is left out: it needs {data.needs}, `{install_command('validation')}`.")
