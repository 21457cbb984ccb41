"""Stops that several cases look at; each is computed once."""

from __future__ import annotations

from functools import lru_cache

from slosh_cli.results import simulate as simulation
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario, find_packaged, load_any_scenario, load_scenario, packaged_scenarios


def scenario(name: str, *overrides: str) -> Scenario:
    """A packaged scenario with some values replaced (``key.path=VALUE``)."""
    return load_scenario(find_packaged(name), overrides)


def runnable() -> tuple[str, ...]:
    """Names of the packaged scenarios that describe a whole stop."""
    return tuple(name for name, path in packaged_scenarios().items() if isinstance(load_any_scenario(path), Scenario))


@lru_cache(maxsize=128)
def stop(name: str, *overrides: str) -> Result:
    """The result of a packaged scenario with some values replaced."""
    return simulation.simulate(scenario(name, *overrides))


def distance(result: Result) -> float:
    """Braking distance in m; not a number for a stop without an answer."""
    return float("nan") if result.braking_distance_m is None else result.braking_distance_m
