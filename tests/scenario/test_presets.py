"""Presets: `use: NAME` in a part of a scenario, and scenarios written out of them."""

import json
import math
import re
from pathlib import Path

import pytest

from slosh_cli.errors import ScenarioError, SloshError, ValueRefused
from slosh_cli.scenario import Scenario, json_schema, load_scenario, parse_scenario, scenario_to_yaml
from slosh_cli.scenario.amounts import tare_of
from slosh_cli.scenario.composed import composed
from slosh_cli.scenario.document import Document, Origin
from slosh_cli.scenario.presets import every_preset, expand, find_preset
from slosh_cli.scenario.schema_train import TrainFile
from slosh_cli.scenario.yaml_text import parse
from slosh_cli.section import section_of
from slosh_cli.study.key import stop_key

_TEXT = """\
format: 1
name: mine
wagon: {use: zacns-like, car_body: {mass: 14 t}}
tank:
  use: zacns-like
  fill: 0.6
  liquid: {use: diesel, model: rigid}
track: {use: uic60-ballast}
contact: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, rail_crown_radius: 0.3 m, kalker_c11: 4.12, adhesion: dry}
braking: {use: k-blocks, initial_speed: 100 km/h, onset: 0.5 s}
"""
_CHOSEN = {
    "wagon": "zacns-like",
    "track": "uic60-ballast",
    "product": "diesel",
    "brake": "k-blocks",
    "temperature": "15 C",
    "gross": "80 t",
    "speed": "100 km/h",
}


def _file(folder: Path, text: str = _TEXT) -> Path:
    file = folder / "mine.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def _refusal(folder: Path, *overrides: str, text: str = _TEXT) -> str:
    with pytest.raises(ScenarioError) as caught:
        load_scenario(_file(folder, text), overrides)
    return str(caught.value).replace(f"{folder}/", "")


def test_what_stands_beside_use_holds_key_by_key() -> None:
    scenario = parse_scenario(_TEXT)
    assert (scenario.wagon.car_body.mass, scenario.wagon.car_body.centre_height) == (14000.0, 2.0)
    assert (scenario.tank.liquid.density, scenario.tank.liquid.model) == (840.0, "rigid")
    assert "wagon.car_body.mass" not in scenario.presets
    assert scenario.presets["tank.radius"] == "zacns-like"
    assert scenario.presets["tank.liquid.density"] == "diesel"


def test_the_resolved_scenario_states_presets_and_reads_back() -> None:
    scenario = parse_scenario(_TEXT)
    again = parse_scenario(scenario_to_yaml(scenario))
    assert again == scenario
    assert again.presets
    plain = again.model_copy(update={"presets": {}})
    assert "presets" not in scenario_to_yaml(plain)
    assert stop_key(plain) == stop_key(scenario)


def test_a_key_given_in_another_way_displaces_that_of_the_preset() -> None:
    text = _TEXT.replace("use: k-blocks", "use: k-blocks, torque: 5 kN m").replace("fill:", "radius: 1.4 m\n  fill:")
    scenario = parse_scenario(text)
    assert (scenario.braking.torque, scenario.braking.blocks) == (5000.0, None)
    assert getattr(scenario.tank, "radius", None) == 1.4
    assert not {"tank.radius", "braking.blocks.force"} & set(scenario.presets)


def test_later_presets_of_a_list_hold() -> None:
    wagon = parse_scenario(_TEXT.replace("use: zacns-like,", "use: [zacns-like, three-piece],")).wagon
    assert (wagon.bogie.wheelbase, wagon.pivot_spacing) == (1.85, 10.7)


def test_an_override_may_use_a_preset(tmp_path: Path) -> None:
    scenario = load_scenario(_file(tmp_path), ["wagon.use=15-9049", "wagon.pivot_spacing=8 m"])
    assert (scenario.wagon.car_body.mass, scenario.wagon.pivot_spacing) == (15900.0, 8.0)
    assert scenario.presets["wagon.car_body.mass"] == "15-9049"
    assert "wagon.pivot_spacing" not in scenario.presets
    changed = parse_scenario(_TEXT).with_({"wagon.use": "15-9049", "tank.radius": 1.4, "braking.torque": "5 kN m"})
    assert changed.wagon.pivot_spacing == 7.8
    assert changed.presets["wagon.pivot_spacing"] == "15-9049"
    assert not {"tank.radius", "braking.blocks.force"} & set(changed.presets)


def test_a_packaged_scenario_takes_another_track_whole() -> None:
    track = load_scenario("paper-80-liquid", ["track.use=uic60-ballast"]).track
    assert (track.rail.youngs_modulus, track.foundation.stiffness, track.foundation.shear_stiffness) == (
        205.9e9,
        5.16e7,
        0.0,
    )


