"""The tank alone, decelerated as prescribed without pitching: force, moment and surface of its liquid over time.

The liquids are those of the wagon. Modes are integrated by the wagon's TR-BDF2, in steps halved until the histories
settle; a shallow-water liquid is carried through stretches of constant mean deceleration; a rigid one follows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.method import START
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.solver import excite_kernels
from slosh_cli.solver.deceleration import Deceleration
from slosh_cli.solver.watched import CellWatch, Watched, watched_modes
from slosh_cli.tank.coefficients import SloshLiquid, SloshMode, SloshTank, slosh_modes
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.modal import modal_liquid
from slosh_cli.tank.still import FlowingLiquid, TransverseWall, shallow_liquid

_WHOLE = 1.0
"""Share of the tank that is modelled: all of it, where a wagon has half of it on each rail."""
ACCURACY = 1e-7
"""Change of the histories, relative to their largest values, from one halving of the steps to the next that ends it."""
FIRST_PHASE = 0.04
"""The fastest mode's phase, rad, in the first and longest steps."""
MOST_STEPS = 20_000_000
"""Halving ends before more steps than this; the accuracy reached is part of the result."""


@dataclass(frozen=True, eq=False)
class Excitation:
    """What the liquid of a whole tank does to it, at `time` (n,) s under `deceleration` (n,) m/s^2.

    `force` N on the tank, forward, and `moment` N m about the bottom centre, nose-down, contain the part of the liquid
    that is at rest in the tank; `surface_front`, `surface_rear` m are rises over the still level at the end walls, all
    (n,). Of a shallow-water liquid force and moment are means over the output interval around each time. `mass` kg of
    liquid, `largest_deceleration` m/s^2, `mass_error` the largest change of the liquid's mass, as a share of it;
    `largest_head` m the largest head of a shallow-water liquid under the roof, zero where it never ran full;
    `accuracy` is what the modes' histories still changed by with the last halving of the steps, relative, and zero for
    the other liquids. `reason` says why the history ends early, empty when it does not. `watched`
    is what was seen of the liquid inside the tank.
    """

    time: Vector
    deceleration: Vector
    force: Vector
    moment: Vector
    surface_front: Vector
    surface_rear: Vector
    watched: Watched
    mass: float
    largest_deceleration: float
    mass_error: float = 0.0
    largest_head: float = 0.0
    accuracy: float = 0.0
    reason: str = ""

    @property
    def normalised_force(self) -> Vector:
        """Force over mass times the largest deceleration, (n,)."""
        return self.force / (self.mass * self.largest_deceleration)

    @property
    def max_surface(self) -> float:
        """Largest change of the level at an end wall, m, a fall with its sign; a rise where both are equal."""
        return extreme(np.concatenate([self.surface_front, self.surface_rear]))


def extreme(values: Vector) -> float:
    """The value of the largest magnitude with its sign, the positive one of two that are equally large."""
    high, low = float(values.max()), float(values.min())
    return low if -low > high else high


class _ExcitedLiquid(SloshLiquid, FlowingLiquid, Protocol):
    """A scenario's liquid with all that its model needs."""


class _ExcitedTank(SloshTank, Protocol):
    """A scenario's tank with such a liquid."""

    @property
    def liquid(self) -> _ExcitedLiquid: ...
    @property
    def baffles(self) -> Sequence[TransverseWall]: ...


def excite(
    tank: _ExcitedTank,
    deceleration: Deceleration,
    duration: float = 40.0,
    interval: float = 0.01,
    probes: Sequence[float] = (),
) -> Excitation:
    """Move the tank, its liquid level at t = 0, through `duration` s; a row every `interval` s.

    `probes` are places where the surface is watched, m from the rear wall. Raises TankError where slosh modes cannot be
    computed, ValueError for a duration or an interval that is not positive, a deceleration that is zero throughout or a
    probe outside the tank.
    """
    if not all(0.0 <= place <= tank.length for place in probes):
        raise ValueError(f"probes must lie within the {tank.length} m of the tank, but {probes} m were given")
    if not (duration > 0.0 and 0.0 < interval < math.inf and duration < math.inf):
        raise ValueError(f"duration and interval must be positive, but {duration} and {interval} s were given")
    if deceleration.largest(duration) == 0.0:
        raise ValueError("the deceleration must not be zero throughout")
    time = _instants(deceleration, duration, interval)
    given = deceleration.after(time)
    given[-1] = deceleration.before(time[-1:])[0]
    if tank.liquid.model == "shallow-water":
        return _excite_cells(tank, deceleration, time, given, probes)
    return _excite_modes(tank, deceleration, time, given, probes)


def _instants(deceleration: Deceleration, duration: float, interval: float) -> Vector:
    """Every `interval` from 0 to `duration`, both in, moved onto the deceleration's corners next to them."""
    count = max(math.ceil(duration / interval - 1e-9), 1)
    time = np.arange(count + 1, dtype=np.float64) * interval
    time[-1] = duration
    for corner in deceleration.times[(deceleration.times > 0.0) & (deceleration.times < duration)]:
        nearest = int(np.clip(np.searchsorted(time, corner), 1, count))
        nearest -= corner - time[nearest - 1] < time[nearest] - corner
        if abs(time[nearest] - corner) < 1e-9 * interval and 0 < nearest < count:
            time[nearest] = corner
    return time


