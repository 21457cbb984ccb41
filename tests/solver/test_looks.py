"""How often a run looks at progress and cancellation: seldom where steps are quick, often where they are not."""

from pathlib import Path
from threading import Event

import pytest

from slosh_cli import load_scenario
from slosh_cli.results.simulate import simulate
from slosh_cli.solver.run import Cancelled

PAPER = Path(__file__).parents[2] / "scenarios" / "paper_80.yaml"
FLOWING = ("tank.liquid.model=shallow-water", "tank.coefficients=computed")


def looks(*overrides: str) -> tuple[int, list[float]]:
    """Steps tried, and the fraction done at every look."""
    fractions: list[float] = []
    result = simulate(load_scenario(PAPER, overrides), progress=lambda done, speed: fractions.append(done))
    return result.steps + result.rejected_steps, fractions


@pytest.mark.parametrize(
    ("overrides", "fewest", "most"),
    [
        ((), 300, 1000),
        (("track.domain.element_length=0.0625 m",), 50, 200),
        (FLOWING, 20, 150),
    ],
    ids=["100 elements", "800 elements", "cells"],
)
def test_slow_steps_are_looked_at_more_often(overrides: tuple[str, ...], fewest: int, most: int) -> None:
    tries, fractions = looks(*overrides)
    assert fewest <= tries / len(fractions) <= most
    assert fractions == sorted(fractions)
    assert fractions[-1] > 0.99


def test_a_look_ends_a_cancelled_run() -> None:
    cancel, seen = Event(), []

    def look(done: float, speed: float) -> None:
        seen.append(done)
        if len(seen) == 3:
            cancel.set()

    with pytest.raises(Cancelled):
        simulate(load_scenario(PAPER, FLOWING), progress=look, cancel=cancel)
    assert len(seen) == 3
    assert seen[-1] < 0.9
