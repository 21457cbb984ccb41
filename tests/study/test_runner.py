"""What the journal lacks is computed once, a failure is a row, memory and threads stay within bounds."""

import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from study_tools import PAPER, QuickSolver

import slosh_cli.results.hdf5
from slosh_cli.errors import PhysicsError
from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import read_history
from slosh_cli.results.result import Result, Status
from slosh_cli.results.validity import Check
from slosh_cli.scenario import Scenario
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.journal import JOURNAL, Journal
from slosh_cli.study.outcome import solve
from slosh_cli.study.plan import Stop, Study
from slosh_cli.study.runner import _history_file, answer, plan, run_study
from slosh_cli.study.table import rows
from slosh_cli.study.threads import Threads


def silent(done: int, total: int) -> None:
    """Nobody watches."""


def carry_out(study: Study, folder: Path, threads: int = 2, cancel: threading.Event | None = None) -> tuple[int, int]:
    """Run a study; returns how many stops were reused and how many computed."""
    with Journal(folder / JOURNAL) as journal:
        planned = plan(study, journal, folder)
        stop = cancel or threading.Event()
        done = run_study(study, planned, journal, Threads(threads), cancel=stop, report=silent)
        return planned.reused, done


def table(study: Study, folder: Path) -> list[dict[str, object]]:
    with Journal(folder / JOURNAL) as journal:
        planned = plan(study, journal, folder)
        return list(rows(study, lambda index: answer(study, planned, journal, index)))


STUDY = Wishes(speeds="30,40", torques="5:20:5")


def test_every_stop_is_computed_once_and_has_its_row(solver: QuickSolver, tmp_path: Path) -> None:
    study = build(STUDY)
    assert carry_out(study, tmp_path) == (0, 16)
    assert len(solver.scenarios) == 16
    found = table(study, tmp_path)
    assert [(row["v0_km_h"], row["torque_kN_m"], row["liquid"]) for row in found] == [
        (speed, torque, liquid) for speed in (30, 40) for torque in (5, 10, 15, 20) for liquid in ("modal", "rigid")
    ]
    for row in found:
        assert row["status"] == "stopped"
        assert row["ratio_to_solid"] == (pytest.approx(1.1) if row["liquid"] == "modal" else None)


def test_a_finished_study_computes_nothing_again(solver: QuickSolver, tmp_path: Path) -> None:
    study = build(STUDY)
    carry_out(study, tmp_path)
    assert carry_out(study, tmp_path) == (16, 0)
    assert len(solver.scenarios) == 16


def test_a_changed_study_computes_only_what_is_new(solver: QuickSolver, tmp_path: Path) -> None:
    carry_out(build(STUDY), tmp_path)
    assert carry_out(build(replace(STUDY, torques="5:25:5")), tmp_path) == (16, 4)
    assert carry_out(build(replace(STUDY, overrides=["name=other", "output.interval=1 s"])), tmp_path) == (16, 0)
    assert carry_out(build(replace(STUDY, overrides=["solver.tolerance=1e-3"])), tmp_path) == (0, 16)


def test_two_ways_to_write_a_value_are_one_stop_and_two_rows(solver: QuickSolver, tmp_path: Path) -> None:
    study = build(Wishes(speeds="36 km/h,10 m/s", torques="5", liquids="rigid"))
    assert carry_out(study, tmp_path) == (0, 1)
    first, second = table(study, tmp_path)
    assert first == second


def test_a_failed_stop_is_a_row_with_its_reason_and_the_others_go_on(solver: QuickSolver, tmp_path: Path) -> None:
    def fails(scenario: Scenario) -> Result:
        if scenario.braking.torque == 10e3:
            raise PhysicsError("The wagon finds no equilibrium.", "wagon")
        if scenario.braking.torque == 15e3:
            return replace(solver.stop(scenario), status=Status.PITCH_LIMIT, reason="a pitch angle passed 0.1 rad",
                           braking_distance_m=None, braking_time_s=None)  # fmt: skip
        if scenario.braking.torque == 20e3:
            raise ZeroDivisionError("division by zero")
        return solver.stop(scenario)

    solver.answer = fails
    study = build(replace(STUDY, liquids="rigid"))
    assert carry_out(study, tmp_path) == (0, 8)
    found = table(study, tmp_path)
    assert [row["status"] for row in found[:4]] == ["stopped", "failed", "pitch-limit", "failed"]
    assert found[1]["reason"] == "The wagon finds no equilibrium."
    assert found[2]["reason"] == "a pitch angle passed 0.1 rad"
    assert found[3]["reason"] == "the program failed: ZeroDivisionError: division by zero"
    assert (found[1]["v0_km_h"], found[1]["torque_kN_m"], found[1]["liquid"]) == (30, 10, "rigid")
    # what the physics refused is final; a failure of the program is tried again
    assert carry_out(study, tmp_path) == (6, 2)


