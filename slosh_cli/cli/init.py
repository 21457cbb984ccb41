"""`slosh init`: a commented scenario to start from."""

import os
import sys
from pathlib import Path
from typing import Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import option
from slosh_cli.cli.output import say
from slosh_cli.errors import UsageError

_DEFAULT: Final = "tank-wagon"
_USUAL: Final = {
    "track": "uic60-ballast",
    "product": "diesel",
    "brake": "k-blocks",
    "temperature": "15 C",
    "speed": "100 km/h",
}
_QUESTIONS: Final = {
    "wagon": "Wagon (`slosh presets` lists them)",
    "track": "Track",
    "product": "Product",
    "temperature": "Temperature of the product",
    "gross": "Mass of the wagon with its load, such as 80 t, or 60 % of the tank's volume",
    "brake": "Brake",
    "speed": "Speed before the stop",
}
_LOAD: Final = "What is in the tank: '60 %' of its volume, '52.8 m^3' or '44 t'."
_CAPACITY: Final = "Volume of the tank, '88 m^3'; its length follows. Default: that of the wagon's preset."
_FILE: Final = "File to write; the scenario takes its name. Default: its own name, in the current folder."


_Name = Annotated[
    str | None,
    typer.Argument(
        metavar="NAME",
        help=f"Packaged scenario to copy; --list shows them all. Default: {_DEFAULT}.",
        show_default=False,
    ),
]


def init_command(
    name: _Name = None,
    output: Annotated[Path | None, option("--output -o", "FILE", _FILE)] = None,
    names: Annotated[bool, typer.Option("--list", help="List the packaged scenarios and exit.")] = False,
    wagon: Annotated[str | None, option("--wagon", "PRESET", "Write a scenario of presets: this wagon.")] = None,
    track: Annotated[str | None, option("--track", "PRESET", "Track. Default: uic60-ballast.")] = None,
    product: Annotated[str | None, option("--product", "PRESET", "Product. Default: diesel.")] = None,
    brake: Annotated[str | None, option("--brake", "PRESET", "Brake. Default: k-blocks.")] = None,
    temperature: Annotated[str | None, option("--temperature", "T", "Of the product. Default: 15 C.")] = None,
    load: Annotated[str | None, option("--load", "AMOUNT", _LOAD)] = None,
    gross: Annotated[str | None, option("--gross", "MASS", "Wagon with its load, in place of --load: '90 t'.")] = None,
    capacity: Annotated[str | None, option("--capacity", "VOLUME", _CAPACITY)] = None,
    speed: Annotated[str | None, option("--speed", "SPEED", "Before the stop. Default: 100 km/h.")] = None,
) -> ExitCode:
    """Write a commented scenario to start from. Never overwrites a file.

    With --wagon, --load and so on it is written out of presets (`slosh presets` lists them): --wagon zacns-like --load
    '60 %'. Without anything, on a terminal, it asks.
    """
    from slosh_cli.scenario.packaged import packaged_scenarios, packaged_trains

    if names:
        say("\n".join(packaged_scenarios() | packaged_trains()))
        return ExitCode.DONE
    chosen = {"wagon": wagon, "track": track, "product": product, "brake": brake}
    chosen |= {"temperature": temperature, "load": load, "gross": gross, "capacity": capacity, "speed": speed}
    given = {key: value for key, value in chosen.items() if value is not None}
    if name and given:
        raise UsageError(f"must stand alone or be left out; given `{name}` beside options for presets", name)
    if given or (not name and output is None and _on_a_terminal()):
        return _of_presets(given, output)
    return _of_packaged(name or _DEFAULT, output)


def _of_packaged(name: str, output: Path | None) -> ExitCode:
    """Write a copy of a packaged scenario."""
    from slosh_cli.scenario import Scenario, find_packaged, load_any_scenario, packaged_scenarios, packaged_text
    from slosh_cli.scenario.packaged import packaged_trains
    from slosh_cli.scenario.words import file_safe

    every = packaged_scenarios() | packaged_trains()
    source = find_packaged(name, trains=True)
    own_name, text = packaged_text(source, file_safe(output.stem) if output else "")
    file = output or Path(f"{own_name}.yaml")
    _write_new(file, text)
    runs = source in packaged_trains().values() or isinstance(load_any_scenario(source), Scenario)
    then = f", run it with `slosh run {file}`" if runs else ""
    say(f"{file} written. Change it, check it with `slosh check {file}`{then}.")
    others = [other for other, path in every.items() if path != source]
    if others:
        say(f"Others to start from: {', '.join(others)}.")
    return ExitCode.DONE


def _on_a_terminal() -> bool:
    return sys.stdin.isatty() and sys.stdout.isatty()


def _of_presets(given: dict[str, str], output: Path | None) -> ExitCode:
    """Write a scenario of presets; what is not given is asked for where nothing is, or has its default."""
    from slosh_cli.scenario.composed import composed
    from slosh_cli.scenario.words import file_safe

    if given:
        if "wagon" not in given:
            raise UsageError("must be given with the others: --wagon; see `slosh presets`", "--wagon")
        if ("load" in given) == ("gross" in given):
            raise UsageError("exactly one of --load and --gross must be given: '60 %', '52.8 m^3' or '44 t'", "--load")
        chosen = _USUAL | given
    else:
        chosen = {key: typer.prompt(question, default=_USUAL.get(key)) for key, question in _QUESTIONS.items()}
        if chosen["gross"].rstrip().endswith("%"):
            chosen["load"] = chosen.pop("gross")
    file = output or Path(f"{chosen['wagon']}-{chosen['product']}.yaml")
    _write_new(file, composed(file_safe(file.stem), chosen))
    say(f"{file} written. Change it, check it with `slosh check {file}`, run it with `slosh run {file}`.")
    return ExitCode.DONE


def _write_new(file: Path, text: str) -> None:
    """Write a file that is not there yet, whole or not at all, also where the power fails."""
    from slosh_cli.results.files import write_text

    if os.path.lexists(file):
        raise UsageError(f"{file} exists already; choose another name with -o FILE", str(file))
    if not file.parent.is_dir():
        raise UsageError(f"cannot write {file}: there is no folder {file.parent}", str(file))
    write_text(text, file)
