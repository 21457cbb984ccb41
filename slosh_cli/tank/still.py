"""The shallow-water liquid of a scenario's tank, at rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Literal, Protocol

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import Section, section_of
from slosh_cli.tank.baffle import Openings, baffles_at
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.load import LoadedLiquid, LoadedTank, frozen_load
from slosh_cli.tank.longitudinal import longitudinal_modes
from slosh_cli.tank.section_table import section_table
from slosh_cli.tank.shallow import WORK_ROWS, ShallowLiquid
from slosh_cli.tank.shallow_flux import fluxes

_GENTLE = 1e-3
"""An acceleration (m/s^2) that moves the surface little."""
_LONG_WAVES = 1e-3
"""Waves are long where their frequency squared is by less than that part lower than shallow water's."""
_ROUNDING = 1e-12
"""A baffle with less than this part of its area closed is none."""
CellColumns = tuple[Array, Array, Array]
"""Area m^2, flow m^3/s and depth m of every cell."""


class FlowingLiquid(LoadedLiquid, Protocol):
    """A scenario's liquid with the numbers of its shallow-water model."""

    @property
    def cells(self) -> int:
        """Finite volumes along the tank."""

    @property
    def slot_speed(self) -> float:
        """Speed of pressure waves where the section runs full, m/s."""

    @property
    def dispersion(self) -> Literal["on", "off"]:
        """Whether the motion across the section counts."""


class TransverseWall(Protocol):
    """A baffle as a scenario describes it."""

    @property
    def position(self) -> float:
        """Distance from the rear end wall, m."""

    @property
    def opening(self) -> float | None:
        """Open part of its area, evenly perforated; 0: a closed bulkhead. None where it has `bands`."""

    @property
    def bands(self) -> Sequence[tuple[float, float]]:
        """From where to where it is open, m above the bottom."""


class _FlowingTank(LoadedTank, Protocol):
    """A scenario's tank with such a liquid."""

    @property
    def baffles(self) -> Sequence[TransverseWall]:
        """Transverse walls, closed or with openings."""

    @property
    def liquid(self) -> FlowingLiquid:
        """What the tank holds."""


def shallow_liquid(
    tank: _FlowingTank, gravity: float, share: float, columns: bool = False
) -> tuple[ShallowLiquid, CellColumns]:
    """Constants for the `share` (0.5: one rail's half) of the tank's liquid, and its cells, level and at rest.

    `columns` that stand still where the tank runs full follow its acceleration at once, as only a tank that is moved as
    prescribed allows: a wagon coupled to them step by step would swing up against their mass.
    """
    section, load = section_of(tank), frozen_load(tank)
    depth, cells = tank.fill * section.height, tank.liquid.cells
    disperses = tank.liquid.dispersion == "on"
    liquid = ShallowLiquid(
        cells=cells,
        spacing=tank.length / cells,
        density=share * tank.liquid.density,
        gravity=gravity,
        centre_height=load.centre_height,
        mass=share * load.mass,
        still_depth=depth,
        baffles=baffles_at(cells, _walls(tank)),
        table=section_table(section, gravity, tank.liquid.slot_speed),
        columns=int(columns),
        disperses=int(disperses),
        riding=0.0,
    )
    columns_at_rest = np.full(cells, section.area(depth)), np.zeros(cells), np.full(cells, depth)
    if disperses:
        part = _motion_across(tank, liquid)
        liquid.table.across[:] *= part
        liquid.table.gain[:] *= part
        liquid.riding = _riding(liquid, columns_at_rest)
    return liquid, columns_at_rest


def _riding(liquid: ShallowLiquid, cells: CellColumns) -> float:
    """Mass (kg) by which the still liquid resists a tank that starts to move."""
    work, push = np.zeros((WORK_ROWS, liquid.cells + 1)), np.zeros(2)
    mass, momentum, source, still = np.zeros((4, liquid.cells + 1))
    kernel: Any = fluxes
    kernel(liquid, *cells, still, -_GENTLE, work, mass, momentum, source, push)
    return float(push[0]) * liquid.density / _GENTLE


def _motion_across(tank: _FlowingTank, liquid: ShallowLiquid) -> float:
    """The inertia of the motion across the section over the table's, so that the first slosh mode has its frequency.

    With `omega^2 (1 + k^2 beta/A) = g k^2 A/B`, for the longest part between closed bulkheads. 1 where the section has
    no finite-element mesh, and where waves are so long that the frequency hardly tells.
    """
    table, section = liquid.table, section_of(tank)
    area, width = section.area(liquid.still_depth), section.surface_width(liquid.still_depth)
    wavenumber = math.pi / longest_section(tank)
    inertia = float(np.interp(liquid.still_depth, table.depth, table.across)) * wavenumber**2 / area
    if not inertia > _LONG_WAVES:
        return 1.0
    try:
        mode = longitudinal_modes(section, liquid.still_depth, longest_section(tank)).modes[0]
    except TankError:
        return 1.0
    return (STANDARD_GRAVITY * wavenumber**2 * area / width / mode.frequency**2 - 1.0) / inertia


def longest_section(tank: _FlowingTank) -> float:
    """Length (m) of the longest part of the tank between end walls and closed bulkheads."""
    faces = sorted(face for face, openings in _walls(tank).items() if not openings)
    cells = tank.liquid.cells
    return max(end - start for start, end in pairwise([0, *faces, cells])) / cells * tank.length


def frequency_excess(tank: _FlowingTank, gravity: float) -> float:
    """How much too high shallow water's first frequency is, by potential flow in this very section.

    It is that of the longest part between closed bulkheads. Where the section has no finite-element mesh, that of a box
    of the same mean depth h = A/B: `sqrt(kh/tanh kh) - 1`. With dispersion it is that of potential flow.
    """
    if tank.liquid.dispersion == "on":
        return 0.0
    section = section_of(tank)
    depth = tank.fill * section.height
    mean_depth = section.area(depth) / section.surface_width(depth)
    length = longest_section(tank)
    wavenumber = math.pi / length
    frequency = wavenumber * math.sqrt(gravity * mean_depth)
    try:
        return frequency / longitudinal_modes(section, depth, length).modes[0].frequency - 1.0
    except TankError:
        return math.sqrt(wavenumber * mean_depth / math.tanh(wavenumber * mean_depth)) - 1.0


def open_share(wall: TransverseWall, section: Section) -> float:
    """Open part of the whole area of a baffle."""
    if wall.opening is not None:
        return wall.opening
    open_area = sum(section.area(high) - section.area(low) for low, high, _ in _bands(wall, section))
    return min(open_area / section.area(section.height), 1.0)


def _bands(wall: TransverseWall, section: Section) -> Openings:
    """A baffle's openings from the bottom up: evenly perforated it is one of the whole height."""
    if wall.opening is None:
        return tuple((low, min(high, section.height), 1.0) for low, high in sorted(wall.bands))
    return ((0.0, section.height, wall.opening),) if wall.opening**2 > 0.0 else ()


def _walls(tank: _FlowingTank) -> dict[int, Openings]:
    """The openings of every baffle that bars anything, by the nearest face between cells."""
    section = section_of(tank)
    return {
        round(wall.position / tank.length * tank.liquid.cells): _bands(wall, section)
        for wall in tank.baffles
        if open_share(wall, section) < 1.0 - _ROUNDING
    }
