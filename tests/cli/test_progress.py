"""The progress bar: on stderr, for people, and only when there is something to wait for."""

import pytest

from slosh_cli.cli import progress
from slosh_cli.cli.progress import RunProgress


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(progress.sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    return now


def test_a_short_run_shows_none(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    with RunProgress("stop") as bar:
        clock[0] = 1.9
        bar(0.5, 10.0)
    assert capsys.readouterr() == ("", "")


def test_a_long_run_shows_how_far_it_is(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    with RunProgress("stop") as bar:
        clock[0] = 2.1
        monkey = progress.sys.stderr
        monkey.isatty = lambda: True  # type: ignore[method-assign]
        bar(0.25, 10.0)
    out, err = capsys.readouterr()
    assert out == ""
    assert "25%" in err
    assert "36.0 km/h" in err


def test_a_file_for_stderr_gets_none(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    progress.sys.stderr.isatty = lambda: False  # type: ignore[method-assign]
    with RunProgress("stop") as bar:
        clock[0] = 5.0
        bar(0.25, 10.0)
    assert capsys.readouterr() == ("", "")
