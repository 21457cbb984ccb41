"""`slosh tank`: the tank alone; its slosh modes, its answer to a deceleration, its modes against the filling."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import AsJson, OutputFolder, Overrides, ScenarioFile, option
from slosh_cli.cli.output import complain, note, say, say_json, warn
from slosh_cli.errors import UsageError, ValueRefused

if TYPE_CHECKING:
    from slosh_cli.application.excitation import ExcitationResult

_HELP: Final = """The tank alone: modes, forces under a deceleration, charts.

Takes the scenario of a stop or of a tank alone.
"""
_KERNELS: Final = {"modal": "excite_kernels.modal_history", "shallow-water": "excite_kernels.cells_history"}
_REMEDY: Final = "Try more cells (tank.liquid.cells) or a smaller deceleration."
_ALL: Final = "0.05:0.95:0.05"
"""Fillings that are shown when none are asked for."""
_LEAST, _MOST = 0.02, 0.995
"""Fillings that the finite elements can represent."""

_MODES: Final = "How many odd longitudinal modes (n = 1, 3, 5, ...). Default: as many as the scenario states."
_Modes = Annotated[int | None, option("--modes", "N", _MODES, min=1, max=20)]
_PICTURES: Final = "Folder for a table (CSV) and pictures of the modes. Default: none are written."
_LEVEL: Final = "Deceleration to reach, such as '0.2 g'."
_RAMP: Final = "Reach it linearly within this time, then hold it. Default: at once."
_MOTION: Final = (
    "Motion of the tank instead: columns time_s and displacement_m, velocity_m_s or acceleration_m_s2, forward."
)
_START: Final = "With a motion: the liquid is at `rest` as it begins, or `moving` with the tank. Default: rest."
_PROBE: Final = "Tell the surface at this distance from the rear wall, such as '0.05 m'; may be repeated."
_COURSE: Final = "Deceleration over time instead: columns time_s and deceleration_m_s2, linear in between."

tank_command = typer.Typer(help=_HELP, rich_markup_mode=None, no_args_is_help=True)


@tank_command.command("coefficients")
def _coefficients(
    scenario_file: ScenarioFile,
    modes: _Modes = None,
    overrides: Overrides = None,
    output: Annotated[Path | None, option("--output -o", "DIR", _PICTURES)] = None,
    as_json: AsJson = False,
) -> ExitCode:
    """Slosh modes of the geometry, beside the scenario's own."""
    from slosh_cli.application.keeping import Keeping
    from slosh_cli.application.tank import COEFFICIENTS_TABLE, coefficients
    from slosh_cli.cli.keeping import files_text, told
    from slosh_cli.cli.reading import load_given
    from slosh_cli.cli.tank_output import show_coefficients
    from slosh_cli.results.files import try_targets
    from slosh_cli.scenario import load_any_scenario

    scenario = load_given(load_any_scenario, scenario_file, overrides)
    if output is not None:
        try_targets(output, (COEFFICIENTS_TABLE,))
    found, keeping = coefficients(scenario, modes), Keeping()
    if not as_json:
        show_coefficients(found)
    files = found.keep(output, keeping) if output is not None else {}
    if as_json:
        say_json(found.summary() | {"warnings": [*found.warnings, *keeping.failures], "files": files})
        for warning in found.warnings:
            warn(warning)
    elif files:
        say(files_text(files))
    return told(keeping)


@tank_command.command("excite")
def _excite(
    scenario_file: ScenarioFile,
    deceleration: Annotated[str | None, option("--deceleration", "A", _LEVEL)] = None,
    ramp: Annotated[str | None, option("--ramp", "TIME", _RAMP)] = None,
    duration: Annotated[str, typer.Option("--duration", metavar="TIME", help="Duration of the excitation.")] = "40 s",
    table: Annotated[Path | None, option("--table", "FILE.csv", _COURSE)] = None,
    interval: Annotated[str, typer.Option("--interval", metavar="TIME", help="Time between rows.")] = "10 ms",
    motion: Annotated[Path | None, option("--motion", "FILE.csv", _MOTION)] = None,
    start: Annotated[str | None, option("--start", "HOW", _START)] = None,
    probe: Annotated[list[str] | None, option("--probe", "PLACE", _PROBE)] = None,
    overrides: Overrides = None,
    output: OutputFolder = None,
    as_json: AsJson = False,
) -> ExitCode:
    """Decelerate the tank: force, moment, surface over time.

    The tank does not pitch; the liquid model is the scenario's. Writes excite.csv, excite.h5 and a figure.
    """
    from slosh_cli.application.excitation import EXCITATION_FILES, excited
    from slosh_cli.application.keeping import folder_of_run
    from slosh_cli.application.prescription import Prescription
    from slosh_cli.cli.progress import announce_kernel
    from slosh_cli.cli.reading import load_given
    from slosh_cli.scenario import load_any_scenario

    scenario = load_given(load_any_scenario, scenario_file, overrides)
    prescription = Prescription.read(
        deceleration, ramp, duration, table, interval, "--{}".format, motion, start, probe or ()
    )
    folder = folder_of_run(scenario, output, overrides, EXCITATION_FILES, note, prescription.settings)
    if scenario.tank.liquid.model in _KERNELS:
        announce_kernel("the liquid", 10, _KERNELS[scenario.tank.liquid.model])
    return _tell(excited(prescription, scenario), folder, as_json=as_json)


