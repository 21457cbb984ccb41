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
from slosh_cli.tank.section_table import SectionTable

Array = NDArray[np.float64]

COURANT = 0.45
"""A step carries no wave further than this part of a cell."""
LIMITER = 1.5
"""Between 1 (minmod) and 2: how steep a reconstructed slope may be beside its neighbours."""
DRY = 1e-7
"""A cell with less than this part of the full section's area holds still."""
FILM = 1e-5
"""In a film of less than this part of the full section's area the speed fades with the area, so that flow over area
stays bounded: A. Kurganov and G. Petrova, Comm. Math. Sci. 5 (2007) 133-160, equation 2.17."""


class ShallowLiquid(NamedTuple):
    """Constants of the liquid in a tank cut into `cells` of `spacing` (m); no cells: the liquid is absent.

    `density` kg/m^3 times the share of the tank that is modelled, `gravity` m/s^2, `centre_height` m of the still
    liquid above the bottom, `mass` kg, `still_depth` m.
    """

    cells: int
    spacing: float
    density: float
    gravity: float
    centre_height: float
    mass: float
    still_depth: float
    table: SectionTable


@kernel
def depth_of(table, area):
    """Depth (m) of a wetted area (m^2): the table's cubic, inverted by Newton's method; above it the slot."""
    last = table.depth.size - 1
    if area >= table.area[last]:
        return table.depth[last] + (area - table.area[last]) / table.slot_width
    if area <= 0.0:
        return 0.0
    low, high = 0, last
    while high - low > 1:
        middle = (low + high) // 2
        if table.area[middle] <= area:
            low = middle
        else:
            high = middle
    depth = table.depth[low] + (table.depth[high] - table.depth[low]) * (area - table.area[low]) / (
        table.area[high] - table.area[low]
    )
    left, right = table.depth[low], table.depth[high]
    for _ in range(20):
        value, slope = _cubic(table.depth, table.area, table.width, low, depth)
        change = (area - value) / slope if slope > 0.0 else 0.0
        following = min(max(depth + change, left), right)
        change = following - depth
        depth = following
        if abs(change) <= 1e-15 * right:
            break
    return depth


@kernel
def _cubic(places, values, slopes, k, place):
    """Cubic through two neighbouring nodes with given slopes; its value and slope."""
    span = places[k + 1] - places[k]
    part = (place - places[k]) / span
    rest = 1.0 - part
    value = (
        rest * rest * (1.0 + 2.0 * part) * values[k]
        + part * part * (3.0 - 2.0 * part) * values[k + 1]
        + span * part * rest * (rest * slopes[k] - part * slopes[k + 1])
    )
    slope = (
        6.0 * part * rest * (values[k + 1] - values[k]) / span
        + rest * (1.0 - 3.0 * part) * slopes[k]
        + part * (3.0 * part - 2.0) * slopes[k + 1]
    )
    return value, slope


@kernel
def _place(table, depth):
    low, high = 0, table.depth.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if table.depth[middle] <= depth:
            low = middle
        else:
            high = middle
    return low


@kernel
def section_at(table, depth):
    """Area (m^2), moment I1 (m^3) and surface width (m) at a depth (m)."""
    last = table.depth.size - 1
    if depth >= table.depth[last]:
        head = depth - table.depth[last]
        area = table.area[last] + table.slot_width * head
        return area, table.pressure[last] + head * (table.area[last] + 0.5 * table.slot_width * head), table.slot_width
    if depth <= 0.0:
        return 0.0, 0.0, 1.0
    k = _place(table, depth)
    area, width = _cubic(table.depth, table.area, table.width, k, depth)
    pressure, _ = _cubic(table.depth, table.pressure, table.area, k, depth)
    return area, pressure, max(width, 1e-12)


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
    k = _place(table, depth)
    area, _ = _cubic(table.depth, table.area, table.width, k, depth)
    pressure, _ = _cubic(table.depth, table.pressure, table.area, k, depth)
    span = table.depth[k + 1] - table.depth[k]
    part = (depth - table.depth[k]) / span
    arm = table.pressure_arm[k] + part * (table.pressure_arm[k + 1] - table.pressure_arm[k])
    return min(arm / pressure, depth) if pressure > 0.0 and area > 0.0 else 0.0


@kernel
def _limited(before, after):
    """Generalised minmod slope between two differences."""
    if before * after <= 0.0:
        return 0.0
    size = min(LIMITER * abs(before), LIMITER * abs(after), 0.5 * abs(before + after))
    return size if before > 0.0 else -size


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
    """Depths (cells,) m of the wetted areas (cells,) m^2; returns the largest wave speed over the still liquid."""
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
        slope_depth[i] = (_limited(surface_b, surface_a) if wet else 0.0) - tilt
        slope_speed[i] = _limited(speed_b, speed_a) if wet else 0.0


