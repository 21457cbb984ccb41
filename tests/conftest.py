"""Shared by the tests that need whole stops: each is computed once in a session."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario, load_scenario

SCENARIOS = Path(__file__).parents[1] / "scenarios"


@pytest.fixture(scope="session")
def shipped() -> Callable[..., Scenario]:
    """`shipped("paper_80", "braking.torque=12 kN m", ...)`: a scenario of the project with some values replaced."""

    def load(name: str, *overrides: str) -> Scenario:
        return load_scenario(SCENARIOS / f"{name}.yaml", overrides)

    return load


@pytest.fixture(scope="session")
def stop(shipped: Callable[..., Scenario]) -> Callable[..., Result]:
    """`stop("paper_80", "braking.torque=12 kN m", ...)`: the result of that stop, computed once."""

    @cache
    def run(name: str, *overrides: str) -> Result:
        from slosh_cli.results.simulate import simulate  # numba: not before a test needs it

        return simulate(shipped(name, *overrides))

    return run
