"""What is kept of a shallow-water liquid's surface along the tank at the output instants of a run."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel
from slosh_cli.tank.shallow import ShallowLiquid

_MOST_INSTANTS = 2000
"""So many instants of a run are kept; where it has more every second one, or fourth, and so on."""
_MOST_PLACES = 200
"""So many places along the tank, beside one more for each part between baffles; of more cells neighbours are joined."""


class SurfaceRecord(Block):
    """Wetted areas along the tank at output instants, thinned where these are many.

    Place p is the cells from `edges[p]` to `edges[p + 1]`, (places + 1,), counted from the rear. Row r of `areas`
    (instants, places) m^2 is that of output instant `every` r, of the `told` ones so far; the areas are means of cells.
    """

    edges: Integers
    areas: Matrix
    told: int
    every: int

    @inner_kernel
    def note(self, start, end, part):
        """Take over the areas at a fraction `part` of a step between two states of the cells, linear in between."""
        areas, edges = self.areas, self.edges
        row, rest = self.told // self.every, self.told % self.every
        if rest == 0 and row == areas.shape[0]:  # their number is even: every second one leaves as many free
            row //= 2
            for k in range(1, row):
                for p in range(edges.size - 1):
                    areas[k, p] = areas[2 * k, p]
            self.every *= 2
        if rest == 0:
            for p in range(edges.size - 1):
                total = 0.0
                for i in range(edges[p], edges[p + 1]):
                    total += start[i] + part * (end[i] - start[i])
                areas[row, p] = total / (edges[p + 1] - edges[p])
        self.told += 1

    def means(self, area: Vector) -> Vector:
        """Mean areas (places,) m^2 of the cells of each place."""
        return np.asarray(np.add.reduceat(area, self.edges[:-1]) / np.diff(self.edges), dtype=np.float64)


def surface_record(liquid: ShallowLiquid, instants: int = _MOST_INSTANTS) -> SurfaceRecord:
    """An empty record of at most so many `instants`, an even number; no place of it reaches across a baffle."""
    walls = [int(face) for face in np.flatnonzero(liquid.baffles.at)]
    joined = -(-liquid.cells // _MOST_PLACES)
    parts = [np.linspace(a, b, -(-(b - a) // joined) + 1).round() for a, b in pairwise([0, *walls, liquid.cells])]
    edges = np.concatenate([[0.0], *(part[1:] for part in parts)]).astype(np.int64)
    return SurfaceRecord.blank(edges=edges, areas=np.zeros((instants, edges.size - 1)), every=1)
