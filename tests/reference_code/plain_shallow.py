"""Shallow water in a closed tank once more, plainly: numpy, first order, Rusanov's flux, no well-balancing.

Written from the equations alone, for the tests to compare the program with:

    A_t + Q_x = 0,    Q_t + (Q^2/A + g I1(A))_x = -A a,    I1(h) = INT_0^h A(z) dz

with a slot above the roof. Slow and diffusive, and right in the limit of a fine mesh.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

GRAVITY = 9.81
LEVELS = 20001


@dataclass(frozen=True)
class PlainSection:
    """A section by its width at any height: m, `height` m; a full one carries pressure waves at `slot_speed` m/s."""

    depth: np.ndarray
    area: np.ndarray
    pressure: np.ndarray
    arm: np.ndarray
    width: np.ndarray

    def depth_of(self, area):
        return np.interp(area, self.area, self.depth)


def plain_section(width: Callable[[np.ndarray], np.ndarray], height: float, slot_speed: float) -> PlainSection:
    """Integrate the width upwards in fine slices, the slot included up to three times the height."""
    depth = np.linspace(0.0, 3.0 * height, 3 * LEVELS - 2)
    middle = 0.5 * (depth[1:] + depth[:-1])
    open_part = np.where(middle < height, width(np.clip(middle, 0.0, height)), 0.0)
    slot = GRAVITY * float(np.sum(open_part * np.diff(depth))) / slot_speed**2
    widths = np.maximum(open_part, slot * (middle > 0.5 * height))
    area = _sum(widths, depth)
    first = _sum(widths * middle, depth)
    second = _sum(widths * middle**2, depth)
    return PlainSection(depth, area, depth * area - first, depth * first - second, np.append(widths, widths[-1]))


def _sum(values, places):
    return np.concatenate([[0.0], np.cumsum(values * np.diff(places))])


def rectangle(width: float, height: float, slot_speed: float = 30.0) -> PlainSection:
    return plain_section(lambda z: np.full_like(z, width), height, slot_speed)


def circle(radius: float, slot_speed: float = 30.0) -> PlainSection:
    return plain_section(lambda z: 2.0 * np.sqrt(z * (2.0 * radius - z)), 2.0 * radius, slot_speed)


@dataclass
class PlainTank:
    """A tank's liquid: `area` m^2 and `flow` m^3/s of each cell; `spacing` m; `time` s; forces over density."""

    section: PlainSection
    spacing: float
    area: np.ndarray
    flow: np.ndarray
    time: float = 0.0

    @property
    def depth(self) -> np.ndarray:
        return self.section.depth_of(self.area)

    def advance(self, until: float, acceleration: float = 0.0) -> tuple[float, float]:
        """Go on to the time `until`; impulse and moment's impulse on the tank over density, since the last call."""
        impulse = turning = 0.0
        while self.time < until - 1e-12:
            force, moment, step = self._step(until, acceleration)
            impulse += step * force
            turning += step * moment
            self.time += step
        return impulse, turning

    def _step(self, until, acceleration):
        section, flow = self.section, self.flow
        depth = np.interp(self.area, section.area, section.depth)
        pressure = np.interp(depth, section.depth, section.pressure)
        width = section.width[np.minimum((depth / section.depth[1]).astype(int), section.width.size - 1)]
        speed = np.where(self.area > 1e-6, flow / np.maximum(self.area, 1e-6), 0.0)
        fastest = np.abs(speed) + np.sqrt(GRAVITY * self.area / width)
        step = min(0.9 * self.spacing / fastest.max(), until - self.time)
        momentum = flow * speed + GRAVITY * pressure
        area = np.concatenate([self.area[:1], self.area, self.area[-1:]])
        mirrored = np.concatenate([-flow[:1], flow, -flow[-1:]])
        through = np.concatenate([momentum[:1], momentum, momentum[-1:]])
        fastest = np.concatenate([fastest[:1], fastest, fastest[-1:]])
        largest = np.maximum(fastest[1:], fastest[:-1])
        mass_flux = 0.5 * (mirrored[1:] + mirrored[:-1]) - 0.5 * largest * np.diff(area)
        momentum_flux = 0.5 * (through[1:] + through[:-1]) - 0.5 * largest * np.diff(mirrored)
        place = (np.arange(self.area.size) + 0.5 - 0.5 * self.area.size) * self.spacing
        height = np.interp(depth[[0, -1]], section.depth, section.arm) / np.maximum(pressure[[0, -1]], 1e-12)
        force = momentum_flux[-1] - momentum_flux[0]
        moment = momentum_flux[-1] * height[1] - momentum_flux[0] * height[0]
        moment += GRAVITY * self.spacing * float(self.area @ place)
        self.flow = flow - step * (np.diff(momentum_flux) / self.spacing + acceleration * self.area)
        self.area = self.area - step * np.diff(mass_flux) / self.spacing
        return force, moment, step
