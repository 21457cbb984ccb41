"""Rules that tie several values of a wagon, its tank and its stop together."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from slosh_cli.scenario import rail_reach
from slosh_cli.scenario.amounts import fits_tank, no_wagon
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.schema_line import SMOOTH_START
from slosh_cli.scenario.schema_run import Foundation, Rail
from slosh_cli.scenario.units import STANDARD_GRAVITY, at_least, at_most, shown

_HIGHEST_TANK: Final = 7.0
"""Above every loading gauge in use, m."""
_WIDEST_TANK: Final = 5.0
"""Wider than every loading gauge in use, m."""
_LONGEST_TANK: Final = 3.0
"""Of the pivot spacing."""
_WIDEST_SLOT: Final = 0.2
"""Of the tank's mean width: the slot above the roof of a shallow-water liquid."""
_USUAL_SLOT_SPEED: Final = 30.0
"""The default of the slot's speed, m/s."""
_MOST_ELEMENTS: Final = 20_000
_ROUNDING: Final = 1e-9
"""Of the tank's height: an edge of a baffle's opening may lie so far beyond the roof."""
_MOST_ROWS: Final = 2_000_000


def _finding(key: str, rule: str, given: str, fix: str) -> Finding:
    return Finding(tuple(key.split(".")), rule, given, fix)


def _metres(value: float) -> str:
    return f"`{shown(value)} m`"


def _wheels_apart(v: Values) -> Iterator[Finding]:
    if not v.has("wagon.bogie.wheelbase", "wagon.wheelset.wheel_radius"):
        return
    wheelbase, diameter = v["wagon.bogie.wheelbase"], 2.0 * v["wagon.wheelset.wheel_radius"]
    if wheelbase <= diameter:
        rule = f"must be longer than the wheels are high, {at_least(diameter)} m, or the wheels of a bogie touch"
        yield _finding("wagon.bogie.wheelbase", rule, _metres(wheelbase), "write a longer wheelbase or smaller wheels")


def _bogies_apart(v: Values) -> Iterator[Finding]:
    if not v.has("wagon.bogie.wheelbase", "wagon.pivot_spacing"):
        return
    wheelbase, spacing = v["wagon.bogie.wheelbase"], v["wagon.pivot_spacing"]
    if spacing <= wheelbase:
        rule = f"must be longer than the wheelbase of a bogie, {at_least(wheelbase)} m"
        yield _finding("wagon.pivot_spacing", rule, _metres(spacing), "write a longer pivot spacing")


def _domain_holds_wagon(v: Values) -> Iterator[Finding]:
    """The rail's ends must be so far from the wheels that they change the deflection there by less than 1 %."""
    if not v.has("wagon.bogie.wheelbase", "wagon.pivot_spacing", "track.domain.length") or _on_springs(v):
        return
    wheels = v["wagon.pivot_spacing"] + v["wagon.bogie.wheelbase"]
    margin, length = _margin(v), v["track.domain.length"]
    needed = _rounded_up(wheels + 2.0 * margin) if math.isfinite(margin) else math.inf
    if needed > rail_reach.LONGEST:
        speed = v["braking.initial_speed"]
        rule = "must stay further below the track's critical speed: the rail's wave hardly fades"
        fix = "write a lower initial speed, or a stiffer or better damped foundation"
        yield _finding("braking.initial_speed", rule, f"`{shown(speed)} m/s`", fix)
    elif length is not None and length < needed:
        rule = f"must hold the wheels, {shown(wheels)} m apart, and {shown(_rounded_up(margin))} m more at either end"
        if margin > rail_reach.LEAST_MARGIN:
            rule += ", or the rail's ends change its deflection on this track by more than 1 %"
        yield _finding("track.domain.length", rule, _metres(length), f"write at least `{shown(needed)} m`")


def _on_springs(v: Values) -> bool:
    """Whether no stretch of rail is computed, so that its lengths say nothing."""
    return bool(v.get("track.model") == "rigid")


def _margin(v: Values) -> float:
    """Least length of rail beyond the outer wheels, m: by the track where it is known."""
    rail, foundation = (
        {name: v.get(f"{prefix}{name}") for name in part.model_fields}
        for part, prefix in ((Rail, "track.rail."), (Foundation, "track.foundation."))
    )
    speed = v.get("braking.initial_speed")
    if speed is None or None in (*rail.values(), *foundation.values()):
        return rail_reach.LEAST_MARGIN
    beam, bed = Rail.model_construct(**rail), Foundation.model_construct(**foundation)
    speed = speed if speed < rail_reach.critical_speed(beam, bed) else 0.0  # beyond it the solver has its say
    return rail_reach.margin_for(beam, bed, speed, rail_reach.REFUSED)


def _rounded_up(metres: float) -> float:
    return math.ceil(10.0 * metres - 1e-9) / 10.0


