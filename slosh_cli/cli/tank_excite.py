"""What `slosh tank excite` reads, computes, prints and writes."""

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import Keeping, by_kind, default_folder, files_text, free_folder
from slosh_cli.cli.output import complain, say, say_json, show, warn
from slosh_cli.cli.progress import announce_compilation
from slosh_cli.cli.reading import read_any_scenario
from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.results.files import try_targets
from slosh_cli.results.validity import plain, warnings_of
from slosh_cli.scenario import parse_quantity

if TYPE_CHECKING:
    from slosh_cli.results.recommendation import Recommendation
    from slosh_cli.results.validity import Check
    from slosh_cli.scenario import Scenario, TankScenario
    from slosh_cli.scenario.csv_table import Table
    from slosh_cli.solver.excite import Deceleration, Excitation

TABLE: Final = "excite.csv"
HISTORY: Final = "excite.h5"
_FILES: Final = (TABLE, HISTORY, "excite.png", "excite.svg")
_KERNELS: Final = {
    "modal": "excite_kernels.modal_history",
    "shallow-water": "excite_kernels.cells_history",
}
COLUMNS: Final = ("time_s", "deceleration_m_s2")
MOST_ROWS: Final = 1_000_000
LARGEST: Final = 1000.0
"""Decelerations beyond this, m/s^2, are a slip in the unit."""
REMEDY: Final = "Try more cells (tank.liquid.cells) or a smaller deceleration."


@dataclass(frozen=True)
class Wishes:
    """The options as they were written."""

    deceleration: str | None
    ramp: str | None
    duration: str
    table: Path | None
    interval: str


def run_excitation(
    scenario_file: Path, wishes: Wishes, overrides: Sequence[str] | None, output: Path | None, *, as_json: bool
) -> ExitCode:
    """Compute, write and tell."""
    scenario = read_any_scenario(scenario_file, overrides)
    duration, interval = _times(wishes)
    deceleration = _deceleration(wishes, duration)
    settings = _settings(wishes)
    folder = output or _default(scenario, overrides, settings)
    try_targets(folder, _FILES)
    if scenario.tank.liquid.model in _KERNELS:
        announce_compilation("the liquid", 10, _KERNELS[scenario.tank.liquid.model])
    from slosh_cli.solver.excite import excite

    found = excite(scenario.tank, deceleration, duration, interval)
    if found.time.size < 2:
        complain(f"failed: {found.reason}. {REMEDY}")
        return ExitCode.NO_ANSWER
    verdicts, advice = judge(scenario, found)
    warnings = warnings_of(verdicts)
    answer = summary(scenario, found) | {
        "checks": plain(verdicts),
        "recommendation": advice.as_dict() if advice else None,
        "warnings": warnings,
    }
    if not as_json:
        _show(scenario, found, answer)
    keeping = Keeping()
    files = _write(scenario, found, answer | {"settings": settings}, folder, keeping)
    if as_json:
        say_json(answer | {"warnings": [*warnings, *keeping.failures], "files": files})
        for warning in warnings:
            warn(warning)
    else:
        say(files_text(files))
    if found.reason:
        complain(f"failed: {found.reason}. {REMEDY}")
    return keeping.told(ExitCode.NO_ANSWER if found.reason else ExitCode.DONE)


def summary(scenario: "Scenario | TankScenario", found: "Excitation") -> dict[str, Any]:
    """The peaks as the JSON object has them: `max_...` is the extreme of the magnitude, in either direction."""
    from slosh_cli.solver.excite import extreme

    return {
        "name": scenario.name,
        "liquid_model": scenario.tank.liquid.model,
        "max_normalised_force": extreme(found.normalised_force),
        "min_normalised_force": float(found.normalised_force.min()),
        "max_surface_m": found.max_surface,
        "surface_limit_m": _room(scenario),
        "max_moment_N_m": extreme(found.moment),
        "liquid_mass_kg": found.mass,
        "mass_error": found.mass_error,
        "accuracy": found.accuracy,
        "reason": found.reason,
    }


