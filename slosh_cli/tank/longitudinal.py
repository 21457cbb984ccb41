"""Longitudinal slosh modes of a prismatic tank with flat ends, from its cross-section (theory section 4).

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

from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import Section
from slosh_cli.tank.eigenproblem import HalfSectionElements
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.shape import ModeShape, mode_shape
from slosh_cli.tank.triangulation import triangulate
from slosh_cli.tank.wetted import half_section

TOLERANCE = 1e-5
"""Relative change of frequencies and heights from one mesh to the next, twice as fine, that ends refining."""

_SMALLEST_HEIGHT = 1e-3  # of the depth: smaller heights count as this large when their change is judged
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

    @property
    def height(self) -> float:
        """Height above the tank's lowest point at which the mode's force acts, m."""
        return self.lambda_02 / self.lambda_1


@dataclass(frozen=True)
class LongitudinalModes:
    """Modes n = 1, 3, 5, ... and how they were reached.

    `relative_change` is the change of the first or the last frequency in the last refinement, whichever is
    larger (the error left is about a fifteenth of it), `height_change` the same of the heights at which the
    forces act, `refinements` how often the first mesh was refined, `unknowns` the size of the last problem and
    `solve_seconds` the time all of it took.
    """

    modes: tuple[LongitudinalMode, ...]
    relative_change: float
    height_change: float
    refinements: int
    unknowns: int
    solve_seconds: float


def longitudinal_modes(section: Section, depth: float, length: float, count: int = 1) -> LongitudinalModes:
    """The first `count` odd longitudinal modes of a tank filled to `depth` m, `length` m long.

    The mesh is refined until frequency and height of the first and the last mode change by less than TOLERANCE.
    Results are kept by geometry, so asking again costs nothing. Raises TankError where the section cannot be
    represented, ValueError for a count or length that is not positive.
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
    watched = sorted({numbers[0], numbers[-1]})
    mesh = triangulate(half_section(section, depth), numbers[-1] * math.pi / length)
    elements = HalfSectionElements(mesh)
    modes = {n: longitudinal_mode(elements, n, length) for n in watched}
    changes, refinements = (math.inf, math.inf), 0
    while not max(changes) < TOLERANCE:
        if elements.size > _MOST_UNKNOWNS:
            raise TankError(
                f"frequencies and heights must settle to {TOLERANCE:g}, but still change by {max(changes):.1e} with "
                f"{elements.size} unknowns; ask for fewer modes"
            )
        mesh, refinements = mesh.refined(), refinements + 1
        elements = HalfSectionElements(mesh)
        previous, modes = modes, {n: longitudinal_mode(elements, n, length) for n in watched}
        changes = _changes([(previous[n], modes[n]) for n in watched], depth)
    modes |= {n: longitudinal_mode(elements, n, length) for n in numbers if n not in modes}
    found = tuple(modes[n] for n in numbers)
    return LongitudinalModes(found, *changes, refinements, elements.size, time.perf_counter() - started)


def _changes(pairs: list[tuple[LongitudinalMode, LongitudinalMode]], depth: float) -> tuple[float, float]:
    """Largest relative change of the frequencies and of the heights from one mesh to the next.

    A height much smaller than the depth is the difference of two of its size and counts against the depth.
    """
    frequency = max(abs(after.frequency / before.frequency - 1.0) for before, after in pairs)
    height = max(
        abs(after.height - before.height) / max(abs(after.height), _SMALLEST_HEIGHT * depth) for before, after in pairs
    )
    return frequency, height


def longitudinal_mode(elements: HalfSectionElements, n: int, length: float) -> LongitudinalMode:
    """Mode `n` of a tank `length` m long on one given mesh; `lambda_02` is about the mesh's own z = 0.

    Integrals over the half section count twice.
    """
    wavenumber = n * math.pi / length
    solved = elements.modes(wavenumber)
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
