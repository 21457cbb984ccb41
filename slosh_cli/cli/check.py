"""`slosh check`: whether a scenario is sound, without running it."""

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, Overrides, ScenarioFile
from slosh_cli.cli.output import say, say_json


def register(app: typer.Typer) -> None:
    """Add the command to the tree."""
    app.command("check")(check)


def check(scenario_file: ScenarioFile, overrides: Overrides = None, as_json: AsJson = False) -> ExitCode:
    """Check a scenario without running it.

    Every mistake is named with its line, all of them at once.
    """
    from slosh_cli.cli.reading import read_any_scenario
    from slosh_cli.scenario import Scenario

    scenario = read_any_scenario(scenario_file, overrides)
    kind = "a stop" if isinstance(scenario, Scenario) else "a tank alone"
    if as_json:
        say_json({"name": scenario.name, "valid": True, "describes": kind, "file": str(scenario_file)})
    else:
        say(f"{scenario_file}: {scenario.name} is a sound scenario ({kind})")
    return ExitCode.DONE
