"""Paths that lead nowhere, to no file, or have names that no system takes."""

import os
import shutil
import socket
from pathlib import Path

import pytest
from answer import answer
from good_files import Good

COMMANDS = ("check", "run", "sweep", "plot", "report", "animate", "compare", "find", "optimum")
PATHS = ("x" * 300, "d/" * 300 + "x.yaml", "x" * 5000, "", "a\0b", "\udc80x", "\x1b[31mred.yaml", "~", "-")


VARIED = ["--vary", "tank.fill=0.3:0.5"]
MORE = {"compare": ["run.h5"], "find": [*VARIED, "--until", "first_lock"], "optimum": VARIED}


def words(command: str, path: str | Path) -> list[str | Path]:
    """The command, given the path and what else it needs."""
    return [command, "--", path, *MORE["compare"]] if command == "compare" else [command, *MORE.get(command, []), path]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_path_that_cannot_be_is_refused(command: str) -> None:
    for path in PATHS:
        answer(*words(command, path), code=2)


@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_no_file_is_refused_at_once(command: str, folder: Path) -> None:
    os.mkfifo("pipe")
    (folder / "folder").mkdir()
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind("socket")
        for path in ("pipe", "socket", "folder", "/dev/zero", "/dev/null", "/dev/full"):
            told = answer(*words(command, path), code=2).err
            assert path in told


def test_a_pipe_is_told_from_an_empty_file() -> None:
    os.mkfifo("pipe")
    assert "given a pipe; save the scenario to a file" in answer("check", "pipe").err
    assert "pipe is a pipe; give a history file" in answer("plot", "pipe").err


@pytest.mark.parametrize("command", ["check", "run", "sweep", "report", "init", "animate"])
def test_a_working_folder_that_is_gone_is_told_of(command: str, folder: Path, good: Good) -> None:
    gone = folder / "gone"
    gone.mkdir()
    os.chdir(gone)
    gone.rmdir()
    files = {"report": [good.run, "-o", "x.html"], "animate": [good.run, "-o", "x.gif"], "init": []}
    answer(command, *files.get(command, ["a.yaml"]), code=2)
    os.chdir(folder)


@pytest.mark.parametrize("name", ["n" * 300, "n/" * 3000])
def test_an_output_that_no_system_takes_is_refused(name: str, good: Good) -> None:
    shutil.copy(good.run, "again.h5")
    for words in (["plot", good.run], ["report", good.run], ["animate", good.run], ["compare", good.run, "again.h5"]):
        answer(*words, "-o", name, code=2)
    answer("init", "-o", name, code=2)


def test_the_base_and_the_wagons_of_a_file_may_be_named_badly(folder: Path, good: Good) -> None:
    for name in ("x" * 300, r"a\0b", r"\ud83d", "../" * 100, "/dev/zero", ".", "", r"\e[31m"):
        (folder / "study.yaml").write_text(f'base: "{name}"\nvary: {{tank.fill: [0.3, 0.5]}}\n', encoding="utf-8")
        answer("sweep", "study.yaml", "--dry-run", code=2)
        (folder / "train.yaml").write_text(good.train.replace("paper_80.yaml", f'"{name}"'), encoding="utf-8")
        answer("check", "train.yaml")


def test_an_answer_does_not_steer_the_terminal(folder: Path, good: Good) -> None:
    path = folder / "\x1b]0;title\x07.yaml"
    path.write_text(good.scenario, encoding="utf-8")
    found = answer("check", path, code=0)
    assert r"\x1b]0;title\x07.yaml" in found.out


LONG = (
    ["check", "a.yaml", "--set", "x" * 100_000],
    ["sweep", "--vary", "k=" + "1:" * 50_000],
    ["sweep", "--v0", "9" * 100_000],
    ["--" + "x" * 100_000],
    ["x" * 100_000],
)


@pytest.mark.parametrize("words", LONG)
def test_a_long_word_is_repeated_in_part(words: list[str], folder: Path, good: Good) -> None:
    (folder / "a.yaml").write_text(good.scenario, encoding="utf-8")
    found = answer(*words, code=2)
    assert len(found.err) < 5_000
