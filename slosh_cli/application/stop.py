"""One stop of a wagon: what can be told of it beforehand, its simulation, its files."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping, by_kind
from slosh_cli.report import FIGURE_NAMES, FORMATS
from slosh_cli.scenario import Scenario, TankScenario, load_scenario

if TYPE_CHECKING:
    from slosh_cli.results.recommendation import Recommendation
    from slosh_cli.results.result import Result
    from slosh_cli.results.validity import Check
    from slosh_cli.solver.run import Cancel, Progress

_HISTORY: Final = "run.h5"
_SUMMARY: Final = "summary.csv"
FIGURE_FILES: Final = tuple(f"{name}.{suffix}" for name in FIGURE_NAMES for suffix in FORMATS)
"""Every figure that a run may have, by the names of its files."""
RUN_FILES: Final = (_HISTORY, _SUMMARY, *FIGURE_FILES)
"""Every file that a run may write, its history first."""


def outlook(scenario: Scenario | TankScenario) -> tuple[tuple[Check, ...], Recommendation]:
    """What can be told before anything moves: verdicts, and the model of the liquid that suits."""
    from slosh_cli.results.filling import filling_checks
    from slosh_cli.results.line import descent_checks
    from slosh_cli.results.liquid_range import expected_checks, tank_checks
    from slosh_cli.results.recommendation import deceleration_of, recommend
    from slosh_cli.results.wagon_range import default_adhesion_checks, lock_check, speed_check, wagon_checks

    tank, deceleration = scenario.tank, deceleration_of(scenario)
    advice = recommend(tank, deceleration)
    verdicts = (*tank_checks(tank, advice.sentence), *filling_checks(tank, scenario.limits))
    if deceleration is not None:
        verdicts += expected_checks(tank, deceleration, advice.sentence)
    if isinstance(scenario, Scenario):
        verdicts += (*wagon_checks(scenario), speed_check(scenario), lock_check(scenario), *descent_checks(scenario))
        verdicts += tuple(default_adhesion_checks(scenario))
    return verdicts, advice


def simulate(
    scenario: Scenario | str | Path, *, progress: Progress | None = None, cancel: Cancel | None = None
) -> Result:
    """Integrate one stop of a scenario, or of its file.

    `progress` is called now and then with the fraction done and the speed (m/s); `cancel` is looked at as often
    and ends the run with `Cancelled`. A stop that comes to no answer is a result too: see its status and reason.
    Raises ScenarioError for a file that cannot be used, PhysicsError where the scenario has no model (indefinite mass
    matrix, supercritical speed) and TankError where slosh coefficients cannot be computed.
    """
    from slosh_cli.results.simulate import simulate as integrated

    stop = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    return integrated(stop, progress=progress, cancel=cancel)


def keep_run(result: Result, folder: Path, keeping: Keeping, *, figures: bool = True) -> dict[str, Any]:
    """Write history and summary of a run into `folder`, then its figures; returns where those lie that could be.

    What an earlier run left in `folder` goes.
    """
    from slosh_cli.results.answers import Shown
    from slosh_cli.results.hdf5 import write_history
    from slosh_cli.results.tables import write_table

    def draw(name: str, folder: Path) -> None:
        from slosh_cli.report.figures import draw_run

        draw_run(result, folder, names=(name,))

    row = result.row(Shown.SUMMARY)
    numbers = {_SUMMARY: partial(write_table, [row]), _HISTORY: partial(write_history, result)}
    drawn = {name: partial(draw, name) for name in FIGURE_NAMES if figures}
    return by_kind(keeping.keep(folder, RUN_FILES, numbers, drawn), history=_HISTORY, summary=_SUMMARY)
