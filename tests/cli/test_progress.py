"""The progress bar: on stderr, for people, and only when there is something to wait for."""

from dataclasses import dataclass

import pytest

from slosh_cli.cli import progress
from slosh_cli.cli.progress import RunProgress, StopsProgress


@dataclass
class World:
    """The clock, and what stderr leads to."""

    now: float = 0.0
    terminal: bool = True


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> World:
    state = World()
    monkeypatch.setattr(progress.time, "monotonic", lambda: state.now)
    monkeypatch.setattr(progress, "_somebody_watches", lambda: state.terminal)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    return state


def test_a_short_run_shows_none(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    with RunProgress("stop") as bar:
        world.now = 1.9
        bar(0.5, 10.0)
    assert capsys.readouterr() == ("", "")


def test_a_long_run_shows_how_far_it_is(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    with RunProgress("stop") as bar:
        world.now = 2.1
        bar(0.25, 10.0)
    out, err = capsys.readouterr()
    assert out == ""
    assert "25%" in err
    assert "36.0 km/h" in err


def test_a_file_for_stderr_is_nobody_watching(capsys: pytest.CaptureFixture[str]) -> None:
    assert progress._somebody_watches() is False


def test_without_anybody_watching_there_is_none(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    world.terminal = False
    with RunProgress("stop") as bar:
        world.now = 5.0
        bar(0.25, 10.0)
    assert capsys.readouterr() == ("", "")


def test_a_study_that_comes_no_further_says_since_when(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    world.terminal = False
    with StopsProgress() as bar:
        for world.now, done in ((0.0, 0), (70.0, 5), (100.0, 5), (140.0, 5), (150.0, 5), (210.0, 6)):
            bar(done, 10)
    lines = capsys.readouterr().err.splitlines()
    assert [line.partition(" stops, ")[2].partition(" ")[0] for line in lines] == ["0.1", "none", "0.0"]
    assert lines[1] == "5 of 10 stops, none for 70 s: a worker may hang. Ctrl-C keeps what is finished"


def test_without_anybody_watching_a_line_a_minute_says_how_far_and_once_why(
    world: World, capsys: pytest.CaptureFixture[str]
) -> None:
    world.terminal = False
    with RunProgress("stop", "it has its reason") as bar:
        for world.now in (5.0, 59.0, 61.0, 100.0, 122.0):
            bar(0.25, 10.0)
    lines = capsys.readouterr().err.replace("\n  ", " ").splitlines()
    assert lines == ["stop: 25% after 61 s, 36.0 km/h; it has its reason", "stop: 25% after 2 min, 36.0 km/h"]


def test_beside_a_bar_the_reason_alone_is_told(world: World, capsys: pytest.CaptureFixture[str]) -> None:
    with RunProgress("stop", "it has its reason") as bar:
        for world.now in (3.0, 61.0, 122.0):
            bar(0.25, 10.0)
    assert capsys.readouterr().err.count("stop: it has its reason") == 1
