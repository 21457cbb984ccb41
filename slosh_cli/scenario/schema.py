"""A whole scenario: a tank wagon on a track and its stop, or a tank alone."""

from collections.abc import Iterable
from functools import reduce
from pathlib import Path
from typing import Any, Self

from pydantic import Field, model_validator

from slosh_cli.scenario.amounts import tare_of
from slosh_cli.scenario.base import USE, Part
from slosh_cli.scenario.document import Document
from slosh_cli.scenario.leaves import Quantity
from slosh_cli.scenario.loader import Root, read
from slosh_cli.scenario.presets import DEFAULT, expand, find_preset, is_usual
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.schema_brake import Braking
from slosh_cli.scenario.schema_limits import Limits
from slosh_cli.scenario.schema_line import file_beside
from slosh_cli.scenario.schema_modes import with_own_coefficients
from slosh_cli.scenario.schema_rules import ALONE_RULES, STOP_RULES
from slosh_cli.scenario.schema_run import Contact, Output, Solver, Track
from slosh_cli.scenario.schema_tank import Tank
from slosh_cli.scenario.schema_wagon import Wagon
from slosh_cli.scenario.tree import spot_of, value_at
from slosh_cli.scenario.units import shown
from slosh_cli.scenario.yaml_text import parse


class TankScenario(Root):
    """A tank alone. Every quantity is SI inside."""

    rules = ALONE_RULES

    tank: Tank = Field(description="The tank and what is in it.")
    limits: Limits = Field(default=Limits.model_construct(), description="What verdicts hold the tank against.")

    @model_validator(mode="after")
    def _load(self) -> Self:
        vars(self)["tank"] = self.tank.loaded(None)
        return self

    def after_overrides(self, document: Document, before: Self | None, file: str) -> Self:
        tank = with_own_coefficients(self.tank, document, before.tank if before else None, file)
        return self.model_copy(update={"tank": tank})


class Scenario(Root):
    """One stop of a tank wagon. Values are of the whole wagon; every quantity is SI inside."""

    rules = STOP_RULES
    has_usual = True

    wagon: Wagon = Field(description="The wagon without its load.")
    tank: Tank = Field(description="The tank and what is in it.")
    track: Track = Field(description="The track under one rail.")
    contact: Contact = Field(description="The contact of wheel and rail.")
    braking: Braking = Field(description="The stop: speed, torque and when.")
    solver: Solver = Field(default=Solver.model_construct(), description="Accuracy and patience.")
    output: Output = Field(default=Output.model_construct(), description="What is written.")
    limits: Limits = Field(default=Limits.model_construct(), description="What verdicts hold the wagon against.")

    @model_validator(mode="after")
    def _load(self) -> Self:
        vars(self)["tank"] = self.tank.loaded(tare_of(self.wagon))
        return self

    def after_overrides(self, document: Document, before: Self | None, file: str) -> Self:
        tank = with_own_coefficients(self.tank, document, before.tank if before else None, file)
        return self.model_copy(update={"tank": tank})

    @property
    def defaults(self) -> dict[str, str]:
        """Values that the file leaves to the program, as texts by their key paths; `computed` where there is no one."""
        taken = [key for key, name in self.presets.items() if name == DEFAULT]
        found = {key: self._text(tuple(key.split("."))) for key in taken}
        for above in (("track", "domain"), ("solver",)):
            part: Any = reduce(getattr, above, self)
            usual = {name: entry.default for name, entry in type(part).model_fields.items()}
            same = [name for name, value in usual.items() if getattr(part, name) == value]
            found |= {".".join((*above, name)): self._text((*above, name)) for name in same}
        return {key: text for key, text in found.items() if text}

    def _text(self, path: tuple[str, ...]) -> str:
        """The value at a key path as a file may have it; empty where there is no such key."""
        part: Any = self
        for step in path[:-1]:
            part = getattr(part, step, None)
        if not isinstance(part, Part) or path[-1] not in type(part).model_fields:
            return ""
        value, spot = getattr(part, path[-1]), spot_of(type(part), path[-1])
        if isinstance(value, Part):
            known = spot.short.known if spot.short else {}
            return next((word for word, one in known.items() if one == value), "")
        unit = f" {spot.leaf.unit}" if isinstance(spot.leaf, Quantity) else ""
        return "computed" if value is None else f"{shown(value)}{unit}"


