"""What a history file must hold to be the history of a run, apart from the format it is kept in."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

import numpy as np

from slosh_cli.results.channels import TIME, WHEELS, wheel
from slosh_cli.results.result import Status, Vector
from slosh_cli.scenario.scalars import well_formed

MOST_ROWS: Final = 10_000_000
"""Rows of a history; a run has at most two million."""
LARGEST: Final = 1e15
"""Numbers beyond this, in SI units, are of no run."""

NEEDED: Final = frozenset(
    {"position", "speed", "car_acceleration", "surface_front", "surface_rear", "liquid_force"}
    | {wheel(i, quantity) for i in WHEELS for quantity in ("speed", "creepage", "normal_force")}
)
"""Channels that figures and reports cannot do without."""


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and not well_formed(value)[1]


def _is_status(value: Any) -> bool:
    try:
        return isinstance(value, str) and bool(Status(value))
    except ValueError:
        return False


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and bool(np.abs(value) < LARGEST)


def _is_number_or_nan(value: Any) -> bool:
    return _is_number(value) or (isinstance(value, float) and bool(np.isnan(value)))


def _is_per_wheel(value: Any) -> bool:
    return (
        isinstance(value, np.ndarray)
        and value.shape == (len(WHEELS),)
        and value.dtype.kind in "fiu"
        and bool((np.abs(value) < LARGEST).all())
    )


_TEXT: Final = (_is_text, "text")
_STATUS: Final = (_is_status, f"one of {', '.join(Status)}")
_NUMBER: Final = (_is_number, "a finite number")
_NUMBER_OR_NAN: Final = (_is_number_or_nan, "a number")
_PER_WHEEL: Final = (_is_per_wheel, f"{len(WHEELS)} finite numbers")

ATTRIBUTES: Final[Mapping[str, tuple[Callable[[Any], bool], str]]] = {
    "name": _TEXT,
    "status": _STATUS,
    "reason": _TEXT,
    "warnings": _TEXT,
    "initial_speed_m_s": _NUMBER,
    "torque_N_m": _NUMBER,
    "onset_s": _NUMBER,
    "liquid_model": _TEXT,
    "surface_limit_m": _NUMBER_OR_NAN,
    "braking_distance_m": _NUMBER_OR_NAN,
    "static_wheel_load_N": _PER_WHEEL,
}
"""The root attributes that a `History` is asked for, with what each must be."""


def faults_of_attributes(attributes: Mapping[str, Any]) -> Iterator[str]:
    """What is wrong with the root attributes, in words that follow the name of the file."""
    missing = [key for key in ATTRIBUTES if key not in attributes]
    if missing:
        yield f"it lacks the attributes {', '.join(missing)}"
    for key, (is_sound, words) in ATTRIBUTES.items():
        if key in attributes and not is_sound(attributes[key]):
            yield f"its attribute {key} must be {words}, but is {_shown(attributes[key])}"


def faults_of_shape(name: str, dataset: Any) -> Iterator[str]:
    """What keeps a dataset, not read yet, from being a column of numbers."""
    shape, dtype = getattr(dataset, "shape", None), getattr(dataset, "dtype", None)
    if shape is None or dtype is None:
        yield f"its {name} must be a dataset, but is a group"
    elif len(shape) != 1 or dtype.kind not in "fiu":
        yield f"its {name} must be a column of numbers, but has the shape {shape} and the type {dtype}"
    elif not 0 < shape[0] <= MOST_ROWS:
        yield f"its {name} must have from 1 to {MOST_ROWS} rows, but has {shape[0]}"


def faults_of_columns(time: Vector, channels: Mapping[str, Vector]) -> Iterator[str]:
    """What is wrong with the numbers of a history: rows, times that fall, values that are no numbers."""
    if not np.isfinite(time).all() or (np.diff(time) < 0.0).any():
        yield f"its {TIME.name} must be finite and must not fall"
    for name, values in channels.items():
        if values.shape != time.shape:
            yield f"its channel {name} is not as long as the time axis ({values.size} rows for {time.size})"
        elif name in NEEDED and not np.isfinite(values).all():
            yield f"its channel {name} must be finite"


def _shown(value: Any) -> str:
    text = " ".join(repr(value).split())
    return f"`{text if len(text) <= 60 else text[:57] + '...'}`"
