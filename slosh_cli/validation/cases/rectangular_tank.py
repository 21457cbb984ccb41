"""Longitudinal modes of a box against their closed forms."""

from __future__ import annotations

from slosh_cli.scenario import Liquid, Rectangular
from slosh_cli.tank import coefficients
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.cases.tank_modes import compare, frequency_chart
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.tank import rectangle


def compute(data: CaseData) -> Outcome:
    """Frequencies, couplings and inertias of the first three odd modes at several fillings."""
    given = data.reference
    found, table = Findings(data), {}
    for fill in given["fills"]:
        liquid = Liquid(model="modal", density=given["density"])
        tank = Rectangular(
            width=given["width"], height=given["height"], length=given["length"], fill=fill, liquid=liquid
        )
        modes = coefficients.computed_modes(tank, 3)
        exact = [rectangle(n, tank.width, fill * tank.height, tank.length, liquid.density) for n in (1, 3, 5)]
        compare(found, f"fill {fill:g}", modes, exact)
        table[fill] = (modes, exact)
    return found.outcome(frequency_chart(table))