def _elements(v: Values) -> Iterator[Finding]:
    key = "track.domain.element_length"
    element, length = v.get(key), v.get("track.domain.length")
    if element is None or _on_springs(v):
        return
    if v.has("wagon.bogie.wheelbase") and element > 0.5 * v["wagon.bogie.wheelbase"]:
        most = 0.5 * v["wagon.bogie.wheelbase"]
        rule = f"must be at most half the wheelbase, {at_most(most)} m"
        yield _finding(key, rule, _metres(element), f"write `{at_most(most)} m` or less")
    if length is not None and element < length / _MOST_ELEMENTS:
        rule = f"must give at most {_MOST_ELEMENTS} elements over {shown(length)} m"
        least = length / _MOST_ELEMENTS
        yield _finding(key, rule, _metres(element), f"write `{at_least(least)} m` or more")


def _braking(v: Values) -> Iterator[Finding]:
    stop, start = "braking.stop_speed", "braking.initial_speed"
    if v.has(stop, start) and v[stop] >= v[start]:
        rule = f"must be below the initial speed, {at_most(v[start])} m/s"
        yield _finding(
            stop,
            rule,
            f"`{shown(v[stop])} m/s`",
            "write a lower stop speed or a higher `braking.initial_speed`",
        )
    limit, onset = "solver.time_limit", "braking.onset"
    if v.has(limit, onset) and v[onset] >= v[limit]:
        rule = f"must come before the solver's time limit, {at_most(v[limit])} s"
        yield _finding(onset, rule, f"`{shown(v[onset])} s`", "write an earlier onset or a later `solver.time_limit`")


def _dips_ahead(v: Values) -> Iterator[Finding]:
    """Unevenness sets in over the first metres: a dip there would be less deep than it is written."""
    if not v.has("wagon.bogie.wheelbase", "wagon.pivot_spacing"):
        return
    least = SMOOTH_START + 0.5 * (v["wagon.bogie.wheelbase"] + v["wagon.pivot_spacing"])
    for number, dip in enumerate(v.get("track.unevenness.dips") or ()):
        if dip.position < least:
            path = ("track", "unevenness", "dips", number, "position")
            rule = f"must be {at_least(least)} m or more, since unevenness sets in over the first {SMOOTH_START:g} m"
            yield Finding(path, rule, _metres(dip.position), f"write `{at_least(least)} m` or more")


def _rows(v: Values) -> Iterator[Finding]:
    interval, limit = "output.interval", "solver.time_limit"
    if v.has(interval, limit) and v[interval] < v[limit] / _MOST_ROWS:
        rule = f"must give at most {_MOST_ROWS} rows up to the time limit of {shown(v[limit])} s"
        fix = f"write `{at_least(v[limit] / _MOST_ROWS)} s` or more, or a lower `solver.time_limit`"
        yield _finding(interval, rule, f"`{shown(v[interval])} s`", fix)


def _coefficients(v: Values) -> Iterator[Finding]:
    if not isinstance(v.get("tank.coefficients"), tuple):
        return
    if v.wrote("tank.modes"):
        fix = "leave `modes` out, or write `coefficients: computed`"
        given = f"`{v.get('tank.modes', 'a value')}` beside a list of coefficients"
        yield _finding("tank.modes", "must not be set where the slosh coefficients are given", given, fix)
    if v.get("tank.liquid.damping_ratio", 0.0) > 0.0:
        rule = "must not be set where the slosh coefficients are given"
        fix = "leave it out and give each mode its own `damping_ratio`, or write `coefficients: computed`"
        given = f"`{shown(v['tank.liquid.damping_ratio'])}` beside a list of coefficients"
        yield _finding("tank.liquid.damping_ratio", rule, given, fix)


def _baffles(v: Values) -> Iterator[Finding]:
    baffles = v.get("tank.baffles", ())
    if baffles and v.get("tank.liquid.model") == "modal":
        fix = "write `model: shallow-water`, or leave the baffles out"
        yield _finding("tank.baffles", "must not be set for the modal liquid, which knows none", f"{len(baffles)}", fix)
    if not baffles or not v.has("tank.length", "tank.liquid.cells"):
        return
    length, cells = v["tank.length"], v["tank.liquid.cells"]
    faces = [round(baffle.position / length * cells) for baffle in baffles]
    for place, face in enumerate(faces):
        if not 0 < face < cells or face in faces[:place]:
            rule = f"must lie inside the {shown(length)} m long tank, a cell or more from its walls and each other"
            given = _metres(baffles[place].position)
            path = ("tank", "baffles", place, "position")
            between = f"`{at_least(length / cells)} m` and `{at_most(length - length / cells)} m`"
            yield Finding(path, rule, given, f"write a place between {between}, a cell or more from the others")


