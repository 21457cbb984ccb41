"""The history file: read back the same, by this program and by others; never half written."""

import pickle
import random
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from slosh_cli import __version__, load_scenario
from slosh_cli.results import hdf5
from slosh_cli.results.channels import channel
from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import read_history, write_history
from slosh_cli.results.result import Result, Status
from slosh_cli.results.stored import NEEDED, History


@pytest.fixture
def file(result: Result, tmp_path: Path) -> Path:
    path = tmp_path / "run.h5"
    write_history(result, path)
    return path


def test_what_was_written_is_read_back(result: Result, file: Path) -> None:
    history = read_history(file)
    np.testing.assert_array_equal(history.time, result.time)
    assert set(history.channels) == set(result.channels)
    for name, values in result.channels.items():
        np.testing.assert_array_equal(history.channels[name], values, err_msg=name)
    for name in (
        "name", "status", "reason", "warnings", "initial_speed_m_s", "torque_N_m", "onset_s", "liquid_model",
        "surface_limit_m", "braking_distance_m", "static_wheel_load_N",
    ):  # fmt: skip
        assert getattr(history, name) == getattr(result, name), name


def test_a_run_without_an_answer_is_read_back_as_such(unfinished: Result, tmp_path: Path) -> None:
    write_history(unfinished, tmp_path / "run.h5")
    history = read_history(tmp_path / "run.h5")
    assert history.braking_distance_m is None
    assert history.status == "time-limit"
    assert history.reason == unfinished.reason


