"""The journal keeps what was committed, whatever happens to the process."""

import multiprocessing
import os
import resource
import signal
import sqlite3
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from slosh_cli.errors import UsageError
from slosh_cli.results.files import FileError
from slosh_cli.study import lock
from slosh_cli.study.journal import JOURNAL, Journal
from slosh_cli.study.lock import LOCK, FolderInUse, locked
from slosh_cli.study.outcome import FinishedStop


def outcome(key: str, *, final: bool = True, **answer: Any) -> FinishedStop:
    return FinishedStop(0, key, {"status": "stopped", "braking_distance_m": 0.1 + 0.2, **answer}, final, 0.25)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "journal.sqlite"


def test_what_was_added_is_there_when_the_journal_is_opened_again(path: Path) -> None:
    with Journal(path) as journal:
        journal.begin_session("abc")
        journal.add([outcome("a"), outcome("b", status="pitch-limit", reason="too fast", distance=float("nan"))])
    with Journal(path) as journal:
        assert len(journal) == 2
        assert "a" in journal
        assert "c" not in journal
        assert journal.answer("a") == {"status": "stopped", "braking_distance_m": 0.1 + 0.2}
        assert journal.answer("c") is None
        assert journal.mean_seconds() == 0.25


def test_a_journal_of_an_earlier_version_is_read_with_the_names_of_today(path: Path) -> None:
    with Journal(path) as journal:
        journal.add([outcome("a", status="overturned", reason="a pitch angle passed 0.1 rad")])
        assert journal.answer("a") == {
            "status": "pitch-limit", "reason": "a pitch angle passed 0.1 rad", "braking_distance_m": 0.1 + 0.2,
        }  # fmt: skip


def test_the_journal_flushes_every_commit_to_the_disk(path: Path) -> None:
    with Journal(path) as journal:
        (mode,) = journal._file.execute("PRAGMA journal_mode").fetchone()
        (flush,) = journal._file.execute("PRAGMA synchronous").fetchone()
    assert (mode, flush) == ("wal", 2)


def test_a_passing_failure_is_kept_but_not_final(path: Path) -> None:
    with Journal(path) as journal:
        journal.add([outcome("a", final=False, status="failed")])
        assert "a" not in journal
        assert journal.answer("a") == {"status": "failed", "braking_distance_m": 0.1 + 0.2}
        journal.add([outcome("a")])
        assert "a" in journal
        assert len(journal) == 1


def test_stops_of_another_build_of_the_solver_are_counted(path: Path) -> None:
    with Journal(path) as journal:
        journal.begin_session("old")
        journal.add([outcome("a"), outcome("b")])
        journal.begin_session("new")
        journal.add([outcome("c")])
        assert journal.other_sources("new") == 2
        assert journal.other_sources("old") == 1


def test_a_session_says_what_computed(path: Path) -> None:
    with Journal(path) as journal:
        journal.begin_session("abc")
    with sqlite3.connect(path) as file:
        program, sources, circumstances = file.execute("SELECT program, sources, circumstances FROM session").fetchone()
    assert program.startswith("slosh ")
    assert sources == "abc"
    assert '"numba"' in circumstances


def test_a_batch_is_committed_whole_or_not_at_all(path: Path) -> None:
    with Journal(path) as journal:
        journal.add([outcome("a")])
        with pytest.raises(TypeError):
            journal.add([outcome("b"), outcome("c", what=object())])
        assert len(journal) == 1


@pytest.mark.parametrize("text", ["this is no journal, " * 100, "SQLite format 3\0" + "x" * 5000])
def test_a_damaged_journal_is_refused_with_a_way_out(path: Path, text: str) -> None:
    path.write_text(text)
    with pytest.raises(FileError, match=r"damaged or no journal of slosh .*--fresh"):
        Journal(path)
    Journal.remove(path)
    with Journal(path) as journal:
        assert len(journal) == 0


def test_the_journal_of_another_version_is_refused(path: Path) -> None:
    with sqlite3.connect(path) as file:
        file.execute("PRAGMA user_version = 7")
    with pytest.raises(FileError, match=r"another version of slosh \(format 7\)"):
        Journal(path)


