"""`slosh sweep`: table, figures, claims, JSON, exit codes, and what it says on the way."""

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from stand_ins import PAPER, Outcome, Slosh

sys.path.insert(0, str(Path(__file__).parents[1] / "study"))  # for study_tools.py

from plausible import plausible_run
from study_tools import QuickSolver

import slosh_cli.results.simulate
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.progress import StopsProgress, duration
from slosh_cli.report.study_figures import draw_study
from slosh_cli.results.result import Result, Status
from slosh_cli.results.validity import Check, warnings_of
from slosh_cli.scenario import Scenario, load_scenario

KEYS = ["name", "runs", "done", "failed", "reused", "table", "figures", "wall_seconds"]
FILES = {"braking_distance.csv", "braking_distance.png", "braking_distance.svg", "journal.sqlite"}


@pytest.fixture(scope="module")
def template() -> Result:
    return plausible_run(load_scenario(PAPER).with_({"braking.initial_speed": "5 km/h"}))


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch, template: Result) -> QuickSolver:
    solver = QuickSolver(template)
    monkeypatch.setattr(slosh_cli.results.simulate, "simulate", solver.simulate)
    monkeypatch.setattr("slosh_cli.compiled.solver_is_cached", lambda *_: True)
    monkeypatch.setattr("slosh_cli.report.study_figures.draw_study", _touch)
    return solver


def _touch(pages: Any, folder: Path) -> list[Path]:
    """Stand in for the drawing, which takes longer than everything else here."""
    assert pages
    files = [folder / f"braking_distance.{suffix}" for suffix in ("png", "svg")]
    for file in files:
        file.touch()
    return files


def answer_of(outcome: Outcome) -> Any:
    answer = json.loads(outcome.out)
    assert isinstance(answer, dict)
    return answer


