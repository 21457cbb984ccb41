"""Published stopping distances of goods trains: two numbers fitted to the level, then gravity on gradients."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.friction import ramped_stop
from slosh_cli.validation.exact.wagon import point_wagon
from slosh_cli.validation.runs import distance, scenario, stop

_KM_H = 1 / 3.6  # in m/s


def compute(data: CaseData) -> Outcome:
    """The program's stops with the fitted numbers beside closed form and table, level and on gradients."""
    found, panels = Findings(data), []
    for train, figures in data.reference["trains"].items():
        deceleration, equivalent = fitted([row for row in figures if row[1] == 0])
        found.note(f"{train}: deceleration that fits the level / m/s^2", deceleration)
        found.note(f"{train}: equivalent time that fits the level, half of the build-up / s", equivalent)
        shown = []
        for speed, grade, published in figures:
            metres, exact = _stops(data, speed, grade, deceleration, equivalent)
            shown.append((speed, grade, metres))
            where = f"{speed:g} km/h, {_gradient(grade)}"
            found.compare(f"{train}: program, {where} / m", metres, exact, "closed_form", _CLOSED)
            if grade == 0 or abs(grade) >= data.reference["decides_from_1_in"]:
                tolerance = "gradient" if grade else "level"
                found.compare(f"{train}: program beside the table, {where} / m", metres, published, tolerance)
            else:
                found.note(f"{train}: program beside the table, {where} / m", metres, float(published))
        panels.append(_panel(train, figures, shown, deceleration, equivalent))
    for train, spread in data.reference["whole_table"].items():
        found.note(f"{train}, whole table: {_WHOLE}", _sentence(spread))
    return found.outcome(Chart(panels))


def fitted(level: Sequence[Sequence[float]]) -> tuple[float, float]:
    """Deceleration (m/s^2) and equivalent time (s) by least squares of the relative error.

    `level` has rows of speed (km/h), gradient and distance (m). The deceleration is thought to build up evenly over
    twice the equivalent time.
    """
    from scipy.optimize import least_squares

    def errors(guess: Any) -> list[float]:
        return [ramped_stop(row[0] * _KM_H, guess[0], 2 * guess[1]) / row[2] - 1 for row in level]

    best = least_squares(errors, (0.5, 5.0), bounds=((0.01, 0.0), (5.0, 100.0)), xtol=1e-12, ftol=1e-12).x
    return float(best[0]), float(best[1])


_CLOSED = "V T/2 + V^2/(2 A) - A T^2/24 on the level, the same motion with gravity on gradients"
_WHOLE = "deceleration / m/s^2, equivalent time / s, errors of the fit in per cent (ours, from every figure)"


def _gradient(grade: float) -> str:
    return "level" if grade == 0 else f"1 in {abs(grade):g} {'up' if grade > 0 else 'down'}"


def _sentence(spread: Sequence[Any]) -> str:
    a, t, *errors = spread
    level, worst, up, worst_up, gentle, worst_gentle, steep = errors
    return (
        f"{a} and {t}; level {level} rms, {worst} at worst; uphill {up} rms, {worst_up} at worst; downhill to 1 in 100 "
        f"{gentle} rms, {worst_gentle} at worst; steeper downhill {steep} at worst"
    )


def _stops(data: CaseData, speed: float, grade: float, deceleration: float, equivalent: float) -> tuple[float, float]:
    """The program's distance and the closed form's, m. The brake slows the wheels' turning too, gravity does not."""
    application = f"{{form: linear, time: {2 * equivalent:.6f} s}}"
    braking = (
        f"braking={{initial_speed: {speed} km/h, onset: 0 s, deceleration: {deceleration:.8f} m/s^2, "
        f"application: {application}}}"
    )
    words = (*data.reference["stiff"], braking, f"track.gradient={1 / grade if grade else 0.0:.12f}")
    case = scenario(data.reference["scenario"], *words)
    wagon = point_wagon(case)
    pull = STANDARD_GRAVITY * case.track.gradient_points[0][1] * wagon.mass / (wagon.mass + wagon.rotating_mass)
    exact = ramped_stop(speed * _KM_H, deceleration, 2 * equivalent, pull)
    return distance(stop(data.reference["scenario"], *words)), exact


def _panel(
    train: str, figures: Sequence[Sequence[float]], shown: Sequence[Sequence[float]], a: float, equivalent: float
) -> Panel:
    speeds = np.linspace(10.0, 120.0, 60)
    curves = []
    for grade in sorted({row[1] for row in figures}):
        words = _gradient(grade)
        pull = STANDARD_GRAVITY / grade if grade else 0.0
        metres = [ramped_stop(v * _KM_H, a, 2 * equivalent, pull) for v in speeds]
        curves.append(curve(f"{words}: two numbers", speeds, metres, exact=True))
        table = [(row[0], row[2]) for row in figures if row[1] == grade]
        curves.append(curve(f"{words}: table", *np.transpose(table), marks=True))
    curves.append(curve("program", [row[0] for row in shown], [row[2] for row in shown], marks=True))
    return Panel("speed / km/h", "stopping distance / m", curves, title=train)
