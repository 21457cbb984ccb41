"""Scenarios: what is simulated, read from YAML with units and checked as a whole."""

from slosh_cli.scenario.loader import load_document, scenario_to_yaml
from slosh_cli.scenario.packaged import find_packaged, packaged_scenarios, packaged_text
from slosh_cli.scenario.schema import (
    Scenario,
    TankScenario,
    json_schema,
    load_any_scenario,
    load_scenario,
    load_tank_scenario,
    parse_scenario,
)
from slosh_cli.scenario.schema_brake import Braking
from slosh_cli.scenario.schema_line import Dip, Unevenness
from slosh_cli.scenario.schema_modes import OutlivedCoefficientsError
from slosh_cli.scenario.schema_run import (
    Adhesion,
    Contact,
    Domain,
    Foundation,
    Output,
    Rail,
    Solver,
    Track,
)
from slosh_cli.scenario.schema_tank import (
    Coefficient,
    Elliptical,
    HorizontalCylinder,
    Liquid,
    Polygon,
    Rectangular,
    Tank,
)
from slosh_cli.scenario.schema_wagon import (
    Bogie,
    CarBody,
    RunningResistance,
    Suspension,
    Wagon,
    WheelFlat,
    Wheelset,
)
from slosh_cli.scenario.units import parse_quantity

__all__ = [
    "Adhesion",
    "Bogie",
    "Braking",
    "CarBody",
    "Coefficient",
    "Contact",
    "Dip",
    "Domain",
    "Elliptical",
    "Foundation",
    "HorizontalCylinder",
    "Liquid",
    "OutlivedCoefficientsError",
    "Output",
    "Polygon",
    "Rail",
    "Rectangular",
    "RunningResistance",
    "Scenario",
    "Solver",
    "Suspension",
    "Tank",
    "TankScenario",
    "Track",
    "Unevenness",
    "Wagon",
    "WheelFlat",
    "Wheelset",
    "find_packaged",
    "json_schema",
    "load_any_scenario",
    "load_document",
    "load_scenario",
    "load_tank_scenario",
    "packaged_scenarios",
    "packaged_text",
    "parse_quantity",
    "parse_scenario",
    "scenario_to_yaml",
]