def _openings(v: Values) -> Iterator[Finding]:
    extent = _tank_extent(v)
    for place, baffle in enumerate(v.get("tank.baffles", ())):
        path = ("tank", "baffles", place, "openings")
        if v.wrote(f"tank.baffles.{place}.openings") and not baffle.openings:
            fix = "write `opening: 0` for a closed bulkhead, or `openings: [{from: 0 m, to: 0.6 m}]`"
            yield Finding(path, "must have at least one opening", "an empty list", fix)
        highest = 0.0
        for number, (low, high) in sorted(enumerate(baffle.bands), key=lambda entry: entry[1]):
            given = f"from {_metres(low)} to {_metres(high)}"
            if low >= high:
                yield Finding((*path, number, "to"), "must lie above `from`", given, "write the higher edge as `to`")
            elif extent is not None and high > extent[1] * (1.0 + _ROUNDING):
                rule = f"must lie in the {shown(extent[1])} m high tank"
                yield Finding((*path, number, "to"), rule, given, f"write `{at_most(extent[1])} m` or less")
            elif low < highest:
                rule = f"must not overlap another opening, which reaches up to {shown(highest)} m"
                fix = f"write `{shown(highest)} m` or more, or make one opening of the two"
                yield Finding((*path, number, "from"), rule, given, fix)
            highest = max(highest, high)


def _slot(v: Values) -> Iterator[Finding]:
    """Pressure waves at c need a slot of width `g A/c^2`, the part `g H/c^2` of the mean width A/H."""
    key, extent = "tank.liquid.slot_speed", _tank_extent(v)
    if extent is None or v.get("tank.liquid.model") != "shallow-water" or not v.has(key):
        return
    least = math.sqrt(STANDARD_GRAVITY * extent[1] / _WIDEST_SLOT)
    if v[key] < least:
        rule = f"must be at least {at_least(least)} m/s, or the slot above the roof is wider than a fifth of the tank"
        usual = "leave it out, or write `30 m/s` or more"
        fix = usual if least <= _USUAL_SLOT_SPEED else f"write `{at_least(least)} m/s` or more"
        yield _finding(key, rule, f"`{shown(v[key])} m/s`", fix)


def _tank_extent(v: Values) -> tuple[float, float] | None:
    """Largest inner (width, height) of the tank in m, None where they are not known."""
    if v.has("tank.radius"):
        return 2.0 * v["tank.radius"], 2.0 * v["tank.radius"]
    if v.has("tank.width", "tank.height"):
        return v["tank.width"], v["tank.height"]
    if v.has("tank.points"):
        points = v["tank.points"]
        return 2.0 * max(y for y, _ in points), max(z for _, z in points)
    return None


def _tank_on_wagon(v: Values) -> Iterator[Finding]:
    bottom = "tank.bottom_height"
    if v.has("tank.shape") and not v.wrote(bottom):
        fix = "write the height of the tank's lowest inner point above the rail head, such as `bottom_height: 1.15 m`"
        yield _finding(bottom, "is required for a tank on a wagon", "nothing", fix)
    if v.has("tank.length", "wagon.pivot_spacing"):
        most = _LONGEST_TANK * v["wagon.pivot_spacing"]
        if v["tank.length"] > most:
            rule = f"must be at most {shown(_LONGEST_TANK)} pivot spacings, {at_most(most)} m"
            yield _finding("tank.length", rule, _metres(v["tank.length"]), "write a shorter tank or a longer wagon")
    extent = _tank_extent(v)
    if extent is None:
        return
    width, height = extent
    if width > _WIDEST_TANK:
        rule = f"must fit on a wagon: at most {shown(_WIDEST_TANK)} m wide"
        yield _finding(_dimension_key(v, "width"), rule, f"a width of {_metres(width)}", "write a narrower tank")
    if v.has(bottom) and v.wrote(bottom) and v[bottom] + height > _HIGHEST_TANK:
        rule = f"must fit on a wagon: its top at most {shown(_HIGHEST_TANK)} m above the rail head"
        given = f"a top at {_metres(v[bottom] + height)}"
        yield _finding(_dimension_key(v, "height"), rule, given, "write a lower tank or `bottom_height`")


def _dimension_key(v: Values, name: str) -> str:
    keys = (f"tank.{name}", "tank.radius", "tank.points")
    return next(key for key in keys if v.has(key))


_TANK_RULES: Final = (_coefficients, _baffles, _openings, _slot, fits_tank)
ALONE_RULES: Final = (*_TANK_RULES, no_wagon)
STOP_RULES: Final = (
    *_TANK_RULES,
    _wheels_apart,
    _bogies_apart,
    _domain_holds_wagon,
    _elements,
    _braking,
    _rows,
    _dips_ahead,
    _tank_on_wagon,
)
