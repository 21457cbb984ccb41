"""Every number in README and docs: listed in `data/documented_numbers.toml`, and what its command gives today."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import re
import shlex
import tomllib
from functools import cache
from pathlib import Path

import pytest
from told_numbers import FIGURE_3, ROOT, agreement_with_the_plain_code, figure_3_tables, gives, text_of
from told_speed import FILLED, stops_of_speed

from slosh_cli.cli import main

DOCUMENTS = ["README.md", *(f"docs/{page.name}" for page in sorted((ROOT / "docs").glob("*.md")))]
MADE_BY_A_SCRIPT = {
    "docs/answers.md", "docs/baffles.md", "docs/identifiability.md", "docs/real-brakes.md", "docs/train-couplers.md",
    "docs/keys.md", "docs/commands.md", "docs/presets.md", "docs/api.md", "docs/gallery.md",
}  # fmt: skip
"""Compared with what makes them in results/test_answers.py, validation/test_validation_documents.py,
test_reference_pages.py and test_gallery.py."""
RECORDS = {"docs/hardness.md"}
"""What was tried how often, and what came out: the commands that repeat it take hours."""
PHRASES = tomllib.loads((ROOT / "tests/data/documented_numbers.toml").read_text(encoding="utf-8"))["phrase"]
TABLE_OF_THE_PAGE = "the table of the page"
PLAIN_CODE = "tests/acceptance/test_against_plain_code.py"
OTHER_CODES = "tests/benchmarks/bench_contestants.py"

CODE = re.compile(r"```.*?```|^(?: {4}|\t)[^\n]*$|`[^`]+`|\]\([^)]*\)", re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.^_/])[-+]?\d+(?:[ \u00a0]\d{3}\b)*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w^])")
NAME = re.compile(r"\b(?:Figure|Table|section|code|[Ww]heel) \d+|^#+ \d+\.\d* ", re.MULTILINE)
"""Numbers that are names."""


def without_code(text: str) -> str:
    """The text with everything a reader types or that is a name blanked, at the same places."""
    for hidden in (FILLED, CODE, NAME):  # for what is filled in see test_documented_speed.py
        text = hidden.sub(lambda match: re.sub(r"\S", "\u00b7", match[0]), text)
    return text


def place_of(phrase: str, text: str) -> re.Match[str] | None:
    """Where a phrase stands in a text, whatever its line breaks."""
    return re.search(r"\s+".join(map(re.escape, phrase.split())), text)


def numbers_in(phrase: str) -> list[str]:
    return NUMBER.findall(without_code(phrase))


@pytest.mark.parametrize("document", DOCUMENTS)
def test_every_number_is_listed(document):
    if document in MADE_BY_A_SCRIPT | RECORDS:
        return
    raw = text_of(document)
    visible = without_code(raw)
    if document == FIGURE_3:  # its tables: see test_the_tables_of_figure_3
        visible = visible[: visible.index("## The numbers")]
    covered = [place_of(entry["text"], raw) for entry in PHRASES if entry["in"] == document]
    spans = [match.span() for match in covered if match]
    missing = [
        f"{match[0]} in line {visible.count(chr(10), 0, match.start()) + 1}"
        for match in NUMBER.finditer(visible)
        if not any(first <= match.start() < last for first, last in spans)
    ]
    assert not missing, f"name the command in {document} and list these in tests/data/documented_numbers.toml"


@pytest.mark.parametrize("entry", PHRASES, ids=lambda entry: entry["text"][:40])
def test_an_entry_fits_its_document(entry):
    """The words stand there, and so does the command that yields their numbers."""
    assert place_of(entry["text"], text_of(entry["in"])), "the phrase is not in the document any more"
    if "given" in entry:
        return
    named = entry.get("named", entry["command"])
    if entry["in"].endswith(".toml"):
        assert named == f"slosh validate {Path(entry['in']).stem}"
    else:
        assert place_of(named, text_of(entry["in"])), f"{entry['in']} must name the command {named!r}"
    assert len(entry["told"]) == len(numbers_in(entry["text"])), numbers_in(entry["text"])


def runs(slow: bool) -> list[object]:
    return [
        pytest.param(entry, id=entry["text"][:40])
        for entry in PHRASES
        if "given" not in entry and entry.get("slow", False) is slow
    ]


@pytest.fixture(scope="module")
def answered(tmp_path_factory):
    """A command's answer, computed once; a list of commands has a list of answers."""
    folder = tmp_path_factory.mktemp("told")

    @cache
    def answer(command):
        if command == TABLE_OF_THE_PAGE:
            return figure_3_tables()
        if command == PLAIN_CODE:
            return agreement_with_the_plain_code()
        if command == OTHER_CODES:
            return stops_of_speed()
        words = shlex.split(command)[1:]
        if words[0] == "run":
            words += ["--no-figures"]
        if words[0] in ("run", "validate") or words[:2] == ["tank", "excite"]:
            words += ["-o", str(folder)]
        if words[0] != "schema":
            words += ["--json"]
        return spoken(words)

    def answers(command):
        return [answer(one) for one in command] if isinstance(command, list) else answer(command)

    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        for module in ("figures", "validation_figures"):
            patch.setattr(f"slosh_cli.report.{module}.RESOLUTION", 20)
        yield answers


