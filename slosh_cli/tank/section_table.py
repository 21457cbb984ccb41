"""A cross-section as a table that compiled kernels can read: area, moments and width against depth, with a slot.

Where the section runs full, a narrow slot above the roof (Preissmann's) keeps the open-channel equations valid: the
depth in it is the pressure head, and its width sets the speed of pressure waves, `c^2 = g A / b`; J. A. Cunge and M.
Wegner, La Houille Blanche 1 (1964) 33-39.
"""

from __future__ import annotations

import math

import numpy as np

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import kernel
from slosh_cli.section import PolygonalSection, Section

_NODES = 400
"""Intervals of the table, crowded towards bottom and roof where the width varies fastest."""
_BINS = 4096
"""Equal parts of depth and area that tell where the search for a node starts."""
LEDGE = 1e-9
"""Either side of a corner's level, by this part of the section's height, lies a node: the width may jump there."""


class SectionTable(Block):
    """Section at the depths (K,) m up to where the slot of `slot_width` (m) takes over.

    The roof is at `roof` (m); up to there the section holds `full_area` (m^2).

    `area` m^2, `width` m, `first` = INT z b dz m^3, `pressure` = INT (h - z) b dz m^3 (the moment I1 of the
    equations) and `pressure_arm` = INT (h - z) z b dz m^4, each (K,). `curves` (K - 1, 10): of each interval the depth
    at its start, one over its length, and the coefficients of the cubics of area and pressure in the part passed.
    `across` and `gain` (K,) m^4 are of the motion across the section (`dispersion`). `depth_start`, `area_start`
    (_BINS + 1,): the last node not beyond the start of each of as many parts of depth and area, of which there are
    `per_depth` 1/m and `per_area` 1/m^2.
    """

    depth: Vector
    area: Vector
    width: Vector
    first: Vector
    pressure: Vector
    pressure_arm: Vector
    curves: Matrix
    across: Vector
    gain: Vector
    depth_start: Integers
    area_start: Integers
    per_depth: float
    per_area: float
    slot_width: float
    roof: float
    full_area: float


def _slot_start(section: Section, slot_width: float) -> float:
    """Depth (m) above which the section is narrower than the slot all the way to the roof."""
    depths = section.height * (1 - np.geomspace(1e-9, 0.5, 2000))  # from the roof down to the middle
    wide = [section.surface_width(float(depth)) >= slot_width for depth in depths]
    first = int(np.argmax(wide))
    return section.height if first == 0 else float(depths[first])


