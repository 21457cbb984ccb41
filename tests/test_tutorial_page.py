"""docs/tutorial.md, walked from its first command to its last in one folder: what it shows is what is printed."""

import re
import shlex
from pathlib import Path

import pytest
import yaml

from slosh_cli.cli import main

PAGE = (Path(__file__).parents[1] / "docs" / "tutorial.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def typed(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.startswith("slosh ")]


def put_in(file: Path, part: str) -> None:
    """The part of the scenario that a block of the page shows, in place of the file's own."""
    (name,) = yaml.safe_load(part)
    text, count = re.subn(rf"^{name}:\n(?:  .*\n)+", lambda _: part, file.read_text(encoding="utf-8"), flags=re.M)
    assert count == 1
    file.write_text(text, encoding="utf-8")


def is_told(line: str, printed: str) -> bool:
    """Whether a line that was printed begins so, but for a unit of the last digit or 2e-4 of its numbers."""
    numeral = r"(\\d+(?:\\.\\d+)?)"
    pattern = r"\s*" + r"\s+".join(NUMBER.sub(numeral, re.escape(word).replace(r"\.", ".")) for word in line.split())
    told = NUMBER.findall(line)
    found = [match for match in (re.match(pattern, one) for one in printed.splitlines()) if match]
    return any(all(map(_same, told, match.groups())) for match in found)


def _same(told: str, printed: str) -> bool:
    last_digit = 10.0 ** -len(told.partition(".")[2])
    return abs(float(told) - float(printed)) <= max(1.01 * last_digit, 2e-4 * float(told))


def test_the_walk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setattr("slosh_cli.report.figures.RESOLUTION", 20)
    printed = ""
    for kind, text in BLOCKS:
        if kind == "yaml" and text.startswith("format: 1\nname: ten\n"):
            (tmp_path / "ten.yaml").write_text(text, encoding="utf-8")
        elif kind == "yaml":
            put_in(tmp_path / "my_wagon.yaml", text)
        if kind == "sh":
            printed = ""
            for command in typed(text):
                assert main(shlex.split(command)[1:]) == 0, command
                out = capsys.readouterr()
                printed += out.out + out.err
        if kind == "text":
            missing = [line for line in text.splitlines() if not is_told(line, printed)]
            assert not missing, printed
    for page in ("my_wagon/report.html", "over-the-fill/report.html"):
        assert (tmp_path / "outputs" / page).stat().st_size > 10_000


def test_nothing_but_slosh_is_typed() -> None:
    assert {kind for kind, _ in BLOCKS} == {"sh", "yaml", "text"}
    assert all(line.startswith("slosh ") for kind, text in BLOCKS if kind == "sh" for line in text.splitlines())


def test_another_number_is_not_told() -> None:
    assert is_told("gross  mass 66.85 t", "  gross mass   66.86 t")
    assert not is_told("gross mass 66.85 t", "  gross mass   66.95 t")
    assert not is_told("gross mass 66.85 t", "  gross weight 66.85 t")