def spoken(words):
    with contextlib.redirect_stdout(io.StringIO()) as out:
        assert main(words) == 0, words
    return json.loads(out.getvalue())


def compare(entry, answer):
    for token, expression in zip(numbers_in(entry["text"]), entry["told"], strict=True):
        told = float(re.sub(r"[ \u00a0]", "", token))
        if not expression:
            continue
        at_most = expression.startswith("at most: ")
        found = gives(expression.removeprefix("at most: "), answer)
        if at_most:
            assert found <= told, (token, expression, found)
        else:
            digits, _, power = token.partition("e")
            decimals = len(digits.partition(".")[2]) - int(power or 0)
            assert round(found, decimals) == told, (token, expression, found)


@pytest.mark.parametrize("entry", runs(slow=False))
def test_a_number_is_what_its_command_gives(entry, answered):
    compare(entry, answered(entry["command"]))


@pytest.mark.slow
@pytest.mark.parametrize("entry", runs(slow=True))
def test_a_number_is_what_its_slow_command_gives(entry, answered):
    if "second-code" in entry["command"] or entry["command"] == OTHER_CODES:
        pytest.importorskip("exudyn")
    compare(entry, answered(entry["command"]))


def least_load(row):
    """The least of a stop's wheel loads, in kN."""
    return min(float(row[f"min_wheel_load_{i}_N"]) for i in range(1, 5)) / 1e3


@pytest.mark.slow
def test_the_tables_of_figure_3(tmp_path):
    """The two studies that the page names, again: every cell of its tables, and wheel loads at a finer tolerance."""
    studies = {
        "printed": ["--liquid", "rigid,modal,shallow-water"],
        "computed": ["--liquid", "modal", "--set", "tank.coefficients=computed"],
        "finer": ["--liquid", "shallow-water", "--set", "solver.tolerance=1e-5"],
    }
    uncertain = float(re.search(r"uncertain by ([\d.]+) kN", text_of(FIGURE_3))[1])
    rows = {}
    for name, words in studies.items():
        assert main(["sweep", *words, "-o", str(tmp_path / name)]) in (0, 3)
        with (tmp_path / name / "braking_distance.csv").open(encoding="utf-8", newline="") as file:
            for found in csv.DictReader(file):
                named = found["liquid"] == "modal" or name == "finer"
                load = f"{found['liquid']}, {name}" if named else found["liquid"]
                rows[int(float(found["v0_km_h"])), float(found["torque_kN_m"]), load] = found
    for speed, table in figure_3_tables().items():
        for torque, line in table.items():
            at = {load: found for (v, t, load), found in rows.items() if (v, t) == (speed, torque)}
            finer = at.pop("shallow-water, finer")
            for load, found in at.items():
                star = " *" if found["liquid_in_range"] == "False" and found["status"] == "stopped" else ""
                distance = found["braking_distance_m"]
                told = f"{float(distance):.1f}{star}" if distance else found["status"]
                assert line[load] == told, (speed, torque, load)
            assert line["least modal computed"] == f"{least_load(at['modal, computed']):.1f}", (speed, torque)
            for found in (at["shallow-water"], finer):
                assert abs(float(line["least shallow"]) - least_load(found)) <= uncertain, (speed, torque)
            ratio = float(at["shallow-water"]["braking_distance_m"]) / float(at["rigid"]["braking_distance_m"])
            assert line["shallow-water / rigid"] == f"{ratio:.3f}", (speed, torque)
