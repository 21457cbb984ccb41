"""`slosh check` tells what is allowed but unlikely, or bound to happen, and still ends with 0."""

import json
from pathlib import Path

import pytest
from stand_ins import PAPER, Slosh

from slosh_cli.cli.exit_codes import ExitCode

COMPUTED = ("--set", "tank.coefficients=computed")
THICK = "limits.viscosity=3000 mm^2/s"
TANK = PAPER.parent / "kolaei_half.yaml"


def told(slosh: Slosh, file: Path, *overrides: str) -> dict:
    options = [part for override in overrides for part in ("--set", override)]
    outcome = slosh("check", file, "--json", *COMPUTED, *options)
    assert outcome.code == ExitCode.DONE, outcome.err
    return json.loads(outcome.out)


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("tank.liquid.density=1840 kg/m^3", "each axle carries 32.8 t"),
        ("wagon.bogie.mass=4.7 t", "counted twice"),
        ("tank.length=25 m", "overhangs"),
        ("wagon.car_body.mass=2 t", "bare shell"),
        ("braking.torque=20 kN m", "locked wheels, with a rigid load wheel 2, wheel 4"),
        ("braking.torque=10 kN m", "outside the linear theory"),
    ],
)
def test_findings_are_warnings(slosh: Slosh, override: str, said: str) -> None:
    found = told(slosh, PAPER, override)
    assert found["valid"] is True
    assert any(said in text for text in found["warnings"]), found["warnings"]
    assert len(found["warnings"]) == sum(not check["within"] for check in found["checks"])
    plain = slosh("check", PAPER, *COMPUTED, "--set", override)
    assert plain.code == ExitCode.DONE
    assert said in plain.err


def test_a_gentle_stop_of_the_paper_s_wagon_is_told_nothing(slosh: Slosh) -> None:
    """But that its tank is half full, unless the liquid is exempt."""
    found = told(slosh, PAPER, "braking.torque=2 kN m", THICK)
    assert found["warnings"] == []
    assert all(check["within"] for check in found["checks"])
    gentle = ("--set", "braking.torque=2 kN m")
    assert found["recommendation"]["sentence"] in slosh("check", PAPER, *COMPUTED, *gentle).out
    (law,) = told(slosh, PAPER, "braking.torque=2 kN m")["warnings"]
    assert "the corresponding rule could not be verified" in law


@pytest.mark.parametrize(
    ("override", "said"),
    [("tank.fill=0.95", "expected to strike the roof"), ("tank.length=6 m", "overstates the first slosh frequency")],
)
def test_the_range_of_shallow_water_is_told_before_the_run(slosh: Slosh, override: str, said: str) -> None:
    found = told(slosh, PAPER, "tank.liquid.model=shallow-water", override)
    assert any(said in text for text in found["warnings"]), found["warnings"]


def test_a_speed_above_the_critical_one(slosh: Slosh) -> None:
    """sqrt((666875 N + 2 sqrt(1e7 N/m^2 x 6.12e6 N m^2))/2000 kg/m) = 90.3 m/s."""
    found = told(slosh, PAPER, "track.rail.mass_per_length=2000 kg/m", "braking.initial_speed=100 m/s")
    assert any("not below the track's critical speed of 90.3 m/s" in text for text in found["warnings"])


def test_given_coefficients_beyond_their_bound(slosh: Slosh) -> None:
    outcome = slosh("check", PAPER, "--json")
    assert any("0.9345" in text and "0.8106" in text for text in json.loads(outcome.out)["warnings"])
    assert outcome.err == ""


def test_a_tank_alone_is_told_up_to_which_deceleration_modes_may_be_used(slosh: Slosh) -> None:
    found = told(slosh, TANK, THICK)
    assert found["describes"] == "a tank alone"
    assert {"tank_volume_m3", "slosh_period_s"} < set(found["data_sheet"])
    assert found["warnings"] == []
    assert found["recommendation"]["liquid_model"] is None
    assert found["recommendation"]["modal_up_to_m_s2"] == pytest.approx(1.48, abs=0.01)


