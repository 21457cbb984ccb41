"""One stop, from scenario to result: what both the command line and Python scripts call."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any, cast

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.method import START
from slosh_cli.results.answers import PerWheel
from slosh_cli.results.channels import WHEELS
from slosh_cli.results.filling import filling_checks
from slosh_cli.results.histories import LOSS_PLACES, WHOLE, channels_of
from slosh_cli.results.line import check_covered
from slosh_cli.results.liquid_range import Motion, motion_checks, tank_checks
from slosh_cli.results.protection import protection_checks
from slosh_cli.results.recommendation import Recommendation, recommend, stop_deceleration
from slosh_cli.results.rest import rest_checks
from slosh_cli.results.result import Result, Status
from slosh_cli.results.slides import Slide, slide_check
from slosh_cli.results.surface import wetted_areas
from slosh_cli.results.train_result import CouplingResult, TrainResult, VehicleResult, gathered, slack_warnings
from slosh_cli.results.validity import Check, Extent, checks, warnings_of
from slosh_cli.results.wagon_range import residual_cause, wagon_checks
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import section_of
from slosh_cli.solver import advance
from slosh_cli.solver.run import RINGING, Cancel, Progress, Run, integrate, mean_speed
from slosh_cli.solver.setup import ReadyStop, problem, train_problem
from slosh_cli.solver.vehicle import Vehicle
from slosh_cli.tank.cells import CellLiquid
from slosh_cli.track.spectrum import realised_level
from slosh_cli.train.coupling import COUPLING_COLUMNS
from slosh_cli.wagon.model import POSITION

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
    static_loads, run = _per_wheel(stop.static_loads), integrate(stop, progress, cancel)
    vehicle, time = stop.vehicle, stop.train.time
    end, account, braked = vehicle.points[START], vehicle.account, vehicle.brake.breaks > 0
    check_covered(scenario, float(end.q[POSITION]))
    status, reason = _ending(run, braked)
    stopped, tank, weight = status is Status.STOPPED, scenario.tank, stop.weight
    advice = _recommended(scenario)
    verdicts = _verdicts(scenario, stop, run, advice)
    distance = float(end.q[POSITION] - account.onset_position) if stopped else None
    if distance is not None:
        verdicts += protection_checks(scenario, [stop], distance, progress, cancel)
    return Result(
        scenario=scenario,
        status=status,
        reason=reason.format(time=time, speed=end.v[POSITION]),
        warnings=tuple(warnings_of(verdicts)),
        checks=verdicts,
        recommendation=advice,
        time=run.rows[:, 0, 0],
        channels=channels_of(scenario, vehicle, run.rows[:, 0]),
        braking_distance_m=distance,
        braking_time_s=time - account.onset_time if stopped else None,
        max_surface_m=account.surface,
        surface_limit_m=section_of(tank).height * (1 - tank.fill),
        static_wheel_load_N=static_loads,
        mean_total_wheel_load_N=WHOLE * (account.load_seconds / account.seconds if account.seconds > 0 else weight),
        weight_N=WHOLE * weight,
        **_of_wheels(scenario, vehicle, static_loads),
        unevenness_d1_m=realised_level(scenario.track.unevenness, float(end.q[POSITION])),
        energy_residual=stop.train.largest_residual,
        energy=_final_energy(stop),
        steps=stop.train.steps,
        rejected_steps=stop.train.rejected,
        work=_work(stop),
        solve_seconds=run.seconds,
        wetted=wetted_areas(vehicle.liquid),
    )


def _ending(run: Run, braked: bool) -> tuple[Status, str]:
    """How the run ended and why, times and speeds still to be put in."""
    status, reason = _OUTCOMES[run.outcome]
    if status is Status.STOPPED and not braked:
        return Status.FAILED, "came to rest at t = {time:.4g} s, before the brake set in: no braking distance"
    return status, reason


def simulate_train(
    train: TrainScenario, *, progress: Progress | None = None, cancel: Cancel | None = None
) -> TrainResult:
    """Integrate the stop of a train; the rest as for one stop."""
    stops = train_problem(train.vehicles, train.file.coupling)
    run = integrate(stops[0], progress, cancel)
    first, clock = stops[0].vehicle, run.train.time
    place, braked = float(first.points[START].q[POSITION]), first.brake.breaks > 0
    status, reason = _ending(run, braked)
    stopped = status is Status.STOPPED
    vehicles = tuple(_of_vehicle(scenario, stop, run) for scenario, stop in zip(train.vehicles, stops, strict=True))
    distance = place - first.account.onset_position if stopped else None
    if distance is not None:
        verdicts = (*vehicles[0].checks, *protection_checks(train, stops, distance, progress, cancel))
        vehicles = (replace(vehicles[0], checks=verdicts), *vehicles[1:])
    return TrainResult(
        scenario=train,
        status=status,
        reason=reason.format(time=clock, speed=mean_speed(run.train)),
        warnings=(*gathered([vehicle.checks for vehicle in vehicles]), *slack_warnings(train)),
        time=run.rows[:, 0, 0],
        braking_distance_m=distance,
        braking_time_s=clock - first.account.onset_time if stopped else None,
        vehicles=vehicles,
        couplings=_of_couplings(run),
        energy_residual=run.train.largest_residual,
        steps=run.train.steps,
        rejected_steps=run.train.rejected,
        solve_seconds=run.seconds,
    )


def _of_vehicle(scenario: Scenario, stop: ReadyStop, run: Run) -> VehicleResult:
    """The answers of one vehicle of a train, its histories made when they are asked for."""
    vehicle, static_loads = stop.vehicle, _per_wheel(stop.static_loads)
    place, account, advice = float(vehicle.points[START].q[POSITION]), vehicle.account, _recommended(scenario)
    check_covered(scenario, place - vehicle.line.behind)
    wheels = _of_wheels(scenario, vehicle, static_loads)
    return VehicleResult(
        scenario=scenario,
        distance_m=place - account.onset_position if vehicle.brake.breaks > 0 else place,
        max_surface_m=account.surface,
        surface_limit_m=section_of(scenario.tank).height * (1 - scenario.tank.fill),
        static_wheel_load_N=static_loads,
        **{name: wheels[name] for name in ("min_wheel_load_N", "max_wheel_load_N", "locked_time_s")},
        checks=_verdicts(scenario, stop, run, advice),
        recorded=partial(channels_of, scenario, vehicle, run.rows[:, stop.place]),
        wetted=wetted_areas(vehicle.liquid),
    )


def _of_couplings(run: Run) -> tuple[CouplingResult, ...]:
    """The answers of the couplings of a train from the front."""
    law = run.train.couplings
    return tuple(
        CouplingResult(
            max_compression_N=float(law.largest[j]),
            max_tension_N=float(0.0 - law.least[j]),
            max_compression_m=float(law.nearest[j]),
            max_tension_m=float(0.0 - law.farthest[j]),
            max_compression_s=float(law.largest_time[j]),
            max_tension_s=float(law.least_time[j]),
            energy_taken_J=float(law.taken[j]),
            force=run.rows[:, j, -COUPLING_COLUMNS],
            compression=run.rows[:, j, 1 - COUPLING_COLUMNS],
        )
        for j in range(law.origin.size)
    )


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


def _of_wheels(scenario: Scenario, vehicle: Vehicle, static_loads: PerWheel) -> dict[str, Any]:
    """Extremes of the wheels since the onset; what slide protection counted, summed over the wheelsets."""
    account, brake, braked = vehicle.account, vehicle.brake, vehicle.brake.breaks > 0
    protected = scenario.braking.slide_protection is not None
    return {
        "min_wheel_load_N": _per_wheel(account.least) if braked else static_loads,
        "max_wheel_load_N": _per_wheel(account.largest) if braked else static_loads,
        "locked_time_s": _per_wheel(account.locked_time),
        "speed_at_first_lock_m_s": min(((one.start, one.speed) for one in _slides(account)), default=(0.0, None))[1],
        "brake_torque_max_N_m": _per_wheel(account.largest_torque),
        "slide_protection_cycles": float(brake.vents.sum()) if protected else None,
        "slide_protection_air": float(brake.air.sum()) if protected else None,
    }


def _recommended(scenario: Scenario) -> Recommendation | None:
    """The model of the liquid that suits this stop; None for a load that is frozen on purpose."""
    if scenario.tank.liquid.model == "rigid":
        return None
    return recommend(scenario.tank, stop_deceleration(scenario))


def _verdicts(scenario: Scenario, stop: ReadyStop, run: Run, advice: Recommendation | None) -> tuple[Check, ...]:
    """All that is to be said of a run: of its liquid, its wheels and ledger, its wagon and track; of a wagon alone, its
    rest."""
    tank, sentence = scenario.tank, advice.sentence if advice else ""
    liquid, stopped = stop.vehicle.liquid, run.outcome == advance.STOPPED and stop.vehicle.brake.breaks > 0
    alone = len(stop.train.vehicles) == 1
    flowing = isinstance(liquid, CellLiquid)
    head = max(liquid.deepest - float(liquid.shallow.table.depth[-1]), 0.0) if flowing else 0.0
    account = stop.vehicle.account
    seconds = stop.train.time - account.onset_time if stopped else None
    part = liquid.shallow.mass * STANDARD_GRAVITY / stop.weight if flowing else 0.0
    motion = Motion(account.surface, head, seconds=seconds, part=part)
    return (
        *tank_checks(tank, sentence),
        *motion_checks(tank, motion, sentence),
        *checks(_extent(scenario, stop, run)),
        slide_check(_slides(account), scenario),
        *filling_checks(tank, scenario.limits),
        *wagon_checks(scenario),
        *(rest_checks(scenario, stop) if stopped and alone else ()),
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
        unloading_limit=scenario.limits.unloading,
    )


def _slides(account: Any) -> list[Slide]:
    """What the wheels that locked did, by the account of their vehicle."""
    found = zip(
        WHEELS, account.locked_time, account.lock_time, account.lock_speed, account.slid, account.slid_work, strict=True
    )
    return [Slide(wheel, *map(float, numbers)) for wheel, *numbers in found if numbers[0] > 0.0]


def _final_energy(stop: ReadyStop) -> dict[str, float]:
    """The ledger at the end of the run, J of the whole wagon."""
    account = stop.vehicle.account
    kinetic, elastic, slosh = WHOLE * account.energies
    losses = WHOLE * account.losses
    return {
        "initial_kinetic": WHOLE * stop.train.initial_kinetic,
        "initial_total": WHOLE * stop.train.total_start,
        "kinetic": float(kinetic),
        "elastic": float(elastic),
        "slosh": float(slosh),
        **{name: float(losses[place]) for name, place in LOSS_PLACES.items()},
    }