def names(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


def unanswered(status: Status, reason: str, when: Callable[[Scenario], bool], quick: QuickSolver) -> None:
    """Let the solver give up on the stops that `when` picks."""

    def answer(scenario: Scenario) -> Result:
        result = quick.stop(scenario)
        if not when(scenario):
            return result
        return replace(result, status=status, reason=reason, braking_distance_m=None, braking_time_s=None)

    quick.answer = answer


def test_without_arguments_it_is_figure_3_of_the_paper(
    slosh: Slosh, quick: QuickSolver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slosh_cli.report.study_figures.draw_study", draw_study)
    outcome = slosh("sweep")
    assert outcome.code == ExitCode.DONE
    assert len(quick.scenarios) == 48
    folder = tmp_path / "outputs" / "paper-wagon"
    assert names(folder) == FILES
    table = pd.read_csv(folder / "braking_distance.csv")
    assert len(table) == 48
    assert sorted(table["v0_km_h"].unique()) == [80.0, 160.0]
    assert sorted(table["torque_kN_m"].unique()) == [2.5 * k for k in range(1, 13)]
    assert set(table["liquid"]) == {"modal", "rigid"}
    assert (folder / "braking_distance.png").stat().st_size > 10_000
    assert table["ratio_to_solid"].dropna().to_numpy() == pytest.approx(1.1)


def test_the_table_on_the_terminal_shows_ratio_best_torque_and_claims(slosh: Slosh, quick: QuickSolver) -> None:
    text = " ".join(slosh("sweep").out.split())
    distance = 1e3 * (80 / 3.6) ** 2 / (30e3 + 1.0) / 0.5
    assert f"80 30 * {distance * 1.1:.2f} * {distance:.2f} 1.1000" in text
    assert f"80 km/h, rigid: 30 kN m, {distance:.2f} m" in text
    assert "fig3-optimum: does not hold" in text
    assert "fig3-longer: holds" in text
    assert "fig3-15-percent: holds" in text
    assert "about 15 % longer at 160 km/h and 20 kN m" in text
    assert "table outputs/paper-wagon/braking_distance.csv" in text
    assert "48 stops in" in text


def test_json_is_one_object_with_the_keys_of_the_contract(slosh: Slosh, quick: QuickSolver) -> None:
    outcome = slosh("sweep", "--v0", "80,160", "--json", "-o", "here")
    answer = answer_of(outcome)
    assert list(answer) == KEYS
    assert (answer["name"], answer["runs"], answer["done"], answer["failed"]) == ("paper-wagon", 48, 48, 0)
    assert answer["reused"] == 0
    assert answer["table"] == str(Path("here/braking_distance.csv"))
    assert answer["figures"] == [str(Path("here/braking_distance.png")), str(Path("here/braking_distance.svg"))]
    assert answer["wall_seconds"] > 0
    assert "fig3-longer: holds" in outcome.err


def test_the_same_command_goes_on_and_a_changed_one_adds_what_is_new(slosh: Slosh, quick: QuickSolver) -> None:
    slosh("sweep", "--json", "--torque", "5:20:5")
    answer = answer_of(slosh("sweep", "--json", "--torque", "5:25:5"))
    assert (answer["runs"], answer["reused"]) == (20, 16)
    assert len(quick.scenarios) == 20
    outcome = slosh("sweep", "--torque", "5:25:5")
    assert "20 of them finished before" in outcome.err
    assert "20 of them from the journal" in outcome.out


def test_fresh_starts_over(slosh: Slosh, quick: QuickSolver) -> None:
    slosh("sweep", "--torque", "5,10")
    assert answer_of(slosh("sweep", "--torque", "5,10", "--fresh", "--json"))["reused"] == 0
    assert len(quick.scenarios) == 16


def test_any_key_can_vary_several_at_once(slosh: Slosh, quick: QuickSolver, tmp_path: Path) -> None:
    outcome = slosh(
        "sweep", PAPER, "--v0", "80", "--torque", "5", "--vary", "tank.fill=0.3:0.5:0.1",
        "--set", "tank.coefficients=computed", "--vary", "wagon.pivot_spacing=10:14:2 m",
        "--vary", "contact.adhesion=dry,wet", "-o", "here",
    )  # fmt: skip
    assert outcome.code == ExitCode.DONE
    table = pd.read_csv(tmp_path / "here" / "braking_distance.csv")
    assert len(table) == 36
    assert sorted(table["wagon_pivot_spacing_m"].unique()) == [10.0, 12.0, 14.0]
    assert sorted(table["tank_fill"].unique()) == [0.3, 0.4, 0.5]
    assert {scenario.contact.adhesion.mu0 for scenario in quick.scenarios} == {0.55, 0.3}
    assert "fig3" not in outcome.out


def test_the_models_of_the_load_can_be_chosen(slosh: Slosh, quick: QuickSolver) -> None:
    answer = answer_of(slosh("sweep", "--v0", "80", "--torque", "5,10", "--liquid", "rigid", "--json"))
    assert answer["runs"] == 2
    assert {scenario.tank.liquid.model for scenario in quick.scenarios} == {"rigid"}


def test_a_study_file_is_run_like_a_scenario(slosh: Slosh, quick: QuickSolver, tmp_path: Path) -> None:
    (tmp_path / "fills.yaml").write_text("base: tank-wagon\nvary:\n  tank.fill: 0.3:0.5:0.1\n")
    answer = answer_of(slosh("sweep", "fills.yaml", "--json"))
    assert (answer["name"], answer["runs"]) == ("fills", 6)
    assert names(tmp_path / "outputs" / "fills") == FILES


def test_histories_are_kept_on_request(slosh: Slosh, quick: QuickSolver, tmp_path: Path) -> None:
    slosh("sweep", "--v0", "80", "--torque", "5,10", "--histories", "-o", "here")
    table = pd.read_csv(tmp_path / "here" / "braking_distance.csv")
    assert all((tmp_path / "here" / file).is_file() for file in table["history"])
    assert len(set(table["history"])) == 4
    assert slosh("plot", tmp_path / "here" / table["history"][0], "-o", "drawn").code == ExitCode.DONE


def test_stops_at_the_pitch_limit_are_results_told_and_explained(
    slosh: Slosh, quick: QuickSolver, tmp_path: Path
) -> None:
    unanswered(
        Status.PITCH_LIMIT, "a pitch angle passed 0.1 rad 3.4 s into the run",
        lambda scenario: scenario.braking.torque > 25e3 and scenario.tank.liquid.model == "modal", quick,
    )  # fmt: skip
    outcome = slosh("sweep", "--json")
    assert outcome.code == ExitCode.DONE
    answer = answer_of(outcome)
    assert (answer["done"], answer["failed"]) == (48, 0)
    assert "4 of 48 stops ended without an answer" in outcome.err
    assert "4 x pitch-limit: a pitch angle passed 0.1 rad" in outcome.err
    assert "80 km/h, 27.5 kN m, modal; 80 km/h, 30 kN m, modal; 160 km/h, 27.5 kN m, modal" in outcome.err
    table = pd.read_csv(tmp_path / answer["table"])
    failed = table[table["status"] == "pitch-limit"]
    assert failed["braking_distance_m"].isna().all()
    assert set(failed["reason"]) == {"a pitch angle passed 0.1 rad 3.4 s into the run"}
    text = " ".join(slosh("sweep").out.split())
    assert "30 pitch-limit *" in text


def test_failures_of_different_causes_are_grouped(slosh: Slosh, quick: QuickSolver) -> None:
    def answer(scenario: Scenario) -> Result:
        torque = scenario.braking.torque / 1e3
        if torque < 7.0:
            return replace(quick.stop(scenario), status=Status.TIME_LIMIT, braking_distance_m=None,
                           reason=f"still rolling at {torque} m/s")  # fmt: skip
        if torque > 28.0:
            raise ValueError("nobody expected this")
        return quick.stop(scenario)

    quick.answer = answer
    outcome = slosh("sweep", "--v0", "80", "--json")
    err = outcome.err
    assert outcome.code == ExitCode.NO_ANSWER == 3
    assert "6 of 24 stops ended without an answer" in err
    assert "4 x time-limit: still rolling at 2.5 m/s" in err
    assert "2 x failed: the program failed: ValueError: nobody expected this" in err


def test_what_lies_outside_the_liquids_theory_is_marked(slosh: Slosh, quick: QuickSolver) -> None:
    beyond = Check("surface rise over the room above and below", "model", 2.0, 1.0, "")

    def answer(scenario: Scenario) -> Result:
        modal = scenario.tank.liquid.model == "modal"
        return replace(quick.stop(scenario), checks=(beyond,) if modal else ())

    quick.answer = answer
    out = slosh("sweep", "--v0", "80").out
    assert "*o " in out
    assert "o outside the range of the liquid's theory" in out


def test_what_a_study_warns_of_is_counted_and_named_in_the_table(
    slosh: Slosh, quick: QuickSolver, tmp_path: Path
) -> None:
    locked = Check("locked wheels", "operation", 3.0, 0.0, "Locked wheels slide; wheel 4 for 3.00 s.")
    heavy = Check("axle load in t", "operation", 25.0, 22.5, "Overload: 25 t.")
    fine = Check("wheel unloading", "operation", 0.1, 0.6, "")

    def answer(scenario: Scenario) -> Result:
        found = (heavy, locked, fine) if scenario.braking.torque > 21e3 else (heavy, fine)
        return replace(quick.stop(scenario), checks=found, warnings=tuple(warnings_of(found)))

    quick.answer = answer
    outcome = slosh("sweep", "--v0", "80", "-o", "here", "--json")
    assert outcome.err.index("24 of 24: axle load in t") < outcome.err.index("8 of 24: locked wheels")
    assert "wheel unloading" not in outcome.err
    table = pd.read_csv(tmp_path / "here" / "braking_distance.csv")
    told = list(zip(table["not_within"], table["warnings"], strict=True))
    assert told[0] == ("axle load in t", "Overload: 25 t.")
    assert told[-1] == ("axle load in t; locked wheels", "Overload: 25 t.; Locked wheels slide; wheel 4 for 3.00 s.")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--v0", "80,fast"], "--v0: braking.initial_speed: must be a speed"),
        (["--torque", "1:10:4"], "must reach its stop in whole steps"),
        (["--vary", "tank.fil=0.5,0.6"], "--vary tank.fil"),
        (["--vary", "tank.fill=1.5"], "--vary tank.fill"),
        (["--vary", "tank.fill"], "must be a key path, an equals sign and values"),
        (["--liquid", "modal,soup"], "--liquid: tank.liquid.model: must be"),
        (["nowhere.yaml"], "nowhere.yaml"),
        (["--jobs", "0"], "'--jobs'"),
        (["--jobs", "2", "--cluster", "tcp://a:1"], "leave one of them out"),
        (["--set", "braking.onset=3"], "--set braking.onset"),
    ],
)
def test_mistakes_are_the_users_matter_and_leave_no_files(
    slosh: Slosh, quick: QuickSolver, tmp_path: Path, arguments: list[str], message: str
) -> None:
    outcome = slosh("sweep", *arguments, "--json")
    assert outcome.code == ExitCode.BAD_INPUT
    assert message in answer_of(outcome)["error"]["message"]
    assert quick.scenarios == []
    assert list(tmp_path.iterdir()) == []


