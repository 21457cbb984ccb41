"""Constant matrices of half a wagon on one rail, from the kinetic energy and the suspension units."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slosh_cli.scenario import Wagon
from slosh_cli.tank.load import FrozenLoad
from slosh_cli.wagon.coordinates import (
    BOGIE_HEAVE,
    BOGIE_PITCH,
    CAR_HEAVE,
    CAR_PITCH,
    COORDINATES,
    POSITION,
    WHEEL_HEAVE,
    WHEEL_SPIN,
    WHEELS,
)

GRAVITY = 9.81
"""Standard acceleration of free fall used throughout, m/s^2."""

Array = NDArray[np.float64]


class WagonModel(NamedTuple):
    """Half a wagon (one rail) with its load frozen, in SI units; vectors in the order of `coordinates`.

    `mass`, `damping`, `stiffness` are (15, 15); `weight` (15,) holds the generalised forces of gravity;
    `tank_row` (15,) gives the longitudinal displacement of the tank's bottom centre, `car_row` that of the car
    body's centre; `gravity_stiffness` (N m/rad, negative) is the frozen load's share of `stiffness` at car pitch;
    `resistance` (3,) are the halved constant (N), linear (N s/m) and quadratic (N s^2/m^2) terms.
    """

    mass: Array
    damping: Array
    stiffness: Array
    weight: Array
    tank_row: Array
    car_row: Array
    gravity_stiffness: float
    wheel_radius: float
    resistance: Array


def _unit(index: int) -> Array:
    row = np.zeros(COORDINATES)
    row[index] = 1.0
    return row


def car_at_height(wagon: Wagon, height: float) -> Array:
    """Row of the longitudinal displacement of the car at `height` (m) above the rail head (model section 2)."""
    pivot_arm = 0.5 * (wagon.traction_height - wagon.wheelset.wheel_radius)
    return (
        _unit(POSITION)
        + pivot_arm * (_unit(BOGIE_PITCH) + _unit(BOGIE_PITCH + 2))
        + (height - wagon.traction_height) * _unit(CAR_PITCH)
    )


def wheel_positions(wagon: Wagon) -> Array:
    """Longitudinal positions of wheels 1 to 4 from the wagon's centre, m, forward positive; (4,)."""
    half_base, half_pivots = 0.5 * wagon.bogie.wheelbase, 0.5 * wagon.pivot_spacing
    return np.array(
        [half_pivots + half_base, half_pivots - half_base, half_base - half_pivots, -half_base - half_pivots]
    )


def _mass_matrix(wagon: Wagon, tank_row: Array, load: FrozenLoad, carried: bool) -> Array:
    radius = wagon.wheelset.wheel_radius
    car = wagon.car_body
    load_row = tank_row + load.centre_height * _unit(CAR_PITCH)
    terms = [
        (car.mass, car_at_height(wagon, car.centre_height)),
        (car.mass, _unit(CAR_HEAVE)),
        (car.pitch_inertia, _unit(CAR_PITCH)),
        (load.mass if carried else 0.0, load_row),
        (load.mass, _unit(CAR_HEAVE)),
        (load.pitch_inertia, _unit(CAR_PITCH)),
    ]
    for bogie in (0, 2):
        pitch = _unit(BOGIE_PITCH + bogie)
        terms += [
            (wagon.bogie.mass, _unit(POSITION) + (wagon.bogie.centre_height - radius) * pitch),
            (wagon.bogie.mass, _unit(BOGIE_HEAVE + bogie)),
            (wagon.bogie.pitch_inertia, pitch),
        ]
    for wheel in range(WHEELS):
        terms += [
            (wagon.wheelset.mass, _unit(POSITION)),
            (wagon.wheelset.mass, _unit(WHEEL_HEAVE + wheel)),
            (wagon.wheelset.spin_inertia, _unit(WHEEL_SPIN + wheel)),
        ]
    return 0.5 * sum((value * np.outer(row, row) for value, row in terms), np.zeros((COORDINATES,) * 2))


def _suspension_matrices(wagon: Wagon) -> tuple[Array, Array]:
    """Stiffness and damping (15, 15): each unit acts on the relative heave of its two ends, arms included."""
    stiffness = np.zeros((COORDINATES, COORDINATES))
    damping = np.zeros_like(stiffness)
    units = []
    for bogie, pivot in ((0, 0.5 * wagon.pivot_spacing), (2, -0.5 * wagon.pivot_spacing)):
        car_end = _unit(CAR_HEAVE) - pivot * _unit(CAR_PITCH)
        units.append((wagon.secondary_suspension, car_end - _unit(BOGIE_HEAVE + bogie)))
        for wheel, arm in ((bogie, 0.5 * wagon.bogie.wheelbase), (bogie + 1, -0.5 * wagon.bogie.wheelbase)):
            bogie_end = _unit(BOGIE_HEAVE + bogie) - arm * _unit(BOGIE_PITCH + bogie)
            units.append((wagon.primary_suspension, bogie_end - _unit(WHEEL_HEAVE + wheel)))
    for unit, row in units:
        stiffness += unit.stiffness * np.outer(row, row)
        damping += unit.damping * np.outer(row, row)
    return stiffness, damping


def wagon_model(wagon: Wagon, tank_bottom_height: float, load: FrozenLoad, *, carried: bool = True) -> WagonModel:
    """Assemble the half wagon; `load` is the whole tank's, `tank_bottom_height` (m) above the rail head.

    A load that is not `carried` along x has a motion of its own there: its longitudinal inertia and its weight's part
    in the car's pitch are then left to the liquid (model section 10).
    """
    tank_row = car_at_height(wagon, tank_bottom_height)
    stiffness, damping = _suspension_matrices(wagon)
    gravity_stiffness = -0.5 * load.mass * GRAVITY * load.centre_height if carried else 0.0
    stiffness[CAR_PITCH, CAR_PITCH] += gravity_stiffness
    weight = np.zeros(COORDINATES)
    weight[CAR_HEAVE] = wagon.car_body.mass + load.mass
    weight[[BOGIE_HEAVE, BOGIE_HEAVE + 2]] = wagon.bogie.mass
    weight[WHEEL_HEAVE : WHEEL_HEAVE + WHEELS] = wagon.wheelset.mass
    resistance = wagon.running_resistance
    return WagonModel(
        mass=_mass_matrix(wagon, tank_row, load, carried),
        damping=damping,
        stiffness=stiffness,
        weight=-0.5 * GRAVITY * weight,
        tank_row=tank_row,
        car_row=car_at_height(wagon, wagon.car_body.centre_height),
        gravity_stiffness=gravity_stiffness,
        wheel_radius=wagon.wheelset.wheel_radius,
        resistance=0.5 * np.array([resistance.constant, resistance.linear, resistance.quadratic]),
    )
