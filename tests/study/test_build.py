"""What a command line or a study file asks for becomes a grid of stops."""

import json
from pathlib import Path
from typing import Any

import pytest
from study_tools import PAPER

from slosh_cli.errors import ScenarioError, UsageError
from slosh_cli.scenario import Scenario, find_packaged
from slosh_cli.study.build import Wishes, build, grid
from slosh_cli.study.key import stop_key
from slosh_cli.study.plan import LIQUID, SPEED, TORQUE, Study
from slosh_cli.study.study_file import is_study_file


def axes(study: Study) -> dict[str, tuple[str, ...]]:
    return {axis.key: axis.values for axis in study.axes}


TORQUES = tuple(f"{2.5 * k:g} kN m" for k in range(1, 13))
FIGURE = {SPEED: ("80 km/h", "160 km/h"), TORQUE: TORQUES, LIQUID: ("modal", "rigid")}
OWN = {
    SPEED: ("60 km/h", "80 km/h", "100 km/h"),
    TORQUE: ("2.5 kN m", "3.75 kN m", "5 kN m", "6.25 kN m", "7.5 kN m", "10 kN m"),
    LIQUID: ("modal", "rigid"),
}
"""What surrounds the speed and the torque of the paper's scenario."""


@pytest.mark.parametrize(
    ("wishes", "expected"),
    [
        ({}, FIGURE),
        ({"file": PAPER}, OWN),
        ({"file": PAPER, "speeds": "80"}, OWN | {SPEED: ("80 km/h",)}),
        ({"file": PAPER, "torques": "10"}, OWN | {TORQUE: ("10 kN m",)}),
        ({"speeds": "80"}, FIGURE | {SPEED: ("80 km/h",)}),
        ({"torques": "10"}, FIGURE | {TORQUE: ("10 kN m",)}),
        ({"vary": ["tank.fill=0.3,0.5"]}, {"tank.fill": ("0.3", "0.5"), LIQUID: ("modal", "rigid")}),
        ({"vary": ["tank.fill=0.3"], "speeds": "80"}, {"tank.fill": ("0.3",), **FIGURE, SPEED: ("80 km/h",)}),
        ({"vary": ["braking.torque=5:6:1 kN m"]}, {TORQUE: ("5 kN m", "6 kN m"), LIQUID: ("modal", "rigid")}),
        ({"liquids": "rigid"}, FIGURE | {LIQUID: ("rigid",)}),
        ({"overrides": ["tank.liquid.model=rigid"]}, FIGURE),
        ({"vary": ["tank.liquid.model=rigid,modal"]}, {LIQUID: ("rigid", "modal")}),
    ],
)
def test_the_grid_follows_from_what_is_asked_for(wishes: dict[str, Any], expected: dict[str, Any]) -> None:
    assert axes(build(Wishes(**wishes))) == expected


@pytest.mark.parametrize("speed", ["83.3 km/h", "22.123456789012345 m/s", "0.3 m/s", "97.7 km/h"])
def test_a_scenarios_own_speed_stays_itself_to_the_last_digit(speed: str) -> None:
    own = build(Wishes(file=PAPER, overrides=[f"braking.initial_speed={speed}"]))
    assert own.base.braking.initial_speed in {own.stop(k).scenario.braking.initial_speed for k in range(own.size)}


def test_without_a_scenario_the_study_is_about_the_papers_wagon(paper: Scenario) -> None:
    study = build(Wishes())
    assert study.name == "paper-wagon"
    assert study.size == 48
    assert study.base == paper


def test_the_load_varies_fastest_and_other_keys_slowest() -> None:
    study = build(Wishes(speeds="80,160", torques="5,10", vary=["tank.fill=0.3,0.5"]))
    rows = [tuple(study.values(index).values()) for index in range(study.size)]
    assert rows[:3] == [
        ("0.3", "80 km/h", "5 kN m", "modal"),
        ("0.3", "80 km/h", "5 kN m", "rigid"),
        ("0.3", "80 km/h", "10 kN m", "modal"),
    ]
    assert rows[-1] == ("0.5", "160 km/h", "10 kN m", "rigid")
    assert len(set(rows)) == 16


def test_a_stop_has_the_values_of_its_place() -> None:
    vary = ["tank.fill=0.3,0.5", "contact.adhesion=dry,wet"]
    study = build(Wishes(overrides=["tank.coefficients=computed"], speeds="80,160", torques="5,10", vary=vary))
    for index in range(study.size):
        scenario, values = study.stop(index).scenario, study.values(index)
        assert f"{scenario.braking.initial_speed * 3.6:g} km/h" == values[SPEED]
        assert f"{scenario.braking.torque / 1e3:g} kN m" == values[TORQUE]
        assert scenario.tank.fill == float(values["tank.fill"])
        assert scenario.contact.adhesion.mu0 == {"dry": 0.55, "wet": 0.30}[values["contact.adhesion"]]
        assert scenario.tank.liquid.model == values[LIQUID]


