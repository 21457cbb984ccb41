"""What of an ideal liquid turns rigidly with its tank: its pitch inertia under a lid.

It is a sum over the odd harmonics of `x = -sum 4/(L k^2) cos(k (x + L/2))`, k = n pi / L: one plane problem
`(d_yy + d_zz - k^2) phi = 0` over the wetted section each. The terms of highest k are summed from their limit
for short waves, where only the neighbourhood of the boundary counts.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from slosh_cli.section import liquid_depth, section_of
from slosh_cli.tank.eigenproblem import HalfSectionElements, factorised
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.load import LoadedTank, frozen_load
from slosh_cli.tank.mesh import Floats
from slosh_cli.tank.triangulation import triangulate
from slosh_cli.tank.wetted import HalfSection, half_section

_TOLERANCE = 1e-5
"""Change from one mesh to the next, as a share of the frozen load's value, below which refining ends."""

_SHORT = 6.0  # wavenumber times the section's narrowest measure beyond which waves are short
_MOST_SAMPLES = 24
_MOST_UNKNOWNS = 150_000


def stokes_joukowski_inertia(tank: LoadedTank) -> float:
    """Pitch inertia in kg m^2 of the liquid about its own centre if a lid held its surface flat.

    An ideal liquid does not turn with its tank as a frozen one does:
    J = J_l - rho sum 32/(L k^4) (A - boundary integral of psi n_z),  d psi/dn = n_z on the whole boundary.
    About another axis add the liquid's mass times the distance squared, as for a rigid body. Raises TankError
    where the section cannot be represented or the value does not settle.
    """
    half, length, frozen = _half_of(tank), tank.length, frozen_load(tank).pitch_inertia
    scale, area = 32.0 * tank.liquid.density / length, 2.0 * half.area

    def slip(elements: HalfSectionElements, wavenumbers: Floats) -> float:
        integrals = np.array([_slip_below_lid(elements, float(k)) for k in wavenumbers])
        return scale * _sum_over_harmonics(integrals, wavenumbers, length, area, 4)

    return frozen - _settled(half, length, slip, frozen)


def _half_of(tank: LoadedTank) -> HalfSection:
    return half_section(section_of(tank), liquid_depth(tank))


def _sum_over_harmonics(values: Floats, wavenumbers: Floats, length: float, limit: float, power: int) -> float:
    """Sum of value(k) / k^power over the odd harmonics of the length, all of them.

    `values` at increasing `wavenumbers` (1/m, from the first harmonic on) tend to `limit` + const / k.
    """
    from scipy.interpolate import CubicSpline
    from scipy.special import zeta

    unit, last = math.pi / length, float(wavenumbers[-1])
    second = (float(values[-1]) - limit) * last
    numbers = np.arange(1.0, round(last / unit) + 1, 2.0)
    harmonics = numbers * unit
    if len(values) < len(numbers):
        values = CubicSpline(np.log(wavenumbers), values)(np.log(harmonics))
    beyond = [(2.0 * unit) ** -p * float(zeta(p, numbers[-1] / 2.0 + 1.0)) for p in (power, power + 1)]
    return float((values / harmonics**power).sum()) + limit * beyond[0] + second * beyond[1]


def _sampled_wavenumbers(half: HalfSection, length: float) -> Floats:
    """Harmonics up to where waves are short against the section; a selection of them where they are many."""
    narrowest = min(half.depth, half.half_width, half.area / half.depth)
    count = max(1, math.ceil((_SHORT / narrowest * length / math.pi + 1.0) / 2.0))
    samples = np.geomspace(1.0, 2.0 * count - 1.0, min(count, _MOST_SAMPLES))
    numbers = 2.0 * np.unique(np.round((samples - 1.0) / 2.0)) + 1.0
    return np.asarray(numbers * math.pi / length, dtype=np.float64)


def _settled(
    half: HalfSection,
    length: float,
    value_on: Callable[[HalfSectionElements, Floats], float],
    whole: float,
    held_surface: bool = False,
) -> float:
    """The value on a mesh so fine that its last refinement changed it by less than _TOLERANCE of `whole`."""
    wavenumbers = _sampled_wavenumbers(half, length)
    mesh = triangulate(half, float(wavenumbers[-1]), held_surface)
    elements = HalfSectionElements(mesh)
    value, change = value_on(elements, wavenumbers), math.inf
    while change > _TOLERANCE * whole:
        if elements.size > _MOST_UNKNOWNS:
            raise TankError(
                f"the value must settle to {_TOLERANCE:g} of the frozen load's, but still changes by "
                f"{change / whole:.1e} with {elements.size} unknowns"
            )
        mesh = mesh.refined()
        elements = HalfSectionElements(mesh)
        previous, value = value, value_on(elements, wavenumbers)
        change = abs(value - previous)
    return value


def _slip_below_lid(elements: HalfSectionElements, wavenumber: float) -> float:
    """Area of the section less the boundary integral of psi n_z; d psi/dn = n_z on the whole boundary."""
    operator = (elements.stiffness + wavenumber**2 * elements.mass).tocsc()
    field = factorised(operator)(elements.area_of_slope)
    area = float(elements.area_of.sum())
    return 2.0 * (area - float(elements.area_of_slope @ field))
