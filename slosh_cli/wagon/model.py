"""Constant matrices of half a vehicle on one rail, from the kinetic energy and the suspension units.

Coordinates: the position along the track; heave and pitch of the car, then of each bogie from the front; the heave of
each wheel, then the spin of each wheel. Where a bogie has no springs under the car, its heave counts from the pivot's
and stays zero: nothing acts on it, and it acts on nothing (theory section 2). Translations in m, rotations in rad;
heave is positive up, pitch positive nose-down, spin positive rolling forward. Wheel 1 is the leading wheel of the
front bogie.
"""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.scenario import Wagon
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.tank.load import FrozenLoad

POSITION, CAR_HEAVE, CAR_PITCH, FIRST_BOGIE = range(4)
"""Places of the first coordinates; each bogie takes two from `FIRST_BOGIE` on: its heave, its pitch."""
_BOGIES = 2
_AXLES = 2  # of a bogie


class WagonModel(Block):
    """Half a vehicle (one rail) with its load frozen, in SI units; vectors in the order of the `coordinates`.

    `wheels` on `bogies`: their heaves begin at place `first_wheel`, their spins at `first_spin`, and `frame` (wheels,)
    is the place of the pitch that a wheel's brake reacts on. `mass`, `damping`, `stiffness` are square; `weight` holds
    the generalised forces of gravity; `tank_row` gives the longitudinal displacement of the tank's bottom centre,
    `car_row` that of the car body's centre, `coupling_row` that of the coupling points; `bogie_rows` (bogies,
    coordinates) give the bogies' heaves; `tank_push` and `tank_turn` are the accelerations per newton along x at the
    tank's bottom centre and per newton metre in the car's pitch; `gravity_stiffness` (N m/rad, negative) is the frozen
    load's share of `stiffness` at car pitch.
    """

    wheels: int
    bogies: int
    coordinates: int
    first_wheel: int
    first_spin: int
    frame: Integers
    mass: Matrix
    damping: Matrix
    stiffness: Matrix
    weight: Vector
    tank_row: Vector
    car_row: Vector
    coupling_row: Vector
    bogie_rows: Matrix
    tank_push: Vector
    tank_turn: Vector
    gravity_stiffness: float
    wheel_radius: float

    @property
    def heaves(self) -> Integers:
        """Places of all vertical displacements: of the car, the bogies, the wheels."""
        bogies = FIRST_BOGIE + 2 * np.arange(self.bogies)
        return np.concatenate([[CAR_HEAVE], bogies, np.arange(self.first_wheel, self.first_spin)])


_FIRST_WHEEL = FIRST_BOGIE + 2 * _BOGIES
_FIRST_SPIN = _FIRST_WHEEL + _BOGIES * _AXLES
_COORDINATES = _FIRST_SPIN + _BOGIES * _AXLES


def _unit(index: int) -> Vector:
    row = np.zeros(_COORDINATES)
    row[index] = 1.0
    return row


def _car_at_height(wagon: Wagon, height: float) -> Vector:
    """Row of the longitudinal displacement of the car at `height` (m) above the rail head (theory section 2)."""
    pivot_arm = 0.5 * (wagon.traction_height - wagon.wheelset.wheel_radius)
    return (
        _unit(POSITION)
        + pivot_arm * (_unit(FIRST_BOGIE + 1) + _unit(FIRST_BOGIE + 3))
        + (height - wagon.traction_height) * _unit(CAR_PITCH)
    )


def _pivots(wagon: Wagon) -> tuple[float, float]:
    """Places (m) of the bogies ahead of the wagon's centre."""
    return 0.5 * wagon.pivot_spacing, -0.5 * wagon.pivot_spacing


def _bogie_rows(wagon: Wagon) -> Matrix:
    """Rows of the heaves of the bogies: their own, or the car's above their pivots, (bogies, coordinates)."""
    own = np.array([_unit(heave) for heave in range(FIRST_BOGIE, _FIRST_WHEEL, 2)])
    if wagon.secondary_suspension != "none":
        return own
    return np.array([_unit(CAR_HEAVE) - pivot * _unit(CAR_PITCH) for pivot in _pivots(wagon)])


def _arms(wagon: Wagon) -> tuple[float, float]:
    """Places (m) of a bogie's axles ahead of its pivot."""
    return 0.5 * wagon.bogie.wheelbase, -0.5 * wagon.bogie.wheelbase


def wheel_positions(wagon: Wagon) -> Vector:
    """Longitudinal positions of the wheels from the wagon's centre, m, forward positive; (wheels,)."""
    return np.array([pivot + arm for pivot in _pivots(wagon) for arm in _arms(wagon)])


