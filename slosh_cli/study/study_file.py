"""Studies kept in a file: `base:`, a scenario, and `vary:`, keys of it with the values they take.

name: fill-and-speed          # default: the file's own name
base: paper_80.yaml           # beside the study file, or a packaged scenario by name
vary:
  tank.fill: 0.2:0.9:0.1      # lists and ranges as on the command line,
  contact.adhesion: [dry, wet]  # or lists of YAML
liquid: [modal, rigid]        # default: the scenario's own model and rigid
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import Field

from slosh_cli.errors import ScenarioError, UsageError, ValueRefused
from slosh_cli.scenario import find_packaged, load_document
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.diagnosis import diagnose
from slosh_cli.scenario.document import Document
from slosh_cli.scenario.leaves import Judge, Leaf
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.source import text_of
from slosh_cli.scenario.tree import value_at
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.words import NAME, file_safe
from slosh_cli.scenario.yaml_text import parse
from slosh_cli.study.axis import Axis, axis_values
from slosh_cli.study.plan import LIQUID

_BASE: Final = "must be the path of a scenario, or the name of a packaged one"
_MAYBE = re.compile(r"""\b(?:base|vary)["']?\s*:""")
_TELLING: Final = frozenset({"base", "vary"})
"""A scenario has neither of these keys."""


@dataclass(frozen=True)
class _Base(Leaf):
    def parse(self, value: object) -> str:
        if isinstance(value, str) and value:
            return value
        raise ValueRefused(_BASE, plain(value), "write `base: paper_80.yaml`")

    def json_schema(self) -> dict[str, Any]:
        return {"type": "string", "minLength": 1}


@dataclass(frozen=True)
class _Vary(Judge):
    def parse(self, value: object) -> Any:
        if isinstance(value, dict) and value:
            return value
        fix = "write `vary:` and under it `tank.fill: 0.2:0.9:0.1`, say"
        raise ValueRefused("must be a mapping of key paths to values", plain(value), fix)


@dataclass(frozen=True)
class _Values(Leaf):
    def parse(self, value: object) -> tuple[str, ...]:
        return axis_values(value)

    def json_schema(self) -> dict[str, Any]:
        single = {"type": ["string", "number", "boolean", "object"]}
        return {"anyOf": [single, {"type": "array", "minItems": 1}]}


class StudyKeys(Part):
    """What a study file may say."""

    noun = "study"

    name: Annotated[str | None, NAME] = Field(
        default=None, description="Name of the study, and of its folder. Default: the file's own."
    )
    description: Any = Field(default="", description="What the study is about.")
    base: Annotated[str | None, _Base()] = Field(
        default=None,
        validate_default=True,
        description="Path of the scenario, from this file; or the name of a packaged one.",
    )
    vary: Annotated[dict[str, Annotated[tuple[str, ...], _Values()]], _Vary()] = Field(
        default=None,
        validate_default=True,
        description="Keys of the scenario with the values they take: a list, or a range `start:stop:step`.",
    )
    liquid: Annotated[tuple[str, ...] | None, _Values()] = Field(
        default=None, description="Models of the load. Default: the scenario's own and rigid."
    )


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
    keys, findings = diagnose(StudyKeys, document.data if isinstance(document.data, dict) else {})
    for finding in findings:
        document.add(finding)
    base = _base(path, document)
    if keys is None or base is None or document.problems:
        raise ScenarioError(str(path), document.sorted_problems())
    found: list[tuple[str, tuple[str, ...], tuple[str, ...]]]
    found = [(key, ("vary", key), values) for key, values in keys.vary.items()]
    if keys.liquid is not None:
        found.append((LIQUID, ("liquid",), keys.liquid))
    axes = [Axis(key, values, str(path), document.origin(place).line) for key, place, values in found]
    return _StudyFile(keys.name or file_safe(path.stem) or "study", base, tuple(axes))


def _base(path: Path, document: Document) -> Path | None:
    """The file of the base scenario; None, with a problem where one is named, where there is none."""
    given = value_at(document.data, ("base",))
    if not isinstance(given, str) or not given:
        return None
    beside = path.parent / given
    if os.path.exists(beside):
        return beside
    try:
        return find_packaged(given)
    except UsageError as error:
        fix = error.message.rpartition("; ")[2]
        document.add(Finding(("base",), _BASE, f"`{given}`, and there is no {beside}", fix))
        return None
