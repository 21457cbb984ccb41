"""One stop, from scenario to result: what both the command line and Python scripts call."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

import numpy as np
from numpy.typing import NDArray

from slosh_cli.results.answers import PerWheel
from slosh_cli.results.channels import WHEELS, slosh_amplitude, wheel
from slosh_cli.results.liquid_range import Motion, motion_checks, tank_checks
from slosh_cli.results.recommendation import Recommendation, recommend, stop_deceleration
from slosh_cli.results.rest import rest_checks
from slosh_cli.results.result import Result, Status
from slosh_cli.results.validity import Check, Extent, checks, warnings_of
from slosh_cli.results.wagon_range import residual_cause, wagon_checks
from slosh_cli.scenario import Scenario
from slosh_cli.solver import advance, record, state
from slosh_cli.solver.cells import DEEPEST
from slosh_cli.solver.ledger import BRAKE, CREEP, FOUNDATION, RESISTANCE, SLOPE, SLOSH_DAMPING, SUSPENSION
from slosh_cli.solver.run import RINGING, Cancel, Progress, Run, integrate
from slosh_cli.solver.setup import HALF, Problem, problem
from slosh_cli.solver.state import EVENTS, FACTORISATIONS, NEWTON, RIGHT_HAND_SIDES
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.section import section_of
from slosh_cli.track.contact import CREEPAGE_SPEED_FLOOR
from slosh_cli.wagon.coordinates import (
    BOGIE_HEAVE,
    BOGIE_PITCH,
    CAR_HEAVE,
    CAR_PITCH,
    COORDINATES,
    POSITION,
    WHEEL_HEAVE,
    WHEEL_SPIN,
)
from slosh_cli.wagon.model import GRAVITY

Array = NDArray[np.float64]

WHOLE = 1 / HALF
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
    clock, onset = run.state.clock, run.state.counts[state.PHASE] > 0
    status, reason = _OUTCOMES[run.outcome]
    stopped = status is Status.STOPPED and onset
    if status is Status.STOPPED and not onset:
        status, reason = Status.FAILED, "came to rest at t = {time:.4g} s, before the brake set in: no braking distance"
    tank, weight = scenario.tank, stop.weight
    advice = recommended(scenario)
    verdicts = _verdicts(scenario, stop, run, advice)
    return Result(
        scenario=scenario,
        status=status,
        reason=reason.format(time=clock[state.TIME], speed=run.state.start.v[POSITION]),
        warnings=tuple(warnings_of(verdicts)),
        checks=verdicts,
        recommendation=advice,
        time=run.rows[:, record.TIME_COLUMN],
        channels=_channels(scenario, stop, run),
        braking_distance_m=float(run.state.start.q[POSITION] - clock[state.ONSET_POSITION]) if stopped else None,
        braking_time_s=float(clock[state.TIME] - clock[state.ONSET_TIME]) if stopped else None,
        max_surface_m=float(run.state.surface[0]),
        surface_limit_m=section_of(tank).height * (1 - tank.fill),
        min_wheel_load_N=_per_wheel(run.state.least) if onset else static_loads,
        max_wheel_load_N=_per_wheel(run.state.largest) if onset else static_loads,
        static_wheel_load_N=static_loads,
        mean_total_wheel_load_N=WHOLE * _mean_load(run, weight),
        weight_N=WHOLE * weight,
        locked_time_s=_per_wheel(run.state.locked_time),
        energy_residual=float(run.state.residual[2]),
        energy=_final_energy(run),
        steps=int(run.state.counts[state.STEPS]),
        rejected_steps=int(run.state.counts[state.REJECTED]),
        work={
            "newton_iterations": int(run.state.work[NEWTON]),
            "factorisations": int(run.state.work[FACTORISATIONS]),
            "right_hand_sides": int(run.state.work[RIGHT_HAND_SIDES]),
            "events": int(run.state.work[EVENTS]),
        },
        solve_seconds=run.seconds,
    )


def _per_wheel(values: Array) -> PerWheel:
    return cast(PerWheel, tuple(float(value) for value in values))


def _mean_load(run: Run, weight: float) -> float:
    impulse, seconds = run.state.load_sum
    return float(impulse / seconds) if seconds > 0 else weight


def recommended(scenario: Scenario) -> Recommendation | None:
    """The model of the liquid that suits this stop; None for a load that is frozen on purpose."""
    if scenario.tank.liquid.model == "rigid":
        return None
    return recommend(scenario.tank, stop_deceleration(scenario))


def _verdicts(scenario: Scenario, stop: Problem, run: Run, advice: Recommendation | None) -> tuple[Check, ...]:
    """All that is to be said of a run: of its liquid, its wheels and ledger, its wagon and track, its rest."""
    tank, sentence = scenario.tank, advice.sentence if advice else ""
    shallow, braked = stop.model.shallow, run.state.counts[state.PHASE] > 0
    head = max(float(run.state.push[DEEPEST] - shallow.table.depth[-1]), 0.0) if shallow.cells else 0.0
    motion = Motion(float(run.state.surface[0]), head)
    return (
        *tank_checks(tank, sentence),
        *motion_checks(tank, motion, sentence),
        *checks(_extent(scenario, stop, run)),
        *wagon_checks(scenario),
        *(rest_checks(scenario, stop, run.state) if run.outcome == advance.STOPPED and braked else ()),
    )


def _extent(scenario: Scenario, stop: Problem, run: Run) -> Extent:
    """What the verdicts on the run as a whole look at."""
    least, lifts = np.minimum(run.state.least, stop.static_loads), int(run.state.lifted[0])
    return Extent(
        unloading=float(np.max(1 - least / stop.static_loads)),
        lifts=lifts,
        pitched=run.outcome == advance.PITCH_LIMIT,
        residual=float(run.state.residual[2]),
        residual_cause=residual_cause(scenario, lifts),
        locked=_per_wheel(run.state.locked_time),
    )


def _final_energy(run: Run) -> dict[str, float]:
    """The ledger at the end of the run, J of the whole wagon."""
    kinetic, elastic, slosh = WHOLE * run.state.energies
    losses = WHOLE * run.state.losses
    return {
        "initial_kinetic": WHOLE * float(run.state.clock[state.INITIAL_KINETIC]),
        "initial_total": WHOLE * float(run.state.clock[state.TOTAL_START]),
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
}


def _channels(scenario: Scenario, stop: Problem, run: Run) -> dict[str, Array]:
    """Histories by channel name, from the raw record."""
    rows = run.rows
    place = rows[:, record.PLACE_COLUMN :][:, :COORDINATES]
    speed = rows[:, record.SPEED_COLUMN :][:, :COORDINATES]
    acceleration = rows[:, record.ACCELERATION_COLUMN :][:, :COORDINATES]
    channels = {
        "position": place[:, POSITION],
        "speed": speed[:, POSITION],
        "acceleration": acceleration[:, POSITION],
        "car_acceleration": acceleration @ stop.model.wagon.car_row,
        "car_heave": place[:, CAR_HEAVE],
        "car_pitch": place[:, CAR_PITCH],
    }
    for bogie in (0, 1):
        channels[f"bogie_{bogie + 1}_heave"] = place[:, BOGIE_HEAVE + 2 * bogie]
        channels[f"bogie_{bogie + 1}_pitch"] = place[:, BOGIE_PITCH + 2 * bogie]
    radius = stop.model.wagon.wheel_radius
    train_speed = np.maximum(np.abs(speed[:, POSITION]), CREEPAGE_SPEED_FLOOR)
    for i in WHEELS:
        rolling = radius * speed[:, WHEEL_SPIN + i - 1]
        channels[wheel(i, "heave")] = place[:, WHEEL_HEAVE + i - 1]
        channels[wheel(i, "speed")] = rolling
        channels[wheel(i, "creepage")] = (speed[:, POSITION] - rolling) / train_speed
        channels[wheel(i, "normal_force")] = rows[:, record.NORMAL_COLUMN + i - 1]
        channels[wheel(i, "tangential_force")] = rows[:, record.CREEP_COLUMN + i - 1]
        channels[wheel(i, "brake_torque")] = rows[:, record.TORQUE_COLUMN + i - 1]
        channels[wheel(i, "rail_deflection")] = rows[:, record.RAIL_COLUMN + i - 1]
    return channels | _liquid_channels(scenario, stop, rows, place, acceleration) | _energy_channels(rows)


def _liquid_channels(
    scenario: Scenario, stop: Problem, rows: Array, place: Array, acceleration: Array
) -> dict[str, Array]:
    """Slosh amplitudes, surface and the load's force and moment on the whole tank (model section 3).

    The force is the derivative of the liquid's momentum, the frozen part included.
    """
    if stop.model.shallow.cells:
        return _cell_channels(scenario, rows, acceleration)
    liquid, load = stop.model.liquid, frozen_load(scenario.tank)
    modes = liquid.mu.size
    amplitude = rows[:, record.SLOSH_COLUMN :][:, :modes]
    second = rows[:, record.SLOSH_COLUMN + modes :][:, :modes]
    tank_acceleration = acceleration @ stop.model.wagon.tank_row
    pitch, pitch_acceleration = place[:, CAR_PITCH], acceleration[:, CAR_PITCH]
    centre = tank_acceleration + load.centre_height * pitch_acceleration
    weight_arm = GRAVITY * load.mass * load.centre_height * pitch + WHOLE * amplitude @ liquid.pitch_weight
    channels = {
        "liquid_force": -load.mass * centre - WHOLE * second @ liquid.lambda_1,
        "liquid_moment": weight_arm
        - load.mass * load.centre_height * centre
        - load.pitch_inertia * pitch_acceleration
        - WHOLE * second @ liquid.lambda_02,
        "surface_front": amplitude @ liquid.side,
        "surface_rear": -amplitude @ liquid.side,
    }
    return channels | {slosh_amplitude(n + 1): amplitude[:, n] for n in range(modes)}


def _cell_channels(scenario: Scenario, rows: Array, acceleration: Array) -> dict[str, Array]:
    """Force and moment of the shallow-water liquid on the whole tank (means over steps), surface at both walls."""
    cells = rows[:, record.CELLS_COLUMN :]
    return {
        "liquid_force": WHOLE * cells[:, 0],
        "liquid_moment": WHOLE * cells[:, 1] - frozen_load(scenario.tank).pitch_inertia * acceleration[:, CAR_PITCH],
        "surface_front": cells[:, 2],
        "surface_rear": cells[:, 3],
    }


def _energy_channels(rows: Array) -> dict[str, Array]:
    stored = ("energy_kinetic", "energy_elastic", "energy_slosh")
    channels = {name: WHOLE * rows[:, record.ENERGY_COLUMN + k] for k, name in enumerate(stored)}
    for name, place in _LOSSES.items():
        channels[f"energy_{name}"] = WHOLE * rows[:, record.LOSS_COLUMN + place]
    channels["energy_residual"] = rows[:, record.RESIDUAL_COLUMN]
    return channels
