"""What `slosh check --sensitivity` does and says."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import say, say_json, show

if TYPE_CHECKING:
    from rich.table import Table

    from slosh_cli.application.sensitivity import Sensitivity
    from slosh_cli.scenario import Scenario


def vary_and_tell(
    scenario: "Scenario",
    jobs: int | None,
    output: Path | None,
    overrides: Sequence[str] | None,
    checked: Mapping[str, Any] | None,
) -> ExitCode:
    """Run the stops, keep table and chart, tell what matters; `checked` is what JSON tells besides, None without."""
    from slosh_cli.application.keeping import Keeping, default_folder
    from slosh_cli.application.sensitivity import keep_sensitivity, sensitivity
    from slosh_cli.cli.keeping import files_text, told
    from slosh_cli.cli.progress import announce_solver, counting

    announce_solver([str(scenario.tank.liquid.model)])
    with counting("stops") as progress:
        found = sensitivity(scenario, threads=jobs, progress=progress)
    keeping = Keeping()
    files = keep_sensitivity(found, output or default_folder(scenario.name, overrides), keeping)
    if checked is not None:
        more = {"sensitivity": found.as_dict(), "files": files}
        say_json({**checked, **more, "warnings": [*checked["warnings"], *keeping.failures]})
    else:
        say("")
        show(_table(found))
        for line in _small(found):
            say(line)
        say(files_text(files))
    return told(keeping)


def _table(found: "Sensitivity") -> "Table":
    """What matters: a row per value, under it what the stop comes to at both its ends."""
    from rich.box import SIMPLE
    from rich.markup import escape
    from rich.table import Table

    table = Table(box=SIMPLE, title="What the stop depends on", title_justify="left", pad_edge=False)
    table.add_column("key")
    for name in ("distance\n/ m", "unloading\n/ %", "first lock\n/ (km/h)"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_row("as it is", *_answers(found.base))
    for one in found.mattering:
        doubt = one.doubt
        table.add_row(escape(f"{doubt.key} = {doubt.own} ({doubt.standing}; {doubt.reason})"))
        for end, row in zip((doubt.low, doubt.high), one.rows, strict=True):
            table.add_row(escape(f"  {end}"), *_answers(row))
    return table


def _answers(row: Mapping[str, Any] | None) -> tuple[str, str, str]:
    """Distance, unloading and speed at the first lock."""
    from slosh_cli.study.sensitivity import DISTANCE, LOCK, UNLOADING

    def cell(name: str, form: str, factor: float, none: str) -> str:
        if row is None:
            return "-"
        value = row.get(name)
        if row["status"] != "stopped":
            return str(row["status"]) if name == DISTANCE else "-"
        return none if value is None else format(value * factor, form)

    asked = ((DISTANCE, ".1f", 1.0, "-"), (UNLOADING, ".1f", 100.0, "-"), (LOCK, ".1f", 3.6, "none"))
    first, second, third = (cell(*one) for one in asked)
    return first, second, third


def _small(found: "Sensitivity") -> list[str]:
    """What does not matter, and what could not be varied."""
    from slosh_cli.study.sensitivity import DISTANCE, LOCK, SMALL, UNLOADING

    small = [one.doubt for one in found.effects if not one.matters(found.base) and not one.refusal]
    lines = []
    if small:
        part, loads, speed = SMALL[DISTANCE] * 100.0, SMALL[UNLOADING] * 100.0, SMALL[LOCK] * 3.6
        limits = f"{part:g} % of the distance, {loads:g} % of unloading or {speed:.1f} km/h"
        lines.append(f"These do not matter here, each alone changes less than {limits} at the first lock:")
        lines += [f"  {one.key}: {one.own}, from {one.low} to {one.high} ({one.standing})" for one in small]
    lines += [
        f"  {one.doubt.key} could not be varied all the way: {one.refusal}" for one in found.effects if one.refusal
    ]
    return lines