def _mass_matrix(wagon: Wagon, tank_row: Vector, load: FrozenLoad, carried: bool) -> Matrix:
    radius = wagon.wheelset.wheel_radius
    car = wagon.car_body
    load_row = tank_row + load.centre_height * _unit(CAR_PITCH)
    terms = [
        (car.mass, _car_at_height(wagon, car.centre_height)),
        (car.mass, _unit(CAR_HEAVE)),
        (car.pitch_inertia, _unit(CAR_PITCH)),
        (load.mass if carried else 0.0, load_row),
        (load.mass, _unit(CAR_HEAVE)),
        (load.pitch_inertia, _unit(CAR_PITCH)),
    ]
    for bogie, heave in enumerate(_bogie_rows(wagon)):
        pitch = _unit(FIRST_BOGIE + 2 * bogie + 1)
        terms += [
            (wagon.bogie.mass, _unit(POSITION) + (wagon.bogie.centre_height - radius) * pitch),
            (wagon.bogie.mass, heave),
            (wagon.bogie.pitch_inertia, pitch),
        ]
        if wagon.secondary_suspension == "none":
            terms.append((wagon.bogie.mass, _unit(FIRST_BOGIE + 2 * bogie)))  # a rest of its own: nothing moves it
    for wheel in range(_BOGIES * _AXLES):
        terms += [
            (wagon.wheelset.mass, _unit(POSITION)),
            (wagon.wheelset.mass, _unit(_FIRST_WHEEL + wheel)),
            (wagon.wheelset.spin_inertia, _unit(_FIRST_SPIN + wheel)),
        ]
    return 0.5 * sum((value * np.outer(row, row) for value, row in terms), np.zeros((_COORDINATES,) * 2))


def _suspension_matrices(wagon: Wagon) -> tuple[Matrix, Matrix]:
    """Stiffness and damping: each unit acts on the relative heave of its two ends, arms included."""
    stiffness = np.zeros((_COORDINATES, _COORDINATES))
    damping = np.zeros_like(stiffness)
    units = []
    sprung = wagon.secondary_suspension != "none"
    secondary = wagon.secondary_suspension if wagon.secondary_suspension != "none" else wagon.primary_suspension
    for bogie, (pivot, heave) in enumerate(zip(_pivots(wagon), _bogie_rows(wagon), strict=True)):
        own, pitch = _unit(FIRST_BOGIE + 2 * bogie), _unit(FIRST_BOGIE + 2 * bogie + 1)
        over = _unit(CAR_HEAVE) - pivot * _unit(CAR_PITCH) - heave
        # without springs nothing is left `over` the pivot; any unit then holds the coordinate that nothing moves
        units.append((secondary, over if sprung else own))
        for axle, arm in enumerate(_arms(wagon)):
            wheel = _unit(_FIRST_WHEEL + _AXLES * bogie + axle)
            units.append((wagon.primary_suspension, heave - arm * pitch - wheel))
    for unit, row in units:
        stiffness += unit.stiffness * np.outer(row, row)
        damping += unit.damping * np.outer(row, row)
    return stiffness, damping


def _weight(wagon: Wagon, load: FrozenLoad) -> Vector:
    """Generalised forces (N) of gravity on half the wagon."""
    masses = wagon.bogie.mass * _bogie_rows(wagon).sum(axis=0)
    masses[CAR_HEAVE] += wagon.car_body.mass + load.mass
    masses[_FIRST_WHEEL:_FIRST_SPIN] = wagon.wheelset.mass
    weight: Vector = -0.5 * STANDARD_GRAVITY * masses
    return weight


def wagon_model(wagon: Wagon, tank_bottom_height: float, load: FrozenLoad, *, carried: bool = True) -> WagonModel:
    """Assemble the half wagon; `load` is the whole tank's, `tank_bottom_height` (m) above the rail head.

    A load that is not `carried` along x has a motion of its own there: its longitudinal inertia and its weight's part
    in the car's pitch are then left to the liquid (theory section 10).
    """
    tank_row = _car_at_height(wagon, tank_bottom_height)
    mass = _mass_matrix(wagon, tank_row, load, carried)
    stiffness, damping = _suspension_matrices(wagon)
    gravity_stiffness = -0.5 * load.mass * STANDARD_GRAVITY * load.centre_height if carried else 0.0
    stiffness[CAR_PITCH, CAR_PITCH] += gravity_stiffness
    return WagonModel(
        wheels=_BOGIES * _AXLES,
        bogies=_BOGIES,
        coordinates=_COORDINATES,
        first_wheel=_FIRST_WHEEL,
        first_spin=_FIRST_SPIN,
        frame=np.repeat(np.arange(FIRST_BOGIE + 1, _FIRST_WHEEL, 2), _AXLES),
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        weight=_weight(wagon, load),
        tank_row=tank_row,
        car_row=_car_at_height(wagon, wagon.car_body.centre_height),
        coupling_row=_car_at_height(wagon, wagon.coupling_height),
        bogie_rows=_bogie_rows(wagon),
        tank_push=np.asarray(np.linalg.solve(mass, tank_row), dtype=np.float64),
        tank_turn=np.asarray(np.linalg.solve(mass, _unit(CAR_PITCH)), dtype=np.float64),
        gravity_stiffness=gravity_stiffness,
        wheel_radius=wagon.wheelset.wheel_radius,
    )
