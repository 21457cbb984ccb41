"""docs/gallery.md: its commands are commands of this program, and its pictures are there."""

import re
import shlex
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import typer
from PIL import Image

from slosh_cli.cli.app import tree

DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "gallery.md").read_text(encoding="utf-8")
COMMANDS = [
    line for text in re.findall(r"^```sh\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL) for line in text.splitlines()
]
PICTURES = re.findall(r"^!\[[^]]+\]\((images/gallery/[^)]+)\)$", PAGE, re.MULTILINE)
APP: Any = typer.main.get_command(tree())


def test_the_page_shows_every_command_that_draws() -> None:
    drawing = {"run", "sweep", "find", "optimum", "compare", "check", "tank", "validate", "animate", "report", "init"}
    assert {shlex.split(command)[1] for command in COMMANDS} == drawing


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_is_one(command: str) -> None:
    """The command's own parser takes all its words; nothing runs."""
    program, *words = shlex.split(command)
    assert program == "slosh"
    found = APP
    while hasattr(found, "commands"):
        found = found.commands[words.pop(0)]
    with found.make_context(found.name, words) as context:
        assert not context.args


def test_the_page_is_what_its_script_writes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(DOCS))
    assert import_module("gallery").page() == PAGE, "make pages"


def test_pictures_are_there_and_small() -> None:
    files = sorted((DOCS / "images" / "gallery").iterdir())
    assert sorted(DOCS / picture for picture in PICTURES) == files
    assert sum(file.stat().st_size for file in files) < 2e6
    replays = [file for file in files if file.suffix == ".gif"]
    assert replays
    for file in replays:
        with Image.open(file) as replay:
            assert getattr(replay, "n_frames", 1) > 30


def test_each_picture_has_a_sentence() -> None:
    for picture in PICTURES:
        before = PAGE.split(f"]({picture})")[0].splitlines()
        said, alternative = before[-3], before[-1].removeprefix("![")
        assert said == alternative
        assert said.endswith(".")
