"""What `slosh run` and `slosh check` do with a train."""

import threading
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import default_lines, say, say_json, show, warn

if TYPE_CHECKING:
    from rich.table import Table

    from slosh_cli.application.train_outlook import VehicleKind
    from slosh_cli.results.train_result import TrainResult
    from slosh_cli.scenario.train_file import TrainScenario

_SHEET: Final = {
    "gross_mass_t": ("gross\n/ t", ".1f"),
    "fill": ("fill", ".2f"),
    "slosh_period_s": ("slosh, tank\nheld / s", ".2f"),
    "slosh_period_rolling_s": ("slosh,\nrolling / s", ".2f"),
    "tau": ("tau,\nmean", ".3f"),
    "filling_time_s": ("fills in\n/ s", ".1f"),
}
"""The data sheet of a kind of vehicle as the terminal shows it: head and format by name."""


def check_train(file: Path, overrides: Sequence[str] | None, *, as_json: bool) -> ExitCode:
    """Say that a train is sound, and what of."""
    from slosh_cli.application.differing import listed
    from slosh_cli.application.stop import outlook
    from slosh_cli.application.train_outlook import vehicle_kinds
    from slosh_cli.results.train_result import gathered, slack_warnings
    from slosh_cli.scenario.standing import counted_standings, standings
    from slosh_cli.scenario.train_file import load_train

    train = load_train(file, overrides or ())
    vehicles, last = train.vehicles, train.vehicles[-1]
    warnings = (*gathered([outlook(vehicle)[0] for vehicle in vehicles]), *slack_warnings(train))
    length = sum(one.wagon.length_in_train for one in vehicles)
    kinds, own = vehicle_kinds(train), standings(train.file)
    if as_json:
        found = {"name": train.name, "valid": True, "describes": "a train", "file": str(file), "length_m": length}
        each = [{"name": one.name, "onset_s": one.braking.onset, "defaults": one.defaults} for one in vehicles]
        found |= {"vehicles": each, "kinds": [one.as_dict() for one in kinds]}
        say_json(found | {"inputs": {key: asdict(one) for key, one in own.items()}, "warnings": list(warnings)})
        return ExitCode.DONE
    say(f"{file}: {train.name} is a sound train of {len(vehicles)} vehicles, {length:.1f} m long")
    names = dict.fromkeys(one.name for one in vehicles)
    say("Vehicles: " + ", ".join(f"{sum(one.name == kind for one in vehicles)} x {kind}" for kind in names))
    onsets = f"{vehicles[0].braking.onset:.2f} s at the front and {last.braking.onset:.2f} s at the end"
    say(f"The brakes set in after {onsets}")
    show("", _kinds(kinds), "", whole=True)
    say(f"{counted_standings(own)} (the train's own file)")
    for one in kinds:
        say(f"{counted_standings(one.inputs())} (vehicles {listed(one.places)}, {one.vehicle.name})")
    say("")
    for line in default_lines({key: text for one in vehicles for key, text in one.defaults.items()}):
        say(line)
    for warning in warnings:
        warn(warning)
    return ExitCode.DONE


def _kinds(kinds: "Sequence[VehicleKind]") -> "Table":
    """A row for all vehicles that are alike."""
    from rich import box
    from rich.table import Table

    from slosh_cli.application.differing import listed

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, 1, 0, 0))
    for name in ("vehicles", "name", "load"):
        table.add_column(name)
    for head, _ in _SHEET.values():
        table.add_column(head, justify="right")
    table.add_column("brake")
    for one in kinds:
        numbers = [
            "-" if (value := one.sheet[name]) is None else format(value, form) for name, (_, form) in _SHEET.items()
        ]
        load = str(one.vehicle.tank.liquid.model)
        table.add_row(listed(one.places), one.vehicle.name, load, *numbers, one.brake)
    return table


def solve_train(train: "TrainScenario") -> "TrainResult":
    """Run the solver with a progress bar; an interrupt stops the solver before it goes on to the user."""
    from slosh_cli.cli.progress import RunProgress, announce_solver
    from slosh_cli.results.effort import why_long
    from slosh_cli.results.simulate import simulate_train

    announce_solver(train.liquids)
    cancel = threading.Event()
    with RunProgress(train.name, why_long(train.vehicles)) as progress:
        try:
            return simulate_train(train, progress=progress, cancel=cancel)
        except KeyboardInterrupt:
            cancel.set()
            raise


def show_train(result: "TrainResult") -> None:
    """Print what a train's run found and what it warns of, to stdout."""
    from rich.text import Text

    stopped = result.braking_distance_m is not None
    lines = [] if stopped else [f"No braking distance: {result.status}. {result.reason}".rstrip(), result.status.remedy]
    alarms = [Text(line, style="bold red") for line in lines]
    alarms += [Text(f"warning: {warning}", style="bold yellow") for warning in result.warnings]
    show(_facts(result), "", _rows(result), *([""] if alarms else []), *alarms)


def _facts(result: "TrainResult") -> "Table":
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    speed = result.initial_speed_m_s * 3.6
    table.title, table.title_justify, table.title_style = (
        f"{result.name}: {len(result.vehicles)} vehicles, {speed:.4g} km/h",
        "left",
        "bold",
    )
    lines = sorted(((one.line, getattr(result, one.name)) for one in result.table() if one.line), key=lambda x: x[0].at)
    for line, value in lines:
        told = "-" if value is None else f"{value / line.per:{line.form}}" if line.form else str(value)
        table.add_row(line.label, f"{told} {line.unit}".rstrip())
    return table


def _rows(result: "TrainResult") -> "Table":
    """One row per vehicle, with the coupling behind it."""
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, 1, 0, 0))
    table.add_column("")
    table.add_column("vehicle", overflow="fold")
    heads = ("onset\n/ s", "way\n/ m", "rise\n/ m", "unloading\n/ %", "locked\n/ s")
    for column in (*heads, "compression\nbehind / kN", "tension\nbehind / kN"):
        table.add_column(column, justify="right", no_wrap=True)
    behind: list[Any] = [*result.couplings, None]
    for number, (one, coupling) in enumerate(zip(result.vehicles, behind, strict=True), 1):
        forces = ["", ""]
        if coupling is not None:
            forces = [f"{coupling.max_compression_N / 1e3:.1f}", f"{coupling.max_tension_N / 1e3:.1f}"]
        numbers = (f"{one.onset_s:.2f}", f"{one.distance_m:.2f}", f"{one.max_surface_m:.2f}")
        wheels = (f"{100 * one.max_wheel_unloading:.1f}", f"{max(one.locked_time_s):.2f}")
        table.add_row(str(number), one.name, *numbers, *wheels, *forces)
    return table
