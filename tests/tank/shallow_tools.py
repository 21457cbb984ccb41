"""The shallow-water kernels under plain names, and exact solutions to hold them to."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from slosh_cli.section import EllipticalSection, PolygonalSection, RectangularSection, Section
from slosh_cli.tank.baffle import baffles_at
from slosh_cli.tank.section_table import depth_of, section_at, section_table
from slosh_cli.tank.shallow import (
    WORK_ROWS,
    ShallowLiquid,
    liquid_depths,
    liquid_energy_in_tank,
    liquid_evolve,
)

G = 9.81
LENGTH = 15.5
CIRCLE = EllipticalSection(1.5, 1.5)
BOX = RectangularSection(2.5, 3.0)
ELLIPSE = EllipticalSection(1.4, 0.9)
HEXAGON = PolygonalSection(((-0.6, 0.0), (0.6, 0.0), (1.3, 1.1), (0.6, 2.2), (-0.6, 2.2), (-1.3, 1.1)))
TROUGH = PolygonalSection(((0.0, 0.0), (1.5, 1.5), (-1.5, 1.5)))
SECTIONS = {"circle": CIRCLE, "box": BOX, "ellipse": ELLIPSE, "hexagon": HEXAGON, "trough": TROUGH}


def liquid_in(
    section: Section, cells: int, depth: float, *, length=LENGTH, density=830.0, slot_speed=30.0, walls=None
) -> ShallowLiquid:
    """A tank's liquid, `depth` deep where it is still; `walls`: openings by face."""
    return ShallowLiquid(
        cells=cells,
        spacing=length / cells,
        density=density,
        gravity=G,
        centre_height=section.centroid_height(depth),
        mass=density * section.area(depth) * length,
        still_depth=depth,
        baffles=baffles_at(cells, walls or {}),
        table=section_table(section, G, slot_speed),
        columns=1,
        disperses=0,
        riding=0.0,
    )


def places(liquid):
    """Cell centres, m from the tank's middle."""
    return (np.arange(liquid.cells) + 0.5 - 0.5 * liquid.cells) * liquid.spacing


def areas(liquid, depths):
    return np.array([section_at(liquid.table, depth)[0] for depth in np.broadcast_to(depths, liquid.cells)])


def depths(liquid, area):
    found = np.zeros(liquid.cells)
    liquid_depths(liquid, area, found)
    return found


def energy(liquid, area, flow):
    """Kinetic and potential energy in the tank's frame, J."""
    return sum(liquid_energy_in_tank(liquid, area, flow, depths(liquid, area)))


@dataclass
class Moving:
    """A liquid under way; `advance` returns impulse (N s), turning impulse (N m s), work (J), steps of the stretch."""

    liquid: ShallowLiquid
    area: np.ndarray
    flow: np.ndarray
    depth: np.ndarray

    def advance(self, acceleration: float, duration: float) -> np.ndarray:
        work, sums = np.zeros((WORK_ROWS, self.liquid.cells + 1)), np.zeros(4)
        assert liquid_evolve(self.liquid, self.area, self.flow, self.depth, acceleration, duration, work, sums)
        assert np.all(np.isfinite(self.area))
        assert np.all(np.isfinite(self.flow))
        assert self.area.min() >= 0.0
        return sums

    @property
    def energy(self) -> float:
        return energy(self.liquid, self.area, self.flow)


def moving(liquid, depth=None) -> Moving:
    """At rest with the given depths; level without."""
    area = areas(liquid, liquid.still_depth if depth is None else depth)
    return Moving(liquid, area, np.zeros(liquid.cells), depths(liquid, area))


def still_tilted(liquid, slope) -> Moving:
    """At rest with the whole liquid below the plane `level + slope x`, cut off by roof and bottom."""
    full, volume = liquid.table.full_area, liquid.cells * areas(liquid, liquid.still_depth)[0]
    reach = abs(slope) * LENGTH + liquid.table.roof

    def cut(level):
        return np.minimum(areas(liquid, level + slope * places(liquid)), full)

    area = cut(brentq(lambda level: cut(level).sum() - volume, -reach, reach, xtol=1e-15))
    return Moving(liquid, area, np.zeros(liquid.cells), depths(liquid, area))


def dam(liquid, behind, before):
    """A wall in the middle has just been taken away."""
    return moving(liquid, np.where(places(liquid) < 0, behind, before))


def history(tank: Moving, acceleration: float, duration: float, interval: float):
    """Mean force (N) and moment (N m) of each interval, and the middles of the intervals (s)."""
    count = round(duration / interval)
    rows = np.array([tank.advance(acceleration, interval)[:2] / interval for _ in range(count)])
    return (np.arange(count) + 0.5) * interval, rows[:, 0], rows[:, 1]


def ritter(place, time, behind):
    """Depth of a dam break onto a dry bed: A. Ritter, VDI-Zeitschrift 36 (1892) 947-954."""
    wave, ray = np.sqrt(G * behind), place / time
    fan = (2 * wave - ray) ** 2 / (9 * G)
    return np.where(ray < -wave, behind, np.where(ray < 2 * wave, fan, 0.0))


def stoker(place, time, behind, before):
    """Depth of a dam break onto a wet bed: J. J. Stoker, Water Waves (1957), section 10.8."""
    wave, ray = np.sqrt(G * behind), place / time

    def gap(h):
        return 2 * (wave - np.sqrt(G * h)) - (h - before) * np.sqrt(G * (h + before) / (2 * h * before))

    middle = brentq(gap, before, behind)
    speed = 2 * (wave - np.sqrt(G * middle))
    bore = middle * speed / (middle - before)
    fan = (2 * wave - ray) ** 2 / (9 * G)
    return np.where(
        ray < -wave, behind, np.where(ray < speed - np.sqrt(G * middle), fan, np.where(ray < bore, middle, before))
    )


def inverse_error(liquid, count=2000):
    """Largest relative error of the depth found back from an area."""
    top = 1.3 * liquid.table.roof
    return max(
        abs(depth_of(liquid.table, section_at(liquid.table, depth)[0]) - depth) / top
        for depth in np.linspace(1e-4 * top, top, count)
    )
