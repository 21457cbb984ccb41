"""What is seen of an excited liquid inside its tank: its centre of mass, the surface at probes and along the tank."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.solver import excite_kernels
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.longitudinal import mode_number
from slosh_cli.tank.shallow import WORK_ROWS, ShallowLiquid
from slosh_cli.tank.still import CellColumns

_MOST_PROFILES = 1000
"""So many profiles of the surface are kept."""
_PROFILE_PLACES = 121
"""So many places along the tank show modes."""
_STRETCHES = 2048
"""Stretches of time whose depths are held at once."""


@dataclass(frozen=True, eq=False)
class Watched:
    """The liquid inside its tank; rises are over the still level, places in m from the rear wall.

    `shift` (n,) m is how far its centre of mass has moved, forward, at the times of the histories; `probes` (n, p) m is
    the rise at the `probe_places` (p,). `profiles` (k, q) m are the rises at `places` (q,) and `profile_times` (k,) s.
    """

    shift: Vector
    probe_places: Vector
    probes: Matrix
    profile_times: Vector
    places: Vector
    profiles: Matrix


def watched_modes(
    modes: Sequence[SloshMode], mass: float, length: float, time: Vector, amplitudes: Matrix, probes: Sequence[float]
) -> Watched:
    """Odd modes of a liquid of `mass` (kg) with `amplitudes` (n, modes) m, rises at a wall, at `time` (n,) s."""
    lambda_1 = np.array([mode.lambda_1 for mode in modes], dtype=np.float64)
    numbers = np.array([mode_number(position) for position in range(len(modes))], dtype=np.float64)
    spots, places = np.array(probes, dtype=np.float64), np.linspace(0.0, length, _PROFILE_PLACES)
    front = amplitudes * np.sign(lambda_1)

    def rises(where: Vector) -> Matrix:
        return np.asarray(-np.cos(math.pi / length * np.outer(numbers, where)), dtype=np.float64)

    kept = _kept(time.size)
    shown = front[kept] @ rises(places)
    return Watched(amplitudes @ lambda_1 / mass, spots, front @ rises(spots), time[kept], places, shown)


def _kept(count: int) -> slice:
    """Which of `count` instants have a profile: evenly spaced ones."""
    return slice(None, None, -(-count // _MOST_PROFILES))


@dataclass(frozen=True, eq=False)
class CellWatch:
    """Follows a shallow-water liquid at the instants `time` (n,) s, the first of them the start, and at `probes` m."""

    liquid: ShallowLiquid
    time: Vector
    probes: Vector
    _shift: Vector = field(init=False)
    _probed: Matrix = field(init=False)
    _profiles: Matrix = field(init=False)

    def __post_init__(self) -> None:
        count, still = self.time.size, self.liquid.still_depth
        kept = len(range(count)[_kept(count)])
        object.__setattr__(self, "_shift", np.zeros(count))
        object.__setattr__(self, "_probed", np.full((count, self.probes.size), still))
        object.__setattr__(self, "_profiles", np.full((kept, self.liquid.cells), still))

    def carry(self, cells: CellColumns, ends: Vector, means: Vector) -> tuple[Matrix, int]:
        """Carry the cells from one of `ends` (k + 1,) s to the next under the mean decelerations (k,) m/s^2.

        Returns the rows (k, 6) of `cells_history`, and how many stretches were done.
        """
        liquid, lengths = self.liquid, np.diff(ends)
        rows, work = np.zeros((lengths.size, 6)), np.zeros((WORK_ROWS, liquid.cells + 1))
        for begin in range(0, lengths.size, _STRETCHES):
            part = slice(begin, begin + _STRETCHES)
            seen = np.zeros((lengths[part].size, 7 + liquid.cells))
            done = excite_kernels.cells_history(liquid, *cells, lengths[part], means[part], work, np.zeros(4), seen)
            rows[part] = seen[:, :6]
            self._look(ends[1:][part][:done], seen[:done])
            if done < seen.shape[0]:
                return rows, begin + done
        return rows, int(lengths.size)

    def _look(self, instants: Vector, seen: Matrix) -> None:
        """Take over what belongs to the instants that are watched."""
        place = np.searchsorted(self.time, instants)
        watched = np.flatnonzero(self.time[np.minimum(place, self.time.size - 1)] == instants)
        place, depths = place[watched], seen[watched, 7:]
        self._shift[place] = seen[watched, 6]
        where = self._centres()
        for k, spot in enumerate(self.probes):
            self._probed[place, k] = [np.interp(spot, where, row) for row in depths]
        every = _kept(self.time.size).step
        shown = place % every == 0
        self._profiles[place[shown] // every] = depths[shown]

    def _centres(self) -> Vector:
        return np.asarray((np.arange(self.liquid.cells) + 0.5) * self.liquid.spacing, dtype=np.float64)

    def seen(self, last: int) -> Watched:
        """What was seen at the first `last` instants."""
        liquid, kept = self.liquid, _kept(self.time.size)
        times = self.time[kept]
        reached = int(np.searchsorted(times, self.time[last - 1], "right")) if last else 0

        def rises(depths: Matrix) -> Matrix:
            return np.asarray(np.minimum(depths, liquid.table.roof) - liquid.still_depth, dtype=np.float64)

        return Watched(
            self._shift[:last],
            self.probes,
            rises(self._probed[:last]),
            times[:reached],
            self._centres(),
            rises(self._profiles[:reached]),
        )
