"""Runs that are compared: all of single wagons or all of trains, from history files or from memory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, TypeVar

from slosh_cli.errors import UsageError
from slosh_cli.results.files import FileError
from slosh_cli.results.result import Record
from slosh_cli.results.stored import History
from slosh_cli.results.train_result import StoredPart, TrainHistory, TrainResult

AnyRun = Record | TrainHistory | TrainResult
"""A run of a wagon or of a train, read back or just computed."""
_R = TypeVar("_R", History, TrainHistory)
_MOST: Final = 6
"""Runs that can be told apart in one picture."""


def trains_of(runs: Sequence[AnyRun]) -> list[TrainHistory] | None:
    """The runs as histories of trains with the texts of their scenarios; None where all are of single wagons.

    Raises UsageError where there are some of both.
    """
    trains = [run for run in runs if isinstance(run, TrainHistory | TrainResult)]
    if trains and len(trains) < len(runs):
        wagon = next(run for run in runs if not isinstance(run, TrainHistory | TrainResult))
        raise UsageError(_mixed(trains[0].name, wagon.name))
    return [_whole(run) if isinstance(run, TrainResult) else run for run in trains] or None


def read_runs(files: Sequence[Path]) -> list[History] | list[TrainHistory]:
    """The runs of history files. Raises UsageError and FileError for files that cannot be compared, with what to do."""
    from slosh_cli.results.hdf5 import is_train_history, read_history, read_train

    if not 2 <= len(files) <= _MOST:
        raise UsageError(f"two to {_MOST} runs can be compared; given {len(files)}; write `slosh compare A.h5 B.h5`")
    known: dict[Path, Path] = {}
    for file in files:
        if (twice := known.setdefault(file.resolve(), file)) is not file:
            raise UsageError(f"{twice} and {file} are the same file; give another run to compare with", str(file))
    trains = [file for file in files if is_train_history(file)]
    if not trains:
        return [_told(read_history, file) for file in files]
    found = {file: _told(read_train, file) for file in trains}
    for file in files:
        if file not in found:
            _told(read_history, file)  # what is no run at all is told as such
            raise UsageError(_mixed(str(trains[0]), str(file)), str(file))
    return list(found.values())


def _told(read: Callable[[Path], _R], file: Path) -> _R:
    """What `read` finds in a file; its error says which files are wanted."""
    try:
        return read(file)
    except FileError as error:
        fix = "" if file.is_dir() else "; give history files (run.h5) that `slosh run` wrote"
        raise FileError(f"{error.message}{fix}", where=str(file)) from error


def _mixed(train: str, wagon: str) -> str:
    rule = f"{train} is the run of a train and {wagon} that of a single wagon: they have no answer in common"
    return f"{rule}; compare runs of trains with each other, or runs of wagons"


def _whole(train: TrainResult) -> TrainHistory:
    """A train's run as its file would have it."""
    from slosh_cli.results.hdf5 import scenario_text

    history = train.history
    texts = [scenario_text(one.scenario) for one in train.vehicles]
    vehicles = tuple(
        StoredPart({**one.facts, "scenario": text}, one.channels)
        for one, text in zip(history.vehicles, texts, strict=True)
    )
    return replace(history, vehicles=vehicles, scenario_text=scenario_text(train.scenario))
