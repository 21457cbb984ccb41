"""The tree of models: what a scenario may have at a path, read off the annotations of its models.

A spot of the tree is a mapping (a Part), a list of items, a union of which the value chooses a branch, or a
single value. No key of a scenario is named here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import Discriminator, Tag
from pydantic.fields import FieldInfo

from slosh_cli.scenario.alias import field_of
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.document import Path
from slosh_cli.scenario.leaves import Leaf


@dataclass(frozen=True)
class Spot:
    """What an annotation says of one value.

    `branches` are the members of a union by their tag, `key` the key whose value is the tag, empty where something else
    chooses. Of a list `items` says what each item is. `part` is the model of a mapping.
    """

    part: type[Part] | None = None
    items: Spot | None = None
    branches: Mapping[str, Spot] | None = None
    key: str = ""
    pick: Callable[[Any], Any] | None = None

    def chosen(self, value: Any) -> Spot | None:
        """The spot itself, or the branch of a union that `value` takes; None where it takes none."""
        if self.branches is None:
            return self
        if self.pick is None:
            return next((branch for branch in self.branches.values() if branch.fits(value)), None)
        tag = self.pick(value)
        return self.branches.get(tag) if isinstance(tag, str) else None

    def fits(self, value: Any) -> bool:
        """Whether the value has the form of this spot."""
        return (self.part is not None and isinstance(value, dict)) or (
            self.items is not None and isinstance(value, list | tuple)
        )

    @property
    def parts(self) -> dict[str, type[Part]]:
        """The models of a union by tag, where a key tells them apart; else empty."""
        found = self.branches.items() if self.branches and self.key else ()
        return {tag: branch.part for tag, branch in found if branch.part is not None}

    @property
    def shared(self) -> list[str]:
        """The keys that all models of a union have."""
        first, *others = self.parts.values()
        return [name for name in first.model_fields if all(name in part.model_fields for part in others)]


@cache
def spot_of(model: type[Part], name: str) -> Spot:
    """The spot of the field `name` of a model."""
    field = model.model_fields[name]
    return _spot(field.annotation, tuple(field.metadata), field.discriminator)


def spot_at(model: type[Part], data: Any, path: Path) -> Spot | None:
    """The spot at `path` of `data`, None where the schema has none."""
    spot: Spot | None = Spot(part=model)
    for step in path:
        spot = _inside(spot, data, step)
        data = value_at(data, (step,))
    return spot


def part_at(model: type[Part], data: Any, path: Path) -> type[Part] | None:
    """The model of the mapping at `path`, None where the schema has no mapping there."""
    spot = spot_at(model, data, path)
    chosen = spot.chosen(value_at(data, path)) if spot else None
    return chosen.part if chosen else None


def data_path(model: type[Part], data: Any, location: Path) -> Path:
    """Pydantic's location of an error without the names of union branches, which are no keys of the file."""
    spot: Spot | None = Spot(part=model)
    path: list[str | int] = []
    for step in location:
        if spot is not None and spot.branches is not None:
            spot = spot.branches.get(str(step)) if spot.pick else spot.chosen(data)
            continue
        path.append(step)
        spot = _inside(spot, data, step)
        data = value_at(data, (step,))
    return tuple(path)


def unions(model: type[Part], prefix: Path = ()) -> Iterator[tuple[Path, Spot]]:
    """Path and spot of every union of mappings that a key tells apart, lists left out."""
    for name in model.model_fields:
        spot = spot_of(model, name)
        if spot.parts:
            yield (*prefix, name), spot
        elif spot.part is not None:
            yield from unions(spot.part, (*prefix, name))


def places_of(model: type[Part], name: str, prefix: Path = ()) -> Iterator[Path]:
    """Paths at which the schema knows `name`: single values below the root, of a union what all branches share."""
    for key in model.model_fields:
        spot = spot_of(model, key)
        if spot.part is not None:
            yield from places_of(spot.part, name, (*prefix, key))
        elif spot.parts:
            shared = next(iter(spot.parts.values()))
            found = places_of(shared, name, (*prefix, key))
            yield from (place for place in found if place[len(prefix) + 1] in spot.shared)
        elif key == field_of(model, name) and prefix:
            yield (*prefix, name)


def value_at(data: Any, path: Path) -> Any:
    """The value at `path`, None where there is none."""
    for step in path:
        try:
            data = data[step]
        except (KeyError, IndexError, TypeError):
            return None
    return data


@cache
def leaves_of(model: type[Part]) -> tuple[tuple[str, Leaf | None], ...]:
    """Name and leaf of every field of a part; see `leaf_of`."""
    return tuple((name, leaf_of(field)) for name, field in model.model_fields.items())


def leaf_of(field: FieldInfo) -> Leaf | None:
    """The leaf in a field's annotation, None for mappings and lists of mappings."""
    return next((entry for entry in field.metadata if isinstance(entry, Leaf)), None)


def _inside(spot: Spot | None, value: Any, step: str | int) -> Spot | None:
    """The spot of key or item `step` in `value`, which is at `spot`."""
    chosen = spot.chosen(value) if spot else None
    if chosen is None:
        return None
    if isinstance(step, int):
        return chosen.items
    if chosen.part is None or step not in chosen.part.model_fields:
        return None
    return spot_of(chosen.part, step)


def _spot(annotation: Any, metadata: tuple[Any, ...] = (), discriminator: Any = None) -> Spot:
    while get_origin(annotation) is Annotated:
        annotation, *inner = get_args(annotation)
        metadata = (*metadata, *inner)
    if any(isinstance(entry, Leaf) for entry in metadata):
        return Spot()
    if isinstance(annotation, type) and issubclass(annotation, Part):
        return Spot(part=annotation)
    if get_origin(annotation) in (list, tuple):
        return Spot(items=_spot(get_args(annotation)[0]))
    if get_origin(annotation) in (Union, UnionType):
        members = [member for member in get_args(annotation) if member is not NoneType]
        found = discriminator or next((_key_of(entry) for entry in metadata if _key_of(entry)), None)
        return _union(members, found.discriminator if isinstance(found, Discriminator) else found)
    return Spot()


def _key_of(entry: Any) -> Any:
    return entry if isinstance(entry, Discriminator) else getattr(entry, "discriminator", None)


def _union(members: list[Any], discriminator: Any) -> Spot:
    if len(members) == 1:
        return _spot(members[0])
    if discriminator is None:
        return Spot(branches={str(number): _spot(member) for number, member in enumerate(members)})
    if callable(discriminator):
        return Spot(branches={_tag(member): _spot(member) for member in members}, pick=discriminator)
    branches = {
        tag: _spot(member) for member in members for tag in get_args(member.model_fields[discriminator].annotation)
    }

    def pick(value: Any) -> Any:
        return value.get(discriminator) if isinstance(value, dict) else None

    return Spot(branches=branches, key=discriminator, pick=pick)


def _tag(member: Any) -> str:
    return next(entry.tag for entry in get_args(member) if isinstance(entry, Tag))


def is_tag(field: FieldInfo) -> bool:
    """Whether a field is the word that tells the branches of a union apart."""
    return get_origin(field.annotation) is Literal and leaf_of(field) is None
