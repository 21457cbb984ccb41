"""The brake torque as the time integrator sees it: a function of time between its breaks."""

from __future__ import annotations

from typing import NamedTuple

from slosh_cli.compiled import kernel


class Brake(NamedTuple):
    """A constant torque (N m per wheel) from the onset (s) on."""

    torque: float
    onset: float


@kernel
def brake_torque(brake, time, phase):
    """Torque (N m) that each brake can hold or apply at `time` (s) once `phase` breaks have passed."""
    return brake.torque if phase > 0 else 0.0


@kernel
def next_break(brake, phase):
    """Time (s) of the next discontinuity of the torque; steps end there. Infinite when there is none."""
    return brake.onset if phase == 0 else float("inf")
