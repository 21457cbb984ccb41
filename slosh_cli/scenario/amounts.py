"""How much is in a tank, as people know it: a volume or a mass in place of the depth over the height."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any, Final

from slosh_cli.scenario.leaves import Range
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.units import at_least, at_most, shown
from slosh_cli.section import Section, depth_of_area, section_of

FILLS: Final = Range(0.02, 0.995)
"""Depths that a tank may be filled to, over its height."""
AMOUNTS: Final = ("volume", "mass", "gross_mass")
"""Keys of a tank that may stand in place of its fill."""
_SIZES: Final = ("radius", "width", "height", "points")
_TARE: Final = (("car_body.mass", 1.0), ("bogie.mass", 2.0), ("wheelset.mass", 4.0))
"""What a wagon without its load is made of, and how often."""


def wanted_volume(tank: Any, tare: float | None) -> float:
    """Volume (m^3) of the liquid of a tank by whichever amount it has; `tare` (kg) is the wagon's without it."""
    if tank.volume is not None:
        return float(tank.volume)
    mass = tank.mass if tank.mass is not None else tank.gross_mass - (tare or 0.0)
    return float(mass / tank.liquid.density)


def fill_of(tank: Any, volume: float) -> float:
    """Depth over height of a tank that holds a `volume` (m^3)."""
    section = section_of(tank)
    return depth_of_area(section, volume / tank.length) / section.height


def tare_of(wagon: Any) -> float:
    """Mass (kg) of a wagon without its load."""
    return float(wagon.car_body.mass + 2.0 * wagon.bogie.mass + 4.0 * wagon.wheelset.mass)


def fits_tank(v: Values) -> Iterator[Finding]:
    """What is written in place of the fill must be what the tank can hold, as the fill must."""
    section = _section(v)
    if section is None or not v.has("tank.length"):
        return
    least, most = (section.area(fill * section.height) * v["tank.length"] for fill in (FILLS.low, FILLS.high))
    whole = section.area(section.height) * v["tank.length"]
    if v.get("tank.volume") is not None:
        yield from _beyond("volume", v["tank.volume"], (least, most), (1.0, "m^3"), f"{shown(_round(whole))} m^3")
    if not v.has("tank.liquid.density"):
        return
    density = v["tank.liquid.density"]
    holds = f"{shown(_round(whole))} m^3, {shown(_round(whole * density / 1e3))} t of this liquid"
    limits = least * density, most * density
    if v.get("tank.mass") is not None:
        yield from _beyond("mass", v["tank.mass"], limits, (1e3, "t"), holds)
    tare = _tare(v)
    if v.get("tank.gross_mass") is not None and tare is not None:
        holds = f"{holds}, and the wagon itself weighs {shown(_round(tare / 1e3))} t"
        yield from _beyond("gross_mass", v["tank.gross_mass"], (limits[0] + tare, limits[1] + tare), (1e3, "t"), holds)


def no_wagon(v: Values) -> Iterator[Finding]:
    """A gross mass is of wagon and load; a tank alone has no wagon."""
    if v.get("tank.gross_mass") is not None:
        rule = "must not be given for a tank alone: it is the mass of wagon and load, and there is no wagon"
        given = f"`{shown(v['tank.gross_mass'] / 1e3)} t`"
        yield Finding(("tank", "gross_mass"), rule, given, "write the `mass` or `volume` of the liquid, or `fill`")


def _beyond(
    key: str, value: float, limits: tuple[float, float], unit: tuple[float, str], holds: str
) -> Iterator[Finding]:
    """A finding where the `value` lies beyond `limits`; `unit` is that of all three in words, with its SI value."""
    least, most = limits
    size, name = unit
    if least <= value <= most:
        return
    low, high = at_least(least / size), at_most(most / size)
    rule = f"must be from {low} {name} to {high} {name}, {FILLS.low:.0%} to {FILLS.high:.1%} of the tank's height"
    fix = f"write at most `{high} {name}`" if value > most else f"write at least `{low} {name}`"
    yield Finding(("tank", key), rule, f"`{shown(value / size)} {name}` (the tank holds {holds})", fix)


def _section(v: Values) -> Section | None:
    """The tank's cross-section; None where it is not known."""
    sizes = {name: v[f"tank.{name}"] for name in _SIZES if v.has(f"tank.{name}")}
    try:
        return section_of(SimpleNamespace(shape=v.get("tank.shape"), **sizes)) if sizes else None
    except (AttributeError, ValueError):
        return None


def _tare(v: Values) -> float | None:
    """Mass (kg) of the wagon without its load; None where it is not known."""
    known = v.has(*(f"wagon.{name}" for name, _ in _TARE))
    return sum(count * float(v[f"wagon.{name}"]) for name, count in _TARE) if known else None


def _round(value: float) -> float:
    """`value` to the digits that people read."""
    return float(f"{value:.6g}")
