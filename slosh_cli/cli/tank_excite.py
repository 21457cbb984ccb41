"""What `slosh tank excite` prints."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

from slosh_cli.application.excitation import ExcitationResult, excitation_folder, excited
from slosh_cli.application.keeping import Keeping
from slosh_cli.application.prescription import Prescription
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import files_text, told
from slosh_cli.cli.output import complain, note, say, say_json, show, warn
from slosh_cli.cli.progress import announce_compilation
from slosh_cli.cli.reading import read_any_scenario

_KERNELS: Final = {
    "modal": "excite_kernels.modal_history",
    "shallow-water": "excite_kernels.cells_history",
}
_REMEDY: Final = "Try more cells (tank.liquid.cells) or a smaller deceleration."


def run_excitation(
    scenario_file: Path,
    read_prescription: Callable[[], Prescription],
    overrides: Sequence[str] | None,
    output: Path | None,
    *,
    as_json: bool,
) -> ExitCode:
    """Compute, write and tell."""
    scenario = read_any_scenario(scenario_file, overrides)
    prescription = read_prescription()
    folder = excitation_folder(scenario, prescription, output, overrides, note)
    if scenario.tank.liquid.model in _KERNELS:
        announce_compilation("the liquid", 10, _KERNELS[scenario.tank.liquid.model])
    result = excited(prescription, scenario)
    if result.histories.time.size < 2:
        complain(f"failed: {result.reason}. {_REMEDY}")
        return ExitCode.NO_ANSWER
    answer, keeping = result.summary(), Keeping()
    if not as_json:
        _show(result, answer)
    files = result.keep(folder, keeping)
    if as_json:
        say_json(answer | {"warnings": [*result.warnings, *keeping.failures], "files": files})
        for warning in result.warnings:
            warn(warning)
    else:
        say(files_text(files))
    if result.reason:
        complain(f"failed: {result.reason}. {_REMEDY}")
    return told(keeping, ExitCode.NO_ANSWER if result.reason else ExitCode.DONE)


def _show(result: ExcitationResult, answer: dict[str, Any]) -> None:
    from rich.table import Table
    from rich.text import Text

    from slosh_cli.solver.excite import extreme

    found, tank = result.histories, result.scenario.tank
    number: Callable[[float, str], str] = lambda value, unit: f"{value:.5g} {unit}".rstrip()  # noqa: E731
    table = Table.grid(padding=(0, 2))
    table.title, table.title_justify, table.title_style = result.conditions, "left", "bold"
    room, depth = result.room, tank.height * tank.fill
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
