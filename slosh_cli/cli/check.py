"""`slosh check`: whether a scenario is sound, without running it."""

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, Overrides, ScenarioFile
from slosh_cli.cli.output import say, say_json, warn


def check_command(scenario_file: ScenarioFile, overrides: Overrides = None, as_json: AsJson = False) -> ExitCode:
    """Check a scenario without running it.

    Every mistake is named with its line, all of them at once. What is allowed but unlikely, or will lead to overload,
    locked wheels or a liquid outside its model, is warned of.
    """
    from slosh_cli.application.stop import outlook
    from slosh_cli.cli.reading import load_given
    from slosh_cli.results.data_sheet import data_sheet
    from slosh_cli.results.validity import plain_checks, warnings_of
    from slosh_cli.scenario import Scenario, load_any_scenario
    from slosh_cli.track.spectrum import level_words, realised_level

    scenario = load_given(load_any_scenario, scenario_file, overrides)
    kind = "a stop" if isinstance(scenario, Scenario) else "a tank alone"
    verdicts, advice = outlook(scenario)
    warnings = warnings_of(verdicts)
    sheet = data_sheet(scenario) if isinstance(scenario, Scenario) else {}
    track = scenario.track if isinstance(scenario, Scenario) else None
    level = level_words(track.unevenness) if track else ""
    if as_json:
        found = {"name": scenario.name, "valid": True, "describes": kind, "file": str(scenario_file)}
        found["data_sheet"] = sheet
        if track and level:
            found["unevenness_d1_m"] = realised_level(track.unevenness)
        say_json(found | {"checks": plain_checks(verdicts), "recommendation": advice.as_dict(), "warnings": warnings})
    else:
        say(f"{scenario_file}: {scenario.name} is a sound scenario ({kind})")
        for name, value in sheet.items():
            say(f"  {name:<20} {value:10.3f}")
        if level:
            say(level)
        say(advice.sentence)
        for warning in warnings:
            warn(warning)
    return ExitCode.DONE
