"""A wheel flat strikes once per turn, and lets its wheel down by its depth."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.runs import scenario, stop


def compute(data: CaseData) -> Outcome:
    """Number and spacing of the blows of a rolling wheel; depth of a flat that is crossed slowly."""
    found, given = Findings(data), data.reference
    result = stop(given["scenario"], *given["rolling"])
    turn = 2.0 * np.pi * result.scenario.wagon.wheelset.wheel_radius
    (flat,) = result.scenario.wagon.wheel_flats
    way, load = result.channels["position"], result.channels[f"wheel_{given['wheel']}_normal_force"]
    blows = _blows(way, load, 0.5 * turn)
    passed = int(np.floor((way[-1] - 0.5 * flat.length) / turn)) + 1
    found.compare("blows of the wheel with the flat", float(blows.size), float(passed), "blows")
    spacing = float(np.diff(blows).mean()) if blows.size > 1 else None
    found.compare("way from blow to blow / m", spacing, turn, "spacing")
    _cross_slowly(found)
    curves = [curve("wheel with the flat", way, load / 1e3)]
    return found.outcome(Chart((Panel("way / m", "normal force / kN", curves),)))


def _blows(way: Vector, load: Vector, apart: float) -> Vector:
    """Places (m) of the loads of a wheel that are close to the least of all, `apart` (m) or more from each other."""
    low = np.flatnonzero(load < 0.3 * load.mean() + 0.7 * load.min())
    groups = np.split(low, np.flatnonzero(np.diff(way[low]) > apart) + 1) if low.size else []
    return np.array([way[group[np.argmin(load[group])]] for group in groups])


def _cross_slowly(found: Findings) -> None:
    """How far the wheel is let down in the middle of its flat."""
    given = found.data.reference
    case, result = scenario(given["scenario"], *given["slow"]), stop(given["scenario"], *given["slow"])
    (flat,) = case.wagon.wheel_flats
    heave = (
        result.channels[f"wheel_{given['wheel']}_heave"] - result.channels[f"wheel_{given['wheel']}_rail_deflection"]
    )
    middle = int(np.argmin(np.abs(result.channels["position"] - 0.5 * flat.length)))
    depth = float(heave[0] - heave[middle])
    found.compare("wheel let down in the middle of its flat / mm", 1e3 * depth, 1e3 * flat.depth, "depth")
