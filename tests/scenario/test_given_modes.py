"""Given slosh coefficients and the tank that they belong to."""

import pickle
from pathlib import Path

import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.results.simulate import simulate
from slosh_cli.scenario import (
    OutlivedCoefficientsError,
    find_packaged,
    load_any_scenario,
    load_scenario,
    load_tank_scenario,
    packaged_scenarios,
    parse_scenario,
    scenario_to_yaml,
)
from slosh_cli.study.build import Wishes, build

PAPER = find_packaged("paper-80-liquid")
NEW = "tank.coefficients=[{frequency: 1 rad/s, lambda_1: -1e5 kg, lambda_02: 0 kg m, mu: 4e5 kg}]"
SHAPING = {
    "tank.fill": "0.9",
    "tank.radius": "1.4 m",
    "tank.length": "15 m",
    "tank.liquid.density": "998 kg/m^3",
}


@pytest.mark.parametrize("key", SHAPING)
def test_a_changed_tank_needs_coefficients_of_its_own(key: str) -> None:
    changed = f"{key}={SHAPING[key]}"
    with pytest.raises(OutlivedCoefficientsError, match=rf"--set {key}: must stay.* set `tank.coefficients=computed`"):
        load_scenario(PAPER, [changed])
    with pytest.raises(OutlivedCoefficientsError, match=rf"^{key}: must stay"):
        load_scenario(PAPER).with_({key: SHAPING[key]})
    for order in ([changed, "tank.coefficients=computed"], ["tank.coefficients=computed", changed]):
        assert load_scenario(PAPER, order).tank.coefficients == "computed"
    assert load_scenario(PAPER, [changed, NEW]).tank.coefficients[0].frequency == 1.0  # type: ignore[union-attr]


def test_the_message_says_what_was_and_what_is_with_units() -> None:
    with pytest.raises(ScenarioError, match=r"given `1\.4 m` instead of `1\.5 m`;"):
        load_scenario(PAPER, ["tank.radius=1.4 m"])


def test_one_changed_number_of_a_mode_does_not_make_the_list_another_tanks() -> None:
    with pytest.raises(OutlivedCoefficientsError):
        load_scenario(PAPER, ["tank.coefficients.0.mu=400 t", "tank.length=15 m"])


def test_another_shape_is_another_tank(tmp_path: Path) -> None:
    file = tmp_path / "w.yaml"
    file.write_text(PAPER.read_text(encoding="utf-8").replace("  radius: 1.5 m\n", ""), encoding="utf-8")
    shape = ["tank.shape=elliptical", "tank.width=3 m", "tank.height=3 m"]
    with pytest.raises(OutlivedCoefficientsError):
        load_scenario(file, shape)
    assert load_scenario(file, [*shape, "tank.coefficients=computed"]).tank.shape == "elliptical"


@pytest.mark.parametrize(
    "same",
    ["tank.fill=0.50", "tank.radius=1500 mm", "tank.liquid.density=0.83 t/m^3", "tank.bottom_height=1.3 m", "name=x"],
)
def test_the_same_tank_keeps_its_coefficients(same: str) -> None:
    assert isinstance(load_scenario(PAPER, [same]).tank.coefficients, tuple)


@pytest.mark.parametrize("model", ["rigid", "shallow-water"])
def test_a_load_that_uses_none_drops_them_for_good(model: str) -> None:
    found = load_scenario(PAPER, ["tank.fill=0.9", f"tank.liquid.model={model}"])
    assert found.tank.coefficients == "computed"
    assert load_scenario(PAPER).with_({"tank.fill": 0.9, "tank.liquid.model": model}) == found
    read_back = parse_scenario(scenario_to_yaml(found))
    assert read_back.with_({"tank.liquid.model": "modal"}).tank.coefficients == "computed"


def test_a_tank_alone_and_its_commands_are_held_to_the_same() -> None:
    half = find_packaged("kolaei-half")
    for load in (load_tank_scenario, load_any_scenario):
        with pytest.raises(OutlivedCoefficientsError):
            load(half, ["tank.fill=0.6"])


def test_the_refusal_survives_pickling() -> None:
    with pytest.raises(OutlivedCoefficientsError) as caught:
        load_scenario(PAPER, ["tank.fill=0.9"])
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again)) == (OutlivedCoefficientsError, str(caught.value))


@pytest.mark.parametrize("liquids", [None, "modal", "rigid,modal", "shallow-water,modal"])
@pytest.mark.parametrize("vary", ["tank.fill=0.2:0.9:0.1", "tank.liquid.density=700,830 kg/m^3", "tank.length=15,16 m"])
def test_a_study_is_refused_before_anything_runs(vary: str, liquids: str | None) -> None:
    with pytest.raises(OutlivedCoefficientsError, match=f"^--vary {vary.partition('=')[0]}: must stay"):
        build(Wishes(vary=[vary], liquids=liquids)).check()
    study = build(Wishes(overrides=["tank.coefficients=computed"], vary=[vary], liquids=liquids))
    study.check()
    assert {study.stop(index).scenario.tank.coefficients for index in range(study.size)} == {"computed"}


def test_a_study_of_rigid_loads_uses_no_coefficients() -> None:
    build(Wishes(vary=["tank.fill=0.2:0.9:0.1"], liquids="rigid,shallow-water")).check()


def test_one_list_of_coefficients_does_not_serve_several_tanks() -> None:
    vary = ["tank.fill=0.4,0.5", NEW]
    with pytest.raises(OutlivedCoefficientsError, match=r"^--vary tank\.coefficients: must be `computed` where"):
        build(Wishes(vary=vary)).check()
    build(Wishes(vary=["tank.fill=0.4", NEW])).check()


def test_packaged_scenarios_but_the_papers_own_are_computed() -> None:
    for name, path in packaged_scenarios().items():
        given = not isinstance(load_any_scenario(path).tank.coefficients, str)
        assert given is name.startswith(("paper-", "kolaei-"))


@pytest.mark.slow
def test_the_unloading_follows_the_fill() -> None:
    """At 90 % the coefficients of 50 % gave an unloading of 0.281; those of the tank itself give 0.194."""
    found = load_scenario(PAPER).with_({"tank.fill": 0.9, "tank.coefficients": "computed"})
    assert simulate(found).max_wheel_unloading == pytest.approx(0.194, abs=5e-4)
