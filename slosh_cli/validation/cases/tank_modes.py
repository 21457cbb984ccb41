"""What the cases about slosh modes share."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.validation.case import Findings
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.exact.tank import ExactMode

_Exact = Callable[[int, float], ExactMode]
"""The closed form of mode n at a filling."""
NUMBERS = (1, 3, 5)


def compare(found: Findings, where: str, modes: Sequence[SloshMode], exact: Sequence[ExactMode]) -> None:
    """Five rows per mode: frequency, the two couplings, inertia, height of the force."""
    for mode, true in zip(modes, exact, strict=True):
        name = f"{where}, mode {true.n}"
        found.compare(f"omega, {name} / rad/s", mode.frequency, true.frequency, "frequency")
        found.compare(f"lambda_1, {name} / kg", mode.lambda_1, true.lambda_1, "coupling")
        found.compare(f"lambda_02, {name} / kg m", mode.lambda_02, true.lambda_02, "coupling")
        found.compare(f"mu, {name} / kg", mode.mu, true.mu, "coupling")
        found.compare(f"slosh mass, {name} / kg", mode.slosh_mass, true.slosh_mass, "coupling")


def frequency_chart(computed: Mapping[float, Sequence[SloshMode]], exact: _Exact) -> Chart:
    """Frequency and height of the force of each mode over the filling."""
    fills, panels = list(computed), []
    smooth = np.linspace(min(fills), max(fills), 60)
    for label, name in (("omega / rad/s", "frequency"), ("height of the force / m", "height")):
        curves = []
        for place, n in enumerate(NUMBERS):
            true = [getattr(exact(n, float(fill)), name) for fill in smooth]
            ours = [getattr(computed[fill][place], name) for fill in fills]
            curves.append(curve(f"mode {n}, closed form", smooth, true, exact=True))
            curves.append(curve(f"mode {n}, finite elements", fills, ours, marks=True))
        panels.append(Panel("fill", label, curves))
    return Chart(panels)
