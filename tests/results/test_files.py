"""A file appears whole or not at all, alone and in company."""

import os
import stat
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from slosh_cli.results.files import FileError, finish_moves, replacing, staging, try_targets


class HalfwayError(Exception):
    """What goes wrong halfway."""


class KilledError(BaseException):
    """Stands for the end of the process."""


def test_the_new_file_takes_the_place_of_the_old(tmp_path: Path) -> None:
    path = tmp_path / "a" / "b" / "table.csv"
    for text in ("old", "new"):
        with replacing(path) as temporary:
            temporary.write_text(text)
            assert temporary.parent == path.parent
    assert path.read_text() == "new"
    assert [file.name for file in path.parent.iterdir()] == ["table.csv"]


def test_nothing_is_seen_before_the_end(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("old")
    with replacing(path) as temporary:
        temporary.write_text("new")
        assert path.read_text() == "old"


def test_a_failure_halfway_keeps_the_old_file_and_leaves_nothing_behind(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("old")

    def write() -> None:
        with replacing(path) as temporary:
            temporary.write_text("half of the n")
            raise HalfwayError

    with pytest.raises(HalfwayError):
        write()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_data_reach_the_disk_before_the_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, events = tmp_path / "table.csv", []
    monkeypatch.setattr(os, "fsync", lambda _: events.append(path.exists()))
    with replacing(path) as temporary:
        temporary.write_text("new")
    assert events[0] is False
    with staging(tmp_path / "run") as stage:
        (stage / "a").write_text("1")
        events.clear()
    assert len(events) == 4  # the file, the list of names, the stage and the folder


@pytest.mark.skipif(os.name == "nt", reason="permission bits")
def test_others_may_read_the_file_as_they_may_any_other(tmp_path: Path) -> None:
    plain = tmp_path / "plain"
    plain.write_text("")
    with replacing(tmp_path / "ours") as temporary:
        temporary.write_text("")
    assert stat.S_IMODE((tmp_path / "ours").stat().st_mode) == stat.S_IMODE(plain.stat().st_mode)


def test_a_refusal_of_the_system_is_the_users_matter(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    path = tmp_path / "file" / "table.csv"
    with pytest.raises(FileError, match="cannot write") as refusal, replacing(path):
        pass
    assert refusal.value.where == str(path)


def test_staged_files_come_together(tmp_path: Path) -> None:
    with staging(tmp_path / "run") as stage:
        (stage / "a").write_text("1")
        (stage / "b").write_text("2")
        assert not (tmp_path / "run" / "a").exists()
    assert {file.name: file.read_text() for file in (tmp_path / "run").iterdir()} == {"a": "1", "b": "2"}


def test_files_of_an_earlier_run_go_when_this_one_has_none_of_them(tmp_path: Path) -> None:
    for name in ("slosh.png", "notes.txt"):
        (tmp_path / name).write_text("old")
    with staging(tmp_path, owned=["slosh.png", "run.h5"]) as stage:
        (stage / "run.h5").write_text("new")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["notes.txt", "run.h5"]


def test_a_failure_while_staging_keeps_the_whole_earlier_run(tmp_path: Path) -> None:
    for name in ("run.h5", "slosh.png"):
        (tmp_path / name).write_text("old")

    def write() -> None:
        with staging(tmp_path, owned=["slosh.png"]) as stage:
            (stage / "run.h5").write_text("new")
            raise HalfwayError

    with pytest.raises(HalfwayError):
        write()
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {
        "run.h5": "old",
        "slosh.png": "old",
    }


def test_staging_into_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("")
    with pytest.raises(FileError, match="cannot write"), staging(tmp_path / "run"):
        pass


def test_a_folder_in_place_of_a_file_stops_the_stage_before_anything_moves(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    (tmp_path / "a").write_text("old")

    def write() -> None:
        with staging(tmp_path, owned=["a", "c"]) as stage:
            for name in ("a", "b"):
                (stage / name).write_text("new")

    with pytest.raises(FileError, match="there is a folder of that name"):
        write()
    assert (tmp_path / "a").read_text() == "old"
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a", "b"]


def test_trying_targets_leaves_nothing_but_takes_away_what_killed_processes_left(tmp_path: Path) -> None:
    abandoned, fresh = tmp_path / ".run.h5.0123abcd.part", tmp_path / ".summary.csv.0123abcd.part"
    stage, own = tmp_path / ".0123abcd.part", tmp_path / "notes.part"
    stage.mkdir()
    for file in (abandoned, fresh, own, stage / "run.h5"):
        file.write_text("half")
    for file in (abandoned, own, stage):
        os.utime(file, (1e9, 1e9))
    try_targets(tmp_path, ["run.h5"])
    assert sorted(file.name for file in tmp_path.iterdir()) == [fresh.name, own.name]
    try_targets(tmp_path / "new" / "deep", ["run.h5"])
    assert not (tmp_path / "new").exists()


def test_targets_below_a_file_are_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="is not a folder"):
        try_targets(tmp_path / "file" / "run", ["run.h5"])


@pytest.mark.parametrize("moved", range(5))
def test_a_process_that_ends_while_files_move_leaves_the_new_ones_to_whoever_looks_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moved: int
) -> None:
    old, new = {"run.h5": "old", "slosh.png": "old", "notes.txt": "mine"}, {"run.h5": "new", "summary.csv": "new"}
    for name, text in old.items():
        (tmp_path / name).write_text(text)
    unlink, replace, steps = Path.unlink, Path.replace, iter(range(10))

    def counted(change: Callable[..., Any]) -> Callable[..., Any]:
        def step(path: Path, *more: Any, **given: Any) -> Any:
            if (path.parent == tmp_path or path.parent.suffix == ".whole") and next(steps) == moved:
                raise KilledError
            return change(path, *more, **given)

        return step

    def killed() -> None:
        with monkeypatch.context() as patch:
            patch.setattr(Path, "unlink", counted(unlink))
            patch.setattr(Path, "replace", counted(replace))
            patch.setattr("shutil.rmtree", lambda *_, **__: None)
            with staging(tmp_path, owned=["run.h5", "slosh.png", "summary.csv"]) as stage:
                for name, text in new.items():
                    (stage / name).write_text(text)

    with pytest.raises(KilledError):
        killed()
    finish_moves(tmp_path)
    finish_moves(tmp_path)
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {"notes.txt": "mine"} | new
