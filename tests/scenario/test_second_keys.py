"""Diameters beside radii, and a coefficient of friction for the law of adhesion."""

from pathlib import Path
from typing import Any

import pytest
from malformed_case import BASE, edited

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import (
    HorizontalCylinder,
    Liquid,
    OutlivedCoefficientsError,
    Scenario,
    load_scenario,
    parse_scenario,
    scenario_to_yaml,
)

TANK = ("  radius: 1.5 m", "  diameter: 3 m")
WHEEL = ("wheel_radius: 0.46 m", "wheel_diameter: 920 mm")
COMPUTED = "tank.coefficients=computed"
NEW_MODES = {"tank.coefficients": "computed"}
"""A changed tank needs slosh coefficients of its own."""
COULOMB = {"mu0": 0.15, "A": 1.0, "B": 0.0, "kA": 1.0, "kS": 1.0}


def load(path: Path, *overrides: str, text: str = BASE) -> Scenario:
    """A scenario from text and overrides."""
    path.write_text(text, encoding="utf-8")
    return load_scenario(path, overrides)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "scenario.yaml"


@pytest.mark.parametrize("changes", [(TANK,), (WHEEL,), (TANK, WHEEL)])
def test_a_diameter_is_the_scenario_of_its_radius(changes: tuple[tuple[str, str], ...]) -> None:
    found = parse_scenario(edited(*changes))
    assert found == parse_scenario(BASE)
    assert parse_scenario(scenario_to_yaml(found)) == found


def test_a_diameter_in_python() -> None:
    given: dict[str, Any] = {"length": 5.75, "fill": 0.5, "liquid": Liquid(model="modal", density=1000.0)}
    assert HorizontalCylinder(**given, diameter=2.4) == HorizontalCylinder(**given, radius=1.2)
    assert HorizontalCylinder(**given, diameter="2.4 m").height == 2.4


@pytest.mark.parametrize("text", [BASE, edited(TANK)])
@pytest.mark.parametrize("override", ["tank.radius=1.2 m", "tank.diameter=2.4 m"])
def test_an_override_of_either_replaces_whichever_the_file_gives(file: Path, text: str, override: str) -> None:
    assert load(file, override, COMPUTED, text=text).tank.width == 2.4
    key, _, value = override.partition("=")
    assert parse_scenario(text).with_({key: value} | NEW_MODES).tank.width == 2.4
    with pytest.raises(OutlivedCoefficientsError, match=r"given `1\.2 m` instead of `1\.5 m`"):
        load(file, override, text=text)


@pytest.mark.parametrize("text", [BASE, edited(TANK)])
@pytest.mark.parametrize("override", ["tank.radius=1.5 m", "tank.diameter=3000 mm"])
def test_the_same_size_by_either_key_keeps_the_given_coefficients(file: Path, text: str, override: str) -> None:
    assert load(file, override, text=text) == parse_scenario(BASE)


def test_replace_takes_the_number_of_a_diameter_in_metres() -> None:
    found = parse_scenario(BASE).with_({"tank.diameter": 2.5, "wagon.wheelset.wheel_diameter": 0.84} | NEW_MODES)
    assert (found.tank.height, found.wagon.wheelset.wheel_radius) == (2.5, 0.42)


PROBLEMS = [
    ("  diameter: 3", 22, "tank.diameter", "must be a length with its unit", "`3` without a unit", "write `3 m`"),
    ("  diameter: 30 m", 22, "tank.diameter", "must be a length from 0.04 m to 20 m", "`30 m`", "such as `3 m`"),
    ("  diameter: 5.2 m", 22, "tank.diameter", "at most 5 m wide", "a width of `5.2 m`", "a narrower tank"),
    ("  diametre: 3 m", 22, "tank.diametre", "is not a key", "`diametre`", "write `diameter`"),
    (
        "  radius: 1.5 m\n  diametre: 3 m",
        23,
        "tank.diametre",
        "is not a key",
        "`diametre`",
        "there already, or take it",
    ),
    ("  diameter: 3 m\n  radius: 1.5 m", 22, "tank.diameter", "must not be given beside `radius`", "both", "keep one"),
    ("  radius: 1.5 m\n  diameter: 3 m", 23, "tank.diameter", "must not be given beside `radius`", "both", "keep one"),
    ("", 20, "tank.radius", "is required", "nothing", "such as `radius: 1.5 m` or `diameter: 3 m`"),
]


@pytest.mark.parametrize(("written", "line", "key", "rule", "given", "fix"), PROBLEMS)
def test_messages_name_the_key_that_was_written(
    file: Path, written: str, line: int, key: str, rule: str, given: str, fix: str
) -> None:
    with pytest.raises(ScenarioError) as caught:
        load(file, text=edited((TANK[0], written)))
    (problem,) = caught.value.problems
    assert (problem.line, problem.key) == (line, key)
    assert rule in problem.rule
    assert given in problem.given
    assert fix in problem.fix


@pytest.mark.parametrize("keys", [("tank.radius", "tank.diameter"), ("tank.diameter", "tank.radius")])
def test_two_overrides_of_one_size_are_refused(file: Path, keys: tuple[str, str]) -> None:
    with pytest.raises(ScenarioError, match="must not be given beside"):
        load(file, *(f"{key}=1.4 m" for key in keys))
    with pytest.raises(ScenarioError, match="must not be given beside"):
        parse_scenario(BASE).with_(dict.fromkeys(keys, 1.4))


def test_a_misplaced_diameter_is_sent_where_it_belongs(file: Path) -> None:
    with pytest.raises(ScenarioError, match=r"move it to `wagon\.wheelset\.wheel_diameter`"):
        load(file, text=edited(("    wheel_radius: 0.46 m\n", ""), ("  pivot_", "  wheel_diameter: 0.92 m\n  pivot_")))
    box = edited(("horizontal-cylinder", "rectangular"), (TANK[0], "  width: 2 m\n  height: 2 m\n  diameter: 2 m"))
    with pytest.raises(ScenarioError, match="`diameter`, which belongs to shape horizontal-cylinder; take it out"):
        load(file, text=box)


@pytest.mark.parametrize("written", ["0.15", "15 %", "150 ‰", "15,0 percent"])
def test_a_number_for_the_adhesion_is_a_constant_coefficient(file: Path, written: str) -> None:
    found = load(file, text=edited(("adhesion: dry", f"adhesion: {written}")))
    assert found.contact.adhesion.model_dump() == COULOMB
    assert parse_scenario(scenario_to_yaml(found)) == found
    assert load(file, f"contact.adhesion={written}") == found


def test_a_number_for_the_adhesion_in_python_and_changed_in_part(file: Path) -> None:
    base = parse_scenario(BASE)
    assert base.with_({"contact.adhesion": 0.15}).contact.adhesion.model_dump() == COULOMB
    found = load(file, "contact.adhesion.A=0.5", text=edited(("adhesion: dry", "adhesion: 0.15")))
    assert found.contact.adhesion.model_dump() == COULOMB | {"A": 0.5}


@pytest.mark.parametrize("share", ["60 %", "60%", "600 ‰", "60 percent", "60 per cent", "6,0e1 %"])
def test_a_fill_in_per_cent_is_the_number(file: Path, share: str) -> None:
    assert load(file, text=edited(("fill: 0.5", f"fill: {share}"))).tank.fill == 0.6
    assert parse_scenario(BASE).with_({"tank.fill": share} | NEW_MODES).tank.fill == 0.6
