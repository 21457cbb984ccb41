"""The same stop by slosh and by others, at several tolerances or steps: time, and error in braking distance.

Every record says whose it is (`contestant`), at what `setting`, with what `error`; `scale` is the whole stop over the
part that was run, where it is not 1.
"""

from typing import Any

import pytest

from . import first_order, fixed_frame, multibody, newmark
from .conftest import ROUNDS
from .same_stop import scenario, stopped


def note(benchmark: Any, contestant: str, setting: str, error: float | None, **more: object) -> None:
    benchmark.extra_info |= {"kind": "contestant", "contestant": contestant, "setting": setting, "error": error} | more


@pytest.mark.parametrize("tolerance", ["1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "1e-5", "1e-6"])
def test_slosh(benchmark: Any, reference: float, tolerance: str) -> None:
    case = scenario(f"solver.tolerance={tolerance}")
    solving: list[float] = []

    def run() -> Any:
        result = stopped(case)
        solving.append(result.solve_seconds)
        return result

    run()
    result = benchmark.pedantic(run, rounds=2 * ROUNDS)
    note(
        benchmark, "e", f"tolerance {tolerance}", abs(result.braking_distance_m / reference - 1),
        solver_seconds=sorted(solving)[len(solving) // 2], steps=result.steps, rejected=result.rejected_steps,
        work=dict(result.work), distance=result.braking_distance_m,
    )  # fmt: skip


@pytest.mark.parametrize(("step", "rounds"), [(1e-2, ROUNDS), (5e-3, 1), (2e-3, 1), (5e-4, ROUNDS)])
def test_textbook(benchmark: Any, reference: float, plain: Any, step: float, rounds: int) -> None:
    distance, steps = benchmark.pedantic(newmark.braking_distance, args=(scenario(), plain, step), rounds=rounds)
    note(benchmark, "a", f"{1e3 * step:g} ms", abs(distance / reference - 1), steps=steps, distance=distance)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-5])
def test_radau_with_one_tolerance_for_all(benchmark: Any, reference: float, plain: Any, tolerance: float) -> None:
    distance, work = benchmark.pedantic(
        first_order.braking_distance, args=(scenario(), plain, "Radau", first_order.USUAL, tolerance), rounds=ROUNDS
    )
    note(benchmark, "d", f"Radau, rtol {tolerance:g}", abs(distance / reference - 1), **work, distance=distance)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5, 1e-6, 1e-7])
def test_radau_with_scaled_tolerances(benchmark: Any, reference: float, plain: Any, tolerance: float) -> None:
    distance, work = benchmark.pedantic(
        first_order.braking_distance, args=(scenario(), plain, "Radau", first_order.TUNED, tolerance), rounds=ROUNDS
    )
    note(benchmark, "d*", f"Radau, scaled {tolerance:g}", abs(distance / reference - 1), **work, distance=distance)


def test_bdf(benchmark: Any, plain: Any) -> None:
    """It takes tens of thousands of steps for the half second before the brake sets in; that is enough."""
    case = scenario()
    until = case.braking.onset
    distance, work = benchmark.pedantic(
        first_order.braking_distance, args=(case, plain, "BDF", first_order.USUAL, 1e-3, until), rounds=1
    )
    assert distance is None
    whole = float(stopped(case).time[-1])
    part = f"{until:g} s of {whole:.1f} s run, scaled by time"
    note(benchmark, "d", "BDF, rtol 0.001", None, scale=whole / until, part=part, **work)


def test_fixed_rail(benchmark: Any) -> None:
    """The coarsest mesh on which the fixed rail is as accurate as the moving one."""
    result = stopped(scenario("solver.tolerance=1e-6"))
    finer = scenario("track.domain.element_length=0.0625 m")
    moving = fixed_frame.moving_accuracy(result.scenario, finer)
    found = fixed_frame.accuracy(result, [0.5, 0.25, 0.2, 0.16, 0.125], 0.0625)
    length = max(length for length, error in found.items() if error <= moving)
    whole = fixed_frame.passage(result, length)
    benchmark.pedantic(whole.deflections, rounds=ROUNDS)
    part = f"{fixed_frame.PART:g} s of {float(result.time[-1]):.1f} s run on the whole length, scaled by time"
    note(
        benchmark, "b", f"{length:g} m, 0.5 ms, the rail alone", None, scale=1 / whole.share, part=part,
        unknowns=whole.rail.unknowns, rail_error=found[length], moving_rail_error=moving,
    )  # fmt: skip


@pytest.mark.skipif(not multibody.is_installed(), reason=multibody.LEFT_OUT)
@pytest.mark.parametrize(("step", "rounds"), [(0.1, ROUNDS), (0.05, ROUNDS), (0.02, 1), (0.01, 1)])
def test_exudyn(benchmark: Any, exudyn_limit: float, step: float, rounds: int) -> None:
    distance, steps = benchmark.pedantic(multibody.braking_distance, args=(scenario(), step), rounds=rounds)
    error = abs(distance / exudyn_limit - 1)
    note(benchmark, "c", f"{1e3 * step:g} ms", error, steps=steps, distance=distance, limit=exudyn_limit)


@pytest.fixture(scope="module")
def exudyn_limit() -> float:
    """Where exudyn's distance converges to, from its two finest runs (its error falls with the step)."""
    fine, finest = (multibody.braking_distance(scenario(), step)[0] for step in (1e-2, 5e-3))
    return 2 * finest - fine