def test_both_models_of_a_stop_recommend_the_same(slosh: Slosh) -> None:
    advice = [
        told(slosh, PAPER, f"tank.liquid.model={model}")["recommendation"] for model in ("modal", "shallow-water")
    ]
    assert advice[0] == advice[1]


def test_the_data_sheet_of_a_stop(slosh: Slosh) -> None:
    """The wagon weighs four of its axle loads; the terminal names the same figures."""
    sheet = told(slosh, PAPER, "tank.fill=0.5")["data_sheet"]
    assert 2 * (sheet["axle_load_front_t"] + sheet["axle_load_rear_t"]) == pytest.approx(sheet["gross_mass_t"])
    assert f"{sheet['tau']:.3f}" in slosh("check", PAPER, *COMPUTED, "--set", "tank.fill=0.5").out


def test_defaults_are_told(slosh: Slosh) -> None:
    text = PAPER.read_text(encoding="utf-8")
    Path("bare.yaml").write_text(f"{text[: text.index('contact:')]}{text[text.index('braking:') :]}", encoding="utf-8")
    told = json.loads(slosh("check", "bare.yaml", "--json", *COMPUTED).out)["defaults"]
    assert told["contact.adhesion"] == "dry"
    assert told["contact.youngs_modulus"] == "2.1e11 Pa"
    assert "track.domain.length" not in told
    assert "track.rail.youngs_modulus" not in told
    plain = slosh("check", "bare.yaml", *COMPUTED).out
    assert "contact: youngs_modulus 2.1e11 Pa, poisson_ratio 0.3" in plain
    inputs = json.loads(slosh("check", "bare.yaml", "--json", *COMPUTED).out)["inputs"]
    assert inputs["contact.kalker_c11"] == {"value": "4.12", "standing": "default", "source": "assumed: usual"}
    assert inputs["wagon.bogie.mass"]["standing"] == "yours"
    assert f"Of {len(inputs)} values " in plain
    assert "contact: " not in slosh("check", PAPER, *COMPUTED).out


def test_default_adhesion_is_warned_of_where_wet_rail_would_lock_wheels(slosh: Slosh) -> None:
    text = PAPER.read_text(encoding="utf-8")
    Path("bare.yaml").write_text(f"{text[: text.index('contact:')]}{text[text.index('braking:') :]}", encoding="utf-8")
    said = "The file says nothing of `contact.adhesion`"
    options = (*COMPUTED, "--set", "braking.torque=15 kN m")
    assert said in slosh("check", "bare.yaml", *options).err
    assert said not in slosh("check", "bare.yaml", *options, "--set", "contact.adhesion=dry").err
    assert said not in slosh("check", "bare.yaml", *COMPUTED, "--set", "braking.torque=3 kN m").err


def test_sensitivity_is_one_json_object_with_files(slosh: Slosh) -> None:
    rigid = ("--set", "tank.liquid.model=rigid", "--set", "solver.tolerance=1e-3", "--output", "out")
    outcome = slosh("check", PAPER, "--sensitivity", "--json", *COMPUTED, *rigid)
    assert outcome.code == ExitCode.DONE, outcome.err
    found = json.loads(outcome.out)
    values = {one["key"]: one for one in found["sensitivity"]["values"]}
    assert values["braking.torque"]["matters"]
    assert found["sensitivity"]["base"]["status"] == "stopped"
    assert found["data_sheet"]
    assert Path(found["files"]["table"]).is_file()
    assert len(found["files"]["figures"]) == 2
    told = slosh("check", PAPER, "--sensitivity", *COMPUTED, *rigid).out
    assert "These do not matter here" in told
    assert "braking.torque" in told


def test_sensitivity_needs_the_stop_of_one_wagon(slosh: Slosh) -> None:
    outcome = slosh("check", TANK, "--sensitivity")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "--sensitivity needs the stop of one wagon" in outcome.err
    Path("train.yaml").write_text("vehicles: []\n", encoding="utf-8")
    assert "a train" in slosh("check", "train.yaml", "--sensitivity").err
