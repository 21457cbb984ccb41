"""Scenario files to models and back. The only module that imports yaml."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from copy import deepcopy
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, TypeVar

import yaml
from pydantic import ValidationError

from slosh_cli.errors import Problem, ScenarioError
from slosh_cli.scenario.alias import rivals
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.diagnosis import diagnose, part_at
from slosh_cli.scenario.document import Document, Origin
from slosh_cli.scenario.given_modes import tank_of_file, with_own_coefficients
from slosh_cli.scenario.leaves import FROM_TEXT
from slosh_cli.scenario.plain_data import plain_data, si_values, unfold_adhesion
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.scalars import plain_scalar
from slosh_cli.scenario.schema import Root, Scenario, TankScenario
from slosh_cli.scenario.source import text_of
from slosh_cli.scenario.units import plain

R = TypeVar("R", Scenario, TankScenario)
Place = tuple[str | int, ...]

MOST_VALUES: Final = 20_000
"""Values of a file with its aliases written out; stops a few lines from unfolding into gigabytes."""
_WAGON_PARTS: Final = ("wagon", "track", "contact", "braking")

_KNOWN_TAGS = {
    f"tag:yaml.org,2002:{name}"
    for name in ("null", "bool", "int", "float", "str", "timestamp", "map", "seq", "value", "merge")
}
_MERGE = "tag:yaml.org,2002:merge"


class _Builder:
    """Builds a Document from YAML nodes. Scalars follow YAML 1.2, so `on` is a word and `1e5` a number."""

    def __init__(self, document: Document, override: str = "") -> None:
        self.document = document
        self.override = override
        self.open: set[int] = set()
        self.count = 0

    def problem(self, node: yaml.Node, path: Place, rule: str, given: str, fix: str) -> None:
        line = None if self.override else node.start_mark.line + 1
        key = ".".join(str(step) for step in path)
        self.document.problems.append(Problem(line, key, rule, given, fix, self.override))

    def build(self, node: yaml.Node, path: Place, written_at: yaml.Node) -> Any:
        """Plain data of `node`; its origin is the line of `written_at`, the key that names it."""
        self.count += 1
        line = None if self.override else written_at.start_mark.line + 1
        self.document.origins[path] = Origin(line, self.override)
        looped = id(node) in self.open
        if looped or self.count > MOST_VALUES:
            if looped or self.count == MOST_VALUES + 1:
                rule = f"must be a tree of at most {MOST_VALUES} values"
                given = "an alias that contains itself" if looped else "more, by aliases or written out"
                self.problem(written_at, path, rule, given, "write the values out where they belong")
            return None
        if node.tag not in _KNOWN_TAGS:
            rule = "must be plain text, number, list or mapping"
            self.problem(node, path, rule, f"the tag `{node.tag}`", "leave out the tag")
            return None
        self.open.add(id(node))
        try:
            if isinstance(node, yaml.MappingNode):
                return self._mapping(node, path)
            if isinstance(node, yaml.SequenceNode):
                return [self.build(item, (*path, index), item) for index, item in enumerate(node.value)]
            quoted = isinstance(node, yaml.ScalarNode) and node.style is not None
            return str(node.value) if quoted else plain_scalar(str(node.value))
        finally:
            self.open.discard(id(node))

    def _mapping(self, node: yaml.MappingNode, path: Place) -> dict[str, Any]:
        result: dict[str, Any] = {}
        first: dict[str, int] = {}
        merged: list[yaml.Node] = []
        for key, value in node.value:
            name, line = str(key.value), key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode):
                given = "a key that is a list or mapping"
                self.problem(key, path, "must have words as keys", given, "write a word before the colon")
            elif name in first:
                given = f"`{name}` again" if self.override else f"`{name}` on lines {first[name]} and {line}"
                self.problem(key, (*path, name), "must be given once", given, "keep one of them")
            elif key.tag == _MERGE:
                merged += value.value if isinstance(value, yaml.SequenceNode) else [value]
            else:
                result[name] = self.build(value, (*path, name), key)
            first.setdefault(name, line)
        for source in merged:
            self._merge(source, path, result)
        return result

    def _merge(self, source: yaml.Node, path: Place, result: dict[str, Any]) -> None:
        """YAML's `<<`: the keys of `source` that are not there yet, each from its own line."""
        if not isinstance(source, yaml.MappingNode) or id(source) in self.open:
            rule, fix = "must be an alias of another mapping", "write `<<: *name` for an anchor `&name` above"
            self.problem(source, (*path, "<<"), rule, "something else", fix)
            return
        inner = _Builder(Document(), self.override)
        inner.open, inner.count = self.open, self.count
        values = inner.build(source, path, source) or {}
        self.count = inner.count
        self.document.problems += inner.document.problems
        for name in [name for name in values if name not in result]:
            result[name] = values[name]
            place = (*path, name)
            origins = inner.document.origins
            self.document.origins.update({key: origins[key] for key in origins if key[: len(place)] == place})


