"""The floor: banded factorisations and solves alone, by LAPACK and by the program's own kernels, in compiled loops.

LAPACK's routines are called through the addresses that scipy publishes for Cython; nothing of Python is in the loops.
Where a repeat starts from a fresh copy, a loop with the copies alone is timed beside and taken off.
"""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from typing import Any

import numba
import numpy as np
from numba.extending import get_cython_function_address
from numpy.typing import NDArray

from slosh_cli.track.banded import factor_rows, solve_four, solve_one
from slosh_cli.track.mem import RailModel

Array = NDArray[np.float64]
BAND = 3
_POINTER, _MODULE = ctypes.c_void_p, "scipy.linalg.cython_lapack"


def _routine(name: str, arguments: int) -> Any:
    return ctypes.CFUNCTYPE(None, *[_POINTER] * arguments)(get_cython_function_address(_MODULE, name))


_GBTRF, _GBTRS = _routine("dgbtrf", 8), _routine("dgbtrs", 11)


@numba.njit(error_model="numpy")
def _lapack_factor(matrix, work, pivots, numbers, repeats):
    for _ in range(repeats):
        work[:] = matrix
        n, band, rows, info = numbers[0:1], numbers[1:2], numbers[2:3], numbers[3:4]
        _GBTRF(
            n.ctypes.data, n.ctypes.data, band.ctypes.data, band.ctypes.data, work.ctypes.data, rows.ctypes.data,
            pivots.ctypes.data, info.ctypes.data,
        )  # fmt: skip


@numba.njit(error_model="numpy")
def _lapack_solve(work, pivots, numbers, letter, right, fresh, repeats):
    for _ in range(repeats):
        right[:] = fresh
        n, band, rows, info, columns = numbers[0:1], numbers[1:2], numbers[2:3], numbers[3:4], numbers[4:5]
        _GBTRS(
            letter.ctypes.data, n.ctypes.data, band.ctypes.data, band.ctypes.data, columns.ctypes.data,
            work.ctypes.data, rows.ctypes.data, pivots.ctypes.data, right.ctypes.data, n.ctypes.data, info.ctypes.data,
        )  # fmt: skip


@numba.njit(error_model="numpy")
def _own_factor(runs, rows, factors, repeats):
    for _ in range(repeats):
        factor_rows(runs, rows, factors)


@numba.njit(error_model="numpy")
def _own_four(factors, right, fresh, repeats):
    for _ in range(repeats):
        right[:] = fresh
        solve_four(factors, right)


@numba.njit(error_model="numpy")
def _own_one(factors, right, fresh, repeats):
    for _ in range(repeats):
        right[:] = fresh
        solve_one(factors, right)


@numba.njit(error_model="numpy")
def _copies(fresh, work, repeats):
    for k in range(repeats):
        work[:] = fresh
        work.ravel()[0] += k  # so that the copies cannot be merged into one


@dataclass(frozen=True)
class Costs:
    """Seconds of one factorisation, of four right-hand sides at once and of a single one."""

    factorisation: float
    four: float
    one: float

    def of(self, factorisations: int, singles: int) -> float:
        """Seconds that this many factorisations (with their four loads each) and single right-hand sides take."""
        return factorisations * (self.factorisation + self.four) + singles * self.one


def _seconds(loop: Callable[[int], None], repeats: int, rounds: int) -> float:
    loop(1)
    found = []
    for _ in range(rounds):
        began = time.perf_counter()
        loop(repeats)
        found.append((time.perf_counter() - began) / repeats)
    return median(found)


def own_costs(rail: RailModel, rows: Array, repeats: int = 100, rounds: int = 101) -> Costs:
    """Costs of the program's kernels for the matrix of `rail` that `rows` (r, 12) describe."""
    factors, four, one = np.empty((12, rail.nodes)), np.empty((rail.nodes, 2, 4)), np.empty(2 * rail.nodes)
    ones = [np.ones_like(four), np.ones_like(one)]
    idle = [
        _seconds(lambda k, pair=pair: _copies(*pair, k), repeats, rounds) for pair in ((ones[0], four), (ones[1], one))
    ]
    return Costs(
        _seconds(lambda k: _own_factor(rail.runs, rows, factors, k), repeats, rounds),
        _seconds(lambda k: _own_four(factors, four, ones[0], k), repeats, rounds) - idle[0],
        _seconds(lambda k: _own_one(factors, one, ones[1], k), repeats, rounds) - idle[1],
    )


def node_by_node(rail: RailModel, rows: Array) -> Array:
    """The same matrix in full, deflection and slope in turns: three diagonals either side, as LAPACK would have it."""
    full = np.zeros((rail.nodes, 2, rail.nodes + 2, 2))  # a node of zeros beyond either end
    for (first, end, *_), row in zip(rail.runs.astype(int), rows.reshape(-1, 2, 3, 2), strict=True):
        for node in range(first, end):
            full[node, :, node : node + 3] = row
    return full[:, :, 1:-1].reshape(2 * rail.nodes, -1)


def lapack_costs(matrix: Array, repeats: int = 100, rounds: int = 101) -> Costs:
    """Costs of `dgbtrf` and `dgbtrs` for a full `matrix` (n, n) whose entries lie within the band."""
    n = len(matrix)
    stored = np.zeros((n, 3 * BAND + 1))  # columns of LAPACK's band storage, one after the other
    for i in range(n):
        for j in range(max(0, i - BAND), min(n, i + BAND + 1)):
            stored[j, 2 * BAND + i - j] = matrix[i, j]
    numbers, letter = np.array([n, BAND, 3 * BAND + 1, 0, 4], dtype=np.int32), np.array([ord("N")], dtype=np.uint8)
    work, pivots = np.empty_like(stored), np.zeros(n, dtype=np.int32)
    four, one = np.empty((4, n)), np.empty((1, n))
    fresh = [np.ones_like(four), np.ones_like(one)]
    idle = [
        _seconds(lambda k, pair=pair: _copies(*pair, k), repeats, rounds)
        for pair in ((stored, work), (fresh[0], four), (fresh[1], one))
    ]
    factor = _seconds(lambda k: _lapack_factor(stored, work, pivots, numbers, k), repeats, rounds) - idle[0]
    solves = []
    for columns, right, ones, copied in ((4, four, fresh[0], idle[1]), (1, one, fresh[1], idle[2])):
        numbers[4] = columns

        def solve(k: int, right: Array = right, ones: Array = ones) -> None:
            _lapack_solve(work, pivots, numbers, letter, right, ones, k)

        solves.append(_seconds(solve, repeats, rounds) - copied)
    exact = np.linalg.solve(matrix, np.ones(n))
    if numbers[3] != 0 or not np.allclose(one[0], exact, rtol=1e-8, atol=1e-8 * np.abs(exact).max()):
        raise ArithmeticError("LAPACK did not solve the rail's equations")
    return Costs(factor, *solves)
