"""The names of units and how people join them: ``kN-m``, ``kgm2``, ``N.m``, ``kg m-3`` in one standard form.

There are no free prefixes: every accepted name is in a table below, and case counts. A slip such as ``21.3 mT``
is refused instead of being read as a magnetic field.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator
from functools import lru_cache
from typing import Final

from slosh_cli.scenario.numerals import plain_signs

DEFINITIONS: Final[dict[str, str]] = {
    "kg": "[mass]",
    "m": "[length]",
    "s": "[time]",
    "rad": "[]",
    "percent": "0.01 * rad",
    "permille": "0.001 * rad",
    # mass
    "g": "0.001 * kg",
    "gram": "0.001 * kg",
    "t": "1000 * kg",
    "lb": "0.45359237 * kg",
    "short_ton": "2000 * lb",
    "long_ton": "2240 * lb",
    "slug": "4.4482216152605 / 0.3048 * kg",
    # length and volume
    "um": "0.000001 * m",
    "mm": "0.001 * m",
    "cm": "0.01 * m",
    "dm": "0.1 * m",
    "km": "1000 * m",
    "inch": "0.0254 * m",
    "ft": "0.3048 * m",
    "yd": "0.9144 * m",
    "mi": "1609.344 * m",
    "nmi": "1852 * m",
    "L": "0.001 * m ** 3",
    "US_gallon": "231 * inch ** 3",
    "imperial_gallon": "4.54609 * L",
    # time, speed, angle
    "us": "0.000001 * s",
    "ms": "0.001 * s",
    "min": "60 * s",
    "h": "3600 * s",
    "mph": "0.44704 * m / s",
    "kn": "1852 * m / (3600 * s)",
    "deg": f"{math.pi / 180!r} * rad",
    "rev": f"{2 * math.pi!r} * rad",
    # a frequency in hertz is meant as an angular one wherever this program asks for it
    "Hz": f"{2 * math.pi!r} * rad / s",
    "rpm": f"{math.pi / 30!r} * rad / s",
    # force, torque, pressure
    "N": "kg * m / s ** 2",
    "daN": "10 * N",
    "kN": "1000 * N",
    "MN": "1000000 * N",
    "kgf": "9.80665 * N",
    "lbf": "4.4482216152605 * N",
    "kip": "1000 * lbf",
    "J": "N * m",
    "kJ": "1000 * N * m",
    "MJ": "1000000 * N * m",
    "Pa": "N / m ** 2",
    "hPa": "100 * Pa",
    "kPa": "1000 * Pa",
    "MPa": "1000000 * Pa",
    "GPa": "1000000000 * Pa",
    "mbar": "100 * Pa",
    "bar": "100000 * Pa",
    "psi": "lbf / inch ** 2",
    "ksi": "1000 * psi",
}
"""Every unit in terms of the ones above it; factors are exact, pi but for its last bit."""

_OTHER_NAMES: Final[dict[str, str]] = {
    "kg": "kgs kilogram kilograms kilogramme kilogrammes",
    "gram": "grams gramme grammes",
    "t": "tonne tonnes metric_ton metric_tons",
    "lb": "lbs lbm pound pounds",
    "short_ton": "short_tons",
    "long_ton": "long_tons",
    "slug": "slugs",
    "um": "micron microns micrometre micrometres micrometer micrometers",
    "mm": "millimetre millimetres millimeter millimeters",
    "cm": "centimetre centimetres centimeter centimeters",
    "dm": "decimetre decimetres decimeter decimeters",
    "m": "metre metres meter meters",
    "km": "kilometre kilometres kilometer kilometers",
    "inch": "in inches",
    "ft": "foot feet",
    "yd": "yard yards",
    "mi": "mile miles",
    "L": "l litre litres liter liters",
    "US_gallon": "US_gal US_gallons",
    "imperial_gallon": "imperial_gal imperial_gallons",
    "us": "microsecond microseconds",
    "ms": "msec millisecond milliseconds",
    "s": "sec secs second seconds",
    "min": "mins minute minutes",
    "h": "hr hrs hour hours",
    "km/h": "kmh kph kmph",
    "mph": "MPH",
    "kn": "kt kts knot knots",
    "deg": "degree degrees",
    "rad": "radian radians",
    "rev": "revs revolution revolutions",
    "Hz": "hertz",
    "rpm": "RPM",
    "N": "newton newtons",
    "kN": "kilonewton kilonewtons",
    "MN": "meganewton meganewtons",
    "kgf": "kp",
    "kip": "kips klbf",
    "J": "joule joules",
    "kJ": "kilojoule kilojoules",
    "Pa": "pascal pascals",
    "kPa": "kilopascal kilopascals",
    "MPa": "megapascal megapascals",
    "GPa": "gigapascal gigapascals",
}
_STANDARD: Final = {name: unit for unit, names in _OTHER_NAMES.items() for name in names.split()}
NAMES: Final = frozenset((*DEFINITIONS, *_STANDARD)) - {"percent", "permille"}
"""Every accepted name; a percentage is a unit on its own and joins no others."""

READINGS: Final[dict[str, tuple[str, ...]]] = {
    "ton": ("metric ton", "short ton", "long ton"),
    "tons": ("metric tons", "short tons", "long tons"),
    "gal": ("US gal", "imperial gal"),
    "gallon": ("US gallon", "imperial gallon"),
    "gallons": ("US gallons", "imperial gallons"),
}
"""Names that stand for several units, and how to write each of them."""

_PHRASE = re.compile(r"\b(metric|short|long|US|imperial)[ _](tons?|gal|gallons?)\b")
_PERCENT: Final = {
    **dict.fromkeys(("%", "percent", "per cent", "pct"), "percent"),
    **dict.fromkeys(("‰", "permille", "per mille"), "permille"),
}
_FIRSTS: Final = ("kg", "t", "N", "daN", "kN", "MN", "lbf", "kip")
_SECONDS: Final = ("mm", "cm", "m", "s", "ft", "in")
_GLUED = re.compile(f"({'|'.join(_FIRSTS)})({'|'.join(_SECONDS)})")
_PAIRS: Final = tuple(first + second for first in _FIRSTS for second in _SECONDS)
"""Two symbols that people write as one word; no such word is a unit with a prefix, as `mN` or `mt` would be."""
_MOST_NAMES: Final = 6
"""In a unit whose case is put right; one with more is no slip of case."""
_WORD = re.compile(r"[A-Za-z]+")
_POWER: Final = r"(?:\^|\*\*)(?P<power>-?[1-9](?:\.[0-9])?)(?![0-9])|(?P<digit>[1-9](?:\.[0-9])?)(?![0-9])"
_FACTOR = re.compile(rf"(?P<name>[A-Za-z]+(?:_[A-Za-z]+)*)(?:{_POWER}|(?P<minus>-[1-9])(?![0-9]))?")
_BRACKET_END = re.compile(rf"\s*\)(?:{_POWER})?")
_JOINT = re.compile(r"\s*(?P<joint>/|\*|\.(?=[A-Za-z])|-(?=[A-Za-z])|(?=[A-Za-z(]))\s*")


class UnknownUnit(ValueError):  # noqa: N818 - reads as what is wrong with the text
    """A unit that cannot be read; `name` is the part of it that is none, empty where the form is at fault."""

    def __init__(self, text: str, name: str = "") -> None:
        super().__init__(text)
        self.name = name


@lru_cache(maxsize=512)
def standard_unit(text: str) -> str:
    """A unit in standard form, ``kg/m^3`` for ``kg·m⁻³``; what stands in brackets becomes one product.

    Products are a space, quotients one slash with brackets round several factors. Raises UnknownUnit.
    """
    plain = plain_signs(text).strip()
    if plain in _PERCENT:
        return _PERCENT[plain]
    plain = _PHRASE.sub(r"\1_\2", plain)
    plain = re.sub(r"^1\s*/\s*", "/", plain)
    plain = re.sub(r"\^[({](-?[0-9.]+)[)}]", r"^\1", plain)
    factors = _Reader(plain).factors()
    over = [_written(name, power) for name, power in factors if power > 0]
    under = [_written(name, -power) for name, power in factors if power < 0]
    if not under:
        return " ".join(over)
    bottom = under[0] if len(under) == 1 else f"({' '.join(under)})"
    return f"{' '.join(over) or '1'}/{bottom}"


def _written(name: str, power: float) -> str:
    return name if power == 1 else f"{name}^{power:g}"


class _Reader:
    """Reads a product of powers from left to right; a slash holds for the next factor or bracket alone."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.place = 0

    def factors(self) -> list[tuple[str, float]]:
        """Names and powers in the order they are written."""
        start = self.text.startswith("/")
        self.place = int(start)
        found = list(self._product(-1.0 if start else 1.0))
        if self.place != len(self.text) or not found:
            raise UnknownUnit(self.text)
        return found

    def _product(self, sign: float, *, inside: bool = False) -> Iterator[tuple[str, float]]:
        while True:
            bracket = self.text.startswith("(", self.place) and not inside
            yield from self._bracket(sign) if bracket else self._factor(sign)
            joint = _JOINT.match(self.text, self.place)
            if joint is None:
                return
            self.place = joint.end()
            sign = -1.0 if joint["joint"] == "/" else 1.0

    def _bracket(self, sign: float) -> list[tuple[str, float]]:
        """The factors of one bracket, which holds no other, to the power behind it."""
        self.place += 1
        inner = list(self._product(1.0, inside=True))
        end = _BRACKET_END.match(self.text, self.place)
        if end is None:
            raise UnknownUnit(self.text)
        self.place = end.end()
        whole = sign * float(end["power"] or end["digit"] or 1.0)
        return [(name, whole * power) for name, power in inner]

    def _factor(self, sign: float) -> Iterator[tuple[str, float]]:
        """One name with its power; of two symbols in one word the power is the second's."""
        match = _FACTOR.match(self.text, self.place)
        if match is None:
            raise UnknownUnit(self.text)
        if match["minus"] and "/" in self.text:  # m s-1 is a power, km/h-1 is anybody's guess
            raise UnknownUnit(self.text)
        self.place = match.end()
        power = float(match["power"] or match["digit"] or match["minus"] or 1.0)
        name = match["name"]
        glued = None if name in NAMES else _GLUED.fullmatch(name)
        if glued is not None:
            yield _STANDARD.get(glued[1], glued[1]), sign
            name = glued[2]
        if name not in NAMES:
            raise UnknownUnit(self.text, name)
        standard = _STANDARD.get(name, name)
        if "/" in standard:  # km/h as one word
            over, _, under = standard.partition("/")
            yield over, sign * power
            yield under, -sign * power
        else:
            yield standard, sign * power


def recased(unit: str) -> Iterator[str]:
    """`unit` with names in the case of the tables, where case is all that is wrong: ``KN m`` as ``kN m``.

    Single letters stay, and so do the first letters of short names where both cases are prefixes (``mN``, ``MN``).
    """
    names = _WORD.findall(unit)
    if len(names) > _MOST_NAMES:
        return
    choices = [[name] if name in NAMES or _GLUED.fullmatch(name) else list(_other_case(name)) for name in names]
    gaps = _WORD.split(unit)
    for chosen in itertools.product(*choices):
        yield "".join(part for pair in itertools.zip_longest(gaps, chosen, fillvalue="") for part in pair)


def _other_case(name: str) -> Iterator[str]:
    for known in (*NAMES, *_PAIRS):
        same = known.lower() == name.lower() and len(name) > 1
        if same and (known[0] == name[0] or name[0] not in "mMdD" or len(name) > 4):
            yield known
