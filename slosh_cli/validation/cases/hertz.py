"""Hertz contact: the published table of the ellipse, the elastic half space itself, and the sphere."""

from __future__ import annotations

from math import cos, radians

import numpy as np

from slosh_cli.scenario import Contact
from slosh_cli.track import contact, hertz
from slosh_cli.validation import kernels
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData, data_rows
from slosh_cli.validation.exact.creep import ellipse, half_space
from slosh_cli.validation.runs import scenario

_YOUNGS, _POISSON = 210e9, 0.3
_MODULUS = _YOUNGS / (2 * (1 - _POISSON**2))


def compute(data: CaseData) -> Outcome:
    """Semi-axes against the table, curvatures and approach against potentials, the kernel's force, the sphere."""
    found = Findings(data)
    angles, ours, table = [], [], []
    for row in data_rows("hertz_table.csv"):
        angle, m, n = float(row["theta_deg"]), float(row["m"]), float(row["n"])
        coefficients = _table_coefficients(angle)
        for name, value, printed in zip("mn", coefficients, (m, n), strict=True):
            found.compare(f"{name} at theta = {angle:g} degrees", value, printed, "table")
        angles.append(angle)
        ours.append(coefficients)
        table.append((m, n))
    _half_space(data, found)
    _sphere(found)
    _kernel(found)
    curves = []
    for k, name in enumerate("mn"):
        curves.append(curve(f"{name}, published", angles, [row[k] for row in table], exact=True, marks=True))
        curves.append(curve(f"{name}, program", angles, [row[k] for row in ours]))
    return found.outcome(Chart((Panel("theta / degrees", "coefficient of the semi-axis", curves),)))


def _table_coefficients(theta: float) -> tuple[float, float]:
    """m and n of `a = m (3 N/(4 E* (A + B)))^(1/3)`, likewise b, with `cos theta = (B - A)/(A + B)`."""
    share = cos(radians(theta))
    wheel, crown = 0.5 / (0.5 * (1 - share)), 0.5 / (0.5 * (1 + share))  # A + B = 1
    axes = hertz.hertz_contact(wheel, crown, _YOUNGS, _POISSON).semi_axes(1.0)
    unit = (3 / (4 * _MODULUS)) ** (1 / 3)
    return axes[0] / unit, axes[1] / unit


def _half_space(data: CaseData, found: Findings) -> None:
    for wheel, crown in data.reference["radii"]:
        program = hertz.hertz_contact(wheel, crown, _YOUNGS, _POISSON)
        force = data.reference["force"]
        approach, along, across = half_space(program.semi_axes(force), force, _MODULUS)
        flat, sharp = sorted((0.5 / wheel, 0.5 / crown))
        name = f"wheel {wheel:g} m on crown {crown:g} m, {force / 1e3:g} kN"
        found.compare(f"smaller curvature under the ellipse, {name} / 1/m", along, flat, "half_space")
        found.compare(f"larger curvature, {name} / 1/m", across, sharp, "half_space")
        found.compare(
            f"approach, {name} / um", 1e6 * (force / program.stiffness) ** (2 / 3), 1e6 * approach, "half_space"
        )


def _sphere(found: Findings) -> None:
    radius, force = 0.5, 1e5
    program = hertz.hertz_contact(radius, radius, _YOUNGS, _POISSON)
    found.compare("C_H of a sphere / N/m^1.5", program.stiffness, 4 / 3 * _MODULUS * radius**0.5, "half_space")
    semi_axis = (3 * force * radius / (4 * _MODULUS)) ** (1 / 3)
    found.compare("radius of its contact / mm", 1e3 * program.semi_axes(force)[0], 1e3 * semi_axis, "half_space")


def _kernel(found: Findings) -> None:
    """The wheel of the paper's scenario: what the time loop makes of an approach; never a tension."""
    case = scenario("paper-80-liquid")
    steel: Contact = case.contact
    model = contact.contact_model(steel, case.wagon.wheelset.wheel_radius)
    load = 93e3
    _, _, approach = ellipse(
        case.wagon.wheelset.wheel_radius, steel.rail_crown_radius, steel.youngs_modulus, steel.poisson_ratio, load
    )
    found.compare(
        "force of the kernel at the approach of 93 kN / kN",
        kernels.normal_force(model, approach) / 1e3,
        93.0,
        "kernel",
    )
    apart = max(abs(kernels.normal_force(model, -float(gap))) for gap in np.geomspace(1e-9, 1.0, 10))
    found.limit("largest force between wheel and rail apart / N", float(apart), "tension")
    approaches = np.linspace(0.0, 3e-4, 2001)
    forces = [kernels.normal_force(model, float(value)) for value in approaches]
    stored = float(np.trapezoid(forces, approaches))
    found.compare("energy stored at 0.3 mm over 2/5 N delta", stored / (0.4 * forces[-1] * 3e-4), 1.0, "energy")
