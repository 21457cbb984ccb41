"""Runs to write, read, and tabulate."""

from pathlib import Path

import pytest
from plausible import plausible_run, unfinished_run

from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario, load_scenario

PAPER = Path(__file__).parents[2] / "scenarios" / "paper_80.yaml"


@pytest.fixture(scope="session")
def scenario() -> Scenario:
    return load_scenario(PAPER)


@pytest.fixture(scope="session")
def result(scenario: Scenario) -> Result:
    return plausible_run(scenario)


@pytest.fixture(scope="session")
def unfinished(scenario: Scenario) -> Result:
    return unfinished_run(scenario)
