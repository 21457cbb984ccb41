"""Fluxes of the shallow-water liquid between its cells, at its walls and through its baffles.

HLL fluxes (A. Harten, P. D. Lax and B. van Leer, SIAM Review 25 (1983) 35-61) of states reconstructed from the surface
relative to the still tilted one, so that a still liquid stays still (E. Audusse et al., SIAM J. Sci. Comput. 25 (2004)
2050-2065), with limited slopes.
"""

from __future__ import annotations

import math

from slosh_cli.compiled import kernel
from slosh_cli.tank.baffle import CLOSED, passing_part, solid_height
from slosh_cli.tank.dispersion import disperse
from slosh_cli.tank.roof import column_push
from slosh_cli.tank.section_table import LEDGE, pressure_height, section_in

DRY = 1e-7
"""A cell with less than this part of the full section's area holds still."""
_STILL = 1e-2
"""A liquid slower than this part of its waves' speed is more and more taken for still."""
STEEPENED, _MILD = 1.2, 0.5
"""Slopes may be this much steeper than minmod's in waves whose slope, drawn out over the whole tank, would change depth
and speed by much less than this part of the depth and of the waves' speed: minmod wears small waves down, but is the
steadiest at bores."""


@kernel
def _limited(before, after, mild):
    """Limited slope between two differences: minmod, where they are small beside `mild` a little steeper."""
    if before * after <= 0.0:
        return 0.0
    least, mean = min(abs(before), abs(after)), 0.5 * abs(before + after)
    if mean < mild:
        least = min(least * (STEEPENED - (STEEPENED - 1.0) * mean / mild), mean)
    return math.copysign(least, before)


@kernel
def _hll(gravity, area_l, speed_l, pressure_l, width_l, area_r, speed_r, pressure_r, width_r):
    """HLL flux of mass (m^3/s) and momentum (m^4/s^2) between two states, and its fastest signal (m/s)."""
    wave_l = math.sqrt(gravity * area_l / width_l)
    wave_r = math.sqrt(gravity * area_r / width_r)
    if area_l <= 0.0:
        speed_l, wave_l = speed_r - 2.0 * wave_r, 0.0
    if area_r <= 0.0:
        speed_r, wave_r = speed_l + 2.0 * wave_l, 0.0
    left = min(speed_l - wave_l, speed_r - wave_r)
    right = max(speed_l + wave_l, speed_r + wave_r)
    fastest = max(-left, right)
    flow_l, flow_r = area_l * speed_l, area_r * speed_r
    momentum_l = flow_l * speed_l + gravity * pressure_l
    momentum_r = flow_r * speed_r + gravity * pressure_r
    if left >= 0.0:
        return flow_l, momentum_l, fastest
    if right <= 0.0:
        return flow_r, momentum_r, fastest
    part, both = 1.0 / (right - left), left * right
    mass = (right * flow_l - left * flow_r + both * (area_r - area_l)) * part
    momentum = (right * momentum_l - left * momentum_r + both * (flow_r - flow_l)) * part
    return mass, momentum, fastest


@kernel
def _slopes(liquid, area, flow, depth, speeds, still, acceleration, slope_depth, slope_speed):
    """Speeds of the cells (m/s), and limited changes over a cell of depth (m, the still tilt included) and speed.

    Closed bulkheads and columns at rest (`still`) are walls.
    """
    cells, at, gravity, table = liquid.cells, liquid.baffles.at, liquid.gravity, liquid.table
    mild = _MILD / cells
    tilt = acceleration * liquid.spacing / gravity
    last = table.area.size - 1
    dry, roof = DRY * table.area[last], table.depth[last]
    for i in range(cells):
        speeds[i] = flow[i] / area[i] if area[i] > dry else 0.0
    for i in range(cells):
        speed = speeds[i]
        surface_b = surface_a = 0.0
        speed_b, speed_a = 2.0 * speed, -2.0 * speed
        wet = area[i] > dry
        if i > 0 and at[i] != CLOSED and still[i - 1] == 0.0:
            wet = wet and area[i - 1] > dry
            surface_b = depth[i] - depth[i - 1] + tilt
            speed_b = speed - speeds[i - 1]
        if i < cells - 1 and at[i + 1] != CLOSED and still[i + 1] == 0.0:
            wet = wet and area[i + 1] > dry
            surface_a = depth[i + 1] - depth[i] + tilt
            speed_a = speeds[i + 1] - speed
        slope_depth[i] = slope_speed[i] = 0.0
        if wet:
            slope_depth[i] = _limited(surface_b, surface_a, mild * depth[i])
            slope_speed[i] = _limited(speed_b, speed_a, mild * math.sqrt(gravity * depth[i]))
        if abs(depth[i] - roof) < 0.5 * abs(slope_depth[i] - tilt):  # the surface meets the roof inside the cell
            slope_depth[i] = 0.0
        slope_depth[i] -= tilt
        # in a flow no cell's surface reaches through the roof: fast waves begin where a cell's mean is full; so the
        # force jumps at no acceleration. A still liquid's surface may
        room = 2.0 * max(abs(depth[i] - roof) - LEDGE * roof, 0.0)
        if abs(slope_depth[i]) > room and area[i] > dry:
            flowing = min(speed * speed / (_STILL * _STILL * gravity * depth[i]), 1.0)
            slope_depth[i] += flowing * (math.copysign(room, slope_depth[i]) - slope_depth[i])
        # neither end of a cell lies below the bed
        slope_depth[i] = min(max(slope_depth[i], -2.0 * depth[i]), 2.0 * depth[i])


