"""The data sheet of a loaded wagon: what an engineer asks of it before it moves."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import liquid_depth, section_of
from slosh_cli.tank.load import frozen_load
from slosh_cli.wagon.model import CAR_HEAVE, wagon_model
from slosh_cli.wagon.torque import brake_torque, total_mass


def data_sheet(scenario: Scenario) -> dict[str, float]:
    """Volumes in m^3, masses and axle loads in t, heights above the rail head in m; tau without unit.

    Tau is the sum of T/R of all wheels over the weight of the loaded wagon. Axle loads are those of standstill.
    """
    wagon, tank = scenario.wagon, scenario.tank
    section, load, gross = section_of(tank), frozen_load(tank), total_mass(scenario)
    volume = section.area(section.height) * tank.length
    liquid = section.area(liquid_depth(tank)) * tank.length
    radius = wagon.wheelset.wheel_radius
    moment = (
        wagon.car_body.mass * wagon.car_body.centre_height
        + 2.0 * wagon.bogie.mass * wagon.bogie.centre_height
        + 4.0 * wagon.wheelset.mass * radius
        + load.mass * (tank.bottom_height + load.centre_height)
    )
    axles = _axle_loads(scenario)
    return {
        "tank_volume_m3": volume,
        "liquid_volume_m3": liquid,
        "ullage_m3": volume - liquid,
        "payload_t": load.mass / 1e3,
        "gross_mass_t": gross / 1e3,
        "axle_load_front_t": float(axles[0]) / 1e3,
        "axle_load_rear_t": float(axles[-1]) / 1e3,
        "centre_of_gravity_m": moment / gross,
        "tau": 8.0 * brake_torque(scenario, 0.0) / (radius * gross * STANDARD_GRAVITY),
    }


def _axle_loads(scenario: Scenario) -> Vector:
    """Static axle loads (kg) from the front, (axles,): twice the reactions of the half wagon's wheels held at rest."""
    tank = scenario.tank
    model = wagon_model(scenario.wagon, tank.bottom_height, frozen_load(tank))
    body, wheels = slice(CAR_HEAVE, model.first_wheel), slice(model.first_wheel, model.first_spin)
    rest = np.linalg.solve(model.stiffness[body, body], model.weight[body])
    loads: Vector = 2.0 * (model.stiffness[wheels, body] @ rest - model.weight[wheels]) / STANDARD_GRAVITY
    return loads