def test_a_combination_that_is_no_sound_scenario_is_a_failed_row(solver: QuickSolver, tmp_path: Path) -> None:
    study = build(Wishes(vary=["wagon.pivot_spacing=10,40 m", "track.domain.length=30,80 m"], liquids="rigid"))
    assert carry_out(study, tmp_path) == (0, 3)
    found = table(study, tmp_path)
    assert [row["status"] for row in found] == ["stopped", "stopped", "failed", "stopped"]
    assert "pivot" in str(found[2]["reason"]) or "domain" in str(found[2]["reason"])
    assert [row["wagon_pivot_spacing_m"] for row in found] == [10, 10, 40, 40]


def test_stops_run_at_the_same_time_and_only_a_few_are_in_hand(solver: QuickSolver, tmp_path: Path) -> None:
    at_once, most, handed = 0, 0, 0
    guard = threading.Lock()

    def slow(scenario: Scenario) -> Result:
        nonlocal at_once, most
        with guard:
            at_once += 1
            most = max(most, at_once)
        time.sleep(0.01)
        with guard:
            at_once -= 1
        return solver.stop(scenario)

    solver.answer = slow
    study = build(Wishes(speeds="20:60:1", torques="5", liquids="rigid"))
    ahead = []

    def stops() -> Iterator[Stop]:
        nonlocal handed
        for index in range(study.size):
            handed += 1
            ahead.append(handed - len(solver.scenarios))
            yield study.stop(index)

    outcomes = [one for batch in Threads(3).outcomes(stops(), study.size, threading.Event()) for one in batch]
    assert len(outcomes) == 41
    assert most == 3
    assert max(ahead) <= 3 * 9 + 1


def test_an_interrupted_study_keeps_what_is_finished_and_goes_on(solver: QuickSolver, tmp_path: Path) -> None:
    cancel = threading.Event()

    def interrupts(scenario: Scenario) -> Result:
        if len(solver.scenarios) == 6:
            cancel.set()
        return solver.stop(scenario)

    solver.answer = interrupts
    study = build(STUDY)
    _, done = carry_out(study, tmp_path, threads=1, cancel=cancel)
    assert 6 <= done < 16
    assert len(table(study, tmp_path)) == done
    solver.answer = solver.stop
    assert carry_out(study, tmp_path) == (done, 16 - done)


def test_after_an_interrupt_no_further_stop_is_made_ready(solver: QuickSolver) -> None:
    cancel, made = threading.Event(), 0
    study = build(Wishes(speeds="20:60:1", torques="5"))

    def stops() -> Iterator[Stop]:
        nonlocal made
        for index in range(study.size):
            made += 1
            yield study.stop(index)

    found = Threads(2).outcomes(stops(), study.size, cancel)
    next(found)
    cancel.set()
    assert sum(len(batch) for batch in found) <= 2 * 9
    assert made <= 2 * 9 + 2 < study.size