def test_a_history_of_an_earlier_version_is_read_with_the_names_of_today(result: Result, tmp_path: Path) -> None:
    write_history(result, tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5", "r+") as plain:
        plain.attrs["status"] = "overturned"
    assert read_history(tmp_path / "run.h5").status is Status.PITCH_LIMIT


def test_several_warnings_stay_several(result: Result, tmp_path: Path) -> None:
    write_history(replace(result, warnings=("one\nin two lines", "another")), tmp_path / "run.h5")
    assert read_history(tmp_path / "run.h5").warnings == ("one in two lines", "another")


def test_plain_h5py_finds_channels_with_units(result: Result, file: Path) -> None:
    with h5py.File(file, "r") as plain:
        surface = {"surface_profile", "surface_profile_time", "surface_profile_place"}
        assert set(plain) == {"time", "scenario", *surface, *result.channels}
        for name in result.channels:
            dataset = plain[name]
            assert dataset.dtype == np.dtype("<f8")
            assert dataset.shape == result.time.shape
            assert dataset.attrs["units"] == channel(name).unit
            assert dataset.attrs["long_name"] == channel(name).long_name
            assert dataset.dims[0][0] == plain["time"]
        assert plain["time"].attrs["NAME"] == b"time"
        assert plain["time"].attrs["units"] == "s"


def test_the_scenario_in_the_file_is_the_scenario_of_the_run(result: Result, file: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.yaml"
    again.write_text(read_history(file).scenario_text, encoding="utf-8")
    assert load_scenario(again) == result.scenario


def test_root_attributes_tell_the_circumstances(result: Result, file: Path) -> None:
    with h5py.File(file, "r") as plain:
        found: dict[str, Any] = dict(plain.attrs)
    assert found["format_version"] == 1
    assert found["program_version"] == __version__
    assert found["status"] == "stopped"
    assert abs(datetime.fromisoformat(found["created"]) - datetime.now(UTC)) < timedelta(minutes=5)
    assert {"python_version", "numpy_version", "numba_version", "platform"} <= set(found)
    assert found["energy_brake_J"] == result.energy["brake"]
    assert found["energy_residual"] == result.energy_residual
    assert found["work_events"] == 3
    assert found["steps"] == result.steps
    np.testing.assert_array_equal(found["min_wheel_load_N"], result.min_wheel_load_N)


def test_summary_values_are_in_the_file(result: Result, file: Path) -> None:
    found = read_history(file).attributes
    for key, value in result.summary().items():
        if key != "warnings":
            np.testing.assert_array_equal(found[key], np.nan if value is None else value, err_msg=key)


def test_a_history_survives_pickling(file: Path) -> None:
    history = read_history(file)
    assert pickle.loads(pickle.dumps(history)).attributes["created"] == history.attributes["created"]


def test_frame_of_a_history(result: Result, file: Path) -> None:
    frame = read_history(file).to_frame()
    np.testing.assert_array_equal(frame["car_pitch"].to_numpy(), result.channels["car_pitch"])
    np.testing.assert_array_equal(frame.index.to_numpy(), result.time)


def test_a_writer_that_fails_midway_leaves_the_old_file(
    result: Result, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = file.read_bytes()

    def fail(_: str) -> None:
        raise RuntimeError("halfway")

    monkeypatch.setattr(hdf5, "channel", fail)
    with pytest.raises(RuntimeError, match="halfway"):
        write_history(result, file)
    assert file.read_bytes() == before
    assert list(file.parent.iterdir()) == [file]


def _edit(change: Callable[[h5py.File], None]) -> Callable[[Path], None]:
    def spoil(path: Path) -> None:
        with h5py.File(path, "r+") as file:
            change(file)

    return spoil


def _replace_speed(file: h5py.File) -> None:
    del file["speed"]
    file["speed"] = np.zeros(3)


def _put(name: str, value: object) -> Callable[[Path], None]:
    """Another dataset in the place of one."""

    def change(file: h5py.File) -> None:
        del file[name]
        file[name] = value

    return _edit(change)


def _call(name: str, value: object) -> Callable[[Path], None]:
    """Another value of an attribute."""

    def change(file: h5py.File) -> None:
        file.attrs[name] = value

    return _edit(change)


def _sparse(file: h5py.File) -> None:
    del file["speed"]
    file.create_dataset("speed", shape=(10**12,), chunks=(1000,), dtype="f8")


SPOILED: dict[str, tuple[Callable[[Path], Any], str]] = {
    "missing": (lambda path: path.unlink(), "does not exist"),
    "empty": (lambda path: path.write_bytes(b""), "cannot read"),
    "text": (lambda path: path.write_text("time,speed\n"), "cannot read"),
    "cut short": (lambda path: path.write_bytes(path.read_bytes()[:5000]), "cannot read"),
    "another program's": (_edit(lambda file: file.attrs.pop("program")), "not the history of a slosh run"),
    "another format": (_edit(lambda file: file.attrs.modify("format_version", 99)), "history format 99"),
    "no scenario": (_edit(lambda file: file.pop("scenario")), "it lacks the text scenario"),
    "a number as scenario": (_put("scenario", 1.5), "it lacks the text scenario"),
    "short channel": (_edit(_replace_speed), "speed is not as long"),
    "two channels gone": (
        _edit(lambda file: [file.pop(name) for name in ("wheel_2_speed", "wheel_1_speed")]),
        "it lacks the channels wheel_1_speed, wheel_2_speed",
    ),
    "time that falls": (_edit(lambda file: file["time"].write_direct(file["time"][:][::-1].copy())), "must not fall"),
    "a trillion rows": (_edit(_sparse), "speed must have from 1 to 10000000 rows"),
    "unknown status": (_call("status", "nonsense"), "status must be one of stopped, .*failed, but is `'nonsense'`"),
    "half a character": (_call("name", np.bytes_(b"a\xff")), "cannot read"),
    "three wheels": (_call("static_wheel_load_N", [1.0, 2.0, 3.0]), "static_wheel_load_N must be 4 finite numbers"),
    "no onset": (_call("onset_s", float("nan")), "onset_s must be a finite number"),
    "onset before all time": (_call("onset_s", -1e300), "onset_s must be a finite number"),
}


@pytest.mark.parametrize(("spoil", "message"), SPOILED.values(), ids=SPOILED)
def test_a_bad_file_is_refused_in_clear_words(file: Path, spoil: Callable[[Path], Any], message: str) -> None:
    spoil(file)
    with pytest.raises(FileError, match=message) as refusal:
        read_history(file)
    assert refusal.value.where == str(file)
    assert str(file) in str(refusal.value)


@pytest.mark.parametrize("name", ["time", *sorted(NEEDED)])
@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda name: _edit(lambda file: file.pop(name)), "it lacks the channels {}"),
        (lambda name: _put(name, "text"), "its {} must be a column of numbers"),
        (lambda name: _put(name, np.zeros((3, 2))), "its {} must be a column of numbers"),
        (lambda name: _put(name, np.array([b"1.0"] * 3)), "its {} must be a column of numbers"),
        (lambda name: _put(name, np.zeros(3, complex)), "its {} must be a column of numbers"),
        (lambda name: _put(name, np.zeros(0)), "its {} must have from 1"),
        (lambda name: _put(name, np.full(3, np.nan)), "{} must be finite|{} is not as long"),
    ],
    ids=["gone", "text", "plane", "texts", "complex", "empty", "nan"],
)  # fmt: skip
def test_every_channel_that_is_needed_is_checked(
    file: Path, name: str, spoil: Callable[[str], Callable[[Path], None]], message: str
) -> None:
    spoil(name)(file)
    with pytest.raises(FileError, match=message.format(name, name)) as refusal:
        read_history(file)
    assert str(refusal.value).startswith(f"cannot read {file} as a slosh history: it")


