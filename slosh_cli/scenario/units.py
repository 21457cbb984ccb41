"""Quantities as people write them (``80 km/h``, ``5 kN m``) to SI floats, and what to write instead of the others.

A remedy never changes a value: what stands after "write" is worth what the text can only have meant, or one of
the things that it can have meant; what stands after "such as" is an example.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from typing import Final

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.conversion import DIMENSIONS, PURE, STANDARD_GRAVITY, Dimension, convert, what_it_measures
from slosh_cli.scenario.numerals import NUMBER_PATTERN, Numeral, plain_signs, read_number
from slosh_cli.scenario.unit_names import NAMES, READINGS, UnknownUnit, recased, standard_unit

__all__ = [
    "DIMENSIONS", "NUMBER_PATTERN", "STANDARD_GRAVITY", "at_least", "at_most", "convert", "numeral_of", "offered",
    "parse_quantity", "percentage", "plain", "shown",
]  # fmt: skip

_COMMON = re.compile(rf"\s*({NUMBER_PATTERN})\s*([A-Za-z].*?)\s*")
"""Nearly every quantity, read without a detour."""
_LONGEST: Final = 200
"""Characters; nothing longer is a quantity."""
_UNCLEAR: Final = {("angular_frequency", "1/min"): ("rpm", "rad/min")}
"""Units that are read, but mean different things to different people."""


@dataclass(frozen=True)
class _Wanted:
    """What a text has to be: its dimension, the SI values the caller can use, and an example."""

    kind: Dimension
    fits: Callable[[float], bool] | None
    example: str

    @property
    def rule(self) -> str:
        return f"must be {self.kind.noun} with its unit, such as {_either(self.kind.units)}"

    @property
    def like(self) -> str:
        """An example that is plainly one."""
        return f"write a number and a unit, such as `{self.example}`"

    @property
    def finite(self) -> str:
        """The same where no unit is at fault."""
        return f"write a finite number and a unit, such as `{self.example}`"

    def accepts(self, number: str, unit: str) -> bool:
        try:
            value = convert(float(number), unit, self.kind.name)
        except ValueError:
            return False
        return math.isfinite(value) and (self.fits is None or self.fits(value))

    def offer(self, numbers: Iterable[str], units: Iterable[str]) -> str:
        """The numbers in the units, as far as the caller can use them; else an example."""
        numbers = tuple(numbers)
        pairs = itertools.product(numbers, units)
        texts = [f"{number} {unit}" for number, unit in pairs if self.accepts(number, unit)]
        sure = len(numbers) == 1 or len(texts) != 1
        return (offered(texts) + ("" if sure else " if that is meant")) or self.like


def offered(texts: list[str]) -> str:
    """``write `a` or `b`, whichever is meant``; empty where there is nothing to offer."""
    written = " or ".join([", ".join(f"`{text}`" for text in texts[:-1]), f"`{texts[-1]}`"] if texts[1:] else [])
    if not texts:
        return ""
    return f"write {written}, whichever is meant" if written else f"write `{texts[0]}`"


def numeral_of(text: str) -> Numeral | None:
    """The number that a text begins with and what follows it; None where there is none."""
    return read_number(plain_signs(text).strip()) if len(text) <= _LONGEST else None


def percentage(text: str) -> float | None:
    """The pure number that ``60 %`` stands for; None where the text is no percentage and no clear number."""
    numeral = numeral_of(text)
    if numeral is None or len(numeral.readings) > 1 or not numeral.rest:
        return None
    try:
        parts = PURE.get(standard_unit(numeral.rest))
    except UnknownUnit:
        return None
    return float(numeral.readings[0]) / parts if parts else None


def parse_quantity(
    text: object, dimension: str, fits: Callable[[float], bool] | None = None, example: str = ""
) -> float:
    """Read ``'80 km/h'`` and the like as an SI float.

    `dimension` is a key of DIMENSIONS. For ``acceleration`` the unit ``g`` is standard gravity, 9.81 m/s^2;
    everywhere else it is the gram. `fits` tells which SI values the caller could use, `example` is a quantity
    that would do; both only choose what to suggest. Raises ValueRefused with the rule, what was given and what
    to write.
    """
    kind = DIMENSIONS[dimension]
    common = _COMMON.fullmatch(text) if isinstance(text, str) and len(text) <= _LONGEST else None
    value = float(common[1]) * kind.factors.get(common[2], math.nan) if common else math.nan
    if math.isfinite(value):
        return value
    wanted = _Wanted(kind, fits, example or f"1 {kind.units[0]}")
    if not isinstance(text, str):
        raise _bare(text, wanted)
    numeral = numeral_of(text)
    if numeral is None:
        raise ValueRefused(wanted.rule, plain(text), wanted.finite)
    numbers, unit = numeral
    if not unit:
        raise ValueRefused(wanted.rule, f"{plain(text)} without a unit", wanted.offer(numbers, kind.units))
    try:
        unclear = _UNCLEAR.get((dimension, standard_unit(unit)))
        value = convert(float(numbers[0]), unit, dimension)
    except ValueError as error:
        given, fix = _unit_advice(numbers, unit, error, wanted)
        raise ValueRefused(wanted.rule, f"{plain(text.strip())}{given}", fix) from None
    if not math.isfinite(value):
        raise ValueRefused(wanted.rule, f"{plain(text)}, which overflows", wanted.finite)
    if unclear:
        about = f"{plain(text)}, which are turns to some people and radians to others"
        raise ValueRefused(wanted.rule, about, wanted.offer(numbers, unclear))
    if len(numbers) > 1:
        about = f"{plain(text.strip())}, whose comma can part thousands or decimals"
        raise ValueRefused(wanted.rule, about, wanted.offer(numbers, [unit]))
    return value


def _bare(value: object, wanted: _Wanted) -> ValueRefused:
    """The refusal of what is no text."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return ValueRefused(wanted.rule, plain(value), wanted.like)
    if not abs(value) < math.inf or abs(value) > 1e300:
        return ValueRefused(wanted.rule, plain(value), wanted.finite)
    fix = wanted.offer([str(value)], wanted.kind.units)
    return ValueRefused(wanted.rule, f"`{value}` without a unit", fix)


