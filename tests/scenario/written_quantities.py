"""Quantities in every spelling, each with the value that it has by this file's own table of units."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from fractions import Fraction

Unit = list[tuple[str, int]]
"""Names with their powers."""

SYMBOLS: dict[str, tuple[float | Fraction, tuple[int, int, int]]] = {
    "kg": (1, (1, 0, 0)), "g": (Fraction(1, 1000), (1, 0, 0)), "t": (1000, (1, 0, 0)), "tonnes": (1000, (1, 0, 0)),
    "lb": (Fraction("0.45359237"), (1, 0, 0)), "m": (1, (0, 1, 0)), "mm": (Fraction(1, 1000), (0, 1, 0)),
    "cm": (Fraction(1, 100), (0, 1, 0)), "km": (1000, (0, 1, 0)), "metres": (1, (0, 1, 0)),
    "in": (Fraction("0.0254"), (0, 1, 0)), "ft": (Fraction("0.3048"), (0, 1, 0)), "yd": (Fraction("0.9144"), (0, 1, 0)),
    "s": (1, (0, 0, 1)), "ms": (Fraction(1, 1000), (0, 0, 1)), "min": (60, (0, 0, 1)), "h": (3600, (0, 0, 1)),
    "N": (1, (1, 1, -2)), "kN": (1000, (1, 1, -2)), "MN": (10**6, (1, 1, -2)), "daN": (10, (1, 1, -2)),
    "lbf": (Fraction("4.4482216152605"), (1, 1, -2)), "kgf": (Fraction("9.80665"), (1, 1, -2)),
    "Pa": (1, (1, -1, -2)), "MPa": (10**6, (1, -1, -2)), "GPa": (10**9, (1, -1, -2)), "bar": (10**5, (1, -1, -2)),
    "psi": (Fraction("4.4482216152605") / Fraction("0.0254") ** 2, (1, -1, -2)), "J": (1, (1, 2, -2)),
    "knots": (Fraction(1852, 3600), (0, 1, -1)), "mph": (Fraction("0.44704"), (0, 1, -1)),
    "Hz": (2 * math.pi, (0, 0, -1)), "rpm": (math.pi / 30, (0, 0, -1)), "L": (Fraction(1, 1000), (0, 3, 0)),
}  # fmt: skip

UNITS: dict[str, list[Unit]] = {
    "mass": [[("kg", 1)], [("g", 1)], [("t", 1)], [("tonnes", 1)], [("lb", 1)]],
    "length": [[("m", 1)], [("mm", 1)], [("cm", 1)], [("km", 1)], [("metres", 1)], [("in", 1)], [("ft", 1)]],
    "time": [[("s", 1)], [("ms", 1)], [("min", 1)], [("h", 1)]],
    "speed": [[("km", 1), ("h", -1)], [("m", 1), ("s", -1)], [("knots", 1)], [("mph", 1)]],
    "acceleration": [[("m", 1), ("s", -2)], [("ft", 1), ("s", -2)]],
    "angular_frequency": [[("Hz", 1)], [("rpm", 1)]],
    "force": [[("N", 1)], [("kN", 1)], [("daN", 1)], [("lbf", 1)], [("kgf", 1)]],
    "torque": [[("N", 1), ("m", 1)], [("kN", 1), ("m", 1)], [("lbf", 1), ("ft", 1)], [("N", 1), ("mm", 1)], [("J", 1)]],
    "modulus": [[("Pa", 1)], [("GPa", 1)], [("N", 1), ("mm", -2)], [("psi", 1)], [("bar", 1)], [("kN", 1), ("cm", -2)]],
    "density": [[("kg", 1), ("m", -3)], [("g", 1), ("cm", -3)], [("t", 1), ("m", -3)], [("kg", 1), ("L", -1)],
                [("lb", 1), ("ft", -3)]],
    "mass_per_length": [[("kg", 1), ("m", -1)], [("lb", 1), ("yd", -1)], [("t", 1), ("km", -1)]],
    "first_moment": [[("kg", 1), ("m", 1)], [("t", 1), ("m", 1)]],
    "moment_of_inertia": [[("kg", 1), ("m", 2)], [("t", 1), ("m", 2)], [("lb", 1), ("ft", 2)]],
    "second_moment": [[("m", 4)], [("cm", 4)], [("mm", 4)], [("in", 4)]],
    "stiffness": [[("N", 1), ("m", -1)], [("kN", 1), ("mm", -1)], [("MN", 1), ("m", -1)], [("lbf", 1), ("in", -1)]],
    "damping": [[("N", 1), ("s", 1), ("m", -1)], [("kN", 1), ("s", 1), ("m", -1)]],
    "quadratic_resistance": [[("N", 1), ("s", 2), ("m", -2)], [("kN", 1), ("s", 2), ("m", -2)]],
    "stiffness_per_length": [[("N", 1), ("m", -2)], [("MN", 1), ("m", -2)], [("MPa", 1)]],
    "damping_per_length": [[("N", 1), ("s", 1), ("m", -2)], [("kN", 1), ("s", 1), ("m", -2)]],
    "shear_damping": [[("N", 1), ("s", 1)], [("kN", 1), ("s", 1)]],
    "inverse_speed": [[("s", 1), ("m", -1)], [("h", 1), ("km", -1)]],
}  # fmt: skip

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_PRODUCTS = (" ", "·", "⋅", "*", "-", ".", " * ", "\u00a0")


@dataclass(frozen=True)
class Written:
    """A quantity in two pieces, with the SI values that it can mean: two where a comma is unclear."""

    number: str
    unit: str
    values: tuple[float, ...]

    @property
    def text(self) -> str:
        """The whole."""
        return self.number + self.unit


def factor(unit: Unit) -> float:
    """SI value of one of a unit, by SYMBOLS alone."""
    return float(math.prod((SYMBOLS[name][0] ** power for name, power in unit), start=Fraction(1)))


def measures(unit: Unit) -> tuple[int, ...]:
    """Exponents of mass, length and time."""
    return tuple(sum(SYMBOLS[name][1][k] * power for name, power in unit) for k in range(3))


def spelt_unit(unit: Unit, chance: random.Random) -> str:
    """The unit in one of the ways in which people join names and powers."""
    product, power = chance.choice(_PRODUCTS), chance.choice(("^{}", "**{}", "{}", "raised"))
    slash = chance.random() < 0.5

    def one(name: str, exponent: int) -> str:
        if exponent == 1:
            return name
        return name + (str(exponent).translate(_RAISED) if power == "raised" else power.format(exponent))

    over = product.join(one(name, exponent) for name, exponent in unit if exponent > 0)
    under = [one(name, -exponent if slash else exponent) for name, exponent in unit if exponent < 0]
    if not under:
        return over
    return over + ("/" if slash else product) + "".join(under)


def spelt_number(chance: random.Random) -> tuple[str, tuple[float, ...]]:  # noqa: PLR0911 - one per spelling
    """A number in one of the ways in which people write them, and what it can mean."""
    whole = str(chance.randrange(1, 10 ** chance.randrange(1, 8)))
    digits = "".join(chance.choice("0123456789") for _ in range(chance.randrange(1, 5)))
    exponent = chance.randrange(-6, 9)
    sign = chance.choice(("", "", "", "-", "\u2212"))
    value = float(f"{'-' if sign else ''}{whole}.{digits}")
    groups = [whole[max(0, end - 3) : end] for end in range(len(whole), 0, -3)][::-1]
    match chance.randrange(8):
        case 0:
            return f"{sign}{whole}.{digits}", (value,)
        case 1 if len(groups) > 1:
            gap = chance.choice((" ", "\u00a0", "\u202f", "\u2009", "'", "’"))
            return f"{sign}{gap.join(groups)}{chance.choice('.,')}{digits}", (value,)
        case 2:
            readings = (value, float(f"{'-' if sign else ''}{whole}{digits}"))
            both = len(digits) == 3 and len(whole) <= 3
            return f"{sign}{whole},{digits}", readings if both else readings[:1]
        case 3 if len(groups) > 1:
            point, comma = chance.choice((".,", ",."))
            return f"{sign}{point.join(groups)}{comma}{digits}", (value,)
        case 4:
            return f"{sign}{whole}.{digits}e{exponent}", (float(f"{value!r}e{exponent}"),)
        case 5:
            raised = chance.choice((str(exponent).translate(_RAISED), f"^{exponent}"))
            times = chance.choice((" × ", "·", " x ", "*"))
            return f"{sign}{whole}.{digits}{times}10{raised}", (float(f"{value!r}e{exponent}"),)
        case _:
            return f"{sign}{whole}", (float(f"{'-' if sign else ''}{whole}"),)


def quantity(unit: Unit, chance: random.Random) -> Written:
    """A random number in a unit, spelt in one of the ways in which people write it."""
    number, values = spelt_number(chance)
    gap = chance.choice((" ", "", " ", "\u00a0"))
    return Written(f"{number}{gap}", spelt_unit(unit, chance), tuple(value * factor(unit) for value in values))


def slip(unit: str, chance: random.Random) -> str:
    """The unit with one letter in the other case, left out (unless it is the only one), doubled or changed."""
    places = [place for place, letter in enumerate(unit) if letter.isascii() and letter.isalpha()]
    place = chance.choice(places)
    letter = unit[place]
    without = "" if len(places) > 1 else letter * 3
    new = chance.choice((letter.swapcase(), letter.swapcase(), without, letter * 2, chance.choice("kmMgNtxs")))
    return unit[:place] + new + unit[place + 1 :]
