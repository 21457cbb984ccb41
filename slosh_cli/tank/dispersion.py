"""What shallow water leaves out: the motion across the section, by which a part of the liquid rides along at once.

Where the flow speeds up along the tank the surface sinks, and all below it with it. That motion has inertia: with the
mean speed u of a section and the energy `0.5 rho beta(A) s^2` per length, `s = u_x`, of what moves across it, it adds

    P = -beta (Du)_x + beta s^2 + 0.5 (A beta' - beta) s^2,    Du = u_t + u u_x,

to the pressure of the depth (over density, m^4/s^2), so that its power is what the energy loses. Shallow water says
what `A Du + P_x` is: a tridiagonal system for Du. In a rectangular section `beta = b h^3/3`, and these are the
equations of A. E. Green and P. M. Naghdi, J. Fluid Mech. 78 (1976) 237-246; `section_table` has beta of all sections
(theory section 10).

Where the surface rises or sinks faster than a third of its waves' speed, waves break (M. Kazolea, A. I. Delis and C. E.
Synolakis, J. Comput. Phys. 271 (2014) 281-305, on such criteria: 0.3 to 0.65), and beta fades to nothing. So that no
energy comes of that, what is stored is then `beta` times the integral of the part left over s, `0.5 s^2` being that
of the whole. Fronts that rise, are steep and carry liquid along are mixed by an eddy viscosity (A. B. Kennedy et al.,
J. Waterway, Port, Coastal, Ocean Eng. 126 (2000) 39-47).
"""

from __future__ import annotations

import math

from slosh_cli.compiled import kernel
from slosh_cli.tank.baffle import CLOSED
from slosh_cli.tank.section_table import across_at, section_at

_CALM, _BROKEN = 0.25, 0.35
"""The term fades from where the surface moves at the first part of the waves' speed to where it does at the second."""
_LEAST_FRONT, _FRONT = 0.05, 0.15
"""A front is mixed from the first part on of slope and of the waves' speed in rise and flow, wholly from the second."""
_MIXING = 1.5 * 1.5
"""Eddy viscosity of a front over depth and rate of rise: the square of the mixing length, 0.9 to 1.5 depths."""
_UNDER_THE_ROOF = 0.15
"""The term fades in this part of the section's height below the roof, which lets nothing rise."""
DISPERSION_ROWS = 10
"""Rows of scratch that `disperse` needs."""


@kernel
def _speed(area, flow, dry):
    return flow / area if area > dry else 0.0


@kernel
def _across(table, area, depth, dry):
    """Of one cell: beta and `A beta' - beta` (m^4), and A/B (m)."""
    last = table.depth.size - 1
    room = (1.0 - depth / table.depth[last]) / _UNDER_THE_ROOF
    if area <= dry or room <= 0.0:
        return 0.0, 0.0, 0.0
    beta, gain = across_at(table, depth)
    _, _, width = section_at(table, depth)
    if room >= 1.0:
        return beta, gain, area / width
    lost = beta * area / (_UNDER_THE_ROOF * table.depth[last] * width)
    return room * beta, room * gain - lost, area / width


@kernel
def _unbroken(gravity, mean_depth, change):
    """Part of beta that is left where the speed changes by `change` (1/s) along the tank, and `0.5 s^2` of the rest."""
    swift = abs(change) * math.sqrt(mean_depth / gravity)
    if swift <= _CALM:
        return 1.0, 0.5 * change * change
    end = min(swift, _BROKEN)
    stored = 0.5 * _BROKEN * (end * end - _CALM * _CALM) - (end**3 - _CALM**3) / 3.0
    stored = 0.5 * _CALM * _CALM + stored / (_BROKEN - _CALM)
    return (_BROKEN - end) / (_BROKEN - _CALM), stored * gravity / mean_depth


@kernel
def _pressure(gravity, beta, gain, mean_depth, change):
    """Of one cell's side of a face: the beta left (m^4) and the pressure without Du (m^4/s^2)."""
    if beta <= 0.0:
        return 0.0, 0.0
    left, stored = _unbroken(gravity, mean_depth, change)
    return left * beta, left * beta * change * change + gain * stored