def test_a_dry_run_says_how_many_and_how_long_and_leaves_no_files(
    slosh: Slosh, quick: QuickSolver, tmp_path: Path
) -> None:
    outcome = slosh("sweep", "--dry-run", "--jobs", "2")
    assert outcome.code == ExitCode.DONE
    assert (
        "48 stops: initial speed 80 km/h | 160 km/h, brake torque per wheel 2.5 kN m to 30 kN m (12 values)"
        in outcome.out
    )
    assert "0 finished before, 48 to run: about 1 s on 2 threads" in outcome.out
    assert list(tmp_path.iterdir()) == []
    slosh("sweep", "--torque", "5,10")
    known = slosh("sweep", "--dry-run", "--torque", "5,10,15", "--json")
    assert (answer_of(known)["runs"], answer_of(known)["reused"], answer_of(known)["table"]) == (12, 8, None)
    assert "8 finished before, 4 to run" in known.err
    assert "0 finished before, 12 to run" in slosh("sweep", "--dry-run", "--fresh", "--torque", "5,10,15").out


def test_a_large_study_is_left_to_its_table(slosh: Slosh, quick: QuickSolver) -> None:
    out = slosh("sweep", "--v0", "80", "--torque", "1:30:0.25").out
    assert "ratio" not in out
    assert "table    outputs" in out


