"""The words that go with the figures of a run, and what a figure asks of it."""

from textwrap import shorten
from typing import Final

import numpy as np

from slosh_cli.results.channels import wheel
from slosh_cli.results.result import Record, Status

FORMATS: Final = ("png", "svg")
"""Kinds of files that every figure is written as."""

FIGURE_NAMES: Final = ("contact_forces", "speed_distance", "wheel_speed", "slosh")
"""Every figure of a run, by the name of its files."""

_LOCKED_SPEED = 1e-3
"""Circumferential speed in m/s below which a wheel under a moving wagon counts as locked in a figure."""


def conditions(record: Record) -> str:
    """Scenario, speed, torque and load in one line, for the head of a figure."""
    load = f"liquid ({record.liquid_model})" if record.has_liquid else "equivalent solid"
    speed = f"{record.initial_speed_m_s * 3.6:.4g} km/h"
    torque = f"{record.torque_N_m / 1e3:.4g} kN m per wheel"
    return f"{shorten(record.name, 48, placeholder='...')}: V₀ = {speed}, {torque}, {load}"


def caption(record: Record) -> str:
    """What a reader must know before trusting the figure: how the run ended, its warnings; mostly empty."""
    ended = [] if record.status is Status.STOPPED else [f"The run ended as {record.status}: {record.reason}"]
    return "\n".join([*ended, *(f"Warning: {warning}" for warning in record.warnings)])


def locked_stretches(record: Record, i: int) -> list[tuple[float, float]]:
    """Start and duration in s of every stretch in which wheel `i` stands while the wagon moves."""
    locked = np.abs(record.channels[wheel(i, "speed")]) < _LOCKED_SPEED
    locked &= record.channels["speed"] > _LOCKED_SPEED
    edges = np.flatnonzero(np.diff(np.concatenate(([False], locked, [False])).astype(np.int8)))
    last = len(record.time) - 1
    return [
        (float(record.time[start]), float(record.time[min(end, last)] - record.time[start]))
        for start, end in edges.reshape(-1, 2)
    ]
