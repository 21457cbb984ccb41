"""`slosh run`: files, summary, JSON, exit codes."""

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd
import pytest
from plausible import plausible_run, unfinished_run
from stand_ins import PAPER, Slosh, Solver

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.report import figures

KEYS = [
    "name",
    "status",
    "braking_distance_m",
    "braking_time_s",
    "initial_speed_m_s",
    "torque_N_m",
    "liquid_model",
    "max_surface_m",
    "surface_limit_m",
    "min_wheel_load_N",
    "max_wheel_load_N",
    "max_wheel_unloading",
    "locked_time_s",
    "brake_torque_max_N_m",
    "slide_protection_cycles",
    "slide_protection_air",
    "speed_at_first_lock_m_s",
    "energy_residual",
    "steps",
    "rejected_steps",
    "solve_seconds",
    "in_model_range",
    "checks",
    "warnings",
    "files",
]


def strict_json(text: str) -> Any:
    """One JSON object and nothing else; NaN and infinity, which JSON does not know, are refused."""

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    return json.loads(text, parse_constant=refuse)


def names(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


DRAWN = {f"{name}.{kind}" for name in figures.FIGURES if name not in ("brake", "line") for kind in figures.FORMATS}


def test_files_lie_in_the_folder_named_after_the_scenario(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    assert slosh("run", PAPER).code == ExitCode.DONE
    assert names(tmp_path / "outputs" / "paper-80-liquid") == {"run.h5", "summary.csv", *DRAWN}


def test_files_lie_where_the_user_wants_them(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    assert slosh("run", PAPER, "-o", "a/b", "--no-figures").code == ExitCode.DONE
    assert names(tmp_path / "a" / "b") == {"run.h5", "summary.csv"}
    assert pd.read_csv(tmp_path / "a/b/summary.csv")["name"][0] == "paper-80-liquid"


def test_values_can_be_changed_on_the_command_line(slosh: Slosh, solver: Solver) -> None:
    outcome = slosh("run", PAPER, "--no-figures", "--set", "braking.torque=12 kN m", "--set", "tank.liquid.model=rigid")
    assert outcome.code == ExitCode.DONE
    assert solver.scenarios[0].braking.torque == 12e3
    assert solver.scenarios[0].tank.liquid.model == "rigid"


def test_a_wrong_value_on_the_command_line_is_the_users_matter(slosh: Slosh, solver: Solver) -> None:
    outcome = slosh("run", PAPER, "--set", "braking.torque=12 m")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "braking.torque" in outcome.err
    assert solver.scenarios == []


def test_the_summary_shows_the_answer_and_the_way_to_it(slosh: Slosh, solver: Solver) -> None:
    outcome = slosh("run", PAPER, "--no-figures")
    result = plausible_run(solver.scenarios[0])
    text = " ".join(outcome.out.split())
    assert f"braking distance {result.braking_distance_m:.2f} m" in text
    assert f"braking time {result.braking_time_s:.2f} s" in text
    assert "812 accepted, 23 rejected" in text
    assert "505 microseconds per step" in text
    assert f"1 93.0 {result.min_wheel_load_N[0] / 1e3:.1f} {result.max_wheel_load_N[0] / 1e3:.1f}" in text
    assert f"warning: {result.warnings[0]}" in text
    assert str(Path("outputs/paper-80-liquid/run.h5")) in text
    assert outcome.err == ""


def test_a_rigid_load_shows_no_surface(slosh: Slosh, solver: Solver) -> None:
    outcome = slosh("run", PAPER, "--no-figures", "--set", "tank.liquid.model=rigid")
    assert "surface" not in outcome.out


def test_json_is_one_object_with_the_keys_of_the_contract(slosh: Slosh, solver: Solver) -> None:
    outcome = slosh("run", PAPER, "--json")
    answer = strict_json(outcome.out)
    assert list(answer) == KEYS
    assert answer["status"] == "stopped"
    assert answer["braking_distance_m"] == plausible_run(solver.scenarios[0]).braking_distance_m
    files = answer["files"]
    assert all(Path(file).is_file() for file in [files["history"], files["summary"], *files["figures"]])
    assert {Path(file).name for file in files["figures"]} == DRAWN
    assert f"warning: {answer['warnings'][0]}" in outcome.err


def test_json_knows_no_nan_and_takes_numpy_numbers(slosh: Slosh, solver: Solver) -> None:
    solver.answer = lambda scenario: replace(
        plausible_run(scenario),
        energy_residual=np.float64("nan"),
        max_surface_m=float("inf"),
        steps=np.int64(7),
        min_wheel_load_N=(np.float64(1.5), 2.0, 3.0, 4.0),
    )
    answer = strict_json(slosh("run", PAPER, "--json", "--no-figures").out)
    assert answer["energy_residual"] is None
    assert answer["max_surface_m"] is None
    assert type(answer["steps"]) is int
    assert answer["steps"] == 7
    assert answer["min_wheel_load_N"] == [1.5, 2.0, 3.0, 4.0]


def test_a_run_without_an_answer_keeps_its_files_and_says_why(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    solver.answer = unfinished_run
    outcome = slosh("run", PAPER, "-o", "here")
    assert outcome.code == ExitCode.NO_ANSWER == 3
    text = " ".join(outcome.out.split())
    assert "No braking distance: time-limit. still at 3.1 m/s after 600 s" in text
    assert "solver.time_limit" in text
    assert "braking distance -" in text
    assert {"run.h5", "summary.csv"} <= names(tmp_path / "here")


def test_json_of_a_run_without_an_answer(slosh: Slosh, solver: Solver) -> None:
    solver.answer = unfinished_run
    outcome = slosh("run", PAPER, "--json", "--no-figures")
    assert outcome.code == ExitCode.NO_ANSWER
    answer = strict_json(outcome.out)
    assert answer["status"] == "time-limit"
    assert answer["braking_distance_m"] is None
    assert "still at 3.1 m/s after 600 s" in answer["warnings"]
    assert "time-limit: still at 3.1 m/s after 600 s" in outcome.err


def test_a_second_run_replaces_the_first_whole(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    slosh("run", PAPER, "-o", "here")
    (tmp_path / "here" / "notes.txt").write_text("mine")
    slosh("run", PAPER, "-o", "here", "--set", "tank.liquid.model=rigid")
    assert names(tmp_path / "here") == {"notes.txt", "run.h5", "summary.csv", *DRAWN} - {
        "slosh.png",
        "slosh.svg",
    }


def full_disk(*_: object, **__: object) -> None:
    raise OSError(28, "No space left on device")


@pytest.mark.parametrize(
    ("writer", "lost"),
    [
        ("results.hdf5.write_history", {"run.h5"}),
        ("results.tables.write_table", {"summary.csv"}),
        ("report.figures.wheel_speed", {"wheel_speed.png", "wheel_speed.svg"}),
        ("report.figures.draw_run", DRAWN),
    ],
)
@pytest.mark.parametrize("as_json", [False, True], ids=["people", "json"])
def test_what_cannot_be_written_costs_itself_alone(
    slosh: Slosh, solver: Solver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, writer: str, lost: set[str],
    as_json: bool,
) -> None:  # fmt: skip
    """The answer is told, every other file is there and of this run, what was there before is gone, exit code 2."""
    here = tmp_path / "here"
    here.mkdir()
    for file in ("run.h5", "summary.csv", *DRAWN):
        (here / file).write_text("of an earlier run")
    solver.answer = lambda scenario: replace(plausible_run(scenario), braking_distance_m=123.25)
    home, name = f"slosh_cli.{writer}".rsplit(".", 1)
    if name == "wheel_speed":
        monkeypatch.setitem(figures.FIGURES, name, full_disk)  # type: ignore[arg-type]
    else:
        monkeypatch.setattr(f"{home}.{name}", full_disk)
    outcome = slosh("run", PAPER, "-o", "here", *(["--json"] if as_json else []))
    assert outcome.code == ExitCode.BAD_INPUT
    assert "123.25" in outcome.out
    assert "No space left on device" in outcome.err
    assert all(file.split(".")[0] in outcome.err for file in lost)
    assert names(here) == {"run.h5", "summary.csv", *DRAWN} - lost
    assert all(file.read_bytes() != b"of an earlier run" for file in here.iterdir())
    if "run.h5" not in lost:
        with h5py.File(here / "run.h5") as file:
            assert file.attrs["braking_distance_m"] == 123.25
    if "summary.csv" not in lost:
        assert pd.read_csv(here / "summary.csv")["braking_distance_m"][0] == 123.25
    if as_json:
        answer = strict_json(outcome.out)
        assert {Path(file).name for file in told(answer["files"])} == names(here)
        assert any("No space left on device" in warning for warning in answer["warnings"])


def told(files: dict[str, Any]) -> list[str]:
    """Every file that the JSON object names."""
    return [*files["figures"], *(files[kind] for kind in ("history", "summary") if kind in files)]


def test_a_figure_that_fails_in_any_way_costs_itself_alone(
    slosh: Slosh, solver: Solver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(_: object) -> None:
        raise ValueError("no such font")

    monkeypatch.setitem(figures.FIGURES, "slosh", fails)  # type: ignore[arg-type]
    outcome = slosh("run", PAPER, "-o", "here")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "the figure here/slosh could not be written: ValueError: no such font" in outcome.err
    assert names(tmp_path / "here") == {"run.h5", "summary.csv", *DRAWN} - {"slosh.png", "slosh.svg"}


def test_a_run_without_an_answer_says_so_even_if_a_file_fails(
    slosh: Slosh, solver: Solver, monkeypatch: pytest.MonkeyPatch
) -> None:
    solver.answer = unfinished_run
    monkeypatch.setattr("slosh_cli.results.hdf5.write_history", full_disk)
    assert slosh("run", PAPER, "-o", "here", "--no-figures").code == ExitCode.NO_ANSWER


def _a_folder(here: Path) -> None:
    (here / "run.h5").mkdir(parents=True)


def _a_figures_folder(here: Path) -> None:
    (here / "slosh.png").mkdir(parents=True)


def _a_file(here: Path) -> None:
    here.write_text("")


def _a_dangling_link(here: Path) -> None:
    here.symlink_to(here.with_name("nowhere"))


@pytest.mark.parametrize(
    ("obstacle", "words"),
    [
        (_a_folder, "there is a folder of that name"),
        (_a_figures_folder, "there is a folder of that name"),
        (_a_file, "is not a folder"),
        (_a_dangling_link, "is a link that leads nowhere"),
    ],
)
def test_targets_are_tried_before_the_run(
    slosh: Slosh, solver: Solver, tmp_path: Path, obstacle: Callable[[Path], None], words: str
) -> None:
    obstacle(tmp_path / "here")
    before = sorted(tmp_path.rglob("*"))
    outcome = slosh("run", PAPER, "-o", "here")
    assert outcome.code == ExitCode.BAD_INPUT
    assert words in outcome.err
    assert solver.scenarios == []
    assert sorted(tmp_path.rglob("*")) == before


def test_a_name_that_is_too_long_is_refused_before_the_run(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    outcome = slosh("run", PAPER, "-o", f"new/{'x' * 300}")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "File name too long" in outcome.err
    assert solver.scenarios == []
    assert list(tmp_path.iterdir()) == []


def test_a_link_in_place_of_a_file_gives_way(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "run.h5").symlink_to(tmp_path / "nowhere")
    assert slosh("run", PAPER, "-o", "here", "--no-figures").code == ExitCode.DONE
    assert not (tmp_path / "here" / "run.h5").is_symlink()


# --- folders nobody chose


def test_what_was_set_is_in_the_folders_name(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    slosh("run", PAPER, "--no-figures")
    slosh("run", PAPER, "--no-figures", "--set", "tank.liquid.model=rigid", "--set", "braking.torque=12 kN m")
    slosh("run", PAPER, "--no-figures", "--set", "braking.torque=12 kN m", "--set", "tank.liquid.model=rigid")
    slosh("run", PAPER, "--no-figures", "--set", "name=mine", "--set", "tank.bottom_height=1.2 m")
    assert names(tmp_path / "outputs") == {
        "paper-80-liquid", "paper-80-liquid-braking.torque=12-kN-m-tank.liquid.model=rigid", "mine",
    }  # fmt: skip


def test_many_settings_make_no_endless_name(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    many = [f"solver.{key}" for key in ("tolerance=1e-3", "time_limit=500 s")] + [f"description={'x' * 300}"]
    many += ["wagon.pivot_spacing=10.5 m", "track.domain.length=40 m", "contact.adhesion=wet", "braking.onset=0.75 s"]
    for fill in (0.4, 0.5):
        settings = [
            word for text in [*many, "tank.coefficients=computed", f"tank.fill={fill}"] for word in ("--set", text)
        ]
        assert slosh("run", PAPER, "--no-figures", *settings).code == ExitCode.DONE
    one, two = names(tmp_path / "outputs")
    assert max(len(one), len(two)) <= 100


def test_a_changed_scenario_never_replaces_an_earlier_run(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    text = PAPER.read_text()
    file = tmp_path / "wagon.yaml"
    changed = text.replace("initial_speed: 80 km/h", "initial_speed: 70 km/h")
    assert changed != text
    for content in (text, changed, text.replace("description:", "description: edited"), changed):
        file.write_text(content)
        outcome = slosh("run", file, "--no-figures")
        assert outcome.code == ExitCode.DONE
        assert ("these go to outputs/paper-80-liquid-2" in outcome.err) == (content == changed)
    assert names(tmp_path / "outputs") == {"paper-80-liquid", "paper-80-liquid-2"}
    for folder, speed in (("paper-80-liquid", 80.0), ("paper-80-liquid-2", 70.0)):
        assert pd.read_csv(tmp_path / "outputs" / folder / "summary.csv")["v0_km_h"][0] == speed


def test_the_history_holds_the_scenario_as_it_was_run(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    slosh("run", PAPER, "-o", "here", "--no-figures", "--set", "braking.torque=7 kN m")
    with h5py.File(tmp_path / "here" / "run.h5") as file:
        text = file["scenario"][()].decode()
    (tmp_path / "again.yaml").write_text(text)
    assert slosh("run", "again.yaml", "--no-figures").code == ExitCode.DONE
    assert solver.scenarios[1] == solver.scenarios[0]


def test_the_first_run_announces_the_compilation(slosh: Slosh, solver: Solver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules["slosh_cli.compiled"], "solver_is_cached", lambda *_: False)
    outcome = slosh("run", PAPER, "--no-figures", "--json")
    assert outcome.err.startswith("Compiling the solver, once")
    strict_json(outcome.out)


def test_where_nothing_can_be_kept_it_says_so_and_how_to_mend_it(
    slosh: Slosh, solver: Solver, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.modules["slosh_cli.compiled"], "solver_is_cached", lambda *_: False)
    monkeypatch.setattr(sys.modules["slosh_cli.compiled"], "not_kept", lambda: "cannot write into /nowhere")
    err = slosh("run", PAPER, "--no-figures", "--json").err
    assert "in memory, for this run only" in err
    assert "cannot write into /nowhere" in err
    assert "NUMBA_CACHE_DIR" in err
    assert "Later runs start at once" not in err
