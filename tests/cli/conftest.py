"""The command line in process."""

import sys
from pathlib import Path
from types import ModuleType

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "results"))  # for plausible.py
sys.path.insert(0, str(Path(__file__).parents[1] / "scenario"))  # for malformed.py

from stand_ins import Outcome, Slosh, Solver

from slosh_cli.cli import main


@pytest.fixture
def slosh(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Slosh:
    """Run a command in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")

    def call(*arguments: object) -> Outcome:
        code = main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return Outcome(code, out, err)

    return call


@pytest.fixture
def solver(monkeypatch: pytest.MonkeyPatch) -> Solver:
    """Replace the solver, and what knows whether it is compiled; figures are drawn coarsely, to save time."""
    monkeypatch.setattr("slosh_cli.report.figures.RESOLUTION", 25)
    stand_in = Solver()
    simulate, compiled = ModuleType("slosh_cli.results.simulate"), ModuleType("slosh_cli.compiled")
    simulate.simulate = stand_in.simulate  # type: ignore[attr-defined]
    compiled.solver_is_cached = lambda *_: True  # type: ignore[attr-defined]
    compiled.is_cached = lambda *_: True  # type: ignore[attr-defined]
    compiled.not_kept = lambda: ""  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, simulate.__name__, simulate)
    monkeypatch.setitem(sys.modules, compiled.__name__, compiled)
    return stand_in