def _nodes(section: Section, top: float) -> Vector:
    """Depths (m) of the table up to `top`; a polygon's corners are among them, so that no interval has one inside."""
    half = 0.5 * top * np.linspace(0.0, 1.0, _NODES // 2 + 1) ** 2
    depth = np.concatenate([half, top - half[-2::-1]])
    if not isinstance(section, PolygonalSection):
        return depth
    beside = LEDGE * section.height
    levels = {z for _, z in section.points}
    corners = [z + side for z in levels for side in (-beside, beside) if beside < z + side < top - beside]
    apart = [z for z in depth[1:-1] if all(abs(z - corner) > 10 * beside for corner in corners)]
    return np.asarray(sorted([0.0, *apart, *corners, top]), dtype=np.float64)


def _starts(places: Vector) -> Integers:
    """Last node not beyond the start of each bin, short of it by rounding."""
    edges = np.linspace(0.0, float(places[-1]), _BINS + 1) - 1e-12 * places[-1]
    return np.asarray(np.maximum(np.searchsorted(places, edges, side="right") - 1, 0), dtype=np.int64)


def _across(depth: Vector, area: Vector, width: Vector) -> tuple[Vector, Vector]:
    """`beta` (m^4) of the motion across a section filled to its depths, and `A beta' - beta`, each (K,).

    All at one height is taken to sink alike, and to move sideways in proportion to its distance from the middle, as
    wide as the wall goes there. No such flow has less energy than the potential flow (Kelvin's theorem); in a half-full
    cylinder it has 3 % more.
    """
    span, mean = np.diff(depth), 0.5 * (width[1:] + width[:-1])
    widening = np.where(span > 10 * LEDGE * depth[-1], np.diff(width) / span, 0.0)  # ledges are steps, not slopes
    areas = (area[1:] ** 2 + area[1:] * area[:-1] + area[:-1] ** 2) / 3.0
    rates = areas / mean * (1.0 + widening**2 / 12.0)
    across = np.concatenate([[0.0], np.cumsum(rates * span)])
    rate = np.interp(depth, 0.5 * (depth[1:] + depth[:-1]), rates)
    return across, area / np.maximum(width, mean[-1]) * rate - across


def _curves(depth: Vector, area: Vector, width: Vector, pressure: Vector) -> Matrix:
    """`SectionTable.curves`: cubics through the nodes with the slopes that area and pressure have there."""
    span, columns = np.diff(depth), [depth[:-1], 1.0 / np.diff(depth)]
    for value, slope in ((area, width), (pressure, area)):
        rise, start, end = np.diff(value), span * slope[:-1], span * slope[1:]
        columns += [value[:-1], start, 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise]
    return np.ascontiguousarray(np.column_stack(columns))


def section_table(section: Section, gravity: float, slot_speed: float) -> SectionTable:
    """Tabulate `section`; pressure waves in the full section run at `slot_speed` (m/s). Gravity in m/s^2."""
    slot_width = gravity * section.area(section.height) / slot_speed**2
    top = _slot_start(section, slot_width)
    depth = _nodes(section, top)
    area = np.array([section.area(float(h)) for h in depth])
    centroid = np.array([section.centroid_height(float(h)) for h in depth])
    second = np.array([section.second_moment(float(h)) for h in depth]) + area * centroid**2
    width = np.array([section.surface_width(float(h)) for h in depth])
    width[0] = section.surface_width(1e-12 * section.height)  # the limit from inside, as at the top
    width[-1] = max(slot_width, section.surface_width(top * (1 - 1e-9)))
    first = area * centroid
    pressure = depth * area - first
    across, gain = _across(depth, area, width)
    return SectionTable(
        depth=depth,
        area=area,
        width=width,
        first=first,
        pressure=pressure,
        pressure_arm=depth * first - second,
        curves=_curves(depth, area, width, pressure),
        across=across,
        gain=gain,
        depth_start=_starts(depth),
        area_start=_starts(area),
        per_depth=_BINS / float(depth[-1]),
        per_area=_BINS / float(area[-1]),
        slot_width=slot_width,
        roof=section.height,
        full_area=section.area(section.height),
    )


@kernel
def _node(places, start, bins_per, place):
    """Last of the `places` (K,) not beyond `place`, searched from its bin's `start`."""
    node = start[int(bins_per * place)]
    while node < places.size - 2 and places[node + 1] <= place:
        node += 1
    return node


@kernel
def depth_of(table, area):
    """Depth (m) of a wetted area (m^2): the table's cubic, inverted by Newton's method; above it the slot."""
    depths, areas = table.depth, table.area
    last = depths.size - 1
    if area >= areas[last]:
        return depths[last] + (area - areas[last]) / table.slot_width
    if area <= 0.0:
        return 0.0
    k = _node(areas, table.area_start, table.per_area, area)
    curve = table.curves[k]
    first, second, third = curve[3], curve[4], curve[5]
    wanted, whole = area - curve[2], first + second + third
    part = wanted / whole
    part += (second + third) / whole * part * (1.0 - part)
    for _ in range(20):
        value = part * (first + part * (second + part * third))
        slope = first + part * (2.0 * second + 3.0 * part * third)
        following = min(max(part + (wanted - value) / slope if slope > 0.0 else part, 0.0), 1.0)
        change = following - part
        part = following
        if abs(change) <= 1e-8:  # the next change would be about the square of this one
            break
    return curve[0] + part / curve[1]


@kernel
def depths_of(table: SectionTable, areas: Matrix, depths: Matrix) -> None:
    """Depths (n, m) m of wetted areas (n, m) m^2; none of what is not finite."""
    for i in range(areas.shape[0]):
        for k in range(areas.shape[1]):
            depths[i, k] = depth_of(table, areas[i, k]) if math.isfinite(areas[i, k]) else math.nan


@kernel
def section_in(curves, starts, bins_per_metre, top, full, pressed, slot, depth):
    """Area (m^2), moment I1 (m^3) and surface width (m) at a depth (m): `section_at` for loops.

    Takes the table's `curves`, `depth_start` and `per_depth`, depth, area and moment at its last node, and the width of
    the slot.
    """
    if depth >= top:
        head = depth - top
        return full + slot * head, pressed + head * (full + 0.5 * slot * head), slot
    if depth <= 0.0:
        return 0.0, 0.0, 1.0
    k = starts[int(bins_per_metre * depth)]
    while k < curves.shape[0] - 1 and curves[k + 1, 0] <= depth:
        k += 1
    part = (depth - curves[k, 0]) * curves[k, 1]
    a1, a2, a3 = curves[k, 3], curves[k, 4], curves[k, 5]
    area = curves[k, 2] + part * (a1 + part * (a2 + part * a3))
    width = (a1 + part * (2.0 * a2 + 3.0 * part * a3)) * curves[k, 1]
    pressure = curves[k, 6] + part * (curves[k, 7] + part * (curves[k, 8] + part * curves[k, 9]))
    return area, pressure, max(width, 1e-12)


@kernel
def section_at(table, depth):
    """Area (m^2), moment I1 (m^3) and surface width (m) at a depth (m)."""
    last = table.depth.size - 1
    top, full, pressed = table.depth[last], table.area[last], table.pressure[last]
    return section_in(table.curves, table.depth_start, table.per_depth, top, full, pressed, table.slot_width, depth)


@kernel
def across_at(table, depth):
    """`across` and `gain` (m^4) at a depth; none where the section runs full, as the roof lets nothing rise."""
    depths = table.depth
    last = depths.size - 1
    if depth <= 0.0 or depth >= depths[last]:
        return 0.0, 0.0
    k = _node(depths, table.depth_start, table.per_depth, depth)
    part = (depth - depths[k]) / (depths[k + 1] - depths[k])
    across = table.across[k] + part * (table.across[k + 1] - table.across[k])
    return across, table.gain[k] + part * (table.gain[k + 1] - table.gain[k])


@kernel
def full_level(table):
    """Depth (m) at which the whole section is full: the roof, but for the sliver below it that the slot replaces."""
    last = table.depth.size - 1
    return table.depth[last] + (table.full_area - table.area[last]) / table.slot_width


@kernel
def stored_level(table, area, depth):
    """Depth (m) to which a cell holds its area (m^2): under a column's pressure less than its depth (`roof`)."""
    last = table.depth.size - 1
    return min(depth, table.depth[last] + max(area - table.area[last], 0.0) / table.slot_width)


@kernel
def potential_at(table, depth):
    """INT z b dz (m^3) at a depth (m): potential energy per length over density and gravity."""
    last = table.depth.size - 1
    if depth >= table.depth[last]:
        head = depth - table.depth[last]
        return table.first[last] + table.slot_width * head * (table.depth[last] + 0.5 * head)
    area, pressure, _ = section_at(table, depth)
    return depth * area - pressure


@kernel
def pressure_height(table, depth):
    """Height (m) above the bottom at which the pressure on an end wall acts."""
    if depth <= 0.0:
        return 0.0
    last = table.depth.size - 1
    if depth >= table.depth[last]:
        head = depth - table.depth[last]
        arm = table.pressure_arm[last] + head * table.first[last]
        return arm / (table.pressure[last] + head * table.area[last])
    k = _node(table.depth, table.depth_start, table.per_depth, depth)
    area, pressure, _ = section_at(table, depth)
    part = (depth - table.depth[k]) * table.curves[k, 1]
    arm = table.pressure_arm[k] + part * (table.pressure_arm[k + 1] - table.pressure_arm[k])
    return min(arm / pressure, depth) if pressure > 0.0 and area > 0.0 else 0.0
