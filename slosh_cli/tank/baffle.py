"""Transverse walls in the tank by where they are open: what a baffle lets through (theory section 10.6).

The flow is the discharge through the wetted part of the openings under the two levels at the wall. Where both sides
are wet, the head is the difference of the levels; between the levels a jet falls freely (P. L. G. Du Buat's partly
submerged orifice, 1786; H. W. King and E. F. Brater, Handbook of Hydraulics, section 4). The jet contracts as behind a
thin sharp edge and loses what it has over the flow behind it (I. E. Idelchik, Handbook of Hydraulic Resistance,
diagram 4-10; J.-C. de Borda and L. Carnot).
"""

from __future__ import annotations

import math

import numpy as np

from slosh_cli.arrays import Integers, Matrix
from slosh_cli.blocks import Block
from slosh_cli.compiled import kernel
from slosh_cli.tank.section_table import section_at

Openings = tuple[tuple[float, float, float], ...]
"""Bands of a wall: from and to (m above the bottom), and the open part of the wall's area there."""
CLOSED = -1
"""A face that nothing passes."""
_EDGE = 0.707
"""Idelchik's contraction at a sharp edge with the open part f of a wall: 1/(1 + 0.707 sqrt(1 - f)) of the opening."""
_ROUNDS, _SETTLED = 6, 1e-10
"""The part that passes is sought by the secant rule in at most so many rounds, until it changes by less."""
_LEAST = 1e-9
"""Resistances and parts held back are not taken for smaller."""
_GAUSS, _PIECES = math.sqrt(0.6), 2
"""Gauss's points of three, and the pieces of a jet over which they are taken."""


class Baffles(Block):
    """The walls between cells. Walls of fewer openings than others have empty bands besides.

    `at` (cells + 1,) tells of each face: 0 no wall, CLOSED, or 1 + the row of a wall with openings; `low`, `high` (m
    above the bottom) and `share`, the open part, of each opening, are (walls, openings).
    """

    at: Integers
    low: Matrix
    high: Matrix
    share: Matrix


def baffles_at(cells: int, walls: dict[int, Openings]) -> Baffles:
    """The walls of a tank of so many cells, by face; a wall without openings is closed."""
    at = np.zeros(cells + 1, dtype=np.int64)
    bands = [openings for openings in walls.values() if openings]
    shape = max(len(bands), 1), max((len(openings) for openings in bands), default=1)
    low, high, share = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    at[[face for face, openings in walls.items() if not openings]] = CLOSED
    at[[face for face, openings in walls.items() if openings]] = np.arange(len(bands)) + 1
    for row, openings in enumerate(bands):
        for column, band in enumerate(openings):
            low[row, column], high[row, column], share[row, column] = band
    return Baffles(at=at, low=low, high=high, share=share)


@kernel
def _open_area(walls, wall, table, depth):
    """Open area (m^2) of a wall below a depth (m)."""
    total, row = 0.0, wall - 1
    for k in range(walls.low.shape[1]):
        low, high = walls.low[row, k], min(walls.high[row, k], depth)
        if walls.share[row, k] > 0.0 and high > low:
            above, _, _ = section_at(table, high)
            below, _, _ = section_at(table, low)
            total += walls.share[row, k] * (above - below)
    return total


@kernel
def _open_part(walls, wall, table, depth):
    """Open part of the area that is wetted at a depth (m); that of a dry wall is 1."""
    depth = min(depth, table.depth[table.depth.size - 1])
    area, _, _ = section_at(table, depth)
    return min(_open_area(walls, wall, table, depth) / area, 1.0) if area > 0.0 else 1.0


@kernel
def _submerged_resistance(part):
    """Ideal discharge over discharge below both levels, of the open `part` of a wall."""
    return max(1.0 + _EDGE * math.sqrt(1.0 - part) - part, _LEAST)


@kernel
def baffle_loss(walls, wall, table, depth):
    """Loss coefficient, on the speed in the tank, of a wall between equal depths (m); infinite above the liquid."""
    part = _open_part(walls, wall, table, depth)
    return (_submerged_resistance(part) / part) ** 2 if part > 1e-150 else math.inf


