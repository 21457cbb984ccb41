"""The kinds of single value a scenario holds: quantity, number, count, choice, text, coordinates.

A leaf stands in the annotation of a model field (``Annotated[float, Quantity(...)]``). It checks the value,
words the refusal, and describes itself in the JSON schema. Values read from a file or a command line are
validated with the context FROM_TEXT, where a quantity has to carry its unit; models built in Python take
plain SI floats.
"""

from __future__ import annotations

import difflib
import math
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.scalars import well_formed
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

FROM_TEXT: Final[dict[str, bool]] = {"units_required": True}
QUANTITY_PATTERN: Final = (
    r"^\s*(?![+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?\s*$)[+\-\u2212]?\.?[0-9].*[A-Za-z\u00b0\u00b5\u03bc].*$"
)
"""Of a text in a JSON schema: a number first and a letter somewhere behind it, but no bare number."""
PERCENT_PATTERN: Final = r"^\s*[+\-\u2212]?\.?[0-9].*(?:%|\u2030|per ?cent|pct|per ?mille)\s*$"


class SIValue(float):
    """A float already in SI, accepted where a file would have to give a unit."""


def refused_error(refused: ValueRefused) -> PydanticCustomError:
    """A refusal in the form pydantic collects."""
    context = {"rule": refused.rule, "given": refused.given, "fix": refused.fix}
    return PydanticCustomError("refused", "{rule}; given {given}; {fix}", context)


@dataclass(frozen=True)
class Leaf:
    """Base of the leaves."""

    def parse(self, value: object) -> Any:
        """The checked value of something read from a file; ValueRefused where a rule is broken."""
        raise NotImplementedError

    def parse_python(self, value: object) -> Any:
        """The checked value of something given in Python."""
        return self.parse(value)

    def json_schema(self) -> dict[str, Any]:
        """What a JSON schema says about the value as a file holds it."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, _source: Any, _handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        def validate(value: Any, info: core_schema.ValidationInfo) -> Any:
            try:
                return self.parse(value) if _from_text(info.context) else self.parse_python(value)
            except ValueRefused as refused:
                raise refused_error(refused) from None

        return core_schema.with_info_plain_validator_function(validate)

    def __get_pydantic_json_schema__(
        self, _core: core_schema.CoreSchema, _handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()


def _from_text(context: Any) -> bool:
    return bool(context and context.get("units_required"))


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

    dimension: str
    limits: Range
    example: str
    nonzero: bool = False

    @property
    def unit(self) -> str:
        """The SI unit the value is held in."""
        return DIMENSIONS[self.dimension].unit

    def parse(self, value: object) -> float:
        if isinstance(value, SIValue):
            number = float(value)
        elif isinstance(value, Multiple):
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
        if isinstance(value, Multiple):
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
            "pattern": QUANTITY_PATTERN,
            "examples": [self.example],
            "x-unit": kind.unit,
            "x-range": self.limits.words(kind.unit),
        }


@dataclass(frozen=True)
class Multiple:
    """A value that was written under another key, `times` as large as the field's: a diameter for a radius."""

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
        return {"anyOf": [number, {"type": "string", "pattern": PERCENT_PATTERN}]}


@dataclass(frozen=True)
class Count(Leaf):
    """A whole number from `low` to `high`."""

    low: int
    high: int

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


@dataclass(frozen=True)
class Version(Leaf):
    """The version of the scenario format."""

    supported: int

    def parse(self, value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int | float) or value != self.supported:
            rule = f"must be {self.supported}, the only scenario format this version reads"
            raise ValueRefused(rule, plain(value), f"write `{self.supported}`")
        return self.supported

    def json_schema(self) -> dict[str, Any]:
        return {"const": self.supported}


@dataclass(frozen=True)
class Choice(Leaf):
    """One of a few words."""

    options: tuple[str, ...]

    def parse(self, value: object) -> str:
        if isinstance(value, str) and value in self.options:
            return value
        raise not_an_option(value, self.options)

    def json_schema(self) -> dict[str, Any]:
        return {"enum": list(self.options)}


def not_an_option(value: object, options: Sequence[str]) -> ValueRefused:
    """The refusal of a word that is none of `options`, with a guess at the intended one."""
    listed = one_of(options)
    rule = f"must be {listed}"
    return ValueRefused(rule, plain(value), f"write {guess(value, options) or listed}")


def one_of(options: Sequence[str]) -> str:
    """``a, b or c``, each in back quotes."""
    quoted = [f"`{option}`" for option in options]
    return " or ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)


def guess(value: object, options: Sequence[str]) -> str:
    """The closest option in back quotes, or empty."""
    if not isinstance(value, str):
        return ""
    text = value.lower().replace("_", "-").replace(" ", "-")
    plain_forms = {option.lower().replace("_", "-"): option for option in options}
    near = difflib.get_close_matches(text, plain_forms, 1, cutoff=0.6)
    return f"`{plain_forms[near[0]]}`" if near else ""


@dataclass(frozen=True)
class Text(Leaf):
    """Text of at most `longest` characters; a `pattern` comes with the `words` that describe it."""

    longest: int
    pattern: str = ""
    words: str = ""
    repair: Callable[[str], str] | None = None

    def parse(self, value: object) -> str:
        rule = f"must be text of at most {self.longest} characters{self.words}"
        if not isinstance(value, str):
            quoted = isinstance(value, int | float)
            written = str(value).lower() if isinstance(value, bool) else str(value)
            fix = f'write it in quotes: `"{written}"`' if quoted else "write text"
            raise ValueRefused(rule, plain(value), fix)
        if len(value) > self.longest:
            raise ValueRefused(rule, f"{len(value)} characters", "shorten it")
        lone = well_formed(value)[1]
        if lone:
            raise ValueRefused("must be text that can be written as UTF-8", f"`{lone}` in it", "write it in UTF-8")
        if self.pattern and not re.fullmatch(self.pattern, value):
            better = self.repair(value) if self.repair else ""
            raise ValueRefused(rule, plain(value), f"write `{better}`" if better else "write a name such as `stop-1`")
        return value

    def json_schema(self) -> dict[str, Any]:
        pattern = {"pattern": f"^{self.pattern}$"} if self.pattern else {}
        return {"type": "string", "maxLength": self.longest, **pattern}


def file_safe(text: str) -> str:
    """The nearest name that can be a folder: ``my stop/2`` becomes ``my-stop-2``."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip("-._")[:100]


NAME: Final = Text(
    longest=100,
    pattern=r"[A-Za-z0-9][A-Za-z0-9._-]*",
    words=" that can name a folder: letters, digits, `.`, `-` and `_`, a letter or digit first",
    repair=file_safe,
)
