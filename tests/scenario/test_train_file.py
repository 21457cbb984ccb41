"""Trains kept in a file: what they are made of, and what is said of a bad one."""

import pickle
from pathlib import Path

import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import load_scenario, scenario_to_yaml
from slosh_cli.scenario.packaged import packaged_trains
from slosh_cli.scenario.schema_train import COUPLINGS, Coupling
from slosh_cli.scenario.train_file import is_train_file, load_train

TRAIN = """\
format: 1
name: small
vehicles:
  - {scenario: paper-80-solid, set: {tank.fill: 0.9}}
  - {scenario: own.yaml, count: 3, set: {braking.application: P}}
coupling:
  compression: {loading: [[0 mm, 0 kN], [20 mm, 60 kN], [210 mm, 1000 kN]], unloading: [[0 mm, 0 kN], [20 mm, 25 kN]]}
  tension: {loading: [[0 mm, 0 kN], [10 mm, 60 kN]], unloading: [[0 mm, 0 kN], [10 mm, 25 kN]]}
brake_pipe: {speed: 250 m/s}
braking: {initial_speed: 60 km/h, onset: 0.5 s}
"""


@pytest.fixture
def train(tmp_path: Path):
    """Write the train, with some text replaced, and load it with overrides."""
    scenario = load_scenario(
        "paper-80-liquid", ["wagon.length_over_buffers=20 m", "track.foundation.damping=5 kN s/m^2"]
    )
    (tmp_path / "own.yaml").write_text(scenario_to_yaml(scenario), encoding="utf-8")

    def load(*overrides: str, replaced: tuple[str, str] = ("", "")):
        assert replaced[0] in TRAIN
        file = tmp_path / "small.yaml"
        file.write_text(TRAIN.replace(*replaced) if replaced[0] else TRAIN, encoding="utf-8")
        return load_train(file, overrides)

    return load


def test_vehicles_are_those_of_their_files_with_the_train_s_stop(train) -> None:
    found = train().vehicles
    assert [one.tank.fill for one in found] == [0.9, 0.5, 0.5, 0.5]
    assert [one.braking.onset for one in found] == pytest.approx([0.5 + x / 250 for x in (8.5, 27, 47, 67)])
    assert {one.braking.initial_speed for one in found} == {60 / 3.6}
    assert {one.track.foundation.damping for one in found} == {found[0].track.foundation.damping}
    assert found[3].braking.application is not None
    assert found[0].braking.application != found[3].braking.application


def test_what_the_first_vehicle_leaves_out_is_a_default_of_all(train, tmp_path: Path) -> None:
    train()
    text = (tmp_path / "own.yaml").read_text(encoding="utf-8")
    bare = text[: text.index("contact:")] + text[text.index("braking:") :]
    (tmp_path / "bare.yaml").write_text(bare, encoding="utf-8")
    replaced = ("paper-80-solid, set: {tank.fill: 0.9}", "bare.yaml")
    found = train(replaced=replaced).vehicles
    assert {one.presets.get("contact.adhesion") for one in found} == {"default"}
    assert found[3].defaults["contact.kalker_c11"] == "4.12"
    assert found[3].contact == found[0].contact
    assert not any(one.presets for one in train().vehicles)
    own = train("contact={youngs_modulus: 200 GPa, poisson_ratio: 0.3, rail_crown_radius: 0.3 m, kalker_c11: 4, "
                "adhesion: wet}", replaced=replaced).vehicles  # fmt: skip
    assert not any(one.presets for one in own)


def test_overrides_reach_every_vehicle_one_of_them_or_the_train(train) -> None:
    computed = ("all.tank.coefficients=computed", "all.tank.fill=0.4")
    found = train(*computed, "vehicles.3.braking.torque=3 kN m", "coupling=automatic", "braking.onset=1 s")
    assert [one.tank.fill for one in found.vehicles] == [0.4] * 4
    assert [one.braking.torque for one in found.vehicles] == [5e3, 5e3, 3e3, 5e3]
    assert found.file.coupling == COUPLINGS["automatic"]
    assert found.vehicles[0].braking.onset == pytest.approx(1.0 + 8.5 / 250)


