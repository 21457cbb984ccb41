"""Validated models as the plain data of a file: for writing them out and for changing single values."""

from __future__ import annotations

from collections.abc import Collection
from functools import cache
from typing import Any

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import SIValue
from slosh_cli.scenario.tree import Spot, spot_of


def plain_data(part: Part, *, as_text: bool, kept: Collection[str] = ()) -> dict[str, Any]:
    """Mappings, lists and scalars that read back as `part`, of a member of a union its tag first.

    With `as_text` every quantity is text in SI units and every default is written out; otherwise quantities
    are SIValue. Parts in the fields `kept` stay parts.
    """
    without = part.unwritten(as_text=as_text)
    values = ((name, spot, getattr(part, name)) for name, spot in _spots(type(part)) if name not in without)
    return {
        name: value if name in kept and isinstance(value, Part) else _plain(value, spot, as_text)
        for name, spot, value in values
        if value is not None
    }


@cache
def _spots(model: type[Part]) -> tuple[tuple[str, Spot], ...]:
    found = [(name, spot_of(model, name)) for name in model.model_fields]
    return tuple(sorted(found, key=lambda entry: not entry[1].is_tag))


def _plain(value: Any, spot: Spot | None, as_text: bool) -> Any:
    if isinstance(value, Part):
        return value.word or plain_data(value, as_text=as_text)
    if spot is not None and spot.branches is not None:
        spot = spot.chosen(value)
    if spot is not None and spot.leaf is not None:
        return spot.leaf.written(value, as_text=as_text)
    if isinstance(value, tuple | list):
        return [_plain(item, spot.inside(value, place) if spot else None, as_text) for place, item in enumerate(value)]
    if isinstance(value, dict):
        return {key: _plain(entry, spot.inside(value, key) if spot else None, as_text) for key, entry in value.items()}
    return value


def si_values(value: Any) -> Any:
    """`value` with its floats and integers marked as SI, so that they need no unit; truth values stay."""
    if isinstance(value, dict):
        return {key: si_values(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [si_values(entry) for entry in value]
    if isinstance(value, Part):
        return plain_data(value, as_text=False)
    if isinstance(value, int | float) and not isinstance(value, bool):
        return SIValue(value)
    return value
