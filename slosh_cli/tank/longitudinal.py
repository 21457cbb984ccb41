"""Longitudinal slosh modes of a prismatic tank with flat ends, from its cross-section (model.md, section 4).

With `k = n pi / L`, n odd, every mode is a plane problem over the section. Its potential is scaled so that
the surface shape `f = d phi/dz` has the width-mean 1: an amplitude in metres is then the mean rise at the end
walls.
"""

from __future__ import annotations

import math
import time
from collections import OrderedDict
from dataclasses import dataclass
from threading import Lock

import numpy as np

from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.tank.eigenproblem import HalfSectionElements, SurfaceModes
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.section import Section
from slosh_cli.tank.shape import ModeShape, mode_shape
from slosh_cli.tank.triangulation import triangulate
from slosh_cli.tank.wetted import half_section

TOLERANCE = 1e-5
"""Relative change of the frequencies from one mesh to the next, twice as fine, below which refining ends."""

_MOST_UNKNOWNS = 150_000
_CACHE_SIZE = 256


@dataclass(frozen=True)
class LongitudinalMode:
    """One mode of a tank holding a liquid of unit density; multiply by the density for kg.

    `n` (odd) half waves along the tank; `frequency` rad/s; `lambda_1` m^3, from the free surface, and
    `lambda_1_from_ends`, the same from the pressure on the two end walls; `lambda_02` m^4 about the tank's
    lowest point; `mu` m^3; `shape` the potential and surface over the cross-section.
    """

    n: int
    frequency: float
    lambda_1: float
    lambda_1_from_ends: float
    lambda_02: float
    mu: float
    shape: ModeShape


@dataclass(frozen=True)
class LongitudinalModes:
    """Modes n = 1, 3, 5, ... and how they were reached.

    `relative_change` is the change of the first or the last frequency in the last refinement, whichever is
    larger (the error left is about a fifteenth of it), `refinements` how often the first mesh was refined,
    `unknowns` the size of the last problem and `solve_seconds` the time all of it took.
    """

    modes: tuple[LongitudinalMode, ...]
    relative_change: float
    refinements: int
    unknowns: int
    solve_seconds: float


def longitudinal_modes(section: Section, depth: float, length: float, count: int = 1) -> LongitudinalModes:
    """The first `count` odd longitudinal modes of a tank filled to `depth` m, `length` m long.

    The mesh is refined until the first and the last frequency change by less than TOLERANCE. Results are kept
    by geometry, so asking again costs nothing. Raises TankError where the section cannot be represented,
    ValueError for a count or length that is not positive.
    """
    if count < 1 or not length > 0.0:
        raise ValueError(f"count and length must be positive, but {count} and {length} were given")
    return _CACHE.modes(section, depth, length, count)


def mode_number(position: int) -> int:
    """Half waves along the tank of the mode at `position` 0, 1, 2, ...: 1, 3, 5, ..."""
    return 2 * position + 1


def _compute(section: Section, depth: float, length: float, count: int) -> LongitudinalModes:
    started = time.perf_counter()
    numbers = [mode_number(position) for position in range(count)]
    mesh = triangulate(half_section(section, depth), numbers[-1] * math.pi / length)
    watched = sorted({numbers[0], numbers[-1]})
    previous, change, refinements = None, math.inf, 0
    while True:
        elements = HalfSectionElements(mesh)
        solved = {n: elements.modes(n * math.pi / length) for n in watched}
        frequencies = np.sqrt([solved[n].kappa[0] for n in watched])
        if previous is not None:
            change = float(np.abs(frequencies / previous - 1.0).max())
        if change < TOLERANCE:
            break
        if elements.size > _MOST_UNKNOWNS:
            raise TankError(
                f"the slosh frequencies must settle to {TOLERANCE:g}, but still change by {change:.1e} with "
                f"{elements.size} unknowns; ask for fewer modes"
            )
        previous, refinements, mesh = frequencies, refinements + 1, mesh.refined()
    solved |= {n: elements.modes(n * math.pi / length) for n in numbers if n not in solved}
    modes = tuple(longitudinal_mode(elements, n, length, solved[n]) for n in numbers)
    return LongitudinalModes(modes, change, refinements, elements.size, time.perf_counter() - started)


def longitudinal_mode(
    elements: HalfSectionElements, n: int, length: float, solved: SurfaceModes | None = None
) -> LongitudinalMode:
    """Mode `n` of a tank `length` m long on one given mesh, the eigenproblem `solved` already or here.

    Integrals over the half section count twice. `lambda_02` is about the mesh's own z = 0.
    """
    wavenumber = n * math.pi / length
    solved = solved or elements.modes(wavenumber)
    kappa, potential = float(solved.kappa[0]), solved.potential[:, 0]
    half_width = elements.section_mesh.half.half_width
    potential = potential * half_width / (kappa * (elements.surface_of @ potential))
    mean_square = 2.0 * float(potential @ (elements.surface_mass @ potential))
    along = -2.0 / wavenumber**2  # X_n, the integral of x cos(k (x + L/2)) over the length
    height_moment = 2.0 * float(elements.area_of_height_times @ potential)
    slope = 2.0 * float(elements.area_of_slope @ potential)
    return LongitudinalMode(
        n=n,
        frequency=math.sqrt(STANDARD_GRAVITY * kappa),
        lambda_1=along * 2.0 * kappa * float(elements.surface_of @ potential),
        lambda_1_from_ends=-2.0 * 2.0 * float(elements.area_of @ potential),
        lambda_02=-2.0 * height_moment - along * slope,
        mu=length / 2.0 * kappa * mean_square,
        shape=mode_shape(elements, kappa, potential),
    )


class _Cache:
    """The latest results by geometry; threads that ask for the same one wait for the first to compute it."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._kept: OrderedDict[tuple[Section, float, float, int], LongitudinalModes] = OrderedDict()
        self.computed = 0

    def modes(self, section: Section, depth: float, length: float, count: int) -> LongitudinalModes:
        """The kept result or a new one."""
        key = (section, depth, length, count)
        with self._lock:
            if key not in self._kept:
                self._kept[key] = _compute(section, depth, length, count)
                self.computed += 1
            self._kept.move_to_end(key)
            while len(self._kept) > _CACHE_SIZE:
                self._kept.popitem(last=False)
            return self._kept[key]


_CACHE = _Cache()
