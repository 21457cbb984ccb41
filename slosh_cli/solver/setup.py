"""From a scenario to a stop ready to integrate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.errors import PhysicsError
from slosh_cli.scenario import Scenario, Track, Wagon
from slosh_cli.scenario.rail_reach import computed_lengths, critical_speed
from slosh_cli.scenario.schema_train import Coupling
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.solver.events import SHORTEST_STEP
from slosh_cli.solver.initial import initial_point
from slosh_cli.solver.train import Control, Train, new_train
from slosh_cli.solver.vehicle import Point, Scales, Vehicle, new_vehicle
from slosh_cli.tank.cells import CellLiquid, cell_liquid
from slosh_cli.tank.coefficients import slosh_modes
from slosh_cli.tank.liquid import Slosh
from slosh_cli.tank.load import FrozenLoad, frozen_load
from slosh_cli.tank.mixed import of_one_class, own_liquid
from slosh_cli.tank.modal import ModalLiquid, modal_liquid
from slosh_cli.tank.still import shallow_liquid
from slosh_cli.tank.surface_record import surface_record
from slosh_cli.track.contact import contact_model
from slosh_cli.track.line import Line
from slosh_cli.track.mem import RailModel, rail_model
from slosh_cli.track.surface import rolling_surface
from slosh_cli.train.coupling import couplings
from slosh_cli.wagon.brake import brake_of
from slosh_cli.wagon.model import CAR_HEAVE, CAR_PITCH, FIRST_BOGIE, POSITION, WagonModel, wagon_model, wheel_positions

HALF = 0.5
"""One rail carries half of the wagon."""
_LOCAL_TOLERANCE_FACTOR = 5.0
"""Local error per step over tolerance^1.5; with order 2 the distance error then goes as the tolerance itself."""
_VERTICAL_SHARE = 32.0
"""Heave and pitch may err this much more, beside their own scales, than the speed beside V0: they move the distance
little, and at the default tolerance wheel loads still come out within a few tenths of a per cent."""
_LONGEST_STEP = 0.25
"""No step is longer than this, s: wheel loads are looked at often enough not to miss their extremes."""
_STANDING = 1e-4
"""Vehicles of a train that are slower than this, m/s, count as standing."""
_EVENT_TIME = 1e-4
"""Events of a train are met to this, s. Some hundred wheels lock and let go as its vehicles come to a stand."""
_INSTANTS_IN_TRAIN = 500
"""So many instants of its liquid's surface does each vehicle of a train keep."""
_FIRST_STEP = 1e-3
"""First step to try, s."""
_SLOWING = 2.2
"""No step takes more of V0 than this times the root of the tolerance.

The local error, one of speeds, does not see the path. Where the deceleration a grows by da, as it does under locked
wheels, a step h leaves out `0.040 h^2 da` of it and `0.121 h^2 a da` of a unit mass's energy (the method's b A c - 1/6
and b A c + b c^2 - 1/2). With a h within the bound that adds up to less than the tolerance of the initial energy, as
Polach's friction grows by a factor of 2.3 at most.
"""
_LEAST_MISSING = 1e-4
"""A track that damps leaves a quarter of this at the default tolerance (seen), or of a third of a coarser tolerance."""


@dataclass(frozen=True, eq=False)
class ReadyStop:
    """A stop ready to integrate, as one of its vehicles sees it: the train at t = 0, with accelerations still open."""

    train: Train
    static_loads: Vector
    """Wheel loads of the vehicle at t = 0, N, (wheels,)."""
    most_missing: float
    """What the ledger may miss where wheels land, as a part of the initial kinetic energy."""
    place: int = 0
    """Of the vehicle in the train, from the front."""

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle, its load as it is by itself: a wagon alone is the train's one."""
        found = self.train.vehicles[self.place]
        liquid = own_liquid(found.liquid)
        return found if liquid is found.liquid else found.replaced(liquid=liquid)

    @property
    def weight(self) -> float:
        """Weight of the half wagon with its load, N."""
        wagon = self.vehicle.wagon
        return -float(wagon.weight[wagon.heaves].sum())


def problem(scenario: Scenario) -> ReadyStop:
    """Build the stop that `scenario` describes; raises SloshError where the physics refuses it."""
    return train_problem((scenario,), None)[0]


