"""Where the section runs full up to a wall, the liquid stands still: nothing but pressure passes.

A slot above the roof (`section_table`) stores liquid under a head however long the head stands, and the surface
elsewhere sinks for it; pressure waves in it ring on. So in a tank that is more than `NEARLY_FULL` the full cells from
the deeper wall on are taken for what they are: a column that neither moves nor gives way, hydrostatic from the first
open surface on. That surface is reflected by the column as by a wall. The column takes in the next cell once that has
run full, and the walls bear its momentum; it lets one go where its pressure would turn into tension. Both only take
energy. Everywhere else the slot carries what strikes the roof for a moment.
"""

from __future__ import annotations

import math

from slosh_cli.compiled import kernel
from slosh_cli.tank.baffle import CLOSED
from slosh_cli.tank.section_table import depth_of, full_level

NEARLY_FULL = 0.6
"""Tanks filled less than that (depth over height) leave what strikes the roof to the slot alone."""
_ROOM = 0.02
"""What the slot held as a column formed goes back to the open surface, this part of the room in its cells at a time."""
_FULL = 1.0 - 1e-13
"""A cell holding this part of the whole section is full."""


@kernel
def _stand_from(liquid, area, depth, wall, beyond, tilt, still):
    """The column at the deeper `wall` of the cells up to before `beyond`."""
    table = liquid.table
    lid, full = full_level(table), table.full_area
    way = 1 if beyond > wall else -1
    end = wall
    while end != beyond and area[end] >= _FULL * full:
        end += way
    if end in (beyond, wall):
        return
    if depth[end] + tilt < lid:
        end -= way
    target, i = end, end
    room = _ROOM * max(full - area[end], 0.0)
    while i != wall:
        i -= way
        still[i] = 1.0
        while area[i] > full and target != beyond:
            moved = min(area[i] - full, room)
            area[i] -= moved
            area[target] += moved
            room -= moved
            if room <= 0.0:
                depth[target] = depth_of(table, area[target])
                target += way
                room = _ROOM * max(full - area[target], 0.0) if target != beyond else 0.0
    if target != beyond:
        depth[target] = depth_of(table, area[target])
    i = wall
    while i != end:
        depth[i] = max(depth[end] + tilt * abs(end - i), lid)
        i += way


@kernel
def stand_still(liquid, area, depth, acceleration, still):
    """Mark in `still` (cells,) the cells of full columns and set their depth to the pressure's; True where one stands.

    Each section between closed bulkheads may have one, at its deeper wall.
    """
    for i in range(liquid.cells):
        still[i] = 0.0
    if not liquid.columns or acceleration == 0.0 or liquid.still_depth < NEARLY_FULL * liquid.table.roof:
        return False
    tilt = acceleration * liquid.spacing / liquid.gravity
    first = 0
    for end in range(1, liquid.cells + 1):
        if end < liquid.cells and liquid.baffles.at[end] != CLOSED:
            continue
        if tilt > 0.0:
            _stand_from(liquid, area, depth, first, end, tilt, still)
        else:
            _stand_from(liquid, area, depth, end - 1, first - 1, -tilt, still)
        first = end
    return True


@kernel
def stop_columns(liquid, flow, still, step):
    """Let what is left of the flow in full columns come to rest; returns the flow (m^3/s) taken, summed over cells.

    A blow is as sharp as pressure waves are fast: it lasts what they need for the tank's length.
    """
    table = liquid.table
    speed = math.sqrt(liquid.gravity * table.full_area / table.slot_width)
    kept = math.exp(-step * speed / (liquid.cells * liquid.spacing))
    taken = 0.0
    for i in range(liquid.cells):
        if still[i] > 0.0:
            taken += (1.0 - kept) * flow[i]
            flow[i] *= kept
    return taken


@kernel
def column_push(liquid, area, acceleration, momentum, still, push):
    """Add to `push` (2,) the force over density (m^4/s^2) of columns on their walls, and its moment (m^5/s^2).

    A column hands the pressure of the first open surface on to its wall, with its own inertia: `momentum` (cells + 1,)
    holds the momentum flux where they meet.
    """
    table, cells = liquid.table, liquid.cells
    last = table.depth.size - 1
    way = 1 if acceleration < 0.0 else -1
    place = 0 if way > 0 else cells - 1
    through = 0.0
    for _ in range(cells):
        ahead = place + 1 if way > 0 else place
        if still[place] > 0.0:
            before = place - way
            if not 0 <= before < cells or still[before] == 0.0:
                through = momentum[place if way > 0 else place + 1]
            through -= way * acceleration * area[place] * liquid.spacing
            if ahead in (0, cells) or liquid.baffles.at[ahead] == CLOSED:
                beyond = (through - liquid.gravity * table.pressure[last]) * table.first[last] / table.area[last]
                push[0] += way * through
                push[1] += way * (liquid.gravity * table.pressure_arm[last] + beyond)
        place += way
