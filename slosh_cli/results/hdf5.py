"""The history file of a run (HDF5): written whole, read back as a `History`."""

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar, cast

import h5py

from slosh_cli.arrays import Array, Vector
from slosh_cli.errors import MOST_SHOWN
from slosh_cli.results.channels import COUPLING_CHANNELS, TIME, Channel, channel
from slosh_cli.results.files import FileError, SteadyFile, finish_moves, replacing
from slosh_cli.results.hdf5_parts import circumstances, stored_surface, write_channel, write_surface
from slosh_cli.results.result import Result
from slosh_cli.results.stored import (
    EXCITED,
    History,
    StoredExcitation,
    faults_of_answers,
    faults_of_columns,
    plain_attributes,
    stored_columns,
)
from slosh_cli.results.stored_train import COUPLING, SCENARIO, VEHICLE, stored_train
from slosh_cli.results.surface import SurfaceProfile, surface_profile
from slosh_cli.results.train_result import TrainHistory, TrainResult
from slosh_cli.scenario.loader import Root
from slosh_cli.scenario.source import other_than_file

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario, TankScenario
    from slosh_cli.scenario.train_file import TrainScenario

_F = TypeVar("_F")
_FORMAT: Final = 1
_LONGEST_TEXT: Final = 1_000_000


class _Group(NamedTuple):
    channels: Mapping[Channel, Vector]
    attributes: Mapping[str, Any]
    surface: "SurfaceProfile | None" = None


def write_history(result: Result, path: Path) -> None:
    """Write the history of a run, its scenario, its answers and its circumstances to the HDF5 file `path`.

    The file at `path` is replaced only when the new one is whole. Raises FileError when it cannot be written.
    """
    channels = {channel(name): values for name, values in result.channels.items()}
    ledger = {f"energy_{name.removeprefix('energy_')}_J": float(joule) for name, joule in result.energy.items()}
    work = {f"work_{name}": int(count) for name, count in result.work.items()}
    attributes = {"format_version": _FORMAT} | circumstances() | result.as_attributes() | ledger | work
    profile = surface_profile(result.scenario, result.time, result.channels, result.wetted)
    more = None if profile is None else partial(write_surface, profile=profile)
    _write(path, result.scenario, result.time, channels, attributes, more=more)


def write_train(result: TrainResult, path: Path) -> None:
    """The same of a train's stop: histories of vehicles and couplings. Raises as `write_history` does."""
    groups: dict[str, _Group] = {}
    for number, vehicle in enumerate(result.vehicles, 1):
        facts = vehicle.as_attributes() | {SCENARIO: scenario_text(vehicle.scenario)}
        found = {channel(name): values for name, values in vehicle.channels.items()}
        surface = surface_profile(vehicle.scenario, result.time, vehicle.channels, vehicle.wetted)
        groups[f"{VEHICLE}{number:03d}"] = _Group(found, facts, surface)
    for number, one in enumerate(result.couplings, 1):
        found = {info: getattr(one, info.name) for info in COUPLING_CHANNELS}
        groups[f"{COUPLING}{number:03d}"] = _Group(found, one.as_attributes())
    attributes = {"train_format_version": _FORMAT} | circumstances() | result.as_attributes()
    _write(path, result.scenario, result.time, {}, attributes, groups)


def read_train(path: Path) -> TrainHistory:
    """Read what `write_train` wrote. Raises FileError where the file is missing, damaged or something else."""
    with _opened(path) as file:
        if file.attrs.get("train_format_version") != _FORMAT:
            raise FileError(f"{path} is not the history of a train that this version can read", where=str(path))
        return _sound(path, stored_train(file, _text(path, file)))


def is_train_history(path: Path) -> bool:
    """Whether the file is the history of a train; False where it cannot be read."""
    return _has_attribute(path, "train_format_version")


def _has_attribute(path: Path, name: str) -> bool:
    try:
        if other_than_file(path):
            return False
        with h5py.File(path, "r") as file:
            return name in file.attrs
    except (OSError, ValueError):
        return False


def write_excitation(
    scenario: "Scenario | TankScenario",
    time: Vector,
    channels: Mapping[Channel, Vector],
    facts: Mapping[str, Any],
    path: Path,
    profiles: "Mapping[Channel, Array]",
) -> None:
    """Write the history of a tank alone, whole, as `write_history`: `profiles` have axes of their own."""
    attributes = {"excitation_format_version": _FORMAT, **circumstances(), **facts}
    _write(path, scenario, time, channels, attributes, more=partial(_write_tables, tables=profiles))


