"""Scenario files to models and back."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from copy import deepcopy
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from slosh_cli.errors import Problem, ScenarioError
from slosh_cli.scenario.alias import rivals
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.diagnosis import diagnose
from slosh_cli.scenario.document import Document, Origin
from slosh_cli.scenario.document import Path as Place
from slosh_cli.scenario.given_modes import tank_of_file, with_own_coefficients
from slosh_cli.scenario.leaves import FROM_TEXT
from slosh_cli.scenario.packaged import packaged_scenarios
from slosh_cli.scenario.plain_data import plain_data, si_values, unfold_adhesion
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.scalars import well_formed
from slosh_cli.scenario.schema import OWN, Root, Scenario, TankScenario, stop_parts
from slosh_cli.scenario.source import text_of
from slosh_cli.scenario.tree import part_at
from slosh_cli.scenario.yaml_text import dump, parse, parse_override

R = TypeVar("R", Scenario, TankScenario)


def load_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario:
    """Read the scenario of a stop, from a file or, by its name where no such file exists, from the packaged ones.

    `overrides` are texts ``key.path=VALUE`` with VALUE in YAML; all are applied, in order, before anything
    is checked. Raises ScenarioError, which lists every mistake of the file and of the overrides.
    """
    document = _read(path, overrides)
    if _is_tank_alone(document.data):
        rule = f"must describe a stop, with {', '.join(stop_parts())} beside the tank"
        fix = "add them, or use the file where a tank alone will do"
        document.add(Finding((), rule, "a tank alone", fix))
        _finish(TankScenario, document, str(path))
    return _finish(Scenario, document, str(path))


def load_tank_scenario(path: str | Path, overrides: Iterable[str] = ()) -> TankScenario:
    """Read a tank: from a file with a tank alone, or from the scenario of a stop, checked as a whole.

    Overrides and errors as in load_scenario.
    """
    found = load_any_scenario(path, overrides)
    if isinstance(found, TankScenario):
        return found
    return TankScenario(format=found.format, name=found.name, description=found.description, tank=found.tank)


def load_any_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario | TankScenario:
    """Read a file of either kind: one with any of the wagon's parts is taken for a stop."""
    document = _read(path, overrides)
    if _is_tank_alone(document.data):
        return _finish(TankScenario, document, str(path))
    return _finish(Scenario, document, str(path))


def parse_scenario(text: str, name: str = "scenario") -> Scenario:
    """The scenario of a stop from YAML text, as `scenario_to_yaml` writes it; `name` stands for the file."""
    return _finish(Scenario, parse(text, name), name)


def load_document(path: str | Path) -> Document:
    """A YAML file that is no scenario (a study) as plain data with the line of every value.

    Raises ScenarioError where the text is no YAML; other mistakes are among the document's `problems`.
    """
    return parse(text_of(Path(path)), str(path))


def scenario_to_yaml(scenario: Scenario | TankScenario) -> str:
    """The resolved scenario as YAML, every quantity in SI units; it reads back as an equal scenario."""
    return dump(plain_data(scenario, as_text=True))


def replace(scenario: R, overrides: Mapping[str, Any]) -> R:
    """A copy of `scenario` with other values, checked like a file; `scenario` stays as it is.

    Keys are key paths. Numbers are SI values; texts are read as in a file (``"12 kN m"``, ``"computed"``).
    Raises ScenarioError, each problem placed at its key path.
    """
    parts = {key.partition(".")[0] for key in overrides}
    document = _overridden(scenario, parts, overrides)
    if not document.problems:
        with suppress(ValidationError):
            found = type(scenario).model_validate(document.data, context=FROM_TEXT)
            return with_own_coefficients(found, document, scenario.tank, scenario.name)
    document = _overridden(scenario, vars(scenario), overrides)
    found = _finish(type(scenario), document, scenario.name)
    return with_own_coefficients(found, document, scenario.tank, scenario.name)


def _overridden(scenario: Root, parts: Collection[str], overrides: Mapping[str, Any]) -> Document:
    """The scenario with its `parts` as plain data and overridden; the others, valid as they are, stay as they are."""
    values = vars(scenario).items()
    plain = {name: plain_data(part, as_text=False) for name, part in values if isinstance(part, Part) and name in parts}
    document = Document({**vars(scenario), **plain}, origins={(): Origin()})
    for key, value in overrides.items():
        if not _is_writable(document, key, key):
            continue
        if isinstance(value, str) and key not in ("name", "description"):
            _override(document, key, value, key)
        else:
            document.overrides.append(key)
            _drop_rival(document, tuple(key.split(".")))
            document.replace(tuple(key.split(".")), si_values(value), key)
    return document


def _is_tank_alone(data: Any) -> bool:
    return isinstance(data, dict) and "tank" in data and not any(part in data for part in stop_parts())


def _finish(model: type[R], document: Document, file: str) -> R:
    """The model of a document, or a ScenarioError with all its problems."""
    scenario = None
    if isinstance(document.data, dict):
        scenario, findings = diagnose(model, document.data)
        for finding in findings:
            document.add(finding)
    if scenario is None or document.problems:
        raise ScenarioError(file, document.sorted_problems())
    if document.original is None:
        return scenario
    return with_own_coefficients(scenario, document, tank_of_file(document, scenario.tank), file)


def _source(path: str | Path) -> Path:
    """The file itself; or the packaged scenario of that name, ``paper-80-liquid``, where there is no such file."""
    file = Path(path)
    is_name = file.name == str(path) and not file.suffix
    return packaged_scenarios().get(file.name, file) if is_name and not file.exists() else file


def _read(path: str | Path, overrides: Iterable[str]) -> Document:
    document = parse(text_of(_source(path)), str(path))
    overrides = tuple(overrides)
    if overrides:
        document.original = deepcopy(document.data)
    for override in overrides:
        key, equals, value = override.partition("=")
        key = key.strip()
        if not _is_writable(document, key, f"--set {key}") or (equals and key.startswith(OWN)):
            continue
        if equals and all(key.split(".")):
            _override(document, key, value, f"--set {key}")
            continue
        rule = "must be a key path, an equals sign and a value"
        fix = "write it like `--set 'braking.torque=12 kN m'`"
        document.overrides.append(f"--set {override}")
        document.problems.append(Problem(None, "", rule, f"`{override}`", fix, f"--set {override}"))
    return document


def _is_writable(document: Document, key: str, place: str) -> bool:
    """Whether a file could hold the key of an override; a problem where it could not."""
    spelt, lone = well_formed(key)
    if lone:
        document.overrides.append(place)
        fix = "write the key in UTF-8"
        document.problems.append(
            Problem(None, spelt, "must be text that can be written as UTF-8", f"`{lone}`", fix, place)
        )
    return not lone


def _override(document: Document, key: str, text: str, place: str) -> None:
    """Apply one override whose value is YAML text."""
    document.overrides.append(place)
    if not isinstance(document.data, dict):
        return
    path = tuple(key.split("."))
    value, problems = parse_override(text, path, place)
    document.problems += problems
    if value is None and problems:
        return
    unfold_adhesion(document.data, path)
    _drop_rival(document, path)
    document.replace(path, value, place)


def _drop_rival(document: Document, path: Place) -> None:
    """Where an override gives the diameter of a file that gives the radius, or the other way round, leave one.

    Both stay where both come from overrides; that is refused like both in a file.
    """
    for key, other in rivals(part_at(Scenario, document.data, path[:-1])):
        rival = (*path[:-1], other)
        if path[-1] == key and not document.origin(rival).override:
            document.remove(rival)
