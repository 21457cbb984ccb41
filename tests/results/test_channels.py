"""The registry of channels: names that scripts rely on, each with unit and meaning."""

import pytest

from slosh_cli.results.channels import CHANNELS, WHEELS, channel, slosh_amplitude, wheel

NAMED = [
    "position",
    "speed",
    "acceleration",
    "car_acceleration",
    "car_heave",
    "car_pitch",
    "bogie_1_heave",
    "bogie_1_pitch",
    "bogie_2_heave",
    "bogie_2_pitch",
    "brake_application",
    "liquid_force",
    "liquid_moment",
    "surface_front",
    "surface_rear",
    "energy_kinetic",
    "energy_elastic",
    "energy_slosh",
    "energy_brake",
    "energy_creep",
    "energy_suspension",
    "energy_foundation",
    "energy_resistance",
    "energy_slosh_damping",
    "energy_slope_work",
    "energy_gradient",
    "energy_residual",
]
PER_WHEEL = [
    "heave",
    "speed",
    "creepage",
    "normal_force",
    "tangential_force",
    "brake_torque",
    "rail_deflection",
    "held_torque",
]


def test_the_names_are_those_of_the_contract_and_no_others() -> None:
    assert set(CHANNELS) == {
        *NAMED,
        *(f"wheel_{i}_{quantity}" for i in (1, 2, 3, 4) for quantity in PER_WHEEL),
    }


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("position", "m"),
        ("car_acceleration", "m/s^2"),
        ("bogie_2_pitch", "rad"),
        ("wheel_3_normal_force", "N"),
        ("wheel_1_brake_torque", "N m"),
        ("wheel_4_creepage", "1"),
        ("slosh_12_amplitude", "m"),
        ("liquid_moment", "N m"),
        ("energy_creep", "J"),
        ("energy_residual", "1"),
    ],
)
def test_units(name: str, unit: str) -> None:
    assert channel(name).unit == unit


def test_every_channel_says_what_it_is() -> None:
    meanings = [info.long_name for info in CHANNELS.values()]
    assert all(meanings)
    assert len(set(meanings)) == len(meanings)
    assert not any("{" in meaning for meaning in meanings)


def test_names_made_by_the_helpers_are_in_the_registry() -> None:
    assert all(wheel(i, "normal_force") in CHANNELS for i in WHEELS)
    assert channel(slosh_amplitude(2)).long_name == "amplitude of longitudinal slosh mode 2"


@pytest.mark.parametrize("name", ["slosh_0_amplitude", "slosh_amplitude", "wheel_5_speed", "", "time"])
def test_unknown_names_are_refused(name: str) -> None:
    with pytest.raises(KeyError, match="no channel named"):
        channel(name)
