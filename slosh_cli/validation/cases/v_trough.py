"""Longitudinal modes of a right-angled trough, vertex down, against their closed forms."""

from __future__ import annotations

from slosh_cli.scenario import Liquid, Polygon
from slosh_cli.tank import coefficients
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.cases.tank_modes import NUMBERS, compare, frequency_chart
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.tank import ExactMode, trough


def compute(data: CaseData) -> Outcome:
    """Frequencies, couplings and inertias of the first three odd modes at several fillings."""
    given = data.reference
    side, found, computed = given["height"], Findings(data), {}

    def exact(n: int, fill: float) -> ExactMode:
        return trough(n, fill * side, given["length"], given["density"])

    for fill in given["fills"]:
        liquid = Liquid(model="modal", density=given["density"])
        corners = ((0.0, 0.0), (side, side), (-side, side))
        tank = Polygon(points=corners, length=given["length"], fill=fill, liquid=liquid)
        computed[fill] = coefficients.computed_modes(tank, 3)
        compare(found, f"fill {fill:g}", computed[fill], [exact(n, fill) for n in NUMBERS])
    return found.outcome(frequency_chart(computed, exact))
