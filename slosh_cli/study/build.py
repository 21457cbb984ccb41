"""A study from what a person asks for: a scenario or a study file, lists and ranges, models of the liquid."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from slosh_cli.errors import UsageError, ValueRefused
from slosh_cli.scenario import Braking, Scenario, find_packaged, load_scenario, parse_quantity, scenario_to_yaml
from slosh_cli.scenario.train_file import TrainScenario, is_train_file, load_train
from slosh_cli.scenario.yaml_text import parse
from slosh_cli.study.axis import Axis, axis_values, expanded, measured
from slosh_cli.study.plan import LIQUID, SOLID, SPEED, TORQUE, Study, TrainStudy, WagonStudy
from slosh_cli.study.study_file import is_study_file, read_study_file

_PAPER_WAGON: Final = "paper-80-liquid"
"""The packaged scenario that a study without one is about."""
_PAPER_STUDY: Final = "paper-wagon"
"""Name of a study without a scenario."""
_MOST_STOPS: Final = 200_000
_SPEEDS: Final = "80,160"
_TORQUES: Final = "2.5:30:2.5"
_AROUND_SPEED: Final = (0.75, 1.0, 1.25)
_AROUND_TORQUE: Final = (0.5, 0.75, 1.0, 1.25, 1.5, 2.0)
"""Parts of a scenario's own speed and torque that a study of it has where no ranges are asked for."""


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

    Without a scenario, speeds, torques and anything else to vary it is the grid of the paper's Figure 3; a scenario
    brings a few values around its own speed and torque instead. Speeds without torques, or torques without speeds,
    bring the other's range along. What is not varied is the scenario's own.
    Raises ScenarioError and UsageError for what is wrong with it, as far as that shows without running anything.
    """
    file, name, base, axes = _source(wishes.file, wishes.overrides)
    axes = _with_axes(axes, [_parsed(text) for text in wishes.vary])
    return _completed(wishes, file, name, base, axes)


def grid(
    scenario: Scenario | TrainScenario | str | Path | None = None,
    vary: Mapping[str, Any] | None = None,
    *,
    histories: bool = False,
) -> Study:
    """The study of a script: a scenario, or the file of a scenario or study, and `vary`, key path -> values.

    Values are a list or a range as a text, or a sequence; a number in it is an SI value. What is not given is completed
    as by `build`, and so are the errors.
    """
    file, name, base, axes = _source(scenario, ())
    axes = _with_axes(axes, [_given(base, key, spec) for key, spec in (vary or {}).items()])
    return _completed(Wishes(histories=histories), file, name, base, axes)


def _completed(wishes: Wishes, file: str, name: str, base: Scenario | TrainScenario, axes: tuple[Axis, ...]) -> Study:
    if isinstance(base, TrainScenario):
        asked = _train_axes(wishes, file, axes)
        return _feasible(TrainStudy(name, base, asked, file, wishes.histories, _kept(wishes.overrides, asked)))
    axes = _with_axes(axes, _braking_axes(wishes, base, axes, own=file != _PAPER_STUDY))
    axes = (*(axis for axis in axes if axis.key != LIQUID), _liquid_axis(wishes, base, axes))
    return _feasible(WagonStudy(name, base, axes, file, wishes.histories))


def _feasible(study: Study) -> Study:
    """The study, unless nobody can wait for it: it would take its time even to plan."""
    if study.size > _MOST_STOPS:
        longest = max(study.axes, key=lambda axis: len(axis.values))
        rule = f"must have at most {_MOST_STOPS:,} stops"
        fix = f"widen the steps, of `{longest.key}` first, which takes {len(longest.values):,} values"
        raise UsageError(f"the study {rule}; given {study.size:,}; {fix}, or make several studies of it", study.file)
    return study


def _train_axes(wishes: Wishes, file: str, axes: tuple[Axis, ...]) -> tuple[Axis, ...]:
    """What varies in a train: what was asked for. Raises UsageError for nothing, and for what each vehicle has."""
    for option, given, key in (("--torque", wishes.torques, TORQUE), ("--liquid", wishes.liquids, LIQUID)):
        if given is not None or any(axis.key == key for axis in axes):
            fix = f"write `--vary all.{key}=...`, or `vehicles.N.{key}` for the N-th from the front"
            raise UsageError(f"{file} is a train, whose vehicles have their own {key}; {fix}", option)
    _check_asked_once(wishes)
    if wishes.speeds is not None:
        axes = _with_axes(axes, [_axis(SPEED, wishes.speeds, "--v0", "km/h")])
    if not axes:
        fix = "write `--v0 60,80`, `--vary all.tank.fill=0.5,0.9` or `--vary coupling=screw,automatic`, say"
        raise UsageError(f"a study of a train needs something that varies; {fix}", file)
    return axes


def _kept(overrides: Sequence[str], axes: Iterable[Axis]) -> dict[str, str]:
    """What was set of single vehicles, which holds in every stop that changes all of them."""
    if not any(axis.key.startswith("all.") for axis in axes):
        return {}
    pairs = (text.partition("=") for text in overrides)
    return {key.strip(): value for key, _, value in pairs if key.strip().startswith("vehicles.")}


def _check_asked_once(wishes: Wishes) -> None:
    """Raise UsageError where speeds or torques are asked for by their option and by --vary."""
    for option, spec, key in (("--v0", wishes.speeds, SPEED), ("--torque", wishes.torques, TORQUE)):
        if spec is not None and any(text.partition("=")[0].strip() == key for text in wishes.vary):
            raise UsageError(f"{option} and --vary {key} ask for the same; leave one of them out", option)


def paper_wagon() -> Scenario:
    """The wagon of the paper as it comes with the program."""
    return load_scenario(find_packaged(_PAPER_WAGON))


def _source(
    source: Scenario | TrainScenario | str | Path | None, overrides: Sequence[str]
) -> tuple[str, str, Scenario | TrainScenario, tuple[Axis, ...]]:
    """What messages call the source, the study's name, the base scenario and the axes of a study file."""
    if source is None:
        wagon = load_scenario(find_packaged(_PAPER_WAGON), overrides)
        return _PAPER_STUDY, _PAPER_STUDY if wagon.name == _PAPER_WAGON else wagon.name, wagon, ()
    if isinstance(source, Scenario | TrainScenario):
        return source.name, source.name, source, ()
    if is_study_file(Path(source)):
        study = read_study_file(Path(source))
        return str(source), study.name, _loaded(study.base, overrides), study.axes
    scenario = _loaded(source, overrides)
    return str(source), scenario.name, scenario, ()


