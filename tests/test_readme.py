"""The README's numbers are what the commands it names give today."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from slosh_cli.cli import main

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SCENARIOS = {
    "kolaei-half": "kolaei_half.yaml",
    "kolaei-three-quarters": "kolaei_three_quarters.yaml",
    "paper-80-liquid": "paper_80.yaml",
}


def numbers(cells: list[str]) -> list[float]:
    return [float(re.sub(r"[*\s ]", "", cell)) for cell in cells]


def answer(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, object]:
    capsys.readouterr()
    assert main([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def computed_rows() -> dict[str, list[float]]:
    found = re.findall(r"^\| `([\w-]+)` \([^|]*\) \| computed \|(.*)\|$", README, re.MULTILINE)
    return {name: numbers(cells.split("|")) for name, cells in found}


@pytest.mark.parametrize("name", SCENARIOS)
def test_the_table_of_computed_coefficients(name, capsys):
    told = computed_rows()[name]
    mode = answer(capsys, "tank", "coefficients", str(ROOT / "scenarios" / SCENARIOS[name]))["modes"][0]
    keys = ("omega_rad_s", "lambda_1_kg", "lambda_02_kg_m", "mu_kg", "mass_fraction", "height_m")
    places = (4, 0, 0, 0, 4, 3)
    assert told == [round(mode[key], digits) for key, digits in zip(keys, places, strict=True)]


@pytest.mark.parametrize("name", ["kolaei-half", "kolaei-three-quarters"])
@pytest.mark.parametrize("drive", ["step", "2.0 s ramp"])
@pytest.mark.parametrize("coefficients", ["printed", "computed"])
def test_the_table_of_largest_forces(name, drive, coefficients, capsys, tmp_path):
    row = re.search(rf"^\| {drive}, {coefficients}(?: coefficients)? \|(.*)\|$", README, re.MULTILINE)
    told = numbers(row[1].split("|"))[list(SCENARIOS).index(name)]
    arguments = ["tank", "excite", str(ROOT / "scenarios" / SCENARIOS[name]), "--deceleration", "0.2 g"]
    arguments += ["--ramp", "2 s"] if drive != "step" else []
    arguments += ["--set", "tank.coefficients=computed"] if coefficients == "computed" else []
    found = answer(capsys, *arguments, "-o", str(tmp_path))["max_normalised_force"]
    assert told == round(found, 2)
