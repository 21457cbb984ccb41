"""What editors mark is what the program refuses: the schemas of scenarios and studies against both kinds of files."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "scenario"))  # for malformed.py

from malformed import CASES, Case
from malformed_case import BASE, edited

from slosh_cli.errors import ScenarioError, SloshError
from slosh_cli.scenario import json_schema, load_any_scenario, packaged_scenarios
from slosh_cli.scenario.packaged import packaged_trains
from slosh_cli.scenario.yaml_text import parse
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.study_schema import every_schema, study_schema, train_schema

jsonschema = pytest.importorskip("jsonschema")


@pytest.fixture(scope="module")
def scenarios() -> Any:
    return jsonschema.Draft202012Validator(json_schema())


@pytest.fixture(scope="module")
def studies() -> Any:
    return jsonschema.Draft202012Validator(study_schema())


def faults(validator: Any, text: str) -> list[str]:
    return [error.message[:200] for error in validator.iter_errors(parse(text, "f.yaml").data)]


def test_the_schemas_are_schemas() -> None:
    for schema in (json_schema(), study_schema(), train_schema(), every_schema()):
        jsonschema.Draft202012Validator.check_schema(schema)


def test_what_an_editor_offers_is_valid() -> None:
    schema = json_schema()
    offered = 0
    for definition in (*schema["$defs"].values(), schema):
        for name, entry in definition["properties"].items():
            own = jsonschema.Draft202012Validator({**entry, "$defs": schema["$defs"]})
            for example in [*entry.get("examples", ()), *([entry["default"]] if "default" in entry else [])]:
                offered += 1
                assert own.is_valid(example), f"{name}: {example!r}"
    assert offered > 40


@pytest.mark.parametrize("name", packaged_scenarios())
def test_every_packaged_scenario_is_valid(name: str, scenarios: Any) -> None:
    assert faults(scenarios, packaged_scenarios()[name].read_text(encoding="utf-8")) == []


TANK = """\
format: 1
name: a
tank:
  shape: rectangular
  width: 2 m
  height: 2 m
  length: 9 m
  fill: 0.5
  liquid: {model: rigid, density: 1000 kg/m^3}
