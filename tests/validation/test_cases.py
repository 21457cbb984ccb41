"""The cases themselves: complete data files, honest rows, and every quick one within its tolerance."""

import math
from importlib.resources import files

import numpy as np
import pytest

from slosh_cli.errors import UsageError
from slosh_cli.validation import registry
from slosh_cli.validation.case import Findings, run_case
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import data_rows, read_case

QUICK = [name for name in registry.NAMES if read_case(name).quick]
NOT_QUICK = [name for name in registry.NAMES if name not in QUICK]
NOTHING = Chart((Panel("x", "y", (curve("line", [0, 1], [0, 1]),)),))


@pytest.mark.parametrize("name", registry.NAMES)
def test_a_data_file_says_what_why_and_from_where(name):
    data = read_case(name)
    assert data.name == name
    assert data.question.endswith("?")
    assert len(data.method) > 80
    assert len(data.source) > 10
    assert data.tolerances
    assert all(len(entry.reason) > 20 for entry in data.tolerances.values())
    assert data.catches


def test_data_files_and_cases_are_the_same_set():
    folder = files("slosh_cli.validation").joinpath("data")
    assert {entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")} == set(
        registry.NAMES
    )


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in NOT_QUICK)])
def test_a_case_keeps_within_its_tolerances(name):
    data = read_case(name)
    if not registry.is_available(data):
        pytest.skip(f"needs {data.needs}")
    result = registry.case_result(data)
    assert result.passed, [row for row in result.rows if not row.passed]
    assert result.chart is not None
    assert len({row.quantity for row in result.rows}) == len(result.rows)
    for panel in result.chart.panels:
        assert panel.x_label
        assert panel.y_label
        for one in panel.curves:
            assert one.x.shape == one.y.shape
            assert np.isfinite(one.y).any()
    used = {row.tolerance for row in result.rows}
    assert {entry.value for entry in data.tolerances.values()} <= used | {0.0}, "a tolerance that no row uses"


def test_reference_tables_are_the_published_ones():
    table = {row["fill_over_radius"]: row["max_normalised_force"] for row in data_rows("table1.csv")}
    assert table == {"1.0": "1.47", "1.5": "1.29"}
    assert [row["id"] for row in data_rows("claims.csv")][:3] == [
        "fig2-oscillation",
        "fig2-front-bogie",
        "fig2-lead-wheel",
    ]
    assert len(data_rows("transverse_modes.csv")) == 9


def test_deviations_are_relative_absolute_or_limits():
    found = Findings(read_case("kolaei"))
    found.compare("absolute", 1.474, 1.47, "table")
    found.compare("relative", 2.0004, 2.0, "closed_form")
    found.compare("not a number", math.nan, 1.0, "closed_form")
    found.compare("nothing", None, 1.0, "closed_form")
    found.note("remark", 2.0, 1.0)
    found.verdict("word", "holds", "does not hold")
    found.verdict("same word", "holds", "holds")
    deviations = [row.deviation for row in found.rows]
    assert deviations[:2] == [pytest.approx(0.004), pytest.approx(2e-4)]
    assert deviations[2:] == [None, None, 1.0, 1.0, 0.0]
    assert [row.passed for row in found.rows] == [True, False, False, False, True, False, True]


def test_a_limit_is_not_passed_by_what_is_no_number():
    found = Findings(read_case("moving-load"))
    found.limit("small", 1e-6, "shape")
    found.limit("negative", -1.0, "shape")
    found.limit("not a number", math.nan, "shape")
    assert [row.passed for row in found.rows] == [True, False, False]


def test_a_case_that_breaks_down_or_checks_nothing_has_not_passed():
    data = read_case("kolaei")

    def breaks(_):
        raise ZeroDivisionError("by accident")

    broken = run_case(data, breaks)
    assert not broken.passed
    assert broken.rows[0].value == "ZeroDivisionError: by accident"
    assert not run_case(data, lambda _: Findings(data).outcome(NOTHING)).passed


def test_unknown_names_are_refused_with_a_guess():
    with pytest.raises(UsageError, match="write `polach`"):
        registry.chosen(["polack"])
    assert [data.name for data in registry.chosen(["polach", "kolaei", "polach"])] == ["kolaei", "polach"]


def test_a_case_whose_extra_is_missing_is_left_out_or_refused(monkeypatch):
    monkeypatch.setattr(registry, "find_spec", lambda name: None)
    assert [data.name for data in registry.left_out()] == ["second-code"]
    assert "second-code" not in [data.name for data in registry.chosen([])]
    with pytest.raises(UsageError, match=r"needs exudyn, .*pip install 'exudyn>="):
        registry.chosen(["second-code"])
