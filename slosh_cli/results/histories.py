"""The histories of a run by channel name, from a vehicle's raw rows."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.results.channels import WHEELS, slosh_amplitude, wheel
from slosh_cli.results.line import line_channels
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.solver.record import Columns, columns_of
from slosh_cli.solver.setup import HALF
from slosh_cli.solver.vehicle import (
    BRAKE,
    CREEP,
    FOUNDATION,
    GRADIENT,
    RESISTANCE,
    SLOPE,
    SLOSH_DAMPING,
    SUSPENSION,
    Vehicle,
)
from slosh_cli.tank.cells import CellLiquid
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.modal import ModalLiquid
from slosh_cli.track.contact import CREEPAGE_SPEED_FLOOR
from slosh_cli.wagon.brake import frictions_of
from slosh_cli.wagon.model import CAR_HEAVE, CAR_PITCH, FIRST_BOGIE, POSITION

WHOLE = 1 / HALF
"""The model is half a wagon; results speak of the whole one."""

LOSS_PLACES = {
    "brake": BRAKE,
    "creep": CREEP,
    "suspension": SUSPENSION,
    "foundation": FOUNDATION,
    "resistance": RESISTANCE,
    "slosh_damping": SLOSH_DAMPING,
    "slope_work": SLOPE,
    "gradient": GRADIENT,
}
"""Name of each entry of the ledger, and its place."""


def channels_of(scenario: Scenario, vehicle: Vehicle, rows: Matrix) -> dict[str, Vector]:
    """Histories by channel name, from a vehicle's raw rows."""
    wagon, columns = vehicle.wagon, columns_of(vehicle)
    place, speed, acceleration = np.split(rows[:, columns.place : columns.normal], 3, axis=1)
    channels = {
        "position": place[:, POSITION],
        "speed": speed[:, POSITION],
        "acceleration": acceleration[:, POSITION],
        "car_acceleration": acceleration @ wagon.car_row,
        "car_heave": place[:, CAR_HEAVE],
        "car_pitch": place[:, CAR_PITCH],
    }
    for bogie in range(wagon.bogies):
        channels[f"bogie_{bogie + 1}_heave"] = place @ wagon.bogie_rows[bogie]
        channels[f"bogie_{bogie + 1}_pitch"] = place[:, FIRST_BOGIE + 2 * bogie + 1]
    train_speed = np.maximum(np.abs(speed[:, POSITION]), CREEPAGE_SPEED_FLOOR)
    for i in WHEELS:
        rolling = wagon.wheel_radius * speed[:, wagon.first_spin + i - 1]
        channels[wheel(i, "heave")] = place[:, wagon.first_wheel + i - 1]
        channels[wheel(i, "speed")] = rolling
        channels[wheel(i, "creepage")] = (speed[:, POSITION] - rolling) / train_speed
        channels[wheel(i, "normal_force")] = rows[:, columns.normal + i - 1]
        channels[wheel(i, "tangential_force")] = rows[:, columns.creep + i - 1]
        channels[wheel(i, "brake_torque")] = rows[:, columns.torque + i - 1]
        channels[wheel(i, "rail_deflection")] = rows[:, columns.rail + i - 1]
        channels[wheel(i, "held_torque")] = rows[:, columns.held_torque + i - 1]
    channels |= _brake_channels(scenario, vehicle, rows, wagon.wheel_radius * speed[:, wagon.first_spin :])
    recorded = rows[:, columns.liquid : columns.end]
    if isinstance(vehicle.liquid, CellLiquid):
        channels |= _cell_channels(scenario, recorded, acceleration)
    else:
        channels |= _load_channels(scenario, vehicle, recorded, place, acceleration)
    channels |= line_channels(scenario, vehicle, place[:, POSITION])
    return channels | _energy_channels(rows, columns)


def _brake_channels(scenario: Scenario, vehicle: Vehicle, rows: Matrix, rolling: Matrix) -> dict[str, Vector]:
    """The application, and of each wheel the friction and the slide protection's share where the brake has them."""
    columns, braking = columns_of(vehicle), scenario.braking
    applied, shares = rows[:, columns.application], rows[:, columns.share : columns.application]
    channels = {"brake_application": applied}
    if braking.slide_protection is not None:
        channels |= {wheel(i, "slide_protection_share"): shares[:, i - 1] for i in WHEELS}
    if braking.rubbing is not None:
        found = np.empty((len(rows), len(WHEELS)))
        frictions_of(vehicle.brake, applied.copy(), shares.copy(), np.ascontiguousarray(rolling), found)
        channels |= {wheel(i, "friction"): found[:, i - 1] for i in WHEELS}
    return channels


def _load_channels(
    scenario: Scenario, vehicle: Vehicle, recorded: Matrix, place: Matrix, acceleration: Matrix
) -> dict[str, Vector]:
    """The load's force and moment on the whole tank (theory section 3), slosh amplitudes and the surface.

    The force is the derivative of the liquid's momentum, the frozen part included.
    """
    load, pitch, turning = frozen_load(scenario.tank), place[:, CAR_PITCH], acceleration[:, CAR_PITCH]
    centre = acceleration @ vehicle.wagon.tank_row + load.centre_height * turning
    weight_arm = STANDARD_GRAVITY * load.mass * load.centre_height * pitch
    channels = {
        "liquid_force": -load.mass * centre,
        "liquid_moment": weight_arm - load.mass * load.centre_height * centre - load.pitch_inertia * turning,
        "surface_front": np.zeros(len(place)),
        "surface_rear": np.zeros(len(place)),
    }
    liquid = vehicle.liquid
    if not isinstance(liquid, ModalLiquid):
        return channels
    amplitude, second = np.split(recorded, 2, axis=1)
    channels["liquid_force"] -= WHOLE * second @ liquid.lambda_1
    channels["liquid_moment"] += WHOLE * (amplitude @ liquid.pitch_weight - second @ liquid.lambda_02)
    channels["surface_front"] = amplitude @ liquid.side
    channels["surface_rear"] = -amplitude @ liquid.side
    return channels | {slosh_amplitude(n + 1): amplitude[:, n] for n in range(amplitude.shape[1])}


def _cell_channels(scenario: Scenario, recorded: Matrix, acceleration: Matrix) -> dict[str, Vector]:
    """Force and moment of the shallow-water liquid on the whole tank (means over steps), surface at both walls."""
    return {
        "liquid_force": WHOLE * recorded[:, 0],
        "liquid_moment": WHOLE * recorded[:, 1] - frozen_load(scenario.tank).pitch_inertia * acceleration[:, CAR_PITCH],
        "surface_front": recorded[:, 2],
        "surface_rear": recorded[:, 3],
    }


def _energy_channels(rows: Matrix, columns: Columns) -> dict[str, Vector]:
    stored = ("energy_kinetic", "energy_elastic", "energy_slosh")
    channels = {name: WHOLE * rows[:, columns.energies + k] for k, name in enumerate(stored)}
    for name, place in LOSS_PLACES.items():
        channels[f"energy_{name}"] = WHOLE * rows[:, columns.losses + place]
    channels["energy_residual"] = rows[:, columns.residual]
    return channels
