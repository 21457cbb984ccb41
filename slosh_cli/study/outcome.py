"""One stop computed: what it came to, however it ended."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from slosh_cli.errors import SloshError
from slosh_cli.results.tables import summary_row
from slosh_cli.study.plan import Stop, tidy

if TYPE_CHECKING:
    from slosh_cli.results.result import Result
    from slosh_cli.scenario import Scenario
    from slosh_cli.solver.run import Cancel

_NOT_THE_ANSWER = ("name", "solve_seconds")
"""Columns of a summary that the same stop does not repeat."""
_NOT_THE_LIQUID = ("wheels lifted off", "pitch beyond small angles")
"""Checks of the model's range that are not about the liquid."""


@dataclass(frozen=True)
class FinishedStop:
    """A finished stop.

    answer: column (with unit) -> value, always with speed, torque, liquid, status and reason.
    final: False for a failure that another try may not repeat, such as a lost worker or too little memory.
    seconds: what it took. result: the whole run, where its history is to be kept.
    """

    index: int
    key: str
    answer: dict[str, Any]
    final: bool
    seconds: float
    result: Result | None = field(default=None, repr=False)

    @property
    def status(self) -> str:
        """How the run ended: `stopped` or without an answer."""
        return str(self.answer["status"])


def solve(stop: Stop, cancel: Cancel | None = None) -> FinishedStop:
    """Compute a stop; a failure is an outcome too. Raises Cancelled when `cancel` is set before the end."""
    from slosh_cli.results.simulate import simulate
    from slosh_cli.solver.run import Cancelled

    began = time.perf_counter()
    try:
        result = simulate(stop.scenario, cancel=cancel)
    except Cancelled:
        raise
    except SloshError as error:
        return failed(stop, str(error), final=True, seconds=time.perf_counter() - began)
    except Exception as error:
        reason = f"the program failed: {type(error).__name__}: {error}"
        return failed(stop, reason, final=False, seconds=time.perf_counter() - began)
    seconds = time.perf_counter() - began
    return FinishedStop(stop.index, stop.key, _answer(result), True, seconds, result if stop.history else None)


def failed(stop: Stop, reason: str, *, final: bool, seconds: float = 0.0) -> FinishedStop:
    """The outcome of a stop that ended without a result."""
    return FinishedStop(stop.index, stop.key, without_result(conditions(stop.scenario), reason), final, seconds)


def without_result(conditions: dict[str, Any], reason: str) -> dict[str, Any]:
    """The row of a stop that has nothing to tell but its `conditions` and why."""
    return conditions | {"status": "failed", "reason": " ".join(reason.split())}


def conditions(scenario: Scenario) -> dict[str, Any]:
    """Speed, torque and model of the load: the columns every row has."""
    return {
        "v0_km_h": tidy(scenario.braking.initial_speed * 3.6),
        "torque_kN_m": tidy(scenario.braking.torque / 1e3),
        "liquid": str(scenario.tank.liquid.model),
    }


def _answer(result: Result) -> dict[str, Any]:
    row = {name: value for name, value in summary_row(result).items() if name not in _NOT_THE_ANSWER}
    return row | {"liquid_in_range": _liquid_in_range(result)}


def _liquid_in_range(result: Result) -> bool:
    """Whether the model of the liquid holds for this run: what else may end a model leaves the distance alone."""
    about_liquid = (check for check in result.checks if check.kind == "model" and check.name not in _NOT_THE_LIQUID)
    return all(check.within for check in about_liquid)
