"""`slosh init`: a commented scenario to start from."""

from pathlib import Path
from typing import Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import option
from slosh_cli.cli.output import say
from slosh_cli.errors import UsageError

_DEFAULT: Final = "tank-wagon"
_FILE: Final = "File to write; the scenario takes its name. Default: its own name, in the current folder."


def init_command(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Packaged scenario to copy; --list shows them all.")
    ] = _DEFAULT,
    output: Annotated[Path | None, option("--output -o", "FILE", _FILE)] = None,
    names: Annotated[bool, typer.Option("--list", help="List the packaged scenarios and exit.")] = False,
) -> ExitCode:
    """Write a commented scenario to start from. Never overwrites a file."""
    from slosh_cli.scenario import (
        Scenario,
        find_packaged,
        load_any_scenario,
        packaged_scenarios,
        packaged_text,
    )
    from slosh_cli.scenario.packaged import packaged_trains
    from slosh_cli.scenario.words import file_safe

    every = packaged_scenarios() | packaged_trains()
    if names:
        say("\n".join(every))
        return ExitCode.DONE
    source = find_packaged(name, trains=True)
    own_name, text = packaged_text(source, file_safe(output.stem) if output else "")
    file = output or Path(f"{own_name}.yaml")
    _write_new(file, text)
    runs = source in packaged_trains().values() or isinstance(load_any_scenario(source), Scenario)
    then = f", run it with `slosh run {file}`" if runs else ""
    say(f"{file} written. Change it, check it with `slosh check {file}`{then}.")
    others = [other for other, path in every.items() if path != source]
    if others:
        say(f"Others to start from: {', '.join(others)}.")
    return ExitCode.DONE


def _write_new(file: Path, text: str) -> None:
    try:
        new = file.open("x", encoding="utf-8", newline="\n")
    except FileExistsError as error:
        raise UsageError(f"{file} exists already; choose another name with -o FILE", str(file)) from error
    except OSError as error:
        raise UsageError(f"cannot write {file}: {error.strerror or error}", str(file)) from error
    try:
        with new:
            new.write(text)
    except OSError as error:
        file.unlink(missing_ok=True)
        raise UsageError(f"cannot write {file}: {error.strerror or error}", str(file)) from error
