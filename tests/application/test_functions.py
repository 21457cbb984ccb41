"""What scripts call: values in, frozen results out, nothing printed, and the answers of the commands."""

import json
import sys
from dataclasses import FrozenInstanceError
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pandas as pd
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "results"))  # for plausible.py
sys.path.insert(0, str(Path(__file__).parents[1] / "study"))  # for study_tools.py

from plausible import plausible_run
from study_tools import PAPER, QuickSolver

import slosh_cli.results.simulate
from slosh_cli import coefficients, excite, load_scenario, plot, simulate, sweep, validate
from slosh_cli.cli import main
from slosh_cli.errors import ScenarioError, SloshError, UsageError
from slosh_cli.results.files import FileError
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario, parse_quantity
from slosh_cli.solver.run import Cancelled
from slosh_cli.validation import registry

GRID = {"braking.initial_speed": "30,40 km/h", "braking.torque": "5:15:5 kN m"}


@pytest.fixture(scope="module")
def paper() -> Scenario:
    return load_scenario(PAPER)


@pytest.fixture(scope="module")
def template(paper: Scenario) -> Result:
    return plausible_run(paper.with_({"braking.initial_speed": "5 km/h"}))


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch, template: Result) -> QuickSolver:
    solver = QuickSolver(template)
    monkeypatch.setattr(slosh_cli.results.simulate, "simulate", solver.simulate)
    return solver


