"""Time of a stop over that of its banded factorisations and solves alone, by number of elements.

Without rows on the way: what recording costs is a benchmark of its own.
"""

from typing import Any

import numpy as np
import pytest

from slosh_cli.solver.setup import problem

from .conftest import ROUNDS
from .floor import lapack_costs, node_by_node, own_costs
from .same_stop import UNRECORDED, scenario, stopped

DOMAIN = 50.0


@pytest.mark.parametrize("elements", [100, 200, 400, 800])
def test_floor(benchmark: Any, elements: int) -> None:
    case = scenario(f"track.domain.element_length={DOMAIN / elements} m", UNRECORDED)
    rail, d, speed = problem(case).vehicle.rail, 0.02, 22.0
    mass, stretch, drift, bend, _ = np.split(rail.forms, 5, axis=1)
    rows = (
        (rail.mass + d * rail.damping + d**2 * rail.stiffness) * mass
        + d**2 * rail.bending_stiffness * bend
        + (d * rail.shear_damping + d**2 * (rail.shear_stiffness - rail.mass * speed**2)) * stretch
        - (2 * d * rail.mass * speed + d**2 * rail.damping * speed) * drift
    )
    solving: list[float] = []

    def run() -> Any:
        result = stopped(case)
        solving.append(result.solve_seconds)
        return result

    run()
    result = benchmark.pedantic(run, rounds=ROUNDS)
    factorisations = result.work["factorisations"]
    singles = result.work["right_hand_sides"] - 4 * factorisations
    own, lapack = own_costs(rail, rows), lapack_costs(node_by_node(rail, rows))
    benchmark.extra_info |= {
        "kind": "floor", "elements": elements, "unknowns": 2 * rail.nodes,
        "solver_seconds": sorted(solving)[len(solving) // 2], "steps": result.steps, "rejected": result.rejected_steps,
        "factorisations": factorisations, "singles": singles,
        "own_floor": own.of(factorisations, singles), "lapack_floor": lapack.of(factorisations, singles),
        "own_costs": vars(own), "lapack_costs": vars(lapack),
    }  # fmt: skip
