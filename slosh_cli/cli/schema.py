"""`slosh schema`: the JSON Schemas of the files that people write, for editors."""

from enum import StrEnum
from typing import Annotated

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import say_json


class _FileKind(StrEnum):
    """What a file describes."""

    SCENARIO = "scenario"
    STUDY = "study"
    TRAIN = "train"


def schema_command(
    kind: Annotated[
        _FileKind | None,
        typer.Argument(
            metavar="[KIND]",
            help="`scenario` (of a stop, or of a tank alone), `train` or `study`. Default: scenario or train.",
            show_default=False,
        ),
    ] = None,
) -> ExitCode:
    """Print the JSON Schema of a scenario, a study or a train.

    An editor that knows it completes and checks files while they are written.
    """
    from slosh_cli.scenario import json_schema
    from slosh_cli.study.study_schema import every_schema, study_schema, train_schema

    made = {_FileKind.SCENARIO: json_schema, _FileKind.STUDY: study_schema, _FileKind.TRAIN: train_schema}
    say_json(made[kind]() if kind else every_schema())
    return ExitCode.DONE