def _tell(result: "ExcitationResult", folder: Path, *, as_json: bool) -> ExitCode:
    """Tell and keep what the liquid did."""
    from slosh_cli.application.keeping import Keeping
    from slosh_cli.cli.keeping import files_text, told
    from slosh_cli.cli.tank_output import show_excitation

    failure = f"failed: {result.reason}. {_REMEDY}"
    if result.histories.time.size < 2:
        complain(failure)
        return ExitCode.NO_ANSWER
    answer, keeping = result.summary(), Keeping()
    if not as_json:
        show_excitation(result, answer)
    files = result.keep(folder, keeping)
    if as_json:
        say_json(answer | {"warnings": [*result.warnings, *keeping.failures], "files": files})
        for warning in result.warnings:
            warn(warning)
    else:
        say(files_text(files))
    if result.reason:
        complain(failure)
    return told(keeping, ExitCode.NO_ANSWER if result.reason else ExitCode.DONE)


@tank_command.command("chart")
def _chart(
    scenario_file: ScenarioFile,
    fills: Annotated[
        str, typer.Option("--fills", metavar="LIST", help="Fillings (depth over height): a list or a range.")
    ] = _ALL,
    modes: _Modes = None,
    overrides: Overrides = None,
    output: OutputFolder = None,
    as_json: AsJson = False,
) -> ExitCode:
    """Frequency, mass and height of modes against filling."""
    from slosh_cli.application.keeping import Keeping
    from slosh_cli.application.tank import chart_fills, chart_folder
    from slosh_cli.cli.keeping import files_text, told
    from slosh_cli.cli.progress import counting
    from slosh_cli.cli.reading import load_given
    from slosh_cli.scenario import load_any_scenario

    scenario = load_given(load_any_scenario, scenario_file, overrides)
    levels = _read_fills(fills)
    folder = chart_folder(scenario, output, [*(overrides or ()), *([f"fills={fills}"] if fills != _ALL else [])])
    with counting("fillings") as progress:
        found = chart_fills(scenario, levels, modes, progress)
    skipped = [f"filling {level:g} is left out: {reason}" for level, reason in found.skipped.items()]
    rows, keeping = found.rows(), Keeping()
    if not rows:
        raise UsageError(f"no filling could be represented: {'; '.join(found.skipped.values())}", "--fills")
    if not as_json:
        numbers = ", ".join(map(str, found.chart.numbers))
        say(f"{scenario.name}: {len(levels) - len(skipped)} fillings, n = {numbers}")
    files = found.keep(folder, keeping)
    if as_json:
        say_json({"name": scenario.name, "rows": rows, "warnings": [*skipped, *keeping.failures], "files": files})
    else:
        say(files_text(files))
    for line in skipped:
        warn(line)
    return told(keeping)


def _read_fills(text: str) -> list[float]:
    """Fillings of a list or a range, in increasing order. Raises UsageError."""
    from slosh_cli.study.axis import expanded

    rule = f"--fills must be numbers between {_LEAST} and {_MOST}, such as `0.05:0.95:0.05` or `0.2,0.5`"
    try:
        fills = sorted({float(value) for value in expanded(text)})
    except ValueRefused as refused:
        raise UsageError(f"--fills {refused}", "--fills") from refused
    except ValueError as error:
        raise UsageError(f"{rule}; given `{text}`", "--fills") from error
    if not all(_LEAST <= fill <= _MOST for fill in fills):
        raise UsageError(f"{rule}; given `{text}`", "--fills")
    return fills
