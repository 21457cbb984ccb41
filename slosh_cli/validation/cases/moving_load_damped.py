"""A constant load on a damped rail against a Fourier integral."""

from __future__ import annotations

import numpy as np

from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Curve, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.paper_track import at, beam, paper_track, steady_deflections
from slosh_cli.validation.exact.steady_rail import fourier_integral

_ELEMENT_LENGTH = 0.125


def compute(data: CaseData) -> Outcome:
    """Deflection ahead of, under and behind the load for several dampings and speeds."""
    found = Findings(data)
    curves: list[Curve] = []
    for alpha, lam in data.reference["dampings"]:
        track = paper_track(_ELEMENT_LENGTH, damping=alpha, shear_damping=lam)
        for speed in data.reference["speeds"]:
            nodes, shape = steady_deflections(track, speed)
            exact = {r: fourier_integral(beam(track), r, speed) for r in data.reference["places"]}
            name = f"{speed:g} m/s, alpha {alpha:g} N s/m^2, lam {lam:g} N s"
            found.compare(f"under 1 N, {name} / nm", 1e9 * at(nodes, shape, 0.0), 1e9 * exact[0.0], "deflection")
            gaps = [abs(at(nodes, shape, r) - value) for r, value in exact.items()]
            found.limit(f"largest error over the peak, {name}", float(max(gaps) / shape.max()), "shape")
        near = np.abs(nodes) <= 6
        curves.append(curve(f"alpha {alpha:g}, lam {lam:g}: elements", nodes[near], -1e9 * shape[near]))
        points = -1e9 * np.array(list(exact.values()))
        curves.append(curve(f"alpha {alpha:g}, lam {lam:g}: integral", list(exact), points, marks=True))
    label = f"deflection under 1 N at {speed:g} m/s / nm"
    return found.outcome(Chart((Panel("distance ahead of the load / m", label, curves),)))
