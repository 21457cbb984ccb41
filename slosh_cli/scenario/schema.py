"""A whole scenario: a tank wagon on a track and its stop, or a tank alone."""

from typing import Annotated, Any, ClassVar, Final, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import NAME, Text, Version
from slosh_cli.scenario.rules import SCENARIO_RULES, TANK_RULES, Rule, broken_rules, values_of
from slosh_cli.scenario.schema_run import ADHESIONS, Braking, Contact, Output, Solver, Track
from slosh_cli.scenario.schema_tank import SHAPES, Tank
from slosh_cli.scenario.schema_wagon import Wagon

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
OWN: Final = "x-"
"""Top-level keys that begin so are the author's own, a place for anchors: nobody reads them."""


class Root(Part):
    """What every scenario file begins with."""

    rules: ClassVar[tuple[Rule, ...]] = ()

    format: Annotated[int, Version(1)] = Field(description="Version of the scenario format: 1.")
    name: Annotated[str, NAME] = Field(description="Short name of the scenario; results are kept in a folder of it.")
    description: Annotated[str, Text(longest=2000)] = Field(
        default="", description="What the scenario is, in a sentence or two."
    )

    @model_validator(mode="after")
    def _check_rules(self) -> Self:
        findings = broken_rules(values_of(self), self.rules)
        if findings:
            text = "; ".join(f"{'.'.join(map(str, f.path))} {f.rule}" for f in findings)
            raise PydanticCustomError("rules", "{text}", {"text": text, "findings": findings})
        return self


class TankScenario(Root):
    """A tank alone. Every quantity is SI inside."""

    rules: ClassVar[tuple[Rule, ...]] = TANK_RULES

    tank: Tank = Field(description="The tank and what is in it.")


class Scenario(Root):
    """One stop of a tank wagon. Values are of the whole wagon; every quantity is SI inside."""

    rules: ClassVar[tuple[Rule, ...]] = SCENARIO_RULES

    wagon: Wagon = Field(description="The wagon without its load.")
    tank: Tank = Field(description="The tank and what is in it.")
    track: Track = Field(description="The track under one rail.")
    contact: Contact = Field(description="The contact of wheel and rail.")
    braking: Braking = Field(description="The stop: speed, torque and when.")
    solver: Solver = Field(default=Solver.model_construct(), description="Accuracy and patience.")
    output: Output = Field(default=Output.model_construct(), description="What is written.")


def stop_parts() -> tuple[str, ...]:
    """The keys that a stop needs beside its tank; a file with none of them describes a tank alone."""
    fields = Scenario.model_fields.items()
    return tuple(name for name, field in fields if field.is_required() and name not in TankScenario.model_fields)


def json_schema() -> dict[str, Any]:
    """JSON Schema of a scenario file, of a stop or of a tank alone, for editors. Quantities are texts with a unit."""
    schema = Scenario.model_json_schema()
    definitions = schema["$defs"]
    for shape in SHAPES.values():
        tank = definitions[shape.__name__]
        tank["required"] = ["shape", *tank["required"]]
        given = next(form for form in tank["properties"]["coefficients"]["oneOf"] if form["type"] == "array")
        given["minItems"] = 1
    contact = definitions["Contact"]["properties"]
    own = {"$ref": contact["adhesion"]["$ref"]}
    mu0 = {"anyOf": definitions["Adhesion"]["properties"]["mu0"]["anyOf"]}
    contact["adhesion"] |= {"anyOf": [{"enum": sorted(ADHESIONS)}, mu0, own]}
    del contact["adhesion"]["$ref"]
    for definition in (*definitions.values(), schema):
        for entry in definition["properties"].values():
            if entry.get("default", "") is None:  # computed: the description says how
                del entry["default"]
            elif "default" in entry and "x-unit" in entry:
                entry["default"] = f"{entry['default']} {entry['x-unit']}"
            elif isinstance(entry.get("default"), dict):
                del entry["default"]
    return {"$schema": DIALECT, **schema, **_by_kind(schema), "patternProperties": {f"^{OWN}": True}}


def _by_kind(schema: dict[str, Any]) -> dict[str, Any]:
    """What is required of a stop, and what a tank alone has not."""
    parts = stop_parts()
    alone = [name for name in Scenario.model_fields if name not in TankScenario.model_fields and name not in parts]
    return {
        "required": [name for name in schema["required"] if name not in parts],
        "if": {"anyOf": [{"required": [part]} for part in parts]},
        "then": {"required": list(parts), "properties": {"tank": {"required": ["bottom_height"]}}},
        "else": {"properties": dict.fromkeys(alone, False)},
    }
