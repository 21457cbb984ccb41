"""docs/which-liquid.md says what `slosh check` recommends, and no recommendation leads on to another."""

import itertools
import re
from pathlib import Path

import pytest

from slosh_cli import load_scenario
from slosh_cli.results.recommendation import recommend, stop_deceleration
from slosh_cli.scenario.units import parse_quantity

PAGE = (Path(__file__).parents[1] / "docs" / "which-liquid.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| `([\w-]+)` \| `(tank.*?)` \| `(.*?)` \| `(.*?)` \|$", PAGE, re.MULTILINE)
LIQUIDS = {
    "modal": ["tank.coefficients=computed", "tank.liquid.model=modal"],
    "shallow-water": ["tank.liquid.model=shallow-water"],
    "rigid": ["tank.liquid.model=rigid"],
}


@pytest.mark.parametrize(("name", "change", "deceleration", "model"), ROWS)
def test_the_page_recommends_what_the_program_does(name: str, change: str, deceleration: str, model: str) -> None:
    tank = load_scenario(name, [*LIQUIDS["shallow-water"], change]).tank
    assert recommend(tank, parse_quantity(deceleration, "acceleration", example="1 m/s^2")).model == model


def test_the_page_has_both_models_among_its_rows() -> None:
    assert {row[3] for row in ROWS} == {"modal", "shallow-water"}


@pytest.mark.parametrize(
    ("name", "fill"), list(itertools.product(["block-brake", "paper-80-liquid"], [0.3, 0.5, 0.8, 0.95]))
)
def test_no_model_sends_the_user_to_one_that_sends_him_back(name: str, fill: float) -> None:
    """The recommendation is the same with every model in use; of shallow water also with dispersion."""
    told = set()
    for words in LIQUIDS.values():
        scenario = load_scenario(name, [f"tank.fill={fill}", *words])
        told.add(recommend(scenario.tank, stop_deceleration(scenario)).model)
    (model,) = told
    dispersed = load_scenario(name, [f"tank.fill={fill}", *LIQUIDS["shallow-water"], "tank.liquid.dispersion=on"])
    if model == "shallow-water":
        assert recommend(dispersed.tank, stop_deceleration(dispersed)).model == "shallow-water"