@kernel
def _fluxes(liquid, area, flow, depth, acceleration, work, mass, momentum, source):
    """Fluxes of mass and momentum through the faces (cells + 1,), and the momentum source (cells,) of the tilt.

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
        if i == 0:  # the wall mirrors the state
            area_b, flow_b, pressure_b, width_b = area_l, -flow_l, pressure_l, width_l
        mass[i], momentum[i] = _hll(gravity, area_b, flow_b, pressure_b, width_b, area_l, flow_l, pressure_l, width_l)
        surface_slope = slope_depth[i] + tilt
        mean_area = (area_l + 4.0 * area[i] + area_r) / 6.0 if surface_slope != 0.0 else 0.0
        source[i] = gravity * (pressure_r - pressure_l - mean_area * surface_slope) / liquid.spacing
        area_b, flow_b, pressure_b, width_b = area_r, flow_r, pressure_r, width_r
    _, momentum[cells] = _hll(gravity, area_b, flow_b, pressure_b, width_b, area_b, -flow_b, pressure_b, width_b)
    mass[0] = mass[cells] = 0.0


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
def _euler(liquid, area, flow, depth, acceleration, step, work, area_end, flow_end):
    """An explicit Euler step (s) of areas and flows; returns the force over density on rear and front wall."""
    mass, momentum, source = work[2], work[3], work[4]
    _fluxes(liquid, area, flow, depth, acceleration, work, mass, momentum, source)
    _keep_wet(liquid, area, mass, step)
    for i in range(liquid.cells):
        area_end[i] = max(area[i] - step * (mass[i + 1] - mass[i]) / liquid.spacing, 0.0)
        flow_end[i] = flow[i] + step * (source[i] - (momentum[i + 1] - momentum[i]) / liquid.spacing)
    _calm_films(liquid, area_end, flow_end)
    return momentum[0], momentum[liquid.cells]


@kernel
def _moment(liquid, area, depth, rear, front):
    """Moment (N m) about the bottom centre, nose-down: weight distribution and end-wall pressures."""
    weight = 0.0
    for i in range(liquid.cells):
        weight += area[i] * (i + 0.5 - 0.5 * liquid.cells)
    weight *= liquid.gravity * liquid.spacing * liquid.spacing
    arm = front * pressure_height(liquid.table, depth[liquid.cells - 1])
    return liquid.density * (weight + arm - rear * pressure_height(liquid.table, depth[0]))


@kernel
def liquid_evolve(liquid, area, flow, depth, acceleration, duration, work, sums):
    """Carry the liquid through `duration` (s) of constant effective `acceleration` (m/s^2) of the tank.

    `area`, `flow`, `depth` (cells,) are updated in place; `work` is (10, cells + 1). To `sums` (4,) are added the
    impulse of the end walls on the tank (N s, forward), that of the moment (N m s), the work (J) done on the liquid in
    the tank's frame and the number of steps. Returns False when the liquid's speed is no longer finite.
    """
    cells = liquid.cells
    first_area, first_flow, first_depth = work[5], work[6], work[7]
    second_area, second_flow = work[8], work[9]
    remaining = duration
    while remaining > 0.0:
        limit = COURANT * liquid.spacing / largest_speed(liquid, area, flow, depth)
        if not limit > 1e-7:
            return False
        step = remaining / math.ceil(remaining / limit)
        rear, front = _euler(liquid, area, flow, depth, acceleration, step, work, first_area, first_flow)
        push = front - rear
        moment = _moment(liquid, area, depth, rear, front)
        liquid_depths(liquid, first_area, first_depth)
        rear, front = _euler(
            liquid, first_area, first_flow, first_depth, acceleration, step, work, second_area, second_flow
        )
        push += front - rear
        moment += _moment(liquid, first_area, first_depth, rear, front)
        carried = 0.0
        for i in range(cells):
            carried += flow[i] + first_flow[i]
            area[i] = 0.5 * (area[i] + second_area[i])
            flow[i] = 0.5 * (flow[i] + second_flow[i])
        _calm_films(liquid, area, flow)
        liquid_depths(liquid, area, depth)
        sums[0] += 0.5 * step * liquid.density * push
        sums[1] += 0.5 * step * moment
        sums[2] -= 0.5 * step * liquid.density * liquid.spacing * acceleration * carried
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
