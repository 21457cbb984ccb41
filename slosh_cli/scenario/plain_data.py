"""Validated models as the plain data of a file: for writing them out and for changing single values."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from pydantic_core import PydanticCustomError

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Quantity, SIValue
from slosh_cli.scenario.schema_run import named_adhesion
from slosh_cli.scenario.tree import leaves_of


def plain_data(part: Part, *, as_text: bool) -> dict[str, Any]:
    """Mappings, lists and scalars that read back as `part`.

    With `as_text` every quantity is text in SI units and every default is written out; otherwise quantities
    are SIValue and a number of modes that was not asked for stays away.
    """
    data: dict[str, Any] = {}
    for name, leaf in leaves_of(type(part)):
        value = getattr(part, name)
        if value is None or (name == "modes" and not _modes_count(part, as_text)):
            continue
        if isinstance(leaf, Quantity):
            data[name] = f"{value!r} {leaf.unit}" if as_text else SIValue(value)
        elif isinstance(value, Part):
            data[name] = plain_data(value, as_text=as_text)
        elif isinstance(value, tuple):
            data[name] = [_item(item, as_text) for item in value]
        else:
            data[name] = value
    return {"shape": data.pop("shape"), **data} if "shape" in data else data


def _modes_count(part: Part, as_text: bool) -> bool:
    """Whether to write the number of modes; beside given coefficients a file must not set it."""
    return getattr(part, "coefficients", None) == "computed" and (as_text or "modes" in part.model_fields_set)


def _item(item: Any, as_text: bool) -> Any:
    return plain_data(item, as_text=as_text) if isinstance(item, Part) else list(item)


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


def unfold_adhesion(data: dict[str, Any], path: tuple[str, ...]) -> None:
    """Write `dry`, `wet` or a number out as a mapping where an override is about to change one of its values."""
    contact = data.get("contact")
    if path[:2] != ("contact", "adhesion") or len(path) < 3 or not isinstance(contact, dict):
        return
    with suppress(PydanticCustomError):
        named = named_adhesion(contact.get("adhesion"))
        contact["adhesion"] = plain_data(named, as_text=True) if isinstance(named, Part) else named
