"""A stiff wagon on a gradient stops like a point mass; a wagon that rolls freely leaves its liquid at rest."""

from __future__ import annotations

import numpy as np

from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.wagon import point_wagon
from slosh_cli.validation.runs import distance, scenario, stop
from slosh_cli.wagon.torque import brake_torque


def compute(data: CaseData) -> Outcome:
    """Distances on constant gradients and on a profile, and the surface of a liquid on a free roll."""
    found, given = Findings(data), data.reference
    words, ours = (*given["stiff"], *given["free"]), []
    for gradient in given["gradients"]:
        case = (given["stop"], *words, f"track.gradient={gradient}")
        ours.append(distance(stop(*case)))
        label = f"braking distance on {1e3 * gradient:g} permille / m"
        found.compare(label, ours[-1], _expected(scenario(*case), [[0.0, gradient]]), "distance")
    text = ", ".join(f"[{place} m, {gradient}]" for place, gradient in given["profile"])
    case = (given["stop"], *words, f"track.gradient=[{text}]")
    found.compare(
        "braking distance on a profile / m", distance(stop(*case)), _expected(scenario(*case), given["profile"]),
        "distance",
    )  # fmt: skip
    roll = stop(given["roll"], *given["free"], *given["rolling"])
    surface = _free_roll(found, roll)
    smooth = np.linspace(min(given["gradients"]), max(given["gradients"]), 40)
    level = scenario(given["stop"], *words)
    exact = [_expected(level, [[0.0, gradient]]) for gradient in smooth]
    curves = [curve("point mass", 1e3 * smooth, exact, exact=True)]
    curves.append(curve("program", 1e3 * np.array(given["gradients"]), ours, marks=True))
    swing = [curve("free roll", roll.time[::10], 1e3 * roll.channels["surface_front"][::10])]
    swing.append(curve("twice the tilt that spin inertia leaves", roll.time[[0, -1]], [1e3 * surface] * 2, exact=True))
    panels = (Panel("gradient / permille", "braking distance / m", curves), Panel("time / s", "surface / mm", swing))
    return found.outcome(Chart(panels))


def _expected(case: Scenario, profile: list[list[float]]) -> float:
    """Distance (m) at which brakes and height have taken the point mass's energy."""
    from scipy.optimize import brentq

    wagon, braking = point_wagon(case), case.braking
    effective = wagon.mass + wagon.rotating_mass
    slowing = 8.0 * brake_torque(case, 0.0) / wagon.wheel_radius / effective
    places, gradients = np.array(profile, dtype=np.float64).T
    along = np.union1d(places, np.linspace(0.0, 2000.0, 20_001))
    gradient = np.interp(along, places, gradients)
    height = np.concatenate([[0.0], np.cumsum(0.5 * (gradient[1:] + gradient[:-1]) * np.diff(along))])

    def left(metres: float) -> float:
        climbed = STANDARD_GRAVITY * wagon.mass / effective * np.interp(metres, along, height)
        return float(0.5 * (braking.initial_speed**2 - braking.stop_speed**2) - slowing * metres - climbed)

    return float(brentq(left, 0.0, 2000.0, xtol=1e-9))


def _free_roll(found: Findings, roll: Result) -> float:
    """Speed and surface of a wagon that rolls down; returns the surface's largest rise (m)."""
    wagon, tank = point_wagon(roll.scenario), roll.scenario.tank
    (pull,) = (-STANDARD_GRAVITY * gradient for _, gradient in roll.scenario.track.gradient_points)
    share = wagon.mass / (wagon.mass + wagon.rotating_mass)
    gained = float(roll.channels["speed"][-1] - roll.channels["speed"][0])
    found.compare("speed after a free roll, over V0", 1.0 + gained / roll.initial_speed_m_s,
                  1.0 + share * pull * float(roll.time[-1]) / roll.initial_speed_m_s, "speed")  # fmt: skip
    tilt = pull * (1.0 - share) / STANDARD_GRAVITY
    rise = 2.0 * tilt * 0.5 * tank.length * 8.0 / np.pi**2  # the first mode's part of a tilted surface
    largest = max(float(np.abs(roll.channels[f"surface_{end}"]).max()) for end in ("front", "rear"))
    found.compare("largest rise of the surface on a free roll / mm", 1e3 * largest, 1e3 * rise, "tilt")
    return float(rise)
