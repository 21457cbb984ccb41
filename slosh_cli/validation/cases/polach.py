"""Polach's creep force law as the time loop uses it against the law itself, its peaks and its limits."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np

from slosh_cli.track import contact
from slosh_cli.validation import kernels
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Curve, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.creep import PolachParameters, adhesion, ellipse, friction
from slosh_cli.validation.runs import scenario

_LOAD = 93e3


def compute(data: CaseData) -> Outcome:
    """Whole curves, peaks, and both ends of the curves, on dry and wet rail."""
    found, curves = Findings(data), []
    peaks: dict[tuple[str, float], tuple[float, float]] = {}
    for rail in ("dry", "wet"):
        printed = PolachParameters(**data.reference[rail])
        gradient = _gradient()
        for speed in data.reference["speeds"]:
            ours = _program(rail, speed)
            name = f"{rail}, {speed:g} m/s"
            law = _law(printed, gradient, speed)
            _whole_curve(found, name, ours, law)
            place, height = _peak(law)
            our_place, our_height = _peak(ours)
            peaks[rail, speed] = our_place, our_height
            found.compare(f"creepage of the peak, {name} / %", 100 * our_place, 100 * place, "peak_place")
            found.compare(f"height of the peak, {name}", our_height, height, "law")
            _limits(found, name, printed, gradient, ours)
        curves += _curves(rail, printed, gradient, data.reference["speeds"][0])
    _published_behaviour(data, found, peaks)
    return found.outcome(Chart((Panel("creepage", "tangential / normal force", curves, log_x=True),)))


def _gradient() -> float:
    """`eps = gradient creepage / mu`: G pi a b c11 / (4 N) under the load."""
    case = scenario("paper-80-liquid")
    steel = case.contact
    a, b, _ = ellipse(
        case.wagon.wheelset.wheel_radius, steel.rail_crown_radius, steel.youngs_modulus, steel.poisson_ratio, _LOAD
    )
    shear = steel.youngs_modulus / (2 * (1 + steel.poisson_ratio))
    return shear * pi * a * b * steel.kalker_c11 / (4 * _LOAD)


def _law(printed: PolachParameters, gradient: float, speed: float) -> Callable[[float], float]:
    return lambda creepage: adhesion(printed, gradient, creepage, speed)


def _program(rail: str, speed: float) -> Callable[[float], float]:
    case = scenario("paper-80-liquid", f"contact.adhesion={rail}")
    model = contact.contact_model(case.contact, case.wagon.wheelset.wheel_radius)
    return lambda creepage: kernels.creep_force(model, _LOAD, creepage * speed, speed) / _LOAD


def _whole_curve(found: Findings, name: str, ours: Callable[[float], float], law: Callable[[float], float]) -> None:
    creepages = np.geomspace(1e-6, 1.0, 61)
    gaps = [abs(ours(float(nu)) / law(float(nu)) - 1) for nu in creepages]
    found.limit(f"largest relative difference of the curve, {name}", max(gaps), "law_everywhere")


def _peak(law: Callable[[float], float]) -> tuple[float, float]:
    """Creepage and height of the largest adhesion."""
    from scipy.optimize import minimize_scalar

    grid = np.geomspace(1e-4, 1.0, 400)
    best = int(np.argmax([law(float(nu)) for nu in grid]))
    bounds = (float(grid[max(best - 1, 0)]), float(grid[min(best + 1, grid.size - 1)]))
    found = minimize_scalar(lambda nu: -law(nu), bounds=bounds, method="bounded", options={"xatol": 1e-9})
    return float(found.x), float(-found.fun)


def _limits(found: Findings, name: str, p: PolachParameters, gradient: float, ours: Callable[[float], float]) -> None:
    """Kalker's linear law, reduced, for no slip; friction for a locked wheel whose contact is all slip."""
    tiny = 1e-8
    linear = 2 / pi * gradient * tiny * (p.kA + p.kS)
    found.compare(f"initial slope over Kalker's times (kA + kS)/2, {name}", ours(tiny) / linear, 1.0, "linear")
    far = 1e6
    case = scenario("paper-80-liquid", f"contact.adhesion={'dry' if p.kA == 1.0 else 'wet'}")
    model = contact.contact_model(case.contact, case.wagon.wheelset.wheel_radius)
    sliding = kernels.creep_force(model, _LOAD, far * 0.05, 0.05) / _LOAD
    found.compare(f"complete sliding over friction, {name}", sliding / friction(p, far * 0.05), 1.0, "sliding")


def _published_behaviour(data: CaseData, found: Findings, peaks: dict[tuple[str, float], tuple[float, float]]) -> None:
    """What the source shows of measured locomotives: see the data file."""
    for rail in ("dry", "wet"):
        (low, high), (least, most) = data.reference["peak_creepage"][rail], data.reference["peak_height"][rail]
        speed = data.reference["speeds"][0]
        place, height = peaks[rail, speed]
        found.verdict(
            f"{rail} rail at {speed:g} m/s: peak between {100 * low:g} and {100 * high:g} % of creepage",
            "yes" if low <= place <= high else f"no, at {100 * place:.2f} %",
            "yes",
        )
        found.verdict(
            f"{rail} rail at {speed:g} m/s: peak between {least:g} and {most:g}",
            "yes" if least <= height <= most else f"no, {height:.3f}",
            "yes",
        )
    falling = all(peaks[rail, 10.0][1] > peaks[rail, 40.0][1] for rail in ("dry", "wet"))
    found.verdict("the peak falls with speed", "yes" if falling else "no", "yes")


def _curves(rail: str, printed: PolachParameters, gradient: float, speed: float) -> list[Curve]:
    creepages = np.geomspace(1e-4, 1.0, 200)
    ours = _program(rail, speed)
    law = [adhesion(printed, gradient, float(nu), speed) for nu in creepages]
    sparse = creepages[::8]
    return [
        curve(f"{rail}, the law at {speed:g} m/s", creepages, law, exact=True),
        curve(f"{rail}, program", sparse, [ours(float(nu)) for nu in sparse], marks=True),
    ]
