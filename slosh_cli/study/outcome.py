"""One stop computed: what it came to, however it ended."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from slosh_cli.errors import SloshError
from slosh_cli.results.answers import Place, Shown
from slosh_cli.results.result import Result
from slosh_cli.results.train_result import TrainResult
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.study.plan import Stop

if TYPE_CHECKING:
    from slosh_cli.solver.run import Cancel, Progress


@dataclass(frozen=True)
class FinishedStop:
    """A finished stop.

    answer: column (with unit) -> value, always with its conditions, status and reason.
    final: False for a failure that another try may not repeat, such as a lost worker or too little memory.
    seconds: what it took. result: the whole run, where its history is to be kept.
    """

    index: int
    key: str
    answer: dict[str, Any]
    final: bool
    seconds: float
    result: Result | TrainResult | None = field(default=None, repr=False)

    @property
    def status(self) -> str:
        """How the run ended: `stopped` or without an answer."""
        return str(self.answer["status"])


def run_of(
    scenario: Scenario | TrainScenario, *, progress: Progress | None = None, cancel: Cancel | None = None
) -> Result | TrainResult:
    """The run of a wagon or of a train; arguments and errors are those of `simulate`."""
    from slosh_cli.results.simulate import simulate, simulate_train

    if isinstance(scenario, TrainScenario):
        return simulate_train(scenario, progress=progress, cancel=cancel)
    return simulate(scenario, progress=progress, cancel=cancel)


def solve(stop: Stop, cancel: Cancel | None = None) -> FinishedStop:
    """Compute a stop; a failure is an outcome too. Raises Cancelled when `cancel` is set before the end."""
    from slosh_cli.solver.run import Cancelled

    began = time.perf_counter()
    try:
        result = run_of(stop.scenario, cancel=cancel)
    except Cancelled:
        raise
    except SloshError as error:
        return failed(stop, str(error), final=True, seconds=time.perf_counter() - began)
    except Exception as error:
        reason = f"the program failed: {type(error).__name__}: {error}"
        return failed(stop, reason, final=False, seconds=time.perf_counter() - began)
    seconds = time.perf_counter() - began
    return FinishedStop(stop.index, stop.key, result.row(Shown.STUDY), True, seconds, result if stop.history else None)


def failed(stop: Stop, reason: str, *, final: bool, seconds: float = 0.0) -> FinishedStop:
    """The outcome of a stop that ended without a result."""
    conditions: dict[str, Any] = {}
    answers = TrainResult if isinstance(stop.scenario, TrainScenario) else Result
    for one in answers.in_table(Shown.STUDY, Place.CONDITIONS, Place.CONDITIONS):
        with suppress(SloshError):  # a brake that tells no torque is why it failed
            conditions |= one.cells(one.value_in(stop))
    return FinishedStop(stop.index, stop.key, without_result(conditions, reason), final, seconds)


def without_result(conditions: dict[str, Any], reason: str) -> dict[str, Any]:
    """The row of a stop that has nothing to tell but its `conditions` and why."""
    return conditions | {"status": "failed", "reason": " ".join(reason.split())}