def load_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario:
    """Read the scenario of a stop.

    `overrides` are texts ``key.path=VALUE`` with VALUE in YAML; all are applied, in order, before anything
    is checked. Raises ScenarioError, which lists every mistake of the file and of the overrides.
    """
    document = _read(path, overrides)
    if _is_tank_alone(document.data):
        rule = f"must describe a stop, with {', '.join(_WAGON_PARTS)} beside the tank"
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
    return _finish(Scenario, _parse(text, name), name)


def load_document(path: str | Path) -> Document:
    """A YAML file that is no scenario (a study) as plain data with the line of every value.

    Raises ScenarioError where the text is no YAML; other mistakes are among the document's `problems`.
    """
    return _parse(text_of(Path(path)), str(path))


def scenario_to_yaml(scenario: Scenario | TankScenario) -> str:
    """The resolved scenario as YAML, every quantity in SI units; it reads back as an equal scenario."""
    data = plain_data(scenario, as_text=True)
    return yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110)


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
        if isinstance(value, str) and key not in ("name", "description"):
            _override(document, key, value, key)
        else:
            document.overrides.append(key)
            _drop_rival(document, tuple(key.split(".")))
            document.replace(tuple(key.split(".")), si_values(value), key)
    return document


def _is_tank_alone(data: Any) -> bool:
    return isinstance(data, dict) and "tank" in data and not any(part in data for part in _WAGON_PARTS)


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


def _read(path: str | Path, overrides: Iterable[str]) -> Document:
    document = _parse(text_of(Path(path)), str(path))
    overrides = tuple(overrides)
    if overrides:
        document.original = deepcopy(document.data)
    for override in overrides:
        key, equals, value = override.partition("=")
        key = key.strip()
        if equals and all(key.split(".")):
            _override(document, key, value, f"--set {key}")
            continue
        rule = "must be a key path, an equals sign and a value"
        fix = "write it like `--set 'braking.torque=12 kN m'`"
        document.overrides.append(f"--set {override}")
        document.problems.append(Problem(None, "", rule, f"`{override}`", fix, f"--set {override}"))
    return document


@lru_cache(maxsize=256)
def _node_of(text: str) -> yaml.Node | None:
    """The node of a value's text; a study gives the same few texts again and again."""
    return yaml.SafeLoader(text).get_single_node()


def _override(document: Document, key: str, text: str, place: str) -> None:
    """Apply one override whose value is YAML text."""
    document.overrides.append(place)
    if not isinstance(document.data, dict):
        return
    path = tuple(key.split("."))
    inner = Document()
    try:
        node = _node_of(text)
        value = _Builder(inner, place).build(node, path, node) if node is not None else None
    except (yaml.YAMLError, RecursionError) as error:
        rule, given, fix = _syntax(error, text)[1:]
        document.problems.append(Problem(None, key, rule, given, fix, place))
        return
    document.problems += inner.problems
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


def _parse(text: str, file: str) -> Document:
    """The document of a YAML text; ScenarioError where the text is no YAML or no mapping."""
    document = Document()
    problem = None
    node = None
    try:
        node = yaml.SafeLoader(text).get_single_node()
        if node is not None:
            document.data = _Builder(document).build(node, (), node)
    except (yaml.YAMLError, RecursionError) as error:
        line, *words = _syntax(error, text)
        problem = Problem(line, "", *words)
    if problem is not None:  # raised out here, without the context: a RecursionError's is too deep to be pickled
        raise ScenarioError(file, (problem,))
    if not isinstance(document.data, dict) and not document.problems:
        given = "an empty file" if node is None else plain(document.data)
        fix = "write `format: 1`, `name: ...` and so on, or start from `slosh init`"
        rule = "must be a mapping of keys to values"
        document.problems.append(Problem(None if node is None else node.start_mark.line + 1, "", rule, given, fix))
    return document


def _syntax(error: Exception, text: str) -> tuple[int | None, str, str, str]:
    """(line, rule, given, fix) of text that is not YAML."""
    rule = "must be valid YAML"
    if isinstance(error, yaml.reader.ReaderError):
        character = error.character if isinstance(error.character, str) else chr(error.character)
        return (
            text.count("\n", 0, error.position) + 1,
            rule,
            f"the control character {character!r}",
            "take it out",
        )
    if not isinstance(error, yaml.MarkedYAMLError):
        return None, rule, "lists or mappings nested too deeply", "write the values out where they belong"
    mark = error.problem_mark or error.context_mark
    begun = error.context_mark
    given = " ".join(str(error.problem or error.context).split())
    if begun and mark and begun.line != mark.line:
        given += f" ({error.context}, begun on line {begun.line + 1})"
    fix = "close what was opened and check colons, quotes and indentation"
    if "'\\t'" in given:
        fix = "indent with spaces, not tabs"
    elif "single document" in str(error.context):
        fix = "keep one scenario to a file"
    elif "undefined alias" in given:
        fix = "define the anchor (`&name`) before it is used"
    return (mark.line + 1 if mark else None), rule, given, fix
