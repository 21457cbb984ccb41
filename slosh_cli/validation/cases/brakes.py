"""Stops under brakes that fade and build up: quadrature, a closed form, braked weight and the laws' own numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from slosh_cli.results.result import Result
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Curve, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.friction import friction_law, ramped_stop
from slosh_cli.validation.exact.wagon import point_wagon, stopping
from slosh_cli.validation.runs import distance, scenario, stop
from slosh_cli.wagon.torque import brake_torque

_KM_H = 1 / 3.6  # in m/s


def compute(data: CaseData) -> Outcome:
    """Distances of every law, of a build-up and of braked weights; coefficients at the values that are known."""
    found = Findings(data)
    curves = [line for brake in data.reference["brakes"] for line in _by_quadrature(found, brake)]
    _built_up(found)
    _braked_weights(found)
    _coefficients(found)
    _mean_coefficient(found)
    return found.outcome(Chart((Panel("distance from the onset / m", "speed / km/h", curves),)))


def _stop(data: CaseData, braking: str, *more: str) -> tuple[Result, tuple[str, ...]]:
    """A stiff wagon's stop under the keys `braking`, and the words that ask for it."""
    words = (*data.reference["stiff"], *more, f"braking={{{braking}}}")
    return stop(data.reference["scenario"], *words), words


def _torque(brake: Any, law: Callable[[float, float], float]) -> Callable[[float], float]:
    """Torque (N m) of a wheel at a speed (m/s), fully applied, from the numbers of the data file."""
    moment = 1e3 * brake["count"] * brake["force"] * brake["arm"]
    return lambda v: moment * law(v / _KM_H, brake["force"])


def _by_quadrature(found: Findings, brake: Any) -> list[Curve]:
    """`ds = V dV/a(V)` after a step; returns the speed over the distance by both."""
    data = found.data
    result, words = _stop(data, f"initial_speed: {brake['speed']} km/h, onset: 0.5 s, {brake['keys']}")
    case = scenario(data.reference["scenario"], *words)
    wagon, torque = point_wagon(case), _torque(brake, friction_law(brake["law"]))

    def expected(speed: float) -> tuple[float, float]:
        return stopping(wagon, case.braking.initial_speed, torque, case.braking.onset, speed, 0.0)

    metres, seconds = expected(case.braking.stop_speed)
    found.compare(f"braking distance, {brake['label']} / m", distance(result), metres, "quadrature")
    found.compare(f"braking time, {brake['label']} / s", result.braking_time_s, seconds, "quadrature")
    speeds = np.linspace(case.braking.stop_speed, 0.99 * case.braking.initial_speed, 40)
    on = result.time >= case.braking.onset
    travelled = result.channels["position"][on] - result.channels["position"][on][0]
    exact = curve(f"{brake['label']}: quadrature", [expected(v)[0] for v in speeds], speeds / _KM_H, exact=True)
    return [exact, curve(brake["label"], travelled[::100], result.channels["speed"][on][::100] / _KM_H, marks=True)]


def _built_up(found: Findings) -> None:
    """A build-up longer than the step by `V0 tau/2 - A tau^2/24`: constant torque, no resistance."""
    given = found.data.reference["build_up"]
    free = found.data.reference["no_resistance"]
    for torque, speed, time in given["torque_speed_time"]:
        keys = f"initial_speed: {speed} km/h, onset: 0 s, torque: {torque} kN m"
        at_once, words = _stop(found.data, keys, free)
        ramped, _ = _stop(found.data, f"{keys}, application: {{form: linear, time: {time} s}}", free)
        wagon = point_wagon(scenario(found.data.reference["scenario"], *words))
        full = 8e3 * torque / wagon.wheel_radius / (wagon.mass + wagon.rotating_mass)
        longer = speed * _KM_H * time / 2 - full * time**2 / 24
        label = f"{torque:g} kN m from {speed:g} km/h built up in {time:g} s"
        source = "V0 tau/2 - A tau^2/24"
        found.compare(f"{label}: longer by / m", distance(ramped) - distance(at_once), longer, "build_up", source)
        exact = ramped_stop(speed * _KM_H, full, time)
        found.compare(f"{label}: braking distance / m", distance(ramped), exact, "build_up", source)


def _braked_weights(found: Findings) -> None:
    """The full wagon on its springs and rail, with the build-up that the brake assessment assumes."""
    application = "application: {form: table, points: [[0 s, 0], [0.2 s, 0], [4.2 s, 1]]}"
    for percentage, speed, metres in found.data.reference["braked_weight"]:
        weight = f"braked_weight: {{percentage: {percentage}, speed: {speed} km/h}}"
        braking = f"braking={{initial_speed: {speed} km/h, onset: 0 s, {weight}, {application}}}"
        label = f"braked weight {percentage} % from {speed} km/h"
        solid = distance(stop("paper-80-solid", braking))
        found.compare(f"{label}, solid load: braking distance / m", solid, metres, "braked_weight", _UIC)
        liquid = distance(stop("paper-80-liquid", braking))
        found.note(f"{label}, half-filled tank: braking distance / m", liquid, float(metres), _UIC)


_UIC = "S = C/(lambda + D) of UIC 544-1 for single vehicles"


def _coefficients(found: Findings) -> None:
    """Coefficients that the program brakes with at full application, beside known values."""
    for law, force, speed, known in found.data.reference["coefficients"]:
        keys = f"initial_speed: 100 km/h, onset: 0 s, blocks: {{count: 1, force: {force} kN, friction: {law}}}"
        case = scenario(found.data.reference["scenario"], f"braking={{{keys}}}")
        torque = brake_torque(case, speed * _KM_H)
        value = torque / (1e3 * force * case.wagon.wheelset.wheel_radius)
        found.compare(f"friction coefficient, {law}, {force} kN, {speed} km/h", value, known, "printed")


def _mean_coefficient(found: Findings) -> None:
    """What the brakes took over what the blocks' forces and the distance make."""
    law, force, speed, known = found.data.reference["mean_coefficient"]
    for count, resistance in ((1, ()), (2, (found.data.reference["no_resistance"],))):
        blocks = f"blocks: {{count: {count}, force: {force} kN, friction: {law}}}"
        result, _ = _stop(found.data, f"initial_speed: {speed} km/h, onset: 0 s, {blocks}", *resistance)
        taken = float(result.channels["energy_brake"][-1])
        mean = taken / (8e3 * count * force * distance(result))
        words = "no running resistance" if resistance else "running resistance"
        label = f"mean over the distance, {law}, {force} kN, from {speed} km/h, blocks per wheel: {count}, {words}"
        found.compare(label, mean, known, "mean")
