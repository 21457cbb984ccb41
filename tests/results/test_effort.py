"""What is said of a run that takes long, and how much memory its history may take."""

import numpy as np
import pytest

from slosh_cli.errors import PhysicsError
from slosh_cli.results.effort import why_long
from slosh_cli.solver import run
from slosh_cli.solver.setup import problem

QUICK = ("braking.initial_speed=10 km/h", "braking.torque=5 kN m")


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ("solver.tolerance=1e-6", "a tolerance of 1e-6"),
        ("track.foundation.damping=0 N s/m^2", "track.foundation.damping"),
        ("wagon.primary_suspension.damping=0 N s/m", "primary_suspension.damping"),
        ("track.unevenness={sigma: 1 mm}", "unevenness"),
        ("tank.liquid={model: shallow-water, density: 830 kg/m^3, cells: 500}", "500 cells"),
        ("braking.onset=1 s", "wheels that shake"),
    ],
)
def test_the_cause_of_a_long_run_is_named(shipped, settings, words):
    assert words in why_long([shipped("paper_80", "tank.coefficients=computed", settings)])


def test_a_long_train_is_a_cause(shipped):
    assert "25 vehicles" in why_long(25 * [shipped("paper_80")])


def test_pieces_of_a_record_are_let_go_as_they_are_put_together():
    pieces = [np.full((10, 1, 5), float(number)) for number in range(8)]
    found = run._joined(pieces)
    assert np.array_equal(found[::10, 0, 0], np.arange(8.0))
    assert found.shape == (80, 1, 5)
    assert pieces == []


def test_a_record_that_grows_too_large_is_refused_with_the_interval_that_would_do(shipped, monkeypatch):
    monkeypatch.setattr(run, "_LARGEST_RECORD", 1 << 20)
    monkeypatch.setattr(run, "_MOST_ROWS", 1000)
    monkeypatch.setattr(run, "_PIECE", 1 << 19)
    scenario = shipped("paper_80_solid", *QUICK, "solver.time_limit=100 s", "output.interval=0.1 ms")
    with pytest.raises(PhysicsError, match=r"memory.*`output.interval: [0-9.]+ s` or more") as refused:
        run.integrate(problem(scenario))
    assert refused.value.where == "output.interval"
    enough = refused.value.message.split("output.interval: ")[1].split(" s")[0]
    whole = run.integrate(problem(shipped("paper_80_solid", *QUICK, f"output.interval={enough} s")))
    assert whole.rows.nbytes < 1 << 20


def test_pieces_of_a_record_change_no_row(shipped, monkeypatch):
    whole = run.integrate(problem(shipped("paper_80_solid", *QUICK)))
    monkeypatch.setattr(run, "_MOST_ROWS", 60)
    monkeypatch.setattr(run, "_PIECE", 1 << 16)
    apart = run.integrate(problem(shipped("paper_80_solid", *QUICK)))
    assert np.array_equal(whole.rows, apart.rows)