def test_a_study_that_cannot_be_written_is_a_clear_error(slosh: Slosh, quick: QuickSolver, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    outcome = slosh("sweep", "-o", "file/here", "--json")
    assert outcome.code == ExitCode.BAD_INPUT
    assert answer_of(outcome)["error"]["code"] == "file"


def test_stops_of_another_build_of_the_solver_are_told(
    slosh: Slosh, quick: QuickSolver, monkeypatch: pytest.MonkeyPatch
) -> None:
    slosh("sweep", "--torque", "5")
    monkeypatch.setattr("slosh_cli.compiled.SOURCES", "another")
    outcome = slosh("sweep", "--torque", "5,10")
    assert "4 stops in the journal are by another build of the solver; --fresh computes them anew" in outcome.err


def test_a_new_result_version_computes_everything_anew(
    slosh: Slosh, quick: QuickSolver, monkeypatch: pytest.MonkeyPatch
) -> None:
    slosh("sweep", "--torque", "5")
    monkeypatch.setattr("slosh_cli.study.key.RESULT_VERSION", 999)
    assert answer_of(slosh("sweep", "--torque", "5", "--json"))["reused"] == 0


def test_linear_algebra_keeps_to_one_thread(slosh: Slosh, quick: QuickSolver, monkeypatch: pytest.MonkeyPatch) -> None:
    import os

    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "8")
    slosh("sweep", "--torque", "5")
    assert os.environ["OPENBLAS_NUM_THREADS"] == os.environ["OMP_NUM_THREADS"] == "1"


def test_without_a_terminal_progress_is_a_line_now_and_then(capsys: pytest.CaptureFixture[str]) -> None:
    with StopsProgress(noted_every=0.0) as progress:
        progress(0, 10)
        progress(5, 10)
        progress(10, 10)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("5 of 10 stops, ")
    assert lines[0].endswith("left")


def test_on_a_terminal_progress_is_a_bar_with_rate_and_time_left(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    with StopsProgress() as progress:
        progress(0, 10)
        progress(5, 10)
        assert progress._bar is not None
        (task,) = progress._bar.tasks
        assert (task.completed, task.total) == (5, 10)
        assert task.fields["rate"].endswith("/s")
        assert task.fields["left"].endswith("left")


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.2, "1 s"), (42.4, "42 s"), (600.0, "10 min"), (7200.0, "2.0 h"), (None, "an unknown time")],
)
def test_durations_read_like_speech(seconds: float | None, words: str) -> None:
    assert duration(seconds) == words


# --- what cannot be written, and folders nobody chose


