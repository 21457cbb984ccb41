"""Runs to draw."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "results"))  # for plausible.py

from plausible import plausible_run

from slosh_cli.results.result import Result
from slosh_cli.scenario import load_scenario

PAPER = Path(__file__).parents[2] / "scenarios" / "paper_80.yaml"


@pytest.fixture(scope="session")
def liquid() -> Result:
    return plausible_run(load_scenario(PAPER), locking=True)


@pytest.fixture(scope="session")
def solid() -> Result:
    return plausible_run(load_scenario(PAPER, ["tank.liquid.model=rigid"]))
