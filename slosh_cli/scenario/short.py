"""Parts that may be written in short: a word for a known one, or a single value in place of the mapping."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args, get_origin

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import core_schema

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Judge, Leaf
from slosh_cli.scenario.scalars import plain_scalar
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.words import Choice, all_of, one_of


@dataclass(frozen=True)
class Short(Judge):
    """A part, or a union of parts, for which one of the words `known` may stand.

    With a `leaf` a single value may stand for it, too: `make` gives the part of the leaf's value, `called` says what
    the value is, `example` is one. Mappings go on to the annotation itself.
    """

    known: Mapping[str, Part]
    leaf: Leaf | None = None
    make: Callable[[Any], Part] | None = None
    called: str = ""
    example: str = ""
    whole: Any = None
    """The annotation itself, which pydantic tells."""

    def parse(self, value: object) -> Any:
        return self._read(value, self.leaf.parse if self.leaf else None)

    def parse_python(self, value: object) -> Any:
        return self._read(value, self.leaf.parse_python if self.leaf else None)

    def _read(self, value: object, read: Callable[[object], Any] | None) -> Any:
        if isinstance(value, dict | Part):
            return value
        if isinstance(value, str) and value in self.known:
            return self.known[value]
        words = [*(f"`{word}`" for word in self.known), *([self.called] if self.leaf else [])]
        rule = f"must be {', '.join(words)} or {self._mapping()}"
        likely = Choice(tuple(self.known)).guess(value)
        if likely:
            raise ValueRefused(rule, plain(value), f"write `{likely}`")
        in_full = f"`{_parts(self.whole)[0].sketch(samples=True)}`"
        if read is None or self.make is None:
            raise ValueRefused(rule, plain(value), f"write {one_of(tuple(self.known))}, or something such as {in_full}")
        try:
            return self.make(read(value))
        except ValueRefused as refused:
            if isinstance(value, list | tuple):
                raise  # meant as what it is: its own rule says more
            fix = refused.fix
            if not isinstance(value, int | float) and not (isinstance(value, str) and value[:1].isdigit()):
                example = f"something such as `{self.example}` or {in_full}"
                fix = f"write {one_of(tuple(self.known))}, or {example}"
            raise ValueRefused(rule, refused.given, fix) from None

    def part(self, value: object) -> Part | None:
        """The part that a short form in a file stands for; None of what is no short form, or no sound one."""
        try:
            found = self.parse(value)
        except ValueRefused:
            return None
        return found if isinstance(found, Part) else None

    def samples(self) -> list[str]:
        """Values as a file may hold them."""
        return [*self.known, *([self.example] if self.example else [])]

    def _mapping(self) -> str:
        """The mapping in words."""
        forms: dict[str, None] = {}
        for part in _parts(self.whole):
            tag = next(
                (name for name, entry in part.model_fields.items() if get_origin(entry.annotation) is Literal), ""
            )
            forms[f"a mapping with its `{tag}`" if tag else f"a mapping of {all_of(part.model_fields)}"] = None
        return " or ".join(forms)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return replace(self, whole=source)._before(source, handler)

    def __get_pydantic_json_schema__(
        self, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        forms = [{"enum": sorted(self.known)}, *([self.leaf.json_schema()] if self.leaf else []), handler(core)]
        return {"anyOf": forms, "examples": [plain_scalar(sample) for sample in self.samples()]}


def _parts(annotation: Any) -> list[type[Part]]:
    """The models of a part or of a union of parts."""
    if isinstance(annotation, type):
        return [annotation] if issubclass(annotation, Part) else []
    return [part for member in get_args(annotation) for part in _parts(member)]
