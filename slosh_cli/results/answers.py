"""Answers: declared once, beside the attribute that holds them; files, tables, JSON and terminal derive from that line.

A class of answers (a run, a vehicle, a coupling) says ``weight_N: float = computed("N", "weight of wagon and load")``.
JSON and HDF5 take them in the order of the class, tables in that of `Place`, the terminal in that of `Told.at`.
"""

import json
from collections.abc import Callable
from dataclasses import KW_ONLY, MISSING, dataclass, field, fields, replace
from enum import Flag, IntEnum, auto
from operator import attrgetter
from typing import Any, ClassVar, Literal, dataclass_transform

import numpy as np

from slosh_cli.results.channels import WHEELS

PerWheel = tuple[float, ...]
"""One number per wheel, wheel 1 first."""
_ANSWER = "answer"
"""Where an attribute keeps its answer."""


class Shown(Flag):
    """Outputs that show an answer: `slosh run --json`, `summary.csv`, a study's table, attributes of `run.h5`."""

    JSON = auto()
    SUMMARY = auto()
    STUDY = auto()
    HISTORY = auto()


class Place(IntEnum):
    """Where the column of an answer stands in a table, from left to right."""

    NAME = auto()
    CONDITIONS = auto()
    DISTANCE = auto()
    STATUS = auto()
    RANGE = auto()
    SURFACE = auto()
    WHEELS = auto()
    RUN = auto()
    WORDS = auto()


@dataclass(frozen=True)
class Told:
    """An answer on the terminal: the lowest `at` comes first, `form` formats a number counted in `per` SI units."""

    at: int
    label: str
    form: str = ""
    unit: str = ""
    per: float = 1.0


@dataclass(frozen=True)
class Answer:
    """One answer: its SI `unit` ("1" without one, "" for what is no number) and its `meaning`.

    name, kind: name and type of its attribute.
    place, column, per: its column in tables, by another name and counted in `per` SI units where that is usual.
    given: key path in the scenario that it is taken from; of: how it follows from other answers; else it is computed.
    needed: whether a file without it is no history of a run; optional: JSON leaves it out where there is none.
    """

    unit: str
    meaning: str
    place: Place = Place.RUN
    _: KW_ONLY
    shown: Shown = ~Shown(0)
    column: str = ""
    per: float = 1.0
    given: str = ""
    of: Callable[[Any], Any] | None = None
    needed: bool = False
    optional: bool = False
    line: Told | None = None
    name: str = ""
    kind: Any = None

    @property
    def columns(self) -> tuple[str, ...]:
        """Its columns in tables, the unit in the name: one, or one per wheel."""
        if self.kind != PerWheel:
            return (self.column or self.name,)
        unit = "" if self.unit == "1" else "_" + self.unit.replace(" ", "_").replace("/", "_")
        return tuple(f"{self.name.removesuffix(unit)}_{i}{unit}" for i in WHEELS)

    def value_in(self, record: Any) -> Any:
        """Its value in a record whose scenario and computed answers are there."""
        return self.of(record) if self.of else attrgetter(self.given)(record.scenario)

    def cells(self, value: Any) -> dict[str, Any]:
        """Column name -> `value` as tables have it."""
        if self.kind == PerWheel:
            return dict(zip(self.columns, value, strict=True))
        if self.per != 1.0:  # without the rounding that a change of units leaves behind (80.00000000000001 km/h)
            value = float(f"{value / self.per:.12g}")
        return {self.columns[0]: "; ".join(value) if isinstance(value, tuple) else _plain(value)}

    def attribute(self, value: Any) -> Any:
        """`value` as an attribute of a file: NaN for no number, several texts as lines, verdicts as JSON."""
        if value is None:
            return np.nan if self.unit else ""
        if self.kind == tuple[str, ...]:
            return "\n".join(" ".join(text.split()) for text in value)
        if isinstance(value, tuple) and not self.unit:
            return json.dumps(_plain(value))
        return getattr(value, "sentence", None) or _plain(value)


def computed(unit: str, meaning: str, place: Place = Place.RUN, *, default_factory: Any = MISSING, **how: Any) -> Any:
    """An attribute that is computed with its record; `how` as in `Answer`."""
    return field(default_factory=default_factory, metadata={_ANSWER: Answer(unit, meaning, place, **how)})


def derived(unit: str, meaning: str, place: Place = Place.RUN, *, init: Literal[False] = False, **how: Any) -> Any:
    """An attribute that follows from the scenario (`given`) or from others (`of`)."""
    return field(init=init, metadata={_ANSWER: Answer(unit, meaning, place, **how)})


@dataclass_transform(
    eq_default=False, kw_only_default=True, frozen_default=True, field_specifiers=(computed, derived, field)
)
class Answers:
    """Base of every class of answers, which becomes a frozen dataclass whose attributes are given by name."""

    def __init_subclass__(cls) -> None:
        made: Any = dataclass(frozen=True, eq=False, kw_only=True, repr=False)(cls)
        found = (replace(one.metadata[_ANSWER], name=one.name, kind=one.type) for one in fields(made) if one.metadata)
        cls._answers = tuple(found)

    _answers: ClassVar[tuple[Answer, ...]] = ()

    @classmethod
    def table(cls, shown: Shown | None = None) -> tuple[Answer, ...]:
        """Every answer in the order of the class, or those of one output."""
        return tuple(one for one in cls._answers if shown is None or shown in one.shown)

    @classmethod
    def in_table(cls, shown: Shown, first: Place = Place.NAME, last: Place = Place.WORDS) -> list[Answer]:
        """The answers of a table of such records in the order of its columns, from one place to another."""
        return sorted((one for one in cls.table(shown) if first <= one.place <= last), key=lambda one: one.place)

    def row(self, shown: Shown) -> dict[str, Any]:
        """The row of a table: column name (with unit) -> value, None where there is no answer."""
        cells = (one.cells(getattr(self, one.name)) for one in self.in_table(shown))
        return {column: value for some in cells for column, value in some.items()}

    def as_dict(self) -> dict[str, Any]:
        """The answers as JSON has them, by name; None where a number is missing."""
        held = self._held(Shown.JSON)
        return {one.name: _plain(v) for one, v in held if v is not None or (one.unit and not one.optional)}

    def as_attributes(self) -> dict[str, Any]:
        """The answers as attributes of a file, by name."""
        return {one.name: one.attribute(value) for one, value in self._held(Shown.HISTORY)}

    def _derive(self) -> None:
        """Put in what follows from the scenario and from other answers."""
        for one in self.table():
            if one.of or one.given:
                object.__setattr__(self, one.name, one.value_in(self))

    def _held(self, shown: Shown) -> list[tuple[Answer, Any]]:
        """The answers of an output with their values, without those that a file of an earlier version lacks."""
        return [(one, getattr(self, one.name)) for one in self.table(shown) if hasattr(self, one.name)]


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    if hasattr(value, "as_dict"):
        return value.as_dict()
    return str(value) if isinstance(value, str) else value
