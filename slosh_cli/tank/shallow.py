"""Shallow-water liquid with a roof and a bottom: Saint-Venant's equations in the tank's frame (theory section 10).

    A_t + Q_x = 0,    Q_t + (Q^2/A + g I1(A))_x = -A a,    a = u_B'' + z_c theta'' - g theta

Finite volumes with the fluxes of `shallow_flux`; Heun's method in time. Both walls reflect.
"""

from __future__ import annotations

import math

from slosh_cli.blocks import Block
from slosh_cli.compiled import kernel
from slosh_cli.tank.baffle import Baffles
from slosh_cli.tank.dispersion import DISPERSION_ROWS, motion_across
from slosh_cli.tank.roof import stand_still, stop_columns
from slosh_cli.tank.section_table import SectionTable, depth_of, potential_at, stored_level
from slosh_cli.tank.shallow_flux import DRY, fluxes

_COURANT = 0.45
"""A step carries no wave further than this part of a cell."""
_MOST_COURANT = 0.5
"""A step during which the waves grow faster than that, as where a cell runs full, is taken again, shorter."""
_SHORTEST_STEP = 1e-7
"""Steps (s) do not go below this."""
WORK_ROWS = 19 + DISPERSION_ROWS
"""Rows of scratch that `liquid_evolve` needs, each one longer than the cells."""
_FILM = 1e-4
"""In a film of less than this part of the full section's area the speed fades with the area, so that flow over area
stays bounded: A. Kurganov and G. Petrova, Comm. Math. Sci. 5 (2007) 133-160, equation 2.17."""


class ShallowLiquid(Block):
    """Constants of the liquid in a tank cut into `cells` of `spacing` (m).

    `density` kg/m^3 times the share of the tank that is modelled, `gravity` m/s^2, `centre_height` m of the still
    liquid above the bottom, `mass` kg, `still_depth` m; `baffles` are the walls between cells. `columns`: whether cells
    that run full up to a wall stand still (`roof`). `disperses`: whether the motion across the section counts
    (`dispersion`), and `riding` kg is then what rides along at once with the tank of the still liquid.
    """

    cells: int
    spacing: float
    density: float
    gravity: float
    centre_height: float
    mass: float
    still_depth: float
    baffles: Baffles
    table: SectionTable
    columns: int
    disperses: int
    riding: float


@kernel
def liquid_depths(liquid, area, depth):
    """Depths (cells,) m of the wetted areas (cells,) m^2, into `depth`."""
    table = liquid.table
    for i in range(liquid.cells):
        depth[i] = depth_of(table, area[i])


@kernel
def _keep_wet(liquid, area, mass, step, kept):
    """Scale the fluxes out of a cell, into `kept`, so that it cannot lose more than it holds; mass stays conserved."""
    cells, spacing = liquid.cells, liquid.spacing
    for i in range(cells + 1):
        kept[i] = mass[i]
    for i in range(cells):
        outflow = step * (max(kept[i + 1], 0.0) - min(kept[i], 0.0))
        held = area[i] * spacing
        if outflow > held:
            share = held / outflow
            if kept[i + 1] > 0.0:
                kept[i + 1] *= share
            if kept[i] < 0.0:
                kept[i] *= share


@kernel
def _calm_films(liquid, area, flow, share):
    """Bound the speed of thin films; thicker cells are left as they are.

    `share` is the step over the longest one, so that what is taken is a matter of time, not of the number of steps.
    """
    film = _FILM * liquid.table.area[liquid.table.area.size - 1]
    for i in range(liquid.cells):
        if area[i] < film:
            flow[i] *= (2.0 * area[i] * area[i] / (area[i] * area[i] + film * film)) ** share


@kernel
def _euler(liquid, area, flow, still, mass, momentum, source, step, share, kept, area_end, flow_end):
    """An explicit Euler step (s) of areas and flows under given fluxes; `kept` (cells + 1,) is scratch.

    Cells of a full column, marked in `still`, neither gain nor lose.
    """
    spacing = liquid.spacing
    _keep_wet(liquid, area, mass, step, kept)
    for i in range(liquid.cells):
        area_end[i] = max(area[i] - step * (kept[i + 1] - kept[i]) / spacing, 0.0)
        change = source[i] - (momentum[i + 1] - momentum[i]) / spacing
        flow_end[i] = flow[i] + step * change if still[i] == 0.0 else flow[i]
    _calm_films(liquid, area_end, flow_end, share)


@kernel
def _add_impulses(liquid, area, flow, push, acceleration, duration, sums):
    """Add to `sums` (4,) the impulses of push and moment, and the work, of `duration` (s) in a state.

    The moment (about the bottom centre, nose-down) is that of the weight's distribution and of the walls' pressures.
    """
    arm, carried, cells = 0.0, 0.0, liquid.cells
    for i in range(cells):
        arm += area[i] * (i + 0.5 - 0.5 * cells)
        carried += flow[i]
    weight = duration * liquid.density
    sums[0] += weight * push[0]
    sums[1] += weight * (push[1] + liquid.gravity * liquid.spacing * liquid.spacing * arm)
    sums[2] -= weight * liquid.spacing * acceleration * carried


