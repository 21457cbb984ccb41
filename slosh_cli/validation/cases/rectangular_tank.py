"""Longitudinal modes of a box against their closed forms."""

from __future__ import annotations

from slosh_cli.scenario import Liquid, Rectangular
from slosh_cli.tank import coefficients
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.cases.tank_modes import NUMBERS, compare, frequency_chart
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.tank import ExactMode, rectangle


def compute(data: CaseData) -> Outcome:
    """Frequencies, couplings and inertias of the first three odd modes at several fillings."""
    given = data.reference
    found, computed = Findings(data), {}

    def exact(n: int, fill: float) -> ExactMode:
        return rectangle(n, given["width"], fill * given["height"], given["length"], given["density"])

    for fill in given["fills"]:
        liquid = Liquid(model="modal", density=given["density"])
        tank = Rectangular(
            width=given["width"], height=given["height"], length=given["length"], fill=fill, liquid=liquid
        )
        computed[fill] = coefficients.computed_modes(tank, 3)
        compare(found, f"fill {fill:g}", computed[fill], [exact(n, fill) for n in NUMBERS])
    return found.outcome(frequency_chart(computed, exact))
