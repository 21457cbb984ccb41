"""Quantities as people write them (``80 km/h``, ``5 kN m``) to SI floats. The only module that imports pint.

The registry holds the units below and no others: it is built in milliseconds, where pint's own takes a
fifth of a second, and a slip such as ``21.3 mT`` is refused instead of being read as a magnetic field.
There are no free prefixes for the same reason: every accepted name is in the table.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.errors import ValueRefused

if TYPE_CHECKING:
    import pint

STANDARD_GRAVITY: Final = 9.81
"""m/s^2, the value of the model everywhere."""

_DEFINITIONS: Final[dict[str, str]] = {
    "kg": "[mass]",
    "m": "[length]",
    "s": "[time]",
    "rad": "[]",
    # mass
    "g": "0.001 * kg",
    "t": "1000 * kg",
    "tonne": "1000 * kg",
    "lb": "0.45359237 * kg",
    # length and volume
    "um": "0.000001 * m",
    "mm": "0.001 * m",
    "cm": "0.01 * m",
    "dm": "0.1 * m",
    "km": "1000 * m",
    "inch": "0.0254 * m",
    "ft": "0.3048 * m",
    "L": "0.001 * m ** 3",
    "l": "0.001 * m ** 3",
    # time, speed, angle
    "us": "0.000001 * s",
    "ms": "0.001 * s",
    "min": "60 * s",
    "h": "3600 * s",
    "kmh": "1000 * m / (3600 * s)",
    "kph": "1000 * m / (3600 * s)",
    "mph": "0.44704 * m / s",
    "deg": f"{math.pi / 180!r} * rad",
    # a frequency in hertz is meant as an angular one wherever this program asks for it
    "Hz": f"{2 * math.pi!r} * rad / s",
    "rpm": f"{math.pi / 30!r} * rad / s",
    # force, torque, pressure
    "N": "kg * m / s ** 2",
    "daN": "10 * N",
    "kN": "1000 * N",
    "MN": "1000000 * N",
    "lbf": "4.4482216152605 * N",
    "Nm": "N * m",
    "kNm": "1000 * N * m",
    "J": "N * m",
    "kJ": "1000 * N * m",
    "Pa": "N / m ** 2",
    "hPa": "100 * Pa",
    "kPa": "1000 * Pa",
    "MPa": "1000000 * Pa",
    "GPa": "1000000000 * Pa",
    "bar": "100000 * Pa",
}


@dataclass(frozen=True)
class Dimension:
    """A kind of quantity: what it is called, its SI unit, and the units to suggest with their factors to SI.

    Quantities in these units, which is nearly all there are, are read without pint: it takes longer to load
    than `slosh check` takes for everything else.
    """

    name: str
    noun: str
    unit: str
    factors: Mapping[str, float]

    @property
    def units(self) -> tuple[str, ...]:
        """The units to suggest, the SI unit among them."""
        return tuple(self.factors)


def _dimension(name: str, noun: str, unit: str, factors: Mapping[str, float] | None = None) -> Dimension:
    return Dimension(name, noun, unit, factors or {unit: 1.0})


DIMENSIONS: Final[dict[str, Dimension]] = {
    entry.name: entry
    for entry in (
        _dimension("mass", "a mass", "kg", {"kg": 1.0, "t": 1e3}),
        _dimension("length", "a length", "m", {"m": 1.0, "mm": 1e-3}),
        _dimension("time", "a time", "s", {"s": 1.0, "ms": 1e-3}),
        _dimension("speed", "a speed", "m/s", {"km/h": 1 / 3.6, "m/s": 1.0}),
        _dimension("acceleration", "an acceleration", "m/s^2", {"m/s^2": 1.0, "g": STANDARD_GRAVITY}),
        _dimension("angular_frequency", "an angular frequency", "rad/s", {"rad/s": 1.0, "Hz": 2 * math.pi}),
        _dimension("force", "a force", "N", {"N": 1.0, "kN": 1e3}),
        _dimension("torque", "a torque", "N m", {"kN m": 1e3, "N m": 1.0}),
        _dimension("modulus", "an elastic modulus", "Pa", {"GPa": 1e9, "Pa": 1.0}),
        _dimension("density", "a density", "kg/m^3"),
        _dimension("mass_per_length", "a mass per length", "kg/m"),
        _dimension("first_moment", "a mass times a length", "kg m"),
        _dimension("moment_of_inertia", "a moment of inertia", "kg m^2"),
        _dimension("second_moment", "a second moment of area", "m^4", {"m^4": 1.0, "cm^4": 1e-8}),
        _dimension("stiffness", "a stiffness", "N/m", {"N/m": 1.0, "kN/m": 1e3}),
        _dimension("damping", "a force per speed", "N s/m", {"N s/m": 1.0, "kN s/m": 1e3}),
        _dimension("quadratic_resistance", "a force per squared speed", "N s^2/m^2"),
        _dimension("stiffness_per_length", "a stiffness per length", "N/m^2", {"N/m^2": 1.0, "MN/m^2": 1e6}),
        _dimension("damping_per_length", "a damping per length", "N s/m^2", {"N s/m^2": 1.0, "kN s/m^2": 1e3}),
        _dimension("shear_damping", "a shear damping", "N s", {"N s": 1.0, "kN s": 1e3}),
        _dimension("contact_stiffness", "a Hertzian contact stiffness", "N/m^1.5"),
        _dimension("inverse_speed", "an inverse speed", "s/m"),
    )
}

NUMBER_PATTERN: Final = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_QUANTITY = re.compile(rf"\s*({NUMBER_PATTERN})(?![0-9.,])\s*(.*?)\s*", re.DOTALL)
_UNIT = re.compile(r"(?:1\s*/\s*)?(?:[A-Za-z()/*\s]|(?:\^|\*\*)-?[0-9](?:\.[0-9])?)+")
_NAME = re.compile(r"[A-Za-z]+")
_LONGEST: Final = 200
"""Characters; nothing longer is a quantity."""


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[Any]:
    """The lean registry, built at first use so that importing this module stays cheap."""
    import pint  # 0.2 s, and only a unit that is in no table of DIMENSIONS needs it

    registry: pint.UnitRegistry[Any] = pint.UnitRegistry(None)
    for name, definition in _DEFINITIONS.items():
        registry.define(f"{name} = {definition}")
    return registry


@lru_cache(maxsize=512)
def _unit(text: str) -> tuple[float, Any]:
    """Factor to SI and dimensionality of a unit; ValueError when it cannot be read."""
    normal = text.replace("²", "^2").replace("³", "^3").replace("⁴", "^4").replace("·", " ")
    if not _UNIT.fullmatch(normal) or any(name not in _DEFINITIONS for name in _NAME.findall(normal)):
        raise ValueError(text)
    registry = _registry()
    try:
        quantity = registry.parse_expression(normal.replace("^", "**"))
        base = registry.Quantity(1.0, quantity.units).to_base_units()
    except Exception as error:  # pint raises a wide choice: tokenizer, definition, syntax and type errors
        raise ValueError(text) from error
    return float(base.magnitude), base.dimensionality


def _dimensionality(dimension: Dimension) -> Any:
    return _unit(dimension.unit)[1]


def convert(value: float, unit: str, dimension: str) -> float:
    """`value` in `unit` as an SI float. ValueError when the unit is unknown or of another dimension."""
    known = DIMENSIONS[dimension].factors.get(unit)
    if known is not None:
        return value * known
    factor, dimensionality = _unit(unit)
    if dimensionality != _dimensionality(DIMENSIONS[dimension]):
        raise ValueError(unit)
    return value * factor


def shown(value: float) -> str:
    """A number for a message: at most six significant digits, no superfluous zeros."""
    return f"{value:.6g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")


def parse_quantity(text: object, dimension: str, fits: Callable[[float], bool] | None = None) -> float:
    """Read ``'80 km/h'`` and the like as an SI float.

    `dimension` is a key of DIMENSIONS. For ``acceleration`` the unit ``g`` is standard gravity, 9.81 m/s^2;
    everywhere else it is the gram. `fits` tells which SI values the caller could use; it only chooses the
    unit to suggest where none was given. Raises ValueRefused with the rule, what was given and what to write.
    """
    kind = DIMENSIONS[dimension]
    rule = f"must be {kind.noun} with its unit, such as {_either(kind.units)}"
    if not isinstance(text, str):
        raise _bare(text, rule, kind, fits)
    match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None:
        raise ValueRefused(rule, plain(text), _number_fix(text, kind))
    number, unit = match.groups()
    value = float(number)
    if not math.isfinite(value):
        raise ValueRefused(rule, f"`{text}`, which overflows", f"write a finite value, such as `1 {kind.units[0]}`")
    if not unit:
        raise _bare(number, rule, kind, fits)
    try:
        return convert(value, unit, dimension)
    except ValueError:
        pass
    given, fix = _unit_advice(number, unit, kind)
    raise ValueRefused(rule, f"{plain(text.strip())}{given}", fix)


def _bare(value: object, rule: str, kind: Dimension, fits: Callable[[float], bool] | None) -> ValueRefused:
    """The refusal of anything that is not text with a unit."""
    example = f"such as `1 {kind.units[0]}`"
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return ValueRefused(rule, plain(value), f"write a number and a unit, {example}")
    if not math.isfinite(float(value)):
        return ValueRefused(rule, f"`{value}`", f"write a finite number and a unit, {example}")
    likely = [unit for unit in kind.units if fits and fits(convert(float(value), unit, kind.name))]
    fix = _whichever(str(value), tuple(likely) or kind.units)
    return ValueRefused(rule, f"`{value}` without a unit", fix)


def _whichever(number: str, units: tuple[str, ...]) -> str:
    written = " or ".join(f"`{number} {unit}`" for unit in units)
    return f"write {written}" + (", whichever is meant" if len(units) > 1 else "")


def plain(value: object) -> str:
    """A value of a YAML file as a message shows it."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`, which is a truth value"
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    text = str(value)
    return f"`{text if len(text) <= 60 else text[:57] + '...'}`"


