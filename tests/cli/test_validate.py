"""`slosh validate`: JSON, table, report, figures, exit codes."""

import json

import pytest

from slosh_cli.cli import main
from slosh_cli.validation import registry
from slosh_cli.validation.case import CaseResult, Row

ROW_KEYS = {"quantity", "value", "reference", "deviation", "tolerance", "source"}


def test_json_report_and_figures(tmp_path, capsys):
    assert main(["validate", "polach", "critical-speed", "--json", "-o", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    answer = json.loads(out)
    assert [case["name"] for case in answer["cases"]] == ["critical-speed", "polach"]
    for case in answer["cases"]:
        assert case["passed"] is True
        assert all(set(row) == ROW_KEYS for row in case["rows"])
    report = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "2 of 2 cases passed." in report
    for case in answer["cases"]:
        assert f"## {case['name']}" in report
        for row in case["rows"]:
            assert row["quantity"].replace("|", "\\|") in report
    assert {"polach.png", "polach.svg", "critical-speed.png", "critical-speed.svg", "report.md"} == {
        file.name for file in tmp_path.iterdir()
    }


def test_table_of_a_named_case_shows_every_row(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["validate", "critical-speed", "-o", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    for word in ("quantity", "ours", "reference", "deviation", "tolerance", "verdict", "521.4237", "accepted"):
        assert word in out
    assert "1 of 1 cases passed." in out


def fell_short(data):
    row = Row("answer [to everything]", 41.0, 42.0, 0.024, 1e-3, "a book", "relative")
    return CaseResult(data, (row,), None, 0.1)


def test_exit_code_1_when_a_case_falls_short(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(registry, "case_result", fell_short)
    assert main(["validate", "polach", "-o", str(tmp_path)]) == 1
    out = capsys.readouterr().out
    assert "answer [to everything]" in out.replace("\n", " ")
    assert "fell short: polach." in out
    assert main(["validate", "polach", "--json", "-o", str(tmp_path)]) == 1
    (case,) = json.loads(capsys.readouterr().out)["cases"]
    assert case["passed"] is False
    assert "fell short" in (tmp_path / "report.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("words", [["polack"], ["kolaei", "figure4"]])
def test_unknown_case(words, capsys):
    assert main(["validate", *words, "--json"]) == 2
    answer = json.loads(capsys.readouterr().out)
    assert answer["error"]["code"] == "usage"
    assert words[-1] in answer["error"]["message"]


def test_list(capsys):
    assert main(["validate", "--list", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert [case["name"] for case in answer["cases"]] + answer["left_out"] == sorted(
        registry.NAMES, key=lambda name: (name in answer["left_out"], registry.NAMES.index(name))
    )
    assert main(["validate", "--list"]) == 0
    assert "kolaei" in capsys.readouterr().out


def test_a_part_of_the_cases_does_not_replace_the_report_of_all(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(registry, "case_result", fell_short)
    folder = tmp_path / "outputs" / "validation"
    assert main(["validate"]) == 1
    report = (folder / "report.md").read_bytes()
    assert main(["validate", "kolaei"]) == 1
    assert main(["validate", "polach", "kolaei"]) == 1
    assert (folder / "report.md").read_bytes() == report
    assert "## kolaei" in (folder / "kolaei" / "report.md").read_text(encoding="utf-8")
    assert (folder / "kolaei+polach" / "report.md").is_file()


def test_the_verdict_is_told_when_the_report_cannot_be_written(tmp_path, capsys, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("slosh_cli.results.files.write_text", full)
    assert main(["validate", "polach", "--json", "-o", str(tmp_path)]) == 2
    out, err = capsys.readouterr()
    answer = json.loads(out)
    assert answer["cases"][0]["passed"] is True
    assert "report" not in answer["files"]
    assert "No space left on device" in answer["warnings"][0]
    assert "report.md could not be written: No space left on device" in err
    assert main(["validate", "polach", "-o", str(tmp_path)]) == 2
    assert "1 of 1 cases passed" in capsys.readouterr().out


def test_a_report_that_cannot_be_written_is_refused_before_the_cases_run(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(registry, "case_result", lambda data: pytest.fail("ran"))
    (tmp_path / "report.md").mkdir()
    assert main(["validate", "polach", "-o", str(tmp_path)]) == 2
    assert "there is a folder of that name" in capsys.readouterr().err
