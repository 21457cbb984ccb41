"""The tables of docs/speed.md, and what of them is not time, again: errors of contestants, work of a stop."""

from __future__ import annotations

import re
from functools import cache

from benchmarks import first_order, multibody, newmark
from benchmarks.same_stop import converged_distance, plain_system, scenario, stopped
from told_numbers import text_of

from slosh_cli.solver.setup import problem

PAGE = "docs/speed.md"
FILLED = re.compile(r"<!-- bench (\w+) -->(.*?)<!-- end -->", re.DOTALL)
"""A table that `make bench-docs` fills in, with its name."""


def tables() -> dict[str, list[dict[str, str]]]:
    """Lines of every table by its name, each as heading -> cell."""
    found = {}
    for name, block in FILLED.findall(text_of(PAGE)):
        heading, _, *lines = (
            [cell.strip() for cell in line.strip("|").split("|")] for line in block.split("\n") if line
        )
        found[name] = [dict(zip(heading, line, strict=True)) for line in lines]
    return found


def amount(cell: str) -> float | None:
    """A number; None where nothing was measured."""
    return None if cell == "-" else float(cell)


converged = cache(converged_distance)


@cache
def limit_of_exudyn() -> float:
    """Distance (m) that exudyn converges to, as in `bench_contestants`."""
    fine, finest = (multibody.braking_distance(scenario(), step)[0] for step in (1e-2, 5e-3))
    return 2 * finest - fine


def error(contestant: str, setting: str) -> float:
    """Error in distance of a contestant at the setting that the page names, computed now."""
    value = float(re.findall(r"[\d.]+(?:e-\d+)?", setting)[0])
    if contestant == "e":
        return abs(stopped(scenario(f"solver.tolerance={value!r}")).braking_distance_m / converged() - 1)
    if contestant == "c":
        return abs(multibody.braking_distance(scenario(), value / 1e3)[0] / limit_of_exudyn() - 1)
    system = plain_system(scenario())
    if contestant == "a":
        return abs(newmark.braking_distance(scenario(), system, value / 1e3)[0] / converged() - 1)
    kind = {"d": first_order.USUAL, "d*": first_order.TUNED}[contestant]
    return abs(first_order.braking_distance(scenario(), system, "Radau", kind, value)[0] / converged() - 1)


def work(elements: int) -> dict[str, str]:
    """Counts of a stop, as in `bench_floor`."""
    case = scenario(f"track.domain.element_length={scenario().track.domain.length / elements} m")
    result, unknowns = stopped(case), 2 * problem(case).vehicle.rail.nodes
    tried = result.steps + result.rejected_steps
    singles = result.work["right_hand_sides"] - 4 * result.work["factorisations"]
    return {
        "unknowns": str(unknowns),
        "steps tried": str(tried),
        "single right-hand sides per step": f"{singles / tried:.1f}",
    }


def stops_of_speed() -> dict[str, float]:
    """What the page says of single stops in its text: how far exudyn's limit lies below, where Newmark fails (ms)."""
    system, failing = plain_system(scenario()), []
    for step in (10, 20):
        try:
            newmark.braking_distance(scenario(), system, step / 1e3)
        except ArithmeticError:
            failing.append(step)
    return {"below": 1 - limit_of_exudyn() / converged(), "failing_ms": min(failing)}
