"""Verdicts on the degree of filling: what the law for dangerous goods allows a shell on the road (ADR 4.3.2.2)."""

from __future__ import annotations

from itertools import pairwise

from slosh_cli.results.validity import Check
from slosh_cli.scenario import Tank
from slosh_cli.scenario.schema_limits import Limits
from slosh_cli.section import liquid_depth, section_of
from slosh_cli.tank.still import open_share

_ROUNDING = 1e-6
"""Parts of a limit that a filling may miss by: amounts are written with few digits, and the fill follows from them."""
_CLASSES = (1.0, 0.98, 0.97, 0.95)
"""Shares of the capacity that ADR 4.3.2.2.1 a to d allow at 50 degC."""
_LAW = ("filling_low", "filling_high", "part_volume", "wall_opening", "exempt_viscosity")
_UNVERIFIED = "for RID tank-wagons the corresponding rule could not be verified"
_LIQUID_AT = 50.0
"""Temperature, degC, at which the liquid must still find its room."""


def degree_of_filling(tank: Tank) -> float:
    """Volume of the liquid over the capacity of its tank."""
    section = section_of(tank)
    return section.area(liquid_depth(tank)) / section.area(section.height)


def filling_checks(tank: Tank, limits: Limits) -> tuple[Check, ...]:
    """Verdicts on a filling that lets a large load surge, and on one that leaves no room to expand."""
    return (_surge_check(tank, limits), _room_check(tank, limits))


def _surge_check(tank: Tank, limits: Limits) -> Check:
    share, part = degree_of_filling(tank), _largest_part(tank, limits)
    bound = part > limits.part_volume * (1.0 + _ROUNDING) and limits.viscosity < limits.exempt_viscosity
    over = min(share - limits.filling_low, limits.filling_high - share) if bound else 0.0
    standing, source = limits.standing_of(_LAW, "indicative", f"ADR 4.3.2.2.4, tanks on the road; {_UNVERIFIED}")
    return Check(
        "degree of filling between its limits",
        "operation",
        over if over > _ROUNDING else 0.0,
        0.0,
        f"The tank is filled to {share:.1%} of its capacity. A shell whose largest part holds {part:.3g} m^3, over "
        f"{limits.part_volume:g} m^3, is filled to at most {100.0 * limits.filling_low:.3g}% or at least "
        f"{100.0 * limits.filling_high:.3g}% of its capacity ({source}). Partitions and surge plates "
        f"(tank.baffles with an opening of at most {limits.wall_opening:g}) divide it; a liquid of "
        f"{1e6 * limits.exempt_viscosity:g} mm^2/s and more is exempt (limits.viscosity).",
        standing,
        source,
    )


def _largest_part(tank: Tank, limits: Limits) -> float:
    """Capacity (m^3) of the largest part between end walls and baffles that are hardly open."""
    section = section_of(tank)
    walls = sorted(wall.position for wall in tank.baffles if open_share(wall, section) <= limits.wall_opening)
    longest = max(end - start for start, end in pairwise([0.0, *walls, tank.length]))
    return section.area(section.height) * longest


def _room_check(tank: Tank, limits: Limits) -> Check:
    share = degree_of_filling(tank)
    warmer = _LIQUID_AT - limits.filling_celsius
    most = limits.filling_degree / (1.0 + limits.expansion_per_kelvin * warmer)
    own = () if limits.filling_degree in _CLASSES else ("filling_degree",)
    standing, source = limits.standing_of(own, "indicative", f"ADR 4.3.2.2.1, tanks on the road; {_UNVERIFIED}")
    return Check(
        "degree of filling over its maximum",
        "operation",
        share,
        most,
        f"The tank is filled to {share:.1%} of its capacity; at most {most:.1%} leave the liquid its room at 50 degC: "
        f"{limits.filling_degree:g}/(1 + {limits.expansion_per_kelvin:g} x {warmer:g}) ({source}). See "
        "limits.filling_degree, .filling_celsius and .expansion_per_kelvin.",
        standing,
        source,
    )
