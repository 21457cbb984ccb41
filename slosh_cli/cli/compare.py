"""`slosh compare`: runs beside each other, from their history files."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, option
from slosh_cli.cli.output import say, say_json

if TYPE_CHECKING:
    from slosh_cli.application.differing import Difference
    from slosh_cli.results.stored import History
    from slosh_cli.results.train_result import TrainHistory

_Files = Annotated[list[Path], typer.Argument(metavar="A.h5 B.h5 ...", help="History files of runs.")]
_FOLDER = "Folder for the figures. Default: outputs/compare."


def compare_command(
    history_files: _Files,
    output: Annotated[Path | None, option("--output -o", "DIR", _FOLDER)] = None,
    as_json: AsJson = False,
) -> ExitCode:
    """Compare runs: answers, inputs, histories in one picture.

    Runs are all of single wagons or all of trains. Changes are against the first run; a run without an answer has a
    dash. Figures of an earlier comparison in the same folder are replaced.
    """
    from slosh_cli.application.comparison import differences, keep_comparison
    from slosh_cli.application.differing import differing_inputs
    from slosh_cli.application.keeping import Keeping
    from slosh_cli.application.runs import read_runs
    from slosh_cli.cli.keeping import told

    runs: Sequence[History | TrainHistory] = read_runs(history_files)
    names = [
        f"{chr(65 + k)}: {run.name} ({file})" for k, (run, file) in enumerate(zip(runs, history_files, strict=True))
    ]
    found, inputs, keeping = differences(runs), differing_inputs(runs), Keeping()
    if not as_json:
        say("\n".join([f"{name}, {run.status}" for name, run in zip(names, runs, strict=True)]))
        say("\n".join(["", *answer_lines(found), "", *_input_lines(inputs), ""]))
    files = keep_comparison(runs, names, output or Path("outputs") / "compare", keeping)
    if as_json:
        told_runs = [{"name": r.name, "file": f, "status": r.status} for r, f in zip(runs, history_files, strict=True)]
        answers = [one.as_dict() for one in found]
        warnings = {"warnings": keeping.failures} if keeping.failures else {}
        say_json({"runs": told_runs, "answers": answers, "inputs": inputs, "figures": files, **warnings})
    else:
        say("\n".join(f"  figure   {file}" for file in files))
    return told(keeping)


def answer_lines(found: Sequence["Difference"]) -> list[str]:
    """Every answer on lines of its own: no number is cut, however narrow the terminal."""
    lines = []
    for one in found:
        lines.append(one.label)
        for place, value in enumerate(one.values):
            text = f"  {chr(65 + place)} {_number(value, one.per):>12} {one.unit if value is not None else ''}".rstrip()
            change, percent = (one.change(place), one.percent(place)) if place else (None, None)
            by = "points" if one.unit == "%" else one.unit  # no per cent of the first run, which follow
            text += f"   {change / one.per:+.5g} {by}".rstrip() if change is not None else ""
            lines.append(text + (f" ({percent:+.3g} %)" if percent is not None else ""))
    return lines


def _number(value: float | None, per: float) -> str:
    return "-" if value is None else f"{value / per:.6g}"


def _input_lines(inputs: Mapping[str, Sequence[Any]]) -> list[str]:
    if not inputs:
        return ["the inputs are the same but for name and description"]
    told = [f"  {key}: {' | '.join(map(_as_written, some))}" for key, some in inputs.items()]
    return ["inputs that differ:", *told]


def _as_written(value: Any) -> str:
    """An input as a scenario has it on one line; a dash where a run has none."""
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key}: {_as_written(one)}' for key, one in value.items())}}}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_as_written, value))}]"
    return "-" if value is None else str(value)