def load_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario:
    """Read the scenario of a stop, from a file or, by its name where no such file exists, from the packaged ones.

    `overrides` are texts ``key.path=VALUE`` with VALUE in YAML; all are applied, in order, before anything
    is checked. Raises ScenarioError, which lists every mistake of the file and of the overrides.
    """
    document = _with_files_beside(read(path, overrides, _kind), Path(path))
    if _kind(document.data) is TankScenario:
        rule = f"must describe a stop, with {', '.join(_needed())} beside the tank"
        fix = "add them, or use the file where a tank alone will do"
        document.add(Finding((), rule, "a tank alone", fix))
        TankScenario.of(document, str(path))
    return Scenario.of(document, str(path))


def load_tank_scenario(path: str | Path, overrides: Iterable[str] = ()) -> TankScenario:
    """Read a tank: from a file with a tank alone, or from the scenario of a stop, checked as a whole.

    Overrides and errors as in load_scenario.
    """
    found = load_any_scenario(path, overrides)
    if isinstance(found, TankScenario):
        return found
    return TankScenario(
        format=found.format,
        name=found.name,
        description=found.description,
        presets=found.presets,
        tank=found.tank,
        limits=found.limits,
    )


def load_any_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario | TankScenario:
    """Read a file of either kind: one with any of the wagon's parts is taken for a stop."""
    document = _with_files_beside(read(path, overrides, _kind), Path(path))
    return _kind(document.data).of(document, str(path))


def _with_files_beside(document: Document, path: Path) -> Document:
    """The document with files that it names found from its own folder, those of overrides from where one is."""
    place = ("track", "unevenness", "file")
    name = value_at(document.data, place)
    if isinstance(name, str) and name.strip() and not document.origin(place).override:
        document.data["track"]["unevenness"]["file"] = file_beside(name, path.parent)
    return document


def parse_scenario(text: str, name: str = "scenario") -> Scenario:
    """The scenario of a stop from YAML text, as `scenario_to_yaml` writes it; `name` stands for the file."""
    document = parse(text, name)
    expand(document, Scenario)
    return Scenario.of(document, name)


def json_schema() -> dict[str, Any]:
    """JSON Schema of a scenario file, of a stop or of a tank alone, for editors. Quantities are texts with a unit."""
    schema, parts = _with_defaults(Scenario.editor_schema()), _stop_parts()
    alone = [name for name in Scenario.model_fields if name not in TankScenario.model_fields and name not in parts]
    return schema | {
        "required": [name for name in schema["required"] if name not in parts],
        "if": {"anyOf": [{"required": [part]} for part in parts]},
        "then": {
            "required": _needed(),
            "properties": {"tank": {"anyOf": [{"required": [key]} for key in ("bottom_height", USE)]}},
        },
        "else": {"properties": dict.fromkeys(alone, False) | {"tank": {"properties": {"gross_mass": False}}}},
    }


def _with_defaults(schema: dict[str, Any]) -> dict[str, Any]:
    """The schema with the values that a stop has where its file says nothing; their keys may be left out."""
    definitions = schema["$defs"] | {Scenario.__name__: schema}
    for path, leaf in find_preset(DEFAULT).leaves.items():
        parts: list[Any] = [Scenario]
        for step in path[:-1]:
            parts.append(spot_of(parts[-1], str(step)).part)
        given = True
        for part, step in reversed(list(zip(parts, path, strict=True))):
            own = definitions[part.__name__]
            own["required"] = [name for name in own.get("required", ()) if name != step or not given]
            given = not own["required"]
            if not given:
                break
            del own["required"]
        definitions[parts[-1].__name__]["properties"][path[-1]]["default"] = leaf.value
    return schema


def _needed() -> list[str]:
    """The keys that a stop must have beside its tank."""
    return [name for name in _stop_parts() if not is_usual(Scenario, name)]


def _stop_parts() -> tuple[str, ...]:
    """The keys that a stop needs beside its tank; a file with none of them describes a tank alone."""
    fields = Scenario.model_fields.items()
    return tuple(name for name, field in fields if field.is_required() and name not in TankScenario.model_fields)


def _kind(data: Any) -> type[Scenario | TankScenario]:
    """What a file describes."""
    alone = isinstance(data, dict) and "tank" in data and not any(part in data for part in _stop_parts())
    return TankScenario if alone else Scenario
