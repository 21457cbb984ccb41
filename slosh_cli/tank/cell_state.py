"""The cells of a shallow-water liquid at one instant, and what they amount to."""

from __future__ import annotations

import math

from slosh_cli.arrays import Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel
from slosh_cli.tank.baffle import CLOSED, baffle_loss
from slosh_cli.tank.section_table import section_at
from slosh_cli.vectors import copy


class Cells(Block):
    """A shallow-water liquid at one instant: wetted area m^2, flow m^3/s and depth m of each cell, (cells,).

    The kernels take the `ShallowLiquid` whose cells they are.
    """

    area: Vector
    flow: Vector
    depth: Vector

    @inner_kernel
    def copy_to(self, target):
        """Copy areas, flows and depths."""
        copy(self.area, target.area)
        copy(self.flow, target.flow)
        copy(self.depth, target.depth)

    @inner_kernel
    def momentum(self, liquid):
        """Momentum (N s) of the liquid relative to the tank."""
        flow, total = self.flow, 0.0
        for i in range(liquid.cells):
            total += flow[i]
        return total * liquid.density * liquid.spacing

    @inner_kernel
    def weights_moment(self, liquid):
        """Moment (N m) of the liquid's weight about the tank's middle, nose-down."""
        area, count, arm = self.area, liquid.cells, 0.0
        for i in range(count):
            arm += area[i] * (i + 0.5 - 0.5 * count)
        return liquid.density * liquid.gravity * liquid.spacing * liquid.spacing * arm

    @inner_kernel
    def rise(self, liquid):
        """Rise (m) of the surface over the still level at the front and at the rear wall, at most to the roof."""
        roof, still, depth = liquid.table.roof, liquid.still_depth, self.depth
        return min(depth[liquid.cells - 1], roof) - still, min(depth[0], roof) - still

    @inner_kernel
    def reached_mass(self, liquid, step):
        """Mass (kg) that bears on walls and baffles when the tank's acceleration changes for `step` (s).

        The mean force of that time is that of half the length which waves run. The surface's slope within a cell
        follows an acceleration at once, so that half a cell counts in any step. A baffle counts by the part of a flow
        that it bars.
        """
        total = 0.0
        for face in range(liquid.cells + 1):
            wall = face in (0, liquid.cells) or liquid.baffles.at[face] == CLOSED
            if not wall and liquid.baffles.at[face] == 0:
                continue
            for cell in range(max(face - 1, 0), min(face + 1, liquid.cells)):
                area, _, width = section_at(liquid.table, self.depth[cell])
                if area > 0.0:
                    wave = math.sqrt(liquid.gravity * area / width)
                    bars = 1.0
                    if not wall:
                        loss = baffle_loss(liquid.baffles, liquid.baffles.at[face], liquid.table, self.depth[cell])
                        bars -= 2.0 / (1.0 + math.sqrt(1.0 + loss * abs(self.flow[cell]) / (area * wave)))
                    total += bars * area * (liquid.spacing + step * wave)
        return min(0.5 * liquid.density * total, liquid.mass)
