"""The base of every part of a scenario: a mapping with keys of its own.

What messages, remedies and the JSON schema say of a part stands in its class alone: in the annotations of its fields
and in the class variables of Part.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal, Self, TypeAlias, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field, GetJsonSchemaHandler, TypeAdapter, model_validator
from pydantic_core import core_schema

from slosh_cli.scenario.leaves import Leaf, Quantity, Range

if TYPE_CHECKING:
    from slosh_cli.scenario.rules import Finding, Values

Path: TypeAlias = tuple[str | int, ...]
"""Keys, and places in lists from 0, from the root of a file to a value."""
OWN: Final = "x-"
"""Top-level keys that begin so are the author's own, a place for anchors: nobody reads them."""
USE: Final = "use"
"""The key of a part that names a preset, or a list of them, of which the later ones hold."""
_DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
_FROM_TEXT: Final = {"units_required": True}


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
        return replace(own, limits=limits, example=self.example)


class Part(BaseModel):
    """A frozen mapping of a scenario: unknown keys are refused, values are SI, names are the YAML keys.

    Validators are built at first use, for a whole scenario at once. `model_construct` makes a constant of a part
    without building one.

    `noun` is what people call the part. `rules` tie values below it together; their key paths begin at it. Of the
    fields in each group of `exactly_one`, which are None where they are left out, one has to be written. A `word`
    stands for a part that cannot be written in full. A root that `has_usual` values has those of a preset where its
    file says nothing.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)

    noun: ClassVar[str] = "mapping"
    aliases: ClassVar[tuple[Alias, ...]] = ()
    exactly_one: ClassVar[tuple[tuple[str, ...], ...]] = ()
    rules: ClassVar[tuple[Callable[[Values], Iterator[Finding]], ...]] = ()
    word: ClassVar[str] = ""
    has_usual: ClassVar[bool] = False

    @classmethod
    def from_text(cls, data: Any) -> Self:
        """The part of data as a file holds it; pydantic's ValidationError where it is not sound."""
        return cls.model_validate(data, context=_FROM_TEXT)

    @classmethod
    def field_from_text(cls, name: str, value: Any) -> Any:
        """The same of the value of one field."""
        return _adapter(cls, name).validate_python(value, context=_FROM_TEXT)

    @classmethod
    def editor_schema(cls) -> dict[str, Any]:
        """JSON Schema of a file with this part as its root, for editors. Quantities are texts with a unit."""
        schema = cls.model_json_schema()
        for definition in (*schema.get("$defs", {}).values(), schema):
            properties = definition["properties"].items()
            definition["title"] = definition["title"].lstrip("_")
            tags = [name for name, entry in properties if "const" in entry and "default" in entry]
            if tags:
                definition["required"] = [*tags, *definition.get("required", ())]
            for name, entry in properties:
                definition["properties"][name] = _with_use(entry)
            for _, entry in properties:
                if entry.get("default", "") is None or isinstance(entry.get("default"), dict):
                    del entry["default"]  # computed or a whole part: the descriptions say how
                elif "default" in entry and "x-unit" in entry:
                    entry["default"] = f"{entry['default']} {entry['x-unit']}"
                elif "default" in entry and "x-unit" in entry.get("items", ()):
                    entry["default"] = [f"{value} {entry['items']['x-unit']}" for value in entry["default"]]
        return {"$schema": _DIALECT, **schema, "patternProperties": {f"^{OWN}": True}}

    @classmethod
    @cache
    def every_key(cls) -> tuple[str, ...]:
        """Every key that the part may have, a second key after its field."""
        second = {alias.field: alias.key for alias in cls.aliases}
        return tuple(key for field in cls.model_fields for key in (field, second.get(field)) if key is not None)

    @classmethod
    def sketch(cls, *, samples: bool) -> str:
        """The keys that the part must have, as it is written on one line, of single values with `samples`."""
        written: list[str] = []
        for name, entry in cls.model_fields.items():
            leaf = next((note for note in entry.metadata if isinstance(note, Leaf)), None)
            if get_origin(entry.annotation) is Literal and leaf is None:
                written.insert(0, f"{name}: {get_args(entry.annotation)[0]}")
            elif entry.is_required() or any(name == group[0] for group in cls.exactly_one):
                written.append(f"{name}: {leaf.sample() if leaf and samples else '...'}")
        return f"{{{', '.join(written)}}}"

    @classmethod
    def field_of(cls, key: str) -> str:
        """The field that a key stands for: itself, or what it is the alias of."""
        return next((alias.field for alias in cls.aliases if alias.key == key), key)

    @classmethod
    def is_written(cls, key: str, data: Mapping[str, Any]) -> bool:
        """Whether the field that a key stands for is given, by whichever of its keys."""
        names = {key, cls.field_of(key), *(alias.key for alias in cls.aliases if alias.field == key)}
        return not names.isdisjoint(data)

    @classmethod
    def rivals(cls, key: str) -> list[str]:
        """The keys that may not stand beside `key`."""
        if not cls.aliases and not cls.exactly_one:
            return []
        groups = [*((alias.key, alias.field) for alias in cls.aliases), *cls.exactly_one]
        return [other for group in groups if key in group for other in group if other != key]

    @classmethod
    def with_fields(cls, data: Mapping[str, Any]) -> dict[str, Any]:
        """`data` with the fields in place of their aliases; where both are given the alias stays, an unknown key."""
        found = dict(data)
        for alias in cls.aliases:
            if alias.key in found and alias.field not in found:
                found[alias.field] = alias.leaf(cls).multiple(found.pop(alias.key), alias.times)
        return found

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        found = handler(core)
        groups = [*((alias.field, alias.key) for alias in cls.aliases), *cls.exactly_one]
        if not groups:
            return found
        schema = handler.resolve_ref_schema(found)
        for alias in cls.aliases:
            described = {"description": alias.description, "title": alias.key.replace("_", " ").title()}
            schema["properties"][alias.key] = alias.leaf(cls).json_schema() | described
            schema["required"].remove(alias.field)
        choices = [{"oneOf": [{"required": [key]} for key in group]} for group in groups]
        schema.update(choices[0] if len(choices) == 1 else {"allOf": choices})
        return schema

    def unwritten(self, *, as_text: bool) -> Collection[str]:  # noqa: ARG002 - parts say it
        """Fields that stay away from the plain data of the part, `as_text` where every default is written out."""
        return ()