def test_a_journal_that_cannot_be_written_ends_the_study_at_once(
    solver: QuickSolver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise FileError("cannot write the journal: disk full")

    monkeypatch.setattr(Journal, "add", full)
    before, cancel = threading.active_count(), threading.Event()
    study = build(Wishes(speeds="20:60:1", torques="5"))
    with pytest.raises(FileError, match="disk full"):
        carry_out(study, tmp_path, cancel=cancel)
    assert cancel.is_set()  # what was in hand was told to end
    assert len(solver.scenarios) < study.size / 2
    assert threading.active_count() == before


def test_the_answer_of_a_stop_holds_nothing_that_another_run_would_not_repeat(solver: QuickSolver) -> None:
    outcome = solve(build(STUDY).stop(0))
    assert not {"name", "solve_seconds"} & set(outcome.answer)
    assert outcome.answer["liquid_in_range"] is True
    assert outcome.result is None


@pytest.mark.parametrize(
    ("name", "kind", "value", "within"),
    [
        ("surface rise over the room above and below", "model", 0.9, True),
        ("surface rise over the room above and below", "model", 1.1, False),
        ("excess of the first slosh frequency", "model", 1.1, False),
        ("wheels lifted off", "model", 4.0, True),
        ("energy ledger residual", "accuracy", 2.0, True),
        ("wheel unloading", "operation", 2.0, True),
    ],
)
def test_a_liquid_beyond_its_theory_is_marked_other_checks_leave_the_distance_alone(
    solver: QuickSolver, name: str, kind: Any, value: float, within: bool
) -> None:
    check = Check(name, kind, value, 1.0, "")
    solver.answer = lambda scenario: replace(solver.stop(scenario), checks=(check,))
    assert solve(build(STUDY).stop(0)).answer["liquid_in_range"] is within


def test_histories_are_kept_when_asked_for(solver: QuickSolver, tmp_path: Path) -> None:
    carry_out(build(STUDY), tmp_path)
    study = build(replace(STUDY, histories=True))
    assert carry_out(study, tmp_path) == (0, 16)  # the rows are known, the histories are not
    assert carry_out(study, tmp_path) == (16, 0)
    found = table(study, tmp_path)
    files = [str(row["history"]) for row in found]
    assert len(set(files)) == 16
    assert all((tmp_path / file).is_file() for file in files)
    (tmp_path / _history_file(study.stop(3).scenario)).unlink()
    assert carry_out(study, tmp_path) == (15, 1)


def test_a_stop_without_a_result_has_no_history_and_is_not_tried_for_it(solver: QuickSolver, tmp_path: Path) -> None:
    def fails(scenario: Scenario) -> Result:
        raise PhysicsError("no", "wagon")

    solver.answer = fails
    study = build(Wishes(speeds="30", torques="5", histories=True))
    assert carry_out(study, tmp_path) == (0, 2)
    assert carry_out(study, tmp_path) == (2, 0)


def test_a_history_that_no_longer_fits_is_written_anew(solver: QuickSolver, tmp_path: Path) -> None:
    """Whatever a history shows is in its key: the output interval, the name; a row does not depend on either."""
    (tmp_path / "wagon.yaml").write_text(PAPER.read_text())
    wishes = Wishes(tmp_path / "wagon.yaml", speeds="30", torques="5", histories=True)
    carry_out(build(wishes), tmp_path)
    for setting in ("output.interval=20 ms", "name=another"):
        study = build(replace(wishes, overrides=[setting]))
        assert carry_out(study, tmp_path) == (0, 2)
        assert carry_out(study, tmp_path) == (2, 0)
        for row in table(study, tmp_path):
            kept = read_history(tmp_path / str(row["history"]))
            assert ("interval: 0.02 s" in kept.scenario_text) == ("interval" in setting)
            assert kept.name == ("another" if "name" in setting else "paper-80-liquid")
    assert carry_out(build(wishes), tmp_path) == (2, 0)  # the first ones are still there
    assert len(list((tmp_path / "histories").iterdir())) == 6
    assert len({study.stop(0).key, build(wishes).stop(0).key}) == 1


def test_a_new_result_version_needs_new_histories(
    solver: QuickSolver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = build(Wishes(speeds="30", torques="5", histories=True))
    carry_out(study, tmp_path)
    monkeypatch.setattr("slosh_cli.study.key.RESULT_VERSION", 999)
    assert carry_out(study, tmp_path) == (0, 2)
    assert len(list((tmp_path / "histories").iterdir())) == 4


def test_a_history_that_cannot_be_written_costs_no_row(
    solver: QuickSolver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = build(replace(STUDY, histories=True))
    write, lost = slosh_cli.results.hdf5.write_history, _history_file(study.stop(3).scenario)

    def fails(result: Result, path: Path) -> None:
        if path == tmp_path / lost:
            raise FileError(f"cannot write {path}: No space left on device", str(path))
        write(result, path)

    monkeypatch.setattr(slosh_cli.results.hdf5, "write_history", fails)
    assert carry_out(study, tmp_path) == (0, 16)
    found = table(study, tmp_path)
    assert len(found) == 16
    assert ["history" in row for row in found] == [index != 3 for index in range(16)]
    monkeypatch.setattr(slosh_cli.results.hdf5, "write_history", write)
    assert carry_out(study, tmp_path) == (15, 1)
    assert all("history" in row for row in table(study, tmp_path))
