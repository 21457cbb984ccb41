"""What the tests of studies share: a solver that answers at once, and the real command in a process of its own."""

import os
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any

from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario
from slosh_cli.solver.run import Cancelled

PAPER = Path(__file__).parents[2] / "scenarios" / "paper_80.yaml"


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


CHEAP = (
    "--v0", "30", "--set", "solver.tolerance=1e-2", "--set", "track.domain.length=30 m",
    "--set", "track.domain.element_length=0.9 m", "--set", "name=cheap",
)  # fmt: skip
"""Options of a sweep whose stops take about a hundredth of a second each."""

COMMAND = """
import os, sys
from slosh_cli.study import outcome, threads
from slosh_cli.cli import main

log = os.open(os.environ["STOP_LOG"], os.O_WRONLY | os.O_APPEND | os.O_CREAT)

def solve(stop, cancel=None):
    os.write(log, (stop.key + "\\n").encode())
    return outcome.solve(stop, cancel)

threads.solve = solve
if "LARGEST_FILE" in os.environ:
    import resource
    largest = int(os.environ["LARGEST_FILE"])
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
sys.exit(main())
"""
"""The command `slosh`, which also notes the key of every stop it begins in the file STOP_LOG."""


def start_slosh(folder: Path, *arguments: object, **environment: object) -> "subprocess.Popen[str]":
    """Start the real command in `folder`, in a process of its own; the stops it begins go to `begun.log` there."""
    given = {"STOP_LOG": str(folder / "begun.log")} | {name: str(value) for name, value in environment.items()}
    return subprocess.Popen(
        [sys.executable, "-c", COMMAND, *map(str, arguments)], cwd=folder, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=os.environ | given,
    )  # fmt: skip


def run_slosh(folder: Path, *arguments: object, **environment: object) -> tuple[int, str, str]:
    """The real command from start to end: exit code, stdout, stderr."""
    process = start_slosh(folder, *arguments, **environment)
    out, err = process.communicate(timeout=600)
    return process.returncode, out, err


def begun(folder: Path) -> list[str]:
    """Keys of the stops that the latest commands began."""
    log = folder / "begun.log"
    return log.read_text().split() if log.exists() else []


def journal_rows(journal: Path) -> dict[str, tuple[object, ...]]:
    """Everything a journal holds by key, read as any other program would read it."""
    if not journal.exists():
        return {}
    with closing(sqlite3.connect(journal)) as file:
        assert file.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        if not file.execute("SELECT 1 FROM sqlite_master WHERE name = 'stop'").fetchone():
            return {}
        return {row[0]: row for row in file.execute("SELECT key, status, answer, seconds, finished, session FROM stop")}


def count(journal: Path) -> int:
    """How many stops a journal holds, while another process may be writing it."""
    if not journal.exists():
        return 0
    with closing(sqlite3.connect(journal)) as file, suppress(sqlite3.OperationalError):
        return int(file.execute("SELECT count(*) FROM stop").fetchone()[0])
    return 0
