"""Tables: units in the column names, readable as they are."""

import csv
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from slosh_cli.results.answers import Shown
from slosh_cli.results.files import FileError
from slosh_cli.results.result import Result
from slosh_cli.results.tables import write_rows, write_table


def test_the_first_columns_are_those_of_the_contract(result: Result) -> None:
    assert list(result.row(Shown.SUMMARY))[:7] == [
        "name", "v0_km_h", "torque_kN_m", "liquid", "braking_distance_m", "braking_time_s", "status",
    ]  # fmt: skip


def test_pandas_reads_back_what_was_written(result: Result, tmp_path: Path) -> None:
    write_table([result.row(Shown.SUMMARY)], tmp_path / "summary.csv")
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
    write_table([unfinished.row(Shown.SUMMARY)], tmp_path / "summary.csv")
    row = pd.read_csv(tmp_path / "summary.csv").iloc[0]
    assert pd.isna(row["braking_distance_m"])
    assert row["status"] == "time-limit"
    assert row["reason"] == unfinished.reason


def test_awkward_text_survives(result: Result, tmp_path: Path) -> None:
    awkward = replace(result, warnings=('a "roof", passed', "über"))
    write_table([awkward.row(Shown.SUMMARY)], tmp_path / "summary.csv")
    assert pd.read_csv(tmp_path / "summary.csv")["warnings"][0] == 'a "roof", passed; über'


def test_one_row_per_stop(result: Result, unfinished: Result, tmp_path: Path) -> None:
    write_table([result.row(Shown.SUMMARY), unfinished.row(Shown.SUMMARY)], tmp_path / "table.csv")
    assert list(pd.read_csv(tmp_path / "table.csv")["status"]) == ["stopped", "time-limit"]


def test_a_table_that_cannot_be_written_whole_leaves_the_old_one(result: Result, tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("old")
    with pytest.raises(ValueError, match="fieldnames"):
        write_table([result.row(Shown.SUMMARY), {"other": 1}], path)
    with pytest.raises(ValueError, match="at least one row"):
        write_table([], path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_in_the_way_is_the_users_matter(result: Result, tmp_path: Path) -> None:
    (tmp_path / "summary.csv").mkdir()
    with pytest.raises(FileError, match=r"cannot write .*summary\.csv"):
        write_table([result.row(Shown.SUMMARY)], tmp_path / "summary.csv")


FORMULAS = [
    "=1+1",
    "=HYPERLINK(1)",
    "+1+1",
    "-1+1",
    "@SUM(1)",
    "\t=1",
    "\r=1",
    "\n=1",
    " =1",
    "＝1",
    "-5 kg",
    "-",
    '="a"',
]


@pytest.mark.parametrize("text", FORMULAS)
def test_a_spreadsheet_finds_no_formula(result: Result, tmp_path: Path, text: str) -> None:
    write_rows([text, "b"], [{text: text, "b": 1.0}], tmp_path / "t.csv")
    with (tmp_path / "t.csv").open(encoding="utf-8", newline="") as file:
        cells = [row[0] for row in csv.reader(file)]
    kept = "'" + text.replace("\r", "\n")
    assert cells == [kept] * 2
    write_table([replace(result, reason=text).row(Shown.SUMMARY)], tmp_path / "summary.csv")
    assert pd.read_csv(tmp_path / "summary.csv")["reason"][0] == kept


@pytest.mark.parametrize("text", ["a\rb", "a\r\nb", "a\nb", "a\r", '"\r,'])
def test_a_line_end_in_a_text_ends_no_row(text: str, tmp_path: Path) -> None:
    write_rows(["a", "b"], [{"a": text, "b": 1.0}] * 2, tmp_path / "t.csv")
    table = pd.read_csv(tmp_path / "t.csv")
    assert list(table["b"]) == [1.0, 1.0]
    assert list(table["a"]) == [text.replace("\r\n", "\n").replace("\r", "\n")] * 2


def test_numbers_and_other_text_stay_as_they_are(tmp_path: Path) -> None:
    values = [-1.5, 2, -0.0, float("-inf"), "-1.5", "+2", "-1e-3", "a=b", "'x", "", None, True]
    write_rows(["a"], [{"a": value} for value in values], tmp_path / "t.csv")
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert lines == ["a", "-1.5", "2", "-0.0", "-inf", "-1.5", "+2", "-1e-3", "a=b", "'x", '""', '""', "True"]


def test_text_that_utf8_cannot_hold_costs_no_table(tmp_path: Path) -> None:
    assert write_rows(["a"], [{"a": "x\ud800"}], tmp_path / "t.csv") == 1
    assert (tmp_path / "t.csv").read_text(encoding="utf-8") == "a\nx\\ud800\n"
