"""Citations of the theory manual resolve, and the constants that it tells are those of the program."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
MANUAL = (ROOT / "docs/theory.md").read_text(encoding="utf-8")
SECTIONS = re.findall(r"^#{2,3} (\d+(?:\.\d+)?)\.? ", MANUAL, re.MULTILINE)
CITED = re.compile(r"\btheory\s+sections?\s+(\d+(?:\.\d+)?(?:(?:, | and | to |, and )\d+(?:\.\d+)?)*)", re.IGNORECASE)
ELSEWHERE = re.compile(
    r"\b(?:model|interface)\.md\b|\bmodel\s+sections?\s+\d|\bsections? \d+ of the model\b"
    r"|\bof[ _]the[ _]contract|\binterface: ",
    re.IGNORECASE,
)
"""How texts are cited that do not come with the program."""


def texts() -> Iterator[tuple[str, str]]:
    """Every file that may cite the manual, but for this one, and its text."""
    for folder in ("slosh_cli", "tests", "scenarios", "docs"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".py", ".toml", ".csv", ".yaml", ".md") and path != Path(__file__):
                yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


def without_margins(text: str) -> str:
    """The text with comments that go on in the next line, and docstrings, as one line each."""
    return re.sub(r"\n[ \t]*(?:#[ \t]*)?", " ", text)


TEXTS = {name: without_margins(text) for name, text in texts()}
CITATIONS = [(name, match[1]) for name, text in TEXTS.items() for match in CITED.finditer(text)]


def test_the_sections_are_numbered_in_their_order() -> None:
    main = [int(number) for number in SECTIONS if "." not in number]
    assert main == list(range(1, len(main) + 1))
    for number in main:
        parts = [int(section.split(".")[1]) for section in SECTIONS if section.startswith(f"{number}.")]
        assert parts == list(range(1, len(parts) + 1)), number
    assert len(set(SECTIONS)) == len(SECTIONS)


def test_every_citation_has_its_section() -> None:
    unknown = [
        (name, number)
        for name, numbers in CITATIONS
        for number in re.findall(r"\d+(?:\.\d+)?", numbers)
        if number not in SECTIONS
    ]
    assert not unknown


def test_the_program_cites_the_manual_and_nothing_else_for_its_physics() -> None:
    others = [(name, match[0]) for name, text in TEXTS.items() for match in ELSEWHERE.finditer(text)]
    assert not others
    assert {name.partition("/")[0] for name, _ in CITATIONS} >= {"slosh_cli", "tests"}


def assigned() -> Iterator[tuple[str, float]]:
    """Every number that a module of the package gives a name in capitals, with or without a leading underscore."""
    line = re.compile(r"^_?([A-Z][A-Z_, ]*)(?:: [^=]+)? = ([\d.e-]+(?:, [\d.e-]+)*)$", re.MULTILINE)
    for path in (ROOT / "slosh_cli").rglob("*.py"):
        for names, values in line.findall(path.read_text(encoding="utf-8")):
            if names.count(",") == values.count(","):
                yield from zip(names.split(", "), map(float, values.split(", ")), strict=True)


@pytest.mark.parametrize(("name", "value"), re.findall(r"`([A-Z][A-Z_]+) = ([^`]+)`", MANUAL))
def test_a_constant_that_the_manual_tells_is_the_program_s(name: str, value: str) -> None:
    assert [found for one, found in assigned() if one == name] == [float(value)]
