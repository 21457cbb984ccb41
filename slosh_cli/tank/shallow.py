"""Shallow-water liquid with a roof and a bottom: Saint-Venant's equations in the tank's frame (model section 10).

    A_t + Q_x = 0,    Q_t + (Q^2/A + g I1(A))_x = -A a,    a = u_B'' + z_c theta'' - g theta

Finite volumes: HLL fluxes (A. Harten, P. D. Lax and B. van Leer, SIAM Review 25 (1983) 35-61) of states reconstructed
from the surface relative to the still tilted one, so that a still liquid stays still (E. Audusse et al., SIAM J. Sci.
Comput. 25 (2004) 2050-2065); limited slopes; Heun's method in time. Both walls reflect.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slosh_cli.compiled import kernel
from slosh_cli.tank.section_table import SectionTable, depth_of, potential_at, pressure_height, section_at

Array = NDArray[np.float64]

COURANT = 0.45
"""A step carries no wave further than this part of a cell."""
WORK_ROWS = 11
"""Rows of scratch that `liquid_evolve` needs, each one longer than the cells."""
DRY = 1e-7
"""A cell with less than this part of the full section's area holds still."""
FILM = 1e-4
"""In a film of less than this part of the full section's area the speed fades with the area, so that flow over area
stays bounded: A. Kurganov and G. Petrova, Comm. Math. Sci. 5 (2007) 133-160, equation 2.17."""


class ShallowLiquid(NamedTuple):
    """Constants of the liquid in a tank cut into `cells` of `spacing` (m); no cells: the liquid is absent.

    `density` kg/m^3 times the share of the tank that is modelled, `gravity` m/s^2, `centre_height` m of the still
    liquid above the bottom, `mass` kg, `still_depth` m; `loss` (cells + 1,) is the loss coefficient of a baffle at a
    face, zero where there is none.
    """

    cells: int
    spacing: float
    density: float
    gravity: float
    centre_height: float
    mass: float
    still_depth: float
    loss: Array
    table: SectionTable


@kernel
def _limited(before, after):
    """Minmod slope between two differences: the most cautious of the limiters, steady at bores and at the roof."""
    if before * after <= 0.0:
        return 0.0
    return before if abs(before) < abs(after) else after


@kernel
def _hll(gravity, area_l, flow_l, pressure_l, width_l, area_r, flow_r, pressure_r, width_r):
    """HLL flux of mass (m^3/s) and momentum (m^4/s^2) between two states."""
    speed_l = flow_l / area_l if area_l > 0.0 else 0.0
    speed_r = flow_r / area_r if area_r > 0.0 else 0.0
    wave_l = math.sqrt(gravity * area_l / width_l)
    wave_r = math.sqrt(gravity * area_r / width_r)
    if area_l <= 0.0:
        speed_l, wave_l = speed_r - 2.0 * wave_r, 0.0
    if area_r <= 0.0:
        speed_r, wave_r = speed_l + 2.0 * wave_l, 0.0
    left = min(speed_l - wave_l, speed_r - wave_r)
    right = max(speed_l + wave_l, speed_r + wave_r)
    momentum_l = flow_l * (flow_l / area_l if area_l > 0.0 else 0.0) + gravity * pressure_l
    momentum_r = flow_r * (flow_r / area_r if area_r > 0.0 else 0.0) + gravity * pressure_r
    if left >= 0.0:
        return flow_l, momentum_l
    if right <= 0.0:
        return flow_r, momentum_r
    span = right - left
    mass = (right * flow_l - left * flow_r + left * right * (area_r - area_l)) / span
    momentum = (right * momentum_l - left * momentum_r + left * right * (flow_r - flow_l)) / span
    return mass, momentum


@kernel
def liquid_depths(liquid, area, depth):
    """Depths (cells,) m of the wetted areas (cells,) m^2, into `depth`."""
    for i in range(liquid.cells):
        depth[i] = depth_of(liquid.table, area[i])


@kernel
def largest_speed(liquid, area, flow, depth):
    """Fastest signal (m/s) in the liquid."""
    fastest = 1e-9
    dry = DRY * liquid.table.area[liquid.table.area.size - 1]
    for i in range(liquid.cells):
        if area[i] > dry:
            _, _, width = section_at(liquid.table, depth[i])
            fastest = max(fastest, abs(flow[i]) / area[i] + math.sqrt(liquid.gravity * area[i] / width))
    return fastest


