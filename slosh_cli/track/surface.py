"""What wheels roll over beside a straight rail: uneven rails and flats (theory section 15).

A rail's shape is a table of cubics. A spectrum of evenly spaced lines is one of a single period: with the first line's
number taken out as a carrier what is left of the sum repeats exactly, so that it has its place in a table however far
the wagon rolls.
"""

from __future__ import annotations

import math

import numpy as np

from slosh_cli.arrays import Array, Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel, kernel
from slosh_cli.scenario import Dip, Unevenness, WheelFlat
from slosh_cli.scenario.schema_line import SMOOTH_START, measured_points
from slosh_cli.track.spectrum import spectral_lines
from slosh_cli.vectors import cell_of

_CELLS_PER_WAVE = 64
"""Cubics over the shortest wavelength: their error is below 1e-9 m (a test says so)."""
_WAVE_SHARE = 0.1
"""No step takes a wheel further than this part of the shortest wavelength."""
_FLAT_STEP = 5e-5
"""Longest step over a flat, s; distances have long converged, extremes of wheel loads ask for it."""
_FLAT_STEPS = 240.0
"""A slow wheel takes longer over its flat; so many steps will do."""
_RINGING = 3.0
"""The wheel's answer is followed from a flat's start over so many of its lengths."""


class RollingSurface(Block):
    """Shape of rails and wheels; `uneven` is 0 where both are even. The rail sets in over `smooth_start` (m).

    The rail's height is `f (cos(carrier x) a - sin(carrier x) b)` at x, which is `ahead` (wheels,) m of the vehicle's
    place: `shape` (n, 4) holds a and b with their slopes at the `knots` (n,) m, with cubics between them. It repeats
    after `period` (m), or is zero beyond the knots where that is zero. No step takes a wheel further than `longest_way`
    (m) where the rail is uneven. Flats: `flat_depth` m and `flat_angle` rad, (wheels,).
    """

    uneven: int
    smooth_start: float
    ahead: Vector
    knots: Vector
    shape: Matrix
    carrier: float
    period: float
    longest_way: float
    flat_depth: Vector
    flat_angle: Vector

    @inner_kernel
    def rail(self, wheel, place):
        """Height (m) of the unloaded rail under a wheel of a vehicle at the `place` (m), and its derivative by it."""
        begun = min(max(place / self.smooth_start, 0.0), 1.0)
        part, part_slope = begun * begun * (3.0 - 2.0 * begun), 6.0 * begun * (1.0 - begun) / self.smooth_start
        height, slope = self.height(place + self.ahead[wheel])
        return part * height, part * slope + part_slope * height

    @inner_kernel
    def height(self, x):
        """Height (m) of the unloaded rail at `x` (m), and its slope."""
        knots, shape, carrier, along = self.knots, self.shape, self.carrier, x
        last = knots.size - 1
        if last < 1:
            return 0.0, 0.0
        if self.period > 0.0:
            along -= math.floor(x / self.period) * self.period
            cell = min(max(int(along / knots[1]), 0), last - 1)
        else:
            if not knots[0] < x < knots[last]:
                return 0.0, 0.0
            cell = cell_of(knots, x)
        width = knots[cell + 1] - knots[cell]
        part = (along - knots[cell]) / width
        a, a_slope = _cubic(shape, cell, 0, width, part)
        if carrier == 0.0:
            return a, a_slope
        b, b_slope = _cubic(shape, cell, 2, width, part)
        cosine, sine = math.cos(carrier * x), math.sin(carrier * x)
        return cosine * a - sine * b, cosine * (a_slope - carrier * b) - sine * (b_slope + carrier * a)

    @inner_kernel
    def flat(self, wheel, angle):
        """What the flat takes off the radius (m) of a wheel that has turned by `angle` (rad), and its derivative."""
        extent = self.flat_angle[wheel]
        turned = angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi))
        if turned >= extent:
            return 0.0, 0.0
        wave = 2.0 * math.pi / extent
        half = 0.5 * self.flat_depth[wheel]
        return half * (1.0 - math.cos(wave * turned)), half * wave * math.sin(wave * turned)

    @inner_kernel
    def way_ahead(self, wheel, place):
        """Way (m) that a step may take a wheel: a part of the shortest wavelength; where it is even, to its end.

        A long step that ended beyond would weigh what is there with its own length.
        """
        knots, shape, x = self.knots, self.shape, place + self.ahead[wheel]
        last = knots.size - 1
        if last < 1 or self.period > 0.0:
            return self.longest_way
        if x < knots[0]:
            return max(knots[0] - x, self.longest_way)
        if x >= knots[last]:
            return math.inf
        cell = cell_of(knots, x)
        flat = shape[cell, 0] == shape[cell, 1] == shape[cell + 1, 0] == shape[cell + 1, 1] == 0.0
        return max(knots[cell + 1] - x, self.longest_way) if flat else self.longest_way

    @inner_kernel
    def turning_step(self, wheel, angle, spin):
        """Longest step (s) of a wheel at `angle` (rad) that turns at `spin` (rad/s): short on a flat and behind it."""
        extent = self.flat_angle[wheel]
        if extent == 0.0 or spin <= 0.0:
            return math.inf
        turned = angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi))
        fine = max(_FLAT_STEP, extent / (_FLAT_STEPS * spin))
        return fine if turned < _RINGING * extent else max(fine, (2.0 * math.pi - turned) / spin)

    def levels(self, places: Vector) -> Vector:
        """Heights (n,) m of the unloaded rail under the leading wheel of a vehicle at the `places` (n,) m."""
        heights = np.zeros(places.size)
        self.trace(0, np.ascontiguousarray(places, dtype=np.float64), heights)
        return heights

    @kernel
    def trace(self, wheel, places, heights):
        """Heights (n,) m of the unloaded rail under a wheel of a vehicle at the `places` (n,) m, into `heights`."""
        for i in range(places.size):
            height, _ = self.rail(wheel, places[i])
            heights[i] = height


