"""A good file of every kind that a person can give, for tests to spoil."""

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from plausible import plausible_run

from slosh_cli.results.hdf5 import write_history
from slosh_cli.results.train_result import CouplingResult, TrainResult, VehicleResult
from slosh_cli.scenario import load_scenario

SCENARIOS = Path(__file__).parents[2] / "scenarios"
STUDY = "name: fills\nbase: paper-80-liquid\nvary:\n  braking.onset: 0.5:1:0.1 s\n  contact.adhesion: [dry, wet]\n"
CHANNELS = ("speed", "position", "brake_application", "surface_front")


@dataclass(frozen=True)
class Good:
    """Texts of a scenario, a train and a study; the histories of a run and of a train."""

    scenario: str
    train: str
    study: str
    run: Path
    train_run: Path


def good_files(folder: Path) -> Good:
    """Write the histories into a folder; nothing is simulated for them."""
    paper = SCENARIOS / "paper_80.yaml"
    result = plausible_run(load_scenario(paper), interval=0.2)
    write_history(result, folder / "run.h5")
    _write_train(folder / "train.h5", result.time, 3)
    texts = (paper, SCENARIOS / "trains" / "block_train.yaml")
    scenario, train = (path.read_text(encoding="utf-8") for path in texts)
    return Good(scenario, train, STUDY, folder / "run.h5", folder / "train.h5")


def _write_train(path: Path, time: np.ndarray, vehicles: int) -> None:
    with h5py.File(path, "w") as file:
        file["time"], file["scenario"] = time, "name: train\n"
        _tell(file, TrainResult)
        file.attrs.update({"train_format_version": 1, "name": "train", "program": "slosh", "status": "stopped"})
        for number in range(1, vehicles + 1):
            part = file.create_group(f"vehicle_{number:03d}")
            _tell(part, VehicleResult)
            part.attrs.update({"name": "wagon", "liquid_model": "modal", "scenario": "name: wagon\n"})
            for name in CHANNELS:
                part[name] = np.linspace(1.0, 0.0, time.size)
        for number in range(1, vehicles):
            part = file.create_group(f"coupling_{number:03d}")
            _tell(part, CouplingResult)
            for name in ("force", "compression"):
                part[name] = np.linspace(-1e4, 1e4, time.size)


def _tell(holder: h5py.Group, answers: type[TrainResult | VehicleResult | CouplingResult]) -> None:
    for one in answers.table():
        if one.unit:
            value = np.full(4, 5.0) if one.kind == tuple[float, ...] else 5 if one.kind is int else 5.0
            holder.attrs[one.name] = value
