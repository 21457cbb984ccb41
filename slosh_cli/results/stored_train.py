"""A train's stop read back: what its file must hold, apart from the format it is kept in."""

from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.results.answers import Answer
from slosh_cli.results.channels import TIME
from slosh_cli.results.hdf5_parts import SURFACE
from slosh_cli.results.stored import faults_of_answers, faults_of_columns, faults_of_shape, plain_attributes
from slosh_cli.results.train_result import CouplingResult, StoredPart, TrainHistory, TrainResult, VehicleResult
from slosh_cli.scenario.schema_train import MOST_VEHICLES

VEHICLE: Final = "vehicle_"
COUPLING: Final = "coupling_"
SCENARIO: Final = "scenario"
_PARTS: Final[Mapping[str, tuple[tuple[Answer, ...], tuple[str, ...]]]] = {
    VEHICLE: (VehicleResult.table(), ("speed", "position", "brake_application", "surface_front")),
    COUPLING: (CouplingResult.table(), ("force", "compression")),
}
"""Answers of a part of a train, and the channels that figures cannot do without, by what its group is called."""


def stored_train(file: Any, text: str) -> TrainHistory | list[str]:
    """The train of an open file, with its scenario, or what is wrong in words that follow the name of the file."""
    attributes = plain_attributes(file)
    names = {kind: sorted(name for name in file if name.startswith(kind)) for kind in _PARTS}
    faults = [
        *faults_of_answers(TrainResult.table(), attributes),
        *faults_of_shape(TIME.name, file.get(TIME.name)),
        *_faults_of_counts(len(names[VEHICLE]), len(names[COUPLING])),
    ]
    faults = faults or [
        fault for kind, some in names.items() for name in some for fault in _faults_of(file, kind, name)
    ]
    if faults:
        return faults
    time = _column(file, TIME.name)
    parts = {kind: tuple(_part(file[name]) for name in some) for kind, some in names.items()}
    for kind, some in names.items():
        for name, part in zip(some, parts[kind], strict=True):
            columns = {f"{name}/{key}": values for key, values in part.channels.items()}
            faults += faults_of_columns(time, columns, {f"{name}/{key}" for key in _PARTS[kind][1]})
    return faults or TrainHistory(str(attributes["name"]), time, parts[VEHICLE], parts[COUPLING], attributes, text)


def _faults_of_counts(vehicles: int, couplings: int) -> Iterator[str]:
    if not 1 <= vehicles <= MOST_VEHICLES:
        yield f"it must have from 1 to {MOST_VEHICLES} vehicles, but has {vehicles}"
    elif couplings != vehicles - 1:
        yield f"it must have {vehicles - 1} couplings for {vehicles} vehicles, but has {couplings}"


def _faults_of(file: Any, kind: str, name: str) -> Iterator[str]:
    """What is wrong with a part, none of whose numbers has been read yet."""
    group, (answers, needed) = file.get(name), _PARTS[kind]
    if not hasattr(group, "keys"):
        yield f"its {name} must be a group of channels"
        return
    yield from (f"of its {name} {fault}" for fault in faults_of_answers(answers, plain_attributes(group)))
    if kind == VEHICLE and not isinstance(plain_attributes(group).get(SCENARIO), str):
        yield f"its {name} lacks the text {SCENARIO}"
    missing = [key for key in needed if key not in group]
    if missing:
        yield f"its {name} lacks the channels {', '.join(missing)}"
    yield from (fault for key in _columns_of(group) for fault in faults_of_shape(f"{name}/{key}", group.get(key)))


def _part(group: Any) -> StoredPart:
    return StoredPart(plain_attributes(group), {key: _column(group, key) for key in _columns_of(group)})


def _column(group: Any, name: str) -> Vector:
    return np.asarray(group[name][:], dtype=np.float64)


def _columns_of(group: Any) -> list[str]:
    """What is in a part of a train beside the surface along its tank."""
    return [key for key in group if not key.startswith(SURFACE)]