def train_problem(scenarios: Sequence[Scenario], coupling: Coupling | None) -> tuple[ReadyStop, ...]:
    """Build the stop of a train of such vehicles from the front, as each of them sees it; what is said once for a run,
    its solver, output and speeds, is the first one's. Without a `coupling` they know nothing of each other.

    Raises SloshError where the physics refuses it.
    """
    lengths = np.array([scenario.wagon.length_in_train for scenario in scenarios])
    behind = np.cumsum(lengths) - 0.5 * (lengths + lengths[0])
    found = [_vehicle(scenario, way) for scenario, way in zip(scenarios, behind, strict=True)]
    vehicles, first = _of_one_kind(found) if len(found) > 1 else tuple(found), scenarios[0]
    most_missing = max(_LEAST_MISSING, first.solver.tolerance / 3)
    places = np.array([vehicle.wagon.coupling_row @ vehicle.points[0].q for vehicle in vehicles])
    law = couplings(coupling, np.diff(places), HALF) if coupling and len(vehicles) > 1 else None
    for vehicle in vehicles if law else ():
        vehicle.line.standing = _STANDING
    train = new_train(vehicles, _control(first, _EVENT_TIME if law else 2.0 * SHORTEST_STEP), _FIRST_STEP, law)
    loads = [vehicle.points[0].normal.copy() for vehicle in vehicles]
    return tuple(ReadyStop(train, load, most_missing, place) for place, load in enumerate(loads))


def _of_one_kind(vehicles: list[Vehicle]) -> tuple[Vehicle, ...]:
    """The vehicles with their liquids as blocks of one class, so that they make a list; each keeps less of its own."""
    own = [_recording_less(vehicle.liquid) for vehicle in vehicles]
    liquids = of_one_class(own, modal_liquid((), STANDARD_GRAVITY, HALF))
    return tuple(
        vehicle if liquid is vehicle.liquid else vehicle.replaced(liquid=liquid)
        for vehicle, liquid in zip(vehicles, liquids, strict=True)
    )


def _recording_less(liquid: Slosh) -> Slosh:
    """The liquid of a vehicle that is one of many."""
    if not isinstance(liquid, CellLiquid):
        return liquid
    return liquid.replaced(surface=surface_record(liquid.shallow, _INSTANTS_IN_TRAIN))


def _vehicle(scenario: Scenario, behind: float) -> Vehicle:
    """The wagon of `scenario` at t = 0, its centre `behind` (m) that of the first vehicle."""
    load = frozen_load(scenario.tank)
    flowing = scenario.tank.liquid.model == "shallow-water"
    wagon = _wagon(scenario.wagon, scenario.tank.bottom_height, load, not flowing)
    liquid = _liquid(scenario, wagon)
    ahead = wheel_positions(scenario.wagon)
    rail = _rail(_computed_track(scenario), tuple(ahead))
    flats = scenario.wagon.wheel_flats
    surface = rolling_surface(scenario.track.unevenness, flats, ahead - behind, wagon.wheel_radius)
    contact = contact_model(scenario.contact, wagon.wheel_radius, surface)
    _check_mass_matrix(wagon, liquid)
    _check_speed(scenario)
    start = initial_point(wagon, rail, contact, scenario.braking.initial_speed)
    return new_vehicle(
        wagon,
        liquid,
        rail,
        contact,
        _line(scenario, behind),
        brake_of(scenario),
        _scales(scenario, wagon, liquid, start),
        start,
    )


def _line(scenario: Scenario, behind: float) -> Line:
    resistance, points = scenario.wagon.running_resistance, np.array(scenario.track.gradient_points)
    pulls = 0.0 - STANDARD_GRAVITY * points[:, 1]
    return Line(
        resistance=HALF * np.array([resistance.constant, resistance.linear, resistance.quadratic]),
        pull=float(pulls[0]),
        places=points[:, 0] + behind,
        behind=behind,
        pulls=pulls,
        standing=0.0,
    )


def _liquid(scenario: Scenario, wagon: WagonModel) -> Slosh:
    """The moving part of the load, at rest."""
    if scenario.tank.liquid.model == "shallow-water":
        return _cells(scenario, wagon)
    modes = slosh_modes(scenario.tank)
    return modal_liquid(modes, STANDARD_GRAVITY, HALF) if modes else Slosh.blank()


