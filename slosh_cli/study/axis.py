"""What a study varies: one key of the scenario and the values it takes, from texts such as ``10:14:1 m``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Final

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.unit_names import UnknownUnit, standard_unit
from slosh_cli.scenario.units import NUMBER_PATTERN, numeral_of, percentage

_MOST_VALUES: Final = 100_000
"""Values of one axis; more are a slip in the step."""

_MEASURE = re.compile(rf"({NUMBER_PATTERN})\s*([^\s0-9.,:\[{{][^:]*|)")
_OPENING, _CLOSING, _QUOTES = "[{(", "]})", "'\""


@dataclass(frozen=True)
class Axis:
    """One key of the scenario and its values, as texts that read like those of a scenario file.

    `source` says where a person wrote it: an option (``--vary tank.fill``), or a file, with its `line`.
    """

    key: str
    values: tuple[str, ...]
    source: str
    line: int | None = None

    @property
    def unit(self) -> str:
        """The unit that all values share, in standard form; empty for pure numbers, words and mixtures."""
        units = {measure[1] if measure else "" for measure in map(_told, self.values)}
        return units.pop() if len(units) == 1 else ""

    def plain(self, position: int) -> float | str:
        """The value at `position` as a number in `unit`, or as text where the axis has no number there."""
        measure = _told(self.values[position])
        if measure is None or measure[1] != self.unit:
            return self.values[position]
        return measure[0]


def measured(text: str) -> tuple[float, str] | None:
    """Number and unit of a text such as ``10 km/h``, None where it is something else."""
    match = _MEASURE.fullmatch(text.strip())
    return (float(match[1]), match[2].strip()) if match else None


def _told(text: str) -> tuple[float, str] | None:
    """Number and unit of a value as a table tells it: ``21 300 kg·m⁻³`` as 21300 ``kg/m^3``, ``60 %`` as 0.6."""
    share, numeral = percentage(text), numeral_of(text)
    if share is not None:
        return share, ""
    if numeral is None or len(numeral.readings) > 1:
        return None
    try:
        return float(numeral.readings[0]), standard_unit(numeral.rest) if numeral.rest else ""
    except UnknownUnit:
        return measured(text)


def expanded(spec: str, bare_unit: str = "") -> tuple[str, ...]:
    """The values that a list (``80,160``, ``dry,wet``) or a range (``start:stop:step``, both ends in) stands for.

    A bare number takes the unit of the next entry that has one (``10,12,14 m``), else `bare_unit`.
    A value given twice counts once. Raises ValueRefused for what is neither list nor range.
    """
    entries = [entry.strip() for entry in _split(spec, ",")]
    if not all(entries):
        rule = "must be a list such as `80,160` or a range `start:stop:step`"
        raise ValueRefused(rule, f"`{spec}`", "write a value on both sides of every comma")
    groups: list[list[str]] = []
    unit = bare_unit
    for entry in reversed(entries):
        parts = [part.strip() for part in _split(entry, ":")]
        known = [measure for measure in map(measured, parts) if measure is not None]
        numeric = len(known) == len(parts)
        unit = (known[-1][1] or unit) if numeric else unit
        if numeric and len(parts) > 1:
            groups.append(_counted(entry, parts, unit))
        else:
            groups.append([f"{entry} {unit}" if numeric and unit and not known[0][1] else entry])
    return tuple(dict.fromkeys(value for group in reversed(groups) for value in group))


def _listed(values: Sequence[Any]) -> tuple[str, ...]:
    """The values of a list in a study file, as texts. Raises ValueRefused where a value has no text."""
    if not values:
        raise ValueRefused("must be a list of at least one value", "an empty list", "write the values to take")
    return tuple(dict.fromkeys(_as_text(value) for value in values))


def axis_values(spec: Any) -> tuple[str, ...]:
    """The values that a study file or a script gives: a text as for `expanded`, any other value, a list of both."""
    if isinstance(spec, str):
        return expanded(spec)
    entries = spec if isinstance(spec, list | tuple) else [spec]
    groups = [expanded(entry) if isinstance(entry, str) else _listed([entry]) for entry in entries]
    return _listed([text for group in groups for text in group])


def _as_text(value: Any) -> str:
    """A value of a file as YAML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_as_text(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_as_text(entry) for entry in value) + "]"
    if isinstance(value, bool) or value is None:
        return "null" if value is None else str(value).lower()
    return repr(value) if isinstance(value, float) else str(value)


def _split(text: str, separator: str) -> Iterator[str]:
    """Parts of `text` between separators outside brackets and quotes."""
    depth, quote, start = 0, "", 0
    for place, letter in enumerate(text):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in _QUOTES:
            quote = letter
        elif letter == separator and depth == 0:
            yield text[start:place]
            start = place + 1
        else:
            depth += (letter in _OPENING) - (letter in _CLOSING)
    yield text[start:]


def _counted(entry: str, parts: list[str], unit: str) -> list[str]:
    """The values of a range, whose numbers may be beyond what can be counted with."""
    try:
        return _range(entry, parts, unit)
    except ArithmeticError:
        rule = "must be a range whose numbers can be counted through"
        raise ValueRefused(rule, f"`{entry}`", "write numbers of an ordinary size, such as `2.5:30:2.5`") from None


def _range(entry: str, parts: list[str], unit: str) -> list[str]:
    """Values from start to stop, both in, in steps; exact decimals, so that 0.3 is 0.3."""
    given = f"`{entry}`"
    if len(parts) != 3:
        raise ValueRefused("must be a range `start:stop:step`", given, "write all three, such as `2.5:30:2.5`")
    numbers, units = zip(*(_number_and_unit(part) for part in parts), strict=True)
    if {written for written in units if written} - {unit}:
        raise ValueRefused(
            "must have one unit in a range", given, "write the unit once, at the end, such as `10:14:1 m`"
        )
    start, stop, step = numbers
    if step == 0 or (stop - start) * step < 0:
        rule = "must have a step that leads from start to stop"
        raise ValueRefused(rule, given, "write a step of the right sign, not zero")
    if abs(stop - start) > (_MOST_VALUES - 1) * abs(step):
        raise ValueRefused(f"must have at most {_MOST_VALUES} values", given, "widen the step")
    count = round((stop - start) / step)
    if abs((stop - start) / step - count) > Decimal("1e-9") * max(count, 1):
        last = f"{_decimal(start + int((stop - start) / step) * step)}:{_decimal(step)}{unit and f' {unit}'}"
        rule = "must reach its stop in whole steps, because both ends count"
        raise ValueRefused(
            rule, given, f"write a stop within reach, such as `{_decimal(start)}:{last}`, or another step"
        )
    texts = [_decimal(start + k * step) for k in range(count)] + [_decimal(stop)]
    return [f"{text} {unit}" if unit else text for text in texts]


def _number_and_unit(part: str) -> tuple[Decimal, str]:
    match = _MEASURE.fullmatch(part)
    assert match is not None  # the caller has measured it
    return Decimal(match[1]), match[2].strip()


def _decimal(number: Decimal) -> str:
    normal = number.normalize()
    exponent = normal.as_tuple().exponent
    return f"{normal:f}" if isinstance(exponent, int) and abs(exponent) < 15 else str(normal)