def test_the_base_scenario_stays_as_it_is(paper: Scenario) -> None:
    study = build(Wishes())
    for index in range(study.size):
        study.stop(index)
    assert study.base == paper


@pytest.mark.parametrize(
    ("wishes", "message"),
    [
        ({"speeds": "80,x"}, "--v0: braking.initial_speed: must be a speed"),
        ({"torques": "1:10:4"}, "--torque must reach its stop"),
        ({"vary": ["tank.fill"]}, "must be a key path, an equals sign and values"),
        ({"vary": ["tank..fill=1"]}, "must be a key path, an equals sign and values"),
        ({"vary": ["tank.fil=0.3,0.4"]}, "--vary tank.fil: .*write `fill`"),
        ({"vary": ["tank.fill=0.3,1.4"], "liquids": "rigid"}, "--vary tank.fill: must be"),
        ({"vary": ["wagon.pivot_spacing=10,12"]}, "--vary wagon.pivot_spacing: must be a length with its unit"),
        ({"vary": ["braking.torque=5 kN m"], "torques": "5"}, "--torque and --vary braking.torque ask for the same"),
        ({"liquids": "modal,soup"}, "--liquid: tank.liquid.model: must be"),
        ({"file": Path("nowhere.yaml")}, "nowhere.yaml: must exist"),
    ],
)
def test_mistakes_are_named_before_anything_runs(wishes: dict[str, Any], message: str) -> None:
    with pytest.raises((UsageError, ScenarioError), match=message):
        build(Wishes(**wishes)).check()


def test_a_value_that_fits_in_no_combination_is_refused_one_that_fits_in_some_is_not() -> None:
    short, long = "track.domain.length=30 m", "track.domain.length=30,80 m"
    spacing = "wagon.pivot_spacing=10,40 m"
    with pytest.raises(ScenarioError, match=r"pivot_spacing|domain"):
        build(Wishes(overrides=[short], vary=[spacing])).check()
    study = build(Wishes(vary=[spacing, long]))
    study.check()
    sound = []
    for index in range(study.size):
        try:
            study.stop(index)
        except ScenarioError:
            continue
        sound.append(tuple(study.values(index).values())[:2])
    assert set(sound) == {("10 m", "30 m"), ("10 m", "80 m"), ("40 m", "80 m")}


def test_a_study_can_be_a_file(tmp_path: Path) -> None:
    (tmp_path / "wagon.yaml").write_text(find_packaged("tank-wagon").read_text())
    file = tmp_path / "my study.yaml"
    file.write_text(
        "description: how full\nbase: wagon.yaml\nvary:\n  tank.fill: 0.2:0.4:0.1\n"
        "  contact.adhesion:\n    - dry\n    - {mu0: 0.2, A: 0.4, B: 0.6 s/m, kA: 1.0, kS: 0.4}\n"
        "  braking.initial_speed: 80,160 km/h\nliquid: [modal]\n"
    )
    study = build(Wishes(file))
    assert study.name == "my-study"
    assert axes(study) == {
        "tank.fill": ("0.2", "0.3", "0.4"),
        "contact.adhesion": ("dry", "{mu0: 0.2, A: 0.4, B: 0.6 s/m, kA: 1.0, kS: 0.4}"),
        SPEED: ("80 km/h", "160 km/h"),
        LIQUID: ("modal",),
    }
    study.check()
    assert study.stop(2).scenario.contact.adhesion.mu0 == 0.2


def test_options_win_over_the_study_file(tmp_path: Path) -> None:
    file = tmp_path / "s.yaml"
    file.write_text("name: fills\nbase: paper-80-liquid\nvary: {tank.fill: [0.3, 0.5], braking.torque: 5 kN m}\n")
    study = build(Wishes(file, speeds="40", torques="7", vary=["tank.fill=0.6"], liquids="rigid"))
    assert (study.name, axes(study)) == (
        "fills",
        {SPEED: ("40 km/h",), "tank.fill": ("0.6",), TORQUE: ("7 kN m",), LIQUID: ("rigid",)},
    )


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        ("base: paper-80-liquid\n", ["s.yaml:1: vary: must be a mapping"]),
        ("vary: {tank.fill: 0.5}\n", ["s.yaml:1: base: must be the path of a scenario"]),
        ("base: nothing.yaml\nvary: {tank.fill: 0.5}\n", ["s.yaml:1: base: must be the path", "nothing.yaml"]),
        ("base: paper-80-liquid\nvari: 1\nvary:\n  tank.fill: 0.5\n", ["s.yaml:2: vari: is not a key", "write `vary`"]),
        ("base: paper-80-liquid\nvary:\n  tank.fill: 0.5:0.9:0.3\n", ["s.yaml:3: vary.tank.fill: must reach"]),
        ("base: paper-80-liquid\nvary:\n  tank.fill: []\n", ["s.yaml:3: vary.tank.fill: must be a list of at least"]),
        ("base: paper-80-liquid\nvary:\n  tank.fill: 2\n", ["s.yaml:3: tank.fill: must be"]),
        ("base: paper-80-liquid\nvary:\n\n  tank.fil: 0.5\n", ["s.yaml:4: tank.fil: "]),
        ("base: paper-80-liquid\nvary: {tank.fill: 0.5}\nname: a b\n", ["s.yaml:3: name: must be text"]),
        ("base: [\n", ["must be valid YAML"]),
        ("base: paper-80-liquid\nvary: {tank.fill: 0.5}\nvary: {tank.fill: 0.6}\n", ["s.yaml:3: vary: must be given"]),
    ],
)  # fmt: skip
def test_mistakes_in_a_study_file_are_named_with_their_line(tmp_path: Path, text: str, messages: list[str]) -> None:
    file = tmp_path / "s.yaml"
    file.write_text(text)
    with pytest.raises(ScenarioError) as caught:
        build(Wishes(file)).check()
    for message in messages:
        assert message in str(caught.value)


