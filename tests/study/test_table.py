"""The table of a study: columns, order, ratios, whole files."""

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from slosh_cli.results.files import FileError
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.plan import Study
from slosh_cli.study.table import columns, rows, write_study_table


def answers(study: Study, index: int) -> dict[str, Any]:
    conditions = study.conditions(index)
    solid = conditions["liquid"] == "rigid"
    return conditions | {"status": "stopped", "reason": "", "braking_distance_m": 100.0 if solid else 115.0}


STUDY = build(Wishes(speeds="80,160", torques="5,10", vary=["wagon.pivot_spacing=10,12 m", "contact.adhesion=dry,wet"]))


def test_the_first_columns_are_those_of_the_contract_and_units_are_in_the_names() -> None:
    names = columns(STUDY)
    assert names[:6] == ["v0_km_h", "torque_kN_m", "liquid", "braking_distance_m", "braking_time_s", "status"]
    assert names[6:8] == ["wagon.pivot_spacing_m", "contact.adhesion"]
    assert {"ratio_to_solid", "liquid_in_range", "min_wheel_load_4_N", "reason", "warnings"} <= set(names)
    assert len(set(names)) == len(names)
    assert "history" not in names
    assert columns(build(Wishes(histories=True)))[-1] == "history"


def test_pandas_reads_the_table_as_it_is(tmp_path: Path) -> None:
    found = rows(STUDY, lambda index: answers(STUDY, index))
    assert write_study_table(columns(STUDY), found, tmp_path / "t.csv") == 32
    table = pd.read_csv(tmp_path / "t.csv")
    assert list(table.columns) == columns(STUDY)
    assert list(table["v0_km_h"].unique()) == [80.0, 160.0]
    assert list(table["contact.adhesion"].unique()) == ["dry", "wet"]
    assert table["wagon.pivot_spacing_m"].tolist() == [10.0] * 16 + [12.0] * 16
    assert table["ratio_to_solid"].dropna().tolist() == [1.15] * 16
    assert table.loc[table["liquid"] == "rigid", "ratio_to_solid"].isna().all()


def test_numbers_are_written_in_full(tmp_path: Path) -> None:
    study = build(Wishes(speeds="80", torques="5", liquids="rigid"))
    given = study.conditions(0) | {"status": "stopped", "braking_distance_m": 0.1 + 0.2}
    write_study_table(columns(study), rows(study, lambda _: given), tmp_path / "t.csv")
    assert "0.30000000000000004" in (tmp_path / "t.csv").read_text()


def test_a_stop_that_has_not_run_has_no_row_and_without_a_solid_there_is_no_ratio() -> None:
    def some(index: int) -> dict[str, Any] | None:
        return None if index % 2 else answers(STUDY, index)

    found = list(rows(STUDY, some))
    assert len(found) == 16
    assert all(row["ratio_to_solid"] is None for row in found)


@pytest.mark.parametrize("failing", ["modal", "rigid"])
def test_without_both_distances_there_is_no_ratio(failing: str) -> None:
    def answer(index: int) -> dict[str, Any]:
        row = answers(STUDY, index)
        return row | ({"braking_distance_m": None, "status": "pitch-limit"} if row["liquid"] == failing else {})

    assert all(row["ratio_to_solid"] is None for row in rows(STUDY, answer))


def test_the_table_is_replaced_only_when_the_new_one_is_whole(tmp_path: Path) -> None:
    file = tmp_path / "t.csv"
    file.write_text("the earlier one")

    def breaks(index: int) -> dict[str, Any]:
        if index == 20:
            raise OSError(28, "No space left on device")
        return answers(STUDY, index)

    with pytest.raises(FileError, match="No space left on device"):
        write_study_table(columns(STUDY), rows(STUDY, breaks), file)
    assert file.read_text() == "the earlier one"
    assert list(tmp_path.iterdir()) == [file]