def judge(
    scenario: "Scenario | TankScenario", found: "Excitation"
) -> "tuple[tuple[Check, ...], Recommendation | None]":
    """Whether the liquid stayed in the range of its model, and which model suits tank and deceleration.

    None for a load that is frozen on purpose.
    """
    from slosh_cli.results.liquid_range import Motion, motion_checks, tank_checks
    from slosh_cli.results.recommendation import recommend
    from slosh_cli.tank.roof import NEARLY_FULL

    tank = scenario.tank
    if tank.liquid.model == "rigid":
        return (), None
    advice = recommend(tank, found.largest_deceleration)
    motion = Motion(abs(found.max_surface), found.largest_head, slot_alone=scenario.tank.fill < NEARLY_FULL)
    return (*tank_checks(tank, advice.sentence), *motion_checks(tank, motion, advice.sentence)), advice


def _times(wishes: Wishes) -> tuple[float, float]:
    duration = _positive(wishes.duration, "--duration")
    interval = _positive(wishes.interval, "--interval")
    if duration / interval > MOST_ROWS:
        rule = f"a history has at most {MOST_ROWS} rows; lengthen --interval or shorten --duration"
        raise UsageError(rule, "--interval")
    return duration, interval


def _deceleration(wishes: Wishes, duration: float) -> "Deceleration":
    from slosh_cli.solver.excite import Deceleration

    if (wishes.deceleration is None) == (wishes.table is None):
        raise UsageError("say how the tank is decelerated: --deceleration '0.2 g', or --table FILE.csv", "excite")
    if wishes.table is not None:
        if wishes.ramp is not None:
            raise UsageError("--ramp goes with --deceleration; a table has its own course", "--ramp")
        found = Deceleration.table(read_course(wishes.table))
        where = str(wishes.table)
    else:
        level = _quantity(wishes.deceleration, "acceleration", "--deceleration")
        ramp = 0.0 if wishes.ramp is None else _quantity(wishes.ramp, "time", "--ramp")
        if ramp < 0.0:
            raise UsageError(f"--ramp must not be negative; given `{wishes.ramp}`", "--ramp")
        found, where = Deceleration.ramped(level, ramp), "--deceleration"
    if found.largest(duration) == 0.0:
        raise UsageError(f"{where}: the tank must be decelerated at some time within --duration", where)
    if found.largest(duration) > LARGEST:
        raise UsageError(f"{where}: must stay below {LARGEST:g} m/s^2, or the unit is another one", where)
    return found


def read_course(file: Path) -> list[tuple[float, float]]:
    """Rows (s, m/s^2) of a CSV file with the columns of COLUMNS; raises ScenarioError with file and line."""
    from slosh_cli.scenario.csv_table import read_table

    table = read_table(file, COLUMNS, _times_do_not_fall)
    return list(zip(*(table.columns[column] for column in COLUMNS), strict=True))


def _times_do_not_fall(table: "Table") -> None:
    times = table.columns[COLUMNS[0]]
    for line, before, time in zip(table.lines[1:], times, times[1:], strict=False):
        if time < before:
            given = f"{time:g} s after {before:g} s"
            table.refuse(line, COLUMNS[0], "must not fall from row to row", given, "sort the rows by time")


def _quantity(text: str | None, dimension: str, option: str) -> float:
    try:
        return parse_quantity(text, dimension)
    except ValueRefused as refused:
        raise UsageError(f"{option} {refused}", option) from refused


def _positive(text: str, option: str) -> float:
    value = _quantity(text, "time", option)
    if value <= 0.0:
        raise UsageError(f"{option} must be positive; given `{text}`", option)
    return value


def _room(scenario: "Scenario | TankScenario") -> float:
    return scenario.tank.height * (1.0 - scenario.tank.fill)


def _settings(wishes: Wishes) -> str:
    """What an excitation is told apart by, next to its scenario."""
    content = None if wishes.table is None else hashlib.sha256(wishes.table.read_bytes()).hexdigest()
    return json.dumps([wishes.deceleration, wishes.ramp, wishes.duration, wishes.interval, content])


