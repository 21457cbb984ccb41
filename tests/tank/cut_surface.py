"""What a still liquid does to its tank under constant deceleration, from the cut surface alone.

Its surface is the plane `z = level + slope x`, cut off by roof and bottom; under the roof the plane is the head of
pressure. Widths, volumes and moments by quadrature, written without the program.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import brentq

G = 9.81
SLICES = 40_001


@dataclass(frozen=True)
class Widths:
    """A section `height` m high by its width (m) at any height."""

    height: float
    width: np.ndarray

    @property
    def z(self):
        return np.linspace(0.0, self.height, self.width.size)

    def below(self, depth, power=0):
        """INT z^power b dz up to `depth` (m), which the roof and the bottom bound."""
        whole = cumulative_trapezoid(self.width * self.z**power, self.z, initial=0.0)
        return np.interp(np.clip(depth, 0.0, self.height), self.z, whole)


def ellipse_widths(half_width, half_height):
    z = np.linspace(0.0, 2 * half_height, SLICES)
    return Widths(2 * half_height, 2 * half_width * np.sqrt(np.clip(1 - (z / half_height - 1) ** 2, 0, None)))


def cornered_widths(levels, widths):
    """Straight walls between the given widths (m) at the given levels (m), the first of which is 0."""
    return Widths(levels[-1], np.interp(np.linspace(0.0, levels[-1], SLICES), levels, widths))


@dataclass(frozen=True)
class StillPlane:
    """A still liquid in a tank: `level` m of its surface in the middle, force N, moment N m, and what they rest on."""

    level: float
    mass: float
    moment: float
    front_push: float
    rear_push: float
    energy: float


def still_plane(section: Widths, length, fill, density, deceleration) -> StillPlane:
    """The plane that holds the volume, and its effects; `energy` J is the potential energy above the bottom."""
    slope, x = deceleration / G, np.linspace(-0.5, 0.5, 20_001) * length
    volume = section.below(fill * section.height) * length
    steep = abs(slope) * length
    level = brentq(
        lambda h: np.trapezoid(section.below(h + slope * x), x) - volume, -steep, section.height + steep, xtol=1e-13
    )
    weight = density * G
    push, arm = {}, {}
    for side in (-1, 1):
        depth = level + slope * side * length / 2
        area, first, second = (section.below(depth, power) for power in (0, 1, 2))
        push[side] = weight * (max(depth, 0.0) * area - first)
        arm[side] = weight * (max(depth, 0.0) * first - second)
    carried = weight * np.trapezoid(section.below(level + slope * x) * x, x)
    energy = weight * np.trapezoid(section.below(level + slope * x, 1), x)
    return StillPlane(level, density * volume, carried + arm[1] - arm[-1], push[1], push[-1], energy)
