"""The standing of every value: of the file, a default, of a preset with its source, or computed."""

import pytest

from slosh_cli.scenario import load_scenario, load_tank_scenario, parse_scenario, scenario_to_yaml
from slosh_cli.scenario.standing import counted_standings, standings

_TEXT = """\
format: 1
name: mine
wagon: {use: zacns-like, car_body: {mass: 14 t}}
tank: {use: [zacns-like, diesel], fill: 0.6, liquid: {model: modal}, coefficients: computed}
track: {gradient: [[0 m, 0], [300 m, 0.01]]}
braking: {use: cast-iron-blocks, initial_speed: 100 km/h, onset: 0.5 s}
solver: {tolerance: 1e-3}
"""


def test_each_value_has_its_standing_and_source() -> None:
    found = standings(parse_scenario(_TEXT))
    told = {key: (one.standing, one.source) for key, one in found.items()}
    assert told["wagon.car_body.mass"] == ("yours", "")
    assert told["wagon.bogie.wheelbase"] == ("published", "preset zacns-like: UIC standard bogie Y25")
    assert told["tank.radius"] == ("assumed", "preset zacns-like: typical of the kind")  # which has a diameter
    assert told["tank.liquid.density"][1].startswith("preset diesel: ")
    assert told["braking.application.time_95"][1].startswith("preset cast-iron-blocks: ")  # which has the word P
    assert told["track.rail.mass_per_length"] == (
        "default",
        "published: Zhai, Wang, Lin, J. Sound Vib. 270 (2004)",
    )
    assert told["contact.adhesion.mu0"] == ("default", "assumed: usual")
    assert told["solver.time_limit"] == ("default", "the program's own")
    assert told["solver.tolerance"] == ("yours", "")
    assert told["tank.coefficients"][0] == told["track.domain"][0] == "computed"
    assert found["track.gradient"].value == "[[0 m, 0], [300 m, 0.01]]"
    assert (found["track.domain"].value, found["track.rail.youngs_modulus"].value) == ("computed", "2.059e11 Pa")
    assert not {"name", "format", "description", "presets"} & set(found)


@pytest.mark.parametrize("name", ["tank-wagon", "block-brake", "paper-80-liquid"])
def test_the_resolved_text_tells_the_same(name: str) -> None:
    scenario = load_scenario(name, ["track.use=soft-track"])
    assert standings(scenario_to_yaml(scenario)) == standings(scenario)
    assert not [key for key in standings(scenario) if ".0." in key]  # items of lists are counted from 1
    alone = load_tank_scenario(name)
    assert standings(scenario_to_yaml(alone)) == standings(alone)


def test_a_preset_answers_for_no_value_but_its_own() -> None:
    taken = "presets: {wagon.bogie.mass: zacns-like, wagon.bogie.wheelbase: y-26}\n"
    text = scenario_to_yaml(load_scenario("tank-wagon")).replace("wagon:\n", f"{taken}wagon:\n", 1)
    found = standings(text.replace("mass: 1800.0 kg", "mass: 1850.0 kg"))
    assert (found["wagon.bogie.mass"].standing, found["wagon.bogie.wheelbase"].standing) == ("yours", "yours")
    assert found["wagon.bogie.mass"].source == "not what the preset zacns-like has"
    assert "y-26" in found["wagon.bogie.wheelbase"].source
    assert standings(text)["wagon.bogie.mass"].standing == "assumed"


def test_standings_are_counted() -> None:
    found = standings(parse_scenario(_TEXT))
    told = counted_standings(found)
    assert told.startswith(f"Of {len(found)} values ")
    assert "2 computed" in told
    assert "measured" not in told
    assert sum(int(word) for word in told.removeprefix(f"Of {len(found)} ").split() if word.isdigit()) == len(found)
