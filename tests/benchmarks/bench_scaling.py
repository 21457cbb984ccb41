"""How the time of a stop grows with elements, modes and output, and how a study uses threads and Dask workers."""

import os
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from statistics import median
from threading import Event
from time import perf_counter
from typing import Any

import pytest

from slosh_cli import simulate
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.cluster import Cluster
from slosh_cli.study.journal import Journal
from slosh_cli.study.plan import Study
from slosh_cli.study.runner import Workers, plan, run_study
from slosh_cli.study.threads import Threads, warm_up

from .conftest import ROUNDS
from .same_stop import UNRECORDED, scenario, stopped

DOMAIN = 44.0
"""Rail under the wagon, m: 50 elements of it are the longest allowed, half a wheelbase."""


def growth(benchmark: Any, by: str, count: float, *overrides: str) -> None:
    case = scenario(*overrides)
    simulate(case)
    result = benchmark.pedantic(simulate, args=(case,), rounds=ROUNDS)
    benchmark.extra_info |= {
        "kind": "growth", "by": by, "count": count, "steps": result.steps, "rejected": result.rejected_steps,
    }  # fmt: skip


@pytest.mark.parametrize("elements", [50, 100, 200, 400, 800, 1600])
def test_elements(benchmark: Any, elements: int) -> None:
    length = f"track.domain.length={DOMAIN} m"
    growth(benchmark, "elements", elements, length, f"track.domain.element_length={DOMAIN / elements} m")


@pytest.mark.parametrize("modes", [1, 2, 5, 10, 20])
def test_modes(benchmark: Any, modes: int) -> None:
    growth(benchmark, "modes", modes, "tank.coefficients=computed", f"tank.modes={modes}")


@pytest.mark.parametrize("interval", [1.0, 10.0, 100.0])
def test_output_interval(benchmark: Any, in_turns: Callable[..., None], interval: float) -> None:
    """Beside the same stop without any row but the last: the time loop, and the whole call with its history."""
    case, silent = scenario(f"output.interval={interval} ms"), scenario(UNRECORDED)
    loop: dict[str, list[float]] = {"loop": [], "other_loop": []}
    in_turns(
        lambda: loop["loop"].append(stopped(case).solve_seconds),
        lambda: loop["other_loop"].append(stopped(silent).solve_seconds),
        rounds=6 * ROUNDS,
    )
    medians = {name: median(seconds) for name, seconds in loop.items()}
    benchmark.extra_info |= {"kind": "recording", "interval_ms": interval} | medians


@pytest.fixture(scope="module")
def study() -> Study:
    """480 stops: sixteen speeds, fifteen torques, liquid and equivalent solid."""
    found = build(Wishes(speeds="40:160:8", torques="2:30:2"))
    assert found.size == 480
    return found


def compute(study: Study, workers: Workers, folder: Path) -> None:
    """All stops of the study into a new journal."""
    path = folder / "journal.sqlite"
    path.unlink(missing_ok=True)
    with Journal(path) as journal:
        journal.begin_session("bench")
        planned = plan(study, journal, folder)
        done = run_study(study, planned, journal, workers, cancel=Event(), report=lambda *_: None)
    assert done == study.size


def test_two_threads(benchmark: Any, in_turns: Callable[..., None], study: Study, tmp_path: Path) -> None:
    warm_up(study.stop(0).scenario)
    in_turns(
        lambda: compute(study, Threads(2), tmp_path),
        lambda: compute(study, Threads(1), tmp_path),
        rounds=3 * ROUNDS,
        warm=False,
    )
    benchmark.extra_info |= {"kind": "threads", "stops": study.size}
    if hasattr(os, "sched_setaffinity"):
        alone = [on_one_core(lambda: compute(study, Threads(1), tmp_path)) for _ in range(ROUNDS)]
        benchmark.extra_info["one_core"] = median(alone)


def on_one_core(work: Callable[[], None]) -> float:
    """Seconds that `work` takes where the process has a single core (Linux)."""
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(cores)})
    try:
        began = perf_counter()
        work()
        return perf_counter() - began
    finally:
        os.sched_setaffinity(0, cores)


@pytest.fixture(params=[1, 2])
def workers(request: pytest.FixtureRequest, study: Study) -> Iterator[tuple[int, Cluster]]:
    """A Dask cluster of worker processes with one thread each, their kernels loaded."""
    dask = pytest.importorskip("distributed")
    local = dask.LocalCluster(n_workers=request.param, threads_per_worker=1, dashboard_address=None)
    with closing(local), Cluster(local.scheduler_address) as cluster:
        with dask.Client(local, set_as_default=False) as client:
            client.run(warm_up, study.stop(0).scenario)
        yield request.param, cluster


def test_dask(benchmark: Any, workers: tuple[int, Cluster], study: Study, tmp_path: Path) -> None:
    number, cluster = workers
    benchmark.pedantic(compute, args=(study, cluster, tmp_path), rounds=ROUNDS)
    benchmark.extra_info |= {"kind": "dask", "workers": number, "stops": study.size}