@pytest.fixture(autouse=True)
def silent(capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Nothing in this module may print, unless the test itself runs a command and reads what it prints."""
    monkeypatch.chdir(tmp_path)
    yield
    assert capfd.readouterr() == ("", "")


def answer_of(capfd: pytest.CaptureFixture[str], *words: object) -> Any:
    """What a command says in JSON."""
    capfd.readouterr()
    assert main([str(word) for word in (*words, "--json")]) == 0
    return json.loads(capfd.readouterr().out)


# --- one stop


def test_a_scenario_its_file_and_its_name_are_the_same_stop(quick: QuickSolver, paper: Scenario) -> None:
    results = [simulate(paper), simulate(PAPER), simulate(str(PAPER))]
    assert quick.scenarios == [paper] * 3
    assert len({result.braking_distance_m for result in results}) == 1
    assert simulate("tank-wagon").name == "tank-wagon"
    with pytest.raises(ScenarioError, match="must exist"):
        simulate("nowhere.yaml")


def test_progress_and_cancellation_come_in_as_callables(paper: Scenario) -> None:
    told: list[float] = []
    result = simulate(paper.with_({"braking.initial_speed": 5.0}), progress=lambda part, _: told.append(part))
    assert result.braking_distance_m is not None
    assert told == sorted(told)
    now = Event()
    now.set()
    with pytest.raises(Cancelled):
        simulate(paper, cancel=now)


# --- studies


def test_a_sweep_has_the_table_of_the_command(
    quick: QuickSolver, paper: Scenario, capfd: pytest.CaptureFixture[str]
) -> None:
    words = ["--v0", "30,40", "--torque", "5:15:5", "-o", "theirs"]
    answer = answer_of(capfd, "sweep", PAPER, *words)
    mine = sweep(paper, GRID, folder="mine")
    assert (answer["runs"], answer["done"], answer["failed"]) == (12, len(mine.rows), len(mine.failed))
    for name in ("braking_distance.csv", "braking_distance.png"):
        assert Path("mine", name).read_bytes() == Path("theirs", name).read_bytes()
    assert {Path(file).parent.name for file in [mine.files["table"], *mine.files["figures"]]} == {"mine"}
    read = pd.read_csv("mine/braking_distance.csv")
    told = mine.to_frame()
    assert list(told.columns) == list(read.columns)
    assert told["braking_distance_m"].tolist() == read["braking_distance_m"].tolist()


def test_without_arguments_a_sweep_is_figure_3_and_knows_the_claims(quick: QuickSolver) -> None:
    found = sweep()
    assert len(found.rows) == len(quick.scenarios) == 48
    assert next(verdict.claim for verdict in found.claims["modal"]) == "fig3-optimum"
    assert not list(Path().iterdir())
    assert repr(found) == "StudyResult(paper-wagon: 48 stops, 0 failed)"
    with pytest.raises(FrozenInstanceError):
        found.reused = 1  # type: ignore[misc]


@pytest.mark.parametrize(
    "torques", ["5,10 kN m", ["5 kN m", "10 kN m"], ["5 kN m", 1e4], [5e3, 1e4], (5000, 10000), np.array([5e3, 1e4])]
)
def test_values_are_texts_or_si_numbers(quick: QuickSolver, paper: Scenario, torques: Any) -> None:
    found = sweep(paper, {"braking.torque": torques, "tank.liquid.model": "rigid"}, threads=1)
    assert [row["torque_kN_m"] for row in found.rows] == [5.0, 10.0]
    assert {scenario.braking.torque for scenario in quick.scenarios} == {5e3, 1e4}


def test_numbers_words_and_mappings_can_vary(quick: QuickSolver, paper: Scenario) -> None:
    creep = {"mu0": 0.2, "A": 0.4, "B": "0.6 s/m", "kA": 1.0, "kS": 0.4}
    base = paper.with_({"tank.coefficients": "computed"})
    found = sweep(base, {"tank.fill": 0.4, "contact.adhesion": ["dry", creep], "tank.liquid.model": "modal"})
    assert [row["tank_fill"] for row in found.rows] == [0.4, 0.4]
    assert {scenario.contact.adhesion.mu0 for scenario in quick.scenarios} == {0.55, 0.2}


def test_a_study_file_is_a_scenario_of_many_stops(quick: QuickSolver) -> None:
    Path("s.yaml").write_text("name: fills\nbase: paper-80-liquid\nvary: {braking.torque: 5:15:5 kN m}\n")
    assert repr(sweep("s.yaml")) == "StudyResult(fills: 6 stops, 0 failed)"


def test_what_lies_in_the_folder_is_not_computed_again(quick: QuickSolver, paper: Scenario) -> None:
    done: list[tuple[int, int]] = []
    sweep(paper, GRID, folder="here")
    more = sweep(paper, GRID | {"braking.torque": "5:20:5 kN m"}, folder="here", progress=lambda *n: done.append(n))
    assert (more.reused, len(more.rows), len(quick.scenarios)) == (12, 16, 16)
    assert done[0] == (0, 4)
    assert done[-1] == (4, 4)
    assert sweep(paper, GRID, folder="here", fresh=True).reused == 0


def test_a_cancelled_sweep_has_the_stops_that_were_done(quick: QuickSolver, paper: Scenario) -> None:
    cancel = Event()
    cancel.set()
    assert len(sweep(paper, GRID, cancel=cancel).rows) < 12


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        ({"tank.fil": [0.3]}, "vary tank.fil: .*write `fill`"),
        ({"tank.fill": []}, "vary tank.fill must be a list of at least one value"),
        ({"braking.torque": "1:10:4 kN m"}, "vary braking.torque must reach its stop"),
        ({"wagon.pivot_spacing": "10"}, "vary wagon.pivot_spacing: must be a length with its unit"),
    ],
)
def test_mistakes_are_named_before_anything_runs(
    quick: QuickSolver, paper: Scenario, vary: dict[str, Any], message: str
) -> None:
    with pytest.raises((UsageError, ScenarioError), match=message):
        sweep(paper, vary)
    assert quick.scenarios == []


def test_histories_need_a_folder(quick: QuickSolver, paper: Scenario) -> None:
    with pytest.raises(UsageError, match="give a folder"):
        sweep(paper, GRID, histories=True)


# --- the tank alone


def test_an_excitation_has_the_answers_of_the_command(paper: Scenario, capfd: pytest.CaptureFixture[str]) -> None:
    words = ["--deceleration", "0.2 g", "--ramp", "1 s", "--duration", "2 s", "-o", "out"]
    answer = answer_of(capfd, "tank", "excite", PAPER, *words)
    found = excite(paper, parse_quantity("0.2 g", "acceleration"), ramp=1.0, duration=2.0)
    assert found.summary() == {key: value for key, value in answer.items() if key != "files"}
    table = pd.read_csv("out/excite.csv", index_col="time_s")
    pd.testing.assert_frame_equal(found.to_frame(), table, check_exact=True)
    assert len(repr(found)) < 120


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "say how the tank is decelerated: deceleration '0.2 g', table FILE.csv or motion FILE.csv"),
        ({"deceleration": "0.2"}, "deceleration must be an acceleration with its unit"),
        ({"deceleration": 0.0}, "deceleration: the tank must be decelerated at some time within duration"),
        ({"deceleration": float("inf")}, "deceleration must be finite; given `inf`"),
        ({"deceleration": "0.2 g", "ramp": -1.0}, "ramp must not be negative"),
        ({"deceleration": "0.2 g", "duration": 0}, "duration must be positive"),
        ({"deceleration": "0.2 g", "duration": float("nan")}, "duration must be finite"),
        ({"deceleration": "0.2 g", "table": "t.csv"}, "say how the tank is decelerated"),
    ],
)
def test_arguments_are_called_by_their_names(paper: Scenario, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        excite(paper, **arguments)


def test_coefficients_have_the_answers_of_the_command(paper: Scenario, capfd: pytest.CaptureFixture[str]) -> None:
    answer = answer_of(capfd, "tank", "coefficients", PAPER, "--modes", "2", "-o", "out")
    found = coefficients(PAPER, modes=2)
    times = ("files", "solve_seconds")
    assert {key: value for key, value in found.summary().items() if key not in times} == {
        key: value for key, value in answer.items() if key not in times
    }
    pd.testing.assert_frame_equal(found.to_frame(), pd.read_csv("out/coefficients.csv"), check_exact=True)
    assert len(repr(found)) < 120
    with pytest.raises(UsageError, match="modes must be at least 1"):
        coefficients(paper, 0)


# --- figures


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slosh_cli.report.figures.RESOLUTION", 25)


@pytest.mark.usefixtures("coarse")
def test_everything_with_an_answer_has_figures(quick: QuickSolver, paper: Scenario, template: Result) -> None:
    expected = {"contact_forces", "speed_distance", "wheel_speed", "slosh"}
    assert set(plot(template)) == expected
    assert set(plot(coefficients(paper, 2))) == {"mode_1", "mode_3"}
    assert set(plot(excite(paper, "0.2 g", duration="1 s"), "drawn")) == {"excite"}
    assert set(plot(sweep(paper, GRID))) == {"braking_distance"}
    assert {file.name for file in Path("drawn").iterdir()} == {"excite.png", "excite.svg"}


@pytest.mark.usefixtures("coarse")
def test_the_history_file_of_a_run_has_its_figures(template: Result) -> None:
    slosh_cli.results.hdf5.write_history(template, Path("run.h5"))
    assert set(plot("run.h5", folder="drawn")) == set(plot(template))
    assert len(list(Path("drawn").iterdir())) == 8
    with pytest.raises(FileError):
        plot("nothing.h5")


# --- validation


def test_validation_returns_results_and_tells_what_is_in_hand() -> None:
    told: list[tuple[int, int, str]] = []
    (found,) = validate(["polach"], lambda *words: told.append(words))
    assert found.passed
    assert told == [(0, 1, "polach")]
    assert repr(found).startswith("CaseResult(polach: passed, ")
    assert set(plot(found)) == {"polach"}
    with pytest.raises(SloshError, match="write `polach`"):
        validate(["polack"])


def test_a_case_that_falls_short_is_a_result(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "compute_of", lambda name: lambda data: 1 / 0)
    (found,) = validate(["polach"])
    assert not found.passed
    assert plot(found) == {}
