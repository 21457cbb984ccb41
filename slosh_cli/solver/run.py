"""Drives the compiled loop: hands it row buffers, reports progress, stops when asked."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from slosh_cli.arrays import Cube
from slosh_cli.errors import PhysicsError
from slosh_cli.method import START
from slosh_cli.scenario.units import at_least
from slosh_cli.solver import advance as loop
from slosh_cli.solver.booking import record
from slosh_cli.solver.record import columns_of
from slosh_cli.solver.setup import ReadyStop
from slosh_cli.solver.train import Train
from slosh_cli.solver.vehicle import FOUNDATION
from slosh_cli.tank.cells import CellLiquid
from slosh_cli.tank.mixed import own_liquid
from slosh_cli.train.coupling import COUPLING_COLUMNS

Progress = Callable[[float, float], None]
"""Called now and then with the fraction done (0 to 1) and the speed in m/s."""

_WORK_PER_CALL = 100_000
"""Steps times nodes between two looks at progress and cancellation: 15 ms, long beside what a look costs."""
_NODES_PER_CELL = 8
"""Rail nodes that take the time of a cell of the liquid, more or less."""
_MOST_ROWS = 1 << 14
"""Rows of the record in one piece; memory of some 10 MiB is used again by the next stop, 40 would be new each time."""
_PIECE = 1 << 26
"""Bytes of every further piece: so large that the system has them back as soon as they are let go (glibc: 32 MiB)."""
_LARGEST_RECORD = 1 << 32
"""Bytes of a record: a wagon alone stays below with as many rows as a scenario may have."""
RINGING = loop.NOT_FINITE + 1
"""Outcome of a stop whose wheels landed on a track that did not take what they put into it."""
_SWALLOWED = 0.5
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
    """Raw outcome: rows (rows, vehicles, columns of `record`), the final state, how it ended, seconds of solving."""

    rows: Cube
    train: Train
    outcome: int
    seconds: float


def integrate(problem: ReadyStop, progress: Progress | None = None, cancel: Cancel | None = None) -> Run:
    """Run the stop to its end. Raises Cancelled when `cancel` is set before that."""
    train = problem.train
    buffer, steps = _buffer(train), max(_WORK_PER_CALL // _work_per_step(train), 10)
    filled: list[Cube] = []
    outcome = loop.advance(train, buffer, 0)  # loads or compiles the machine code before the clock starts
    began = time.perf_counter()
    while outcome in (loop.RUNNING, loop.ROWS_FULL):
        outcome = loop.advance(train, buffer, steps)
        if outcome == loop.ROWS_FULL:
            filled.append(buffer[: train.rows])
            _check_size(train, filled)
            buffer, train.rows = _buffer(train, _PIECE), 0
        if cancel is not None and cancel.is_set():
            raise Cancelled
        if progress is not None:
            progress(_fraction(train), mean_speed(train))
    seconds = time.perf_counter() - began
    _record_end(train, buffer)
    if outcome == loop.STOPPED and _is_ringing(problem):
        outcome = RINGING
    filled.append(buffer[: train.rows])
    return Run(_joined(filled), train, outcome, seconds)


def _check_size(train: Train, filled: list[Cube]) -> None:
    """Refuse a record that memory may not hold, as soon as it is too large, with the interval that would do."""
    size = sum(piece.nbytes for piece in filled)
    if size > _LARGEST_RECORD:
        enough = 1.2 * train.control.interval * size / (_LARGEST_RECORD * _fraction(train))
        raise PhysicsError(
            f"The history of {len(train.vehicles)} vehicle{'s' if len(train.vehicles) > 1 else ''} must stay below "
            f"{_LARGEST_RECORD >> 30} GiB of memory, but is larger after {train.time:.4g} s of the run, at rows "
            f"{train.control.interval:g} s apart. Write `output.interval: {at_least(enough)} s` or more.",
            "output.interval",
        )


def _joined(pieces: list[Cube]) -> Cube:
    """The pieces of a record as one; each is let go as it is taken over, so that memory holds the record once."""
    if len(pieces) == 1:
        return pieces[0]
    end = sum(len(piece) for piece in pieces)
    found = np.empty((end, *pieces[0].shape[1:]))
    while pieces:
        piece = pieces.pop()
        found[end - len(piece) : end] = piece
        end -= len(piece)
    return found


def _work_per_step(train: Train) -> int:
    """Rail nodes of all vehicles, and what takes the time of as many."""
    own = [own_liquid(vehicle.liquid) for vehicle in train.vehicles]
    cells = sum(liquid.shallow.cells for liquid in own if isinstance(liquid, CellLiquid))
    return sum(vehicle.rail.nodes for vehicle in train.vehicles) + _NODES_PER_CELL * cells


def _buffer(train: Train, most_bytes: int = 0) -> Cube:
    """Rows to make room for at once: all up to the time limit, or many steps' worth; empty pages cost nothing."""
    control = train.control
    per_step = int(control.longest_step / control.interval) + 3
    widest = max(columns_of(vehicle).end for vehicle in train.vehicles)
    row = (len(train.vehicles), widest + (COUPLING_COLUMNS if train.couplings.origin.size else 0))
    most = most_bytes // (8 * row[0] * row[1]) or _MOST_ROWS
    return np.empty((max(2 * per_step, min(int(control.time_limit / control.interval) + per_step, most)), *row))


def _record_end(train: Train, buffer: Cube) -> None:
    """Add the end of the run as a row of its own, unless an output instant coincides with it."""
    interval = train.control.interval
    if abs(train.next_output - interval - train.time) >= 1e-9 * max(interval, train.time):
        record(train, buffer, 1.0, 0.0)


def mean_speed(train: Train) -> float:
    """Mean speed (m/s) of the vehicles by their mass."""
    return float(sum(share * v.points[START].v[0] for share, v in zip(train.shares, train.vehicles, strict=True)))


def _is_ringing(problem: ReadyStop) -> bool:
    """Whether waves of landing wheels stayed in the rail until steps too long for them took their energy.

    Without damping they run to and fro between the domain's ends, ever shorter, and shake the wheels that made them.
    An L-stable method takes the energy of those too short for its steps, so that the ledger misses it, and the distance
    goes on changing with the tolerance (seen: with a million steps still as much as with ten thousand).
    """
    train = problem.train
    absorbed = sum(vehicle.account.losses[FOUNDATION] for vehicle in train.vehicles) / train.initial_kinetic
    lifted = any(vehicle.account.lifted for vehicle in train.vehicles)
    return bool(lifted and -train.residual > max(problem.most_missing, _SWALLOWED * absorbed))


def _fraction(train: Train) -> float:
    """How far the run has come: by speed lost or by time, whichever is further."""
    by_speed = 1.0 - mean_speed(train) / float(train.vehicles[0].scales.speed[0])
    return min(max(by_speed, train.time / train.control.time_limit, 0.0), 1.0)
