"""The kinds of quantity and the factors of their units to SI. The only module that imports pint.

Pint's registry holds the units of unit_names and no others: it is built in milliseconds, where pint's own takes
a fifth of a second. It computes in fractions, so that every factor is the float nearest to the exact one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.scenario.unit_names import DEFINITIONS, UnknownUnit, standard_unit

if TYPE_CHECKING:
    import pint

STANDARD_GRAVITY: Final = 9.81
"""m/s^2, the value of the model everywhere."""


@dataclass(frozen=True)
class Dimension:
    """A kind of quantity: what it is called, its SI unit, the units to suggest and factors to SI.

    `factors` are those of units in standard form. Quantities in them, which is nearly all there are, are read
    without pint: it takes longer to load than `slosh check` takes for everything else.
    """

    name: str
    noun: str
    unit: str
    units: tuple[str, ...]
    factors: Mapping[str, float]


def _dimension(
    name: str,
    noun: str,
    unit: str,
    suggested: Mapping[str, float] | None = None,
    others: Mapping[str, float] | None = None,
) -> Dimension:
    first = suggested or {unit: 1.0}
    return Dimension(name, noun, unit, tuple(first), {**first, **(others or {})})


_STRESSES: Final = {
    **{"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "bar": 1e5},
    **{"N/m^2": 1.0, "kN/m^2": 1e3, "MN/m^2": 1e6, "N/mm^2": 1e6, "kN/mm^2": 1e9},
}
_LENGTHS: Final = {"cm": 1e-2, "km": 1e3, "inch": 0.0254, "ft": 0.3048}

DIMENSIONS: Final[dict[str, Dimension]] = {
    entry.name: entry
    for entry in (
        _dimension("mass", "a mass", "kg", {"kg": 1.0, "t": 1e3}, {"g": 1e-3, "lb": 0.45359237}),
        _dimension("length", "a length", "m", {"m": 1.0, "mm": 1e-3}, _LENGTHS),
        _dimension("volume", "a volume", "m^3", {"m^3": 1.0, "L": 1e-3}),
        _dimension("time", "a time", "s", {"s": 1.0, "ms": 1e-3}, {"min": 60.0, "h": 3600.0}),
        _dimension("speed", "a speed", "m/s", {"km/h": 1 / 3.6, "m/s": 1.0}, {"mph": 0.44704, "kn": 1852 / 3600}),
        _dimension("acceleration", "an acceleration", "m/s^2", {"m/s^2": 1.0, "g": STANDARD_GRAVITY}),
        _dimension(
            "angular_frequency", "an angular frequency", "rad/s", {"rad/s": 1.0, "Hz": 2 * math.pi}, {"1/s": 1.0}
        ),
        _dimension("force", "a force", "N", {"N": 1.0, "kN": 1e3}, {"MN": 1e6, "lbf": 4.4482216152605}),
        _dimension("torque", "a torque", "N m", {"kN m": 1e3, "N m": 1.0}, {"MN m": 1e6, "J": 1.0, "kJ": 1e3}),
        _dimension("modulus", "an elastic modulus", "Pa", {"GPa": 1e9, "Pa": 1.0}, _STRESSES),
        _dimension("density", "a density", "kg/m^3", None, {"t/m^3": 1e3, "g/cm^3": 1e3, "kg/L": 1e3}),
        _dimension("mass_per_length", "a mass per length", "kg/m", None, {"t/m": 1e3}),
        _dimension("first_moment", "a mass times a length", "kg m", None, {"t m": 1e3}),
        _dimension("moment_of_inertia", "a moment of inertia", "kg m^2", None, {"t m^2": 1e3}),
        _dimension("second_moment", "a second moment of area", "m^4", {"m^4": 1.0, "cm^4": 1e-8}, {"mm^4": 1e-12}),
        _dimension(
            "stiffness", "a stiffness", "N/m", {"N/m": 1.0, "kN/m": 1e3}, {"MN/m": 1e6, "N/mm": 1e3, "kN/mm": 1e6}
        ),
        _dimension("damping", "a force per speed", "N s/m", {"N s/m": 1.0, "kN s/m": 1e3}),
        _dimension("quadratic_resistance", "a force per squared speed", "N s^2/m^2"),
        _dimension("stiffness_per_length", "a stiffness per length", "N/m^2", {"N/m^2": 1.0, "MN/m^2": 1e6}, _STRESSES),
        _dimension("damping_per_length", "a damping per length", "N s/m^2", {"N s/m^2": 1.0, "kN s/m^2": 1e3}),
        _dimension("shear_damping", "a shear damping", "N s", {"N s": 1.0, "kN s": 1e3}),
        _dimension("contact_stiffness", "a Hertzian contact stiffness", "N/m^1.5"),
        _dimension("kinematic_viscosity", "a kinematic viscosity", "m^2/s", {"mm^2/s": 1e-6, "m^2/s": 1.0}),
        _dimension("inverse_speed", "an inverse speed", "s/m"),
    )
}

PURE: Final[dict[str, int]] = {"percent": 100, "permille": 1000}
"""The units of pure numbers: how many of them make one."""

_NAMED_OTHERWISE: Final = {"modulus": "a pressure", "torque": "a torque or an energy"}


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[Any]:
    """The lean registry, built at first use so that importing this module stays cheap."""
    import pint  # 0.2 s, and only a unit that is in no table of DIMENSIONS needs it

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry(None, non_int_type=Fraction)
    for name, definition in DEFINITIONS.items():
        registry.define(f"{name} = {definition}")
    return registry


@lru_cache(maxsize=512)
def _measure(standard: str) -> tuple[float, Any]:
    """Factor to SI and dimensionality of a unit in standard form; UnknownUnit where no float holds the factor."""
    registry = _registry()
    quantity = registry.parse_expression(standard.replace("^", "**").replace(" ", " * "))
    try:
        base = registry.Quantity(1, quantity.units).to_base_units()
        return float(base.magnitude), base.dimensionality
    except ArithmeticError:
        raise UnknownUnit(standard) from None


def convert(value: float, unit: str, dimension: str) -> float:
    """`value` in `unit` as an SI float. ValueError when the unit is unknown or of another dimension."""
    standard = standard_unit(unit)
    known = DIMENSIONS[dimension].factors.get(standard)
    if known is not None:
        return value * known
    factor, dimensionality = _measure(standard)
    if dimensionality != _measure(standard_unit(DIMENSIONS[dimension].unit))[1]:
        raise ValueError(unit)
    return value * factor


def what_it_measures(unit: str) -> str:
    """The kind of quantity that a readable unit belongs to, as a noun; empty where it has no name here."""
    standard = standard_unit(unit)
    dimensionality = _measure(standard)[1]
    if standard in PURE:
        return "a pure number"
    for name, kind in DIMENSIONS.items():
        if _measure(kind.unit)[1] == dimensionality:
            return _NAMED_OTHERWISE.get(name, kind.noun)
    return ""
