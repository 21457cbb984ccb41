"""A run read back: what its file must hold to be the history of a run, apart from the format it is kept in."""

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.errors import printable
from slosh_cli.results.answers import Answer, PerWheel, Place, Shown
from slosh_cli.results.channels import TIME, WHEELS, channel, wheel
from slosh_cli.results.result import Record, Status
from slosh_cli.results.validity import Check
from slosh_cli.scenario.scalars import well_formed

if TYPE_CHECKING:
    from slosh_cli.results.surface import SurfaceProfile

_MOST_ROWS: Final = 10_000_000
"""Rows of a history; a run has at most two million."""
LARGEST: Final = 1e15
"""Numbers beyond this, in SI units, are of no run."""
_SMALL: Final = 1_000_000
_DENSEST: Final = 100
"""A column of more bytes than `_SMALL` must take at least one of `_DENSEST` of them in its file."""

NEEDED: Final = frozenset(
    {"position", "speed", "car_acceleration", "surface_front", "surface_rear", "liquid_force"}
    | {wheel(i, quantity) for i in WHEELS for quantity in ("speed", "creepage", "normal_force")}
)
"""Channels that figures and reports cannot do without."""


EXCITED: Final = frozenset({"deceleration", "liquid_force", "surface_front", "surface_rear"})
"""Channels of a tank alone that its replay cannot do without."""


@dataclass(frozen=True, eq=False)
class StoredExcitation:
    """An excitation of a tank alone, read back: its `channels` at `time` (n,) s, the scenario as resolved YAML; the
    `surface` along the tank has its places from the rear end wall, and there is none in files of earlier versions."""

    name: str
    time: Vector
    channels: Mapping[str, Vector]
    surface: "SurfaceProfile | None"
    scenario_text: str


class History(Record):
    """A run read back from its file: the same answers, channels and methods as a `Result`.

    attributes: every root attribute of the file, as plain Python values and float64 arrays.
    scenario_text: the scenario as resolved YAML.

    An answer that files of an earlier version do not hold is no attribute: asking for it raises AttributeError.
    """

    attributes: Mapping[str, Any]
    scenario_text: str

    def __init__(
        self, *, time: Vector, channels: Mapping[str, Vector], attributes: Mapping[str, Any], scenario_text: str
    ) -> None:
        held = {one.name: _value(one, attributes[one.name]) for one in History.table() if one.name in attributes}
        given = {"time": time, "channels": channels, "attributes": attributes, "scenario_text": scenario_text}
        for name, value in (held | given).items():
            object.__setattr__(self, name, value)
        for one in History.table():
            if one.of and Shown.HISTORY not in one.shown:
                with suppress(AttributeError, ArithmeticError):
                    object.__setattr__(self, one.name, one.of(self))


def plain_attributes(holder: Any) -> dict[str, Any]:
    """The attributes of an open file or group, as plain Python values where they are single ones.

    Control characters of texts are spelt out: no picture and no terminal can take them.
    """
    found = {}
    for key, value in holder.attrs.items():
        single = value.item() if isinstance(value, np.generic) else value
        text = single.decode("utf-8") if isinstance(single, bytes) else single
        found[key] = printable(text, "\n\t") if isinstance(text, str) else text
    return found


def faults_of_answers(answers: Sequence[Answer], attributes: Mapping[str, Any]) -> Iterator[str]:
    """What is wrong with the attributes that hold answers, in words that follow the name of what has them."""
    missing = [one.name for one in answers if one.needed and one.name not in attributes]
    if missing:
        yield f"it lacks the attributes {', '.join(missing)}"
    for one in answers:
        if one.name in attributes and not _is_sound(one, attributes[one.name]):
            yield f"its attribute {one.name} must be {_words(one)}, but is {_shown(attributes[one.name])}"


def _is_sound(one: Answer, value: Any) -> bool:
    """Whether an attribute is of the kind of its answer, and within bounds where no run does without it."""
    if one.unit:
        return _are_numbers(one, value)
    if one.kind is bool:
        return isinstance(value, bool)
    try:
        return isinstance(value, str) and not well_formed(value)[1] and _value(one, value) is not None
    except (ValueError, KeyError, TypeError, RecursionError):
        return False


