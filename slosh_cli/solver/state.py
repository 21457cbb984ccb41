"""The moving parts of a run: three points of a step, clocks, sums and the scratch arrays of the kernels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slosh_cli.solver.problem import LOSSES, Array, Cells, Point, empty_point
from slosh_cli.tank.shallow import WORK_ROWS
from slosh_cli.track.banded import ENTRIES
from slosh_cli.track.mem import RailModel
from slosh_cli.track.moving import MATRICES
from slosh_cli.wagon.coordinates import BODIES, COORDINATES, WHEELS

# places in State.clock
TIME, NEXT_STEP, NEXT_OUTPUT, ONSET_TIME, ONSET_POSITION, TOTAL_START, INITIAL_KINETIC, LAST_ERROR, MIDDLE_AT = range(9)
# places in State.counts
STEPS, REJECTED, PHASE, ROWS, STALLED = range(5)
# places in State.work
NEWTON, FACTORISATIONS, RIGHT_HAND_SIDES, EVENTS = range(4)
# unit inputs of the wagon's response: a force up at each wheel, one along the track, a moment on each bogie
PUSH_INPUT, BOGIE_INPUT, INPUTS = WHEELS, WHEELS + 1, WHEELS + 3
UNKNOWNS = WHEELS + 1
"""What is left of wagon and rail at a stage: four wheel loads and the acceleration along the track."""


PUSH_PLACES = 16
"""Length of the shallow-water liquid's account with the wagon, `State.push`."""


class State(NamedTuple):
    """Everything a run changes. `start`, `middle`, `end` are the stages of the step in hand.

    `clock[MIDDLE_AT]` is how long after the start `middle` stands, s: before it where it is the last step's, zero where
    something jumped in between and it says nothing.
    `losses` (7,) J as in `ledger`, `residual` (3,): before, now, largest; `locked`, `airborne` (4,) flags;
    `locked_time` (4,) s; `least`, `largest` (4,) wheel loads (N) since onset; `surface` (1,) largest rise, m;
    `load_sum` (2,): N s of all wheels since onset, and the s. `push` (16,): the shallow-water liquid's account with the
    wagon, see `cells`.
    """

    start: Point
    middle: Point
    end: Point
    clock: Array
    counts: NDArray[np.int64]
    work: NDArray[np.int64]
    locked: NDArray[np.bool_]
    airborne: NDArray[np.bool_]
    energies_before: Array
    energies: Array
    losses_before: Array
    losses: Array
    residual: Array
    locked_time: Array
    least: Array
    largest: Array
    surface: Array
    load_sum: Array
    lifted: NDArray[np.int64]
    values_before: Array
    values: Array
    cells_start: Cells
    cells_end: Cells
    push: Array


class Scratch(NamedTuple):
    """Work space of the kernels; nothing in it outlives a step."""

    base: Point
    rail_rows: Array
    rail_factors: Array
    flexibility: Array
    missing: Array
    rail_error: Array
    rail_error_rate: Array
    rail_zero: Array
    slosh_zero: Array
    linear: Array
    response: Array
    inputs: Array
    free_bodies: Array
    right: Array
    q_error: Array
    v_error: Array
    pivots: NDArray[np.int64]
    contact_flexibility: Array
    coupled: Array
    coupled_right: Array
    load_before: Array
    load_change: Array
    load_gap: Array
    creep_change: Array
    spin_change: Array
    spin_gap: Array
    load_gain: Array
    speed_gain: Array
    spin_gain: Array
    normal_slope: Array
    creep_by_normal: Array
    creep_by_slip: Array
    creep_by_speed: Array
    resistance_slope: Array
    factored: Array
    free: Array
    cell_work: Array
    cell_sums: Array


def new_scratch(rail: RailModel, modes: int, cells: int) -> Scratch:
    """Work space for a `rail` and a liquid of `modes` and `cells`."""
    unknowns = 2 * rail.nodes
    return Scratch(
        base=empty_point(unknowns, modes),
        rail_rows=np.zeros((rail.runs.shape[0], MATRICES)),
        rail_factors=np.zeros((ENTRIES, rail.nodes)),
        flexibility=np.zeros((rail.nodes, 2, WHEELS)),
        **{name: np.zeros(unknowns) for name in _RAIL_VECTORS},
        slosh_zero=np.zeros(modes),
        linear=np.zeros((BODIES, BODIES)),
        response=np.zeros((INPUTS, BODIES)),
        inputs=np.zeros(INPUTS),
        free_bodies=np.zeros(BODIES),
        **{name: np.zeros(COORDINATES) for name in ("right", "q_error", "v_error")},
        pivots=np.zeros(UNKNOWNS, dtype=np.int64),
        contact_flexibility=np.zeros((WHEELS, WHEELS)),
        coupled=np.zeros((UNKNOWNS, UNKNOWNS)),
        coupled_right=np.zeros(UNKNOWNS),
        **{name: np.zeros(WHEELS) for name in _WHEEL_VECTORS},
        resistance_slope=np.zeros(1),
        factored=np.zeros(2),
        free=np.zeros(WHEELS),
        cell_work=np.zeros((WORK_ROWS, cells + 1)),
        cell_sums=np.zeros(4),
    )


_RAIL_VECTORS = ("missing", "rail_error", "rail_error_rate", "rail_zero")
_WHEEL_VECTORS = (
    "load_before", "load_change", "load_gap", "creep_change", "spin_change", "spin_gap",
    "load_gain", "speed_gain", "spin_gain", "normal_slope",
    "creep_by_normal", "creep_by_slip", "creep_by_speed",
)  # fmt: skip


def new_state(start: Point, cells: Cells, events: int, first_step: float) -> State:
    """State at t = 0 from the initial `start` and `cells`; (events,) event values; the first step to try in s."""
    unknowns, modes = start.rail.size, start.slosh.size
    clock = np.zeros(9)
    clock[NEXT_STEP] = first_step
    clock[LAST_ERROR] = 1.0
    return State(
        start=start,
        middle=empty_point(unknowns, modes),
        end=empty_point(unknowns, modes),
        clock=clock,
        counts=np.zeros(5, dtype=np.int64),
        work=np.zeros(4, dtype=np.int64),
        locked=np.zeros(WHEELS, dtype=np.bool_),
        airborne=np.zeros(WHEELS, dtype=np.bool_),
        energies_before=np.zeros(3),
        energies=np.zeros(3),
        losses_before=np.zeros(LOSSES),
        losses=np.zeros(LOSSES),
        residual=np.zeros(3),
        locked_time=np.zeros(WHEELS),
        least=np.full(WHEELS, np.inf),
        largest=np.full(WHEELS, -np.inf),
        surface=np.zeros(1),
        load_sum=np.zeros(2),
        lifted=np.zeros(1, dtype=np.int64),
        values_before=np.ones(events),
        values=np.ones(events),
        cells_start=cells,
        cells_end=Cells._make(column.copy() for column in cells),
        push=np.zeros(PUSH_PLACES),
    )
