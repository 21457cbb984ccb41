"""Half a train of wagons with slosh on rigid rails, once more: couplings, brake wave and modes written anew for scipy.

Beside the matrices of `second_wagon` nothing of the solver is used. The memory of a coupling's friction spring is that
of the last step that scipy accepted, so a step may not be long beside how fast a coupling turns back.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import Radau
from second_wagon import GRAVITY, SIZE, Brake, SecondWagon

_HALF = 0.5
_LONGEST = 4e-3  # s


class SloshingWagon:
    """Half of a scenario's wagon with its slosh modes behind the coordinates of `second_wagon`.

    `modes` (modes, 4): frequency rad/s, lambda_1 kg, lambda_02 kg m, mu kg, of the whole tank.
    """

    def __init__(self, scenario, brake: Brake, modes) -> None:
        self.base = SecondWagon(scenario, brake)
        wagon, size = scenario.wagon, SIZE + len(modes)
        self.size = size
        mass, stiffness = np.zeros((size, size)), np.zeros((size, size))
        mass[:SIZE, :SIZE], stiffness[:SIZE, :SIZE] = self.base.mass, self.base.stiffness
        tank = self._along_car(scenario.tank.bottom_height)  # of u_B
        for n, (frequency, lambda_1, lambda_02, mu) in enumerate(modes, SIZE):
            mass[n, :SIZE] = _HALF * lambda_1 * tank
            mass[n, 2] += _HALF * lambda_02
            mass[:SIZE, n] = mass[n, :SIZE]
            mass[n, n], stiffness[n, n] = _HALF * mu, _HALF * mu * frequency**2
            stiffness[n, 2] = stiffness[2, n] = -_HALF * GRAVITY * lambda_1
        self.inverse, self.stiffness = np.linalg.inv(mass), stiffness
        self.ends = np.concatenate([self._along_car(wagon.coupling_height), np.zeros(len(modes))])
        self.onset = scenario.braking.onset

    def _along_car(self, height: float) -> np.ndarray:
        """How a point of the car at a `height` (m) moves along the track with s and the pitches."""
        wagon, row = self.base.wagon, np.zeros(SIZE)
        row[0], row[2] = 1.0, height - wagon.traction_height
        row[[4, 6]] = (wagon.traction_height - self.base.radius) / 2
        return row

    def settled(self) -> np.ndarray:
        state = self.base.settled()
        rest = np.zeros(self.size - SIZE)
        return np.concatenate([state[:SIZE], rest, state[SIZE:], rest])

    def acceleration(self, time: float, q, v, push: float) -> np.ndarray:
        """Under a force `push` (N, of the half wagon) forward at the coupling points; no wheel is locked."""
        base = self.base
        f, torque = base.tangential(time, np.concatenate([q[:SIZE], v[:SIZE]]), time >= self.onset)
        terms, force = base.wagon.running_resistance, push * self.ends - self.stiffness @ q
        force[:SIZE] += base.weight - base.damping @ v[:SIZE]
        force[0] -= f.sum() + _HALF * (terms.constant + terms.linear * v[0] + terms.quadratic * v[0] ** 2)
        force[7:11] += base.loads(q[:SIZE])
        force[11:15] += f * base.radius - torque
        force[[4, 6]] += torque[[0, 2]] + torque[[1, 3]]
        return self.inverse @ force


class FrictionSpring:
    """A coupling by its tables: `push`, `pull` are pairs of (loading, unloading), each of (travel m, force N)."""

    def __init__(self, push, pull, transition: float) -> None:
        self.tables, self.transition, self.held, self.place = (push, pull), transition, 0.0, 0.0

    @staticmethod
    def _on(table, travel: float) -> float:
        (x, y), (x_last, y_last) = table[-2:]
        if travel > x_last:
            return y_last + (travel - x_last) * (y_last - y) / (x_last - x)
        return float(np.interp(travel, *np.array(table).T))

    def force(self, c: float) -> float:
        """At a compression (m), on a straight way from the last place kept."""
        loading, unloading = (self._on(table, abs(c)) for table in self.tables[int(c < 0)])
        low, high = (unloading, loading) if c >= 0 else (-loading, -unloading)
        return min(max(self.held + self.transition * (c - self.place), low), high)

    def keep(self, c: float) -> None:
        self.held, self.place = self.force(c), c


def second_train(
    wagons: list[SloshingWagon],
    spring: Callable[[], FrictionSpring],
    times,
    rtol: float = 1e-5,
    longest: float = _LONGEST,
):
    """Forces (couplings, n) in N of whole couplings and positions (wagons, n) in m at `times` (n,) in s.

    No step is longer than `longest` s.
    """
    springs, sizes = [spring() for _ in wagons[1:]], [2 * wagon.size for wagon in wagons]
    cuts = np.cumsum(sizes)[:-1]

    def ends(state):
        return np.array(
            [wagon.ends @ part[: wagon.size] for wagon, part in zip(wagons, np.split(state, cuts), strict=True)]
        )

    def forces(state):
        return np.array([one.force(c) for one, c in zip(springs, np.diff(ends(state)) - apart, strict=True)])

    def slope(time, state):
        whole = np.concatenate([[0.0], forces(state), [0.0]])
        found = []
        for wagon, part, push in zip(wagons, np.split(state, cuts), _HALF * np.diff(whole), strict=True):
            q, v = part[: wagon.size], part[wagon.size :]
            found += [v, wagon.acceleration(time, q, v, push)]
        return np.concatenate(found)

    state = np.concatenate([wagon.settled() for wagon in wagons])
    apart = np.diff(ends(state))
    told, places = np.zeros((len(springs), len(times))), np.zeros((len(wagons), len(times)))
    begin, done = 0.0, 0
    for end in [*sorted({wagon.onset for wagon in wagons}), float(times[-1]) + 1e-9]:
        run = Radau(slope, begin, state, end, rtol=rtol, atol=1e-9, max_step=longest)
        while run.status == "running":
            message = run.step()
            assert run.status != "failed", message
            within = run.dense_output()
            while done < len(times) and times[done] <= run.t:
                now = within(times[done])
                told[:, done], places[:, done] = forces(now), [part[0] for part in np.split(now, cuts)]
                done += 1
            for one, c in zip(springs, np.diff(ends(run.y)) - apart, strict=True):
                one.keep(float(c))
        begin, state = run.t, run.y
    return told, places
