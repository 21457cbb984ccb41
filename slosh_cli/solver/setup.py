"""From a scenario to a stop ready to integrate."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from slosh_cli.errors import PhysicsError
from slosh_cli.scenario import Scenario, Track, Wagon
from slosh_cli.scenario.rail_reach import computed_lengths
from slosh_cli.solver.initial import initial_point
from slosh_cli.solver.problem import Array, Cells, Control, Model, Point
from slosh_cli.tank.coefficients import slosh_modes
from slosh_cli.tank.load import FrozenLoad, frozen_load
from slosh_cli.tank.modal import ModalLiquid, modal_liquid
from slosh_cli.tank.still import no_cells, shallow_liquid
from slosh_cli.track.contact import contact_model
from slosh_cli.track.mem import RailModel, critical_speed, rail_model
from slosh_cli.wagon.brake import Brake
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
from slosh_cli.wagon.model import GRAVITY, WagonModel, wagon_model, wheel_positions

HALF = 0.5
"""One rail carries half of the wagon."""
LOCAL_TOLERANCE_FACTOR = 5.0
"""Local error per step over tolerance^1.5; with order 2 the distance error then goes as the tolerance itself."""
VERTICAL_SHARE = 32.0
"""Heave and pitch may err this much more, beside their own scales, than the speed beside V0: they move the distance
little, and at the default tolerance wheel loads still come out within a few tenths of a per cent."""
LONGEST_STEP = 0.25
"""No step is longer than this, s: wheel loads are looked at often enough not to miss their extremes."""


SLOWING = 2.2
"""No step takes more of V0 than this times the root of the tolerance.

The local error, one of speeds, does not see the path. Where the deceleration a grows by da, as it does under locked
wheels, a step h leaves out `0.040 h^2 da` of it and `0.121 h^2 a da` of a unit mass's energy (the method's b A c - 1/6
and b A c + b c^2 - 1/2). With a h within the bound that adds up to less than the tolerance of the initial energy, as
Polach's friction grows by a factor of 2.3 at most.
"""


LEAST_MISSING = 1e-4
"""A track that damps leaves a quarter of this at the default tolerance (seen), or of a third of a coarser tolerance."""


@dataclass(frozen=True)
class Problem:
    """A stop ready to integrate: its constants and its state at t = 0 (accelerations still open)."""

    model: Model
    start: Point
    cells: Cells
    static_loads: Array
    """Wheel loads at t = 0, N, (4,)."""
    most_missing: float
    """What the ledger may miss where wheels land, as a part of the initial kinetic energy."""

    @property
    def weight(self) -> float:
        """Weight of the half wagon with its load, N."""
        return -float(self.model.wagon.weight.sum())


def problem(scenario: Scenario) -> Problem:
    """Build the stop that `scenario` describes; raises SloshError where the physics refuses it."""
    load = frozen_load(scenario.tank)
    flowing = scenario.tank.liquid.model == "shallow-water"
    wagon = _wagon(scenario.wagon, scenario.tank.bottom_height, load, not flowing)
    liquid = modal_liquid(slosh_modes(scenario.tank), GRAVITY, HALF)
    rail = _rail(_computed_track(scenario), tuple(wheel_positions(scenario.wagon)))
    contact = contact_model(scenario.contact, wagon.wheel_radius)
    _check_mass_matrix(wagon, liquid)
    _check_speed(scenario, rail)
    start = initial_point(wagon, rail, contact, scenario.braking.initial_speed, liquid.mu.size)
    shallow, cells = shallow_liquid(scenario.tank, GRAVITY, HALF) if flowing else no_cells()
    turn = np.zeros(COORDINATES)
    turn[CAR_PITCH] = 1.0
    model = Model(
        wagon=wagon,
        liquid=liquid,
        rail=rail,
        contact=contact,
        brake=Brake(scenario.braking.torque, scenario.braking.onset),
        control=_control(scenario, wagon, liquid, start, contact.stiffness),
        shallow=shallow,
        tank_push=np.asarray(np.linalg.solve(wagon.mass, wagon.tank_row), dtype=np.float64),
        tank_turn=np.asarray(np.linalg.solve(wagon.mass, turn), dtype=np.float64),
    )
    most_missing = max(LEAST_MISSING, scenario.solver.tolerance / 3)
    return Problem(model, start, Cells(*cells), start.normal.copy(), most_missing)


@lru_cache(maxsize=16)
def _wagon(wagon: Wagon, tank_bottom_height: float, load: FrozenLoad, carried: bool) -> WagonModel:
    """The wagon's matrices, shared by the stops of a study: nothing writes to them."""
    return wagon_model(wagon, tank_bottom_height, load, carried=carried)


