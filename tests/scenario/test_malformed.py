"""Every malformed scenario is refused with everything that is wrong with it, each at its place."""

import pickle
import re
from pathlib import Path

import pytest
from malformed import CASES, Case
from malformed_case import BASE

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import load_any_scenario, load_scenario


def refusal(case: Case, folder: Path) -> ScenarioError:
    with pytest.raises(ScenarioError) as caught:
        load_scenario(case.write(folder), case.overrides)
    return caught.value


def test_the_text_that_the_cases_break_is_sound(tmp_path: Path) -> None:
    path = tmp_path / "sound.yaml"
    path.write_text(BASE, encoding="utf-8")
    assert load_scenario(path).name == "example"


def test_there_are_enough_cases_with_names_of_their_own() -> None:
    assert len(CASES) >= 60
    assert len({case.name for case in CASES}) == len(CASES)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_refused_with_place_rule_given_and_remedy(case: Case, tmp_path: Path) -> None:
    error = refusal(case, tmp_path)
    found = [(problem.line, problem.key, problem.override) for problem in error.problems]
    assert found == [(entry.line, entry.key, entry.override) for entry in case.expected]
    for problem, entry in zip(error.problems, case.expected, strict=True):
        assert entry.rule in problem.rule
        assert entry.given in problem.given
        assert entry.fix in problem.fix


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_message_has_one_line_for_each_problem_and_survives_pickling(case: Case, tmp_path: Path) -> None:
    error = refusal(case, tmp_path)
    lines = str(error).splitlines()
    assert len(lines) == len(error.problems)
    file = tmp_path / "broken.yaml"
    for line, entry in zip(lines, case.expected, strict=True):
        place = entry.override or (f"{file}:{entry.line}" if entry.line else str(file))
        assert line.startswith(f"{place}: ")
        assert entry.key in line
        assert re.search(r"; given .+; ", line)
    assert error.where == (case.expected[0].override or lines[0].split(": ")[0])
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.where, again.problems, again.code) == (
        str(error),
        error.where,
        error.problems,
        "scenario",
    )


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_refused_as_a_scenario_of_any_kind(case: Case, tmp_path: Path) -> None:
    if case.name == "a tank alone where a stop is asked for":
        assert load_any_scenario(case.write(tmp_path)).name == "alone"
        return
    with pytest.raises(ScenarioError):
        load_any_scenario(case.write(tmp_path), case.overrides)
