"""Fields that may be written under another key: the diameter of a tank for its radius."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar

from pydantic import GetJsonSchemaHandler, model_validator
from pydantic_core import core_schema

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Multiple, Quantity, Range


@dataclass(frozen=True)
class Alias:
    """A `key` that holds `times` what the field `field` holds; exactly one of the two is written."""

    key: str
    field: str
    times: float
    example: str
    description: str

    def leaf(self, model: type[Part]) -> Quantity:
        """The leaf of the key: the field's with its limits `times` as large."""
        own = next(entry for entry in model.model_fields[self.field].metadata if isinstance(entry, Quantity))
        limits = Range(self.times * own.limits.low, self.times * own.limits.high, own.limits.above, own.limits.below)
        return Quantity(own.dimension, limits, self.example)


class Aliased(Part):
    """A part some of whose fields have a second key. The models hold the fields alone."""

    aliases: ClassVar[tuple[Alias, ...]] = ()

    @model_validator(mode="before")
    @classmethod
    def _read_aliases(cls, data: Any) -> Any:
        return with_fields(cls, data) if isinstance(data, dict) else data

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        schema = handler.resolve_ref_schema(handler(core))
        for alias in cls.aliases:
            described = {"description": alias.description, "title": alias.key.replace("_", " ").title()}
            schema["properties"][alias.key] = alias.leaf(cls).json_schema() | described
            schema["required"].remove(alias.field)
            schema["oneOf"] = [{"required": [alias.field]}, {"required": [alias.key]}]
        return schema


def aliases_of(model: type[Part] | None) -> tuple[Alias, ...]:
    """The aliases of a part, none where it has none."""
    return model.aliases if model is not None and issubclass(model, Aliased) else ()


@cache
def keys_of(model: type[Part]) -> tuple[str, ...]:
    """Every key that a part may have, a second key after its field."""
    second = {alias.field: alias.key for alias in aliases_of(model)}
    return tuple(key for field in model.model_fields for key in (field, second.get(field)) if key is not None)


def field_of(model: type[Part] | None, key: str) -> str:
    """The field that a key of a part stands for: itself, or what it is the alias of."""
    return next((alias.field for alias in aliases_of(model) if alias.key == key), key)


def is_written(model: type[Part] | None, key: str, data: Mapping[str, Any]) -> bool:
    """Whether the field that a key stands for is given, by whichever of its keys."""
    return key in data or any(other in data for one, other in rivals(model) if one == key)


def with_fields(model: type[Part], data: Mapping[str, Any]) -> dict[str, Any]:
    """`data` with the fields in place of their aliases; where both are given the alias stays, as an unknown key."""
    found = dict(data)
    for alias in aliases_of(model):
        if alias.key in found and alias.field not in found:
            found[alias.field] = Multiple(found.pop(alias.key), alias.leaf(model), alias.times)
    return found


def rivals(model: type[Part] | None) -> Iterator[tuple[str, str]]:
    """Pairs of keys of which a part may have one alone, either way round."""
    for alias in aliases_of(model):
        yield alias.key, alias.field
        yield alias.field, alias.key