def _cells(scenario: Scenario, wagon: WagonModel) -> CellLiquid:
    shallow, columns = shallow_liquid(scenario.tank, STANDARD_GRAVITY, HALF)
    at_centre = wagon.tank_row.copy()
    at_centre[CAR_PITCH] += shallow.centre_height
    return cell_liquid(
        shallow,
        columns,
        by_force=float(at_centre @ wagon.tank_push),
        by_moment=float(at_centre @ wagon.tank_turn),
        along_by_force=float(wagon.tank_push[POSITION]),
    )


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


def _check_mass_matrix(wagon: WagonModel, liquid: Slosh) -> None:
    """Refuse slosh coefficients whose kinetic energy could be negative."""
    if not isinstance(liquid, ModalLiquid):
        return
    rows = np.outer(liquid.lambda_1, wagon.tank_row)
    rows[:, CAR_PITCH] += liquid.lambda_02
    size = wagon.coordinates
    mass = np.diag(np.concatenate([np.zeros(size), liquid.mu]))
    mass[:size, :size], mass[size:, :size], mass[:size, size:] = wagon.mass, rows, rows.T
    scale = np.sqrt(np.diag(mass))
    if np.linalg.eigvalsh(mass / np.outer(scale, scale))[0] <= 0:
        raise PhysicsError(
            "The mass matrix is not positive definite: the slosh coefficients carry more mass than the tank holds. "
            "Give lambda_1, lambda_02 and mu of the whole tank; lambda_1^2/mu is part of the liquid's mass.",
            "tank.coefficients",
        )


def _check_speed(scenario: Scenario) -> None:
    limit = critical_speed(scenario.track.rail, scenario.track.foundation)
    if scenario.braking.initial_speed >= limit:
        raise PhysicsError(
            f"The initial speed must stay below the track's critical speed of {limit:.1f} m/s, but is "
            f"{scenario.braking.initial_speed:.1f} m/s: no steady rail shape exists there.",
            "braking.initial_speed",
        )


def _scales(scenario: Scenario, wagon: WagonModel, liquid: Slosh, start: Point) -> Scales:
    """Scales of velocities and places from V0 and from how far the wagon sags at the `start` under its weight."""
    speeds = np.full(wagon.coordinates, scenario.braking.initial_speed)
    speeds[wagon.first_spin :] /= wagon.wheel_radius
    places = np.full(wagon.coordinates, np.inf)
    heaves, sag = wagon.heaves, np.abs(start.q)
    sag[FIRST_BOGIE : wagon.first_wheel : 2] = np.abs(wagon.bogie_rows @ start.q)
    places[heaves] = sag[heaves]
    speeds[heaves] = np.sqrt(STANDARD_GRAVITY * places[heaves])
    arms = {CAR_HEAVE: scenario.wagon.pivot_spacing}
    arms |= dict.fromkeys(range(FIRST_BOGIE, wagon.first_wheel, 2), scenario.wagon.bogie.wheelbase)
    for heave, arm in arms.items():
        places[heave + 1] = sag[heave if heave == CAR_HEAVE else FIRST_BOGIE] / (0.5 * arm)
        speeds[heave + 1] = places[heave + 1] * speeds[heave] / places[heave]
    speeds[1 : wagon.first_spin] *= _VERTICAL_SHARE
    places *= _VERTICAL_SHARE
    coupling = float(np.abs(liquid.lambda_1).max(initial=1.0)) if isinstance(liquid, ModalLiquid) else 1.0
    return Scales(
        speed=speeds,
        place=places,
        slosh=scenario.braking.initial_speed * float(wagon.mass[POSITION, POSITION]) / coupling,
        load=float(start.normal.mean()),
    )


def _control(scenario: Scenario, event_time: float) -> Control:
    return Control(
        local_tolerance=_LOCAL_TOLERANCE_FACTOR * scenario.solver.tolerance**1.5,
        stop_speed=scenario.braking.stop_speed,
        time_limit=scenario.solver.time_limit,
        longest_step=_LONGEST_STEP,
        most_slowing=_SLOWING * float(np.sqrt(scenario.solver.tolerance)) * scenario.braking.initial_speed,
        event_time=event_time,
        interval=scenario.output.interval,
    )
