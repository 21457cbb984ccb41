"""The history file of a run (HDF5): written whole, read back as a `History`."""

import platform
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import h5py
import numpy as np

from slosh_cli.arrays import Array, Vector
from slosh_cli.errors import MOST_SHOWN
from slosh_cli.results.channels import COUPLING_CHANNELS, TIME, Channel, channel
from slosh_cli.results.files import FileError, SteadyFile, finish_moves, replacing
from slosh_cli.results.result import Result
from slosh_cli.results.stored import NEEDED, History, faults_of_attributes, faults_of_columns, faults_of_shape
from slosh_cli.results.surface import SurfaceProfile, surface_profile
from slosh_cli.results.train_result import StoredPart, TrainHistory, TrainResult
from slosh_cli.scenario.loader import Root
from slosh_cli.version import __version__

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario, TankScenario
    from slosh_cli.scenario.train_file import TrainScenario

_FORMAT: Final = 1
_SCENARIO: Final = "scenario"
_VEHICLE: Final = "vehicle_"
_COUPLING: Final = "coupling_"
_SURFACE: Final = "surface_profile"


class _Group(NamedTuple):
    channels: Mapping[Channel, Vector]
    attributes: Mapping[str, Any]


def write_history(result: Result, path: Path) -> None:
    """Write the history of a run, its scenario, its answers and its circumstances to the HDF5 file `path`.

    The file at `path` is replaced only when the new one is whole. Raises FileError when it cannot be written.
    """
    channels = {channel(name): values for name, values in result.channels.items()}
    ledger = {f"energy_{name.removeprefix('energy_')}_J": float(joule) for name, joule in result.energy.items()}
    work = {f"work_{name}": int(count) for name, count in result.work.items()}
    attributes = {"format_version": _FORMAT} | _circumstances() | result.as_attributes() | ledger | work
    profile = surface_profile(result.scenario, result.time, result.channels)
    more = None if profile is None else partial(_write_profile, profile=profile)
    _write(path, result.scenario, result.time, channels, attributes, more=more)


def write_train(result: TrainResult, path: Path) -> None:
    """The same of a train's stop: histories of vehicles and couplings. Raises as `write_history` does."""
    groups: dict[str, _Group] = {}
    for number, vehicle in enumerate(result.vehicles, 1):
        facts = vehicle.as_attributes() | {"scenario": scenario_text(vehicle.scenario)}
        found = {channel(name): values for name, values in vehicle.channels.items()}
        groups[f"{_VEHICLE}{number:03d}"] = _Group(found, facts)
    for number, one in enumerate(result.couplings, 1):
        found = {info: getattr(one, info.name) for info in COUPLING_CHANNELS}
        groups[f"{_COUPLING}{number:03d}"] = _Group(found, one.as_attributes())
    attributes = {"train_format_version": _FORMAT} | _circumstances() | result.as_attributes()
    _write(path, result.scenario, result.time, {}, attributes, groups)


def read_train(path: Path) -> TrainHistory:
    """Read what `write_train` wrote. Raises FileError where the file is missing, damaged or something else."""
    with _unreadable(path), h5py.File(path, "r") as file:
        if file.attrs.get("train_format_version") != _FORMAT:
            raise FileError(f"{path} is not the history of a train that this version can read", where=str(path))
        time = np.asarray(file[TIME.name][:], dtype=np.float64)
        parts = {
            name: StoredPart(
                {key: _plain(value) for key, value in group.attrs.items()},
                {key: np.asarray(group[key][:], dtype=np.float64) for key in group},
            )
            for name, group in file.items()
            if name.startswith((_VEHICLE, _COUPLING))
        }
        attributes = {key: _plain(value) for key, value in file.attrs.items()}
    columns = {f"{name}/{key}": values for name, part in parts.items() for key, values in part.channels.items()}
    _refuse(path, faults_of_columns(time, columns))
    vehicles = tuple(part for name, part in sorted(parts.items()) if name.startswith(_VEHICLE))
    couplings = tuple(part for name, part in sorted(parts.items()) if name.startswith(_COUPLING))
    return TrainHistory(str(attributes["name"]), time, vehicles, couplings, attributes)


def is_train_history(path: Path) -> bool:
    """Whether the file is the history of a train; False where it cannot be read."""
    try:
        with h5py.File(path, "r") as file:
            return "train_format_version" in file.attrs
    except OSError:
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
    attributes = {"excitation_format_version": _FORMAT, **_circumstances(), **facts}
    _write(path, scenario, time, channels, attributes, more=partial(_write_tables, tables=profiles))


def _write_tables(file: h5py.File, tables: Mapping[Channel, Array]) -> None:
    for info, table in tables.items():
        _write_channel(file, info, table)


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
            axis = _write_channel(file, TIME, time)
            axis.make_scale(TIME.name)
            for info, values in channels.items():
                _write_channel(file, info, values).dims[0].attach_scale(axis)
            for name, group in (groups or {}).items():
                part = file.create_group(name)
                for info, values in group.channels.items():
                    _write_channel(part, info, values).dims[0].attach_scale(axis)
                for key, value in group.attributes.items():
                    part.attrs[key] = value
            if more is not None:
                more(file)
            file.create_dataset(_SCENARIO, data=scenario_text(scenario), dtype=h5py.string_dtype())
            for key, value in attributes.items():
                file.attrs[key] = value
        if steady.trouble is not None:
            raise steady.trouble


def read_history(path: Path) -> History:
    """Read a history file.

    Raises FileError when the file is missing, damaged, or not a history that this version can read.
    """
    with _unreadable(path), h5py.File(path, "r") as file:
        attributes = {key: _plain(value) for key, value in file.attrs.items()}
        _check_format(path, attributes)
        scenario_text = _text(path, file)
        columns = _columns(path, file)
    time = columns.pop(TIME.name)
    _refuse(path, faults_of_columns(time, columns))
    return History(time=time, channels=columns, attributes=attributes, scenario_text=scenario_text)


