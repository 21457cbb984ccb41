"""What slide protection leaves open of a braking distance: a sample of the slip decides, and decisions do not converge.

A sample that falls to the other side of a threshold lets a wheel go or holds it, and all samples after it fall
otherwise. On a dry or even rail the distance hardly notices. On an uneven, slippery one it may move by a percent,
however small the steps. So a run in which slide protection worked is held against one with smaller steps.
"""

from __future__ import annotations

from slosh_cli.method import START
from slosh_cli.results.validity import Check
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.schema_run import SMALLEST_TOLERANCE
from slosh_cli.solver.advance import STOPPED
from slosh_cli.solver.run import Cancel, Progress, integrate
from slosh_cli.solver.setup import problem
from slosh_cli.wagon.model import POSITION

PROTECTION = "slide protection resolved"
_FINER = 0.5
"""Of the tolerance: other steps, at little more than the same cost; a tenth tells the same where it was tried."""


def protection_check(scenario: Scenario, distance: float, progress: Progress | None, cancel: Cancel | None) -> Check:
    """The verdict on a braking `distance` (m) that slide protection had a part in: what half the tolerance gives.

    `progress` and `cancel` are those of `simulate`.
    """
    tolerance = scenario.solver.tolerance
    finer = _distance(scenario, max(_FINER * tolerance, SMALLEST_TOLERANCE), progress, cancel)
    miss = 1.0 if finer is None else abs(finer / distance - 1.0)
    found = "the wagon does not stop" if finer is None else f"it is {finer:.6g} m"
    return Check(
        PROTECTION,
        "accuracy",
        miss,
        tolerance,
        f"The braking distance of {distance:.6g} m is good to {100.0 * miss:.1g} % only: with half the tolerance "
        f"{found}. Slide protection decides by samples of the slip; one that falls otherwise changes all that follow.",
    )


def _distance(scenario: Scenario, tolerance: float, progress: Progress | None, cancel: Cancel | None) -> float | None:
    """The braking distance (m) at a tolerance; None where the wagon does not stop."""
    stop = problem(scenario.with_({"solver.tolerance": tolerance}))
    run, vehicle = integrate(stop, progress, cancel), stop.vehicle
    if run.outcome != STOPPED:
        return None
    return float(vehicle.points[START].q[POSITION] - vehicle.account.onset_position)