@pytest.mark.parametrize(
    ("replaced", "said"),
    [
        (("own.yaml", "nope.yaml"), "small.yaml:5: vehicles.1.scenario: must be the path of a scenario"),
        (("own.yaml", "small.yaml"), "small.yaml:5: vehicles.1.scenario: must be the scenario of one vehicle"),
        (("count: 3", "count: 0"), "small.yaml:5: vehicles.1.count: must be a whole number from 1"),
        (("tank.fill: 0.9", "tank.fill: 1.9"), "small.yaml:4: vehicles.0.set.tank.fill: must be a number from"),
        (("tank.fill: 0.9", "tank.fil: 0.9"), "small.yaml:4: vehicles.0.set.tank.fil: is not a key"),
        (("[20 mm, 25 kN]]", "[20 mm, 65 kN]]"), "small.yaml:7: coupling.compression.unloading: must nowhere be above"),
        (("[210 mm, 1000 kN]", "[210 mm, 10 kN]"), "small.yaml:7: coupling.compression.loading: must never fall"),
        (("[[0 mm, 0 kN], [10 mm, 60", "[[0 mm, 1 kN], [10 mm, 60"), ":8: coupling.tension.loading: must begin"),
        (("[210 mm, 1000 kN]", "[20.5 mm, 1000 kN]"), "coupling.transition_stiffness: must be at least"),
        (("coupling:\n", "coupling:\n  linear: {stiffness: -1 N/m}\n"), ":7: coupling.linear.stiffness: must be"),
        (("  tension", "  tensions"), "small.yaml:8: coupling.tensions: is not a key"),
        (("60 km/h, onset: 0.5 s", "60 km/h, onset: 700 s"), "must come before the solver's time limit"),
        (("60 km/h", "60"), "small.yaml:10: braking.initial_speed: must be a speed"),
    ],
)  # fmt: skip
def test_a_bad_train_is_refused_with_file_line_and_fix(train, replaced: tuple[str, str], said: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        train(replaced=replaced)
    assert said in str(caught.value)
    assert "; write" in str(caught.value) or "exchange" in str(caught.value) or "name a" in str(caught.value)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("all.tank.fil=0.3", "--set all.tank.fil: is not a key"),
        ("vehicles.9.tank.fill=0.3", "--set vehicles.9.tank.fill: must name a vehicle from the front, 1 to 4"),
        ("vehicles.2.tank.fill=3", "--set vehicles.2.tank.fill: must be a number"),
        ("brake_pipe.speed=0.1 m/s", "--set brake_pipe.speed: must be a speed from"),
    ],
)
def test_a_bad_override_is_refused_as_it_was_written(train, override: str, said: str) -> None:
    with pytest.raises(ScenarioError, match=said):
        train(override)


def test_a_mistake_in_a_vehicle_s_file_names_that_file(train, tmp_path: Path) -> None:
    file = tmp_path / "own.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace("torque:", "torqe:"), encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"own\.yaml:\d+: braking\.torqe: is not a key"):
        train()


@pytest.mark.parametrize("name", packaged_trains())
def test_packaged_trains_are_sound(name: str) -> None:
    file = packaged_trains()[name]
    assert is_train_file(file)
    assert load_train(file).name == name


def test_screw_and_automatic_are_sound_couplings() -> None:
    for coupling in COUPLINGS.values():
        given = {name: vars(value) if hasattr(value, "loading") else value for name, value in vars(coupling).items()}
        assert Coupling.model_validate({name: value for name, value in given.items() if value is not None}) == coupling


@pytest.mark.parametrize(
    ("override", "fix"),
    [
        ("vehicles.2.braking.onset=3 s", "--set braking.onset="),
        ("all.braking.stop_speed=1 m/s", "--set braking.stop_speed="),
        ("vehicles.2.track.gradient=0.01", "--set all.track.gradient="),
        ("vehicles.2.solver.tolerance=1e-5", "--set all.solver.tolerance="),
    ],
)
def test_a_value_of_a_vehicle_that_the_train_would_displace_is_refused(train, override: str, fix: str) -> None:
    with pytest.raises(ScenarioError, match="must be said of the whole train") as refused:
        train(override)
    assert fix in str(refused.value)


def test_a_brake_as_a_whole_is_refused_since_it_would_lose_its_speed_and_onset(train) -> None:
    with pytest.raises(ScenarioError, match="key by key") as refused:
        train("vehicles.2.braking={torque: 3 kN m, initial_speed: 80 km/h, onset: 9 s}")
    assert "write `--set vehicles.2.braking.blocks=...`" in str(refused.value)


def test_so_is_one_in_the_file_and_the_first_vehicle_speaks_for_all(train) -> None:
    with pytest.raises(ScenarioError, match=r"small.yaml:4: vehicles.0.set.braking.onset: must be said of the whole"):
        train(replaced=("tank.fill: 0.9", "braking.onset: 2 s"))
    with pytest.raises(ScenarioError, match=r"small.yaml:5: vehicles.1.set.track.gradient: must be said of the whole"):
        train(replaced=("braking.application: P", "track.gradient: 0.01"))
    for override in ("all.track.gradient=0.01", "vehicles.1.track.gradient=0.01"):
        assert {one.track.gradient_points for one in train(override).vehicles} == {((0.0, 0.01),)}
