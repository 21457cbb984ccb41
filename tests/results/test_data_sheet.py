"""The data sheet of a wagon against figures by hand."""

import math

import pytest

from slosh_cli.results.data_sheet import data_sheet


def test_the_half_filled_wagon_by_hand(shipped):
    """A half-filled circle of 1.5 m: its centre lies 4 R/(3 pi) below the axis."""
    scenario = shipped("paper_80_solid")
    wagon, tank = scenario.wagon, scenario.tank
    sheet = data_sheet(shipped("paper_80_solid", "tank.fill=0.5", "tank.liquid.density=1000 kg/m^3"))
    full = math.pi * 1.5**2 * 15.5
    load, gross = 0.5 * full, 21.3 + 3.6 + 5.6 + 0.5 * full
    centre = tank.bottom_height + 1.5 - 4 * 1.5 / (3 * math.pi)
    radius = wagon.wheelset.wheel_radius
    empty = 21.3 * wagon.car_body.centre_height + 3.6 * wagon.bogie.centre_height + 5.6 * radius
    assert sheet == pytest.approx(
        {
            "tank_volume_m3": full,
            "liquid_volume_m3": load,
            "ullage_m3": load,
            "payload_t": load,
            "gross_mass_t": gross,
            "axle_load_front_t": gross / 4,
            "axle_load_rear_t": gross / 4,
            "centre_of_gravity_m": (empty + load * centre) / gross,
            "tau": 8 * scenario.braking.torque / radius / (gross * 1e3 * 9.81),
        },
        rel=1e-9,
    )
