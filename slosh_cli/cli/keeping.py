"""What a command says of the files it keeps."""

import os
import traceback
from collections.abc import Mapping
from typing import Any

from slosh_cli.application.keeping import Keeping
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import complain


def told(keeping: Keeping, code: ExitCode = ExitCode.DONE) -> ExitCode:
    """Tell what could not be kept, on stderr; returns the exit code of the command, which would else be `code`."""
    if os.environ.get("SLOSH_DEBUG"):
        for cause in keeping.causes:
            traceback.print_exception(cause)
    for failure in keeping.failures:
        complain(f"error: {failure}")
    return ExitCode.BAD_INPUT if keeping.failures and code is ExitCode.DONE else code


def files_text(files: Mapping[str, Any]) -> str:
    """Where the files lie, a line per kind."""
    named = [f"  {kind:8} {file}" for kind, file in files.items() if kind != "figures"]
    return "\n".join(["", *named, *([f"  figures  {', '.join(files['figures'])}"] if files["figures"] else [])])
