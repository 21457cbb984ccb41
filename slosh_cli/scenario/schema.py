"""A whole scenario: a tank wagon on a track and its stop, or a tank alone."""

from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import NAME, Text, Version
from slosh_cli.scenario.rules import SCENARIO_RULES, TANK_RULES, Rule, broken_rules, values_of
from slosh_cli.scenario.schema_run import ADHESIONS, Braking, Contact, Output, Solver, Track
from slosh_cli.scenario.schema_tank import SHAPES, Tank
from slosh_cli.scenario.schema_wagon import Wagon


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


def json_schema() -> dict[str, Any]:
    """JSON Schema of a scenario file, for editors. Quantities are texts with a unit."""
    schema = Scenario.model_json_schema()
    definitions = schema["$defs"]
    for shape in SHAPES.values():
        tank = definitions[shape.__name__]
        tank["required"] = ["shape", *tank["required"], "bottom_height"]
        tank["properties"]["bottom_height"].pop("default")
    contact = definitions["Contact"]["properties"]
    own = {"$ref": contact["adhesion"]["$ref"]}
    contact["adhesion"] |= {"oneOf": [{"enum": sorted(ADHESIONS)}, own]}
    del contact["adhesion"]["$ref"]
    for definition in (*definitions.values(), schema):
        for entry in definition["properties"].values():
            if entry.get("default", "") is None:  # computed: the description says how
                del entry["default"]
            elif "default" in entry and "x-unit" in entry:
                entry["default"] = f"{entry['default']} {entry['x-unit']}"
            elif isinstance(entry.get("default"), dict):
                del entry["default"]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
