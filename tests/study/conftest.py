"""Studies with a solver that answers at once, and the real command in a process of its own."""

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "results"))  # for plausible.py

from plausible import plausible_run

import slosh_cli.results.simulate
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario, load_scenario
from slosh_cli.scenario import replace as with_values
from slosh_cli.solver.run import Cancelled

PAPER = Path(__file__).parents[2] / "scenarios" / "paper_80.yaml"


@pytest.fixture(scope="session")
def paper() -> Scenario:
    return load_scenario(PAPER)


class QuickSolver:
    """Stands in for the solver: a braking distance that follows from the scenario alone, at once.

    `answer` may be changed; `scenarios` are those it was asked for.
    """

    def __init__(self, template: Result) -> None:
        self._template = template
        self._lock = Lock()
        self.scenarios: list[Scenario] = []
        self.answer: Callable[[Scenario], Result] = self.stop

    def stop(self, scenario: Scenario) -> Result:
        brake, solid = scenario.braking, scenario.tank.liquid.model == "rigid"
        distance = 1e3 * brake.initial_speed**2 / (brake.torque + 1.0) * (1.0 if solid else 1.1) / scenario.tank.fill
        return replace(self._template, scenario=scenario, braking_distance_m=distance, braking_time_s=distance / 10.0)

    def simulate(self, scenario: Scenario, *, progress: Any = None, cancel: Any = None) -> Result:
        if cancel is not None and cancel.is_set():
            raise Cancelled
        with self._lock:
            self.scenarios.append(scenario)
        return self.answer(scenario)


@pytest.fixture(scope="session")
def template(paper: Scenario) -> Result:
    return plausible_run(with_values(paper, {"braking.initial_speed": "5 km/h"}))


@pytest.fixture
def solver(monkeypatch: pytest.MonkeyPatch, template: Result) -> QuickSolver:
    quick = QuickSolver(template)
    monkeypatch.setattr(slosh_cli.results.simulate, "simulate", quick.simulate)
    monkeypatch.setattr("slosh_cli.report.figures.RESOLUTION", 25)
    return quick


CHEAP = (
    "--v0", "30", "--liquid", "rigid", "--set", "solver.tolerance=1e-2", "--set", "track.domain.length=30 m",
    "--set", "track.domain.element_length=0.9 m",
)  # fmt: skip
"""Options of a sweep whose stops take a few hundredths of a second each."""


def start_slosh(folder: Path, *arguments: object, **environment: str) -> "subprocess.Popen[str]":
    """Start the real command in `folder`, in a process of its own."""
    code = "import sys; from slosh_cli.cli import main; sys.exit(main())"
    return subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)], cwd=folder, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **environment},
    )  # fmt: skip


def run_slosh(folder: Path, *arguments: object, **environment: str) -> tuple[int, str, str]:
    """The real command from start to end: exit code, stdout, stderr."""
    process = start_slosh(folder, *arguments, **environment)
    out, err = process.communicate(timeout=300)
    return process.returncode, out, err
