"""The page of keys: what the schema of scenarios, trains and studies says of each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, get_args

from slosh_cli.scenario import Scenario
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Leaf, Quantity
from slosh_cli.scenario.points import Points
from slosh_cli.scenario.presets import DEFAULT, find_preset, is_usual
from slosh_cli.scenario.schema_train import SHARED, TrainFile
from slosh_cli.scenario.tree import Spot, spot_of
from slosh_cli.scenario.units import DIMENSIONS, shown
from slosh_cli.scenario.words import all_of, one_of
from slosh_cli.study.study_file import StudyKeys

BEGIN = ("format", "name", "description", "presets")
"""What every scenario and every train begins with."""

KEYS = """# Every key of a file

Made by `make pages` from the code itself.

`slosh schema scenario`, `slosh schema train` and `slosh schema study` say the same to an editor. `slosh check FILE`
refuses what is not here, with a guess at the key that was meant. [The scenario file](scenario.md) explains the keys
that need it.

- A quantity has a number and a unit. The unit named here is the one that the program computes in. Every unit of the
  same dimension is read. Numbers outside the range are refused.
- A number has no unit; a percentage such as `60 %` will do.
- `[]` stands for an item of a list. `--set` and `--vary` count items from 0: `wagon.wheel_flats.0.depth`.
- Any part of a scenario may have `use: NAME`, which takes the values of a [preset](presets.md).
- *Required* means: where the part that the key belongs to is there.
- A default that is marked as *usual* is that of the preset `default`. `slosh check` says where it is taken.
"""


@dataclass(frozen=True)
class Row:
    """One key: its path, what it takes, what holds where it is left out, what it means."""

    key: str
    takes: str
    default: str
    meaning: str

    def __str__(self) -> str:
        return f"| `{self.key}` | {cell(self.takes)} | {cell(self.default)} | {cell(self.meaning)} |\n"


USUAL = "that of each key (usual)"
USUAL_PARTS = {".".join(map(str, path[:-1])) for path in find_preset(DEFAULT).leaves} | {
    name for name in Scenario.model_fields if is_usual(Scenario, name)
}
"""Parts that may be left out because the preset `default` has all that they need."""
ROWS = "| key | takes | default | meaning |\n|---|---|---|---|\n"


def cell(text: str) -> str:
    """A text as it may stand in a table."""
    return " ".join(text.split()).replace("|", "\\|")


def takes(leaf: Leaf) -> str:
    """What a single value has to be."""
    return WORDS[type(leaf).__name__](leaf)


def quantity(leaf: Quantity) -> str:
    """A number with a unit."""
    nonzero = ", not zero" if leaf.nonzero else ""
    return f"{DIMENSIONS[leaf.dimension].noun} {leaf.limits.words(leaf.unit)}{nonzero}, such as `{leaf.example}`"


def points(leaf: Points) -> str:
    """A table of two values."""
    return f"{leaf.least} to {leaf.most} points such as `{leaf.example}`: {takes(leaf.x)}; {takes(leaf.y)}"


WORDS: Mapping[str, Callable[[Any], str]] = {
    "Quantity": quantity,
    "Number": lambda leaf: f"a number {leaf.limits.words()}, such as `{leaf.example}`",
    "Count": lambda leaf: f"a whole number from {leaf.low} to {leaf.high}",
    "Choice": lambda leaf: one_of(leaf.options),
    "Text": lambda leaf: f"text of at most {leaf.longest} characters{leaf.words}",
    "Points": points,
    "NumberOrPoints": lambda leaf: f"{takes(leaf.number)}; or {takes(leaf.points)}",
    "_Version": lambda leaf: f"`{leaf.supported}`",
    "_Taken": lambda leaf: f"a mapping such as `{leaf.sample()}`",
    "Outline": lambda leaf: f"corners such as `{leaf.sample()}`, nothing further out than {leaf.largest:g} m",
    "_Waveband": lambda leaf: f"two lengths such as `{leaf.sample()}`, {leaf.length.limits.words('m')}",
    "_MeasuredRail": lambda leaf: f"a CSV file such as `{leaf.sample()}`",
    "_Base": lambda _: "a path or a name, such as `paper_80.yaml`",
    "_Values": lambda _: "a list, or a text with commas",
}
"""What a value of each kind has to be."""


def forms(spot: Spot) -> str:
    """What may stand at a spot."""
    if spot.leaf is not None:
        return takes(spot.leaf)
    if spot.key:
        found = f"a mapping with its `{spot.key}`"
    elif spot.branches:
        found = " or ".join(f"`{tag}`" if one.is_tag else forms(one) for tag, one in sorted_branches(spot))
    elif spot.items is not None:
        found = f"a list, each item {forms(spot.items)}"
    else:
        found = "a mapping of key paths to values" if spot.entries else "a mapping" if spot.part else "text"
    if spot.short is None:
        return found
    single = [takes(spot.short.leaf)] if spot.short.leaf else []
    return "; or ".join([*([one_of(tuple(spot.short.known))] if spot.short.known else []), *single, found])


def sorted_branches(spot: Spot) -> list[tuple[str, Spot]]:
    """The branches of a union, words first."""
    return sorted((spot.branches or {}).items(), key=lambda item: not item[1].is_tag)


def default_of(spot: Spot, value: Any) -> str:
    """A default as a file would have it."""
    if isinstance(value, Part):
        words = spot.short.known if spot.short else {}
        return next((f"`{word}`" for word, one in words.items() if one == value), "that of each key")
    if value in ((), {}, "", None):
        return "none"
    if spot.leaf is not None and isinstance(value, tuple):
        return f"`[{', '.join(spot.leaf.written(value, as_text=True))}]`"
    unit = f" {spot.leaf.unit}" if isinstance(spot.leaf, Quantity) else ""
    return f"`{shown(value) if isinstance(value, float) else value}{unit}`"


def models_of(spot: Spot) -> tuple[str, dict[str, type[Part]]]:
    """The key that tells the models at a spot apart, empty for a single one, and the models by its value."""
    if spot.parts:
        return spot.key, spot.parts
    parts = [one.part for one in (spot, *(spot.branches or {}).values()) if one.part is not None]
    return "", {"": parts[0]} if parts else {}


def rows_inside(spot: Spot, above: str) -> Iterator[Row]:
    """Rows of all that is in the mapping, or in the items of the list, at a spot."""
    key, models = models_of(spot)
    if models:
        yield from rows_of(key, models, above)
    for one in (spot, *(spot.branches or {}).values()):
        if one.items is not None:
            yield from rows_inside(one.items, f"{above}[]")


def rows_of(key: str, models: Mapping[str, type[Part]], above: str) -> Iterator[Row]:
    """Rows of the keys of one model, or of several that a word at `key` tells apart."""
    names = dict.fromkeys(name for model in models.values() for name in model.model_fields)
    if key:
        told = [f"`{tag}`: {model.model_fields[key].description}" for tag, model in models.items()]
        yield Row(f"{above}.{key}", one_of(tuple(models)), "required", " ".join(told))
    for name in names:
        if name == key:
            continue
        groups: dict[Row, list[str]] = {}
        for tag, model in models.items():
            for row in (
                field_rows(model, name, f"{above}.{name}".removeprefix(".")) if name in model.model_fields else ()
            ):
                groups.setdefault(row, []).append(tag)
        for row, tags in groups.items():
            only = "" if len(tags) == len(models) else f"With {one_of([f'{key}: {tag}' for tag in tags])}: "
            yield Row(row.key, row.takes, row.default, only + row.meaning)


def field_rows(model: type[Part], name: str, path: str) -> Iterator[Row]:
    """The row of a field, of its second key, and of all that is in it."""
    entry, spot = model.model_fields[name], spot_of(model, name)
    meaning, _, told = (entry.description or "").partition(" Default: ")
    group = next((group for group in model.exactly_one if name in group), ())
    second = next((alias for alias in model.aliases if alias.field == name), None)
    usual = find_preset(DEFAULT).leaves.get(tuple(path.split(".")))
    if group or second:
        default = f"exactly one of {one_of(group or (name, second.key if second else ''))}"
    elif usual:
        default = f"`{usual.value}` (usual)"
    elif entry.is_required() or (entry.default is None and entry.validate_default):
        default = USUAL if path in USUAL_PARTS else "required"
    else:
        default = told.rstrip(".") or default_of(spot, entry.default)
    words = ", ".join(f"`{tag}`" for tag in get_args(entry.annotation)) if spot.is_tag else forms(spot)
    yield Row(path, words, default, meaning)
    if second:
        yield Row(path.removesuffix(name) + second.key, takes(second.leaf(model)), default, second.description)
    yield from rows_inside(spot, path)


def section(model: type[Part], name: str) -> str:
    """The chapter of one part of a root."""
    rows = list(field_rows(model, name, name))
    needed = "It is required." if rows[0].default == "required" else f"Default: {rows[0].default}."
    first = f"{rows[0].meaning} `{name}` takes {rows[0].takes}. {needed}\n"
    table = "\n" + ROWS + "".join(map(str, rows[1:])) if rows[1:] else ""
    return f"\n### `{name}`\n\n{first}{table}"


TRAIN = """
## A train

A train begins as a scenario does. It may have {shared} for all its vehicles, with the keys shown above. Where it has
not, those of its first vehicle hold. There they are written in full: usual values are for scenarios alone. Its own
parts are these.
"""
STUDY = """
## A study

The keys under `vary` are key paths of the scenario or the train that it varies, as on this page.

"""


def keys_page() -> str:
    """``keys.md``."""
    wagon = [name for name in Scenario.model_fields if name not in BEGIN]
    own = [name for name in TrainFile.model_fields if name not in (*BEGIN, *SHARED)]
    texts = [
        KEYS,
        "\n## A wagon or a tank alone\n\n",
        table_of(Scenario, BEGIN),
        "\nA tank alone, for `slosh tank`, has of the following only `tank` and `limits`.\n",
        *(section(Scenario, name) for name in wagon),
        TRAIN.format(shared=all_of(f"`{name}`" for name in SHARED)),
        *(section(TrainFile, name) for name in own),
        STUDY,
        table_of(StudyKeys, StudyKeys.model_fields),
    ]
    return "".join(texts)


def table_of(model: type[Part], names: Iterable[str]) -> str:
    """A table of some keys of a root."""
    return ROWS + "".join(str(row) for name in names for row in field_rows(model, name, name))
