"""Drives the compiled loop: hands it row buffers, reports progress, stops when asked."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from slosh_cli.solver import advance as loop
from slosh_cli.solver.events import EVENT_COUNT
from slosh_cli.solver.ledger import FOUNDATION
from slosh_cli.solver.problem import Array
from slosh_cli.solver.record import SLOSH_COLUMN, record_row
from slosh_cli.solver.setup import Problem
from slosh_cli.solver.state import INITIAL_KINETIC, NEXT_OUTPUT, PHASE, ROWS, TIME, State, new_scratch, new_state

Progress = Callable[[float, float], None]
"""Called now and then with the fraction done (0 to 1) and the speed in m/s."""

WORK_PER_CALL = 100_000
"""Steps times nodes between two looks at progress and cancellation: 15 ms, long beside what a look costs."""
NODES_PER_CELL = 8
"""Rail nodes that take the time of a cell of the liquid, more or less."""
MOST_ROWS = 1 << 14
"""Rows of the record in one piece; memory of some 10 MiB is used again by the next stop, 40 would be new each time."""
FIRST_STEP = 1e-3
"""First step to try, s."""
RINGING = loop.NOT_FINITE + 1
"""Outcome of a stop whose wheels landed on a track that did not take what they put into it."""
SWALLOWED = 0.5
"""It is one where the method took more than this part of what the foundation took."""


class Cancel(Protocol):
    """Something like threading.Event that says when to give up."""

    def is_set(self) -> bool:
        """True when the run should end."""
        ...


class Cancelled(Exception):  # noqa: N818  (not an error: somebody asked for it)
    """The run was cancelled from outside."""


@dataclass(frozen=True, eq=False)
class Run:
    """Raw outcome: the record (rows, columns of `record`), the final state, how it ended, seconds of solving."""

    rows: Array
    state: State
    outcome: int
    seconds: float


def integrate(problem: Problem, progress: Progress | None = None, cancel: Cancel | None = None) -> Run:
    """Run the stop to its end. Raises Cancelled when `cancel` is set before that."""
    model, modes = problem.model, problem.start.slosh.size
    state = new_state(problem.start, problem.cells, EVENT_COUNT, FIRST_STEP)
    scratch = new_scratch(model.rail, modes, problem.cells.area.size)
    buffer = np.empty((_most_rows(problem), SLOSH_COLUMN + 2 * modes))  # pages that stay empty cost nothing
    filled: list[Array] = []
    outcome = loop.RUNNING if loop.begin(model, scratch, state) else loop.UNSOLVED
    loop.advance(model, scratch, state, buffer, 0)  # loads or compiles the machine code before the clock starts
    began = time.perf_counter()
    steps = max(WORK_PER_CALL // (model.rail.nodes + NODES_PER_CELL * problem.cells.area.size), 10)
    while outcome in (loop.RUNNING, loop.ROWS_FULL):
        outcome = loop.advance(model, scratch, state, buffer, steps)
        if outcome == loop.ROWS_FULL:
            filled.append(buffer[: state.counts[ROWS]].copy())
            state.counts[ROWS] = 0
        if cancel is not None and cancel.is_set():
            raise Cancelled
        if progress is not None:
            progress(_fraction(problem, state), float(state.start.v[0]))
    seconds = time.perf_counter() - began
    _record_end(problem, state, buffer)
    if outcome == loop.STOPPED and _is_ringing(problem, state):
        outcome = RINGING
    rows = buffer[: state.counts[ROWS]]
    return Run(np.concatenate([*filled, rows]) if filled else rows, state, outcome, seconds)


def _most_rows(problem: Problem) -> int:
    """Rows to make room for at once: all up to the time limit, or many steps' worth."""
    control = problem.model.control
    per_step = int(control.longest_step / control.interval) + 3
    return max(2 * per_step, min(int(control.time_limit / control.interval) + per_step, MOST_ROWS))


def _record_end(problem: Problem, state: State, buffer: Array) -> None:
    """Add the end of the run as a row of its own, unless an output instant coincides with it."""
    now, interval = state.clock[TIME], problem.model.control.interval
    if abs(state.clock[NEXT_OUTPUT] - interval - now) < 1e-9 * max(interval, now):
        return
    record_row(problem.model, state, buffer[state.counts[ROWS]], now, 1.0, 0.0, state.counts[PHASE])
    state.counts[ROWS] += 1


def _is_ringing(problem: Problem, state: State) -> bool:
    """Whether waves of landing wheels stayed in the rail until steps too long for them took their energy.

    Without damping they run to and fro between the domain's ends, ever shorter, and shake the wheels that made them.
    An L-stable method takes the energy of those too short for its steps, so that the ledger misses it, and the distance
    goes on changing with the tolerance (seen: with a million steps still as much as with ten thousand).
    """
    missing = -float(state.residual[1])
    absorbed = float(state.losses[FOUNDATION] / state.clock[INITIAL_KINETIC])
    return bool(state.lifted[0]) and missing > max(problem.most_missing, SWALLOWED * absorbed)


def _fraction(problem: Problem, state: State) -> float:
    """How far the run has come: by speed lost or by time, whichever is further."""
    control = problem.model.control
    by_speed = 1.0 - float(state.start.v[0]) / float(control.speed_scale[0])
    return min(max(by_speed, float(state.clock[TIME]) / control.time_limit, 0.0), 1.0)