@kernel
def _baffle(liquid, wall, depth_l, area_l, speed_l, pressure_l, width_l, depth_r, area_r, speed_r, pressure_r, width_r):
    """Flow (m^3/s) through a baffle, momentum fluxes (m^4/s^2) on its rear and front side, fastest signal (m/s).

    Between the fluxes of an open face and those on a closed wall, as the flow lies between the open face's and none:
    such a mean of two fluxes that feed no energy feeds none. The difference of momentum that is left across the baffle
    is its loss.
    """
    gravity = liquid.gravity
    mass, open_, fastest = _hll(gravity, area_l, speed_l, pressure_l, width_l, area_r, speed_r, pressure_r, width_r)
    _, wall_l, fast_l = _hll(gravity, area_l, speed_l, pressure_l, width_l, area_l, -speed_l, pressure_l, width_l)
    _, wall_r, fast_r = _hll(gravity, area_r, -speed_r, pressure_r, width_r, area_r, speed_r, pressure_r, width_r)
    fastest = max(fastest, fast_l, fast_r)
    if wall == CLOSED or mass == 0.0:
        return 0.0, wall_l, wall_r, fastest
    more_l, more_r = wall_l / gravity - pressure_l, wall_r / gravity - pressure_r
    walls, table = liquid.baffles, liquid.table
    if mass > 0.0:
        part = passing_part(
            walls, wall, table, gravity, mass, depth_l, area_l, width_l, more_l, depth_r, area_r, width_r, more_r
        )
    else:
        part = passing_part(
            walls, wall, table, gravity, mass, depth_r, area_r, width_r, more_r, depth_l, area_l, width_l, more_l
        )
    return part * mass, wall_l + part * (open_ - wall_l), wall_r + part * (open_ - wall_r), fastest


@kernel
def _turning(liquid, wall, still, depth, face, depth_l, depth_r, before, after):
    """Moment (m^5/s^2) on a baffle of the momentum fluxes before and after it, about the bottom.

    Where it is open nothing bears on it. A closed one, or beside a column, bears the pressures of both sides' cells.
    """
    table = liquid.table
    if wall == CLOSED or still[face - 1] + still[face] > 0.0:
        return before * pressure_height(table, depth[face - 1]) - after * pressure_height(table, depth[face])
    return (before - after) * solid_height(liquid.baffles, wall, table, depth_l, depth_r)


@kernel
def _column_face(gravity, still_l, area_l, speed_l, pressure_l, width_l, still_r, area_r, speed_r, pressure_r, width_r):
    """Momentum flux (m^4/s^2) and fastest signal (m/s) where a column at rest reflects an open surface; 0 inside it."""
    momentum = signal = 0.0
    if still_l == 0.0:
        _, momentum, signal = _hll(gravity, area_l, speed_l, pressure_l, width_l, area_l, -speed_l, pressure_l, width_l)
    elif still_r == 0.0:
        _, momentum, signal = _hll(gravity, area_r, -speed_r, pressure_r, width_r, area_r, speed_r, pressure_r, width_r)
    return momentum, signal


@kernel
def _push_walls(liquid, depth, still, momentum, push):
    """Add what the end walls bear to `push` (2,); a column at rest bears on its wall by `column_push`."""
    table, last = liquid.table, liquid.cells - 1
    after, before = (1.0 - still[0]) * momentum[0], (1.0 - still[last]) * momentum[last + 1]
    push[0] += before - after
    push[1] += before * pressure_height(table, depth[last]) - after * pressure_height(table, depth[0])