def _loaded(source: str | Path, overrides: Sequence[str]) -> Scenario | TrainScenario:
    """The scenario or the train of a file."""
    if is_train_file(Path(source)):
        return load_train(source, overrides)
    return load_scenario(source, overrides)


def _around(value: float, unit: str, parts: Sequence[float]) -> str | None:
    """``parts`` of an SI value as a list in `unit`, itself to the last digit; None where all of them were zero."""
    per, si, dimension = {"km/h": (1 / 3.6, "m/s", "speed"), "kN m": (1e3, "N m", "torque")}[unit]
    texts = [f"{part * value / per:.6g} {unit}" for part in parts]
    own = f"{value / per:.12g} {unit}"
    texts[parts.index(1.0)] = own if parse_quantity(own, dimension) == value else f"{value!r} {si}"
    return ",".join(texts) if value else None


def _braking_axes(wishes: Wishes, base: Scenario, axes: Sequence[Axis], *, own: bool) -> list[Axis]:
    """Speeds and torques: those asked for, completed by a few around the base's `own`, or by those of Figure 3.

    A brake that is told by anything but its torque, in the scenario or by an axis, stays what it is.
    """
    varied = {axis.key for axis in axes}
    rivals = {f"braking.{key}" for key in Braking.rivals("torque")}
    others = base.braking.torque is None or any(".".join(key.split(".")[:2]) in rivals for key in varied)
    _check_asked_once(wishes)
    figure = (wishes.speeds, wishes.torques) != (None, None) or not axes
    speeds, torques = wishes.speeds, wishes.torques
    if speeds is None and figure and SPEED not in varied:
        speeds = _around(base.braking.initial_speed, "km/h", _AROUND_SPEED) if own else _SPEEDS
    if torques is None and figure and TORQUE not in varied and not others:
        torques = _around(base.braking.torque or 0.0, "kN m", _AROUND_TORQUE) if own else _TORQUES
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
        return Axis(key, expanded(spec, bare_unit), option)
    except ValueRefused as refused:
        raise UsageError(f"{option} {refused}", option) from None


def _given(base: Scenario | TrainScenario, key: str, spec: Any) -> Axis:
    """The axis of a script's `spec`; arrays of NumPy will do."""
    found = spec.tolist() if hasattr(spec, "tolist") else spec
    entries = found if isinstance(found, list | tuple) else [found]
    try:
        return Axis(key, axis_values([_with_unit(base, key, entry) for entry in entries]), f"vary {key}")
    except ValueRefused as refused:
        raise UsageError(f"vary {key} {refused}", f"vary {key}") from None


def _with_unit(base: Scenario | TrainScenario, key: str, value: Any) -> Any:
    """A number with the SI unit in which the scenario tells its own value of `key`; anything else as it is."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    told = own_measure(base, key)
    return f"{value!r} {told[1]}".rstrip() if told else value


def own_measure(base: Scenario | TrainScenario, key: str) -> tuple[float, str] | None:
    """The scenario's own value of `key` in SI and its unit, empty for a pure number; None where it is no number."""
    root, steps = (base, key) if isinstance(base, Scenario) else base.spot(key)
    own: Any = parse(scenario_to_yaml(root), base.name).data
    for step in steps.split("."):
        own = own.get(step) if isinstance(own, dict) else None
    if isinstance(own, bool) or not isinstance(own, int | float | str):
        return None
    return measured(own) if isinstance(own, str) else (float(own), "")


def study_along(source: Scenario | TrainScenario | str | Path, key: str, overrides: Sequence[str] = ()) -> Study:
    """A study of a scenario or train, or of its file, in which nothing but `key` varies; its axis has no values yet.

    Raises UsageError for the file of a study, and the errors of a file that cannot be used.
    """
    file, name, base, axes = _source(source, overrides)
    if axes:
        raise UsageError(f"{file} is a study, which varies keys already; give the scenario of its `base:`", file)
    axis = (Axis(key, (), f"--vary {key}"),)
    if isinstance(base, TrainScenario):
        return TrainStudy(name, base, axis, file, kept=_kept(overrides, axis))
    return WagonStudy(name, base, axis, file)


def _with_axes(axes: Iterable[Axis], others: Iterable[Axis]) -> tuple[Axis, ...]:
    """`axes`, then `others`; one of these that shares its key with one of those takes its place."""
    found = {axis.key: axis for axis in axes}
    found |= {axis.key: axis for axis in others}
    return tuple(found.values())
