"""`slosh run`, `check` and `plot` with a train."""

import json
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
from stand_ins import Slosh

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.results.data_sheet import data_sheet
from slosh_cli.scenario import load_scenario

TRAIN = """\
format: 1
name: three
vehicles:
  - {scenario: paper-80-solid, count: 2}
  - {scenario: paper-80-solid, set: {tank.fill: 0.3}}
braking: {initial_speed: 20 km/h, onset: 0.2 s}
"""
VEHICLE_KEYS = {
    "name", "onset_s", "distance_m", "liquid_model", "max_surface_m", "surface_limit_m", "min_wheel_load_N",
    "max_wheel_load_N", "max_wheel_unloading", "locked_time_s",
}  # fmt: skip
COUPLING_KEYS = {"max_compression_N", "max_tension_N", "max_compression_m", "max_tension_m", "energy_taken_J"}
TRAIN_KEYS = {
    "name", "status", "braking_distance_m", "braking_time_s", "initial_speed_m_s", "energy_residual", "steps",
    "rejected_steps", "solve_seconds", "warnings", "files", "vehicles", "couplings", "max_compression_N",
    "max_tension_N",
}  # fmt: skip


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "three.yaml"
    path.write_text(TRAIN, encoding="utf-8")
    return path


def test_a_run_tells_of_every_vehicle_and_coupling(slosh: Slosh, file: Path) -> None:
    outcome = slosh("run", file, "--json", "-o", "kept", "--set", "all.braking.torque=4 kN m")
    assert outcome.code == ExitCode.DONE, outcome.err
    answer = json.loads(outcome.out)
    assert set(answer) == TRAIN_KEYS
    assert [set(one) for one in answer["vehicles"]] == 3 * [VEHICLE_KEYS]
    assert [set(one) for one in answer["couplings"]] == 2 * [COUPLING_KEYS]
    assert answer["status"] == "stopped"
    assert answer["braking_distance_m"] == answer["vehicles"][0]["distance_m"]
    assert answer["max_compression_N"] == max(one["max_compression_N"] for one in answer["couplings"]) > 1e3
    with h5py.File("kept/run.h5") as kept:
        time, force = kept["time"][:], kept["coupling_001/force"][:]
        assert force.shape == time.shape == kept["vehicle_003/speed"].shape
        assert abs(force).max() <= 1.001 * max(
            answer["couplings"][0]["max_compression_N"], answer["couplings"][0]["max_tension_N"]
        )
        assert kept["coupling_002/compression"].attrs["units"] == "m"
        place = [kept[f"vehicle_{k:03d}/position"][:] for k in (1, 2, 3)]
        assert np.abs(kept["coupling_001/compression"][:] - (place[1] - place[0])).max() < 5e-3
        assert kept.attrs["status"] == "stopped"
        assert "vehicles" in kept["scenario"][()].decode()
        assert "fill" in kept["vehicle_003"].attrs["scenario"]
    assert len(pd.read_csv("kept/vehicles.csv")) == 3
    assert list(pd.read_csv("kept/couplings.csv")["coupling"]) == [1, 2]
    assert pd.read_csv("kept/summary.csv")["v0_km_h"][0] == 20.0
    assert Path("kept/coupling_forces.png").exists()
    for name in ("coupling_forces", "coupling_extremes", "brake_wave", "train_speed"):
        assert Path(f"kept/{name}.svg").exists()
    redrawn = slosh("plot", "kept/run.h5", "-o", "again")
    assert redrawn.code == ExitCode.DONE
    assert Path("again/train_speed.png").exists()


def test_a_run_for_people_has_a_row_per_vehicle(slosh: Slosh, file: Path) -> None:
    outcome = slosh("run", file, "--no-figures")
    assert outcome.code == ExitCode.DONE, outcome.err
    assert "three: 3 vehicles, 20 km/h" in outcome.out
    assert Path("outputs/three/run.h5").exists()
    assert slosh("run", file, "--no-figures").code == ExitCode.DONE
    assert not Path("outputs/three-2").exists()
    other = slosh("run", file, "--no-figures", "--set", "vehicles.3.tank.fill=0.8")
    assert other.code == ExitCode.DONE
    assert len(list(Path("outputs").iterdir())) == 2


def test_check_says_that_it_is_a_train(slosh: Slosh, file: Path) -> None:
    outcome = slosh("check", file)
    assert outcome.code == ExitCode.DONE
    assert "a sound train of 3 vehicles, 51.0 m long" in outcome.out
    assert json.loads(slosh("check", file, "--json").out)["describes"] == "a train"


def test_check_tells_of_every_kind_of_vehicle(slosh: Slosh, file: Path) -> None:
    options = ("--set", "vehicles.1.braking.blocks={count: 2, force: 30 kN, friction: cast-iron}")
    found = json.loads(slosh("check", file, "--json", *options).out)
    assert [kind["vehicles"] for kind in found["kinds"]] == [[1], [2], [3]]
    assert [kind["vehicles"] for kind in json.loads(slosh("check", file, "--json").out)["kinds"]] == [[1, 2], [3]]
    alone = data_sheet(load_scenario("paper-80-solid", ["tank.fill=0.3"]))
    for name in ("gross_mass_t", "fill", "slosh_period_s"):
        assert found["kinds"][2]["data_sheet"][name] == alone[name]
    assert found["kinds"][0]["brake"] == "blocks cast-iron, 2 x 30 kN"
    assert found["inputs"]["braking.onset"] == {"value": "0.2 s", "standing": "yours", "source": ""}
    told = slosh("check", file, *options).out
    row = next(line for line in told.splitlines() if line.startswith("1 "))
    assert f"{found['kinds'][0]['data_sheet']['tau']:.3f}" in row
    assert "blocks cast-iron, 2 x 30 kN" in row
    assert "(vehicles 3, " in told
    assert "(the train's own file)" in told


def test_couplings_with_slack_ask_for_a_finer_tolerance(slosh: Slosh, file: Path) -> None:
    words = "The couplings have slack"
    for command in (("check", file), ("run", file, "--no-figures", "-o", "kept")):
        assert words not in slosh(*command, "--json").out
        coarse = slosh(*command, "--set", "coupling=automatic", "--set", "all.solver.tolerance=1e-4", "--json")
        assert any(words in warning for warning in json.loads(coarse.out)["warnings"])
        assert words not in slosh(*command, "--set", "coupling=automatic", "--set", "all.solver.tolerance=5e-5").out


def test_a_bad_train_ends_with_2(slosh: Slosh, file: Path) -> None:
    file.write_text(TRAIN.replace("count: 2", "count: 0"), encoding="utf-8")
    for command in ("run", "check"):
        outcome = slosh(command, file)
        assert outcome.code == ExitCode.BAD_INPUT
        assert "three.yaml:4: vehicles.0.count" in outcome.err
