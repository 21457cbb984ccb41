"""Answers: one line declares one, every output follows from it, and a history answers as its run did."""

import json
import sys
from dataclasses import FrozenInstanceError, fields, replace
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd
import pytest

from slosh_cli.errors import UsageError
from slosh_cli.results.answers import Answers, PerWheel, Place, Shown, Told, computed, derived
from slosh_cli.results.channels import CHANNELS
from slosh_cli.results.hdf5 import read_history, write_history
from slosh_cli.results.result import Record, Result
from slosh_cli.results.tables import write_table
from slosh_cli.results.validity import Check
from slosh_cli.study.table import columns

DOCS = Path(__file__).parents[2] / "docs"
FOUR = (1.0, 2.0, 3.0, 4.0)


class Coupling(Answers):
    """A row of answers that is no run."""

    compression_N: float | None = computed("N", "largest", column="compression_kN", per=1e3)  # noqa: N815
    kind: str = computed("", "words", Place.NAME, shown=~Shown.HISTORY, default_factory=lambda: "screw")
    twice_N: float = derived("N", "twice", shown=Shown.JSON, of=lambda row: 2.0 * row.compression_N)  # noqa: N815

    def __post_init__(self) -> None:
        object.__setattr__(self, "twice_N", 0.0 if self.compression_N is None else self.table()[2].value_in(self))


class Pair(Answers):
    """Answers of parts within answers."""

    couplings: tuple[Coupling, ...] = computed("", "each coupling", shown=Shown.JSON)
    torque_max_N_m: PerWheel = computed("N m", "largest torque", Place.WHEELS)  # noqa: N815
    slip_m_s: PerWheel = computed("m/s", "largest slip", Place.WHEELS)
    share: PerWheel = computed("1", "share of the torque", Place.WHEELS)


def test_any_class_of_answers_has_rows_json_and_attributes() -> None:
    row = Coupling(compression_N=240_500.1)
    assert row.row(Shown.SUMMARY) == {"kind": "screw", "compression_kN": 240.5001}
    assert list(row.row(Shown.SUMMARY)) == ["kind", "compression_kN"]  # the place, not the line
    assert row.as_dict() == {"compression_N": 240_500.1, "kind": "screw", "twice_N": 481_000.2}
    assert row.as_attributes() == {"compression_N": 240_500.1}
    with pytest.raises(FrozenInstanceError):
        row.compression_N = 1.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        Coupling()  # type: ignore[call-arg]


def test_no_number_is_none_in_json_and_nan_in_files() -> None:
    row = Coupling(compression_N=None)
    assert row.as_dict()["compression_N"] is None
    assert np.isnan(row.as_attributes()["compression_N"])


def test_answers_of_parts_are_objects_in_json_and_a_column_has_its_whole_unit() -> None:
    pair = Pair(couplings=(Coupling(compression_N=1.0),), torque_max_N_m=FOUR, slip_m_s=FOUR, share=FOUR)
    assert json.loads(json.dumps(pair.as_dict()))["couplings"][0]["twice_N"] == 2.0
    names = ("torque_max_{}_N_m", "slip_{}_m_s", "share_{}")
    assert list(pair.row(Shown.STUDY)) == [name.format(i) for name in names for i in (1, 2, 3, 4)]


def test_every_answer_of_a_run_is_declared_once_with_unit_and_meaning() -> None:
    table = Result.table()
    assert [one.name for one in Record.table()] == [one.name for one in table][: len(Record.table())]
    assert len({one.name for one in table}) == len(table)
    for one in table:
        assert one.meaning, one.name
        assert one.unit or one.kind not in (int, float, float | None, PerWheel), one.name
        unit = "" if one.unit == "1" else one.unit
        assert one.name.endswith(unit.replace(" ", "_").replace("/", "_")) or one.name == "solve_seconds"
    columns = [name for one in table for name in one.columns]
    assert len(set(columns)) == len(columns)
    assert [one.name for one in table if not one.shown and not one.line] == []


def test_no_two_lines_of_the_terminal_claim_the_same_place() -> None:
    for per_wheel in (False, True):
        at = [one.line.at for one in Result.table() if one.line and (one.kind == PerWheel) == per_wheel]
        assert len(set(at)) == len(at)


class Extended(Result):
    """A run with one more answer: that line is all that any output needs."""

    worst_jerk_m_s3: float = computed("m/s^3", "largest jerk", line=Told(12, "jerk, largest", ".1f", "m/s^3"))


@pytest.fixture
def extended(result: Result) -> Extended:
    given = {one.name: getattr(result, one.name) for one in fields(result) if one.init}
    return Extended(**given, worst_jerk_m_s3=1.25)


