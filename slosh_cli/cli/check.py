"""`slosh check`: whether a scenario is sound, without running it."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile, Threaded
from slosh_cli.cli.output import default_lines, say, say_json, warn
from slosh_cli.errors import UsageError

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario, TankScenario

_SHEET: Final = {
    "Mass and volume": {
        "tank_volume_m3": ("volume of the tank", ".2f", "m^3"),
        "liquid_volume_m3": ("volume of the liquid", ".2f", "m^3"),
        "ullage_m3": ("ullage", ".2f", "m^3"),
        "degree_of_filling": ("liquid over tank, volumes", ".3f", ""),
        "fill": ("liquid over tank, heights", ".3f", ""),
        "payload_t": ("payload", ".2f", "t"),
        "gross_mass_t": ("gross mass", ".2f", "t"),
        "axle_load_front_t": ("axle load, front", ".2f", "t"),
        "axle_load_rear_t": ("axle load, rear", ".2f", "t"),
        "centre_of_gravity_m": ("centre of gravity above rail", ".2f", "m"),
    },
    "Brake": {
        "tau": ("brake force over weight (tau), mean", ".3f", ""),
        "tau_initial": ("tau at the initial speed", ".3f", ""),
        "tau_near_rest": ("tau near rest", ".3f", ""),
        "filling_time_s": ("filling time", ".1f", "s"),
        "mean_deceleration_m_s2": ("mean deceleration, point mass", ".3f", "m/s^2"),
        "stopping_distance_m": ("distance from the onset, point mass", ".1f", "m"),
        "braked_weight_percentage": ("lambda of that distance (UIC 544-1)", ".1f", "%"),
    },
    "Periods": {
        "slosh_period_s": ("first slosh period, tank held", ".2f", "s"),
        "slosh_period_rolling_s": ("first slosh period, wagon rolling", ".2f", "s"),
        "slosh_after_build_up": ("slosh after build-up over a step's", ".2f", ""),
        "bounce_frequency_Hz": ("bounce of the wagon", ".2f", "Hz"),
        "pitch_frequency_Hz": ("pitch of the wagon", ".2f", "Hz"),
    },
}
"""The data sheet as the terminal shows it: groups of label, format and unit by name."""


_SENSITIVITY: Final = "Run the stop with each uncertain value up and down: tells what it depends on, with a chart."


def check_command(
    scenario_file: ScenarioFile,
    overrides: Overrides = None,
    sensitivity: Annotated[bool, typer.Option("--sensitivity", help=_SENSITIVITY)] = False,
    jobs: Threaded = None,
    output: OutputFolder = None,
    as_json: AsJson = False,
) -> ExitCode:
    """Check a scenario without running it.

    Every mistake is named with its line, all of them at once. The data sheet tells masses, the brake and the periods of
    what is sound, and what the program takes where the file says nothing. What is allowed but unlikely, or will lead to
    overload, locked wheels or a liquid outside its model, is warned of.
    """
    from slosh_cli.cli.reading import load_given
    from slosh_cli.scenario import Scenario, load_any_scenario
    from slosh_cli.scenario.train_file import is_train_file

    if is_train_file(scenario_file):
        from slosh_cli.cli.train import check_train

        _refuse(sensitivity, scenario_file, "a train")
        return check_train(scenario_file, overrides, as_json=as_json)
    scenario = load_given(load_any_scenario, scenario_file, overrides)
    stop = scenario if isinstance(scenario, Scenario) else None
    _refuse(sensitivity and stop is None, scenario_file, "a tank alone")
    found, lines = _found(scenario_file, scenario, stop)
    if not as_json:
        for line in lines:
            say(line)
        for warning in found["warnings"]:
            warn(warning)
    if sensitivity and stop:
        from slosh_cli.cli.sensitivity_output import vary_and_tell

        return vary_and_tell(stop, jobs, output, overrides, found if as_json else None)
    if as_json:
        say_json(found)
    return ExitCode.DONE


def _found(
    file: Path, scenario: "Scenario | TankScenario", stop: "Scenario | None"
) -> tuple[dict[str, Any], list[str]]:
    """What there is to tell of a sound scenario, which may be a `stop`: as JSON has it, and in lines."""
    from slosh_cli.application.stop import outlook
    from slosh_cli.results.data_sheet import data_sheet, resonances
    from slosh_cli.results.validity import plain_checks, warnings_of
    from slosh_cli.scenario.standing import counted_standings, standings
    from slosh_cli.track.spectrum import level_words, realised_level

    kind, defaults = ("a stop", stop.defaults) if stop else ("a tank alone", {})
    (verdicts, advice), sheet, inputs = outlook(scenario), data_sheet(scenario), standings(scenario)
    level, told = level_words(stop.track.unevenness) if stop else "", resonances(sheet)
    found = {"name": scenario.name, "valid": True, "describes": kind, "file": str(file)}
    found |= {"data_sheet": sheet, "resonances": told} | ({"defaults": defaults} if stop else {})
    found |= {"inputs": {key: asdict(one) for key, one in inputs.items()}}
    found |= {"unevenness_d1_m": realised_level(stop.track.unevenness)} if stop and level else {}
    found |= {"checks": plain_checks(verdicts), "recommendation": advice.as_dict(), "warnings": warnings_of(verdicts)}
    lines = [f"{file}: {scenario.name} is a sound scenario ({kind})", *_lines(sheet)]
    lines += [counted_standings(inputs), *default_lines(defaults), *told]
    in_use = scenario.tank.liquid.model == advice.model
    suits = ["The model of the liquid that suits is the one in use."] if in_use else []
    return found, [*lines, *([level] if level else []), *suits, advice.sentence]


def _refuse(asked: bool, file: Path, what: str) -> None:
    if asked:
        raise UsageError(f"--sensitivity needs the stop of one wagon; given {file}, {what}", "--sensitivity")


def _lines(sheet: Mapping[str, float | None]) -> Iterator[str]:
    """The data sheet in groups; a dash where there is no number."""
    for group, rows in _SHEET.items():
        known = {name: row for name, row in rows.items() if name in sheet}
        yield from (["", group] if known else [])
        for name, (label, form, unit) in known.items():
            value = sheet[name]
            yield f"  {label:<36}{'-' if value is None else format(value, form):>10} {unit}".rstrip()
    yield ""