HELD = [one.name for one in History.table() if one.needed]


@pytest.mark.parametrize("name", HELD)
@pytest.mark.parametrize("value", [None, "nonsense", [1.0, 2.0], ["a", "b"], float("inf"), True])
def test_every_attribute_that_is_needed_is_checked(file: Path, name: str, value: object) -> None:
    if value == "nonsense" and name in ("name", "reason", "warnings", "liquid_model"):
        return
    (_edit(lambda h5: h5.attrs.pop(name)) if value is None else _call(name, value))(file)
    with pytest.raises(FileError, match=name):
        read_history(file)


def test_a_file_with_any_bytes_changed_or_cut_is_read_or_refused(file: Path) -> None:
    whole, chance = file.read_bytes(), random.Random(1)
    for trial in range(150):
        spoilt = bytearray(whole[: chance.randrange(len(whole))] if trial % 3 == 0 else whole)
        for _ in range(chance.choice([0, 1, 3, 20])):
            spoilt[chance.randrange(min(len(spoilt), 30_000))] = chance.randrange(256)
        file.write_bytes(spoilt)
        with suppress(FileError):
            read_history(file)


def test_a_channel_that_is_not_finite_is_named(file: Path) -> None:
    with h5py.File(file, "r+") as h5:
        h5["wheel_3_normal_force"][5] = np.nan
    with pytest.raises(FileError, match="its channel wheel_3_normal_force must be finite"):
        read_history(file)


def test_what_else_is_in_the_file_is_left_alone(result: Result, file: Path) -> None:
    with h5py.File(file, "r+") as h5:
        h5["remark"] = "mine"
        h5.create_group("more")["speed"] = [1.0]
        h5["own_column"] = np.zeros(3)
    assert set(read_history(file).channels) == set(result.channels)


def test_a_folder_is_refused_with_a_hint(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"is a folder; give the history file in it, say .*run\.h5"):
        read_history(tmp_path)


def test_a_path_that_cannot_be_written_is_the_users_matter(result: Result, tmp_path: Path) -> None:
    (tmp_path / "run.h5").mkdir()
    with pytest.raises(FileError, match="cannot write"):
        write_history(result, tmp_path / "run.h5")


LIMITS = """
import resource, sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from plausible import plausible_run
from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import write_history
from slosh_cli.scenario import load_scenario

folder = Path(sys.argv[3])
run = plausible_run(load_scenario(sys.argv[2]))
write_history(run, folder / "whole.h5")
whole = (folder / "whole.h5").stat().st_size
hard = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
for limit in (0, 1, 100, 2048, *(k * whole // 16 for k in range(1, 16)), whole - 1):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, hard))
    try:
        write_history(run, folder / "run.h5")
    except FileError as error:
        assert "File too large" in str(error), error
    else:
        raise AssertionError(limit)
    assert [file.name for file in folder.iterdir()] == ["whole.h5"], limit
resource.setrlimit(resource.RLIMIT_FSIZE, (whole, hard))
write_history(run, folder / "run.h5")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
def test_a_full_disk_is_a_refusal_wherever_it_comes(tmp_path: Path) -> None:
    """HDF5 itself ends the process with a segmentation fault, at once or when Python ends."""
    root = Path(__file__).parents[2]
    words = [str(Path(__file__).parent), str(root / "scenarios" / "paper_80.yaml"), str(tmp_path)]
    run = subprocess.run([sys.executable, "-c", LIMITS, *words], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    one, other = read_history(tmp_path / "run.h5"), read_history(tmp_path / "whole.h5")
    assert one.scenario_text == other.scenario_text
    for name, values in one.channels.items():
        np.testing.assert_array_equal(values, other.channels[name])