def _columns(path: Path, file: h5py.File) -> dict[str, Vector]:
    """The time axis and every channel that the file has; what else is in it is left alone."""
    known = [name for name in file if _is_known(name)]
    missing = [name for name in (TIME.name, *sorted(NEEDED)) if name not in known]
    lacks = [f"it lacks the channels {', '.join(missing)}"] if missing else []
    _refuse(path, [*lacks, *(fault for name in known for fault in faults_of_shape(name, file.get(name)))])
    return {name: np.asarray(file[name][:], dtype=np.float64) for name in known}


def _is_known(name: str) -> bool:
    try:
        return name == TIME.name or bool(channel(name))
    except KeyError:
        return False


def _text(path: Path, file: h5py.File) -> str:
    """The scenario of the run as resolved YAML."""
    text = file[_SCENARIO][()] if isinstance(file.get(_SCENARIO), h5py.Dataset) else None
    if not isinstance(text, bytes):
        _refuse(path, [f"it lacks the text {_SCENARIO}"])
    return str(text, "utf-8") if isinstance(text, bytes) else ""


def _refuse(path: Path, faults: Iterable[str]) -> None:
    """Raise FileError with all faults of a history, where there are any."""
    found = list(faults)
    if found:
        listed = "; ".join(found[:MOST_SHOWN]) + (f"; and {len(found) - MOST_SHOWN} more" * (len(found) > MOST_SHOWN))
        raise FileError(f"cannot read {path} as a slosh history: {listed}; run the scenario again", where=str(path))


def scenario_text(scenario: "Scenario | TankScenario | TrainScenario") -> str:
    """The resolved scenario as YAML."""
    from slosh_cli.scenario import scenario_to_yaml

    return scenario_to_yaml(scenario) if isinstance(scenario, Root) else scenario.text


def is_of(path: Path, scenario: "Scenario | TankScenario | TrainScenario", settings: str = "") -> bool:
    """Whether the file at `path` is the history of this scenario under these settings; descriptions do not count."""
    try:
        with h5py.File(path, "r") as file:
            text = file[_SCENARIO][()].decode("utf-8")
            found = str(file.attrs.get("settings", ""))
    except Exception:  # whatever it is, it is no history of ours
        return False
    return found == settings and _without_words(text) == _without_words(scenario_text(scenario))


def _without_words(text: str) -> str:
    return re.sub(r"^(name|description):.*\n(?:[ \t].*\n|\n)*", "", text, flags=re.MULTILINE)


def _write_channel(file: h5py.Group, info: Channel, values: Array) -> h5py.Dataset:
    dataset = file.create_dataset(info.name, data=values, dtype="<f8")
    dataset.attrs["units"] = info.unit
    dataset.attrs["long_name"] = info.long_name
    return dataset


def _write_profile(file: h5py.File, profile: SurfaceProfile) -> None:
    """The surface along the tank, (times, places), with its coordinates."""
    instants = Channel(f"{_SURFACE}_time", "s", "instants of the surface along the tank")
    places = Channel(f"{_SURFACE}_place", "m", "distance from the front end wall")
    scales = [_write_channel(file, instants, profile.time), _write_channel(file, places, profile.place)]
    rise = file.create_dataset(_SURFACE, data=profile.rise, dtype="<f4", compression="gzip", shuffle=True)
    rise.attrs.update({"units": "m", "long_name": "rise of the free surface", "standing": profile.standing})
    for axis, scale in enumerate(scales):
        scale.make_scale(scale.name.removeprefix("/"))
        rise.dims[axis].attach_scale(scale)


def read_surface(path: Path) -> SurfaceProfile | None:
    """The surface along the tank that `write_history` kept; None in a file without it. Raises FileError."""
    with _unreadable(path), h5py.File(path, "r") as file:
        if _SURFACE not in file:
            return None
        names = (f"{_SURFACE}_time", f"{_SURFACE}_place", _SURFACE)
        time, place, rise = (np.asarray(file[name][:], dtype=np.float64) for name in names)
        standing = str(file[_SURFACE].attrs["standing"])
    sound = rise.shape == (time.size, place.size) and all(np.isfinite(one).all() for one in (time, place, rise))
    _refuse(path, [] if sound and time.size else [f"its {_SURFACE} must be finite and as long as its coordinates"])
    return SurfaceProfile(time, place, rise, standing)


def _circumstances() -> dict[str, Any]:
    """Which program wrote the file, when and where."""
    return {
        "program": "slosh",
        "program_version": __version__,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "python_version": platform.python_version(),
        "numpy_version": np.__version__,
        "numba_version": version("numba"),
        "platform": f"{platform.platform()} {sys.byteorder}-endian",
    }


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
    _refuse(path, faults_of_attributes(attributes))


def _plain(value: Any) -> Any:
    """A root attribute as a plain Python value where it is a single one."""
    value = value.item() if isinstance(value, np.generic) else value
    return value.decode("utf-8") if isinstance(value, bytes) else value


@contextmanager
def _unreadable(path: Path) -> Iterator[None]:
    finish_moves(path.parent)
    if not path.exists():
        raise FileError(f"{path} does not exist", where=str(path))
    if path.is_dir():
        raise FileError(f"{path} is a folder; give the history file in it, say {path / 'run.h5'}", where=str(path))
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError, MemoryError) as error:
        raise FileError(f"cannot read {path} as a slosh history (HDF5): {error}", where=str(path)) from error
