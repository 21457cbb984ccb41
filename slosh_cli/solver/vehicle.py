"""A vehicle as a value: its constants, its state at the points of a step, and its work space.

A vehicle is {wagon, liquid, rail window, contact, line, brake}. A run has a list of them in a `Train`; how many there
are, how many wheels each has and how long its rail is are data: nothing is compiled again for another number.
"""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Flags, Integers, Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.tank.liquid import Ride, Slosh
from slosh_cli.track.contact import ContactModel
from slosh_cli.track.line import Line
from slosh_cli.track.mem import RailModel
from slosh_cli.track.moving import RailWork, rail_work
from slosh_cli.wagon.brake import Brake
from slosh_cli.wagon.model import WagonModel

BRAKE, CREEP, SUSPENSION, FOUNDATION, RESISTANCE, SLOSH_DAMPING, GRADIENT, SLOPE, LOSSES = range(9)
"""Places in a point's powers and in the work done so far, and their number: how energy leaves or enters (`ledger`)."""


class Scales(Block):
    """What a vehicle's errors are held against. SI units.

    `speed` and `place` (coordinates,) for those of its coordinates, `slosh` m/s; `load` is the static wheel load in N.
    """

    speed: Vector
    place: Vector
    slosh: float
    load: float


class Point(Block):
    """A vehicle at one instant: coordinates and rail with two time derivatives, contact forces, powers.

    `q`, `v`, `a` (coordinates,); `rail...` (2 n,); `normal` and `creep` in N, `torque` in N m (wheels,); `power` in W,
    in the order of the ledger's losses. `stage` is its place among the points of a step (`method.START`, ...).
    """

    stage: int
    q: Vector
    v: Vector
    a: Vector
    rail: Vector
    rail_rate: Vector
    rail_second: Vector
    normal: Vector
    creep: Vector
    torque: Vector
    power: Vector


class Scratch(Block):
    """Work space of a vehicle's stages; nothing in it outlives a step.

    The bodies answer linearly to their inputs: a force up at each wheel, one along the track (place `wheels`), a moment
    on each bogie, and last one along the track at the coupling points. `response` (inputs, bodies) are the answers.
    """

    linear: Matrix
    response: Matrix
    inputs: Vector
    free_bodies: Vector
    right: Vector
    q_error: Vector
    v_error: Vector
    pivots: Integers
    coupled: Matrix
    coupled_right: Vector
    free: Vector
    load_before: Vector
    load_change: Vector
    load_gap: Vector
    creep_change: Vector
    spin_change: Vector
    spin_gap: Vector
    load_gain: Vector
    speed_gain: Vector
    spin_gain: Vector
    turn_gain: Vector
    turn_by_gap: Vector
    normal_slope: Vector
    creep_by_normal: Vector
    creep_by_slip: Vector
    creep_by_speed: Vector
    torque_slope: Vector
    resistance_slope: float
    along_gap: float
    pull: float
    size_before: float
    load_size_before: float
    moved: float
    deepest: float
    acceleration_before: float
    factored_speed: float
    factored_acceleration: float


class _Account(Block):
    """What a vehicle sums up over a run, beside what it was before the step in hand.

    `energies` (3,) J: kinetic, elastic, gravity's and slosh; `losses` J, in the order of the ledger's. Since its onset,
    at `onset_time` s and `onset_position` m: `least`, `largest` wheel loads (N), `largest_torque` (N m) transmitted and
    `locked_time` (s), each (wheels,); `lock_time` s and `lock_speed` m/s of a wheel's first lock; `slid` m and
    `slid_work` J of its longest slide, beside those of the slide in hand; `load_seconds` N s of all wheels in
    `seconds`. `surface` is the largest rise, m; `lifted` says how often wheels lifted off or landed; the rest counts
    what was computed.
    """

    energies_before: Vector
    energies: Vector
    losses_before: Vector
    losses: Vector
    locked_time: Vector
    lock_time: Vector
    lock_speed: Vector
    sliding: Vector
    sliding_work: Vector
    slid: Vector
    slid_work: Vector
    least: Vector
    largest: Vector
    largest_torque: Vector
    values_before: Vector
    values: Vector
    onset_time: float
    onset_position: float
    load_seconds: float
    seconds: float
    surface: float
    lifted: int
    newton: int
    factorisations: int
    right_hand_sides: int


class Vehicle(Block):
    """Constants, state and work space of a vehicle. `points` are its places in a step, in the order of `method.START`.

    `locked`, `airborne` (wheels,) say which wheels slide and which are off the rail, `turning` (wheels,) which way the
    others turn: 1 forward, -1 back. `coupling_force` (N, of the half vehicle, forward) acts at the coupling points.
    """

    wagon: WagonModel
    liquid: Slosh
    rail: RailModel
    contact: ContactModel
    line: Line
    brake: Brake
    scales: Scales
    points: tuple[Point, ...]
    ride: Ride
    locked: Flags
    airborne: Flags
    turning: Vector
    account: _Account
    scratch: Scratch
    rail_work: RailWork
    coupling_force: float


def new_point(stage: int, wagon: WagonModel, rail: RailModel) -> Point:
    """A zeroed state of a vehicle on its rail."""
    unknowns, forces = 2 * rail.nodes, {name: np.zeros(wagon.wheels) for name in ("normal", "creep", "torque")}
    shape = {name: np.zeros(unknowns) for name in ("rail", "rail_rate", "rail_second")}
    return Point.blank(wagon.coordinates, stage=stage, **shape, **forces, power=np.zeros(LOSSES))


def _scratch(wagon: WagonModel) -> Scratch:
    bodies, unknowns, inputs = wagon.first_spin, wagon.wheels + 1, wagon.wheels + wagon.bogies + 2
    return Scratch.blank(
        wagon.wheels,
        linear=np.zeros((bodies, bodies)),
        response=np.zeros((inputs, bodies)),
        inputs=np.zeros(inputs),
        free_bodies=np.zeros(bodies),
        **{name: np.zeros(wagon.coordinates) for name in ("right", "q_error", "v_error")},
        pivots=np.zeros(unknowns, dtype=np.int64),
        coupled=np.zeros((unknowns, unknowns)),
        coupled_right=np.zeros(unknowns),
    )


def _account(wheels: int) -> _Account:
    return _Account.blank(
        wheels,
        **{name: np.zeros(3) for name in ("energies_before", "energies")},
        **{name: np.zeros(LOSSES) for name in ("losses_before", "losses")},
        least=np.full(wheels, np.inf),
        largest=np.full(wheels, -np.inf),
        **{name: np.ones(wheels + 2) for name in ("values_before", "values")},
    )


def new_vehicle(
    wagon: WagonModel,
    liquid: Slosh,
    rail: RailModel,
    contact: ContactModel,
    line: Line,
    brake: Brake,
    scales: Scales,
    start: Point,
) -> Vehicle:
    """A vehicle at the `start` of a run; any kinds of liquid and brake that keep their contracts."""
    return Vehicle(
        wagon=wagon,
        liquid=liquid,
        rail=rail,
        contact=contact,
        line=line,
        brake=brake,
        scales=scales,
        points=(start, *(new_point(stage, wagon, rail) for stage in range(1, 4))),
        ride=Ride.blank(3),
        locked=np.zeros(wagon.wheels, dtype=np.bool_),
        airborne=np.zeros(wagon.wheels, dtype=np.bool_),
        turning=np.ones(wagon.wheels),
        account=_account(wagon.wheels),
        scratch=_scratch(wagon),
        rail_work=rail_work(rail),
        coupling_force=0.0,
    )