def test_unknown_names_are_guessed_and_nothing_else_is_missed(tmp_path: Path) -> None:
    told = _refusal(tmp_path, text=_TEXT.replace("{use: zacns-like,", "{use: zacn-like,"))
    given = "must be the name of a preset; given `zacn-like`; did you mean `zacns-like`?"
    assert told == f"mine.yaml:3: wagon.use: {given}"
    assert _refusal(tmp_path, "wagon.use=zacn-like") == f"--set wagon.use: {given}"


def test_a_preset_without_values_for_the_part_is_refused(tmp_path: Path) -> None:
    told = _refusal(tmp_path, text=_TEXT.replace("use: uic60-ballast", "use: k-blocks"))
    assert told.startswith(
        "mine.yaml:8: track.use: must be a preset with values for `track`; given `k-blocks`, a brake;"
    )
    assert "use" in _refusal(tmp_path, text="use: zacns-like\n" + _TEXT)


def test_a_wrong_value_names_its_place_and_the_preset(tmp_path: Path) -> None:
    told = _refusal(
        tmp_path, text=_TEXT.replace("fill: 0.6", "shape: rectangular\n  width: 2 m\n  height: 2 m\n  fill: 0.6")
    )
    assert "mine.yaml:5: tank.diameter: " in told
    assert "from the preset `zacns-like`" in told
    told = _refusal(tmp_path, text=_TEXT.replace("car_body: {mass: 14 t}", "car_body: {mass: 14}"))
    assert told.startswith("mine.yaml:3: wagon.car_body.mass: ")
    assert "preset" not in told


@pytest.mark.parametrize("wagon", [p.name for p in every_preset().values() if p.kind == "wagon"])
@pytest.mark.parametrize("product", ["diesel", "caustic-soda"])
def test_scenarios_of_presets_are_sound(wagon: str, product: str) -> None:
    scenario = parse_scenario(composed("own", _CHOSEN | {"wagon": wagon, "product": product, "gross": "60 t"}))
    title, tare = find_preset(wagon).title, tare_of(scenario.wagon) / 1000.0
    assert f"tare {tare:g} t" in title
    volume = math.pi * (0.5 * scenario.tank.height) ** 2 * scenario.tank.length
    assert any(
        abs(float(word) - volume) < 0.6
        for word in title.replace(",", "").split()
        if word[0].isdigit() and "-" not in word
    )


@pytest.mark.parametrize("name", sorted(every_preset()))
def test_every_preset_is_sound_where_it_is_used(name: str) -> None:
    preset = find_preset(name)
    assert {leaf.standing for leaf in preset.leaves.values()} <= {"published", "measured", "assumed"}
    assert all(leaf.source for leaf in preset.leaves.values())
    parts = {str(path[0]) for path in preset.leaves}
    scenario = load_scenario("tank-wagon", [f"{part}.use={name}" for part in sorted(parts)])
    assert set(scenario.presets.values()) == {name}
    assert len(scenario.presets) == len(preset.leaves)


def test_density_follows_the_petroleum_tables_and_is_refused_outside() -> None:
    diesel = find_preset("diesel")
    alpha = 186.9696 / 840.0**2 + 0.4862 / 840.0
    for celsius in (-20.0, 30.0, 50.0):
        exact = 840.0 * math.exp(-alpha * (celsius - 15.0) * (1.0 + 0.8 * alpha * (celsius - 15.0)))
        assert diesel.density(celsius) == pytest.approx(exact, abs=0.06)
    with pytest.raises(ValueRefused, match="from -20 to 50 C"):
        diesel.density(51.0)
    for preset in every_preset().values():
        if preset.density_at:
            own = preset.leaves["tank", "liquid", "density"].value
            assert f"{dict(preset.density_at)[15.0]} kg/m^3" == own


_LEFT_OUT = "".join(line for line in _TEXT.splitlines(True) if not line.startswith(("track", "contact")))


def test_what_a_file_leaves_out_has_its_default_and_says_so() -> None:
    scenario, full = parse_scenario(_LEFT_OUT), parse_scenario(_TEXT)
    assert (scenario.track, scenario.contact) == (full.track, full.contact)
    defaults = {key for key, name in scenario.presets.items() if name == "default"}
    assert {key.partition(".")[0] for key in defaults} == {"track", "contact"}
    assert "contact.adhesion: default" in scenario_to_yaml(scenario)
    assert "default" not in full.presets.values()
    assert parse_scenario(scenario_to_yaml(scenario)) == scenario
    assert stop_key(scenario.model_copy(update={"presets": {}})) == stop_key(full)


def test_defaults_are_taken_key_by_key_and_give_way_to_overrides(tmp_path: Path) -> None:
    text = _LEFT_OUT + "contact: {kalker_c11: 3.9}\n"
    scenario = load_scenario(_file(tmp_path, text), ["track.foundation.stiffness=2e7 N/m^2"])
    assert (scenario.contact.kalker_c11, scenario.contact.poisson_ratio) == (3.9, 0.3)
    assert (scenario.track.foundation.stiffness, scenario.track.foundation.damping) == (2e7, 3.78e4)
    assert not {"contact.kalker_c11", "track.foundation.stiffness"} & set(scenario.presets)
    changed = scenario.with_({"contact.poisson_ratio": 0.25})
    assert "contact.poisson_ratio" not in changed.presets
    assert changed.presets["track.foundation.damping"] == "default"


