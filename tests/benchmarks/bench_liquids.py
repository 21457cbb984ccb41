"""A stop with each model of the liquid, and what a cell of shallow water costs beside a plain kernel of a box."""

from time import perf_counter
from typing import Any

import numba
import numpy as np
import pytest

from slosh_cli import simulate
from slosh_cli.solver.excite import STANDARD_GRAVITY
from slosh_cli.tank.shallow import WORK_ROWS, liquid_evolve
from slosh_cli.tank.still import shallow_liquid

from .conftest import ROUNDS
from .same_stop import UNRECORDED, scenario

FLOWING = "tank.liquid={model: shallow-water, density: 830 kg/m^3, dispersion: %s}"
MODELS = {"modal": (), "shallow-water": (FLOWING % "off",), "dispersion": (FLOWING % "on",)}
SWAY, STRETCH, SECONDS = 0.3, 0.01, 14.0
"""Deceleration (m/s^2), and lengths (s) of a call of the kernel and of all of them."""


@pytest.mark.parametrize("model", MODELS)
def test_stop(benchmark: Any, model: str) -> None:
    """From 160 km/h with 10 kN m."""
    case = scenario("braking.torque=10 kN m", UNRECORDED, *MODELS[model])
    simulate(case)
    result = benchmark.pedantic(simulate, args=(case,), rounds=ROUNDS)
    benchmark.extra_info |= {"kind": "liquid", "model": model, "steps": result.steps, "rejected": result.rejected_steps}


@numba.njit(error_model="numpy", fastmath=True)
def _plain_box(depth, flow, fresh_depth, fresh_flow, spacing, step, steps):
    """Rusanov fluxes of first order, forward Euler: the least that a cell of a box can cost."""
    for _ in range(steps):
        for i in range(1, depth.size - 1):
            mass = force = 0.0
            for side in (0, 1):
                a, b = i - 1 + side, i + side
                u, v = flow[a] / depth[a], flow[b] / depth[b]
                swift = max(abs(u) + np.sqrt(9.81 * depth[a]), abs(v) + np.sqrt(9.81 * depth[b]))
                way = 1.0 - 2.0 * side
                mass += way * 0.5 * (flow[a] + flow[b] - swift * (depth[b] - depth[a]))
                both = flow[a] * u + flow[b] * v + 0.5 * 9.81 * (depth[a] ** 2 + depth[b] ** 2)
                force += way * 0.5 * (both - swift * (flow[b] - flow[a]))
            fresh_depth[i] = depth[i] + step / spacing * mass
            fresh_flow[i] = flow[i] + step / spacing * force
        fresh_depth[0], fresh_flow[0] = fresh_depth[1], -fresh_flow[1]
        fresh_depth[-1], fresh_flow[-1] = fresh_depth[-2], -fresh_flow[-2]
        depth[:], flow[:] = fresh_depth, fresh_flow


def _plain_seconds(cells: int) -> float:
    """Seconds for a cell and step of the plain kernel."""
    depth, flow = 1.0 + 0.1 * np.linspace(-1.0, 1.0, cells + 2), np.zeros(cells + 2)
    fresh, steps = (np.zeros(cells + 2), np.zeros(cells + 2)), 20_000
    _plain_box(depth, flow, *fresh, 0.13, 0.01, 1)
    begun = perf_counter()
    _plain_box(depth, flow, *fresh, 0.13, 0.01, steps)
    return (perf_counter() - begun) / (steps * cells)


@pytest.mark.parametrize("model", ["shallow-water", "dispersion"])
def test_cell(benchmark: Any, model: str) -> None:
    """The kernel alone, twice through all cells in a step, with 120 cells of the cylinder."""
    tank = scenario(*MODELS[model]).tank
    counted: list[float] = []

    def run() -> None:
        liquid, cells = shallow_liquid(tank, STANDARD_GRAVITY, 0.5)
        work, sums = np.zeros((WORK_ROWS, liquid.cells + 1)), np.zeros(4)
        begun = perf_counter()
        for _ in range(round(SECONDS / STRETCH)):
            liquid_evolve(liquid, *cells, -SWAY, STRETCH, work, sums)
        counted.append((perf_counter() - begun) / (2.0 * sums[3] * liquid.cells))

    run()
    benchmark.pedantic(run, rounds=ROUNDS)
    plain = min(_plain_seconds(tank.liquid.cells) for _ in range(ROUNDS))
    benchmark.extra_info |= {"kind": "cell", "model": model, "cell": min(counted), "plain": plain}
