"""The kinds of single value a scenario holds: quantity, number, count; those of words are in `words`.

A leaf stands in the annotation of a model field (``Annotated[float, Quantity(...)]``). It checks the value,
words the refusal, and describes itself in the JSON schema. In values read from a file or a command line
(`Part.from_text`) a quantity has to carry its unit; models built in Python take plain SI floats.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Final

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.units import (
    DIMENSIONS,
    at_least,
    at_most,
    convert,
    numeral_of,
    offered,
    parse_quantity,
    percentage,
    plain,
    shown,
)

_PERCENT_PATTERN: Final = r"^\s*[+\-\u2212]?\.?[0-9].*(?:%|\u2030|per ?cent|pct|per ?mille)\s*$"


class SIValue(float):
    """A float already in SI, accepted where a file would have to give a unit."""


@dataclass(frozen=True)
class Judge:
    """What an annotation asks of a value before anything else looks at it."""

    def parse(self, value: object) -> Any:
        """The value, or what it stands for; ValueRefused where a rule is broken."""
        raise NotImplementedError

    def parse_python(self, value: object) -> Any:
        """The same of something given in Python."""
        return self.parse(value)

    def _validate(self, value: Any, info: core_schema.ValidationInfo) -> Any:
        try:
            return self.parse(value) if info.context else self.parse_python(value)
        except ValueRefused as refused:
            context = {"rule": refused.rule, "given": refused.given, "fix": refused.fix}
            raise PydanticCustomError("refused", "{rule}; given {given}; {fix}", context) from None

    def _before(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """The schema of the annotation `source` with the check ahead of it."""
        return core_schema.with_info_before_validator_function(self._validate, handler(source))

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return self._before(source, handler)


@dataclass(frozen=True)
class Leaf(Judge):
    """Base of the leaves: all that is asked of a single value."""

    def sample(self) -> str:
        """A value as a file may hold it."""
        raise NotImplementedError

    def advice(self, key: str) -> str:
        """What to write where the key is missing."""
        return f"write it, such as `{key}: {self.sample()}`"

    def written(self, value: Any, *, as_text: bool) -> Any:  # noqa: ARG002 - quantities differ
        """A checked value as plain data that reads back as it, with `as_text` as a file would hold it."""
        return _listed(value)

    def json_schema(self) -> dict[str, Any]:
        """What a JSON schema says about the value as a file holds it."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self._validate)

    def __get_pydantic_json_schema__(
        self, _core: core_schema.CoreSchema, _handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()


def _listed(value: Any) -> Any:
    return [_listed(entry) for entry in value] if isinstance(value, tuple) else value


@dataclass(frozen=True)
class Range:
    """The values allowed; an exclusive end is one that the value may approach but not take."""

    low: float
    high: float
    above: bool = False
    below: bool = False

    def __contains__(self, value: float) -> bool:
        return (self.low < value if self.above else self.low <= value) and (
            value < self.high if self.below else value <= self.high
        )

    def words(self, unit: str = "") -> str:
        """``from 100 kg to 2e4 kg``, in the given unit."""
        tail = f" {unit}" if unit else ""
        start = f"above {at_least(self.low)}{tail}" if self.above else f"from {at_least(self.low)}{tail}"
        end = f"below {at_most(self.high)}{tail}" if self.below else f"to {at_most(self.high)}{tail}"
        return f"{start} {'and' if self.above or self.below else ''} {end}".replace("  ", " ")


@dataclass(frozen=True)
class Quantity(Leaf):
    """A number with a unit, held as an SI float within `limits` (SI). `example` is what to write."""

    PATTERN: ClassVar[str] = (
        r"^\s*(?![+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?\s*$)[+\-\u2212]?\.?[0-9].*[A-Za-z\u00b0\u00b5\u03bc].*$"
    )
    """Of a text in a JSON schema: a number first and a letter somewhere behind it, but no bare number."""

    dimension: str
    limits: Range
    example: str
    nonzero: bool = False

    def sample(self) -> str:
        return self.example

    def written(self, value: Any, *, as_text: bool) -> Any:
        return f"{value!r} {self.unit}" if as_text else SIValue(value)

    def multiple(self, value: object, times: float) -> object:
        """A value of this leaf for a field that holds `times` less: a diameter for a radius."""
        return _Multiple(value, self, times)

    @property
    def unit(self) -> str:
        """The SI unit the value is held in."""
        return DIMENSIONS[self.dimension].unit

    def parse(self, value: object) -> float:
        if isinstance(value, SIValue):
            number = float(value)
        elif isinstance(value, _Multiple):
            return value.share(value.leaf.parse(value.value))
        else:
            number = parse_quantity(value, self.dimension, self._accepts, self.example)
        if number == 0.0 and self.nonzero:
            raise ValueRefused("must not be zero", plain(value), f"write a value such as `{self.example}`")
        if number in self.limits:
            return number
        noun = DIMENSIONS[self.dimension].noun
        given = plain(value) if isinstance(value, str) else f"`{_beyond(number, self.limits)} {self.unit}`"
        if isinstance(value, str) and f"{shown(number)} {self.unit}" != value.strip():
            given += f" = {_beyond(number, self.limits)} {self.unit}"
        raise ValueRefused(f"must be {noun} {self.limits.words(self.unit)}", given, self._range_fix(value))

    def parse_python(self, value: object) -> float:
        if isinstance(value, _Multiple):
            return value.share(value.leaf.parse_python(value.value))
        bare = isinstance(value, int | float) and not isinstance(value, bool)
        return self.parse(SIValue(value) if bare else value)  # type: ignore[arg-type]

    def _accepts(self, number: float) -> bool:
        return number in self.limits and not (self.nonzero and number == 0.0)

    def _range_fix(self, value: object) -> str:
        """An example; and the unit that was probably meant, if the same number fits in it."""
        fix = f"write a value within the range, such as `{self.example}`"
        numeral = numeral_of(value) if isinstance(value, str) else None
        if numeral is not None and len(numeral.readings) == 1:
            for unit in DIMENSIONS[self.dimension].units:
                if self._accepts(convert(float(numeral.readings[0]), unit, self.dimension)):
                    return f"{fix}, or is its unit meant to be `{unit}`?"
        return fix

    def json_schema(self) -> dict[str, Any]:
        kind = DIMENSIONS[self.dimension]
        return {
            "type": "string",
            "pattern": self.PATTERN,
            "examples": [self.example],
            "x-unit": kind.unit,
            "x-range": self.limits.words(kind.unit),
        }


@dataclass(frozen=True)
class _Multiple:
    """A value with the leaf that it was written for, `times` as large as another's."""

    value: object
    leaf: Quantity
    times: float

    def share(self, number: float) -> float:
        """What the field holds."""
        return number / self.times


def _beyond(number: float, limits: Range) -> str:
    """A number outside its limits, with as many digits as it takes to see that."""
    return shown(number) if float(shown(number)) not in limits else repr(number)


def _finite_number(value: object, rule: str, example: str, fits: Callable[[float], bool]) -> float:
    """A plain number as float; ValueRefused for text, truth values, containers, nan and infinity."""
    if isinstance(value, str):
        raise ValueRefused(rule, *_text_for_number(value, example, fits))
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueRefused(rule, plain(value), f"write a number, such as `{example}`")
    if not abs(value) <= sys.float_info.max:
        raise ValueRefused(rule, plain(value), f"write a finite number, such as `{example}`")
    return float(value)


def _text_for_number(value: str, example: str, fits: Callable[[float], bool]) -> tuple[str, str]:
    """(given, fix) where text stands in place of a pure number."""
    numeral = numeral_of(value)
    if numeral is None:
        return plain(value), f"write a number, such as `{example}`"
    if numeral.rest:
        return plain(value), f"write a number without a unit, such as `{example}`"
    fix = offered([number for number in numeral.readings if fits(float(number))])
    if numeral.readings[0] == value.strip():
        fix = fix.replace("write", "write it without quotes:", 1)
    quoted = f"'{value}'"
    return f"the text {plain(quoted)}", fix or f"write a number, such as `{example}`"


@dataclass(frozen=True)
class Number(Leaf):
    """A dimensionless number within `limits`; in a file a percentage such as ``60 %`` is one too."""

    limits: Range
    example: str

    def sample(self) -> str:
        return self.example

    def parse(self, value: object) -> float:
        rule = f"must be a number {self.limits.words()}"
        share = percentage(value) if isinstance(value, str) else None
        number = _finite_number(value, rule, self.example, self.limits.__contains__) if share is None else share
        if number not in self.limits:
            beyond = _beyond(number, self.limits)
            given = f"`{beyond}`" if share is None else f"{plain(value)} = {beyond}"
            fix = f"write a number within the range, such as `{self.example}`"
            if share is None and number / 100 in self.limits:
                fix += ", or is it meant in `%`?"
            raise ValueRefused(rule, given, fix)
        return number

    def json_schema(self) -> dict[str, Any]:
        low = "exclusiveMinimum" if self.limits.above else "minimum"
        high = "exclusiveMaximum" if self.limits.below else "maximum"
        number = {"type": "number", low: self.limits.low, high: self.limits.high}
        return {"anyOf": [number, {"type": "string", "pattern": _PERCENT_PATTERN}]}


@dataclass(frozen=True)
class Count(Leaf):
    """A whole number from `low` to `high`."""

    low: int
    high: int

    def sample(self) -> str:
        return str(self.low)

    def parse(self, value: object) -> int:
        rule = f"must be a whole number from {self.low} to {self.high}"
        number = _finite_number(value, rule, str(self.low), self._accepts)
        if not self._accepts(number):
            raise ValueRefused(rule, plain(value), f"write a whole number within the range, such as `{self.low}`")
        return round(number)

    def _accepts(self, number: float) -> bool:
        return math.isfinite(number) and number == round(number) and self.low <= number <= self.high

    def json_schema(self) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.low, "maximum": self.high}
