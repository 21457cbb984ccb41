"""`slosh schema`: the JSON Schema of a scenario, for editors."""

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import say_json


def register(app: typer.Typer) -> None:
    """Add the command to the tree."""
    app.command("schema")(schema)


def schema() -> ExitCode:
    """Print the JSON Schema of a scenario.

    An editor that knows it completes and checks scenarios while they are written.
    """
    from slosh_cli.scenario import json_schema

    say_json(json_schema())
    return ExitCode.DONE