@kernel
def _falling(walls, wall, table, lower, higher):
    """INT sqrt(higher - z) db dz (m^2.5) over the openings between two levels (m)."""
    total, row = 0.0, wall - 1
    for k in range(walls.low.shape[1]):
        low, high = max(walls.low[row, k], lower), min(walls.high[row, k], higher)
        if walls.share[row, k] > 0.0 and high > low:
            # by parts INT A d(root) of the root of the head, smooth at corners of the section, a parabola in a box
            start, end = math.sqrt(higher - high), math.sqrt(higher - low)
            above, _, _ = section_at(table, high)
            below, _, _ = section_at(table, low)
            part = start * above - end * below
            half = 0.5 * (end - start) / _PIECES
            for point in range(3 * _PIECES):
                place = point % 3 - 1
                root = start + (2 * (point // 3) + 1 + place * _GAUSS) * half
                area, _, _ = section_at(table, higher - root * root)
                part += (8.0 if place == 0 else 5.0) / 9.0 * half * area
            total += walls.share[row, k] * part
    return total


@kernel
def discharge(walls, wall, table, gravity, lower, gap):
    """Flow (m^3/s) through a wall from a level `gap` (m) over the `lower` one."""
    higher = lower + gap
    part = _open_part(walls, wall, table, higher)
    contraction = 1.0 + _EDGE * math.sqrt(1.0 - part)
    free = max(math.sqrt(max(contraction * contraction - part * part, 0.0)), _LEAST)
    flow = _falling(walls, wall, table, lower, higher) / free
    below = min(part, _open_part(walls, wall, table, lower))
    flow += _open_area(walls, wall, table, lower) * math.sqrt(gap) / _submerged_resistance(below)
    return math.sqrt(2.0 * gravity) * flow


@kernel
def _push(table, low, high, lower, higher):
    """Force over density and gravity (m^3) of two levels (m) on the band of a section, and its moment (m^4)."""
    force = moment = 0.0
    if min(high, lower) > low:
        above, above_pressure, _ = section_at(table, min(high, lower))
        below, below_pressure, _ = section_at(table, low)
        force = (higher - lower) * (above - below)
        moment = (higher - lower) * (min(high, lower) * above - above_pressure - low * below + below_pressure)
    start, end = max(low, lower), min(high, higher)
    for point in range(3 if end > start else 0):  # Gauss's rule
        height = 0.5 * (start + end) + 0.5 * (point - 1) * _GAUSS * (end - start)
        _, _, width = section_at(table, height)
        part = (8.0 if point == 1 else 5.0) / 18.0 * (end - start) * (higher - height) * width
        force += part
        moment += part * height
    return force, moment


@kernel
def solid_height(walls, wall, table, depth, depth_2):
    """Height (m) above the bottom at which two depths (m) push a wall with openings: where it is not open."""
    lower, higher, row = min(depth, depth_2), max(depth, depth_2, 1e-6 * table.roof), wall - 1
    higher = max(higher, lower * (1.0 + 1e-6))
    force, moment = _push(table, 0.0, table.depth[table.depth.size - 1], lower, higher)
    whole = force
    for k in range(walls.low.shape[1]):
        open_force, open_moment = _push(table, walls.low[row, k], walls.high[row, k], lower, higher)
        force -= walls.share[row, k] * open_force
        moment -= walls.share[row, k] * open_moment
    return moment / force if force > _LEAST * whole else 0.5 * higher


@kernel
def _level(depth, area, width, excess):
    """Level (m) at which the pressure's moment I1 is larger by `excess` (m^3); exact where the width is constant."""
    under = area + math.sqrt(max(area * area + 2.0 * width * excess, 0.0))
    return max(depth + 2.0 * excess / under, 0.0) if under > 0.0 else depth


@kernel
def passing_part(walls, wall, table, gravity, flow, depth, area, width, excess, depth_2, area_2, width_2, excess_2):
    """Part of the `flow` (m^3/s) through an open face that a wall lets through, between 0 and 1.

    Depth, area and width are those upstream and (`_2`) downstream; `excess` (m^3) is how much I1 grows where the wall
    holds all. The more passes, the nearer the levels at the wall: by as much from either side.
    """
    lower = _level(depth_2, area_2, width_2, excess_2)
    waves = math.sqrt(gravity * area / width) + math.sqrt(gravity * area_2 / width_2)
    gap = max(_level(depth, area, width, excess) - lower, waves * abs(flow) / (gravity * (area + area_2)))
    part = before = change = 0.0
    for k in range(_ROUNDS):
        held = max(1.0 - part, _LEAST)
        through = discharge(walls, wall, table, gravity, lower + 0.5 * (1.0 - held) * gap, held * gap)
        following = 0.0
        if through > 0.0:
            following = 2.0 / (1.0 + math.sqrt(1.0 + 4.0 * held * (flow / through) ** 2))
        change_before, change = change, following - part
        if abs(change) < _SETTLED:
            break
        step = change if k == 0 else change * (part - before) / (change_before - change)
        before, part = part, min(max(part + step, 0.0), 1.0)
    return part
