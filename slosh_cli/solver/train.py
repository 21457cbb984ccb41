"""A run: its vehicles from the front, its clock, and what steers the integrator."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.blocks import Block
from slosh_cli.solver.vehicle import Vehicle
from slosh_cli.train.coupling import Couplings, couplings


class Control(Block):
    """What steers the integrator. SI units.

    `local_tolerance` bounds the error of one step relative to the vehicles' `Scales`. No step is longer than
    `longest_step` (s), nor takes more than `most_slowing` (m/s) from the speed. An event inside a step of no more than
    `event_time` (s) is taken at its end.
    """

    local_tolerance: float
    stop_speed: float
    time_limit: float
    longest_step: float
    most_slowing: float
    event_time: float
    interval: float


class Train(Block):
    """The vehicles of a run, the couplings between them, and its clock.

    `shares` (vehicles,) of the whole mass make the mean speed. `time`, `next_step`, `next_output` s; `middle_at` (s) is
    how long after the start the middle stage stands: before it where it is the last step's, zero where something jumped
    in between and it says nothing. `trying` (s) is the step that is tried next, zero where it is still to be chosen,
    after `event_tries` that had an event inside; `shortened` is 1 where one erred too much, `jumped` where the start's
    accelerations must be found anew. `total_start`, `initial_kinetic` J; `residual_before`, `residual`,
    `largest_residual` are the ledger's, over `initial_kinetic`; the rest counts.
    """

    vehicles: tuple[Vehicle, ...]
    couplings: Couplings
    control: Control
    shares: Vector
    stop_values: Vector
    time: float
    next_step: float
    next_output: float
    last_error: float
    middle_at: float
    total_start: float
    initial_kinetic: float
    residual_before: float
    residual: float
    largest_residual: float
    steps: int
    rejected: int
    rows: int
    stalled: int
    events: int
    jumped: int
    trying: float
    event_tries: int
    shortened: int


def new_train(
    vehicles: tuple[Vehicle, ...], control: Control, first_step: float, law: Couplings | None = None
) -> Train:
    """Vehicles from the front at t = 0; the first step to try in s. Without a `law` they know nothing of each other."""
    masses = np.array([-vehicle.wagon.weight[vehicle.wagon.heaves].sum() for vehicle in vehicles])
    return Train.blank(
        vehicles=vehicles,
        couplings=law if law is not None else couplings(None, np.zeros(0), 0.0),
        control=control,
        shares=masses / masses.sum() if len(vehicles) > 1 else np.ones(1),
        stop_values=np.ones(2),
        next_step=first_step,
        last_error=1.0,
        jumped=1,
    )