def test_one_line_brings_an_answer_into_every_output(
    extended: Extended, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from slosh_cli.cli import summary

    write_table([extended.row(Shown.SUMMARY)], tmp_path / "summary.csv")
    assert pd.read_csv(tmp_path / "summary.csv")["worst_jerk_m_s3"][0] == 1.25
    write_history(extended, tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5") as file:
        assert file.attrs["worst_jerk_m_s3"] == 1.25
    assert extended.summary()["worst_jerk_m_s3"] == 1.25
    assert extended.row(Shown.STUDY)["worst_jerk_m_s3"] == 1.25
    monkeypatch.setattr(summary, "Result", Extended)
    summary.show_run(extended)
    text = capsys.readouterr().out
    assert "jerk, largest                         1.2 m/s^3" in text
    assert text.index("within the range") < text.index("wheel unloading") < text.index("jerk")
    assert text.index("at rest / kN") < text.index("least / kN")


def test_the_columns_of_a_study_are_those_of_its_rows(result: Result) -> None:
    from slosh_cli.study.build import Wishes, build

    found = columns(build(Wishes(speeds="80", torques="5")))
    assert [name for name in found if name != "ratio_to_solid"] == list(result.row(Shown.STUDY))


def test_a_history_has_every_answer_of_its_run(result: Result, tmp_path: Path) -> None:
    checks = (Check("roof", "model", 2.0, 1.0, "over"), Check("load", "operation", np.nan, 0.5, "none"))
    run = replace(result, checks=checks, warnings=("one", "two"), energy_residual=np.inf)
    write_history(run, tmp_path / "run.h5")
    history = read_history(tmp_path / "run.h5")
    for one in Record.table():
        if one.name != "checks":
            assert getattr(history, one.name) == getattr(run, one.name), one.name
    assert history.in_model_range is False
    assert repr([check.as_dict() for check in history.checks]) == repr([check.as_dict() for check in checks])
    assert str(history.as_dict()) == str(run.as_dict())
    assert history.row(Shown.SUMMARY) == run.row(Shown.SUMMARY)


@pytest.fixture
def early(result: Result, tmp_path: Path) -> Path:
    """A file that holds what files of the first version held."""
    write_history(result, tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5", "r+") as file:
        for name in ("checks", "in_model_range", "recommendation"):
            del file.attrs[name]
    return tmp_path / "run.h5"


def test_what_an_early_file_does_not_hold_is_not_made_up(early: Path) -> None:
    history = read_history(early)
    assert history.max_wheel_unloading == max(history.wheel_unloading)
    for name in ("checks", "in_model_range", "liquid_in_range", "not_within"):
        assert not hasattr(history, name)
    assert "in_model_range" not in history.as_dict()
    assert "stopped after" in repr(history)


SPOILT: dict[str, tuple[str, Any, str]] = {
    "a word": ("max_surface_m", "high", "max_surface_m must be a number, but is `'high'`"),
    "two wheels": ("locked_time_s", [0.0, 1.0], "locked_time_s must be 4 numbers"),
    "half a step": ("steps", 0.5, "steps must be a number"),
    "maybe": ("in_model_range", "maybe", "in_model_range must be true or false"),
    "no list": ("checks", "3", "checks must be a list of checks"),
    "no checks": ("checks", '[{"check": "roof"}]', "checks must be a list of checks"),
    "brackets": ("checks", "[" * 50_000, "checks must be a list of checks"),
}


@pytest.mark.parametrize(("name", "value", "message"), SPOILT.values(), ids=SPOILT)
def test_an_answer_of_another_kind_is_refused(
    result: Result, tmp_path: Path, name: str, value: Any, message: str
) -> None:
    from slosh_cli.results.files import FileError

    write_history(result, tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5", "r+") as file:
        file.attrs[name] = value
    with pytest.raises(FileError, match=message):
        read_history(tmp_path / "run.h5")


def test_a_file_whose_wheels_carry_nothing_is_read(result: Result, tmp_path: Path) -> None:
    write_history(result, tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5", "r+") as file:
        file.attrs["static_wheel_load_N"] = [0.0] * 4
    assert not hasattr(read_history(tmp_path / "run.h5"), "wheel_unloading")


def test_a_repr_fits_a_screen_and_names_the_worst(result: Result, unfinished: Result) -> None:
    checks = [Check(f"check {i}", "operation", float(i), 1.0, "") for i in range(9)]
    text = repr(replace(result, checks=tuple(checks)))
    assert len(text.splitlines()) < 15
    assert text.startswith("Result paper-80-liquid: 80 km/h, 5 kN m per wheel, load: modal\n  stopped after ")
    assert text.index("check 8 (8 > 1)") < text.index("check 7") < text.index("and 2 more")
    assert "check 1 " not in text
    assert "time-limit, no braking distance: still at 3.1 m/s" in repr(unfinished)


def test_a_dataset_carries_units_meanings_and_answers(result: Result, tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    found = result.to_xarray()
    assert set(found.data_vars) == set(result.channels)
    np.testing.assert_array_equal(found["speed"].sel(time=result.time[5]), result.channels["speed"][5])
    assert found["speed"].attrs == {"units": "m/s", "long_name": CHANNELS["speed"].long_name}
    assert found["time"].attrs["units"] == "s"
    assert found.attrs["braking_distance_m"] == result.braking_distance_m
    assert type(found.attrs["in_model_range"]) is int  # netCDF knows no true and false
    write_history(result, tmp_path / "run.h5")
    assert read_history(tmp_path / "run.h5").to_xarray().equals(found)


def test_without_xarray_one_is_told_how_to_get_it(result: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(UsageError, match="to_xarray needs xarray; install it with: python -m pip install"):
        result.to_xarray()


def test_the_page_of_answers_is_made_from_their_table() -> None:
    spec = spec_from_file_location("answers_page", DOCS / "answers.py")
    assert spec is not None
    assert spec.loader is not None
    made = module_from_spec(spec)
    spec.loader.exec_module(made)
    assert (DOCS / "answers.md").read_text(encoding="utf-8") == made.page(), "make pages"
