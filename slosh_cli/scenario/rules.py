"""Rules that tie several values of a scenario together.

A rule is checked as soon as the values it needs are valid, whatever else is wrong, so that a person
sees everything at once.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Final

from slosh_cli.scenario import rail_reach
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.schema_run import Foundation, Rail
from slosh_cli.scenario.units import STANDARD_GRAVITY, at_least, at_most, shown

HIGHEST_TANK: Final = 7.0
"""Above every loading gauge in use, m."""
WIDEST_TANK: Final = 5.0
"""Wider than every loading gauge in use, m."""
LONGEST_TANK: Final = 3.0
"""Of the pivot spacing."""
WIDEST_SLOT: Final = 0.2
"""Of the tank's mean width: the slot above the roof of a shallow-water liquid."""
USUAL_SLOT_SPEED: Final = 30.0
"""The default of the slot's speed, m/s."""
MOST_ELEMENTS: Final = 20_000
MOST_ROWS: Final = 2_000_000


@dataclass(frozen=True)
class Finding:
    """One mistake at one path of the data: the rule, what was given and what to write.

    Of an unknown key, `guess` is the path of the key that was probably meant.
    """

    path: tuple[str | int, ...]
    rule: str
    given: str
    fix: str
    guess: tuple[str | int, ...] = ()


@dataclass(frozen=True)
class Values:
    """Valid values by dotted key path, defaults included, and the paths that were written out."""

    values: Mapping[str, Any]
    explicit: frozenset[str]

    def has(self, *keys: str) -> bool:
        return all(key in self.values for key in keys)

    def __getitem__(self, key: str) -> Any:
        return self.values[key]


def values_of(part: Part, prefix: str = "") -> Values:
    """All values of a validated part."""
    values: dict[str, Any] = {}
    explicit: set[str] = set()
    _collect(part, prefix, values, explicit)
    return Values(values, frozenset(explicit))


def _collect(part: Part, prefix: str, values: dict[str, Any], explicit: set[str]) -> None:
    keys = _keys_of(type(part), prefix)
    explicit.update([keys[name] for name in part.model_fields_set])
    for name, value in vars(part).items():
        if isinstance(value, Part):
            _collect(value, f"{keys[name]}.", values, explicit)
        else:
            values[keys[name]] = value


@cache
def _keys_of(model: type[Part], prefix: str) -> dict[str, str]:
    return {name: prefix + name for name in model.model_fields}


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
    if not v.has("wagon.bogie.wheelbase", "wagon.pivot_spacing", "track.domain.length"):
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


def _margin(v: Values) -> float:
    """Least length of rail beyond the outer wheels, m: by the track where it is known."""
    rail, foundation = (
        {name: v.values.get(f"{prefix}{name}") for name in part.model_fields}
        for part, prefix in ((Rail, "track.rail."), (Foundation, "track.foundation."))
    )
    speed = v.values.get("braking.initial_speed")
    if speed is None or None in (*rail.values(), *foundation.values()):
        return rail_reach.LEAST_MARGIN
    beam, bed = Rail.model_construct(**rail), Foundation.model_construct(**foundation)
    speed = speed if speed < rail_reach.critical_speed(beam, bed) else 0.0  # beyond it the solver has its say
    return rail_reach.margin_for(beam, bed, speed, rail_reach.REFUSED)


def _rounded_up(metres: float) -> float:
    return math.ceil(10.0 * metres - 1e-9) / 10.0


def _elements(v: Values) -> Iterator[Finding]:
    key = "track.domain.element_length"
    element, length = v.values.get(key), v.values.get("track.domain.length")
    if element is None:
        return
    if v.has("wagon.bogie.wheelbase") and element > 0.5 * v["wagon.bogie.wheelbase"]:
        most = 0.5 * v["wagon.bogie.wheelbase"]
        rule = f"must be at most half the wheelbase, {at_most(most)} m"
        yield _finding(key, rule, _metres(element), f"write `{at_most(most)} m` or less")
    if length is not None and element < length / MOST_ELEMENTS:
        rule = f"must give at most {MOST_ELEMENTS} elements over {shown(length)} m"
        least = length / MOST_ELEMENTS
        yield _finding(key, rule, _metres(element), f"write `{at_least(least)} m` or more")


def _adhesion(v: Values) -> Iterator[Finding]:
    area, slip = "contact.adhesion.kA", "contact.adhesion.kS"
    if v.has(area, slip) and v[slip] > v[area]:
        most = at_most(v[area])
        rule = f"must be at most kA, {most}"
        yield _finding(slip, rule, f"`{shown(v[slip])}`", f"write `{most}` or less, or exchange kA and kS")


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