def _write_tables(file: h5py.File, tables: Mapping[Channel, Array]) -> None:
    for info, table in tables.items():
        write_channel(file, info, table)


def _write(
    path: Path,
    scenario: "Scenario | TankScenario | TrainScenario",
    time: Vector,
    channels: Mapping[Channel, Vector],
    attributes: Mapping[str, Any],
    groups: "Mapping[str, _Group] | None" = None,
    more: Callable[[h5py.File], None] | None = None,
) -> None:
    """Write the file; it replaces the one at `path` when all of it is on the disk.

    HDF5 does not survive a disk that is full, or ends the process with it; so it never gets to know.
    """
    with replacing(path) as temporary, temporary.open("xb+") as target:
        steady = SteadyFile(target)
        with h5py.File(steady, "w") as file:
            axis = write_channel(file, TIME, time)
            axis.make_scale(TIME.name)
            for info, values in channels.items():
                write_channel(file, info, values).dims[0].attach_scale(axis)
            for name, group in (groups or {}).items():
                part = file.create_group(name)
                for info, values in group.channels.items():
                    write_channel(part, info, values).dims[0].attach_scale(axis)
                for key, value in group.attributes.items():
                    part.attrs[key] = value
                if group.surface is not None:
                    write_surface(part, group.surface)
            if more is not None:
                more(file)
            file.create_dataset(SCENARIO, data=scenario_text(scenario), dtype=h5py.string_dtype())
            for key, value in attributes.items():
                file.attrs[key] = value
        if steady.trouble is not None:
            raise steady.trouble


def read_history(path: Path) -> History:
    """Read a history file.

    Raises FileError when the file is missing, damaged, or not a history that this version can read.
    """
    with _opened(path) as file:
        attributes = plain_attributes(file)
        _check_format(path, attributes)
        scenario_text = _text(path, file)
        columns = _sound(path, stored_columns(file))
    time = columns.pop(TIME.name)
    _refuse(path, faults_of_columns(time, columns))
    return History(time=time, channels=columns, attributes=attributes, scenario_text=scenario_text)


def read_excitation(path: Path) -> StoredExcitation:
    """Read what `write_excitation` wrote. Raises FileError where the file is missing, damaged or something else."""
    with _opened(path) as file:
        if file.attrs.get("excitation_format_version") != _FORMAT:
            raise FileError(f"{path} is not the history of a tank alone that this version can read", where=str(path))
        name, text, columns = str(file.attrs["name"]), _text(path, file), _sound(path, stored_columns(file, EXCITED))
        surface, faults = stored_surface(file, excited=True)
    time = columns.pop(TIME.name)
    _refuse(path, [*faults_of_columns(time, columns, EXCITED), *faults])
    return StoredExcitation(name, time, columns, surface, text)


def is_excitation(path: Path) -> bool:
    """Whether the file is the history of a tank alone; False where it cannot be read."""
    return _has_attribute(path, "excitation_format_version")


def _text(path: Path, file: h5py.File) -> str:
    """The scenario of the run as resolved YAML."""
    held = file.get(SCENARIO)
    is_text = isinstance(held, h5py.Dataset) and held.shape == () and held.dtype.itemsize <= _LONGEST_TEXT
    text = held[()] if is_text else None
    _refuse(path, [] if isinstance(text, bytes) else [f"it lacks the text {SCENARIO}"])
    return str(text, "utf-8") if isinstance(text, bytes) else ""


def _refuse(path: Path, faults: Iterable[str]) -> None:
    """Raise FileError with all faults of a history, where there are any."""
    if found := list(faults):
        listed = "; ".join(found[:MOST_SHOWN]) + (f"; and {len(found) - MOST_SHOWN} more" * (len(found) > MOST_SHOWN))
        raise FileError(f"cannot read {path} as a slosh history: {listed}; run the scenario again", where=str(path))


def _sound(path: Path, found: _F | list[str]) -> _F:
    """What was found in a file, unless that is a list of faults."""
    if isinstance(found, list):
        _refuse(path, found)
    return cast("_F", found)


