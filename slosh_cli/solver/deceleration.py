"""A deceleration of a tank over time, linear between instants: from a level and a ramp, a table, or a motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from slosh_cli.arrays import Vector


@dataclass(frozen=True, eq=False)
class Deceleration:
    """A deceleration that is linear between `times` (k,) s, where it has `values` (k,) m/s^2.

    It is zero before the first time and keeps the last value after the last one. Times must not fall; a time given
    twice is a jump. `blow` m/s is the speed, forward, that the tank is given at once at t = 0, while its liquid stands.
    Raises ValueError where these rules are broken.
    """

    times: Vector
    values: Vector
    blow: float = 0.0

    def __post_init__(self) -> None:
        if self.times.ndim != 1 or self.times.shape != self.values.shape or not self.times.size:
            raise ValueError("times and values must be of one length, at least 1")
        if not (np.isfinite(self.times).all() and np.isfinite(self.values).all()):
            raise ValueError("times and values must be finite")
        if np.any(np.diff(self.times) < 0.0):
            raise ValueError("times must not fall")

    @classmethod
    def ramped(cls, level: float, ramp: float = 0.0) -> Deceleration:
        """Linear from 0 to `level` (m/s^2) within `ramp` (s) from t = 0, then held; without a ramp a step."""
        points = [(0.0, 0.0), (ramp, level)] if ramp > 0.0 else [(0.0, level)]
        return cls.table(points)

    @classmethod
    def table(cls, points: Sequence[tuple[float, float]]) -> Deceleration:
        """Through points (s, m/s^2)."""
        times, values = np.array(points, dtype=np.float64).reshape(-1, 2).T
        return cls(times, values)

    @classmethod
    def of_motion(cls, quantity: str, times: Vector, values: Vector, *, at_rest: bool) -> Deceleration:
        """That of a tank whose `quantity` has the `values` (k,), forward, at rising `times` (k,) s from 0.

        It is one of ``displacement_m``, ``velocity_m_s`` and ``acceleration_m_s2``.

        A displacement is the cubic spline through its points, whose second derivative is linear between them. A
        velocity is linear between its points. `at_rest`: the liquid stands before the motion, so that a first speed
        other than zero comes as a blow; otherwise tank and liquid move together at first. At the end the tank keeps its
        speed, or its acceleration where that is given. Raises ValueError for fewer points than 4, 2 and 1.
        """
        if quantity == "acceleration_m_s2":
            return cls(times, -values)
        if times.size < 2:
            raise ValueError(f"{quantity} needs more points")
        if quantity == "velocity_m_s":
            steps = np.diff(values) / np.diff(times)
            instants, reached, first = np.repeat(times, 2)[1:-1], np.repeat(steps, 2), float(values[0])
        else:
            from scipy.interpolate import CubicSpline

            course = CubicSpline(times, values)
            instants, reached, first = times, course(times, 2), float(course(times[0], 1))
        ends, still = np.append(instants, instants[-1]), np.append(-reached, 0.0)
        return cls(ends, still, first if at_rest else 0.0)

    def after(self, instants: Vector) -> Vector:
        """Values in m/s^2 at `instants` (s), just after a jump where there is one."""
        return self._at(instants, "right")

    def before(self, instants: Vector) -> Vector:
        """The same just before a jump."""
        return self._at(instants, "left")

    def speed_lost(self, instants: Vector) -> Vector:
        """Integral in m/s up to `instants` (s)."""
        times, values = self.times, self.values
        sums = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(times) * (values[1:] + values[:-1]))])
        k = np.searchsorted(times, instants, "right") - 1
        reached = np.clip(k, 0, None)
        more = 0.5 * (instants - times[reached]) * (values[reached] + self.after(instants))
        return np.where(k < 0, 0.0, sums[reached] + more)

    def largest(self, duration: float) -> float:
        """Largest absolute value in m/s^2 from t = 0 to `duration` (s)."""
        ends = np.array([0.0, duration])
        inside = np.abs(self.values[(self.times >= 0.0) & (self.times <= duration)])
        return float(np.max([*inside, *np.abs(self.after(ends)), *np.abs(self.before(ends[1:]))]))

    def _at(self, instants: Vector, side: str) -> Vector:
        times, values = self.times, self.values
        k = np.searchsorted(times, instants, "left" if side == "left" else "right") - 1
        reached, following = np.clip(k, 0, None), np.clip(k + 1, None, times.size - 1)
        span = times[following] - times[reached]
        part = np.where(span > 0.0, (instants - times[reached]) / np.where(span > 0.0, span, 1.0), 0.0)
        return np.where(k < 0, 0.0, values[reached] + part * (values[following] - values[reached]))
