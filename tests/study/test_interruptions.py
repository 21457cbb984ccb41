"""The real command, killed, interrupted, out of disk: no finished stop is lost, none runs twice."""

import json
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from study_tools import CHEAP, PAPER, begun, count, journal_rows, run_slosh, start_slosh

from slosh_cli.results.hdf5 import read_history

TABLE = "outputs/cheap/braking_distance.csv"
JOURNAL = "outputs/cheap/journal.sqlite"


def sweep(stops: int, *more: object) -> list[object]:
    """Arguments of a sweep of `stops` cheap stops, half of them with liquid."""
    return ["sweep", *CHEAP, "--torque", f"{2 + 0.1:g}:{2 + 0.1 * (stops // 2):g}:0.1", "--jobs", 2, *more]


def folder(parent: Path, name: str) -> Path:
    made = parent / name
    made.mkdir()
    (made / "outputs").mkdir()
    return made


def uninterrupted(parent: Path, stops: int) -> bytes:
    """The table of the sweep when nothing happens."""
    where = folder(parent, "uninterrupted")
    code, _, err = run_slosh(where, *sweep(stops))
    assert code in (0, 3), err
    assert len(begun(where)) == stops
    return (where / TABLE).read_bytes()


def kill_at_random_moments(where: Path, stops: int, kills: int, seed: int) -> None:
    """Start the sweep and kill it, again and again: every fourth time at any moment of its start, else amid the stops.

    What the journal held before a start is still there, to the letter, and is not begun again.
    """
    chance, sessions_with_progress = random.Random(seed), 0
    for number in range(kills):
        before = journal_rows(where / JOURNAL)
        (where / "begun.log").unlink(missing_ok=True)
        process = start_slosh(where, *sweep(stops))
        # by stops, not by seconds, so that some are left for the last session however fast they are
        enough = len(before) + chance.randint(0, stops // kills)
        until = time.monotonic() + (chance.uniform(0.0, 1.5) if number % 4 == 0 else 60.0)
        while count(where / JOURNAL) <= enough and time.monotonic() < until and process.poll() is None:
            time.sleep(0.002)
        time.sleep(chance.uniform(0.0, 0.01))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        after = journal_rows(where / JOURNAL)
        assert {key: after[key] for key in before} == before
        assert not set(begun(where)) & set(before)
        assert len(set(begun(where))) == len(begun(where))
        sessions_with_progress += len(after) > len(before)
    assert sessions_with_progress >= kills // 2
    (where / "begun.log").unlink(missing_ok=True)


@pytest.mark.parametrize(
    ("stops", "kills"), [(60, 3), pytest.param(200, 20, marks=pytest.mark.slow)], ids=["a few", "twenty"]
)
def test_a_sweep_killed_at_random_moments_ends_with_the_table_of_an_uninterrupted_one(
    tmp_path: Path, stops: int, kills: int
) -> None:
    expected = uninterrupted(tmp_path, stops)
    where = folder(tmp_path, "killed")
    kill_at_random_moments(where, stops, kills, seed=stops)
    kept = journal_rows(where / JOURNAL)
    code, out, err = run_slosh(where, *sweep(stops, "--json"))
    assert code in (0, 3), err
    answer = json.loads(out)
    assert (answer["runs"], answer["reused"], answer["done"] + answer["failed"]) == (stops, len(kept), stops)
    assert len(begun(where)) == stops - len(kept)
    assert not set(begun(where)) & set(kept)
    assert (where / TABLE).read_bytes() == expected


@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)])
def test_ctrl_c_keeps_what_is_finished_and_says_how_to_go_on(tmp_path: Path, number: signal.Signals) -> None:
    where = folder(tmp_path, "interrupted")
    process = start_slosh(where, *sweep(600))
    while len(begun(where)) < 10 and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(number)
    sent = time.monotonic()
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert time.monotonic() - sent < 10.0
    kept = journal_rows(where / JOURNAL)
    assert 8 <= len(kept) < 500
    assert f"{len(kept)} of 600 stops are finished" in err
    assert "the same command goes on from there" in err
    assert len((where / TABLE).read_text().splitlines()) == 1 + len(kept)
    assert not (where / JOURNAL).with_name("journal.lock").exists()
    assert len(begun(where)) - len(kept) <= 2  # at most the stops that were in hand are lost


def test_a_full_disk_is_a_clear_error_and_the_study_goes_on_when_there_is_room(tmp_path: Path) -> None:
    where = folder(tmp_path, "full")
    code, out, err = run_slosh(where, *sweep(60, "--json"), LARGEST_FILE=80_000)
    assert code == 2
    error = json.loads(out)["error"]
    assert error["code"] == "file"
    assert "journal.sqlite" in error["where"]
    assert "every stop committed before is kept" in err
    assert "Traceback" not in err
    kept = journal_rows(where / JOURNAL)
    assert 0 < len(kept) < 60
    code, out, err = run_slosh(where, *sweep(60, "--json"))
    assert json.loads(out)["reused"] == len(kept)
    assert len(journal_rows(where / JOURNAL)) == 60