def _are_numbers(one: Answer, value: Any) -> bool:
    found = np.asarray(value)
    kinds = "iu" if one.kind is int else "fiu"
    if found.shape != ((len(WHEELS),) if one.kind == PerWheel else ()) or found.dtype.kind not in kinds:
        return False
    sound = np.abs(found) < LARGEST
    return not one.needed or bool((sound if _is_finite(one) else sound | np.isnan(found)).all())


def _is_finite(one: Answer) -> bool:
    """Whether a figure can do nothing without the number."""
    return one.needed and one.place in (Place.CONDITIONS, Place.WHEELS)


def _words(one: Answer) -> str:
    """What an attribute must be."""
    if one.unit:
        finite = "finite " * _is_finite(one)
        return f"{len(WHEELS)} {finite}numbers" if one.kind == PerWheel else f"a {finite}number"
    words = {Status: f"one of {', '.join(Status)}", bool: "true or false", tuple[Check, ...]: "a list of checks"}
    return words.get(one.kind, "text")


def _value(one: Answer, value: Any) -> Any:
    """An answer from the attribute that holds it."""
    if one.kind == float | None:
        return None if np.isnan(value) else float(value)
    if one.kind == PerWheel:
        return tuple(float(number) for number in value)
    if one.kind == tuple[str, ...]:
        return tuple(value.splitlines())
    if one.kind == tuple[Check, ...]:
        return tuple(
            Check(
                *(found["check"], found["kind"], float(found["value"]), float(found["limit"]), ""),
                *(found.get("standing", ""), found.get("source", "")),
            )
            for found in json.loads(value)
        )
    return one.kind(value)


def stored_columns(file: Any, needed: Collection[str] = NEEDED) -> dict[str, Vector] | list[str]:
    """The time axis and every channel that an open file has, or what is wrong with these; all else is left alone."""
    known = [name for name in file if name == TIME.name or name in needed or _is_channel(name)]
    missing = [name for name in (TIME.name, *sorted(needed)) if name not in known]
    faults = [f"it lacks the channels {', '.join(missing)}"] if missing else []
    faults += [fault for name in known for fault in faults_of_shape(name, file.get(name))]
    return faults or {name: np.asarray(file[name][:], dtype=np.float64) for name in known}


def _is_channel(name: str) -> bool:
    try:
        return bool(channel(name))
    except KeyError:
        return False


def faults_of_shape(name: str, dataset: Any) -> Iterator[str]:
    """What keeps a dataset, not read yet, from being a column of numbers."""
    shape, dtype = getattr(dataset, "shape", None), getattr(dataset, "dtype", None)
    if dataset is None:
        yield f"it lacks its {name}"
    elif shape is None or dtype is None:
        yield f"its {name} must be a dataset with rows, but is a group, a link or empty"
    elif len(shape) != 1 or dtype.kind not in "fiu":
        yield f"its {name} must be a column of numbers, but has the shape {shape} and the type {dtype}"
    elif not 0 < shape[0] <= _MOST_ROWS:
        yield f"its {name} must have from 1 to {_MOST_ROWS} rows, but has {shape[0]}"
    elif not is_there(dataset):
        yield f"its {name} must be in the file itself, all {shape[0]} rows of it"


def is_there(dataset: Any, small: int = _SMALL) -> bool:
    """Whether the numbers are in the file, not in others, and are no more than `small` bytes with next to nothing in
    them."""
    if dataset.is_virtual or dataset.external:
        return False
    return bool(dataset.nbytes <= max(small, _DENSEST * dataset.id.get_storage_size()))


def faults_of_columns(time: Vector, channels: Mapping[str, Vector], needed: Collection[str] = NEEDED) -> Iterator[str]:
    """What is wrong with the numbers of a history: rows, times that fall, values that are no numbers."""
    if not _are_sound(time) or (np.diff(time) < 0.0).any():
        yield f"its {TIME.name} must be finite and must not fall"
    for name, values in channels.items():
        if values.shape != time.shape:
            yield f"its channel {name} is not as long as the time axis ({values.size} rows for {time.size})"
        elif name in needed and not _are_sound(values):
            yield f"its channel {name} must be finite"


def _are_sound(values: Vector) -> bool:
    """Whether all numbers are finite, and such as a run can have."""
    return bool((np.abs(values) < LARGEST).all())


def _shown(value: Any) -> str:
    text = " ".join(repr(value).split())
    return f"`{text if len(text) <= 60 else text[:57] + '...'}`"