@kernel
def _stop(liquid, stopped, sums):
    """Add to `sums` the impulses on the tank of a flow (m^3/s, summed over cells) that came to rest in full cells."""
    impulse = liquid.density * liquid.spacing * stopped
    last = liquid.table.depth.size - 1
    sums[0] += impulse
    sums[1] += impulse * liquid.table.first[last] / liquid.table.area[last]


@kernel
def _longest_step(liquid, speed, acceleration, courant):
    """Step (s) in which a wave of `speed` (m/s), sped up by the acceleration, runs through `courant` cells."""
    reach = courant * liquid.spacing
    return 2.0 * reach / (speed + math.sqrt(speed * speed + 4.0 * abs(acceleration) * reach))


@kernel
def _lifted(liquid, area, flow, depth):
    """Moment (N m s, nose-down about the bottom centre) of the momentum across the section."""
    if not liquid.disperses:
        return 0.0
    return motion_across(liquid, area, flow, depth, DRY * liquid.table.full_area)[1]


@kernel
def liquid_evolve(liquid, area, flow, depth, acceleration, duration, work, sums):
    """Carry the liquid through `duration` (s) of constant effective `acceleration` (m/s^2) of the tank.

    `area`, `flow`, `depth` (cells,) are updated in place; `work` is (WORK_ROWS, cells + 1). To `sums` (4,) are added
    the impulse of walls and baffles on the tank (N s, forward), that of the moment (N m s), the work (J) done on the
    liquid in the tank's frame and the number of steps. Returns False when the liquid's speed is no longer finite.
    """
    mass, momentum, source, push = work[2], work[3], work[4], work[5]
    mass_2, momentum_2, source_2, push_2 = work[6], work[7], work[8], work[9]
    area_1, flow_1, depth_1, area_2, flow_2, kept = work[10], work[11], work[12], work[13], work[14], work[15]
    still, still_1 = work[16], work[17]
    for i in range(liquid.cells):
        if depth[i] >= liquid.table.depth[liquid.table.depth.size - 1]:  # it may be a column's, under another tilt
            depth[i] = depth_of(liquid.table, area[i])
    stand_still(liquid, area, depth, acceleration, still)
    sums[1] -= _lifted(liquid, area, flow, depth)
    remaining = duration
    while remaining > 0.0:
        speed = fluxes(liquid, area, flow, depth, still, acceleration, work, mass, momentum, source, push)
        limit = _longest_step(liquid, speed, acceleration, _COURANT)
        while True:
            if not limit > _SHORTEST_STEP:
                return False
            step = remaining / math.ceil(remaining / limit)
            share = step / limit
            _euler(liquid, area, flow, still, mass, momentum, source, step, share, kept, area_1, flow_1)
            liquid_depths(liquid, area_1, depth_1)
            stand_still(liquid, area_1, depth_1, acceleration, still_1)
            speed = fluxes(
                liquid, area_1, flow_1, depth_1, still_1, acceleration, work, mass_2, momentum_2, source_2, push_2
            )
            longest = _longest_step(liquid, speed, acceleration, _MOST_COURANT)
            if step <= longest:
                break
            limit = min(longest, 0.9 * step)
        _euler(liquid, area_1, flow_1, still_1, mass_2, momentum_2, source_2, step, share, kept, area_2, flow_2)
        _add_impulses(liquid, area, flow, push, acceleration, 0.5 * step, sums)
        _add_impulses(liquid, area_1, flow_1, push_2, acceleration, 0.5 * step, sums)
        for i in range(liquid.cells):
            area[i] = 0.5 * (area[i] + area_2[i])
            flow[i] = 0.5 * (flow[i] + flow_2[i])
        _calm_films(liquid, area, flow, share)
        liquid_depths(liquid, area, depth)
        if stand_still(liquid, area, depth, acceleration, still):
            _stop(liquid, stop_columns(liquid, flow, still, step), sums)
        sums[3] += 1.0
        remaining = remaining - step if remaining - step > 1e-12 * duration else 0.0
    sums[1] += _lifted(liquid, area, flow, depth)
    return True


@kernel
def liquid_energy_in_tank(liquid, area, flow, depth):
    """Kinetic energy of the motion relative to the tank and potential energy above the bottom, J."""
    kinetic = potential = 0.0
    for i in range(liquid.cells):
        if area[i] > 0.0:
            kinetic += 0.5 * flow[i] * flow[i] / area[i]
        potential += liquid.gravity * potential_at(liquid.table, stored_level(liquid.table, area[i], depth[i]))
    across = 0.0
    if liquid.disperses:
        across, _ = motion_across(liquid, area, flow, depth, DRY * liquid.table.full_area)
    return across + liquid.density * liquid.spacing * kinetic, liquid.density * liquid.spacing * potential
