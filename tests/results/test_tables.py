"""Tables: units in the column names, readable as they are."""

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from slosh_cli.results.files import FileError
from slosh_cli.results.result import Result
from slosh_cli.results.tables import summary_row, write_summary, write_table


def test_the_first_columns_are_those_of_the_contract(result: Result) -> None:
    assert list(summary_row(result))[:7] == [
        "name", "v0_km_h", "torque_kN_m", "liquid", "braking_distance_m", "braking_time_s", "status",
    ]  # fmt: skip


def test_pandas_reads_back_what_was_written(result: Result, tmp_path: Path) -> None:
    write_summary(result, tmp_path / "summary.csv")
    table = pd.read_csv(tmp_path / "summary.csv")
    assert len(table) == 1
    row = table.iloc[0]
    assert row["name"] == result.name
    assert row["v0_km_h"] == 80.0
    assert row["torque_kN_m"] == 5.0
    assert row["liquid"] == "modal"
    assert row["braking_distance_m"] == result.braking_distance_m
    assert row["min_wheel_load_3_N"] == result.min_wheel_load_N[2]
    assert row["locked_time_4_s"] == result.locked_time_s[3]
    assert row["steps"] == result.steps
    assert row["status"] == "stopped"


def test_no_answer_is_an_empty_field(unfinished: Result, tmp_path: Path) -> None:
    write_summary(unfinished, tmp_path / "summary.csv")
    row = pd.read_csv(tmp_path / "summary.csv").iloc[0]
    assert pd.isna(row["braking_distance_m"])
    assert row["status"] == "time-limit"
    assert row["reason"] == unfinished.reason


def test_awkward_text_survives(result: Result, tmp_path: Path) -> None:
    awkward = replace(result, warnings=('a "roof", passed', "über"))
    write_summary(awkward, tmp_path / "summary.csv")
    assert pd.read_csv(tmp_path / "summary.csv")["warnings"][0] == 'a "roof", passed; über'


def test_one_row_per_stop(result: Result, unfinished: Result, tmp_path: Path) -> None:
    write_table([summary_row(result), summary_row(unfinished)], tmp_path / "table.csv")
    assert list(pd.read_csv(tmp_path / "table.csv")["status"]) == ["stopped", "time-limit"]


def test_a_table_that_cannot_be_written_whole_leaves_the_old_one(result: Result, tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("old")
    with pytest.raises(ValueError, match="fieldnames"):
        write_table([summary_row(result), {"other": 1}], path)
    with pytest.raises(ValueError, match="at least one row"):
        write_table([], path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_in_the_way_is_the_users_matter(result: Result, tmp_path: Path) -> None:
    (tmp_path / "summary.csv").mkdir()
    with pytest.raises(FileError, match=r"cannot write .*summary\.csv"):
        write_summary(result, tmp_path / "summary.csv")
