"""Modes across the tank from the same code: published ones of the circular cylinder, overtones of a rectangle."""

import math

import numpy as np
import pytest

from slosh_cli.section import EllipticalSection, RectangularSection
from slosh_cli.tank.eigenproblem import HalfSectionElements, Parity
from slosh_cli.tank.triangulation import triangulate
from slosh_cli.tank.wetted import half_section
from slosh_cli.validation.data_file import data_rows


def transverse_table():
    rows = data_rows("transverse_modes.csv")
    return [(float(row["depth_over_diameter"]), float(row["omega2_R_over_g"])) for row in rows]


def test_the_transverse_table_is_complete():
    table = transverse_table()
    assert [depth for depth, _ in table] == pytest.approx(np.arange(0.1, 0.95, 0.1))
    assert np.all(np.diff([value for _, value in table]) > 0.0)


@pytest.mark.parametrize(("depth", "published"), transverse_table())
def test_transverse_modes_of_the_circular_cylinder(depth, published):
    mesh = triangulate(half_section(EllipticalSection(1.0, 1.0), 2.0 * depth), 0.0).refined()
    solved = HalfSectionElements(mesh).modes(0.0, parity=Parity.ANTISYMMETRIC)
    assert solved.kappa[0] == pytest.approx(published, rel=2e-4)


@pytest.mark.parametrize(
    ("parity", "across"),
    [(Parity.SYMMETRIC, (0.0, 1.0, 2.0)), (Parity.ANTISYMMETRIC, (0.5, 1.5, 2.5))],
)
def test_overtones_of_a_rectangle(parity, across):
    mesh = triangulate(half_section(RectangularSection(2.0, 2.0), 1.0), 0.0).refined()
    k = np.hypot(np.array(across) * math.pi, 0.5)
    coarse, fine = (
        np.abs(HalfSectionElements(one).modes(0.5, 3, parity).kappa / (k * np.tanh(k)) - 1.0)
        for one in (mesh.refined(), mesh.refined().refined())
    )
    assert coarse.max() < 5e-4
    assert np.log2(coarse / fine) == pytest.approx(4.0, abs=0.3)


def test_symmetric_modes_need_a_wavenumber():
    elements = HalfSectionElements(triangulate(half_section(RectangularSection(2.0, 2.0), 1.0), 0.0))
    with pytest.raises(ValueError, match="above 0"):
        elements.modes(0.0)
