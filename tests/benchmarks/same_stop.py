"""The stop that all contestants solve, on the same mesh, and what its braking distance converges to."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from reference_code import plain_motion, plain_rail
from reference_code.plain_motion import System

from slosh_cli import load_scenario, simulate
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario
from slosh_cli.track.mem import fitted_nodes

SCENARIO = Path(__file__).parents[2] / "scenarios" / "paper_160.yaml"
UNRECORDED = "output.interval=100 s"
"""A stop with no row but its first and last."""
CONVERGED = 1e-8
"""Tolerance of the stop whose distance all errors are taken from."""


def scenario(*overrides: str) -> Scenario:
    """The stop from 160 km/h with some values replaced."""
    return load_scenario(SCENARIO, overrides)


def stopped(case: Scenario) -> Result:
    """Simulate; raises ArithmeticError where the wagon did not stop or a wheel locked on the way."""
    result = simulate(case)
    if result.braking_distance_m is None or max(result.locked_time_s) > 0.0:
        raise ArithmeticError(f"{case.name} should stop on rolling wheels, but: {result.status} {result.reason}")
    return result


def converged_distance() -> float:
    """Braking distance (m) at a tolerance far below those that are compared."""
    distance = stopped(scenario(f"solver.tolerance={CONVERGED:g}")).braking_distance_m
    assert distance is not None
    return distance


def plain_system(case: Scenario) -> System:
    """Wagon, contact and rail of the plain implementation on exactly the program's nodes."""
    system = plain_motion.system_of(case)
    wheels = system.wagon.axle_positions
    nodes = fitted_nodes(wheels, case.track.domain.length, case.track.domain.element_length)
    free = np.delete(np.arange(2 * nodes.size), [0, 2 * nodes.size - 2])
    forms = [plain_rail._band(matrix[np.ix_(free, free)]) for matrix in plain_rail._assemble(nodes)]
    under = np.array([2 * int(np.argmin(np.abs(nodes - wheel))) - 1 for wheel in wheels])
    names = ("I00", "I01", "I11", "I12", "I22")
    return replace(system, rail=replace(system.rail, **dict(zip(names, forms, strict=True)), wheel_dofs=under))
