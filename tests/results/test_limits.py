"""Every limit of a verdict is a key of the scenario, and changes that verdict alone."""

import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.results.filling import filling_checks
from slosh_cli.results.validity import Extent, checks
from slosh_cli.results.wagon_range import wagon_checks
from slosh_cli.scenario import parse_scenario, scenario_to_yaml
from slosh_cli.scenario.schema_limits import Limits

TAU = "brake force over weight (tau)"


def verdict(scenario, name):
    found = (*wagon_checks(scenario), *filling_checks(scenario.tank, scenario.limits))
    return next(check for check in found if check.name == name)


@pytest.mark.parametrize(
    ("overrides", "name", "limit", "within"),
    [
        ((), "axle load in t", 22.5, True),
        (("limits.axle_load=18 t",), "axle load in t", 18.0, False),
        ((), TAU, 0.12, True),
        (("braking.torque=6 kN m",), TAU, 0.12, False),
        (("braking.torque=6 kN m", "braking.slide_protection={}"), TAU, 0.15, True),
        (("braking.torque=6 kN m", "limits.tau=0.2"), TAU, 0.2, True),
        (
            ("braking.slide_protection={}", "limits.tau_with_protection=0.1"),
            TAU, 0.1, False,
        ),
    ],
)  # fmt: skip
def test_a_limit_decides_about_its_verdict(shipped, overrides, name, limit, within):
    check = verdict(shipped("paper_80_solid", *overrides), name)
    assert (check.limit, check.within) == (limit, within)
    assert check.standing
    assert check.source


@pytest.mark.parametrize(
    ("own", "name"),
    [
        ("axle_load=20 t", "axle load in t"),
        ("tau=0.01", TAU),
        ("filling_low=0.1", "degree of filling between its limits"),
    ],
)
def test_a_limit_of_the_scenario_says_so(shipped, own, name):
    usual, changed = verdict(shipped("paper_80_solid"), name), verdict(shipped("paper_80_solid", f"limits.{own}"), name)
    assert usual.standing != changed.standing == "assumed"
    assert changed.source == f"limits.{own.partition('=')[0]} of the scenario; usual: {usual.source}"


def test_a_low_limit_makes_no_brake_impossible(shipped):
    check = verdict(shipped("paper_80_solid", "limits={tau: 0.01, tau_with_protection: 0.02}"), TAU)
    assert not check.within
    assert "the limit here is 0.01. Wagons are built for at most 0.12 without" in check.meaning
    assert "No freight wagon" not in check.meaning


@pytest.mark.parametrize(("gross", "within"), [("90 t", True), ("90.01 t", False)])
def test_ninety_tonnes_are_no_overload(shipped, gross, within):
    for radius in ("1.5 m", "1.43 m", "1.37 m"):
        scenario = shipped(
            "paper_80_solid", f"tank.radius={radius}", f"tank.gross_mass={gross}", "tank.liquid.density=1 t/m^3"
        )
        assert verdict(scenario, "axle load in t").within is within


@pytest.mark.parametrize("own", ["filling_low=0.81", "filling_high=0.1"])
def test_limits_of_filling_the_wrong_way_round_are_refused(shipped, own):
    """They would allow everything, without a word."""
    with pytest.raises(ScenarioError, match=r"filling_low.* must be at most `filling_high`"):
        shipped("paper_80_solid", f"limits.{own}")
    assert shipped("paper_80_solid", "limits={filling_low: 0.5, filling_high: 0.5}").limits.filling_low == 0.5


@pytest.mark.parametrize(("torque", "said"), [(6, False), (10, True)])
def test_a_brake_that_no_freight_wagon_has_is_called_so(shipped, torque, said):
    check = verdict(shipped("paper_80_solid", f"braking.torque={torque} kN m"), TAU)
    assert ("No freight wagon has such a brake" in check.meaning) is said


def test_a_changed_limit_of_the_unloading():
    told = Extent(0.5, 0, False, 0.0, "", 0.4)
    (check,) = (check for check in checks(told) if check.name == "wheel unloading")
    assert not check.within
    assert "the limit is 0.4. EN 14363 has 0.6" in check.meaning
    assert check.source.startswith("limits.unloading of the scenario; usual: EN 14363")


def test_limits_have_usual_values_units_and_words_and_read_back(shipped):
    changed = shipped("paper_80_solid", "limits={axle_load: 25 t, viscosity: 3000 mm^2/s}")
    assert parse_scenario(scenario_to_yaml(changed)) == changed
    assert changed.limits.tau == Limits().tau == 0.12
    assert all(entry.description and not entry.is_required() for entry in Limits.model_fields.values())