def _unit_advice(numbers: tuple[str, ...], unit: str, error: ValueError, wanted: _Wanted) -> tuple[str, str]:
    """(what is wrong with the unit, what to write) for a unit that was not accepted."""
    if not isinstance(error, UnknownUnit):
        noun = what_it_measures(unit)
        return f", which is {noun}" if noun else ", which has another dimension", wanted.like
    if error.name in READINGS:
        units = [re.sub(rf"\b{error.name}\b", reading, unit) for reading in READINGS[error.name]]
        return f", where `{error.name}` can be several units", wanted.offer(numbers, units)
    fix = wanted.like
    likely = [other for other in recased(unit) if wanted.accepts(numbers[0], other)]
    if len({convert(1.0, other, wanted.kind.name) for other in likely}) == 1:
        fix = wanted.offer(numbers, likely[:1])
    name = error.name or next((name for name in re.findall("[A-Za-z]+", unit) if name not in NAMES), "")
    return f", where `{name}` is no unit known here" if error.name else f", where `{unit}` cannot be read", fix


def shown(value: float) -> str:
    """A number for a message: at most six significant digits, no superfluous zeros."""
    return f"{value:.6g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")


def digits(value: float, count: int) -> str:
    """A number for a message, to so many digits and without an exponent."""
    return shown(float(f"{value:.{count}g}"))


def at_least(value: float) -> str:
    """A lower bound for a message: as `shown`, but never below the bound."""
    return _rounded(value, ROUND_CEILING)


def at_most(value: float) -> str:
    """An upper bound for a message: as `shown`, but never above the bound."""
    return _rounded(value, ROUND_FLOOR)


def _rounded(value: float, rounding: str) -> str:
    near = float(shown(value))
    if near == value or (near > value) == (rounding == ROUND_CEILING):
        return shown(value)
    return shown(float(Context(prec=6, rounding=rounding).create_decimal(Decimal(value))))


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


def _either(units: tuple[str, ...]) -> str:
    return " or ".join(f"`{unit}`" for unit in units)
