"""Studies with a solver that answers at once, and the real command in a process of its own."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "results"))  # for plausible.py
sys.path.insert(0, str(Path(__file__).parents[1] / "study"))  # for study_tools.py

from plausible import plausible_run
from study_tools import PAPER, QuickSolver

import slosh_cli.results.simulate
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario, load_scenario


@pytest.fixture(scope="session")
def paper() -> Scenario:
    return load_scenario(PAPER)


@pytest.fixture(scope="session")
def template(paper: Scenario) -> Result:
    return plausible_run(paper.with_({"braking.initial_speed": "5 km/h"}))


@pytest.fixture
def solver(monkeypatch: pytest.MonkeyPatch, template: Result) -> QuickSolver:
    quick = QuickSolver(template)
    monkeypatch.setattr(slosh_cli.results.simulate, "simulate", quick.simulate)
    return quick