@kernel
def _is_wall(liquid, still, face):
    """Whether nothing flows through a face: an end wall, a closed bulkhead or a column at rest."""
    if face in (0, liquid.cells) or liquid.baffles.at[face] == CLOSED:
        return True
    return still[face - 1] + still[face] > 0.0


@kernel
def _mixed(liquid, area, flow, depth, mean_depth, face):
    """Eddy viscosity times area (m^4/s) at a face, and how fast waves are there (m/s)."""
    deep, wetted = 0.5 * (mean_depth[face - 1] + mean_depth[face]), 0.5 * (area[face - 1] + area[face])
    wave = math.sqrt(liquid.gravity * deep)
    rise = (flow[face - 1] - flow[face]) / liquid.spacing * deep / wetted
    slope = abs(depth[face] - depth[face - 1]) / liquid.spacing
    carried = 0.5 * abs(flow[face] + flow[face - 1]) / wetted
    part = (min(rise / wave, slope, carried / wave) - _LEAST_FRONT) / (_FRONT - _LEAST_FRONT)
    return (_MIXING * min(part, 1.0) * rise * deep * wetted if part > 0.0 else 0.0), wave


@kernel
def _prepare(liquid, area, flow, depth, still, dry, rows):
    """Fill `rows` with the betas at the faces and the pressures there without Du."""
    cells, spacing, gravity = liquid.cells, liquid.spacing, liquid.gravity
    beta, gain, mean = rows[0], rows[1], rows[2]
    between, front_beta, rear_beta, front, rear = rows[3], rows[4], rows[5], rows[6], rows[7]
    for i in range(cells):
        beta[i], gain[i], mean[i] = _across(liquid.table, area[i], depth[i], dry)
    before = 0.0
    for i in range(cells):
        speed = _speed(area[i], flow[i], dry)
        if _is_wall(liquid, still, i):
            change = 2.0 * speed / spacing
            rear_beta[i], rear[i] = _pressure(gravity, beta[i], gain[i], mean[i], change)
        else:
            change, k = (speed - before) / spacing, i - 1
            one, push_one = _pressure(gravity, beta[i], gain[i], mean[i], change)
            other, push_other = _pressure(gravity, beta[k], gain[k], mean[k], change)
            between[i] = rear[i] = 0.0
            if mean[i] > 0.0 and mean[k] > 0.0:
                mixing, wave = _mixed(liquid, area, flow, depth, mean, i)
                # the stress follows Du within a step, as long as waves take for half a cell
                between[i] = 0.5 * (one + other + mixing * spacing / wave)
                rear[i] = 0.5 * (push_one + push_other) - mixing * change
            front[k] = rear[i]
        if _is_wall(liquid, still, i + 1):
            change = -2.0 * speed / spacing
            front_beta[i], front[i] = _pressure(gravity, beta[i], gain[i], mean[i], change)
        before = speed


@kernel
def _solve(liquid, area, still, dry, rows):
    """Du (m/s^2) of the cells from shallow water's `A Du`, both `rows[8]`, by Thomas' algorithm; `rows[9]` is scratch.

    The matrix is symmetric, and its diagonal rules. Columns at rest and dry cells have none.
    """
    cells, spacing = liquid.cells, liquid.spacing
    between, front_beta, rear_beta, front, rear, right, upper = (
        rows[3], rows[4], rows[5], rows[6], rows[7], rows[8], rows[9],
    )  # fmt: skip
    squared, lower, above = spacing * spacing, 0.0, 0.0
    for i in range(cells):
        value = right[i] - (front[i] - rear[i]) / spacing
        if still[i] > 0.0 or area[i] <= dry:
            value = 0.0
        below = lower
        diagonal = max(area[i], dry) - below
        if _is_wall(liquid, still, i):
            diagonal += 2.0 * rear_beta[i] / squared
        if _is_wall(liquid, still, i + 1):
            diagonal += 2.0 * front_beta[i] / squared
            lower = 0.0
        else:
            lower = -between[i + 1] / squared
            diagonal -= lower
        if i > 0:
            diagonal -= below * above
            value -= below * right[i - 1]
        above = lower / diagonal
        upper[i], right[i] = above, value / diagonal
    for i in range(cells - 2, -1, -1):
        right[i] -= upper[i] * right[i + 1]