def scenario_text(scenario: "Scenario | TankScenario | TrainScenario") -> str:
    """The resolved scenario as YAML."""
    from slosh_cli.scenario import scenario_to_yaml

    return scenario_to_yaml(scenario) if isinstance(scenario, Root) else scenario.text


def is_of(path: Path, scenario: "Scenario | TankScenario | TrainScenario", settings: str = "") -> bool:
    """Whether the file at `path` is the history of this scenario under these settings; descriptions do not count."""
    return inputs_of(path) == f"{settings}\n{_without_words(scenario_text(scenario))}"


def inputs_of(path: Path) -> str | None:
    """Settings and scenario of a history, without name and description; None of what is no history of ours."""
    try:
        if other_than_file(path):
            return None
        with h5py.File(path, "r") as file:
            return f"{file.attrs.get('settings', '')}\n{_without_words(file[SCENARIO][()].decode('utf-8'))}"
    except Exception:  # whatever it is, it is no history of ours
        return None


def _without_words(text: str) -> str:
    return re.sub(r"^(name|description):.*\n(?:[ \t].*\n|\n)*", "", text, flags=re.MULTILINE)


def read_surface(path: Path, vehicle: int | None = None) -> SurfaceProfile | None:
    """The surface along the tank of a run, or of a train's vehicle counted from 1 at the front; None in a file without.

    Raises FileError for a file that cannot be read, a damaged surface, or a vehicle that the file has not.
    """
    with _opened(path) as file:
        profile, faults = stored_surface(_of_vehicle(path, file, vehicle))
    _refuse(path, faults)
    return profile


def _of_vehicle(path: Path, file: h5py.File, vehicle: int | None) -> h5py.Group:
    """The part of a file that holds the histories of one wagon."""
    numbers = [int(name.removeprefix(VEHICLE)) for name in file if name.startswith(VEHICLE)]
    if vehicle is None and numbers:
        raise FileError(f"{path} is the history of a train: say which of {len(numbers)} vehicles", where=str(path))
    if vehicle is not None and vehicle not in numbers:
        raise FileError(f"{path} has no vehicle {vehicle}, but {len(numbers)} vehicles", where=str(path))
    return file if vehicle is None else file[f"{VEHICLE}{vehicle:03d}"]


def _check_format(path: Path, attributes: Mapping[str, Any]) -> None:
    found = attributes.get("format_version")
    if attributes.get("program") != "slosh" or found is None:
        raise FileError(f"{path} is an HDF5 file, but not the history of a slosh run", where=str(path))
    if found != _FORMAT:
        raise FileError(
            f"{path} has history format {found}, but this version of slosh reads format {_FORMAT}; "
            f"it was written by slosh {attributes.get('program_version', '?')}",
            where=str(path),
        )
    _refuse(path, faults_of_answers(History.table(), attributes))


@contextmanager
def _opened(path: Path) -> Iterator[h5py.File]:
    """The file, open for reading. Raises FileError where it is missing, damaged, or leads to other files."""
    finish_moves(path.parent)
    try:
        other = other_than_file(path)
        if other == "a folder":
            raise FileError(f"{path} is a folder; give the history file in it, say {path / 'run.h5'}", where=str(path))
        if other:
            raise FileError(f"{path} is {other}; give a history file (run.h5)", where=str(path))
        if not os.path.exists(path):
            raise FileError(f"{path} does not exist", where=str(path))
        with h5py.File(path, "r") as file:
            _refuse(path, _faults_of_links(file))
            yield file
    except (OSError, RuntimeError, LookupError, ValueError, TypeError, AttributeError, MemoryError) as error:
        number = error.errno if isinstance(error, OSError) else None
        reason = os.strerror(number) if number else " ".join(str(error).split())
        raise FileError(f"cannot read {path} as a slosh history (HDF5): {reason}", where=str(path)) from error


def _faults_of_links(group: h5py.Group, depth: int = 2) -> Iterator[str]:
    """Names that lead to other files, which nobody has checked."""
    for name in group:
        if isinstance(group.get(name, getlink=True), h5py.ExternalLink):
            yield f"its {name} must be in the file itself, but is a link to another one"
        elif depth > 1 and isinstance(group.get(name), h5py.Group):
            yield from _faults_of_links(group[name], depth - 1)
