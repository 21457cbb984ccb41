"""The free surface along the tank at output instants, for pictures: from what a run records of its load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.results.channels import slosh_amplitude
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import liquid_depth, section_of

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario
    from slosh_cli.tank.liquid import Slosh

_PLACES: Final = 33
_MOST_TIMES: Final = 1000


@dataclass(frozen=True, eq=False)
class SurfaceProfile:
    """Rise of the surface (m) over the still one: `rise` (times, places), at `time` s and at `place` m from the front
    end wall. `standing` is "computed", or "assumed" where the scenario gives modes without their shapes. A place that
    comes twice is a baffle, with the levels in front of it and behind it."""

    time: Vector
    place: Vector
    rise: Matrix
    standing: str


@dataclass(frozen=True, eq=False)
class WettedAreas:
    """What a shallow-water run records along its tank: the wetted `areas` (instants, places) m^2 of every `every`-th
    row, and of the last one; place p is the cells from `edges[p]` to `edges[p + 1]`, from the rear. A baffle stands in
    front of so many cells as `walls` says."""

    every: int
    edges: Integers
    walls: Integers
    areas: Matrix


def wetted_areas(liquid: Slosh) -> WettedAreas | None:
    """What the liquid of a run that ended has recorded along its tank; None for any other load."""
    from slosh_cli.tank.cells import CellLiquid

    if not isinstance(liquid, CellLiquid):
        return None
    record, walls = liquid.surface, np.flatnonzero(liquid.shallow.baffles.at[1:-1]) + 1
    areas = record.areas[: 1 + (record.told - 1) // record.every].copy()
    if (record.told - 1) % record.every:
        areas = np.vstack([areas, record.means(liquid.start.area)])
    return WettedAreas(record.every, record.edges, walls, areas)


def surface_profile(
    scenario: Scenario, time: Vector, channels: Mapping[str, Vector], wetted: WettedAreas | None = None
) -> SurfaceProfile | None:
    """The surface along the tank of a run, at not more than 2000 instants of its `time` and where it is finite.

    None where only its ends are known, as where a shallow-water liquid comes without its `wetted` areas.
    """
    found = None
    if wetted is not None:
        found = _of_cells(scenario, time, channels, wetted)
    elif scenario.tank.liquid.model in ("modal", "rigid"):
        found = _of_modes(scenario, time, channels)
    if found is None:
        return None
    sound = np.isfinite(found.rise).all(axis=1)
    return replace(found, time=found.time[sound], rise=found.rise[sound]) if sound.any() else None


def _of_cells(scenario: Scenario, time: Vector, channels: Mapping[str, Vector], wetted: WettedAreas) -> SurfaceProfile:
    """From the areas of the cells: the surface is level in each place, so that the liquid under it is all there is.

    At most it rises to the roof: what is in the slot above is a head of pressure. At the end walls it is what the
    channels say.
    """
    from slosh_cli.tank.section_table import depths_of, section_table

    tank, edges, walls = scenario.tank, wetted.edges, wetted.walls
    rows = np.unique(np.append(np.arange(0, time.size, wetted.every), time.size - 1))
    table = section_table(section_of(tank), STANDARD_GRAVITY, tank.liquid.slot_speed)
    depth = np.empty_like(wetted.areas)
    depths_of(table, wetted.areas, depth)
    behind, last = np.searchsorted(edges, walls), edges.size - 2
    places = np.concatenate([[0, last], np.stack([behind - 1, behind], axis=1).ravel(), np.arange(last + 1)])
    cells = np.concatenate([[0, edges[-1]], np.repeat(walls, 2), 0.5 * (edges[1:] + edges[:-1])])
    order = np.argsort(cells, kind="stable")
    rise = np.minimum(depth, table.roof)[:, places[order]] - liquid_depth(tank)
    rise[:, 0], rise[:, -1] = channels["surface_rear"][rows], channels["surface_front"][rows]
    place = tank.length * (1.0 - cells[order] / edges[-1])
    return SurfaceProfile(time[rows], place[::-1].copy(), rise[:, ::-1].copy(), "computed")


def _of_modes(scenario: Scenario, time: Vector, channels: Mapping[str, Vector]) -> SurfaceProfile | None:
    """The surface of a load in modes or frozen, at not more than 1000 instants.

    The n-th mode is a cosine of 2 n - 1 half waves (theory section 4), one at the front wall where it lifts the liquid
    there. Given modes count as those, from the lowest frequency on. None where that is not what the ends do.
    """
    tank = scenario.tank
    rows = np.unique(np.linspace(0, time.size - 1, min(time.size, _MOST_TIMES)).round().astype(np.int64))
    place = np.linspace(0.0, tank.length, _PLACES)
    rise, standing = np.zeros((rows.size, _PLACES)), "computed"
    if tank.liquid.model == "modal":
        from slosh_cli.tank.coefficients import slosh_modes

        standing = "computed" if isinstance(tank.coefficients, str) else "assumed"
        modes = slosh_modes(tank)
        order = np.argsort(np.argsort([mode.frequency for mode in modes], kind="stable"))
        amplitude = np.stack([channels[slosh_amplitude(n + 1)][rows] for n in range(len(modes))], axis=1)
        waves = np.cos(np.outer(2 * order + 1, np.pi * place / tank.length))
        rise = amplitude @ (np.sign([[mode.lambda_1] for mode in modes]) * waves)
    walls = np.stack([channels["surface_front"][rows], channels["surface_rear"][rows]], axis=1)
    if not np.allclose(rise[:, [0, -1]], walls, rtol=1e-9, atol=1e-9, equal_nan=True):
        return None
    return SurfaceProfile(time[rows], place, rise, standing)
