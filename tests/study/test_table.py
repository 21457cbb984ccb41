"""The table of a study: columns, order, ratios, whole files."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from slosh_cli.results.files import FileError
from slosh_cli.results.tables import write_rows
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.tree import spot_of
from slosh_cli.study.axis import Axis
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.plan import Study
from slosh_cli.study.table import column_of, columns, rows


def answers(study: Study, index: int) -> dict[str, Any]:
    conditions = study.conditions(index)
    solid = conditions["liquid"] == "rigid"
    return conditions | {"status": "stopped", "reason": "", "braking_distance_m": 100.0 if solid else 115.0}


STUDY = build(Wishes(speeds="80,160", torques="5,10", vary=["wagon.pivot_spacing=10,12 m", "contact.adhesion=dry,wet"]))


def test_the_first_columns_are_those_of_the_contract_and_units_are_in_the_names() -> None:
    names = columns(STUDY)
    assert names[:6] == ["v0_km_h", "torque_kN_m", "liquid", "braking_distance_m", "braking_time_s", "status"]
    assert names[6:8] == ["wagon_pivot_spacing_m", "contact_adhesion"]
    assert {"ratio_to_solid", "liquid_in_range", "min_wheel_load_4_N", "reason", "warnings"} <= set(names)
    assert len(set(names)) == len(names)
    assert "history" not in names
    assert columns(build(Wishes(histories=True)))[-1] == "history"


def key_paths(model: type[Part], prefix: str = "") -> Iterator[str]:
    """Every key path that a study can vary, items of lists and all branches of a union included."""
    for name in model.model_fields:
        yield prefix + name
        spot = spot_of(model, name)
        inside = [spot, *(spot.branches or {}).values()]
        for part in (found.part for found in inside if found.part):
            yield from key_paths(part, f"{prefix}{name}.")
        for part in (found.items.part for found in inside if found.items and found.items.part):
            yield from key_paths(part, f"{prefix}{name}.0.")


def test_every_column_is_an_attribute_and_no_two_are_the_same() -> None:
    keys = set(key_paths(Scenario))
    assert {
        "tank.radius",
        "tank.points",
        "tank.coefficients.0.mu",
        "contact.adhesion.mu0",
        "tank.baffles.0.opening",
    } <= keys
    names = {key: column_of(Axis(key, ("1",), "")) for key in keys}
    assert len(set(names.values())) == len(keys)
    assert all(name.isidentifier() and name.isascii() for name in names.values())
    assert not set(names.values()) & set(columns(build(Wishes(speeds="80", torques="5"))))


@pytest.mark.parametrize(
    ("unit", "name"),
    [
        ("m", "a_b_m"),
        ("kg/m^3", "a_b_kg_m_3"),
        ("kg·m⁻³", "a_b_kg_m_3"),
        ("kN·m", "a_b_kN_m"),
        ("\u00b5m", "a_b_um"),
        ("\u03bcm", "a_b_um"),
        ("%", "a_b"),
        ("°", "a_b_deg"),
        ("", "a_b"),
    ],
)
def test_the_unit_in_a_columns_name_is_the_unit(unit: str, name: str) -> None:
    assert column_of(Axis("a.b", (f"1 {unit}", f"2 {unit}"), "")) == name


def test_a_columns_name_is_an_attribute_of_the_table(tmp_path: Path) -> None:
    write_rows(columns(STUDY), rows(STUDY, lambda index: answers(STUDY, index)), tmp_path / "t.csv")
    assert pd.read_csv(tmp_path / "t.csv").query("contact_adhesion == 'wet'").wagon_pivot_spacing_m.max() == 12.0


def test_pandas_reads_the_table_as_it_is(tmp_path: Path) -> None:
    found = rows(STUDY, lambda index: answers(STUDY, index))
    assert write_rows(columns(STUDY), found, tmp_path / "t.csv") == 32
    table = pd.read_csv(tmp_path / "t.csv")
    assert list(table.columns) == columns(STUDY)
    assert list(table["v0_km_h"].unique()) == [80.0, 160.0]
    assert list(table["contact_adhesion"].unique()) == ["dry", "wet"]
    assert table["wagon_pivot_spacing_m"].tolist() == [10.0] * 16 + [12.0] * 16
    assert table["ratio_to_solid"].dropna().tolist() == [1.15] * 16
    assert table.loc[table["liquid"] == "rigid", "ratio_to_solid"].isna().all()


def test_numbers_are_written_in_full(tmp_path: Path) -> None:
    study = build(Wishes(speeds="80", torques="5", liquids="rigid"))
    given = study.conditions(0) | {"status": "stopped", "braking_distance_m": 0.1 + 0.2}
    write_rows(columns(study), rows(study, lambda _: given), tmp_path / "t.csv")
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
        write_rows(columns(STUDY), rows(STUDY, breaks), file)
    assert file.read_text() == "the earlier one"
    assert list(tmp_path.iterdir()) == [file]
