"""What the benchmarks share. Threads of the linear algebra are kept to one: every contestant computes on one core."""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

from collections.abc import Callable  # noqa: E402
from statistics import median  # noqa: E402
from time import perf_counter  # noqa: E402
from typing import Any  # noqa: E402

import pytest  # noqa: E402

ROUNDS = 5


@pytest.fixture(scope="session")
def reference() -> float:
    """Braking distance (m) that the stop converges to."""
    from .same_stop import converged_distance

    return converged_distance()


@pytest.fixture(scope="session")
def plain() -> Any:
    """The stop's wagon, rail and contact in the plain implementation."""
    from .same_stop import plain_system, scenario

    return plain_system(scenario())


@pytest.fixture
def in_turns(benchmark: Any) -> Callable[..., None]:
    """`in_turns(ours, other)`: time two things in turns, A B A B, so that a burst of other work hits both.

    The median of `other` goes into the record, too.
    """

    def measure(
        ours: Callable[[], object], other: Callable[[], object], rounds: int = ROUNDS, warm: bool = True
    ) -> None:
        seconds: list[float] = []

        def first_the_other() -> None:
            began = perf_counter()
            other()
            seconds.append(perf_counter() - began)

        if warm:
            other()
            ours()
        benchmark.pedantic(ours, setup=first_the_other, rounds=rounds)
        benchmark.extra_info["other"] = median(seconds)

    return measure
