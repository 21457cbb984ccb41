"""What may be wrong with the history of a run or of a train: what to do to an open file, by a name for it."""

from collections.abc import Callable
from typing import Any

import h5py
import numpy as np

Spoil = Callable[[h5py.File], object]
ROWS = 50


def _clear(file: h5py.File, name: str) -> None:
    if name in file or file.get(name, getlink=True) is not None:
        del file[name]


def dataset(name: str, **how: Any) -> Spoil:
    """Another dataset in the place of one."""

    def spoil(file: h5py.File) -> None:
        _clear(file, name)
        file.create_dataset(name, **how)

    return spoil


def put(name: str, what: object) -> Spoil:
    """A link, or a type, in the place of a dataset or group."""

    def spoil(file: h5py.File) -> None:
        _clear(file, name)
        file[name] = what

    return spoil


def group(name: str) -> Spoil:
    """An empty group in the place of a dataset or a group."""

    def spoil(file: h5py.File) -> None:
        _clear(file, name)
        file.create_group(name)

    return spoil


def virtual(name: str) -> Spoil:
    """A dataset whose numbers are those of another file."""

    def spoil(file: h5py.File) -> None:
        _clear(file, name)
        layout = h5py.VirtualLayout((ROWS,), dtype="f8")
        layout[:] = h5py.VirtualSource("other.h5", "x", shape=(ROWS,))
        file.create_virtual_dataset(name, layout)

    return spoil


def filled(name: str, value: float) -> Spoil:
    """The same number in every row."""
    return lambda file: file[name].__setitem__(Ellipsis, value)


def attribute(name: str, value: object, holder: str = "/") -> Spoil:
    """Another value of an attribute; none where that is None."""

    def spoil(file: h5py.File) -> None:
        if value is None:
            del file[holder].attrs[name]
        else:
            file[holder].attrs[name] = value

    return spoil


WRONG: dict[str, Callable[[str], Spoil]] = {
    "a column of 1e12 rows that holds nothing": lambda name: dataset(name, shape=(10**12,), dtype="f8"),
    "a column of 1e7 rows that holds nothing": lambda name: dataset(name, shape=(10**7,), dtype="f8"),
    "chunks that hold nothing": lambda name: dataset(name, shape=(10**7,), dtype="f8", chunks=(10**5,)),
    "a table of 1e12 cells": lambda name: dataset(name, shape=(10**6, 10**6), dtype="f8", chunks=(1000, 1000)),
    "texts": lambda name: dataset(name, data=["a"] * ROWS, dtype=h5py.string_dtype()),
    "empty": lambda name: dataset(name, data=h5py.Empty("f8")),
    "no rows": lambda name: dataset(name, shape=(0,), dtype="f8"),
    "a single number": lambda name: dataset(name, data=1.0),
    "complex numbers": lambda name: dataset(name, data=np.zeros(ROWS, complex)),
    "truth values": lambda name: dataset(name, data=np.zeros(ROWS, bool)),
    "records": lambda name: dataset(name, data=np.zeros(ROWS, [("a", "f8")])),
    "references": lambda name: dataset(name, shape=(ROWS,), dtype=h5py.ref_dtype),
    "lists": lambda name: dataset(name, shape=(ROWS,), dtype=h5py.vlen_dtype("f8")),
    "bytes": lambda name: dataset(name, data=np.zeros(ROWS, "V8")),
    "a group": group,
    "a link to nothing": lambda name: put(name, h5py.SoftLink("/nowhere")),
    "a link to itself": lambda name: put(name, h5py.SoftLink(f"/{name}")),
    "a link to another file": lambda name: put(name, h5py.ExternalLink("run.h5", "/time")),
    "a link to a pipe": lambda name: put(name, h5py.ExternalLink("pipe", "/time")),
    "numbers of another file": virtual,
    "numbers of the system's": lambda name: dataset(name, shape=(9,), dtype="f8", external=[("/etc/passwd", 0, 72)]),
    "a type": lambda name: put(name, np.dtype("f8")),
}
"""What may stand in the place of a dataset, none of which is a column of numbers."""
SETS = {
    "run": ("time", "speed", "surface_profile", "scenario"),
    "train": ("time", "vehicle_001/speed", "coupling_002/force"),
}
NUMBERS = {"nan": np.nan, "infinity": np.inf, "1e308": 1e308}
VALUES = {
    "text": "nonsense",
    "five numbers": np.zeros(5),
    "nothing": None,
    "empty": h5py.Empty("f8"),
    "bytes": np.bytes_(b"\xff"),
    "a complex number": 1j,
    "infinity": np.inf,
}
NEEDED = {
    "run": (("status", "/"), ("braking_distance_m", "/"), ("static_wheel_load_N", "/"), ("initial_speed_m_s", "/")),
    "train": (
        ("status", "/"),
        ("braking_distance_m", "/"),
        ("onset_s", "vehicle_002"),
        ("max_tension_N", "coupling_001"),
    ),
}


def spoils(kind: str) -> dict[str, Spoil]:
    """Everything that makes a history of a kind, run or train, one that must be refused."""
    found = {f"{name}: {words}": make(name) for name in SETS[kind] for words, make in WRONG.items()}
    found |= {f"{name}: {words}": filled(name, value) for name in SETS[kind][:2] for words, value in NUMBERS.items()}
    found |= {
        f"{holder} {name}: {words}": attribute(name, value, holder)
        for name, holder in NEEDED[kind]
        for words, value in VALUES.items()
    }
    if kind == "train":
        found["vehicle_001 without its scenario"] = attribute("scenario", None, "vehicle_001")
    if kind == "run":
        texts = {"a list": "- 1\n", "a name": "name: x\n", "brackets": "[" * 5000, "a half": 'name: "\\ud83d"\n'}
        text = h5py.string_dtype()
        found |= {f"scenario: {words}": dataset("scenario", data=one, dtype=text) for words, one in texts.items()}
        found["scenario: no UTF-8"] = dataset("scenario", data=np.bytes_(b"\xff\xfe"))
        found["scenario: 400 MB"] = dataset("scenario", shape=(), dtype="S400000000")
    else:
        found["a vehicle less"] = lambda file: file.__delitem__("vehicle_003")
        found["20,000 vehicles"] = lambda file: [file.create_group(f"vehicle_{n:05d}") for n in range(20_000)]
        found["vehicle_001: a column"] = dataset("vehicle_001", data=np.zeros(ROWS))
        found["status: another"] = attribute("status", "nonsense")
    return found