@kernel
def _pull(liquid, area, flow, dry, mass, momentum, source, right):
    """Shallow water's `A Du` of the cells, into `right`: its change of flow without what the flow carries along."""
    cells, convected, speed = liquid.cells, 0.0, _speed(area[0], flow[0], dry)
    for i in range(cells):
        before, convected = convected, 0.0
        if i < cells - 1:
            ahead = _speed(area[i + 1], flow[i + 1], dry)
            convected = 0.5 * mass[i + 1] * (speed + ahead)
            speed = ahead
        right[i] = source[i] - (momentum[i + 1] - convected - momentum[i] + before) / liquid.spacing


@kernel
def disperse(liquid, area, flow, depth, still, dry, rows, mass, momentum, source, push):
    """Add the pressure of the motion across the section to the fluxes of shallow water.

    `momentum` (cells + 1,), `source` (cells,) and `push` (2,) are those of `fluxes`, which this changes; `rows`
    (DISPERSION_ROWS, cells + 1) is scratch. Du is nothing at walls, closed bulkheads and columns at rest.
    """
    cells, spacing = liquid.cells, liquid.spacing
    between, front_beta, rear_beta, front, rear, right = rows[3], rows[4], rows[5], rows[6], rows[7], rows[8]
    _prepare(liquid, area, flow, depth, still, dry, rows)
    _pull(liquid, area, flow, dry, mass, momentum, source, right)
    _solve(liquid, area, still, dry, rows)
    behind = 0.0
    for i in range(cells + 1):
        ahead = 0.0
        if not _is_wall(liquid, still, i):
            momentum[i] += rear[i] - between[i] * (right[i] - right[i - 1]) / spacing
        else:
            if i < cells and still[i] == 0.0:
                ahead = rear[i] - 2.0 * rear_beta[i] * right[i] / spacing
            if 0 < i < cells and liquid.baffles.at[i] != CLOSED:  # a column at rest bears it
                momentum[i] += behind + ahead
            else:
                momentum[i] += behind if i > 0 else ahead
                push[0] += behind - ahead
                if i > 0:
                    push[1] += behind * _height(liquid, depth[i - 1])
                if i < cells:
                    push[1] -= ahead * _height(liquid, depth[i])
                if 0 < i < cells:
                    source[i] += (ahead - behind) / spacing
        behind = 0.0
        if i < cells and still[i] == 0.0 and _is_wall(liquid, still, i + 1):
            behind = front[i] + 2.0 * front_beta[i] * right[i] / spacing


@kernel
def _height(liquid, depth):
    """Height (m) at which this pressure acts on a wall: that of a rectangular section, where it is a parabola."""
    return 0.375 * min(depth, liquid.table.roof)


@kernel
def motion_across(liquid, area, flow, depth, dry):
    """Energy (J) of the motion across the section, and the moment (N m s, nose-down) of its momentum."""
    cells, spacing, table, gravity = liquid.cells, liquid.spacing, liquid.table, liquid.gravity
    energy, moment, top = 0.0, 0.0, table.depth[table.depth.size - 1]
    for i in range(cells):
        beta, _, mean = _across(table, area[i], depth[i], dry)
        if beta <= 0.0:
            continue
        speed = _speed(area[i], flow[i], dry)
        _, sinking, _ = section_at(table, depth[i])
        sinking *= min((1.0 - depth[i] / top) / _UNDER_THE_ROOF, 1.0)
        for side in (-1, 1):  # half of it at each of the cell's faces
            face = i if side < 0 else i + 1
            if face in (0, cells) or liquid.baffles.at[face] == CLOSED:
                change = -side * 2.0 * speed / spacing
            else:
                change = side * (_speed(area[i + side], flow[i + side], dry) - speed) / spacing
            left, stored = _unbroken(gravity, mean, change)
            energy += 0.5 * beta * stored
            moment -= 0.5 * left * sinking * change * (face - 0.5 * cells) * spacing
    return liquid.density * spacing * energy, liquid.density * spacing * moment