def test_the_key_knows_everything_that_changes_the_answer_and_nothing_else(paper: Scenario) -> None:
    key = stop_key(paper)
    same = paper.with_({"name": "other", "description": "words", "output.interval": "1 s"})
    assert stop_key(same) == key
    assert stop_key(paper.with_({"braking.initial_speed": "80.0 km/h"})) == key
    for change in (
        {"braking.torque": "5.000001 kN m"},
        {"solver.tolerance": 1e-5},
        {"tank.liquid.model": "rigid"},
        {"contact.adhesion": "wet"},
        {"tank.coefficients": "computed"},
        {"contact.stiffness": "9.4e10 N/m^1.5"},
    ):
        assert stop_key(paper.with_(change)) != key


def test_another_result_version_makes_other_keys(paper: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    key = stop_key(paper)
    monkeypatch.setattr("slosh_cli.study.key.RESULT_VERSION", 999)
    assert stop_key(paper) != key


def test_a_stop_without_history_has_the_key_of_one_with_it() -> None:
    without, with_it = build(Wishes()), build(Wishes(histories=True))
    assert [without.stop(i).key for i in (0, 17)] == [with_it.stop(i).key for i in (0, 17)]
    assert without.stop(0).scenario.output.interval == 100.0
    assert with_it.stop(0).scenario.output.interval == 0.01
    assert with_it.stop(0).scenario.description.startswith("braking.initial_speed 80 km/h")


STUDY = {"base": "paper-80-liquid", "vary": {"tank.fill": "0.3:0.5:0.1", "contact.adhesion": ["dry", "wet"]}}


@pytest.mark.parametrize("indent", [None, 2, "\t"])
def test_a_study_may_be_json(indent: int | str | None, tmp_path: Path) -> None:
    (tmp_path / "s.json").write_text(json.dumps(STUDY, indent=indent), encoding="utf-8")
    assert axes(build(Wishes(tmp_path / "s.json"))) == {
        "tank.fill": ("0.3", "0.4", "0.5"),
        "contact.adhesion": ("dry", "wet"),
        LIQUID: ("modal", "rigid"),
    }


def test_a_scenario_with_such_words_in_it_is_none(tmp_path: Path) -> None:
    text = find_packaged("paper-80-liquid").read_text(encoding="utf-8")
    (tmp_path / "a.yaml").write_text(f"x-own:\n  base: 1\n{text}# vary: this\n", encoding="utf-8")
    assert not is_study_file(tmp_path / "a.yaml")
    assert build(Wishes(tmp_path / "a.yaml")).name == "paper-80-liquid"


def test_a_study_that_is_no_yaml_is_told_so_as_a_study(tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("base: paper-80-liquid\nvary: {tank.fill: [0.3\n", encoding="utf-8")
    assert is_study_file(tmp_path / "s.yaml")
    assert not is_study_file(tmp_path / "nowhere.yaml")


def test_a_brake_that_is_told_otherwise_keeps_its_torque(shipped):
    """Torques of Figure 3 would displace the blocks, and every row would tell of another brake."""
    blocks = shipped("paper_80", "braking.blocks={count: 2, force: 25 kN, friction: cast-iron}")
    vary = {"braking.initial_speed": "80 km/h", "braking.blocks.friction": "cast-iron,0.15"}
    assert "braking.torque" not in [axis.key for axis in grid(blocks, vary).axes]
    assert "braking.torque" not in [axis.key for axis in grid(blocks, {}).axes]
    assert "braking.torque" in [axis.key for axis in grid(shipped("paper_80"), {}).axes]
    with pytest.raises(ScenarioError, match="must not be given beside `torque`"):
        grid(blocks, vary | {"braking.torque": "5 kN m"}).check()