@kernel
def _slopes(liquid, area, flow, depth, acceleration, slope_depth, slope_speed):
    """Limited changes over a cell of depth (m, the still tilt included) and speed (m/s)."""
    cells = liquid.cells
    tilt = acceleration * liquid.spacing / liquid.gravity
    dry = DRY * liquid.table.area[liquid.table.area.size - 1]
    for i in range(cells):
        speed = flow[i] / area[i] if area[i] > dry else 0.0
        surface_b = surface_a = 0.0
        speed_b, speed_a = 2.0 * speed, -2.0 * speed
        wet = area[i] > dry
        if i > 0:
            wet = wet and area[i - 1] > dry
            surface_b = depth[i] - depth[i - 1] + tilt
            speed_b = speed - (flow[i - 1] / area[i - 1] if area[i - 1] > dry else 0.0)
        if i < cells - 1:
            wet = wet and area[i + 1] > dry
            surface_a = depth[i + 1] - depth[i] + tilt
            speed_a = (flow[i + 1] / area[i + 1] if area[i + 1] > dry else 0.0) - speed
        slope = (_limited(surface_b, surface_a) if wet else 0.0) - tilt
        slope_depth[i] = min(max(slope, -2.0 * depth[i]), 2.0 * depth[i])  # neither end of a cell lies below the bed
        slope_speed[i] = _limited(speed_b, speed_a) if wet else 0.0


@kernel
def _baffle(gravity, loss, area_l, flow_l, pressure_l, width_l, area_r, flow_r, pressure_r, width_r):
    """Flow (m^3/s) through a baffle and the momentum fluxes (m^4/s^2) on its rear and front side.

    Each side starts from the flux on a closed wall, which the flow m relieves by the wave speed times m; what is left
    across the baffle is the loss `0.5 loss m |m| / A` of the narrower side.
    """
    _, wall_l = _hll(gravity, area_l, flow_l, pressure_l, width_l, area_l, -flow_l, pressure_l, width_l)
    _, wall_r = _hll(gravity, area_r, -flow_r, pressure_r, width_r, area_r, flow_r, pressure_r, width_r)
    narrow = min(area_l, area_r)
    if narrow <= 0.0:
        return 0.0, wall_l, wall_r
    wave_l = math.sqrt(gravity * area_l / width_l)
    wave_r = math.sqrt(gravity * area_r / width_r)
    linear, square, drive = wave_l + wave_r, 0.5 * loss / narrow, wall_l - wall_r
    flow = 2.0 * drive / (linear + math.sqrt(linear * linear + 4.0 * square * abs(drive)))
    return flow, wall_l - wave_l * flow, wall_r + wave_r * flow


@kernel
def _fluxes(liquid, area, flow, depth, acceleration, work, mass, momentum, source, push):
    """Fluxes of mass and momentum through the faces (cells + 1,), and the momentum source (cells,) of the tilt.

    `push` (2,) gets the force over density on all walls and baffles (m^4/s^2, forward) and its moment (m^5/s^2).

    `work` is (2, cells + 1) scratch. Cells run from the rear wall forward; the source balances the pressures of a still
    tilted liquid to rounding.
    """
    cells, table, gravity = liquid.cells, liquid.table, liquid.gravity
    slope_depth, slope_speed = work[0], work[1]
    _slopes(liquid, area, flow, depth, acceleration, slope_depth, slope_speed)
    dry = DRY * table.area[table.area.size - 1]
    tilt = acceleration * liquid.spacing / gravity
    area_b = flow_b = pressure_b = 0.0
    width_b = 1.0
    for i in range(cells):
        wet = area[i] > dry
        speed = flow[i] / area[i] if wet else 0.0
        below = max(depth[i] - 0.5 * slope_depth[i], 0.0) if wet else 0.0
        above = max(depth[i] + 0.5 * slope_depth[i], 0.0) if wet else 0.0
        area_l, pressure_l, width_l = section_at(table, below)
        area_r, pressure_r, width_r = section_at(table, above)
        flow_l = area_l * (speed - 0.5 * slope_speed[i])
        flow_r = area_r * (speed + 0.5 * slope_speed[i])
        jump = 0.0
        if i == 0:  # the wall mirrors the state
            area_b, flow_b, pressure_b, width_b = area_l, -flow_l, pressure_l, width_l
        if liquid.loss[i] > 0.0:
            mass[i], before, after = _baffle(
                gravity, liquid.loss[i], area_b, flow_b, pressure_b, width_b, area_l, flow_l, pressure_l, width_l
            )
            momentum[i] = before
            jump = after - before
            push[0] -= jump
            push[1] += before * pressure_height(table, depth[i - 1]) - after * pressure_height(table, depth[i])
        else:
            mass[i], momentum[i] = _hll(
                gravity, area_b, flow_b, pressure_b, width_b, area_l, flow_l, pressure_l, width_l
            )
        surface_slope = slope_depth[i] + tilt
        mean_area = (area_l + 4.0 * area[i] + area_r) / 6.0 if surface_slope != 0.0 else 0.0
        source[i] = (gravity * (pressure_r - pressure_l - mean_area * surface_slope) + jump) / liquid.spacing
        area_b, flow_b, pressure_b, width_b = area_r, flow_r, pressure_r, width_r
    _, momentum[cells] = _hll(gravity, area_b, flow_b, pressure_b, width_b, area_b, -flow_b, pressure_b, width_b)
    mass[0] = mass[cells] = 0.0
    push[0] += momentum[cells] - momentum[0]
    push[1] += momentum[cells] * pressure_height(table, depth[cells - 1]) - momentum[0] * pressure_height(
        table, depth[0]
    )


