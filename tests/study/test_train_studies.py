"""Studies of trains: rows are those of single runs, nothing finished is lost, wrong keys are told before any stop."""

import json
import re
import signal
import time
from pathlib import Path
from threading import Event

import pandas as pd
import pytest
from study_tools import begun, count, journal_rows, run_slosh, start_slosh

from slosh_cli.application.studies import sweep
from slosh_cli.errors import ScenarioError, UsageError
from slosh_cli.results.hdf5 import read_train
from slosh_cli.results.simulate import simulate_train
from slosh_cli.scenario.train_file import load_train
from slosh_cli.study.build import Wishes, build, grid
from slosh_cli.study.estimate import seconds_per_stop
from slosh_cli.study.key import stop_key
from slosh_cli.study.runner import plan

TRAIN = """\
format: 1
name: short
vehicles:
  - {scenario: tank-wagon, set: {tank.liquid.model: rigid, tank.fill: 0.9, braking.torque: 6 kN m}}
  - {scenario: own.yaml, count: 2, set: {tank.liquid.model: rigid, tank.coefficients: computed}}
coupling: screw
braking: {initial_speed: 6 km/h, onset: 0.1 s, stop_speed: 0.2 m/s}
solver: {tolerance: 1.0e-2}
output: {interval: 50 ms}
"""
VARY = {"vehicles.2.tank.fill": "0.5,0.7", "coupling": "screw,automatic", "braking.initial_speed": "5,6 km/h"}


@pytest.fixture
def file(tmp_path: Path, scenarios: Path) -> Path:
    (tmp_path / "own.yaml").write_bytes((scenarios / "tank_wagon.yaml").read_bytes())
    found = tmp_path / "short.yaml"
    found.write_text(TRAIN, encoding="utf-8")
    return found


@pytest.fixture
def scenarios() -> Path:
    return Path(__file__).parents[2] / "scenarios"


def test_the_rows_of_a_study_are_those_of_single_runs(file: Path) -> None:
    found = sweep(file, VARY)
    assert len(found.rows) == 8
    for row in (found.rows[1], found.rows[6]):
        overrides = (
            f"vehicles.2.tank.fill={row['vehicles_2_tank_fill']}",
            f"coupling={row['coupling']}",
            f"braking.initial_speed={row['v0_km_h']} km/h",
        )
        alone = simulate_train(load_train(file, overrides))
        answers = ("braking_distance_m", "max_compression_N", "max_tension_N", "compression_at", "steps")
        for answer in (*answers, "max_compression_s", "max_tension_s", "max_wheel_unloading"):
            assert row[answer] == pytest.approx(getattr(alone, answer), rel=1e-12), answer
        largest = alone.couplings[row["compression_at"] - 1]
        assert largest.max_compression_s == row["max_compression_s"]
    assert len({row["max_compression_N"] for row in found.rows}) == 8
    assert set(found.figures()) == {f"{kind}_{k}" for kind in ("braking_distance", "coupler_forces") for k in (1, 2)}


@pytest.mark.parametrize(
    "overrides",
    [
        {"all.tank.fill": "0.4"},
        {"vehicles.3.tank.fill": "40 %", "coupling": "automatic"},
        {"brake_pipe.speed": "200 m/s", "output.interval": "1 s", "all.contact.adhesion": "wet"},
        {"all.braking.application": "P", "vehicles.1.braking.application": "G"},
        {"coupling.transition_stiffness": "2e8 N/m"},
    ],
)
def test_a_train_with_other_values_is_the_one_that_its_file_with_them_tells(file: Path, overrides: dict) -> None:
    train = load_train(file)
    changed = train.with_(overrides)
    read = load_train(file, [f"{key}={value}" for key, value in overrides.items()])
    assert stop_key(changed) == stop_key(read)
    assert changed.vehicles == read.vehicles
    assert stop_key(changed) != stop_key(train)


@pytest.mark.parametrize("keys", [("all.tank.fill", "vehicles.1.tank.fill"), ("vehicles.1.tank.fill", "all.tank.fill")])
def test_what_is_said_of_one_vehicle_holds_there_in_any_order(file: Path, keys: tuple[str, str]) -> None:
    values = {"all.tank.fill": ("0.4", "0.6"), "vehicles.1.tank.fill": ("0.7", "0.8")}
    study = build(Wishes(file, vary=tuple(f"{key}={','.join(values[key])}" for key in keys)))
    for index in range(study.size):
        told = study.values(index)
        one, every = float(told["vehicles.1.tank.fill"]), float(told["all.tank.fill"])
        assert [vehicle.tank.fill for vehicle in study.stop(index).scenario.vehicles] == [one, every, every]
        alone = load_train(file, [f"{key}={told[key]}" for key in keys])
        assert study.stop(index).key == stop_key(alone)