def test_a_preset_holds_against_defaults_and_what_matters_is_required(tmp_path: Path) -> None:
    assert parse_scenario(_LEFT_OUT + "track: {use: soft-track}\n").track.foundation.stiffness == 1.5e7
    told = _refusal(tmp_path, text=_LEFT_OUT.replace("wagon: {use: zacns-like,", "wagon: {"))
    assert "wagon.pivot_spacing: is required" in told
    assert "running_resistance" not in told
    told = _refusal(tmp_path, text="".join(line for line in _LEFT_OUT.splitlines(True) if "wagon:" not in line))
    assert "wagon: is required" in told


def test_given_coefficients_belong_to_their_tank_where_the_track_is_left_out(tmp_path: Path) -> None:
    text = scenario_to_yaml(load_scenario("paper-80-liquid"))
    bare = text[: text.index("track:")] + text[text.index("contact:") :]
    assert load_scenario(_file(tmp_path, bare), ["braking.torque=4 kN m"]).tank.coefficients != "computed"
    assert "the given slosh coefficients belong to the unchanged tank" in _refusal(tmp_path, "tank.fill=0.9", text=bare)
    light = re.sub(r"  running_resistance:\n(?:    .*\n)+", "", bare).replace("  fill: 0.5", "  gross_mass: 80 t")
    told = _refusal(tmp_path, "wagon.car_body.mass=15 t", text=light)
    assert "the given slosh coefficients belong to the unchanged tank" in told


def test_a_misspelt_key_with_a_default_is_guessed(tmp_path: Path) -> None:
    told = _refusal(tmp_path, text=_TEXT.replace("kalker_c11", "kalker_c1"))
    assert told == "mine.yaml:9: contact.kalker_c1: is not a key of `contact`; given `kalker_c1`; write `kalker_c11`"


def test_a_train_says_all_of_a_part_or_nothing() -> None:
    track = parse(_TEXT, "mine").data["track"]
    document = Document({"track": track, "contact": {"kalker_c11": 4.12}}, origins={(): Origin()})
    expand(document, TrainFile)
    assert document.data["contact"] == {"kalker_c11": 4.12}
    with pytest.raises(ScenarioError, match=r"contact\.adhesion: is required.*such as `adhesion: dry`"):
        TrainFile.of(document, "train")


def test_a_mass_that_does_not_fit_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r"tank\.gross_mass: .*the tank holds"):
        composed("own", _CHOSEN | {"gross": "120 t"})


@pytest.mark.parametrize(("load", "volume"), [("60 %", 52.8), ("50 m^3", 50.0), ("42 t", 50.0), ("42000kg", 50.0)])
def test_a_load_is_a_share_a_volume_or_a_mass(load: str, volume: float) -> None:
    """The capacity of 88 m^3 makes the tank longer, and a share is of that capacity."""
    chosen = {key: value for key, value in _CHOSEN.items() if key != "gross"}
    tank = parse_scenario(composed("own", chosen | {"capacity": "88 m^3", "load": load})).tank
    assert math.pi * (0.5 * tank.height) ** 2 * tank.length == pytest.approx(88.0, abs=0.01)
    assert section_of(tank).area(tank.fill * tank.height) * tank.length == pytest.approx(volume, rel=1e-4)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"load": "60"}, "write such as `60 %`"),
        ({"load": "60 km"}, "write such as `60 %`"),
        ({"load": "120 %"}, "the tank holds"),
        ({"load": "60 %", "capacity": "40 m^3"}, "must be from 0.8 to 1.25 times the 87.0 m^3 of zacns-like"),
        ({"load": "60 %", "capacity": "88 m"}, "88 m"),
    ],
)
def test_a_load_or_capacity_that_cannot_be_is_refused(wrong: dict[str, str], told: str) -> None:
    chosen = {key: value for key, value in _CHOSEN.items() if key != "gross"}
    with pytest.raises(SloshError, match=re.escape(told)):
        composed("own", chosen | wrong)


def test_the_editor_schema_allows_use() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(json.dumps(json_schema()))
    jsonschema.validate(parse(_TEXT, "mine").data, schema)
    jsonschema.validate(parse(_LEFT_OUT, "mine").data, schema)
    jsonschema.validate(parse(_LEFT_OUT + "track: {rail: {mass_per_length: 54 kg/m}}\n", "mine").data, schema)
    assert schema["$defs"]["Contact"]["properties"]["adhesion"]["default"] == "dry"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(parse(_TEXT.replace("use: uic60-ballast", "use: 5"), "mine").data, schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(parse(_TEXT.replace("use: zacns-like, car_body", "car_body"), "mine").data, schema)
    assert "presets" in Scenario.model_fields