def _with_corners(deceleration: Deceleration, instants: Vector) -> Vector:
    """`instants` and the deceleration's corners between them, each once, in order."""
    corners = deceleration.times
    inside = corners[(corners > instants[0]) & (corners < instants[-1])]
    return np.asarray(np.unique(np.concatenate([instants, inside])), dtype=np.float64)


def _excite_modes(
    tank: _ExcitedTank, deceleration: Deceleration, time: Vector, given: Vector, probes: Sequence[float]
) -> Excitation:
    load, modes = frozen_load(tank), slosh_modes(tank)
    rows, accuracy = _settled_history(modes, deceleration, time)
    return Excitation(
        time=time,
        deceleration=given,
        force=load.mass * given + rows[:, 0],
        moment=load.mass * load.centre_height * given + rows[:, 1],
        surface_front=rows[:, 2],
        surface_rear=-rows[:, 2],
        watched=watched_modes(modes, load.mass, tank.length, time, rows[:, 3:], probes),
        mass=load.mass,
        largest_deceleration=deceleration.largest(float(time[-1])),
        accuracy=accuracy,
    )


def _settled_history(modes: Sequence[SloshMode], deceleration: Deceleration, time: Vector) -> tuple[Matrix, float]:
    """Slosh force, moment, front rise and amplitudes (n, 3 + modes) at `time`, and how far they have settled.

    That is the relative change of the first three with the last halving.

    Histories of steps h and h/2 are combined so that their errors of order h^2 cancel (L. F. Richardson).
    """
    if not modes:
        return np.zeros((time.size, 3)), 0.0
    ends = _with_corners(deceleration, time)
    wanted = np.searchsorted(ends, time)
    lengths, first, last = np.diff(ends), deceleration.after(ends[:-1]), deceleration.before(ends[1:])
    fastest = max(mode.frequency for mode in modes)
    steps = np.maximum(np.ceil(lengths * fastest / FIRST_PHASE), 1.0).astype(np.int64)

    def history(halvings: int) -> Matrix:
        rows = np.zeros((ends.size, 3 + len(modes)))
        liquid = modal_liquid(modes, STANDARD_GRAVITY, _WHOLE)
        liquid.rate[START] = -deceleration.blow * liquid.lambda_1 / liquid.mu
        excite_kernels.modal_history(liquid, lengths, first, last, steps * 2**halvings, rows)
        return rows[wanted]

    coarse, fine, halvings = history(0), history(1), 1
    combined, change = (4.0 * fine - coarse) / 3.0, math.inf
    while change > ACCURACY and 2 ** (halvings + 1) * int(steps.sum()) <= MOST_STEPS:
        halvings += 1
        coarse, fine = fine, history(halvings)
        previous, combined = combined, (4.0 * fine - coarse) / 3.0
        size = np.maximum(np.abs(combined).max(axis=0), np.finfo(float).tiny)
        change = float((np.abs(combined - previous).max(axis=0) / size)[:3].max())
    return combined, change


def _excite_cells(
    tank: _ExcitedTank, deceleration: Deceleration, time: Vector, given: Vector, probes: Sequence[float]
) -> Excitation:
    liquid, cells = shallow_liquid(tank, STANDARD_GRAVITY, _WHOLE, columns=True)
    cells[1][:] = -deceleration.blow * cells[0]
    borders = np.concatenate([time[:1], 0.5 * (time[1:] + time[:-1]), time[-1:]])
    ends = _with_corners(deceleration, np.union1d(time, borders))
    lengths = np.diff(ends)
    means = np.diff(deceleration.speed_lost(ends)) / lengths
    watch = CellWatch(liquid, time, np.array(probes, dtype=np.float64))
    rows, done = watch.carry(cells, ends, means)
    last = int(np.searchsorted(borders, ends[done], "right")) - 1  # as many rows as have their whole interval
    sums = np.concatenate([np.zeros((1, 2)), np.cumsum(rows[:, :2], axis=0)])
    spans = np.diff(borders[: last + 1])
    force, moment = (np.diff(sums[np.searchsorted(ends, borders[: last + 1])], axis=0) / spans[:, None]).T
    still, volume = liquid.still_depth, frozen_load(tank).mass / tank.liquid.density
    depths = np.concatenate([[[still, still]], rows[:, 2:4]])[np.searchsorted(ends, time[:last])]
    front, rear = (np.minimum(depths, liquid.table.roof) - still).T
    reason = f"the liquid's speed is no longer finite after {ends[done]:.6g} s" if done < lengths.size else ""
    return Excitation(
        time=time[:last],
        deceleration=given[:last],
        force=force,
        moment=moment,
        surface_front=front,
        surface_rear=rear,
        watched=watch.seen(last),
        mass=liquid.mass,
        largest_deceleration=deceleration.largest(float(time[-1])),
        mass_error=float(np.abs(rows[:done, 4] / volume - 1.0).max(initial=0.0)),
        largest_head=float(np.max(rows[:done, 5] - liquid.table.depth[-1], initial=0.0)),
        reason=reason,
    )
