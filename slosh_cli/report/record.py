"""What a figure needs to know of a run, and the words that go with it."""

from collections.abc import Mapping
from textwrap import shorten
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from slosh_cli.results.channels import wheel
from slosh_cli.results.result import PerWheel, Status, Vector

LOCKED_SPEED = 1e-3
"""Circumferential speed in m/s below which a wheel under a moving wagon counts as locked in a figure."""


class Record(Protocol):
    """A run in memory (`Result`) or read back from its file (`History`)."""

    @property
    def name(self) -> str: ...
    @property
    def status(self) -> Status: ...
    @property
    def warnings(self) -> tuple[str, ...]: ...
    @property
    def reason(self) -> str: ...
    @property
    def time(self) -> Vector: ...
    @property
    def channels(self) -> Mapping[str, Vector]: ...
    @property
    def initial_speed_m_s(self) -> float: ...
    @property
    def torque_N_m(self) -> float: ...  # noqa: N802
    @property
    def onset_s(self) -> float: ...
    @property
    def liquid_model(self) -> str: ...
    @property
    def surface_limit_m(self) -> float: ...
    @property
    def braking_distance_m(self) -> float | None: ...
    @property
    def static_wheel_load_N(self) -> PerWheel: ...  # noqa: N802


def has_liquid(record: Record) -> bool:
    """Whether the load of the run can slosh."""
    return record.liquid_model != "rigid"


def conditions(record: Record) -> str:
    """Scenario, speed, torque and load in one line, for the head of a figure."""
    load = f"liquid ({record.liquid_model})" if has_liquid(record) else "equivalent solid"
    speed = f"{record.initial_speed_m_s * 3.6:.4g} km/h"
    torque = f"{record.torque_N_m / 1e3:.4g} kN m per wheel"
    return f"{shorten(record.name, 48, placeholder='...')}: V₀ = {speed}, {torque}, {load}"


def caption(record: Record) -> str:
    """What a reader must know before trusting the figure: how the run ended, its warnings; mostly empty."""
    ended = [] if record.status is Status.STOPPED else [f"The run ended as {record.status}: {record.reason}"]
    return "\n".join([*ended, *(f"Warning: {warning}" for warning in record.warnings)])


def locked_stretches(record: Record, i: int) -> list[tuple[float, float]]:
    """Start and duration in s of every stretch in which wheel `i` stands while the wagon moves."""
    locked = np.abs(record.channels[wheel(i, "speed")]) < LOCKED_SPEED
    locked &= record.channels["speed"] > LOCKED_SPEED
    edges = np.flatnonzero(np.diff(np.concatenate(([False], locked, [False])).astype(np.int8)))
    last = len(record.time) - 1
    return [
        (float(record.time[start]), float(record.time[min(end, last)] - record.time[start]))
        for start, end in edges.reshape(-1, 2)
    ]


def slip_percent(record: Record, i: int) -> NDArray[np.float64]:
    """Creepage of wheel `i` in percent."""
    return 100.0 * record.channels[wheel(i, "creepage")]
