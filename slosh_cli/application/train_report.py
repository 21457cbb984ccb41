"""The report of a train: verdict, forces along the train and over time, tables of vehicles and couplings, inputs."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.application.differing import labelled, listed
from slosh_cli.application.input_tables import inputs_table, vehicle_inputs_table
from slosh_cli.application.train_comparison import train_differences
from slosh_cli.report.html import page_table, page_text, plain_numbers
from slosh_cli.results.channels import channel
from slosh_cli.results.train_result import TrainResult

if TYPE_CHECKING:
    from slosh_cli.arrays import Integers, Vector
    from slosh_cli.results.train_result import StoredPart, TrainHistory

_MOST_ROWS: Final = 500
_APPLIED: Final = 0.95
_PROVENANCE: Final = ("program", "program_version", "created", "python_version", "numpy_version", "numba_version")
_GIVEN: Final = "energy_slope_work"
"""The part of the ledger that comes in; all others are there, or were taken."""
_FIGURES: Final = ("coupling_extremes", "train_slosh")
"""Figures that tell what the charts of the page do not."""
_VEHICLES: Final = (
    ("vehicle", None), ("name", lambda one: one["name"]), ("load", lambda one: one["liquid_model"]),
    ("onset, s", lambda one: _short(one["onset_s"])), ("way, m", lambda one: _short(one["distance_m"])),
    ("load at rest, kN", lambda one: _short(np.mean(one["static_wheel_load_N"]) / 1e3)),
    ("least load, kN", lambda one: _short(np.min(one["min_wheel_load_N"]) / 1e3)),
    ("largest load, kN", lambda one: _short(np.max(one["max_wheel_load_N"]) / 1e3)),
    ("unloading, %", lambda one: _short(100.0 * one["max_wheel_unloading"])),
    ("locked, s", lambda one: _short(np.max(one["locked_time_s"]))),
    ("rise, m", lambda one: _short(one["max_surface_m"])), ("room, m", lambda one: _short(one["surface_limit_m"])),
)  # fmt: skip
_COUPLINGS: Final = (
    ("max_compression_N", "compression, kN", 1e3), ("max_compression_s", "at, s", 1.0),
    ("max_tension_N", "tension, kN", 1e3), ("max_tension_s", "at, s", 1.0),
    ("max_compression_m", "run up, mm", 1e-3), ("max_tension_m", "extension, mm", 1e-3),
    ("energy_taken_J", "work taken, kJ", 1e3),
)  # fmt: skip


def train_page(path: Path) -> str:
    """The page of a train's history file. Raises FileError where that cannot be read."""
    from slosh_cli.report.train_figures import draw_train
    from slosh_cli.results.hdf5 import read_train

    train = read_train(path)
    warnings = [*str(train.facts.get("warnings", "")).splitlines(), str(train.facts.get("reason", ""))]
    facts = {
        "title": train.name,
        "verdict": _verdict(train),
        "warnings": [one for one in warnings if one],
        "tables": list(_tables(train)),
        "scenario": train.scenario_text,
    }
    with tempfile.TemporaryDirectory() as folder:
        files = draw_train(train, Path(folder), ("png",), _FIGURES)
        return page_text(facts, {"train": _data(train)}, {file.stem: file for file in files})


def _verdict(train: TrainHistory) -> str:
    facts, told = train.facts, []
    distance, speed = facts.get("braking_distance_m", np.nan), facts["initial_speed_m_s"] * 3.6
    if np.isfinite(distance):
        told.append(
            f"Stopped from {speed:.4g} km/h in {facts['braking_time_s']:.1f} s; the first vehicle went "
            f"{distance:.2f} m since its brake set in."
        )
    else:
        told.append(f"No braking distance: {train.status}.")
    told += [_force_words(train, way) for way in ("compression", "tension") if train.couplings]
    least = max(range(len(train.vehicles)), key=lambda place: train.vehicles[place].facts["max_wheel_unloading"])
    most = 100.0 * train.vehicles[least].facts["max_wheel_unloading"]
    told.append(f"The wheel that is unloaded most loses {most:.0f} % of its load at rest, in vehicle {least + 1}.")
    locks = [float(np.max(one.facts["locked_time_s"])) for one in train.vehicles]
    places = [place for place, time in enumerate(locks, 1) if time > 0.0]
    which = f"{'vehicle' if len(places) == 1 else 'vehicles'} {listed(places)}" if places else ""
    told.append(f"Wheels lock in {which}, for {max(locks):.3g} s at most." if places else "No wheel locks.")
    return " ".join(told)


def _force_words(train: TrainHistory, way: str) -> str:
    forces = [one.facts[f"max_{way}_N"] for one in train.couplings]
    place = int(np.argmax(forces))
    when = train.couplings[place].facts.get(f"max_{way}_s", np.nan)
    at = f" at {when:.1f} s" if np.isfinite(when) and forces[place] > 0.0 else ""
    between = f"between vehicles {place + 1} and {place + 2}"
    return f"The largest {way} is {forces[place] / 1e3:.1f} kN, {between}{at}."