def _number_fix(text: str, kind: Dimension) -> str:
    example = f"`1.5 {kind.units[0]}`"
    if re.match(r"\s*[+-]?[0-9]+,[0-9]", text):
        return f"write the number with a decimal point and without separators, such as {example}"
    return f"write a finite number and a unit, such as {example}"


def _unit_advice(number: str, unit: str, kind: Dimension) -> tuple[str, str]:
    """(what is wrong with the unit, what to write) for a unit that was not accepted."""
    example = _whichever(number, kind.units)
    try:
        dimensionality = _unit(unit)[1]
    except ValueError:
        repaired = _repaired(unit, kind)
        unknown = [name for name in _NAME.findall(unit) if name not in _DEFINITIONS]
        about = f", where `{unknown[0]}` is no unit known here" if unknown else f", where `{unit}` cannot be read"
        return about, f"write `{number} {repaired}`" if repaired else example
    for other in DIMENSIONS.values():
        if _dimensionality(other) == dimensionality:
            return f", which is {other.noun}", example
    return ", which has another dimension", example


def _repaired(unit: str, kind: Dimension) -> str:
    """The unit that was probably meant, or empty: other case, ``kgm`` in one, ``m/s2`` without ``^``."""

    def fits(candidate: str) -> bool:
        try:
            return bool(_unit(candidate)[1] == _dimensionality(kind))
        except ValueError:
            return False

    def known(match: re.Match[str]) -> str:
        name = match.group()
        if name in _DEFINITIONS:
            return name
        for cut in range(1, len(name)):
            if name[:cut] in _DEFINITIONS and name[cut:] in _DEFINITIONS:
                return f"{name[:cut]} {name[cut:]}"
        same = [entry for entry in _DEFINITIONS if entry.lower() == name.lower()]
        return (same or difflib.get_close_matches(name, _DEFINITIONS, 1) or [name])[0]

    powered = re.sub(r"([A-Za-z])([0-9])", r"\1^\2", unit)
    for candidate in (_NAME.sub(known, powered), _NAME.sub(known, powered.replace("-", " "))):
        if fits(candidate):
            return candidate
    return ""


def _either(units: tuple[str, ...]) -> str:
    return " or ".join(f"`{unit}`" for unit in units)
