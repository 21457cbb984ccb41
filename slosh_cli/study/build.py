"""A study from what a person asks for: a scenario or a study file, lists and ranges, models of the liquid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.scenario import Scenario, find_packaged, load_scenario
from slosh_cli.study.axis import Axis, values_of
from slosh_cli.study.plan import LIQUID, SOLID, SPEED, TORQUE, Study, with_axes
from slosh_cli.study.study_file import is_study_file, read_study_file

PAPER_WAGON: Final = "paper-80-liquid"
"""The packaged scenario that a study without one is about."""
PAPER_STUDY: Final = "paper-wagon"
"""Name of a study without a scenario."""
SPEEDS: Final = "80,160"
TORQUES: Final = "2.5:30:2.5"


@dataclass(frozen=True)
class Wishes:
    """A study as it is asked for on a command line; None where nothing was said.

    `speeds` in km/h and `torques` in kN m unless they carry a unit; `vary` are texts ``key.path=SPEC``.
    """

    file: Path | None = None
    overrides: Sequence[str] = ()
    speeds: str | None = None
    torques: str | None = None
    vary: Sequence[str] = ()
    liquids: str | None = None
    histories: bool = False


def build(wishes: Wishes) -> Study:
    """The study that is asked for.

    Without speeds, torques and anything else to vary it is the grid of the paper's Figure 3; speeds without torques,
    or torques without speeds, bring the other's range of that grid along. What is not varied is the scenario's own.
    Raises ScenarioError and UsageError for what is wrong with it, as far as that shows without running anything.
    """
    file, name, base, axes = _source(wishes)
    axes = with_axes(axes, [_parsed(text) for text in wishes.vary])
    axes = with_axes(axes, _braking_axes(wishes, axes))
    axes = (*(axis for axis in axes if axis.key != LIQUID), _liquid_axis(wishes, base, axes))
    return Study(name, base, axes, file, wishes.histories)


def paper_wagon() -> Scenario:
    """The wagon of the paper as it comes with the program."""
    return load_scenario(find_packaged(PAPER_WAGON))


def _source(wishes: Wishes) -> tuple[str, str, Scenario, tuple[Axis, ...]]:
    """What messages call the source, the study's name, the base scenario and the axes of a study file."""
    if wishes.file is None:
        wagon = load_scenario(find_packaged(PAPER_WAGON), wishes.overrides)
        return PAPER_STUDY, PAPER_STUDY if wagon.name == PAPER_WAGON else wagon.name, wagon, ()
    if is_study_file(wishes.file):
        study = read_study_file(wishes.file)
        return str(wishes.file), study.name, load_scenario(study.base, wishes.overrides), study.axes
    scenario = load_scenario(wishes.file, wishes.overrides)
    return str(wishes.file), scenario.name, scenario, ()


def _braking_axes(wishes: Wishes, axes: Sequence[Axis]) -> list[Axis]:
    """Speeds and torques: those asked for; those of Figure 3 where they complete it."""
    varied = {axis.key for axis in axes}
    for option, spec, key in (("--v0", wishes.speeds, SPEED), ("--torque", wishes.torques, TORQUE)):
        if spec is not None and any(text.partition("=")[0].strip() == key for text in wishes.vary):
            raise UsageError(f"{option} and --vary {key} ask for the same; leave one of them out", option)
    figure = (wishes.speeds, wishes.torques) != (None, None) or not axes
    speeds = SPEEDS if wishes.speeds is None and figure and SPEED not in varied else wishes.speeds
    torques = TORQUES if wishes.torques is None and figure and TORQUE not in varied else wishes.torques
    found = []
    if speeds is not None:
        found.append(_axis(SPEED, speeds, "--v0", "km/h"))
    if torques is not None:
        found.append(_axis(TORQUE, torques, "--torque", "kN m"))
    return found


def _liquid_axis(wishes: Wishes, base: Scenario, axes: Sequence[Axis]) -> Axis:
    """The models of the load: as asked for, else as varied otherwise, else the scenario's own and its solid."""
    known = next((axis for axis in axes if axis.key == LIQUID), None)
    if wishes.liquids is not None:
        return _axis(LIQUID, wishes.liquids, "--liquid")
    own = str(base.tank.liquid.model)
    return known or Axis(LIQUID, ("modal" if own == SOLID else own, SOLID), "--liquid")


def _parsed(text: str) -> Axis:
    key, equals, spec = text.partition("=")
    key = key.strip()
    if not equals or not all(key.split(".")):
        rule = "must be a key path, an equals sign and values"
        raise UsageError(f"--vary {rule}; given `{text}`; write it like `--vary tank.fill=0.2:0.9:0.1`", "--vary")
    return _axis(key, spec, f"--vary {key}")


def _axis(key: str, spec: str, option: str, bare_unit: str = "") -> Axis:
    try:
        return Axis(key, values_of(spec, bare_unit), option)
    except ValueRefused as refused:
        raise UsageError(f"{option} {refused}", option) from None
