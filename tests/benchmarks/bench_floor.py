"""Time of a stop over that of its banded factorisations and solves alone, by number of elements."""

from typing import Any

import pytest

from slosh_cli.solver.setup import problem

from .conftest import ROUNDS
from .floor import lapack_costs, own_costs
from .same_stop import scenario, stopped

DOMAIN = 50.0


@pytest.mark.parametrize("elements", [100, 200, 400, 800])
def test_floor(benchmark: Any, elements: int) -> None:
    case = scenario(f"track.domain.element_length={DOMAIN / elements} m")
    rail, d, speed = problem(case).model.rail, 0.02, 22.0
    matrix = (
        (rail.mass + d * rail.damping + d**2 * rail.stiffness) * rail.mass_form
        + d**2 * rail.bending_stiffness * rail.bending_form
        + (d * rail.shear_damping + d**2 * (rail.shear_stiffness - rail.mass * speed**2)) * rail.tension_form
        - (2 * d * rail.mass * speed + d**2 * rail.damping * speed) * rail.drift_form
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
    own, lapack = own_costs(matrix), lapack_costs(matrix)
    benchmark.extra_info |= {
        "kind": "floor", "elements": elements, "unknowns": int(matrix.shape[1]),
        "solver_seconds": sorted(solving)[len(solving) // 2], "steps": result.steps, "rejected": result.rejected_steps,
        "factorisations": factorisations, "singles": singles,
        "own_floor": own.of(factorisations, singles), "lapack_floor": lapack.of(factorisations, singles),
        "own_costs": vars(own), "lapack_costs": vars(lapack),
    }  # fmt: skip
