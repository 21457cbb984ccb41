"""What a command says of the files it keeps."""

import os
import traceback
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from slosh_cli.application.keeping import Keeping
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import complain, say_json, warn

if TYPE_CHECKING:
    from slosh_cli.results.result import Result
    from slosh_cli.results.train_result import TrainResult


def told(keeping: Keeping, code: ExitCode = ExitCode.DONE) -> ExitCode:
    """Tell what could not be kept, on stderr; returns the exit code of the command, which would else be `code`."""
    if os.environ.get("SLOSH_DEBUG"):
        for cause in keeping.causes:
            traceback.print_exception(cause)
    for failure in keeping.failures:
        complain(f"error: {failure}")
    return ExitCode.BAD_INPUT if keeping.failures and code is ExitCode.DONE else code


def answered(
    result: "Result | TrainResult",
    files: Mapping[str, Any],
    keeping: Keeping,
    *,
    as_json: bool,
    more: Mapping[str, Any] | None = None,
) -> ExitCode:
    """Tell the end of a run: with `as_json` the whole answer with what is `more`, else where its `files` lie.

    Returns the exit code.
    """
    from slosh_cli.cli.summary import show_files
    from slosh_cli.results.result import Status

    stopped = result.status is Status.STOPPED
    if as_json:
        answer = result.summary()
        say_json(answer | {"warnings": [*answer["warnings"], *keeping.failures], "files": files} | dict(more or {}))
        for warning in result.warnings:
            warn(warning)
        if not stopped:
            complain(f"{result.status}: {result.reason} {result.status.remedy}")
    else:
        show_files(files)
    return told(keeping, ExitCode.DONE if stopped else ExitCode.NO_ANSWER)


def files_text(files: Mapping[str, Any]) -> str:
    """Where the files lie, a line per kind."""
    named = [f"  {kind:8} {file}" for kind, file in files.items() if kind != "figures"]
    return "\n".join(["", *named, *([f"  figures  {', '.join(files['figures'])}"] if files["figures"] else [])])