def test_what_is_set_of_one_vehicle_holds_in_a_study_of_all(file: Path) -> None:
    one = "vehicles.3.tank.fill=0.8"
    study = build(Wishes(file, (one,), vary=("all.tank.fill=0.4,0.6",)))
    for index, fill in enumerate(("0.4", "0.6")):
        alone = load_train(file, [one, f"all.tank.fill={fill}"])
        assert [vehicle.tank.fill for vehicle in alone.vehicles] == [float(fill), float(fill), 0.8]
        assert study.stop(index).key == stop_key(alone)


def test_a_combination_that_is_not_sound_costs_only_itself(file: Path) -> None:
    speeds = {"braking.stop_speed": "7 km/h,0.2 m/s", "braking.initial_speed": "6,10 km/h"}
    rows = sweep(file, speeds).rows
    assert [row["status"] for row in rows] == ["failed", "stopped", "stopped", "stopped"]
    assert "must be below the initial speed" in rows[0]["reason"]


def test_a_train_that_has_not_been_compiled_is_expected_to_take_as_long_as_its_vehicles(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slosh_cli.compiled.solver_is_cached", lambda _: False)
    study = build(Wishes(file, vary=("all.tank.fill=0.4,0.6",)))
    wagon = build(Wishes(file.parent / "own.yaml", vary=("tank.fill=0.4,0.6", "tank.coefficients=computed")))
    each, of_wagon = (seconds_per_stop(one, plan(one, None, tmp_path), None) for one in (study, wagon))
    assert each == 3 * of_wagon


def test_what_says_nothing_of_the_answer_is_not_in_a_trains_key(file: Path) -> None:
    train = load_train(file)
    words = {"name": "other", "description": "other", "output.interval": "1 s"}
    assert stop_key(train.with_(words)) == stop_key(train)
    swapped = load_train(file, ["vehicles.1.tank.fill=0.5", "vehicles.2.tank.fill=0.9"])
    assert stop_key(swapped) != stop_key(load_train(file, ["vehicles.2.tank.fill=0.5"]))


BAD = {
    "vehicles.4.tank.fill": ("0.5", "vehicle from the front, 1 to 3"),
    "vehicles.2.tank.fil": ("0.5", "write `fill`"),
    "all.braking.initial_speed": ("5 km/h", "write `braking.initial_speed=...`"),
    "vehicles.02.tank.fill": ("0.5", "must be `all.KEY`"),
    "vehicles": ("1", "must be `all.KEY`"),
    "all.tank.fill": ("0.5,7", "number from 0.02"),
    "tank.fill": ("0.5", "tank"),
    "coupling": ("screw,rope", "`screw`, `automatic`"),
}


@pytest.mark.parametrize("key", BAD)
def test_wrong_keys_and_values_are_told_before_anything_runs(file: Path, key: str) -> None:
    values, told = BAD[key]
    with pytest.raises(ScenarioError, match=re.escape(told)) as caught:
        build(Wishes(file, vary=(f"{key}={values}",))).check()
    assert f"--vary {key}" in str(caught.value)


@pytest.mark.parametrize(
    ("wishes", "told"),
    [
        ({}, "something that varies"),
        ({"torques": "5,6", "speeds": "5"}, "all.braking.torque"),
        ({"liquids": "modal"}, "all.tank.liquid.model"),
        ({"vary": ("braking.torque=5 kN m",)}, "all.braking.torque"),
        ({"speeds": "5", "vary": ("braking.initial_speed=6 km/h",)}, "ask for the same"),
    ],
)
def test_what_only_wagons_have_is_refused_with_the_way_to_say_it(file: Path, wishes: dict, told: str) -> None:
    with pytest.raises(UsageError, match=re.escape(told)):
        build(Wishes(file, **wishes))


def test_numbers_of_a_script_have_the_unit_of_the_vehicle_or_the_train(file: Path) -> None:
    study = grid(file, {"all.wagon.bogie.mass": [1500.0], "brake_pipe.speed": [250.0], "vehicles.2.tank.length": [15]})
    train = study.stop(0).scenario
    assert train.vehicles[0].wagon.bogie.mass == 1500.0
    assert train.file.brake_pipe.speed == 250.0
    assert (train.vehicles[1].tank.length, train.vehicles[2].tank.length) == (15.0, 15.5)


def test_a_study_may_be_interrupted_and_one_of_another_wagon_computes_anew(file: Path, tmp_path: Path) -> None:
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    sweep(file, VARY, folder=whole)
    cancel = Event()
    first = sweep(
        file, VARY, folder=parts, threads=1, progress=lambda done, _: done >= 3 and cancel.set(), cancel=cancel
    )
    assert 3 <= len(first.rows) < 8
    assert sweep(file, VARY, folder=parts).reused >= 3
    assert (whole / "braking_distance.csv").read_bytes() == (parts / "braking_distance.csv").read_bytes()
    own = file.parent / "own.yaml"
    own.write_text(own.read_text(encoding="utf-8").replace("mass: 1.8 t", "mass: 1.9 t"), encoding="utf-8")
    assert sweep(file, VARY, folder=parts).reused == 0


def test_a_study_that_is_killed_loses_nothing_and_its_table_is_that_of_an_uninterrupted_one(
    file: Path, tmp_path: Path
) -> None:
    journal = tmp_path / "killed" / "journal.sqlite"
    arguments = ["sweep", file, "--vary", "all.tank.fill=0.41:0.65:0.02", "--v0", "5,6", "--json", "--jobs", 2]
    process = start_slosh(tmp_path, *arguments, "-o", "killed")
    until = time.monotonic() + 120.0
    while count(journal) < 4 and time.monotonic() < until and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    before = journal_rows(journal)
    assert 4 <= len(before) < 26
    code, out, err = run_slosh(tmp_path, *arguments, "-o", "killed")
    assert code == 0, err
    assert json.loads(out)["reused"] == len(before)
    assert before.items() <= journal_rows(journal).items()
    vary = {"all.tank.fill": "0.41:0.65:0.02", "braking.initial_speed": "5,6 km/h"}
    sweep(file, vary, folder=tmp_path / "whole", threads=1)
    tables = [(tmp_path / name / "braking_distance.csv").read_bytes() for name in ("killed", "whole")]
    assert tables[0] == tables[1]
    assert len(tables[0].splitlines()) == 27


def test_histories_of_a_study_are_those_of_trains(file: Path, tmp_path: Path) -> None:
    found = sweep(file, {"coupling": "screw"}, folder=tmp_path / "kept", histories=True)
    history = read_train(tmp_path / "kept" / found.rows[0]["history"])
    assert len(history.vehicles) == 3
    assert max(history.couplings[0].channels["force"]) <= found.rows[0]["max_compression_N"] * (1 + 1e-9)


def test_the_command_takes_a_study_file_of_a_train(file: Path, tmp_path: Path) -> None:
    study = tmp_path / "study.yaml"
    study.write_text("base: short.yaml\nvary:\n  all.braking.application: [step, P]\n", encoding="utf-8")
    code, out, err = run_slosh(tmp_path, "sweep", study, "--vary", "coupling=screw", "-o", "kept", "--json")
    assert code == 0, err
    told = json.loads(out)
    assert (told["done"], told["failed"]) == (2, 0)
    table = pd.read_csv(tmp_path / told["table"])
    assert list(table["all_braking_application"]) == ["step", "P"]
    assert (table["max_compression_N"] > 0).all()
    assert not {"ratio_to_solid", "liquid"} & {*table}
    code, out, err = run_slosh(tmp_path, "sweep", study, "--vary", "coupling=screw", "-o", "kept")
    assert code == 0, err
    assert all(word in out for word in ("application", "compression", "2 of them from the journal"))


def test_a_pitch_limit_is_a_row_of_a_study_and_no_failure(file: Path, tmp_path: Path) -> None:
    soft = "all.wagon.secondary_suspension.stiffness=1e5 N/m"
    moving = ("--set", "all.tank.liquid.model=modal", "--set", "all.braking.torque=30 kN m")
    arguments = ["sweep", file, *moving, "--vary", soft, "--v0", "60", "-o", "kept"]
    code, _, err = run_slosh(tmp_path, *arguments)
    table = pd.read_csv(tmp_path / "kept" / "braking_distance.csv")
    assert list(table["status"]) == ["pitch-limit"], err
    assert code == 0, err


@pytest.mark.slow
def test_a_thousand_stops_of_twenty_wagons_survive_kills(tmp_path: Path, scenarios: Path) -> None:
    """Killed four times amid its stops: what the journal held is never begun again, and the table is whole."""
    text = (scenarios / "trains" / "block_train.yaml").read_text(encoding="utf-8")
    file = tmp_path / "block.yaml"
    file.write_text(text.replace("initial_speed: 80 km/h", "initial_speed: 3 km/h"), encoding="utf-8")
    (tmp_path / "outputs").mkdir()
    ranges = ("--vary", "all.tank.liquid.model=rigid", "--vary", "all.tank.fill=0.301:0.8:0.001", "--v0", "3,4")
    arguments = ["sweep", file, "--set", "solver.tolerance=1e-2", *ranges, "-o", "kept", "--jobs", 2]
    journal = tmp_path / "kept" / "journal.sqlite"
    for number in range(4):
        (tmp_path / "begun.log").unlink(missing_ok=True)
        before = journal_rows(journal) if journal.exists() else {}
        process = start_slosh(tmp_path, *arguments)
        until = time.monotonic() + 600.0
        while count(journal) < 200 * (number + 1) and time.monotonic() < until and process.poll() is None:
            time.sleep(0.05)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        after = journal_rows(journal)
        assert before.items() <= after.items()
        assert not {*begun(tmp_path)} & {*before}
    code, _, err = run_slosh(tmp_path, *arguments)
    assert code == 0, err
    table = pd.read_csv(tmp_path / "kept" / "braking_distance.csv")
    assert len(table) == 1000
    assert (table["status"] == "stopped").all()
