"""Random trains of 2 to 20 random wagons."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from slosh_cli.scenario.train_file import TrainScenario, load_train

from .wagons import KM_H, PACKAGED, Overrides, adhesion, body, brake, line, tank, track

_LONGEST = 20
_FEWEST_CELLS = 20
_FILE = """format: 1
name: campaign
vehicles: [{{scenario: {packaged}, count: {count}}}]
braking: {{initial_speed: 80 km/h, onset: 0.5 s}}
"""


def train(seed: int) -> Overrides:
    """A stop of a random train: overrides of one of `vehicles` packaged wagons."""
    draw = np.random.default_rng([seed, 1])
    count = int(min(2 + draw.geometric(0.25), _LONGEST))
    kinds = [_vehicle(draw) for _ in range(min(count, int(draw.integers(1, 4))))]
    found: Overrides = {"vehicles": count}
    for place in range(1, count + 1):
        own = kinds[int(draw.integers(0, len(kinds)))]
        found |= {f"vehicles.{place}.{key}": value for key, value in own.items()}
    ground = track(draw)
    if count > 6:
        ground["track.model"] = "rigid"
    dips = {"wagon.bogie.wheelbase": 2.6, "wagon.pivot_spacing": 15.5, "wagon.wheelset.wheel_radius": 0.3}
    ground |= {key: value for key, value in line(draw, dips).items() if key.startswith("track.")}
    return found | {
        **{f"all.{key}": value for key, value in ground.items()},
        "all.contact.adhesion": adhesion(draw),
        "coupling": str(draw.choice(["screw", "automatic"], p=(0.7, 0.3))),
        "brake_pipe.speed": float(draw.uniform(150.0, 290.0)),
        "braking.initial_speed": float(draw.uniform(5.0, 120.0)) / KM_H,
        "braking.onset": float(draw.uniform(0.0, 1.0)),
        "all.solver.time_limit": 300.0,
        "all.output.interval": 0.05,
    }


def _vehicle(draw: np.random.Generator) -> Overrides:
    found = body(draw)
    found |= {"tank": tank(draw, found["wagon.pivot_spacing"])} | brake(draw)
    if found["tank"]["liquid"]["model"] == "shallow-water":
        found["tank"]["liquid"]["cells"] = _FEWEST_CELLS
    return found | {"wagon.length_over_buffers": found["wagon.pivot_spacing"] * 1.2 + 3.0}


def train_of(overrides: Mapping[str, Any]) -> TrainScenario:
    """The train of the overrides; ScenarioError where it is refused."""
    own = {key: value for key, value in overrides.items() if key != "vehicles"}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "train.yaml"
        file.write_text(_FILE.format(packaged=PACKAGED, count=overrides["vehicles"]), encoding="utf-8")
        return load_train(file).with_(own)
