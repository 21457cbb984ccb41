"""What of an ideal liquid moves rigidly with its tank, and all slosh masses: they make up the liquid (a sum rule)."""

from __future__ import annotations

import math

import numpy as np

from slosh_cli.tank.eigenproblem import HalfSectionElements, factorised
from slosh_cli.tank.inertia import _half_of, _settled, _sum_over_harmonics
from slosh_cli.tank.load import LoadedTank, frozen_load
from slosh_cli.tank.mesh import Floats
from slosh_cli.tank.triangulation import triangulate


def added_mass(tank: LoadedTank) -> float:
    """Mass in kg of the liquid that follows a sudden longitudinal push of the tank (phi = 0 on the surface).

    With the slosh masses `lambda_1^2/mu` of all modes, transverse overtones included, it makes up the whole:
    m_0 = m_l - (8 rho / L) sum (1/k^2) integral(chi) dA,  chi = 1 on the surface, d chi/dn = 0 on the wall.
    Raises TankError where the section cannot be represented or the value does not settle.
    """
    half, length, mass = _half_of(tank), tank.length, frozen_load(tank).mass
    scale, width = 8.0 * tank.liquid.density / length, 2.0 * half.half_width

    def free_share(elements: HalfSectionElements, wavenumbers: Floats) -> float:
        integrals = np.array([_below_open_surface(elements, float(k)) for k in wavenumbers])
        return scale * _sum_over_harmonics(integrals * wavenumbers, wavenumbers, length, width, 3)

    return mass - _settled(half, length, free_share, mass, held_surface=True)


def free_masses(tank: LoadedTank, longitudinal: int, transverse: int) -> Floats:
    """Slosh masses `lambda_1^2/mu` in kg of the modes n = 1, 3, ... and their overtones, (longitudinal, transverse).

    The first column are the modes of the coefficients; the others, with nodes across the surface, take
    part because their mean over the width is not zero unless the tank is rectangular.
    """
    half, length = _half_of(tank), tank.length
    wavenumbers = (2.0 * np.arange(longitudinal) + 1.0) * math.pi / length
    elements = HalfSectionElements(triangulate(half, float(wavenumbers[-1])).refined())
    masses = np.empty((longitudinal, transverse))
    for row, wavenumber in zip(masses, wavenumbers, strict=True):
        solved = elements.modes(float(wavenumber), transverse)
        over_surface = 2.0 * (elements.surface_of @ solved.potential)
        row[:] = tank.liquid.density * (2.0 / wavenumber**2) ** 2 * solved.kappa * over_surface**2 / length
    return masses


def _below_open_surface(elements: HalfSectionElements, wavenumber: float) -> float:
    """Integral over the section of the field that is 1 on the surface and has no flux through the wall."""
    operator = (elements.stiffness + wavenumber**2 * elements.mass).tocsc()
    field = np.zeros(elements.size)
    field[elements.surface_unknowns] = 1.0
    inner = np.setdiff1d(np.arange(elements.size), elements.surface_unknowns)
    load = -(operator @ field)[inner]
    field[inner] = factorised(operator[inner][:, inner])(load)
    return 2.0 * float(elements.area_of @ field)
