"""One stop, from scenario to result: what both the command line and Python scripts call."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.method import START
from slosh_cli.results.answers import PerWheel
from slosh_cli.results.channels import WHEELS, slosh_amplitude, wheel
from slosh_cli.results.liquid_range import Motion, motion_checks, tank_checks
from slosh_cli.results.recommendation import Recommendation, recommend, stop_deceleration
from slosh_cli.results.rest import rest_checks
from slosh_cli.results.result import Result, Status
from slosh_cli.results.validity import Check, Extent, checks, warnings_of
from slosh_cli.results.wagon_range import residual_cause, wagon_checks
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import section_of
from slosh_cli.solver import advance
from slosh_cli.solver.record import Columns, columns_of
from slosh_cli.solver.run import RINGING, Cancel, Progress, Run, integrate
from slosh_cli.solver.setup import HALF, ReadyStop, problem
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
from slosh_cli.wagon.model import CAR_HEAVE, CAR_PITCH, FIRST_BOGIE, POSITION

_WHOLE = 1 / HALF
"""The model is half a wagon; results speak of the whole one."""


_OUTCOMES: Mapping[int, tuple[Status, str]] = {
    advance.STOPPED: (Status.STOPPED, ""),
    advance.TIME_LIMIT: (Status.TIME_LIMIT, "still rolling at {speed:.2f} m/s at the time limit of {time:.4g} s"),
    advance.PITCH_LIMIT: (
        Status.PITCH_LIMIT,
        "a pitch angle passed 0.1 rad {time:.2f} s into the run at {speed:.1f} m/s; small-angle kinematics end there",
    ),
    advance.UNSOLVED: (
        Status.FAILED,
        "no step, however short, satisfied the equations at t = {time:.6g} s ({speed:.2f} m/s); tighten "
        "solver.tolerance or refine track.domain.element_length",
    ),
    advance.STALLED_EVENTS: (
        Status.FAILED,
        "wheels lock and release without time passing at t = {time:.6g} s ({speed:.2f} m/s)",
    ),
    advance.NOT_FINITE: (
        Status.FAILED,
        "a value became infinite or undefined at t = {time:.6g} s; tighten solver.tolerance",
    ),
    RINGING: (
        Status.FAILED,
        "wheels left the rail, and the track hardly damps what their landings put into it: the waves run to and fro in "
        "the rail and go on shaking the wheels, and the braking distance hangs on waves too short for the steps. Give "
        "the track its damping (track.foundation.damping, 4.9 kN s/m^2 in the packaged scenarios)",
    ),
}


def simulate(scenario: Scenario, *, progress: Progress | None = None, cancel: Cancel | None = None) -> Result:
    """Integrate one stop.

    `progress` is called now and then with the fraction done and the speed (m/s); `cancel` is looked at as often
    and ends the run with `Cancelled`. A stop that comes to no answer is a result too: see its status and reason.
    Raises PhysicsError where the scenario has no model (indefinite mass matrix, supercritical speed) and TankError
    where slosh coefficients cannot be computed.
    """
    stop = problem(scenario)
    static_loads = _per_wheel(stop.static_loads)
    run = integrate(stop, progress, cancel)
    vehicle, time = stop.vehicle, stop.train.time
    end, account, braked = vehicle.points[START], vehicle.account, vehicle.brake.breaks > 0
    status, reason = _ending(run, braked)
    stopped, tank, weight = status is Status.STOPPED, scenario.tank, stop.weight
    advice = _recommended(scenario)
    verdicts = _verdicts(scenario, stop, run, advice)
    return Result(
        scenario=scenario,
        status=status,
        reason=reason.format(time=time, speed=end.v[POSITION]),
        warnings=tuple(warnings_of(verdicts)),
        checks=verdicts,
        recommendation=advice,
        time=run.rows[:, 0, 0],
        channels=_channels(scenario, vehicle, run.rows[:, 0]),
        braking_distance_m=float(end.q[POSITION] - account.onset_position) if stopped else None,
        braking_time_s=time - account.onset_time if stopped else None,
        max_surface_m=account.surface,
        surface_limit_m=section_of(tank).height * (1 - tank.fill),
        min_wheel_load_N=_per_wheel(account.least) if braked else static_loads,
        max_wheel_load_N=_per_wheel(account.largest) if braked else static_loads,
        static_wheel_load_N=static_loads,
        mean_total_wheel_load_N=_WHOLE * (account.load_seconds / account.seconds if account.seconds > 0 else weight),
        weight_N=_WHOLE * weight,
        locked_time_s=_per_wheel(account.locked_time),
        energy_residual=stop.train.largest_residual,
        energy=_final_energy(stop),
        steps=stop.train.steps,
        rejected_steps=stop.train.rejected,
        work=_work(stop),
        solve_seconds=run.seconds,
    )


def _ending(run: Run, braked: bool) -> tuple[Status, str]:
    """How the run ended and why, times and speeds still to be put in."""
    status, reason = _OUTCOMES[run.outcome]
    if status is Status.STOPPED and not braked:
        return Status.FAILED, "came to rest at t = {time:.4g} s, before the brake set in: no braking distance"
    return status, reason


def _work(stop: ReadyStop) -> dict[str, int]:
    """What was computed, in counts."""
    account = stop.vehicle.account
    return {
        "newton_iterations": account.newton,
        "factorisations": account.factorisations,
        "right_hand_sides": account.right_hand_sides,
        "events": stop.train.events,
    }


def _per_wheel(values: Vector) -> PerWheel:
    return cast(PerWheel, tuple(float(value) for value in values))


def _recommended(scenario: Scenario) -> Recommendation | None:
    """The model of the liquid that suits this stop; None for a load that is frozen on purpose."""
    if scenario.tank.liquid.model == "rigid":
        return None
    return recommend(scenario.tank, stop_deceleration(scenario))


def _verdicts(scenario: Scenario, stop: ReadyStop, run: Run, advice: Recommendation | None) -> tuple[Check, ...]:
    """All that is to be said of a run: of its liquid, its wheels and ledger, its wagon and track, its rest."""
    tank, sentence = scenario.tank, advice.sentence if advice else ""
    liquid, stopped = stop.vehicle.liquid, run.outcome == advance.STOPPED and stop.vehicle.brake.breaks > 0
    flowing = isinstance(liquid, CellLiquid)
    head = max(liquid.deepest - float(liquid.shallow.table.depth[-1]), 0.0) if flowing else 0.0
    motion = Motion(stop.vehicle.account.surface, head)
    return (
        *tank_checks(tank, sentence),
        *motion_checks(tank, motion, sentence),
        *checks(_extent(scenario, stop, run)),
        *wagon_checks(scenario),
        *(rest_checks(scenario, stop) if stopped else ()),
    )


def _extent(scenario: Scenario, stop: ReadyStop, run: Run) -> Extent:
    """What the verdicts on the run as a whole look at."""
    account = stop.vehicle.account
    return Extent(
        unloading=float(np.max(1 - np.minimum(account.least, stop.static_loads) / stop.static_loads)),
        lifts=account.lifted,
        pitched=run.outcome == advance.PITCH_LIMIT,
        residual=stop.train.largest_residual,
        residual_cause=residual_cause(scenario, account.lifted),
        locked=_per_wheel(account.locked_time),
    )


def _final_energy(stop: ReadyStop) -> dict[str, float]:
    """The ledger at the end of the run, J of the whole wagon."""
    account = stop.vehicle.account
    kinetic, elastic, slosh = _WHOLE * account.energies
    losses = _WHOLE * account.losses
    return {
        "initial_kinetic": _WHOLE * stop.train.initial_kinetic,
        "initial_total": _WHOLE * stop.train.total_start,
        "kinetic": float(kinetic),
        "elastic": float(elastic),
        "slosh": float(slosh),
        **{name: float(losses[place]) for name, place in _LOSSES.items()},
    }


_LOSSES = {
    "brake": BRAKE,
    "creep": CREEP,
    "suspension": SUSPENSION,
    "foundation": FOUNDATION,
    "resistance": RESISTANCE,
    "slosh_damping": SLOSH_DAMPING,
    "slope_work": SLOPE,
    "gradient": GRADIENT,
}


def _channels(scenario: Scenario, vehicle: Vehicle, rows: Matrix) -> dict[str, Vector]:
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
        channels[f"bogie_{bogie + 1}_heave"] = place[:, FIRST_BOGIE + 2 * bogie]
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
    recorded = rows[:, columns.liquid : columns.end]
    if isinstance(vehicle.liquid, CellLiquid):
        channels |= _cell_channels(scenario, recorded, acceleration)
    else:
        channels |= _load_channels(scenario, vehicle, recorded, place, acceleration)
    return channels | _energy_channels(rows, columns)


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
    channels["liquid_force"] -= _WHOLE * second @ liquid.lambda_1
    channels["liquid_moment"] += _WHOLE * (amplitude @ liquid.pitch_weight - second @ liquid.lambda_02)
    channels["surface_front"] = amplitude @ liquid.side
    channels["surface_rear"] = -amplitude @ liquid.side
    return channels | {slosh_amplitude(n + 1): amplitude[:, n] for n in range(amplitude.shape[1])}


def _cell_channels(scenario: Scenario, recorded: Matrix, acceleration: Matrix) -> dict[str, Vector]:
    """Force and moment of the shallow-water liquid on the whole tank (means over steps), surface at both walls."""
    return {
        "liquid_force": _WHOLE * recorded[:, 0],
        "liquid_moment": _WHOLE * recorded[:, 1]
        - frozen_load(scenario.tank).pitch_inertia * acceleration[:, CAR_PITCH],
        "surface_front": recorded[:, 2],
        "surface_rear": recorded[:, 3],
    }


def _energy_channels(rows: Matrix, columns: Columns) -> dict[str, Vector]:
    stored = ("energy_kinetic", "energy_elastic", "energy_slosh")
    channels = {name: _WHOLE * rows[:, columns.energies + k] for k, name in enumerate(stored)}
    for name, place in _LOSSES.items():
        channels[f"energy_{name}"] = _WHOLE * rows[:, columns.losses + place]
    channels["energy_residual"] = rows[:, columns.residual]
    return channels