"""
POINTS = "  points: [[-1, 0], [1, 0], ['1 m', 2], [-1, 2]]\n"
GIVEN = BASE[BASE.index("  coefficients:") : BASE.index("track:")]
LAST = BASE[BASE.index("solver:") :]
SOUND = {
    "the wagon of the malformed cases": BASE,
    "a tank alone": TANK,
    "a tank alone with its height": TANK + "  bottom_height: 1 m\n",
    "own adhesion": edited(("adhesion: dry", "adhesion: {mu0: 0.3, A: 0.4, B: 0.2 s/m, kA: 0.3, kS: 0.1}")),
    "computed": edited((GIVEN, "  coefficients: computed\n  modes: 3\n")),
    "baffles": TANK.replace("rigid", "shallow-water") + "  baffles: [{position: 3 m, opening: 0.5}]\n",
    "polygon": TANK.replace("rectangular", "polygon").replace("  width: 2 m\n  height: 2 m\n", POINTS),
    "given stiffness": edited(("  adhesion: dry", "  adhesion: dry\n  stiffness: 9.4e10 N/m^1.5")),
    "no solver and no output": edited((LAST, "")),
}


@pytest.mark.parametrize("name", SOUND)
def test_what_the_program_reads_is_valid(name: str, scenarios: Any, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text(SOUND[name], encoding="utf-8")
    load_any_scenario(tmp_path / "a.yaml")
    assert faults(scenarios, SOUND[name]) == []


def test_keys_of_ones_own_are_valid(scenarios: Any, studies: Any) -> None:
    assert scenarios.is_valid({**parse(BASE, "f").data, "x-own": [1, {"a": 2}]})
    assert studies.is_valid({"base": "a.yaml", "vary": {"tank.fill": 0.5}, "x-own": None})
    assert not scenarios.is_valid({**parse(BASE, "f").data, "y-own": 1})


STRUCTURE = (
    "is not a key of", "is required", "must be a mapping", "must be `", "must be 1", "must be text", "must be a list",
    "must be a whole number", "must be a number",
)  # fmt: skip


def structural() -> Iterator[Case]:
    """Malformed files whose mistake a schema can see: keys, forms, words and pure numbers."""
    for case in CASES:
        rule = case.expected[0].rule if case.expected else ""
        if isinstance(case.content, str) and not case.overrides and rule.startswith(STRUCTURE) and case.name != "nan":
            yield case


@pytest.mark.parametrize("case", structural(), ids=lambda case: case.name)
def test_what_the_program_refuses_for_its_form_is_marked(case: Case, scenarios: Any) -> None:
    assert isinstance(case.content, str)
    assert faults(scenarios, case.content)


def test_a_tank_alone_has_no_solver_and_a_stop_needs_the_tanks_height(scenarios: Any) -> None:
    assert faults(scenarios, TANK + "solver: {tolerance: 1.0e-4}\n")
    assert faults(scenarios, TANK + "braking: {initial_speed: 80 km/h, torque: 5 kN m, onset: 0.5 s}\n")
    assert faults(scenarios, edited(("  bottom_height: 1.15 m\n", "")))


STUDIES = {
    "range": "vary: {tank.fill: 0.2:0.9:0.1}",
    "list": "vary: {contact.adhesion: [dry, wet]}",
    "numbers": "vary: {tank.fill: [0.3, 0.5]}",
    "one number": "vary: {tank.fill: 0.5}",
    "a word": "vary: {contact.adhesion: wet}",
    "mappings": "vary: {contact.adhesion: [dry, {mu0: 0.3, A: 0.4, B: 0.2 s/m, kA: 0.3, kS: 0.1}]}",
    "an item": "vary: {tank.coefficients.0.damping_ratio: [0.0, 0.01]}",
    "speeds": "vary: {braking.initial_speed: '80,160 km/h'}",
    "liquids in a text": "vary: {tank.fill: 0.5}\nliquid: 'modal, rigid'",
    "liquids in a list": "vary: {tank.fill: 0.5}\nliquid: [modal, rigid]",
    "name and description": "name: fills\ndescription: of some\nvary: {tank.fill: 0.5}",
}
BAD = {
    "no base": "vary: {tank.fill: 0.5}",
    "base is no text": "base: 3\nvary: {tank.fill: 0.5}",
    "nothing varies": "base: tank-wagon",
    "vary is a word": "base: tank-wagon\nvary: fill",
    "vary is empty": "base: tank-wagon\nvary: {}",
    "no values": "base: tank-wagon\nvary: {tank.fill: []}",
    "unknown key": "base: tank-wagon\nvari: {tank.fill: 0.5}\nvary: {tank.fill: 0.5}",
    "unknown path": "base: tank-wagon\nvary: {tank.fil: 0.5}",
    "unknown path of an item": "base: tank-wagon\nvary: {tank.coefficients.0.nu: 3 kg}",
    "unknown part": "base: tank-wagon\nvary: {brakes.torque: 5 kN m}",
    "unknown liquid": "base: tank-wagon\nvary: {tank.fill: 0.5}\nliquid: [water]",
    "unknown liquid in a text": "base: tank-wagon\nvary: {tank.fill: 0.5}\nliquid: modal,water",
    "name of no folder": "name: a/b\nbase: tank-wagon\nvary: {tank.fill: 0.5}",
}


def study_of(folder: Path, text: str) -> None:
    (folder / "study.yaml").write_text(text + "\n", encoding="utf-8")
    build(Wishes(folder / "study.yaml")).check()


@pytest.mark.parametrize("name", STUDIES)
def test_what_a_study_may_say_is_valid(name: str, studies: Any, tmp_path: Path) -> None:
    base = "paper-80-liquid" if name == "an item" else "tank-wagon"  # the one with given coefficients
    text = f"base: {base}\n{STUDIES[name]}"
    study_of(tmp_path, text)
    assert faults(studies, text) == []


@pytest.mark.parametrize("name", BAD)
def test_what_a_study_may_not_say_is_marked(name: str, studies: Any, tmp_path: Path) -> None:
    with pytest.raises(SloshError):
        study_of(tmp_path, BAD[name])
    assert faults(studies, BAD[name])


def test_the_error_of_a_study_is_that_of_a_scenario(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"study\.yaml:2: .*is not a key of a tank"):
        study_of(tmp_path, BAD["unknown path"])


@pytest.fixture(scope="module")
def trains() -> Any:
    return jsonschema.Draft202012Validator(train_schema())


@pytest.mark.parametrize("name", packaged_trains())
def test_every_packaged_train_is_valid(name: str, trains: Any) -> None:
    assert faults(trains, packaged_trains()[name].read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("name", [*packaged_scenarios(), *packaged_trains()])
def test_one_schema_knows_all_that_is_packaged(name: str) -> None:
    every = jsonschema.Draft202012Validator(every_schema())
    text = (packaged_scenarios() | packaged_trains())[name].read_text(encoding="utf-8")
    assert faults(every, text) == []
    assert faults(every, text.replace("name:", "nam:"))


SMALL = """\
format: 1
name: small
vehicles:
  - {scenario: tank-wagon, set: {tank.fill: 0.9, track: rigid}}
  - {scenario: own.yaml, count: 3}
coupling: screw
track: rigid
braking: {initial_speed: 60 km/h, onset: 0.5 s}
"""
BAD_TRAINS = {
    "a count of 0": ("count: 3", "count: 0"),
    "an unknown key of a vehicle": ("tank.fill: 0.9", "tank.fil: 0.9"),
    "an unknown coupling": ("coupling: screw", "coupling: rope"),
    "an unknown word for the track": ("\ntrack: rigid", "\ntrack: soft"),
    "no vehicles": ("vehicles:", "x-vehicles:"),
    "a key that a train has not": ("coupling: screw", "couplings: screw"),
    "no onset": (", onset: 0.5 s", ""),
}  # fmt: skip


def test_a_small_train_is_valid(trains: Any) -> None:
    assert faults(trains, SMALL) == []


@pytest.mark.parametrize("name", BAD_TRAINS)
def test_what_a_train_may_not_say_is_marked(name: str, trains: Any) -> None:
    before, after = BAD_TRAINS[name]
    assert before in SMALL
    assert faults(trains, SMALL.replace(before, after))


def test_a_study_of_a_train_varies_its_keys_and_those_of_its_vehicles(studies: Any) -> None:
    keys = ("all.tank.fill", "vehicles.3.braking.application", "brake_pipe.speed", "coupling", "braking.initial_speed")
    for key in keys:
        assert faults(studies, f"base: small.yaml\nvary: {{{key}: [1, 2]}}") == []
    assert faults(studies, "base: small.yaml\nvary: {vehicles.0.tank.fill: [0.1]}")