def _fails(*_: Any, **__: Any) -> None:
    raise OSError(28, "No space left on device")


@pytest.mark.parametrize(
    ("writer", "lost"),
    [
        ("results.tables.write_rows", {"braking_distance.csv"}),
        ("report.study_figures.draw_study", {"braking_distance.png", "braking_distance.svg"}),
    ],
)
def test_what_cannot_be_written_costs_itself_alone(
    slosh: Slosh, quick: QuickSolver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, writer: str, lost: set[str]
) -> None:
    slosh("sweep", "--torque", "5,10", "-o", "here")
    monkeypatch.setattr(f"slosh_cli.{writer}", _fails)
    for as_json in (True, False):
        outcome = slosh("sweep", "--torque", "5,10,15", "-o", "here", *(["--json"] if as_json else []))
        assert outcome.code == ExitCode.BAD_INPUT
        assert "No space left on device" in outcome.err
        assert names(tmp_path / "here") == FILES - lost
        if as_json:
            answer = answer_of(outcome)
            assert list(answer) == [*KEYS, "warnings"]
            assert answer["done"] == 12
            assert {Path(file).name for file in [*answer["figures"], answer["table"]] if file} == FILES - lost - {
                "journal.sqlite"
            }
        else:
            assert "most effective" in outcome.out
            assert not any(str(Path("here") / file) in outcome.out for file in lost)


@pytest.mark.parametrize("name", ["braking_distance.csv", "journal.sqlite", "braking_distance.svg", "histories/x"])
def test_targets_are_tried_before_the_first_stop(slosh: Slosh, quick: QuickSolver, tmp_path: Path, name: str) -> None:
    if name == "histories/x":
        (tmp_path / "here").mkdir()
        (tmp_path / "here" / "histories").write_text("")
    else:
        (tmp_path / "here" / name).mkdir(parents=True)
    outcome = slosh("sweep", "--torque", "5", "--histories", "-o", "here", "--json")
    assert outcome.code == ExitCode.BAD_INPUT
    assert answer_of(outcome)["error"]["code"] == "file"
    assert quick.scenarios == []


def test_another_study_of_the_same_name_gets_a_folder_of_its_own(
    slosh: Slosh, quick: QuickSolver, tmp_path: Path
) -> None:
    outputs = tmp_path / "outputs"
    slosh("sweep", "--torque", "5,10")
    first = (outputs / "paper-wagon" / "braking_distance.csv").read_bytes()
    outcome = slosh("sweep", "--torque", "15,20")
    assert outcome.code == ExitCode.DONE
    assert "outputs/paper-wagon holds the results of other settings; these go to outputs/paper-wagon-2" in outcome.err
    slosh("sweep", "--torque", "5")  # a part of it would take rows away from the first table
    slosh("sweep", "--torque", "5,10", "--vary", "tank.bottom_height=1.2,1.3 m")
    slosh("sweep", "--torque", "5,10", "--set", "contact.adhesion=wet")
    assert (outputs / "paper-wagon" / "braking_distance.csv").read_bytes() == first
    assert names(outputs) == {
        "paper-wagon", "paper-wagon-2", "paper-wagon-3", "paper-wagon-4", "paper-wagon-contact.adhesion=wet",
    }  # fmt: skip
    assert answer_of(slosh("sweep", "--torque", "5,10", "--json"))["reused"] == 8
    assert answer_of(slosh("sweep", "--torque", "15,20,25", "--json"))["reused"] == 8
    assert len(pd.read_csv(outputs / "paper-wagon-2" / "braking_distance.csv")) == 12
    assert len(names(outputs)) == 5


def test_a_chosen_folder_takes_every_study(slosh: Slosh, quick: QuickSolver, tmp_path: Path) -> None:
    slosh("sweep", "--torque", "5,10", "-o", "here")
    assert answer_of(slosh("sweep", "--torque", "10,20", "-o", "here", "--json"))["reused"] == 4
    assert names(tmp_path) == {"here"}


def test_a_fresh_start_does_not_take_another_studys_journal(slosh: Slosh, quick: QuickSolver, tmp_path: Path) -> None:
    slosh("sweep", "--torque", "5,10")
    slosh("sweep", "--torque", "20", "--fresh")
    assert answer_of(slosh("sweep", "--torque", "5,10", "--json"))["reused"] == 8
