"""`slosh check`: whether a scenario is sound, without running it."""

from typing import TYPE_CHECKING

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, Overrides, ScenarioFile
from slosh_cli.cli.output import say, say_json, warn

if TYPE_CHECKING:
    from slosh_cli.results.recommendation import Recommendation
    from slosh_cli.results.validity import Check
    from slosh_cli.scenario import Scenario, TankScenario


def register(app: typer.Typer) -> None:
    """Add the command to the tree."""
    app.command("check")(check)


def check(scenario_file: ScenarioFile, overrides: Overrides = None, as_json: AsJson = False) -> ExitCode:
    """Check a scenario without running it.

    Every mistake is named with its line, all of them at once. What is allowed but unlikely, or will lead to overload,
    locked wheels or a liquid outside its model, is warned of.
    """
    from slosh_cli.cli.reading import read_any_scenario
    from slosh_cli.results.validity import plain, warnings_of
    from slosh_cli.scenario import Scenario

    scenario = read_any_scenario(scenario_file, overrides)
    kind = "a stop" if isinstance(scenario, Scenario) else "a tank alone"
    verdicts, advice = judge(scenario)
    warnings = warnings_of(verdicts)
    if as_json:
        found = {"name": scenario.name, "valid": True, "describes": kind, "file": str(scenario_file)}
        say_json(found | {"checks": plain(verdicts), "recommendation": advice.as_dict(), "warnings": warnings})
    else:
        say(f"{scenario_file}: {scenario.name} is a sound scenario ({kind})")
        say(advice.sentence)
        for warning in warnings:
            warn(warning)
    return ExitCode.DONE


def judge(scenario: "Scenario | TankScenario") -> "tuple[tuple[Check, ...], Recommendation]":
    """What can be told before anything moves: verdicts, and the model of the liquid that suits."""
    from slosh_cli.results.liquid_range import expected_checks, tank_checks
    from slosh_cli.results.recommendation import deceleration_of, recommend
    from slosh_cli.results.wagon_range import lock_check, speed_check, wagon_checks
    from slosh_cli.scenario import Scenario

    tank, deceleration = scenario.tank, deceleration_of(scenario)
    advice = recommend(tank, deceleration)
    verdicts = tank_checks(tank, advice.sentence)
    if deceleration is not None:
        verdicts += expected_checks(tank, deceleration, advice.sentence)
    if isinstance(scenario, Scenario):
        verdicts += (*wagon_checks(scenario), speed_check(scenario), lock_check(scenario))
    return verdicts, advice
