"""`slosh presets`: the named values that a scenario may use, with their sources."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson
from slosh_cli.cli.output import say, say_json

if TYPE_CHECKING:
    from slosh_cli.scenario.presets import Preset


def presets_command(
    name: Annotated[
        str, typer.Argument(metavar="[NAME]", help="Preset to print with its sources. Default: a list of all.")
    ] = "",
    json: AsJson = False,
) -> ExitCode:
    """List the presets for scenarios, or print one with its sources.

    A part of a scenario takes one by `use: NAME`; of every value the source and the standing are printed: published,
    measured or assumed.
    """
    from slosh_cli.scenario.presets import every_preset, find_preset

    if name:
        found = find_preset(name)
        say_json(_as_json(found)) if json else _tell(found)
        return ExitCode.DONE
    every = every_preset().values()
    if json:
        say_json({"presets": [_as_json(preset) for preset in every]})
        return ExitCode.DONE
    width = max(len(preset.name) for preset in every)
    for preset in every:
        say(f"{preset.kind:8} {preset.name:{width}}  {preset.title}")
    say("Write `use: NAME` in a part of a scenario; `slosh presets NAME` prints the values with their sources.")
    return ExitCode.DONE


def _tell(preset: "Preset") -> None:
    say(f"{preset.name}, a {preset.kind}: {preset.title}")
    if preset.un is not None:
        say(f"UN number {preset.un}")
    for path, leaf in preset.leaves.items():
        say(f"  {'.'.join(map(str, path))}: {leaf.value}  [{leaf.standing}: {leaf.source}]")
    for celsius, density in preset.density_at:
        say(f"  density at {celsius:g} C: {density:g} kg/m^3")


def _as_json(preset: "Preset") -> dict[str, Any]:
    values = [
        {"key": ".".join(map(str, path)), "value": leaf.value, "standing": leaf.standing, "source": leaf.source}
        for path, leaf in preset.leaves.items()
    ]
    found: dict[str, Any] = {"name": preset.name, "kind": preset.kind, "title": preset.title, "values": values}
    if preset.density_at:
        found |= {"un": preset.un, "density_at": [list(point) for point in preset.density_at]}
    return found
