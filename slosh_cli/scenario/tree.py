"""The tree of models: what a scenario may have at a path, read off the annotations of its models.

A spot of the tree is a mapping (a Part), a mapping with keys of the author's, a list of items, a union of which the
value chooses a branch, or a single value. No key of a scenario is named here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import Discriminator, Tag

from slosh_cli.scenario.base import Part, Path
from slosh_cli.scenario.leaves import Leaf
from slosh_cli.scenario.short import Short


@dataclass(frozen=True)
class Spot:
    """What an annotation says of one value.

    `part` is the model of a mapping, `leaf` what is asked of a single value. Of a list `items` says what each item is,
    of a mapping whose keys are the author's `entries` what each value is. `branches` are the members of a union by
    their tag, `key` the key whose value is the tag, empty where something else chooses; `is_tag` marks that word in the
    members. `short` are the short forms in which a part may be written.
    """

    part: type[Part] | None = None
    items: Spot | None = None
    entries: Spot | None = None
    branches: Mapping[str, Spot] | None = None
    key: str = ""
    pick: Callable[[Any], Any] | None = None
    leaf: Leaf | None = None
    short: Short | None = None
    is_tag: bool = False

    def chosen(self, value: Any) -> Spot | None:
        """The spot itself, or the branch of a union that `value` takes; None where it takes none."""
        if self.branches is None:
            return self
        if self.pick is None:
            return next((branch for branch in self.branches.values() if branch._fits(value)), None)
        tag = self.pick(value)
        return self.branches.get(tag) if isinstance(tag, str) else None

    def _fits(self, value: Any) -> bool:
        """Whether the value has the form of this spot."""
        if isinstance(value, dict):
            return self.part is not None or self.entries is not None
        return self.items is not None if isinstance(value, list | tuple) else self.leaf is not None

    def inside(self, value: Any, step: str | int) -> Spot | None:
        """The spot of key or item `step` in `value`, which is at this spot."""
        chosen = self.chosen(value)
        if chosen is None or isinstance(step, int):
            return chosen.items if chosen else None
        if chosen.part is None:
            return chosen.entries
        return spot_of(chosen.part, step) if step in chosen.part.model_fields else None

    def at(self, data: Any, path: Path) -> Spot | None:
        """The spot at `path` of `data`, None where the schema has none."""
        return [spot for spot, _ in self.way(data, path)][-1]

    def way(self, data: Any, path: Path) -> Iterator[tuple[Spot | None, Any]]:
        """Spot and value at every step to `path` of `data`, from this spot on."""
        spot: Spot | None = self
        yield spot, data
        for step in path:
            spot = spot.inside(data, step) if spot else None
            data = value_at(data, (step,))
            yield spot, data

    def part_at(self, data: Any, path: Path) -> type[Part] | None:
        """The model of the mapping at `path`, None where the schema has no mapping there."""
        spot, value = list(self.way(data, path))[-1]
        chosen = spot.chosen(value) if spot else None
        return chosen.part if chosen else None

    def inner(self, data: Any) -> Iterator[tuple[Path, Spot, Any]]:
        """Path, spot and value of all that is in `data`, which is at this spot, as far as the schema knows it."""
        steps = data if isinstance(data, dict) else range(len(data)) if isinstance(data, list | tuple) else ()
        for step in steps:
            spot = self.inside(data, step)
            if spot is not None:
                yield (step,), spot, data[step]
                yield from (((step, *path), *found) for path, *found in spot.inner(data[step]))

    def data_path(self, data: Any, location: Path, kind: str = "") -> Path | None:
        """Pydantic's location of an error in `data` without the names of union branches, which are no keys of the file.

        None for an error of a `kind` that is about a branch which the value does not take.
        """
        spot: Spot | None = self
        path: list[str | int] = []
        for place, step in enumerate(location):
            if spot is None or spot.branches is None:
                path.append(step)
                spot = spot.inside(data, step) if spot else None
                data = value_at(data, (step,))
            elif spot.pick is not None:
                spot = spot.branches.get(str(step))
            else:
                spot = spot.chosen(data)
                if spot is None:
                    break
                if spot.leaf is not None and kind != "refused":
                    return None
                if spot.leaf is None and place + 1 == len(location):
                    return None
        return tuple(path)

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

    def places(self, name: str, data: Any, prefix: Path = ()) -> Iterator[Path]:
        """Paths at which the schema knows `name`: single values below the root, of a union what all branches share.

        Parts that `data` does without, or that exclude one which it has, are no places.
        """
        first = next(iter(self.parts.values()), None)
        part, known = (first, self.shared) if first else (self.part, list(self.part.model_fields if self.part else ()))
        for key in known if part else ():
            assert part is not None
            spot, value = spot_of(part, key), value_at(data, (key,))
            spot = spot if spot.key else spot.chosen(value) or spot
            if any(key in group and value_at(data, (other,)) for group in part.exactly_one for other in group):
                continue
            if spot.part is not None or spot.parts:
                there = value is not None or part.model_fields[key].default is not None
                yield from spot.places(name, value, (*prefix, key)) if there else ()
            elif key == part.field_of(name) and prefix:
                yield (*prefix, name)


@cache
def spot_of(model: type[Part], name: str) -> Spot:
    """The spot of the field `name` of a model."""
    entry = model.model_fields[name]
    return _spot(entry.annotation, tuple(entry.metadata), entry.discriminator)


def value_at(data: Any, path: Path) -> Any:
    """The value at `path`, None where there is none."""
    for step in path:
        try:
            data = data[step]
        except (KeyError, IndexError, TypeError):
            return None
    return data


def _spot(annotation: Any, metadata: tuple[Any, ...] = (), discriminator: Any = None) -> Spot:
    while get_origin(annotation) is Annotated:
        annotation, *inner = get_args(annotation)
        metadata = (*metadata, *inner)
    leaf = next((entry for entry in metadata if isinstance(entry, Leaf)), None)
    if leaf is not None:
        return Spot(leaf=leaf)
    found = _form(annotation, metadata, discriminator)
    short = next((entry for entry in metadata if isinstance(entry, Short)), None)
    return replace(found, short=replace(short, whole=annotation)) if short else found


def _form(annotation: Any, metadata: tuple[Any, ...], discriminator: Any) -> Spot:
    origin, members = get_origin(annotation), get_args(annotation)
    if isinstance(annotation, type) and issubclass(annotation, Part):
        return Spot(part=annotation)
    if origin in (list, tuple):
        return Spot(items=_spot(members[0]))
    if origin in (dict, Mapping):
        return Spot(entries=_spot(members[1]))
    if origin in (Union, UnionType):
        found = discriminator or next((_key_of(entry) for entry in metadata if _key_of(entry)), None)
        given = [member for member in members if member is not NoneType]
        return _union(given, found.discriminator if isinstance(found, Discriminator) else found)
    return Spot(is_tag=origin is Literal)


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
