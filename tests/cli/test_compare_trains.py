"""`slosh compare` and `slosh run --twin` with trains, and a twin that no longer belongs to its run."""

import json
import shutil
from pathlib import Path

import pytest
from plausible import plausible_run
from stand_ins import PAPER, Slosh, Solver

from slosh_cli.application.comparison import differences
from slosh_cli.application.differing import differing_inputs, listed
from slosh_cli.application.train import simulate_train
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.errors import UsageError
from slosh_cli.report.compare_train_figures import compare_train_figures
from slosh_cli.results.hdf5 import read_train, write_history, write_train
from slosh_cli.scenario import load_scenario
from slosh_cli.scenario.train_file import load_train

TRAIN = """\
format: 1
name: four
vehicles:
  - {scenario: paper-80-solid, count: 3, set: {tank.coefficients: computed}}
  - {scenario: paper-80-solid, set: {tank.fill: 0.3, tank.coefficients: computed}}
braking: {initial_speed: 10 km/h, onset: 0.2 s}
output: {interval: 0.1 s}
"""


@pytest.fixture
def train(tmp_path: Path) -> Path:
    file = tmp_path / "four.yaml"
    file.write_text(TRAIN, encoding="utf-8")
    return file


def test_trains_are_compared_as_files_and_in_memory(slosh: Slosh, train: Path) -> None:
    first = simulate_train(train)
    other = simulate_train(load_train(train, ["vehicles.2.braking.torque=6 kN m", "coupling.linear.stiffness=1e6 N/m"]))
    for run, name in ((first, "A.h5"), (other, "B.h5")):
        write_train(run, Path(name))
    told = json.loads(slosh("compare", "A.h5", "B.h5", "-o", "out", "--json").out)
    answers = {one["name"]: one for one in told["answers"]}
    assert answers["braking_distance_m"]["values"] == [first.braking_distance_m, other.braking_distance_m]
    assert answers["max_compression_N"]["values"][1] == other.max_compression_N
    assert answers["compression_at"]["values"] == [first.compression_at, other.compression_at]
    assert answers["compression_at"]["percent"] == [None]
    least = [min(min(one.min_wheel_load_N) for one in run.vehicles) for run in (first, other)]
    assert answers["min_wheel_load_N"]["values"] == least
    places = answers["min_wheel_load_at"]["values"]
    assert [min(run.vehicles[int(k) - 1].min_wheel_load_N) for run, k in zip((first, other), places, strict=True)] == (
        least
    )
    assert answers["locked_vehicles"]["values"] == [
        sum(max(one.locked_time_s) > 0.0 for one in run.vehicles) for run in (first, other)
    ]
    assert "vehicles.2.braking.torque" in told["inputs"]
    assert told["inputs"]["coupling.linear.stiffness"] == [None, "1000000.0 N/m"]
    assert not [key for key in told["inputs"] if "onset" in key or key.startswith(("all", "presets"))]
    assert {Path(file).stem for file in told["figures"]} == {"compare_train_speed", "compare_train_forces"}
    assert [one.as_dict() for one in differences([first, other])] == told["answers"]
    assert differing_inputs([first, read_train(Path("B.h5"))]) == told["inputs"]
    assert "compression at (coupling with" in slosh("compare", "A.h5", "B.h5", "-o", "out").out


def test_every_train_lies_inside_the_picture(train: Path) -> None:
    runs = [simulate_train(load_train(train, [f"coupling={kind}"])) for kind in ("screw", "automatic")]
    for draw in compare_train_figures([run.history for run in runs], ["A", "B"]).values():
        for axes in draw().axes:
            low, high = axes.get_ylim()
            assert len(axes.lines) == 2
            assert all(low <= value <= high for line in axes.lines for value in line.get_ydata())


def test_a_wagon_is_not_compared_with_a_train(slosh: Slosh, train: Path) -> None:
    wagon = plausible_run(load_scenario(PAPER))
    write_history(wagon, Path("wagon.h5"))
    write_train(run := simulate_train(train), Path("train.h5"))
    for files in (("wagon.h5", "train.h5"), ("train.h5", "wagon.h5")):
        done = slosh("compare", *files)
        assert done.code == ExitCode.BAD_INPUT
        assert "train.h5 is the run of a train" in done.err
        assert "wagon.h5" in done.err
    with pytest.raises(UsageError, match="of a train"):
        differences([run, read_train(Path("train.h5")), wagon])


def test_the_liquids_of_a_train_have_their_twins(slosh: Slosh, train: Path) -> None:
    liquid = ("--set", "all.tank.liquid.model=modal", "--no-figures", "-o", "out")
    told = json.loads(slosh("run", train, "--twin", "--json", *liquid).out)["twin"]
    assert {one["liquid_model"] for one in told["solid"]["vehicles"]} == {"rigid"}
    assert len(told["words"]) == 5
    assert told["words"][1].startswith("largest compression: ")
    assert read_train(Path("out/solid/run.h5")).status == "stopped"
    assert slosh("run", train, *liquid).code == ExitCode.DONE
    assert not Path("out/solid").exists()
    done = slosh("run", train, "--twin", "--no-figures", "-o", "out")
    assert done.code == ExitCode.BAD_INPUT
    assert "all.tank.liquid.model" in done.err


def test_no_twin_is_left_beside_another_run(slosh: Slosh, solver: Solver) -> None:
    slosh("run", PAPER, "--twin", "--no-figures", "-o", "out")
    Path("out/solid/notes.txt").write_text("mine")
    assert slosh("run", PAPER, "--no-figures", "-o", "out", "--set", "braking.torque=6 kN m").code == ExitCode.DONE
    assert [file.name for file in Path("out/solid").iterdir()] == ["notes.txt"]
    shutil.copy("out/run.h5", "out/solid/run.h5")
    done = slosh("run", PAPER, "--no-figures", "-o", "out")
    assert "out/solid holds a run that is not known to be the solid twin" in done.err
    assert Path("out/solid/run.h5").exists()


def test_places_are_listed() -> None:
    assert [listed(some) for some in ([4], [1, 2, 3], [1, 3, 4, 9])] == ["4", "1-3", "1,3-4,9"]
