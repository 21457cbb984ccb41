"""What the tests of commands share: the outcome of a command, and a solver that answers at once."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from plausible import plausible_run

PAPER = Path(__file__).parents[2] / "scenarios" / "paper_80.yaml"


@dataclass(frozen=True)
class Outcome:
    """What a command left behind."""

    code: int
    out: str
    err: str


Slosh = Callable[..., Outcome]


class Solver:
    """Stands in for the solver; `answer` decides what a run gives or raises."""

    def __init__(self) -> None:
        self.answer: Callable[[Any], Any] = plausible_run
        self.scenarios: list[Any] = []

    def simulate(self, scenario: Any, *, progress: Any = None, cancel: Any = None) -> Any:
        self.scenarios.append(scenario)
        if progress is not None:
            progress(0.5, 10.0)
        return self.answer(scenario)
