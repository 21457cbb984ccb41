"""`slosh compare` and `slosh run --twin`: what differs, and what cannot be compared."""

import json
from dataclasses import replace
from pathlib import Path

import h5py
import pytest
from plausible import plausible_run, unfinished_run
from stand_ins import PAPER, Slosh, Solver

from slosh_cli.application.comparison import differences, liquid_words
from slosh_cli.application.differing import Difference, differing_inputs
from slosh_cli.cli.compare import answer_lines
from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.results.hdf5 import write_history
from slosh_cli.scenario import load_scenario


@pytest.fixture
def runs(tmp_path: Path) -> tuple[Path, Path]:
    first = plausible_run(load_scenario(PAPER))
    other = replace(
        first,
        braking_distance_m=1.1 * first.braking_distance_m,
        scenario=first.scenario.with_({"tank.liquid.model": "rigid", "name": "other"}),
    )
    files = tmp_path / "A.h5", tmp_path / "B.h5"
    for run, file in zip((first, other), files, strict=True):
        write_history(run, file)
    return files


def test_answers_and_inputs_that_differ_are_told(slosh: Slosh, runs: tuple[Path, Path]) -> None:
    done = slosh("compare", *runs, "-o", "out", "--json")
    assert done.code == ExitCode.DONE
    told = json.loads(done.out)
    distance = next(one for one in told["answers"] if one["name"] == "braking_distance_m")
    assert distance["percent"] == [pytest.approx(10.0)]
    assert distance["change"] == [pytest.approx(distance["values"][1] - distance["values"][0])]
    assert told["inputs"] == {"tank.liquid.model": ["modal", "rigid"]}
    assert {Path(file).stem for file in told["figures"]} == {
        "compare_speed", "compare_wheel_loads", "compare_slosh", "compare_brake",
    }  # fmt: skip
    assert all(Path(file).stat().st_size > 1000 for file in told["figures"])


def test_points_are_no_per_cent_and_inputs_stand_as_written(slosh: Slosh, tmp_path: Path) -> None:
    """Unloadings of 20 % and 25 % are 5 points apart, and 25 per cent."""
    (line, other) = answer_lines([Difference("max_wheel_unloading", "largest", "%", 0.01, (0.2, 0.25))])[1:]
    assert line == "  A           20 %"
    assert other == "  B           25 %   +5 points (+25 %)"
    first = plausible_run(load_scenario(PAPER))
    baffles = [{"position": "5 m", "opening": 0.2}]
    walled = first.scenario.with_({"tank.liquid.model": "shallow-water", "tank.baffles": baffles})
    files = tmp_path / "A.h5", tmp_path / "B.h5"
    for run, file in zip((first, replace(first, scenario=walled)), files, strict=True):
        write_history(run, file)
    assert "[] | [{position: 5.0 m, opening: 0.2}]" in slosh("compare", *files, "-o", "out").out


def test_no_number_is_cut_on_a_narrow_terminal(
    slosh: Slosh, runs: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    out = slosh("compare", *runs, "-o", "out").out
    assert "\u2026" not in out
    assert "(+10 %)" in out
    assert "tank.liquid.model: modal | rigid" in out


def test_what_cannot_be_compared_is_refused_with_the_file(slosh: Slosh, runs: tuple[Path, Path]) -> None:
    first, _ = runs
    Path("text.h5").write_text("no history")
    Path("folder").mkdir()
    with h5py.File("other.h5", "w") as file:
        file["x"] = [1.0]
    with h5py.File("train.h5", "w") as file:
        file.attrs["train_format_version"] = 1
    for wrong, word in (
        (first, "same file"), ("text.h5", "slosh run"), ("folder", "run.h5"), ("other.h5", "slosh run"),
        ("missing.h5", "does not exist"), ("train.h5", "slosh run"),
    ):  # fmt: skip
        done = slosh("compare", first, wrong)
        assert done.code == ExitCode.BAD_INPUT, wrong
        assert str(wrong) in done.err
        assert word in done.err
    assert slosh("compare", first).code == ExitCode.BAD_INPUT


def test_a_run_without_a_distance_has_no_difference() -> None:
    distance = differences([plausible_run(load_scenario(PAPER)), unfinished_run(load_scenario(PAPER))])[0]
    assert (distance.name, distance.values[1], distance.change(1), distance.percent(1)) == (
        "braking_distance_m", None, None, None,
    )  # fmt: skip
    assert "no difference" in liquid_words(plausible_run(load_scenario(PAPER)), unfinished_run(load_scenario(PAPER)))[0]


def test_runs_of_one_scenario_differ_in_no_input() -> None:
    assert differing_inputs([plausible_run(load_scenario(PAPER)), plausible_run(load_scenario(PAPER))]) == {}


def test_a_twin_runs_beside_the_liquid_and_is_kept(slosh: Slosh, solver: Solver) -> None:
    done = slosh("run", PAPER, "--twin", "--no-figures", "-o", "out", "--json")
    told = json.loads(done.out)["twin"]
    assert told["solid"]["liquid_model"] == "rigid"
    assert Path(told["solid"]["files"]["history"]) == Path("out/solid/run.h5")
    assert Path("out/solid/run.h5").is_file()
    assert Path("out/run.h5").is_file()
    assert len(told["words"]) == 3
    assert "what the liquid did" in slosh("run", PAPER, "--twin", "--no-figures", "-o", "out").out


def test_a_solid_has_no_twin(slosh: Slosh, solver: Solver) -> None:
    done = slosh("run", PAPER, "--twin", "--set", "tank.liquid.model=rigid", "-o", "out")
    assert done.code == ExitCode.BAD_INPUT
    assert "--twin" in done.err
