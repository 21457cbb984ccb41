"""The JSON Schema of a study file, for editors."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from slosh_cli.scenario import Scenario
from slosh_cli.scenario.base import _DIALECT as DIALECT
from slosh_cli.scenario.base import OWN, Part
from slosh_cli.scenario.tree import spot_of
from slosh_cli.scenario.words import NAME, Choice
from slosh_cli.study.plan import LIQUID
from slosh_cli.study.study_file import KEYS

_ITEM = "0"


def study_schema() -> dict[str, Any]:
    """JSON Schema of a study file; the keys to vary are those of a scenario, with what they mean."""
    keys = dict(_keys(Scenario))
    named = {key: _spec(field) for key, field in keys.items() if _ITEM not in key.split(".")}
    items = {_pattern(key): _spec(field) for key, field in keys.items() if _ITEM in key.split(".")}
    described = {
        "name": {**NAME.json_schema(), "description": "Name of the study, and of its folder. Default: the file's own."},
        "description": {"description": "What the study is about."},
        "base": {
            "type": "string",
            "minLength": 1,
            "description": "Path of the scenario, from this file; or the name of a packaged one.",
        },
        "vary": {
            "type": "object",
            "minProperties": 1,
            "properties": named,
            "patternProperties": items,
            "additionalProperties": False,
            "description": "Keys of the scenario with the values they take: a list, or a range `start:stop:step`.",
        },
        "liquid": _models(keys[LIQUID]),
    }
    return {
        "$schema": DIALECT,
        "title": "Study",
        "type": "object",
        "properties": {key: described[key] for key in KEYS},
        "required": ["base", "vary"],
        "additionalProperties": False,
        "patternProperties": {f"^{OWN}": True},
    }


def _keys(model: type[Part], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Key path and field of all that can vary: single values, parts as a whole, items of lists."""
    for name, field in model.model_fields.items():
        key = f"{prefix}{name}"
        yield key, field
        spot = spot_of(model, name)
        for found in (spot, *(spot.branches or {}).values()):
            if found.part is not None:
                yield from _keys(found.part, f"{key}.")
            if found.items is not None and found.items.part is not None:
                yield f"{key}.{_ITEM}", field
                yield from _keys(found.items.part, f"{key}.{_ITEM}.")


def _pattern(key: str) -> str:
    """A key path with an item of a list in it, for every item."""
    steps = ["[0-9]+" if step == _ITEM else re.escape(step) for step in key.split(".")]
    return f"^{'[.]'.join(steps)}$"


def _spec(field: Any) -> dict[str, Any]:
    """The values of an axis as a file may give them: one, several in a text, or a list."""
    single = {"type": ["string", "number", "boolean", "object"]}
    spec = {"anyOf": [single, {"type": "array", "minItems": 1}]}
    return {**spec, "description": field.description} if field.description else spec


def _models(field: Any) -> dict[str, Any]:
    """Models of the liquid: a list, or a text with commas."""
    leaf = next((e for e in field.metadata if isinstance(e, Choice)), None)
    words = leaf.options if isinstance(leaf, Choice) else ()
    listed = "|".join(map(re.escape, words))
    return {
        "anyOf": [
            {"type": "string", "pattern": rf"^\s*(?:{listed})\s*(?:,\s*(?:{listed})\s*)*$"},
            {"type": "array", "items": {"enum": list(words)}, "minItems": 1},
        ],
        "description": "Models of the load. Default: the scenario's own and rigid.",
    }
