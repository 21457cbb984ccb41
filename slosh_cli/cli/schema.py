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
        _FileKind,
        typer.Argument(metavar="KIND", help="`scenario` (of a stop, or of a tank alone), `study` or `train`."),
    ] = _FileKind.SCENARIO,
) -> ExitCode:
    """Print the JSON Schema of a scenario, a study or a train.

    An editor that knows it completes and checks files while they are written.
    """
    if kind is not _FileKind.SCENARIO:
        from slosh_cli.study.study_schema import study_schema, train_schema

        say_json(study_schema() if kind is _FileKind.STUDY else train_schema())
        return ExitCode.DONE
    from slosh_cli.scenario import json_schema

    say_json(json_schema())
    return ExitCode.DONE
