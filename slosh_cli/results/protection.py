"""What slide protection leaves open of a braking distance: a sample of the slip decides, and decisions do not converge.

A sample that falls to the other side of a threshold lets a wheel go or holds it, and all samples after it fall
otherwise. On a dry or even rail the distance hardly notices. On an uneven, slippery one it may move by a percent,
however small the steps. So a run in which slide protection worked is held against one with smaller steps.
"""

from __future__ import annotations

from collections.abc import Sequence

from slosh_cli.method import START
from slosh_cli.results.validity import Check
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.schema_run import SMALLEST_TOLERANCE
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.scenario.units import digits
from slosh_cli.solver.advance import STOPPED
from slosh_cli.solver.run import Cancel, Progress, integrate
from slosh_cli.solver.setup import ReadyStop, problem, train_problem
from slosh_cli.wagon.model import POSITION

PROTECTION = "slide protection resolved"
_HALF, _TWICE = (0.5, "half"), (2.0, "twice")
"""Of the tolerance: other steps, at little more than the same cost; a tenth tells the same where it was tried."""


def protection_checks(
    scenario: Scenario | TrainScenario,
    stops: Sequence[ReadyStop],
    distance: float,
    progress: Progress | None,
    cancel: Cancel | None,
) -> tuple[Check, ...]:
    """The verdict on a braking `distance` (m) that slide protection had a part in: what half the tolerance gives.

    Beside the smallest tolerance it is twice of it.
    `stops` are those of the vehicles, run; without a brake that vented nothing is said. `progress` and `cancel` are
    those of `simulate`.
    """
    if not any(stop.vehicle.brake.vents.any() for stop in stops):
        return ()
    first = scenario if isinstance(scenario, Scenario) else scenario.vehicles[0]
    tolerance = first.solver.tolerance
    part, words = _HALF if _HALF[0] * tolerance >= SMALLEST_TOLERANCE else _TWICE
    stop = _stop(scenario, part * tolerance)
    run, vehicle = integrate(stop, progress, cancel), stop.vehicle
    miss, found = 1.0, "the wagon does not stop"
    if run.outcome == STOPPED:
        other = float(vehicle.points[START].q[POSITION] - vehicle.account.onset_position)
        miss, found = abs(other / distance - 1.0), f"it is {other:.6g} m"
    meaning = (
        f"The braking distance of {distance:.6g} m is good to {digits(100.0 * miss, 1)} % only: with {words} "
        f"the tolerance {found}. Slide protection decides by samples of the slip; one that falls otherwise changes "
        "all that follow."
    )
    return (Check(PROTECTION, "accuracy", miss, tolerance, meaning),)


def _stop(scenario: Scenario | TrainScenario, tolerance: float) -> ReadyStop:
    """The stop at another tolerance; of a train that of its first vehicle."""
    if isinstance(scenario, Scenario):
        return problem(scenario.with_({"solver.tolerance": tolerance}))
    train = scenario.with_({"all.solver.tolerance": tolerance, "vehicles.1.solver.tolerance": tolerance})
    return train_problem(train.vehicles, train.file.coupling)[0]
