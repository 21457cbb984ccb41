"""Every malformed scenario through the command line: exit code 2, the right line, no traceback."""

import json
from pathlib import Path

import pytest
from malformed import CASES, Case
from stand_ins import Slosh

from slosh_cli.cli.exit_codes import ExitCode


def arguments(case: Case, folder: Path) -> list[str]:
    # `check` takes a tank alone for what it is; only a stop asks for more.
    command = "run" if case.name == "a tank alone where a stop is asked for" else "check"
    overrides = [word for text in case.overrides for word in ("--set", text)]
    return [command, str(case.write(folder)), *overrides]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_refused_with_line_and_key_and_no_traceback(case: Case, slosh: Slosh, tmp_path: Path) -> None:
    outcome = slosh(*arguments(case, tmp_path))
    assert outcome.code == ExitCode.BAD_INPUT
    assert outcome.out == ""
    assert "Traceback" not in outcome.err
    lines = outcome.err.splitlines()
    assert len(lines) == len(case.expected)
    for line, problem in zip(lines, case.expected, strict=True):
        file = f"{tmp_path / 'broken.yaml'}"
        place = problem.override or (f"{file}:{problem.line}" if problem.line else file)
        assert line.startswith(f"{place}: ")
        assert problem.key in line


@pytest.mark.parametrize("case", CASES[::5], ids=lambda case: case.name)
def test_with_json_the_same_refusal_is_one_object(case: Case, slosh: Slosh, tmp_path: Path) -> None:
    outcome = slosh(*arguments(case, tmp_path), "--json")
    assert outcome.code == ExitCode.BAD_INPUT
    error = json.loads(outcome.out)["error"]
    assert error["code"] == "scenario"
    assert error["message"] == outcome.err.rstrip("\n")
    assert error["message"].startswith(error["where"])
