"""The JSON Schemas of files that speak of a scenario's keys, studies and trains, for editors."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from pydantic.fields import FieldInfo

from slosh_cli.scenario import Scenario, json_schema
from slosh_cli.scenario.presets import TAKEN
from slosh_cli.scenario.schema_train import TrainFile
from slosh_cli.scenario.tree import Spot, spot_of
from slosh_cli.scenario.words import Choice
from slosh_cli.study.plan import LIQUID
from slosh_cli.study.study_file import StudyKeys

_ITEM = "0"
_NOT_VARIED = ("format", "vehicles")
"""Keys of a train that no study varies."""


def study_schema() -> dict[str, Any]:
    """JSON Schema of a study file; the keys to vary are those of a scenario, with what they mean."""
    schema: dict[str, Any] = StudyKeys.editor_schema()
    properties: dict[str, Any] = {
        key: {word: said for word, said in entry.items() if word not in ("title", "default")}
        for key, entry in schema["properties"].items()
    }
    values = properties["vary"].pop("additionalProperties")
    keys = {key: (said, spot) for key, said, spot in _keys(Spot(part=Scenario))}
    varied = _of_keys(values)
    of_trains = {r"^(?:all|vehicles[.][1-9][0-9]*)[.].+$": values}
    own = {key: values for key, _, _ in _keys(Spot(part=TrainFile)) if key.partition(".")[0] not in _NOT_VARIED}
    varied["properties"] = own | varied["properties"]
    varied["patternProperties"] |= of_trains
    properties["vary"] |= {"minProperties": 1} | varied
    properties["liquid"] |= _models(keys[LIQUID][1])
    del schema["description"]
    return {**schema, "title": "Study", "properties": properties, "required": ["base", "vary"]}


def train_schema() -> dict[str, Any]:
    """JSON Schema of a train file; the keys that a vehicle may `set` are those of a scenario, with what they mean."""
    schema: dict[str, Any] = TrainFile.editor_schema()
    schema["$defs"]["TrainEntry"]["properties"]["set"] |= _of_keys({})
    return schema | {"title": "Train"}


def every_schema() -> dict[str, Any]:
    """JSON Schema of every file that `slosh run` and `slosh check` take: a wagon, a tank alone or a train."""
    wagon, train = json_schema(), train_schema()
    definitions = wagon.pop("$defs") | train.pop("$defs")
    dialect = {"$schema": wagon.pop("$schema")}
    del train["$schema"]
    keys = train["properties"] | wagon["properties"]
    names = {key: {word: entry[word] for word in ("description",) if word in entry} for key, entry in keys.items()}
    chosen = {"if": {"required": ["vehicles"]}, "then": train, "else": wagon}
    return {**dialect, "title": "Scenario or train", "$defs": definitions, "properties": names, **chosen}


def _of_keys(values: dict[str, Any]) -> dict[str, Any]:
    """What a mapping of a scenario's key paths to such values may hold, each key with what it means."""
    specs = {key: values | ({"description": said} if said else {}) for key, said, _ in _keys(Spot(part=Scenario))}
    return {
        "properties": {key: spec for key, spec in specs.items() if _ITEM not in key.split(".")},
        "patternProperties": {_pattern(key): spec for key, spec in specs.items() if _ITEM in key.split(".")},
        "additionalProperties": False,
    }


def _keys(spot: Spot, above: str = "", field: FieldInfo | None = None) -> Iterator[tuple[str, str | None, Spot]]:
    """Key path, description and spot of all that can vary: single values, parts as a whole, items of lists."""
    for found in (spot, *(spot.branches or {}).values()):
        for name, entry in found.part.model_fields.items() if found.part else ():
            if name == TAKEN and not above:
                continue
            inner = spot_of(found.part, name)
            yield above + name, entry.description, inner
            yield from _keys(inner, f"{above}{name}.", entry)
        if found.items is not None and (found.items.part or found.items.parts):
            yield above + _ITEM, field.description if field else None, found.items
            yield from _keys(found.items, f"{above}{_ITEM}.")


def _pattern(key: str) -> str:
    """A key path with an item of a list in it, for every item."""
    steps = ["[0-9]+" if step == _ITEM else re.escape(step) for step in key.split(".")]
    return f"^{'[.]'.join(steps)}$"


def _models(spot: Spot) -> dict[str, Any]:
    """Models of the liquid: a list, or a text with commas."""
    words = spot.leaf.options if isinstance(spot.leaf, Choice) else ()
    either = "|".join(map(re.escape, words))
    return {
        "anyOf": [
            {"type": "string", "pattern": rf"^\s*(?:{either})\s*(?:,\s*(?:{either})\s*)*$"},
            {"type": "array", "items": {"enum": list(words)}, "minItems": 1},
        ],
    }
