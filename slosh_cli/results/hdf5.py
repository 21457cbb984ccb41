"""The history file of a run (HDF5): written whole, read back as a `History`."""

import json
import platform
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import h5py
import numpy as np

from slosh_cli.errors import MOST_SHOWN
from slosh_cli.results.channels import TIME, Channel, channel, is_channel
from slosh_cli.results.files import FileError, replacing
from slosh_cli.results.result import PerWheel, Result, Status, Vector, frame
from slosh_cli.results.steady_file import SteadyFile
from slosh_cli.results.stored import NEEDED, faults_of_attributes, faults_of_columns, faults_of_shape
from slosh_cli.results.validity import plain
from slosh_cli.version import __version__

if TYPE_CHECKING:
    import pandas as pd

    from slosh_cli.scenario import Scenario, TankScenario

FORMAT_VERSION: Final = 1
SCENARIO: Final = "scenario"


@dataclass(frozen=True, eq=False, kw_only=True)
class History:
    """A run read back from its file; time, channels and the named values are those of `Result`.

    attributes: every root attribute of the file, as plain Python values and float64 arrays.
    scenario_text: the scenario as resolved YAML.
    """

    time: Vector = field(repr=False)
    channels: Mapping[str, Vector] = field(repr=False)
    attributes: Mapping[str, Any]
    scenario_text: str = field(repr=False)

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return str(self.attributes["name"])

    @property
    def status(self) -> Status:
        """How the run ended."""
        return Status(self.attributes["status"])

    @property
    def reason(self) -> str:
        """Why the run did not stop; empty when it did."""
        return str(self.attributes["reason"])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the run warned of."""
        return tuple(str(self.attributes["warnings"]).splitlines())

    @property
    def initial_speed_m_s(self) -> float:
        """V0, the speed at t = 0, in m/s."""
        return float(self.attributes["initial_speed_m_s"])

    @property
    def torque_N_m(self) -> float:  # noqa: N802
        """Brake torque per wheel in N m."""
        return float(self.attributes["torque_N_m"])

    @property
    def onset_s(self) -> float:
        """Time at which the brake sets in, in s."""
        return float(self.attributes["onset_s"])

    @property
    def liquid_model(self) -> str:
        """Model of the load: "rigid", "modal", ..."""
        return str(self.attributes["liquid_model"])

    @property
    def surface_limit_m(self) -> float:
        """Room above the still surface in m; NaN when the run did not state it."""
        return float(self.attributes["surface_limit_m"])

    @property
    def braking_distance_m(self) -> float | None:
        """Distance from the onset to the stop speed in m; None when the wagon did not stop."""
        distance = float(self.attributes["braking_distance_m"])
        return None if np.isnan(distance) else distance

    @property
    def static_wheel_load_N(self) -> PerWheel:  # noqa: N802
        """Wheel loads of the wagon at rest in N."""
        first, second, third, fourth = (float(load) for load in self.attributes["static_wheel_load_N"])
        return first, second, third, fourth

    def to_frame(self) -> "pd.DataFrame":
        """The history as a DataFrame: index `time` in s, one column per channel, all in SI units."""
        return frame(self.time, self.channels)


def write_history(result: Result, path: Path) -> None:
    """Write the history of a run, its scenario, its summary and its circumstances to the HDF5 file `path`.

    The file at `path` is replaced only when the new one is whole. Raises FileError when it cannot be written.
    """
    from slosh_cli.scenario import scenario_to_yaml

    with _writing(path) as file:
        time = _write_channel(file, TIME, result.time)
        time.make_scale(TIME.name)
        for name, values in result.channels.items():
            _write_channel(file, channel(name), values).dims[0].attach_scale(time)
        file.create_dataset(SCENARIO, data=scenario_to_yaml(result.scenario), dtype=h5py.string_dtype())
        for key, value in _attributes(result).items():
            file.attrs[key] = value


def write_excitation(
    scenario: "Scenario | TankScenario",
    time: Vector,
    channels: Mapping[Channel, Vector],
    facts: Mapping[str, Any],
    path: Path,
) -> None:
    """Write the history of a tank alone: `channels` at `time` (s), the scenario, `facts` as root attributes.

    The file at `path` is replaced only when the new one is whole. Raises FileError when it cannot be written.
    """
    from slosh_cli.scenario import scenario_to_yaml

    with _writing(path) as file:
        axis = _write_channel(file, TIME, time)
        axis.make_scale(TIME.name)
        for info, values in channels.items():
            _write_channel(file, info, values).dims[0].attach_scale(axis)
        file.create_dataset(SCENARIO, data=scenario_to_yaml(scenario), dtype=h5py.string_dtype())
        for key, value in {"excitation_format_version": FORMAT_VERSION, **_circumstances(), **facts}.items():
            file.attrs[key] = value


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
    known = [name for name in file if name == TIME.name or is_channel(name)]
    missing = [name for name in (TIME.name, *sorted(NEEDED)) if name not in known]
    lacks = [f"it lacks the channels {', '.join(missing)}"] if missing else []
    _refuse(path, [*lacks, *(fault for name in known for fault in faults_of_shape(name, file.get(name)))])
    return {name: np.asarray(file[name][:], dtype=np.float64) for name in known}


def _text(path: Path, file: h5py.File) -> str:
    """The scenario of the run as resolved YAML."""
    text = file[SCENARIO][()] if isinstance(file.get(SCENARIO), h5py.Dataset) else None
    if not isinstance(text, bytes):
        _refuse(path, [f"it lacks the text {SCENARIO}"])
    return str(text, "utf-8") if isinstance(text, bytes) else ""


def _refuse(path: Path, faults: Iterable[str]) -> None:
    """Raise FileError with all faults of a history, where there are any."""
    found = list(faults)
    if found:
        listed = "; ".join(found[:MOST_SHOWN]) + (f"; and {len(found) - MOST_SHOWN} more" * (len(found) > MOST_SHOWN))
        raise FileError(f"cannot read {path} as a slosh history: {listed}; run the scenario again", where=str(path))


@contextmanager
def _writing(path: Path) -> Iterator[h5py.File]:
    """An empty HDF5 file that replaces `path` when the block ends well and all of it is on the disk.

    HDF5 does not survive a disk that is full, or ends the process with it; so it never gets to know.
    """
    with replacing(path) as temporary, temporary.open("xb+") as target:
        steady = SteadyFile(target)
        with h5py.File(steady, "w") as file:
            yield file
        if steady.trouble is not None:
            raise steady.trouble


def is_of(path: Path, scenario: "Scenario | TankScenario", settings: str = "") -> bool:
    """Whether the file at `path` is the history of this scenario under these settings; descriptions do not count."""
    from slosh_cli.scenario import scenario_to_yaml

    try:
        with h5py.File(path, "r") as file:
            text = file[SCENARIO][()].decode("utf-8")
            found = str(file.attrs.get("settings", ""))
    except Exception:  # whatever it is, it is no history of ours
        return False
    return found == settings and _without_words(text) == _without_words(scenario_to_yaml(scenario))


def _without_words(text: str) -> str:
    return re.sub(r"^(name|description):.*\n(?:[ \t].*\n|\n)*", "", text, flags=re.MULTILINE)


def _write_channel(file: h5py.File, info: Channel, values: Vector) -> h5py.Dataset:
    dataset = file.create_dataset(info.name, data=values, dtype="<f8")
    dataset.attrs["units"] = info.unit
    dataset.attrs["long_name"] = info.long_name
    return dataset


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


def _attributes(result: Result) -> dict[str, Any]:
    """Root attributes: circumstances, summary, ledger. None becomes NaN, several warnings become lines."""
    circumstances = {"format_version": FORMAT_VERSION, **_circumstances()}
    summary = result.summary() | {
        "reason": result.reason,
        "warnings": "\n".join(" ".join(warning.split()) for warning in result.warnings),
        "checks": json.dumps(plain(result.checks)),
        "recommendation": result.recommendation.sentence if result.recommendation else "",
        "onset_s": result.onset_s,
        "static_wheel_load_N": list(result.static_wheel_load_N),
        "mean_total_wheel_load_N": result.mean_total_wheel_load_N,
        "weight_N": result.weight_N,
    }
    ledger = {f"energy_{name.removeprefix('energy_')}_J": float(joule) for name, joule in result.energy.items()}
    work = {f"work_{name}": int(count) for name, count in result.work.items()}
    every = circumstances | summary | ledger | work
    return {key: np.nan if value is None else value for key, value in every.items()}


def _check_format(path: Path, attributes: Mapping[str, Any]) -> None:
    found = attributes.get("format_version")
    if attributes.get("program") != "slosh" or found is None:
        raise FileError(f"{path} is an HDF5 file, but not the history of a slosh run", where=str(path))
    if found != FORMAT_VERSION:
        raise FileError(
            f"{path} has history format {found}, but this version of slosh reads format {FORMAT_VERSION}; "
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
    if not path.exists():
        raise FileError(f"{path} does not exist", where=str(path))
    if path.is_dir():
        raise FileError(f"{path} is a folder; give the history file in it, say {path / 'run.h5'}", where=str(path))
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError, MemoryError) as error:
        raise FileError(f"cannot read {path} as a slosh history (HDF5): {error}", where=str(path)) from error
