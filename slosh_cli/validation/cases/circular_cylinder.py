"""Transverse modes of a half-round to nearly full cylinder against published values, and its long waves."""

from __future__ import annotations

from math import pi, sqrt

from slosh_cli.scenario import HorizontalCylinder, Liquid
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import EllipticalSection
from slosh_cli.tank import coefficients
from slosh_cli.tank.eigenproblem import HalfSectionElements, Parity
from slosh_cli.tank.triangulation import triangulate
from slosh_cli.tank.wetted import half_section
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData, data_rows
from slosh_cli.validation.exact.wagon import segment_area


def compute(data: CaseData) -> Outcome:
    """The same elements, across the tank instead of along it; then the longitudinal mode of a very long tank."""
    found = Findings(data)
    table = [
        (float(row["depth_over_diameter"]), float(row["omega2_R_over_g"])) for row in data_rows("transverse_modes.csv")
    ]
    computed = []
    for depth, published in table:
        mesh = triangulate(half_section(EllipticalSection(1.0, 1.0), 2.0 * depth), 0.0).refined()
        kappa = float(HalfSectionElements(mesh).modes(0.0, parity=Parity.ANTISYMMETRIC).kappa[0])
        computed.append(kappa)
        found.compare(f"omega^2 R/g, transverse, depth {depth:g} D", kappa, published, "transverse")
    radius, length = data.reference["radius"], data.reference["length"]
    for fill in data.reference["fills"]:
        tank = HorizontalCylinder(
            radius=radius, length=length, fill=fill, liquid=Liquid(model="modal", density=data.reference["density"])
        )
        mode = coefficients.computed_modes(tank, 1)[0]
        width = 2 * radius * sqrt(1 - (1 - 2 * fill) ** 2)
        area = segment_area(radius, fill)
        name = f"{length:g} m long tank, fill {fill:g}"
        wave = sqrt(STANDARD_GRAVITY * area / width)
        found.compare(f"omega, {name} / rad/s", mode.frequency, pi / length * wave, "long_wave")
        # of a shallow layer the surface moves 8/pi^2, and lambda_1 needs no more than the surface's width
        found.compare(
            f"lambda_1, {name} / kg", mode.lambda_1, -2 * tank.liquid.density * width * (length / pi) ** 2, "lambda_1"
        )
        fraction = mode.slosh_mass / (tank.liquid.density * area * length)
        found.compare(f"slosh mass over mass, {name}", fraction, 8 / pi**2, "long_wave")
    depths, values = zip(*table, strict=True)
    curves = (curve("published", depths, values, exact=True), curve("finite elements", depths, computed, marks=True))
    return found.outcome(Chart((Panel("depth / diameter", "omega^2 R / g", curves),)))
