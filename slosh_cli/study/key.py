"""What makes two stops the same stop."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.scenario import Scenario
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.plain_data import plain_data
from slosh_cli.scenario.schema_train import TrainFile
from slosh_cli.scenario.train_file import TrainScenario

if TYPE_CHECKING:
    from slosh_cli.study.plan import Study

RESULT_VERSION: Final = 4
"""Raise it whenever the same scenario would give another answer: journals then compute every stop anew."""

_SAYS_NOTHING: Final = ("name", "description", "presets", "output")
"""Parts of a scenario that its answer does not depend on."""


def stop_key(scenario: Scenario | TrainScenario) -> str:
    """sha256 (hexadecimal) of all that the answer of a stop depends on: the scenario and RESULT_VERSION.

    The scenario is the resolved one, every default written out, without its words and what it is to put out; of a train
    its file and every vehicle.
    """
    return _key(scenario, _SAYS_NOTHING)


def history_key(scenario: Scenario | TrainScenario) -> str:
    """sha256 (hexadecimal) of all that the history of a stop depends on: the whole scenario and RESULT_VERSION."""
    return _key(scenario, ())


def study_key(study: Study) -> dict[str, Any]:
    """What tells studies apart: a hash of the base scenario and the values of every axis."""
    axes = {axis.key: list(axis.values) for axis in study.axes}
    return {"base": _key(study.base, _SAYS_NOTHING, version=0), "axes": axes}


def extends(study: Mapping[str, Any], earlier: Mapping[str, Any]) -> bool:
    """Whether a study holds every stop of an earlier one; both as `study_key` has them."""
    axes, others = study["axes"], earlier["axes"]
    same = study["base"] == earlier["base"] and set(axes) == set(others)
    return same and all(set(values) <= set(axes[key]) for key, values in others.items())


def _key(scenario: Scenario | TrainScenario, without: tuple[str, ...], version: int | None = None) -> str:
    telling: list[str] = []
    said: Scenario | TrainFile
    if isinstance(scenario, TrainScenario):
        kinds = {id(vehicle): _key(vehicle, without, version) for vehicle in scenario.vehicles}
        telling = [f'"vehicles":[{",".join(kinds[id(vehicle)] for vehicle in scenario.vehicles)}]']
        said, without = scenario.file, (*without, "vehicles")
    else:
        said = scenario
    without = without if said.presets else (*without, "presets")
    parts = {name: part for name, part in sorted(vars(said).items()) if name not in without}
    telling += [f'"{name}":{_text(tuple(p.items()) if isinstance(p, dict) else p)}' for name, p in parts.items()]
    number = RESULT_VERSION if version is None else version
    return hashlib.sha256(f"[{number},{{{','.join(telling)}}}]".encode()).hexdigest()


@lru_cache(maxsize=256)
def _text(part: Part | tuple[Any, ...] | int | str | None) -> str:
    """JSON of a part, the same for the same values; the stops of a study share most parts."""
    data = plain_data(part, as_text=True) if isinstance(part, Part) else part
    return json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
