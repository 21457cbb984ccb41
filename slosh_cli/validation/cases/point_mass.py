"""A wagon that cannot pitch on a rail that does not give stops like a point mass with rotating wheels."""

from __future__ import annotations

from math import atan, pi

import numpy as np

from slosh_cli.scenario import Scenario
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.creep import ellipse
from slosh_cli.validation.exact.wagon import PointWagon, point_wagon, stopping
from slosh_cli.validation.runs import distance, scenario, stop
from slosh_cli.wagon.torque import brake_torque


def compute(data: CaseData) -> Outcome:
    """Distance and time at two speeds and several torques, with little slip and with ordinary slip."""
    found, curves = Findings(data), []
    stiff, torques = data.reference["stiff"], data.reference["torques"]
    for name in data.reference["scenarios"]:
        ours = []
        for torque in torques:
            for slip, kalker in (("next to no slip", 100.0), ("ordinary slip", 4.12)):
                words = (*stiff, f"contact.kalker_c11={kalker}", f"braking.torque={torque} kN m")
                result, case = stop(name, *words), scenario(name, *words)
                metres, seconds = _expected(case)
                label = f"{case.braking.initial_speed * 3.6:.0f} km/h, {torque:g} kN m, {slip}"
                found.compare(f"braking distance, {label} / m", distance(result), metres, "distance")
                found.compare(f"braking time, {label} / s", result.braking_time_s, seconds, "distance")
                if kalker < 100.0:
                    ours.append(distance(result))
        smooth = np.linspace(min(torques), max(torques), 40)
        exact = [_expected(scenario(name, *stiff, f"braking.torque={torque} kN m"))[0] for torque in smooth]
        curves.append(curve(f"{name}: point mass", smooth, exact, exact=True))
        curves.append(curve(f"{name}: program", torques, ours, marks=True))
    _ordinary_wagon(found)
    return found.outcome(Chart((Panel("brake torque per wheel / kN m", "braking distance / m", curves),)))


def _expected(case: Scenario) -> tuple[float, float]:
    wagon, braking, torque = point_wagon(case), case.braking, brake_torque(case, 0.0)
    nu = _creepage(case, wagon, torque / wagon.wheel_radius)
    return stopping(wagon, braking.initial_speed, lambda _: torque, braking.onset, braking.stop_speed, nu)


def _creepage(case: Scenario, wagon: PointWagon, force: float) -> float:
    """Creepage at which Polach's law gives `force` (N) under the static load; so little slip leaves friction at mu0."""
    from scipy.optimize import brentq

    steel, p = case.contact, case.contact.adhesion
    a, b, _ = ellipse(
        wagon.wheel_radius, steel.rail_crown_radius, steel.youngs_modulus, steel.poisson_ratio, wagon.wheel_load
    )
    shear = steel.youngs_modulus / (2 * (1 + steel.poisson_ratio))
    load = wagon.wheel_load

    def surplus(nu: float) -> float:
        eps = shear * pi * a * b * steel.kalker_c11 * nu / (4 * p.mu0 * load)
        return 2 * p.mu0 * load / pi * (p.kA * eps / (1 + (p.kA * eps) ** 2) + atan(p.kS * eps)) - force

    return float(brentq(surplus, 0.0, 0.01, xtol=1e-16))


def _ordinary_wagon(found: Findings) -> None:
    """The shipped wagons on their springs and rail: suspension and slosh only shift a stop a little."""
    for name in ("paper-80-liquid", "paper-80-solid"):
        metres, _ = _expected(scenario(name))
        found.compare(f"braking distance, {name} as shipped / m", distance(stop(name)), metres, "shipped")