@inner_kernel
def _cubic(shape, cell, column, width, part):
    """Value and slope of a cubic at the `part` of its cell, from those at both ends in two columns of `shape`."""
    left, right = shape[cell, column], shape[cell + 1, column]
    left_slope, right_slope = shape[cell, column + 1], shape[cell + 1, column + 1]
    rest, step = 1.0 - part, (right - left) / width
    value = left + part * part * (3.0 - 2.0 * part) * (right - left)
    value += width * part * rest * (rest * left_slope - part * right_slope)
    slope = 6.0 * part * rest * step + rest * (1.0 - 3.0 * part) * left_slope - part * (2.0 - 3.0 * part) * right_slope
    return value, slope


def even_surface(wheels: int = 4) -> RollingSurface:
    """Straight rails and round wheels."""
    return RollingSurface.blank(
        wheels, smooth_start=SMOOTH_START, knots=np.zeros(0), shape=np.zeros((0, 4)), longest_way=math.inf
    )


def rolling_surface(
    unevenness: Unevenness | None, flats: tuple[WheelFlat, ...], ahead: Vector, wheel_radius: float
) -> RollingSurface:
    """The surfaces of a vehicle whose wheels are `ahead` (wheels,) m of its place, of `wheel_radius` (m)."""
    even = even_surface(ahead.size)
    if unevenness is None and not flats:
        return even
    depth, angle = np.zeros(ahead.size), np.zeros(ahead.size)
    for flat in flats:
        depth[flat.wheel - 1], angle[flat.wheel - 1] = flat.depth, flat.length / wheel_radius
    found = even.replaced(uneven=1, ahead=ahead, flat_depth=depth, flat_angle=angle)
    if unevenness is None:
        return found
    if unevenness.dips is not None:
        knots, shape, shortest = _dips(unevenness.dips)
    elif unevenness.file is not None:
        knots, shape, shortest = _measured(measured_points(unevenness.file))
    else:
        return _spectral(found, unevenness)
    return found.replaced(knots=knots, shape=shape, longest_way=_WAVE_SHARE * shortest)


def _dips(dips: tuple[Dip, ...]) -> tuple[Vector, Matrix, float]:
    """Knots, shape and shortest length of dips, which may overlap."""
    grids = [dip.position + dip.length * np.linspace(0.0, 1.0, _CELLS_PER_WAVE + 1) for dip in dips]
    knots = np.unique(np.concatenate(grids))
    shape = np.zeros((knots.size, 4))
    for dip in dips:
        inside = (dip.position < knots) & (knots < dip.position + dip.length)
        wave = 2.0 * np.pi / dip.length
        phase = wave * (knots[inside] - dip.position)
        shape[inside, 0] -= 0.5 * dip.depth * (1.0 - np.cos(phase))
        shape[inside, 1] -= 0.5 * dip.depth * wave * np.sin(phase)
    return knots, shape, min(dip.length for dip in dips)


def _measured(points: Matrix) -> tuple[Vector, Matrix, float]:
    """Knots, shape and shortest wavelength of measured points, cubic between them (not-a-knot).

    Beyond either end a cubic leads to an even rail.
    """
    from scipy.interpolate import CubicSpline

    x, spline = points[:, 0], CubicSpline(points[:, 0], points[:, 1])
    inner = np.column_stack([points[:, 1], spline(x, 1)])
    level = np.zeros((1, 2))
    knots = np.concatenate([[x[0] - _RUN_OUT], x, [x[-1] + _RUN_OUT]])
    shape = np.pad(np.concatenate([level, inner, level]), ((0, 0), (0, 2)))
    return knots, shape, 2.0 * float(np.diff(x).min())


_RUN_OUT = 2.0
"""A measured rail comes to zero over this length beyond its ends, m."""


def _spectral(found: RollingSurface, unevenness: Unevenness) -> RollingSurface:
    """The surfaces with the rail of a spectrum: one period of the sum without its carrier."""
    number, amplitude, phase = spectral_lines(unevenness)
    spacing = 2.0 * np.pi * (1.0 / unevenness.wavelengths[0] - 1.0 / unevenness.wavelengths[1]) / number.size
    period = 2.0 * np.pi / spacing
    cells = 1 << math.ceil(math.log2(_CELLS_PER_WAVE * period / unevenness.wavelengths[0]))
    coefficients: Array = np.zeros((2, cells), dtype=np.complex128)
    coefficients[0, : number.size] = amplitude * np.exp(1j * phase)
    coefficients[1] = 1j * spacing * np.arange(cells) * coefficients[0]
    value, slope = cells * np.fft.ifft(coefficients, axis=1)
    shape = np.column_stack([value.real, slope.real, value.imag, slope.imag])
    return found.replaced(
        knots=np.linspace(0.0, period, cells + 1),
        shape=np.concatenate([shape, shape[:1]]),
        carrier=float(number[0]),
        period=period,
        longest_way=_WAVE_SHARE * unevenness.wavelengths[0],
    )