def _rows(v: Values) -> Iterator[Finding]:
    interval, limit = "output.interval", "solver.time_limit"
    if v.has(interval, limit) and v[interval] < v[limit] / MOST_ROWS:
        rule = f"must give at most {MOST_ROWS} rows up to the time limit of {shown(v[limit])} s"
        fix = f"write `{at_least(v[limit] / MOST_ROWS)} s` or more, or a lower `solver.time_limit`"
        yield _finding(interval, rule, f"`{shown(v[interval])} s`", fix)


def _coefficients(v: Values) -> Iterator[Finding]:
    if not isinstance(v.values.get("tank.coefficients"), tuple):
        return
    if "tank.modes" in v.explicit:
        fix = "leave `modes` out, or write `coefficients: computed`"
        given = f"`{v.values.get('tank.modes', 'a value')}` beside a list of coefficients"
        yield _finding("tank.modes", "must not be set where the slosh coefficients are given", given, fix)
    if v.values.get("tank.liquid.damping_ratio", 0.0) > 0.0:
        rule = "must not be set where the slosh coefficients are given"
        fix = "leave it out and give each mode its own `damping_ratio`, or write `coefficients: computed`"
        given = f"`{shown(v['tank.liquid.damping_ratio'])}` beside a list of coefficients"
        yield _finding("tank.liquid.damping_ratio", rule, given, fix)


def _baffles(v: Values) -> Iterator[Finding]:
    baffles = v.values.get("tank.baffles", ())
    if baffles and v.values.get("tank.liquid.model") == "modal":
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


def _slot(v: Values) -> Iterator[Finding]:
    """Pressure waves at c need a slot of width `g A/c^2`, the part `g H/c^2` of the mean width A/H."""
    key, extent = "tank.liquid.slot_speed", tank_extent(v)
    if extent is None or v.values.get("tank.liquid.model") != "shallow-water" or not v.has(key):
        return
    least = math.sqrt(STANDARD_GRAVITY * extent[1] / WIDEST_SLOT)
    if v[key] < least:
        rule = f"must be at least {at_least(least)} m/s, or the slot above the roof is wider than a fifth of the tank"
        usual = "leave it out, or write `30 m/s` or more"
        fix = usual if least <= USUAL_SLOT_SPEED else f"write `{at_least(least)} m/s` or more"
        yield _finding(key, rule, f"`{shown(v[key])} m/s`", fix)


def tank_extent(v: Values) -> tuple[float, float] | None:
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
    if v.has("tank.shape") and bottom not in v.explicit:
        fix = "write the height of the tank's lowest inner point above the rail head, such as `bottom_height: 1.15 m`"
        yield _finding(bottom, "is required for a tank on a wagon", "nothing", fix)
    if v.has("tank.length", "wagon.pivot_spacing"):
        most = LONGEST_TANK * v["wagon.pivot_spacing"]
        if v["tank.length"] > most:
            rule = f"must be at most {shown(LONGEST_TANK)} pivot spacings, {at_most(most)} m"
            yield _finding("tank.length", rule, _metres(v["tank.length"]), "write a shorter tank or a longer wagon")
    extent = tank_extent(v)
    if extent is None:
        return
    width, height = extent
    if width > WIDEST_TANK:
        rule = f"must fit on a wagon: at most {shown(WIDEST_TANK)} m wide"
        yield _finding(_dimension_key(v, "width"), rule, f"a width of {_metres(width)}", "write a narrower tank")
    if v.has(bottom) and bottom in v.explicit and v[bottom] + height > HIGHEST_TANK:
        rule = f"must fit on a wagon: its top at most {shown(HIGHEST_TANK)} m above the rail head"
        given = f"a top at {_metres(v[bottom] + height)}"
        yield _finding(_dimension_key(v, "height"), rule, given, "write a lower tank or `bottom_height`")


def _dimension_key(v: Values, name: str) -> str:
    keys = (f"tank.{name}", "tank.radius", "tank.points")
    return next(key for key in keys if v.has(key))


Rule = Callable[[Values], Iterator[Finding]]
TANK_RULES: Final[tuple[Rule, ...]] = (_coefficients, _baffles, _slot)
SCENARIO_RULES: Final[tuple[Rule, ...]] = (
    *TANK_RULES,
    _wheels_apart,
    _bogies_apart,
    _domain_holds_wagon,
    _elements,
    _adhesion,
    _braking,
    _rows,
    _tank_on_wagon,
)


def broken_rules(values: Values, rules: tuple[Rule, ...]) -> tuple[Finding, ...]:
    """Everything the given rules have against the values."""
    return tuple(finding for rule in rules for finding in rule(values))
