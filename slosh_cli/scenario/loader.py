"""Scenario files to models and back, whatever the files describe."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from slosh_cli.errors import Problem, ScenarioError, ValueRefused
from slosh_cli.scenario.base import OWN, Part
from slosh_cli.scenario.diagnosis import diagnose
from slosh_cli.scenario.document import Document, Origin
from slosh_cli.scenario.leaves import Leaf
from slosh_cli.scenario.packaged import packaged_scenarios
from slosh_cli.scenario.plain_data import plain_data, si_values
from slosh_cli.scenario.presets import TAKEN, expand
from slosh_cli.scenario.rules import Values
from slosh_cli.scenario.scalars import well_formed
from slosh_cli.scenario.source import text_of
from slosh_cli.scenario.tree import Spot
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.words import NAME, Text
from slosh_cli.scenario.yaml_text import dump, parse, parse_override


@dataclass(frozen=True)
class _Version(Leaf):
    """The version of the scenario format."""

    supported: int

    def sample(self) -> str:
        return str(self.supported)

    def advice(self, key: str) -> str:
        return f"write `{key}: {self.supported}`"

    def parse(self, value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int | float) or value != self.supported:
            rule = f"must be {self.supported}, the only scenario format this version reads"
            raise ValueRefused(rule, plain(value), f"write `{self.supported}`")
        return self.supported

    def json_schema(self) -> dict[str, Any]:
        return {"const": self.supported}


class _Taken(Leaf):
    """Which preset gave the value at a key path."""

    def sample(self) -> str:
        return "{tank.length: zacns-like}"

    def advice(self, key: str) -> str:
        return f"write `{key}: {self.sample()}`, or leave it out"

    def parse(self, value: object) -> Any:
        if isinstance(value, dict) and all(isinstance(name, str) for name in value.values()):
            return value
        raise ValueRefused("must be a mapping of key paths to names of presets", plain(value), "leave it out")

    def json_schema(self) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": {"type": "string"}}


class Root(Part):
    """What every scenario file begins with."""

    noun: ClassVar[str] = "scenario"

    format: Annotated[int, _Version(1)] = Field(description="Version of the scenario format: 1.")
    name: Annotated[str, NAME] = Field(description="Short name of the scenario; results are kept in a folder of it.")
    description: Annotated[str, Text(longest=2000)] = Field(
        default="", description="What the scenario is, in a sentence or two."
    )
    presets: Annotated[dict[str, Any], _Taken()] = Field(
        default={}, description="What came from presets, key path to name; resolved scenarios state it."
    )

    def unwritten(self, *, as_text: bool) -> Collection[str]:  # noqa: ARG002 - the same for both
        """What came from presets, where nothing did."""
        return () if self.presets else (TAKEN,)

    @classmethod
    def of(cls, document: Document, file: str) -> Self:
        """The model of a document, or a ScenarioError with all its problems; `file` is what these name."""
        found = None
        if isinstance(document.data, dict):
            found, findings = diagnose(cls, document.data, document.written)
            for finding in findings:
                document.add(finding)
        if found is None or document.problems:
            raise ScenarioError(file, document.sorted_problems())
        return found if document.original is None else found.after_overrides(document, None, file)

    def with_(self, overrides: Mapping[str, Any]) -> Self:
        """A copy with other values, checked like a file; the original stays as it is.

        Keys are key paths. Numbers are SI values; texts are read as in a file (``"12 kN m"``, ``"computed"``).
        Raises ScenarioError, each problem placed at its key path.
        """
        changed = {key.partition(".")[0] for key in overrides}
        document = self._overridden(overrides, [name for name in vars(self) if name not in changed])
        if not document.problems:
            with suppress(ValidationError):
                return self.from_text(document.data).after_overrides(document, self, self.name)
        document = self._overridden(overrides, ())
        return self.of(document, self.name).after_overrides(document, self, self.name)

    def after_overrides(self, document: Document, before: Self | None, file: str) -> Self:  # noqa: ARG002 - roots say it
        """What a file becomes that was sound but for what the overrides of `document` leave behind.

        `before` is the sound one without them; None where `document` has its data. May raise ScenarioError.
        """
        return self

    @model_validator(mode="after")
    def _check_rules(self) -> Self:
        values = Values()
        values.add(self)
        findings = tuple(values.broken())
        if findings:
            text = "; ".join(f"{'.'.join(map(str, f.path))} {f.rule}" for f in findings)
            raise PydanticCustomError("rules", "{text}", {"text": text, "findings": findings})
        return self

    def _overridden(self, overrides: Mapping[str, Any], kept: Collection[str]) -> Document:
        """The scenario as plain data and overridden; the parts that are `kept`, valid as they are, stay so."""
        document = Document(plain_data(self, as_text=False, kept=kept), origins={(): Origin()})
        for key, value in overrides.items():
            if not _is_writable(document, key, key):
                continue
            path = tuple(key.split("."))
            spot = Spot(part=type(self)).at(document.data, path)
            if isinstance(value, str) and not (spot and isinstance(spot.leaf, Text)):
                _override(document, type(self), key, value, key)
            else:
                _put(document, type(self), path, si_values(value), key)
        expand(document, type(self))
        return document


def read(path: str | Path, overrides: Iterable[str], kind: Callable[[Any], type[Root]]) -> Document:
    """A scenario file, or the packaged one of that name where there is no such file, with overrides applied.

    `overrides` are texts ``key.path=VALUE`` with VALUE in YAML; `kind` tells by its data what a file describes.
    Raises ScenarioError where the text is no YAML; other mistakes are among the document's `problems`.
    """
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
            _override(document, kind(document.data), key, value, f"--set {key}")
            continue
        rule = "must be a key path, an equals sign and a value"
        fix = "write it like `--set 'braking.torque=12 kN m'`"
        document.overrides.append(f"--set {override}")
        document.problems.append(Problem(None, "", rule, f"`{override}`", fix, f"--set {override}"))
    expand(document, kind(document.data))
    return document


def load_document(path: str | Path) -> Document:
    """A YAML file that is no scenario (a study) as plain data with the line of every value.

    Raises ScenarioError where the text is no YAML; other mistakes are among the document's `problems`.
    """
    return parse(text_of(Path(path)), str(path))


def scenario_to_yaml(scenario: Root) -> str:
    """The resolved scenario as YAML, every quantity in SI units; it reads back as an equal scenario."""
    return dump(plain_data(scenario, as_text=True))


def _source(path: str | Path) -> Path:
    """The file itself; or the packaged scenario of that name, ``paper-80-liquid``, where there is no such file."""
    file = Path(path)
    is_name = file.name == str(path) and not file.suffix
    return packaged_scenarios().get(file.name, file) if is_name and not os.path.exists(file) else file


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


def _override(document: Document, model: type[Part], key: str, text: str, place: str) -> None:
    """Apply one override whose value is YAML text."""
    if not isinstance(document.data, dict):
        document.overrides.append(place)
        return
    path = tuple(key.split("."))
    value, problems = parse_override(text, path, place)
    document.problems += problems
    if value is None and problems:
        document.overrides.append(place)
        return
    _put(document, model, path, value, place)


def _put(document: Document, model: type[Part], path: tuple[str, ...], value: Any, place: str) -> None:
    """Put the value of an override into the data, and make room for it.

    Parts on the way that are given in short, by a word or one value, are written out as mappings. Of keys that exclude
    the one given, those of the file go; those of overrides stay and are refused like both in a file.
    """
    document.overrides.append(place)
    normal, root = document.normal(path), Spot(part=model)
    ways = list(root.way(document.data, normal[:-1]))
    for end, (spot, inner) in enumerate(ways):
        part = spot.short.part(inner) if spot and spot.short else None
        if part is not None:
            ways[end - 1][1][normal[end - 1]] = plain_data(part, as_text=True)
            ways = list(root.way(document.data, normal[:-1]))
            break
    for end, (spot, inner) in enumerate(ways):
        chosen = spot.chosen(inner) if spot and isinstance(inner, dict) else None
        for other in chosen.part.rivals(path[end]) if chosen and chosen.part else ():
            if not document.overridden((*normal[:end], other)):
                document.remove((*normal[:end], other))
    document.replace(path, value, place)
