"""Every limit of a verdict is a key of the scenario, and changes that verdict alone."""

import pytest

from slosh_cli.results.filling import filling_checks
from slosh_cli.results.validity import Extent, checks
from slosh_cli.results.wagon_range import wagon_checks
from slosh_cli.scenario import parse_scenario, scenario_to_yaml
from slosh_cli.scenario.schema_limits import Limits


def verdict(scenario, name):
    found = (*wagon_checks(scenario), *filling_checks(scenario.tank, scenario.limits))
    return next(check for check in found if check.name == name)


@pytest.mark.parametrize(
    ("overrides", "name", "limit", "within"),
    [
        ((), "axle load in t", 22.5, True),
        (("limits.axle_load=18 t",), "axle load in t", 18.0, False),
        ((), "brake force over weight (tau)", 0.12, True),
        (("braking.torque=6 kN m",), "brake force over weight (tau)", 0.12, False),
        (("braking.torque=6 kN m", "braking.slide_protection={}"), "brake force over weight (tau)", 0.15, True),
        (("braking.torque=6 kN m", "limits.tau=0.2"), "brake force over weight (tau)", 0.2, True),
        (
            ("braking.slide_protection={}", "limits.tau_with_protection=0.1"),
            "brake force over weight (tau)", 0.1, False,
        ),
    ],
)  # fmt: skip
def test_a_limit_decides_about_its_verdict(shipped, overrides, name, limit, within):
    check = verdict(shipped("paper_80_solid", *overrides), name)
    assert (check.limit, check.within) == (limit, within)
    assert check.standing
    assert check.source


@pytest.mark.parametrize(("torque", "said"), [(6, False), (10, True)])
def test_a_brake_that_no_freight_wagon_has_is_called_so(shipped, torque, said):
    check = verdict(shipped("paper_80_solid", f"braking.torque={torque} kN m"), "brake force over weight (tau)")
    assert ("No freight wagon has such a brake" in check.meaning) is said


def test_a_changed_limit_of_the_unloading():
    told = Extent(0.5, 0, False, 0.0, "", 0.4)
    (check,) = (check for check in checks(told) if check.name == "wheel unloading")
    assert not check.within
    assert "the limit is 0.4" in check.meaning


def test_limits_have_usual_values_units_and_words_and_read_back(shipped):
    changed = shipped("paper_80_solid", "limits={axle_load: 25 t, viscosity: 3000 mm^2/s}")
    assert parse_scenario(scenario_to_yaml(changed)) == changed
    assert changed.limits.tau == Limits().tau == 0.12
    assert all(entry.description and not entry.is_required() for entry in Limits.model_fields.values())