@kernel
def fluxes(liquid, area, flow, depth, still, acceleration, work, mass, momentum, source, push):
    """Fluxes of mass and momentum through the faces (cells + 1,), and the momentum source (cells,) of the tilt.

    Cells marked in `still` (cells,) are columns at rest between a wall and the first open surface, which they reflect.
    `push` (2,) gets the force over density on all walls and baffles (m^4/s^2, forward) and its moment (m^5/s^2).
    Returns the fastest signal (m/s).

    `work` is (2, cells + 1) scratch. Cells run from the rear wall forward; the source balances the pressures of a still
    tilted liquid to rounding.
    """
    cells, table, gravity, spacing = liquid.cells, liquid.table, liquid.gravity, liquid.spacing
    at = liquid.baffles.at
    slope_depth, slope_speed, speeds = work[0], work[1], work[18]
    dry = DRY * table.area[table.area.size - 1]
    _slopes(liquid, area, flow, depth, speeds, still, acceleration, slope_depth, slope_speed)
    tilt = acceleration * spacing / gravity
    curves, starts, per_depth, slot = table.curves, table.depth_start, table.per_depth, table.slot_width
    last = table.depth.size - 1
    top, full, pressed = table.depth[last], table.area[last], table.pressure[last]
    depth_b = area_b = speed_b = pressure_b = 0.0
    width_b = 1.0
    fastest = 1e-9
    push[0] = push[1] = 0.0
    for i in range(cells):
        wet = area[i] > dry
        below = max(depth[i] - 0.5 * slope_depth[i], 0.0) if wet else 0.0
        above = max(depth[i] + 0.5 * slope_depth[i], 0.0) if wet else 0.0
        area_l, pressure_l, width_l = section_in(curves, starts, per_depth, top, full, pressed, slot, below)
        area_r, pressure_r, width_r = section_in(curves, starts, per_depth, top, full, pressed, slot, above)
        speed_l = speeds[i] - 0.5 * slope_speed[i]
        speed_r = speeds[i] + 0.5 * slope_speed[i]
        jump = 0.0
        if i == 0:  # the wall mirrors the state
            area_b, speed_b, pressure_b, width_b = area_l, -speed_l, pressure_l, width_l
        if i > 0 and still[i - 1] + still[i] > 0.0 and at[i] != CLOSED:
            mass[i] = 0.0
            momentum[i], signal = _column_face(
                gravity,
                still[i - 1],
                area_b,
                speed_b,
                pressure_b,
                width_b,
                still[i],
                area_l,
                speed_l,
                pressure_l,
                width_l,
            )
        elif at[i] != 0:
            mass[i], before, after, signal = _baffle(
                liquid,
                at[i],
                depth_b,
                area_b,
                speed_b,
                pressure_b,
                width_b,
                below,
                area_l,
                speed_l,
                pressure_l,
                width_l,
            )
            if still[i - 1] > 0.0:
                before = 0.0  # `column_push` adds what a column bears
            if still[i] > 0.0:
                after = 0.0
            momentum[i] = before
            jump = after - before
            push[0] -= jump
            push[1] += _turning(liquid, at[i], still, depth, i, depth_b, below, before, after)
        else:
            mass[i], momentum[i], signal = _hll(
                gravity, area_b, speed_b, pressure_b, width_b, area_l, speed_l, pressure_l, width_l
            )
        fastest = max(fastest, signal if i > 0 or still[0] == 0.0 else 0.0)
        surface_slope = slope_depth[i] + tilt
        mean_area = (area_l + 4.0 * area[i] + area_r) / 6.0 if surface_slope != 0.0 else 0.0
        source[i] = (gravity * (pressure_r - pressure_l - mean_area * surface_slope) + jump) / spacing
        depth_b, area_b, speed_b, pressure_b, width_b = above, area_r, speed_r, pressure_r, width_r
    _, momentum[cells], signal = _hll(
        gravity, area_b, speed_b, pressure_b, width_b, area_b, -speed_b, pressure_b, width_b
    )
    mass[0] = mass[cells] = 0.0
    _push_walls(liquid, depth, still, momentum, push)
    if liquid.disperses:
        disperse(liquid, area, flow, depth, still, dry, work[19:], mass, momentum, source, push)
    column_push(liquid, area, acceleration, momentum, still, push)
    return max(fastest, signal) if still[cells - 1] == 0.0 else fastest
