"""Every block of docs/python.md runs, in its order, in an empty folder, and prints what it says it prints."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import slosh_cli

PAGE = (Path(__file__).parents[1] / "docs" / "python.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, "subprocess.CompletedProcess[str]"]:
    folder = tmp_path_factory.mktemp("page")
    words = [sys.executable, "-c", "\n".join(BLOCKS)]
    return folder, subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, timeout=600)


def test_every_block_runs_and_only_its_own_words_are_printed(
    outcome: tuple[Path, "subprocess.CompletedProcess[str]"],
) -> None:
    process = outcome[1]
    assert process.returncode == 0, process.stderr
    assert process.stderr == ""
    lines = process.stdout.splitlines()
    assert re.fullmatch(r"stopped \d+\.\d+ m", lines[0])
    assert "0 stops without an answer" in lines
    assert "['contact_forces', 'slosh', 'speed_distance', 'wheel_speed']" in lines
    assert re.fullmatch(r"rectangular-tank passed \d+ rows", lines[-1])


def test_the_files_are_those_that_the_page_names(outcome: tuple[Path, "subprocess.CompletedProcess[str]"]) -> None:
    folder, _ = outcome
    assert {file.name for file in folder.iterdir()} == {"torques", "figures", "study.pdf", "two.yaml"}
    assert {file.name for file in (folder / "torques").iterdir()} == {
        "braking_distance.csv", "braking_distance.png", "braking_distance.svg", "journal.sqlite",
    }  # fmt: skip
    assert len(list((folder / "figures").iterdir())) == 8


def test_the_page_shows_everything_that_the_package_offers() -> None:
    shown = set(re.findall(r"\b[a-z_]+\b", "\n".join(BLOCKS)))
    offered = {name for name in slosh_cli.__all__ if name.islower() and not name.startswith("_")}
    assert offered <= shown