@lru_cache(maxsize=16)
def _rail(track: Track, wheels: tuple[float, ...]) -> RailModel:
    """The rail's matrices, shared by the stops of a study: nothing writes to them."""
    return rail_model(track, np.array(wheels))


def _computed_track(scenario: Scenario) -> Track:
    """The track with the lengths of its domain put in where the scenario leaves them to the program."""
    wagon, track = scenario.wagon, scenario.track
    speed = scenario.braking.initial_speed
    length, element_length = computed_lengths(track, wagon.bogie.wheelbase, wagon.pivot_spacing, speed)
    domain = {"length": length, "element_length": element_length}
    return track.model_copy(update={"domain": track.domain.model_copy(update=domain)})


def _check_mass_matrix(wagon: WagonModel, liquid: ModalLiquid) -> None:
    """Refuse slosh coefficients whose kinetic energy could be negative."""
    modes = liquid.mu.size
    mass = np.zeros((COORDINATES + modes, COORDINATES + modes))
    mass[:COORDINATES, :COORDINATES] = wagon.mass
    for n in range(modes):
        row = liquid.lambda_1[n] * wagon.tank_row
        row[CAR_PITCH] += liquid.lambda_02[n]
        mass[COORDINATES + n, :COORDINATES] = mass[:COORDINATES, COORDINATES + n] = row
        mass[COORDINATES + n, COORDINATES + n] = liquid.mu[n]
    size = np.sqrt(np.diag(mass))
    if np.linalg.eigvalsh(mass / np.outer(size, size))[0] <= 0:
        raise PhysicsError(
            "The mass matrix is not positive definite: the slosh coefficients carry more mass than the tank holds. "
            "Give lambda_1, lambda_02 and mu of the whole tank; lambda_1^2/mu is part of the liquid's mass.",
            "tank.coefficients",
        )


def _check_speed(scenario: Scenario, rail: RailModel) -> None:
    limit = critical_speed(rail)
    if scenario.braking.initial_speed >= limit:
        raise PhysicsError(
            f"The initial speed must stay below the track's critical speed of {limit:.1f} m/s, but is "
            f"{scenario.braking.initial_speed:.1f} m/s: no steady rail shape exists there.",
            "braking.initial_speed",
        )


def _scales(scenario: Scenario, sag: Array) -> tuple[Array, Array]:
    """Scales of velocities and places (15,) each, from V0 and from how far the wagon sags (m) under its weight."""
    speeds = np.full(COORDINATES, scenario.braking.initial_speed)
    speeds[WHEEL_SPIN:] /= scenario.wagon.wheelset.wheel_radius
    places = np.full(COORDINATES, np.inf)
    heaves = [CAR_HEAVE, BOGIE_HEAVE, BOGIE_HEAVE + 2, *range(WHEEL_HEAVE, WHEEL_HEAVE + WHEELS)]
    places[heaves] = np.abs(sag[heaves])
    arms = {CAR_PITCH: scenario.wagon.pivot_spacing, BOGIE_PITCH: scenario.wagon.bogie.wheelbase}
    for pitch, arm in arms.items():
        places[pitch] = np.abs(sag[pitch - 1]) / (0.5 * arm)
    places[BOGIE_PITCH + 2] = places[BOGIE_PITCH]
    speeds[heaves] = np.sqrt(GRAVITY * places[heaves])
    for pitch, heave in ((CAR_PITCH, CAR_HEAVE), (BOGIE_PITCH, BOGIE_HEAVE), (BOGIE_PITCH + 2, BOGIE_HEAVE + 2)):
        speeds[pitch] = places[pitch] * speeds[heave] / places[heave]
    speeds[1:WHEEL_SPIN] *= VERTICAL_SHARE
    places *= VERTICAL_SHARE
    return speeds, places


def _control(
    scenario: Scenario, wagon: WagonModel, liquid: ModalLiquid, start: Point, contact_stiffness: float
) -> Control:
    speed_scale, place_scale = _scales(scenario, start.q)
    load = float(start.normal.mean())
    coupling = float(np.abs(liquid.lambda_1).max(initial=1.0))
    return Control(
        local_tolerance=LOCAL_TOLERANCE_FACTOR * scenario.solver.tolerance**1.5,
        speed_scale=speed_scale,
        place_scale=place_scale,
        slosh_scale=scenario.braking.initial_speed * float(wagon.mass[POSITION, POSITION]) / coupling,
        load_scale=load,
        approach_scale=(load / contact_stiffness) ** (2 / 3),
        stop_speed=scenario.braking.stop_speed,
        time_limit=scenario.solver.time_limit,
        longest_step=LONGEST_STEP,
        most_slowing=SLOWING * float(np.sqrt(scenario.solver.tolerance)) * scenario.braking.initial_speed,
        interval=scenario.output.interval,
    )
