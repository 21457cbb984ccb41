"""Formulas, markup and control characters in texts stay text, wherever they are shown."""

import csv
import shutil
from pathlib import Path
from xml.dom.minidom import parse

import h5py
import pytest
from answer import asked
from good_files import Good

from slosh_cli.results.tables import write_rows

WORDS = "$\\frac$ $x % {} <script>alert(1)</script> & \x1b[31m \\ _^"


@pytest.mark.parametrize("command", ["plot", "report"])
def test_words_of_a_history_stay_words(command: str, good: Good, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slosh_cli.report.figures.RESOLUTION", 25)
    shutil.copy(good.train_run, "run.h5")
    with h5py.File("run.h5", "r+") as file:
        file.attrs.update({"name": WORDS, "reason": WORDS, "warnings": WORDS})
    found = asked(command, "run.h5", "-o", "out" if command == "plot" else "out.html")
    assert (found.code, found.err) == (0, ""), found.err
    for page in [*folder.rglob("*.svg"), *folder.rglob("*.html")]:
        text = page.read_text(encoding="utf-8")
        assert "<script>alert" not in text
        assert "\x1b" not in text
    for picture in folder.rglob("*.svg"):
        assert "frac" in parse(str(picture)).documentElement.toxml()


def test_cells_that_a_spreadsheet_would_run_are_marked_as_text(folder: Path) -> None:
    texts = ["=HYPERLINK(1)", "+1+1", "-1+1", "@SUM(1)", "\t=1", "plain", "-5", "1e3"]
    write_rows(["a"], [{"a": text} for text in texts], folder / "table.csv")
    with (folder / "table.csv").open(encoding="utf-8", newline="") as file:
        cells = [row[0] for row in csv.reader(file)][1:]
    assert [cell.removeprefix("'") for cell in cells] == texts
    assert [cell.startswith("'") for cell in cells] == [True] * 5 + [False] * 3