def test_five_of_fifty_stops_fail_and_the_others_are_finished(tmp_path: Path) -> None:
    arguments = ["sweep", *CHEAP, "--liquid", "rigid", "--torque", "1:50:1", "--set", "solver.time_limit=7 s"]
    code, out, err = run_slosh(tmp_path, *arguments, "--json")
    assert code == 3
    answer = json.loads(out)
    assert (answer["runs"], answer["done"], answer["failed"]) == (50, 45, 5)
    assert "5 of 50 stops ended without an answer" in err
    assert "5 x time-limit: still rolling at" in err
    assert "at 1 kN m; 2 kN m; 3 kN m; 4 kN m and 1 more" in err
    rows = (tmp_path / TABLE).read_text().splitlines()[1:]
    assert [row.split(",")[5] for row in rows] == ["time-limit"] * 5 + ["stopped"] * 45


def test_two_processes_on_one_study_the_second_is_told(tmp_path: Path) -> None:
    first = start_slosh(tmp_path, *sweep(600))
    while not begun(tmp_path) and first.poll() is None:
        time.sleep(0.005)
    code, out, err = run_slosh(tmp_path, *sweep(60, "--json"), STOP_LOG=tmp_path / "second.log")
    first.send_signal(signal.SIGINT)
    first.communicate(timeout=60)
    assert code == 2
    assert f"process {first.pid} on " in json.loads(out)["error"]["message"]
    assert "already working on the study" in err
    assert not (tmp_path / "second.log").read_text()


@pytest.mark.parametrize("largest", [0, 100_000])
def test_a_full_disk_does_not_take_the_answer_of_a_run(tmp_path: Path, largest: int) -> None:
    """HDF5 itself would end in a segmentation fault here."""
    words = ["--set", "braking.initial_speed=30 km/h", "--set", "solver.tolerance=1e-2", "--set", "name=cheap"]
    code, out, err = run_slosh(tmp_path, "run", PAPER, *words, "--json", "-o", "here", LARGEST_FILE=largest)
    assert code == 2, err
    assert "Traceback" not in err
    answer = json.loads(out)
    assert answer["status"] == "stopped"
    assert answer["braking_distance_m"] > 0.0
    assert "history" not in answer["files"]
    assert ("summary" in answer["files"]) == (largest > 0)
    assert "run.h5 could not be written" in err
    assert sorted(file.name for file in (tmp_path / "here").iterdir()) == sorted(
        Path(file).name for file in [*answer["files"]["figures"], *([answer["files"]["summary"]] if largest else [])]
    )


def test_a_full_disk_does_not_take_the_rows_of_a_sweep_with_histories(tmp_path: Path) -> None:
    code, out, err = run_slosh(tmp_path, *sweep(4, "--histories", "--json"), LARGEST_FILE=100_000)
    assert code == 2, err
    assert "Traceback" not in err
    answer = json.loads(out)
    assert (answer["runs"], answer["done"]) == (4, 4)
    assert any("histories: cannot write" in warning for warning in answer["warnings"])
    table = pd.read_csv(tmp_path / answer["table"])
    assert len(table) == 4
    assert table["history"].isna().any()
    for file in table["history"].dropna():
        read_history(tmp_path / "outputs/cheap" / file)
    code, out, err = run_slosh(tmp_path, *sweep(4, "--histories", "--json"))
    assert code == 0, err
    assert not pd.read_csv(tmp_path / answer["table"])["history"].isna().any()


STREAMS = {
    "closed": (">&- 2>&-", 0),
    "out closed": (">&-", 0),
    "err closed": ("2>&-", 0),
    "err full": ("2>/dev/full", 0),
    "out full": (">/dev/full", 2),
}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="streams of Linux")
@pytest.mark.parametrize(("streams", "expected"), STREAMS.values(), ids=STREAMS)
def test_streams_that_take_nothing_do_not_end_a_study(tmp_path: Path, streams: str, expected: int) -> None:
    arguments = " ".join(f"'{word}'" for word in sweep(4, "--histories"))
    start = f"'{sys.executable}' -c 'import sys; from slosh_cli.cli import main; sys.exit(main())'"
    run = subprocess.run(
        ["bash", "-c", f"{start} {arguments} {streams}"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == expected, run.stderr
    assert "Traceback" not in run.stderr
    assert "Exception ignored" not in run.stderr
    assert ("cannot write to standard output" in run.stderr) == (expected == 2)
    assert len(pd.read_csv(tmp_path / TABLE)) == 4
    assert len(journal_rows(tmp_path / JOURNAL)) == 4
    for file in (tmp_path / "outputs/cheap/histories").iterdir():
        assert read_history(file).status == "stopped"  # nothing that was printed ended in a file