def _data(train: TrainHistory) -> dict[str, Any]:
    """What the page's charts show: every stretch of a force has its value of largest magnitude."""
    every = max(-(-train.time.size // _MOST_ROWS), 1)
    begins = np.arange(0, train.time.size, every)
    shown = dict.fromkeys((0, len(train.vehicles) // 2, len(train.vehicles) - 1))
    onsets = [one.facts["onset_s"] for one in train.vehicles]
    applied = [_first_time(train, one.channels.get("brake_application")) for one in train.vehicles]
    speeds = [
        {"name": f"vehicle {place + 1}", "values": plain_numbers(train.vehicles[place].channels["speed"][begins] * 3.6)}
        for place in shown
    ]
    return {
        "time": plain_numbers(train.time[begins]),
        "forces": [_thinned(one.channels["force"], begins) for one in train.couplings],
        "compression": [_short(one.facts["max_compression_N"] / 1e3) for one in train.couplings],
        "tension": [_short(-one.facts["max_tension_N"] / 1e3) for one in train.couplings],
        "onset": plain_numbers(onsets),
        "applied": plain_numbers(applied),
        "speeds": speeds,
        "vehicles": len(train.vehicles),
    }


def _thinned(force: Vector, begins: Integers) -> list[float]:
    """A force in kN, of each stretch the value of largest magnitude."""
    low, high = np.minimum.reduceat(force, begins), np.maximum.reduceat(force, begins)
    return [_short(value) for value in np.where(-low > high, low, high) / 1e3]


def _first_time(train: TrainHistory, application: Vector | None) -> float:
    reached = np.flatnonzero(application >= _APPLIED) if application is not None else np.array([])
    return float(train.time[reached[0]]) if reached.size else np.nan


def _tables(train: TrainHistory) -> Iterator[dict[str, Any]]:
    sorts = "From the front. A click on a column's name sorts."
    yield page_table("Answers", ("answer", "value", "unit"), list(_answers(train)), "Computed by the model.")
    rows: list[Sequence[Any]] = [
        (place, *(of(one.facts) for _, of in _VEHICLES if of)) for place, one in enumerate(train.vehicles, 1)
    ]
    note = f"{sorts} Loads are of one wheel: at rest the mean, else the least and the largest since the onset."
    yield page_table("Vehicles", [name for name, _ in _VEHICLES], rows, note, sortable=True)
    if train.couplings:
        rows = [_coupling(place, one) for place, one in enumerate(train.couplings, 1)]
        head = ("coupling", "between", *(name for _, name, _ in _COUPLINGS))
        yield page_table("Couplings", head, rows, f"{sorts} Forces are of the whole coupling.", sortable=True)
    if train.scenario_text:
        yield inputs_table(train.scenario_text.split("---\n", 1)[0], "Inputs of the train")
    yield vehicle_inputs_table([str(one.facts["scenario"]) for one in train.vehicles])
    yield page_table("Energy ledger", ("part", "begin, kJ", "end, kJ"), list(_ledger(train)), "Of all vehicles.")
    facts = [(name, str(train.facts[name])) for name in _PROVENANCE if name in train.facts]
    yield page_table("Provenance", ("name", "value"), facts)


def _answers(train: TrainHistory) -> Iterator[tuple[str, str, str]]:
    found = train_differences([train])
    for one in found:
        value = one.values[0]
        yield one.label, "none" if value is None else f"{value / one.per:.6g}", one.unit
    told = {one.name for one in found}
    for answer in TrainResult.table():
        if answer.unit and answer.name in train.facts and answer.name not in told:
            yield labelled(answer.name, answer.meaning), f"{float(train.facts[answer.name]):.6g}", answer.unit


def _coupling(place: int, one: StoredPart) -> tuple[Any, ...]:
    numbers = [_short(one.facts[name] / per) if name in one.facts else "" for name, _, per in _COUPLINGS]
    return (place, f"{place} and {place + 1}", *numbers)


def _ledger(train: TrainHistory) -> Iterator[tuple[str, str, str]]:
    """Energies of all vehicles at the begin and at the end, the work of the couplings, and their sums."""
    total = [0.0, 0.0]
    held = [set(one.channels) for one in train.vehicles]
    names = [name for name in train.vehicles[0].channels if all(name in one for one in held) and _is_energy(name)]
    for name in names:
        begin, end = (sum(float(one.channels[name][row]) for one in train.vehicles) for row in (0, -1))
        sign = -1.0 if name == _GIVEN else 1.0
        total = [total[0] + sign * begin, total[1] + sign * end]
        yield channel(name).long_name, f"{begin / 1e3:.6g}", f"{end / 1e3:.6g}"
    taken = sum(float(one.facts["energy_taken_J"]) for one in train.couplings)
    yield "work that the couplings took", "0", f"{taken / 1e3:.6g}"
    words = "sum, less the work that came in: the same at both ends but for the residual"
    yield words, f"{total[0] / 1e3:.6g}", f"{(total[1] + taken) / 1e3:.6g}"


def _is_energy(name: str) -> bool:
    return name.startswith("energy_") and name != "energy_residual"


def _short(value: float) -> float:
    return float(f"{value:.4g}")
