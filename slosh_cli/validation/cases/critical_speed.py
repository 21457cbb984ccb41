"""The critical speed: from free waves, from the steady solutions on the way there, and as a refusal."""

from __future__ import annotations

import numpy as np

from slosh_cli.errors import PhysicsError
from slosh_cli.solver.setup import problem
from slosh_cli.track import mem
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.paper_track import WHEEL_PLACES, at, beam, paper_track, steady_deflections
from slosh_cli.validation.runs import scenario

_SHARES = np.linspace(0.3, 0.9, 7)
_ELEMENT_LENGTH = 0.25
_LONG = 160.0


def compute(data: CaseData) -> Outcome:
    """The formula beside the slowest free wave; where 1/y^2 of the elements vanishes; what the solver accepts."""
    found, panels = Findings(data), []
    for shear in data.reference["shear_stiffness"]:
        track = paper_track(_ELEMENT_LENGTH, _LONG, shear_stiffness=shear)
        waves = beam(track).critical_speed
        formula = mem.critical_speed(mem.rail_model(track, WHEEL_PLACES))
        found.compare(f"critical speed, {shear:g} N shear layer / m/s", formula, waves, "formula")
        speeds = _SHARES * waves
        under = np.array([at(*steady_deflections(track, float(v)), 0.0) for v in speeds])
        # 1/y0^2 = 4 k (V_cr^2 - V^2) m falls to zero in a straight line over V^2
        slope, offset = np.polyfit(speeds**2, under**-2.0, 1)
        reached = float(np.sqrt(-offset / slope))
        found.compare(
            f"where the elements' deflection grows without bound, {shear:g} N / m/s", reached, waves, "elements"
        )
        line = curve(
            "free waves", [0, waves], [1e-12 * under[0] ** -2 * waves**2 / (waves**2 - speeds[0] ** 2), 0], exact=True
        )
        points = curve("moving elements", speeds**2 / waves, 1e-12 * under**-2.0, marks=True)
        panels.append(
            Panel(
                "V^2 / V_cr / m/s",
                "(load over deflection)^2 / (kN/mm)^2",
                (line, points),
                title=f"shear layer of {shear / 1e3:g} kN",
            )
        )
    _refusals(data, found)
    return found.outcome(Chart(panels))


def _refusals(data: CaseData, found: Findings) -> None:
    """A heavy soft track brings the critical speed down to where wagons run."""
    soft = data.reference["soft_track"]
    limit = beam(scenario("paper-80-solid", *soft).track).critical_speed
    for factor, stated in ((0.98, "accepted"), (1.02, "refused")):
        speed = f"braking.initial_speed={factor * limit} m/s"
        try:
            problem(scenario("paper-80-solid", *soft, speed))
            verdict = "accepted"
        except PhysicsError:
            verdict = "refused"
        found.verdict(f"a stop from {factor:g} of a critical speed of {limit:.2f} m/s", verdict, stated)
