"""What a command says of the files it keeps."""

import os
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from slosh_cli.application.keeping import Keeping, free_folder
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import complain, note


def told(keeping: Keeping, code: ExitCode = ExitCode.DONE) -> ExitCode:
    """Tell what could not be kept, on stderr; returns the exit code of the command, which would else be `code`."""
    if os.environ.get("SLOSH_DEBUG"):
        for cause in keeping.causes:
            traceback.print_exception(cause)
    for failure in keeping.failures:
        complain(f"error: {failure}")
    return ExitCode.BAD_INPUT if keeping.failures and code is ExitCode.DONE else code


def folder_of_its_own(default: Path, fits: Callable[[Path], bool]) -> Path:
    """`default`, or another folder, of which is told, where `default` holds results of something else."""
    folder = free_folder(default, fits)
    if folder != default:
        note(f"{default} holds the results of other settings; these go to {folder}")
    return folder


def files_text(files: Mapping[str, Any]) -> str:
    """Where the files lie, a line per kind."""
    named = [f"  {kind:8} {file}" for kind, file in files.items() if kind != "figures"]
    return "\n".join(["", *named, *([f"  figures  {', '.join(files['figures'])}"] if files["figures"] else [])])