@kernel
def _keep_wet(liquid, area, mass, step):
    """Scale the fluxes out of a cell so that it cannot lose more than it holds; mass stays conserved."""
    for i in range(liquid.cells):
        outflow = step * (max(mass[i + 1], 0.0) - min(mass[i], 0.0))
        held = area[i] * liquid.spacing
        if outflow > held:
            share = held / outflow
            if mass[i + 1] > 0.0:
                mass[i + 1] *= share
            if mass[i] < 0.0:
                mass[i] *= share


@kernel
def _calm_films(liquid, area, flow):
    """Bound the speed of thin films; thicker cells are left as they are."""
    film = FILM * liquid.table.area[liquid.table.area.size - 1]
    for i in range(liquid.cells):
        if area[i] < film:
            flow[i] *= 2.0 * area[i] * area[i] / (area[i] * area[i] + film * film)


@kernel
def _euler(liquid, area, flow, depth, acceleration, step, work, area_end, flow_end, sums):
    """An explicit Euler step (s) of areas and flows; to `sums` (4,) go half of its push, moment and work.

    The moment (about the bottom centre, nose-down) is that of the weight's distribution and of the walls' pressures.
    """
    mass, momentum, source, push = work[2], work[3], work[4], work[10]
    push[0] = push[1] = 0.0
    _fluxes(liquid, area, flow, depth, acceleration, work, mass, momentum, source, push)
    _keep_wet(liquid, area, mass, step)
    arm = carried = 0.0
    for i in range(liquid.cells):
        arm += area[i] * (i + 0.5 - 0.5 * liquid.cells)
        carried += flow[i]
        area_end[i] = max(area[i] - step * (mass[i + 1] - mass[i]) / liquid.spacing, 0.0)
        flow_end[i] = flow[i] + step * (source[i] - (momentum[i + 1] - momentum[i]) / liquid.spacing)
    _calm_films(liquid, area_end, flow_end)
    half = 0.5 * step * liquid.density
    sums[0] += half * push[0]
    sums[1] += half * (push[1] + liquid.gravity * liquid.spacing * liquid.spacing * arm)
    sums[2] -= half * liquid.spacing * acceleration * carried


@kernel
def liquid_evolve(liquid, area, flow, depth, acceleration, duration, work, sums):
    """Carry the liquid through `duration` (s) of constant effective `acceleration` (m/s^2) of the tank.

    `area`, `flow`, `depth` (cells,) are updated in place; `work` is (WORK_ROWS, cells + 1). To `sums` (4,) are added
    the impulse of walls and baffles on the tank (N s, forward), that of the moment (N m s), the work (J) done on the
    liquid in the tank's frame and the number of steps. Returns False when the liquid's speed is no longer finite.
    """
    cells = liquid.cells
    first_area, first_flow, first_depth = work[5], work[6], work[7]
    second_area, second_flow = work[8], work[9]
    remaining = duration
    while remaining > 0.0:
        reach, speed = COURANT * liquid.spacing, largest_speed(liquid, area, flow, depth)
        limit = 2.0 * reach / (speed + math.sqrt(speed * speed + 4.0 * abs(acceleration) * reach))
        if not limit > 1e-7:
            return False
        step = remaining / math.ceil(remaining / limit)
        _euler(liquid, area, flow, depth, acceleration, step, work, first_area, first_flow, sums)
        liquid_depths(liquid, first_area, first_depth)
        _euler(liquid, first_area, first_flow, first_depth, acceleration, step, work, second_area, second_flow, sums)
        for i in range(cells):
            area[i] = 0.5 * (area[i] + second_area[i])
            flow[i] = 0.5 * (flow[i] + second_flow[i])
        _calm_films(liquid, area, flow)
        liquid_depths(liquid, area, depth)
        sums[3] += 1.0
        remaining = remaining - step if remaining - step > 1e-12 * duration else 0.0
    return True


@kernel
def liquid_energy_in_tank(liquid, area, flow, depth):
    """Kinetic energy of the motion relative to the tank and potential energy above the bottom, J."""
    kinetic = potential = 0.0
    for i in range(liquid.cells):
        if area[i] > 0.0:
            kinetic += 0.5 * flow[i] * flow[i] / area[i]
        potential += liquid.gravity * potential_at(liquid.table, depth[i])
    return liquid.density * liquid.spacing * kinetic, liquid.density * liquid.spacing * potential
