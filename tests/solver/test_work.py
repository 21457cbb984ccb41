"""A stop takes no more work than it did: steps, rejections, Newton iterations, factorisations, right-hand sides.

Work is counted, not timed, so the guard holds on any machine. `MEASURED` is what the stops took when it was last
renewed (`python tests/solver/test_work.py` prints it anew); more than `MORE` of that is a regression, less than `FEWER`
either an improvement, to be kept by renewing the table, or work that is no longer counted.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import median

import pytest

from slosh_cli.results.result import Result

MORE, FEWER = 1.10, 0.70
SPARE = 3
"""Counts as small as a few rejections may differ by this many between processors."""

RIGID, FAST = "tank.liquid.model=rigid", "braking.initial_speed=150 km/h"
STOPS: dict[str, tuple[str, ...]] = {
    "80 km/h, liquid": ("paper_80",),
    "80 km/h, solid": ("paper_80_solid",),
    "160 km/h, liquid": ("paper_160",),
    "160 km/h, solid": ("paper_160_solid",),
    "160 km/h, tight": ("paper_160", "solver.tolerance=1e-5"),
    "shallow water": ("paper_80", "tank.liquid.model=shallow-water"),
    "wet, wheels lock": ("paper_80", "contact.adhesion=wet"),
    "some wheels lock": ("paper_80", RIGID, FAST, "braking.torque=19.6 kN m"),
    "all wheels lock": ("paper_80", RIGID, FAST, "braking.torque=25 kN m"),
}
COUNTS = ("steps", "rejected", "newton_iterations", "factorisations", "right_hand_sides", "events")
MEASURED: dict[str, tuple[int, ...]] = {
    "80 km/h, liquid": (321, 30, 1411, 354, 2476, 2),
    "80 km/h, solid": (252, 18, 999, 273, 1907, 2),
    "160 km/h, liquid": (423, 34, 1838, 460, 3220, 2),
    "160 km/h, solid": (331, 18, 1159, 352, 2460, 2),
    "160 km/h, tight": (1299, 22, 5470, 1324, 9447, 2),
    "shallow water": (567, 43, 2534, 613, 4288, 2),
    "wet, wheels lock": (614, 86, 2799, 707, 4940, 6),
    "some wheels lock": (513, 63, 2322, 583, 4075, 6),
    "all wheels lock": (519, 54, 2288, 582, 4063, 8),
}
"""In the order of `COUNTS`."""

FIGURE_3_STEPS, FIGURE_3_REJECTED = 500, 0.20
"""Most accepted steps of the median stop of the paper's Figure 3, and most of its tried steps that are rejected."""


def counted(result: Result) -> tuple[int, ...]:
    """The work of a stop in the order of `COUNTS`."""
    return (result.steps, result.rejected_steps, *(result.work[name] for name in COUNTS[2:]))


@pytest.mark.parametrize("name", STOPS)
def test_a_stop_takes_the_work_it_took(name: str, stop: Callable[..., Result]) -> None:
    found = dict(zip(COUNTS, counted(stop(*STOPS[name])), strict=True))
    for count, measured in zip(COUNTS, MEASURED[name], strict=True):
        assert found[count] <= MORE * measured + SPARE, f"more {count} than the {measured} of the table"
        assert found[count] >= FEWER * measured - SPARE, f"fewer {count} than {measured}: renew the table"


def test_figure_3_takes_few_steps(stop: Callable[..., Result]) -> None:
    steps, rejected = [], []
    for name in ("paper_80", "paper_160"):
        for liquid in ("modal", "rigid"):
            for torque in range(25, 301, 25):
                result = stop(name, f"tank.liquid.model={liquid}", f"braking.torque={0.1 * torque:g} kN m")
                steps.append(result.steps)
                rejected.append(result.rejected_steps / (result.steps + result.rejected_steps))
    assert len(steps) == 48
    assert median(steps) <= FIGURE_3_STEPS
    assert median(rejected) < FIGURE_3_REJECTED


if __name__ == "__main__":
    import sys
    from pathlib import Path

    from slosh_cli import load_scenario, simulate

    for key, (file, *overrides) in STOPS.items():
        scenario = load_scenario(Path(__file__).parents[2] / "scenarios" / f"{file}.yaml", overrides)
        sys.stdout.write(f'    "{key}": {counted(simulate(scenario))},\n')