class Aliased(Part):
    """A part some of whose fields have a second key. The models hold the fields alone."""

    @model_validator(mode="before")
    @classmethod
    def _read_aliases(cls, data: Any) -> Any:
        return cls.with_fields(data) if isinstance(data, dict) else data


def _with_use(entry: dict[str, Any]) -> dict[str, Any]:
    """The editor's schema of a field, which may name a preset where it is a part; the loader checks what it gives."""
    if not any("$ref" in member for member in (entry, *entry.get("anyOf", ()), *entry.get("oneOf", ()))):
        return entry
    names = {"oneOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}, "minItems": 1}]}
    used = {"type": "object", "required": [USE], "properties": {USE: names}}
    if "anyOf" in entry:
        return entry | {"anyOf": [*entry["anyOf"], used]}
    apart = {word: entry[word] for word in ("description", "title", "default") if word in entry}
    form = {word: said for word, said in entry.items() if word not in apart}
    return apart | {"anyOf": [form, used]}


@cache
def _adapter(model: type[Part], name: str) -> TypeAdapter[Any]:
    """What validates a single field of a part."""
    field = model.model_fields[name]
    by_key = [Field(discriminator=field.discriminator)] if isinstance(field.discriminator, str) else []
    notes = (*by_key, *field.metadata)
    kind: Any = Annotated[field.annotation, *notes] if notes else field.annotation
    return TypeAdapter(kind)
