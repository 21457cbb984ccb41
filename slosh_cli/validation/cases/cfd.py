"""Force and moment of the braked tank beside three- and two-dimensional computations of a free surface (interFoam)."""

from __future__ import annotations

from typing import Any

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.scenario import find_packaged, load_any_scenario
from slosh_cli.solver.deceleration import Deceleration
from slosh_cli.solver.excite import Excitation, excite
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData, data_rows

_STEP = 0.02


def compute(data: CaseData) -> Outcome:
    """The histories that `decides` names under their tolerances, each with linear theory where the tank is open."""
    found, panels = Findings(data), []
    for name in data.reference["decides"]:
        case = data.reference["cases"][name]
        rows = data_rows(f"cfd_{name}.csv")
        time, force, moment = (np.array([float(row[key]) for row in rows]) for key in case["columns"])
        flowing = _braked(data, case, "shallow-water", float(time[-1]))
        dispersed = _braked(data, case, "shallow-water, dispersion: on", float(time[-1]))
        given = np.interp(flowing.time, time, force)
        unit, title = flowing.mass * flowing.largest_deceleration, case["title"]
        curves = [curve("interFoam", time, force / unit, exact=True)]
        curves.append(curve("shallow water", flowing.time, flowing.force / unit))
        found.limit(f"rms of the force over m a, {title}", _rms(flowing.force - given) / unit, f"force_{name}")
        found.compare(f"peak moment / N m, {title}", float(flowing.moment.max()), float(moment.max()), f"moment_{name}")
        found.note(f"peak force / N, {title}", float(flowing.force.max()), float(force.max()))
        found.note(f"force over m a at once, {title}", float(flowing.force[1] / unit), float(force[0] / unit))
        late = f"with dispersion, {title}"
        found.limit(f"rms of the force over m a {late}", _rms(dispersed.force - given) / unit, f"dispersed_{name}")
        peak = float(dispersed.moment.max())
        found.compare(f"peak moment / N m {late}", peak, float(moment.max()), f"moment_{name}")
        found.note(f"peak force / N {late}", float(dispersed.force.max()), float(force.max()))
        found.note(f"force over m a at once {late}", float(dispersed.force[1] / unit), float(force[0] / unit))
        curves.append(curve("with dispersion", dispersed.time, dispersed.force / unit))
        if case["linear"]:
            linear = _braked(data, case, "modal", float(time[-1]))
            found.note(f"rms of the force over m a, linear theory, {title}", _rms(linear.force - given) / unit)
            curves.append(curve("linear theory, one mode", linear.time, linear.force / unit))
        panels.append(Panel("time / s", "force over m a", curves, title=title))
    return found.outcome(Chart(panels))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _braked(data: CaseData, case: Any, model: str, duration: float) -> Excitation:
    """What the liquid does in the tank of a case, told every `_STEP`."""
    liquid = f"{{model: {model}, density: {data.reference['density']} kg/m^3}}"
    words = f"tank={{{case['tank']}, length: {data.reference['length']} m, liquid: {liquid}}}"
    course = Deceleration.ramped(case["deceleration"], case["ramp"])
    return excite(load_any_scenario(find_packaged("kolaei-half"), [words]).tank, course, duration, _STEP)
