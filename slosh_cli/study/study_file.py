"""Studies kept in a file: `base:`, a scenario, and `vary:`, keys of it with the values they take.

name: fill-and-speed          # default: the file's own name
base: paper_80.yaml           # beside the study file, or a packaged scenario by name
vary:
  tank.fill: 0.2:0.9:0.1      # lists and ranges as on the command line,
  contact.adhesion: [dry, wet]  # or lists of YAML
liquid: [modal, rigid]        # default: the scenario's own model and rigid
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from slosh_cli.errors import Problem, ScenarioError, UsageError, ValueRefused
from slosh_cli.scenario import find_packaged, load_document
from slosh_cli.scenario.document import Document
from slosh_cli.scenario.source import text_of
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.words import NAME, file_safe
from slosh_cli.scenario.yaml_text import parse
from slosh_cli.study.axis import Axis, axis_values
from slosh_cli.study.plan import LIQUID

KEYS: Final = ("name", "description", "base", "vary", "liquid")

_MAYBE = re.compile(r"""\b(?:base|vary)["']?\s*:""")
_TELLING: Final = frozenset({"base", "vary"})
"""A scenario has neither of these keys."""


@dataclass(frozen=True)
class _StudyFile:
    """A study as its file tells it: name, path of the base scenario, axes in the order of the file."""

    name: str
    base: Path
    axes: tuple[Axis, ...]


def is_study_file(path: Path) -> bool:
    """Whether the file looks like a study, in YAML or JSON; False where it cannot be read at all."""
    try:
        text = text_of(path)
    except ScenarioError:
        return False
    if not _MAYBE.search(text):
        return False
    try:
        data = parse(text, str(path)).data
    except ScenarioError:  # no YAML: by its looks
        return any(line.startswith(tuple(_TELLING)) for line in text.splitlines())
    return isinstance(data, dict) and not _TELLING.isdisjoint(data)


def read_study_file(path: Path) -> _StudyFile:
    """Read a study file. Raises ScenarioError with every mistake and its line."""
    document = load_document(path)
    data = document.data if isinstance(document.data, dict) else {}
    reader = _Reader(path, document)
    for key in data:
        if key not in KEYS:
            near = difflib.get_close_matches(str(key), KEYS, 1)
            fix = f"write `{near[0]}`" if near else f"take it out; the keys here are {', '.join(KEYS)}"
            reader.problem((key,), "is not a key of a study", f"`{key}`", fix)
    study = _StudyFile(reader.name(data), reader.base(data), reader.axes(data))
    if document.problems:
        raise ScenarioError(str(path), document.sorted_problems())
    return study


class _Reader:
    """Takes the parts of a study out of its document and notes what is wrong with them."""

    def __init__(self, path: Path, document: Document) -> None:
        self._path = path
        self._document = document

    def problem(self, place: tuple[str | int, ...], rule: str, given: str, fix: str) -> None:
        line = self._document.origin(place).line
        self._document.problems.append(Problem(line, ".".join(map(str, place)), rule, given, fix))

    def name(self, data: Mapping[str, Any]) -> str:
        name = data.get("name", file_safe(self._path.stem) or "study")
        try:
            return str(NAME.parse(name))
        except ValueRefused as refused:
            self.problem(("name",), refused.rule, refused.given, refused.fix)
            return ""

    def base(self, data: Mapping[str, Any]) -> Path:
        given = data.get("base")
        rule = "must be the path of a scenario, or the name of a packaged one"
        if not isinstance(given, str) or not given:
            self.problem(("base",), rule, plain(given), "write `base: paper_80.yaml`")
            return self._path
        beside = self._path.parent / given
        if beside.exists():
            return beside
        try:
            return find_packaged(given)
        except UsageError as error:
            self.problem(("base",), rule, f"`{given}`, and there is no {beside}", error.message.rpartition("; ")[2])
            return self._path

    def axes(self, data: Mapping[str, Any]) -> tuple[Axis, ...]:
        vary = data.get("vary")
        if not isinstance(vary, dict) or not vary:
            rule = "must be a mapping of key paths to values"
            self.problem(("vary",), rule, plain(vary), "write `vary:` and under it `tank.fill: 0.2:0.9:0.1`, say")
            vary = {}
        found = [self._axis(("vary", key), str(key), spec) for key, spec in vary.items()]
        if "liquid" in data:
            found.append(self._axis(("liquid",), LIQUID, data["liquid"]))
        return tuple(axis for axis in found if axis is not None)

    def _axis(self, place: tuple[str, ...], key: str, spec: Any) -> Axis | None:
        try:
            return Axis(key, axis_values(spec), str(self._path), self._document.origin(place).line)
        except ValueRefused as refused:
            self.problem(place, refused.rule, refused.given, refused.fix)
            return None