def test_a_folder_without_permission_is_a_clear_error(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot read"):
        Journal(tmp_path / "nowhere" / "journal.sqlite")


def test_removing_a_journal_leaves_nothing_of_it(path: Path) -> None:
    journal = Journal(path)
    journal.add([outcome("a")])
    assert len(list(path.parent.iterdir())) == 3
    journal._file.close()
    path.with_name("journal.sqlite-wal").write_text("the log of a killed process")
    path.with_name("journal.sqlite-shm").write_text("and its index")
    Journal.remove(path)
    Journal.remove(path)
    assert list(path.parent.iterdir()) == []


def test_a_journal_can_be_read_while_another_process_writes_it(path: Path) -> None:
    with Journal(path) as journal:
        journal.add([outcome("a")])
        with Journal(path, read_only=True) as reader:
            assert len(reader) == 1
            journal.add([outcome("b")])
            assert len(reader) == 2


FILLING = """
import resource, sys
from pathlib import Path
from slosh_cli.study.journal import Journal
from slosh_cli.study.outcome import FinishedStop
resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, 400_000))
with Journal(Path(sys.argv[1])) as journal:
    for k in range(1000):
        journal.add([FinishedStop(k, f"key {k}", {"status": "stopped", "k": k, "text": "x" * 1000}, True, 0.1)])
        print(k, flush=True)
"""


def test_a_full_disk_is_a_clear_error_and_the_journal_stays_sound(path: Path) -> None:
    run = subprocess.run([sys.executable, "-c", FILLING, str(path)], capture_output=True, text=True, check=False)
    assert run.returncode == 1
    assert "FileError: cannot write" in run.stderr
    assert "every stop committed before is kept" in run.stderr
    committed = [int(line) for line in run.stdout.split()]
    assert len(committed) > 5
    with Journal(path) as journal:
        (verdict,) = journal._file.execute("PRAGMA integrity_check").fetchone()
        assert verdict == "ok"
        assert len(journal) == len(committed)
        for k in committed:
            answer = journal.answer(f"key {k}")
            assert answer is not None
            assert answer["k"] == k
    assert resource.getrlimit(resource.RLIMIT_FSIZE)[0] != 400_000


def _hold(folder: str, ready: Any, go: Any) -> None:
    with locked(Path(folder)):
        ready.set()
        go.wait(30)


def test_a_second_process_is_told_who_works_in_the_folder(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    ready, go = context.Event(), context.Event()
    other = context.Process(target=_hold, args=(str(tmp_path), ready, go))
    other.start()
    try:
        assert ready.wait(30)
        with (
            pytest.raises(UsageError, match=f"process {other.pid} on .* is already working on the study"),
            locked(tmp_path),
        ):
            pass
    finally:
        go.set()
        other.join(30)
    with locked(tmp_path):
        assert str(os.getpid()) in (tmp_path / LOCK).read_text()


def test_a_killed_process_leaves_no_lock_behind(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    ready, go = context.Event(), context.Event()
    other = context.Process(target=_hold, args=(str(tmp_path), ready, go))
    other.start()
    assert ready.wait(30)
    assert other.pid is not None
    os.kill(other.pid, signal.SIGKILL)
    other.join(30)
    assert (tmp_path / LOCK).exists()
    with locked(tmp_path):
        pass


def test_a_folder_that_cannot_be_made_is_a_clear_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot write"), locked(tmp_path / "file" / "study"):
        pass


def test_the_locks_file_goes_with_its_holder(tmp_path: Path) -> None:
    with locked(tmp_path):
        assert (tmp_path / LOCK).exists()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(KeyboardInterrupt), locked(tmp_path):
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_a_lock_whose_file_vanished_while_it_was_taken_is_nobodys(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its holder left between the opening and the locking: two processes must not each hold a file of that name."""
    take, turns = lock._take, []

    def taken_when_the_holder_leaves(file: Any) -> None:
        turns.append(file)
        if len(turns) == 1:
            (tmp_path / LOCK).unlink()
        take(file)

    monkeypatch.setattr(lock, "_take", taken_when_the_holder_leaves)
    with locked(tmp_path):
        assert len(turns) == 2
        assert (tmp_path / LOCK).exists()
        with pytest.raises(FolderInUse), locked(tmp_path):
            pass


def test_a_study_is_noted_and_read_back(tmp_path: Path) -> None:
    with Journal(tmp_path / JOURNAL) as journal:
        assert journal.study() is None
        for values in (["5"], ["5", "10"]):
            journal.note_study({"base": "x", "axes": {"braking.torque": values}})
    with Journal(tmp_path / JOURNAL, read_only=True) as journal:
        assert journal.study() == {"base": "x", "axes": {"braking.torque": ["5", "10"]}}