def _default(scenario: "Scenario | TankScenario", overrides: Sequence[str] | None, settings: str) -> Path:
    from slosh_cli.results.hdf5 import is_of

    def fits(folder: Path) -> bool:
        return not (folder / HISTORY).exists() or is_of(folder / HISTORY, scenario, settings)

    return free_folder(default_folder(scenario.name, overrides), fits)


def _write(
    scenario: "Scenario | TankScenario", found: "Excitation", facts: dict[str, Any], folder: Path, keeping: Keeping
) -> dict[str, Any]:
    """Write table and history together, then the figure; returns where those lie that could be written."""
    from slosh_cli.results.channels import CHANNELS, Channel
    from slosh_cli.results.hdf5 import write_excitation
    from slosh_cli.results.tables import write_table

    columns = {
        "force_N": (CHANNELS["liquid_force"], found.force),
        "moment_N_m": (CHANNELS["liquid_moment"], found.moment),
        "surface_front_m": (CHANNELS["surface_front"], found.surface_front),
        "surface_rear_m": (CHANNELS["surface_rear"], found.surface_rear),
    }
    values = zip(found.time, *(column for _, column in columns.values()), strict=True)
    rows = [dict(zip(("time_s", *columns), map(float, row), strict=True)) for row in values]
    channels = {Channel("deceleration", "m/s^2", "prescribed deceleration of the tank"): found.deceleration}
    channels |= dict(columns.values())
    words, warnings = _words(scenario, found), facts["warnings"]
    facts = facts | {
        "warnings": "\n".join(warnings),
        "checks": json.dumps(facts["checks"]),
        "recommendation": (facts["recommendation"] or {}).get("sentence", ""),
    }

    def draw(folder: Path) -> None:
        from slosh_cli.report.tank_figures import Heading, draw_excitation

        draw_excitation(found, Heading("Tank under deceleration", words, warnings), _room(scenario), folder)

    numbers: dict[str, Callable[[Path], object]] = {
        TABLE: lambda path: write_table(rows, path),
        HISTORY: lambda path: write_excitation(scenario, found.time, channels, facts, path),
    }
    return by_kind(keeping.keep(folder, _FILES, numbers, {"excite": draw}), table=TABLE, history=HISTORY)


def _words(scenario: "Scenario | TankScenario", found: "Excitation") -> str:
    from slosh_cli.solver.excite import extreme

    tank = scenario.tank
    return (
        f"{scenario.name}: {tank.shape}, {tank.length:g} m long, {100.0 * tank.fill:g} % full, "
        f"liquid: {tank.liquid.model}, up to {extreme(found.deceleration):.4g} m/s²"
    )


def _show(scenario: "Scenario | TankScenario", found: "Excitation", answer: dict[str, Any]) -> None:
    from rich.table import Table
    from rich.text import Text

    from slosh_cli.solver.excite import extreme

    number: Callable[[float, str], str] = lambda value, unit: f"{value:.5g} {unit}".rstrip()  # noqa: E731
    table = Table.grid(padding=(0, 2))
    table.title, table.title_justify, table.title_style = _words(scenario, found), "left", "bold"
    room, depth = _room(scenario), scenario.tank.height * scenario.tank.fill
    for row in (
        ("force / (m |a|), largest in magnitude", number(answer["max_normalised_force"], "")),
        ("force / (m |a|), least", number(answer["min_normalised_force"], "")),
        ("force, largest in magnitude", number(extreme(found.force) / 1e3, "kN (forward +)")),
        ("moment about the bottom centre, likewise", number(answer["max_moment_N_m"] / 1e3, "kN m (nose-down +)")),
        ("surface at an end wall, likewise", f"{found.max_surface:+.3f} m (room: {room:.2f} m, depth: {depth:.2f} m)"),
        ("mass error", f"{found.mass_error:.1e}"),
        ("last change of the histories", f"{found.accuracy:.1e}"),
    ):
        table.add_row(*row)
    alarms = [Text(f"warning: {warning}", style="bold yellow") for warning in answer["warnings"]]
    if not alarms and answer["recommendation"]:
        alarms = [Text(answer["recommendation"]["sentence"])]
    show(table, *([""] if alarms else []), *alarms)
