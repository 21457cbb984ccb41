"""The stretch of rail and its elements follow the track: how far a wheel's wave reaches, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import parse_scenario, rail_reach, scenario_to_yaml
from slosh_cli.scenario.rail_reach import computed_lengths, error_of_elements, error_of_ends, fading, margin_for
from slosh_cli.track.mem import critical_speed, rail_model, steady_shapes
from slosh_cli.wagon.model import wheel_positions

SCENARIOS = Path(__file__).parents[2] / "scenarios"
SOFT = "track.foundation={stiffness: 3e5 N/m^2, shear_stiffness: 0 N, damping: 0 N s/m^2, shear_damping: 0 N s}"
WHEELS = 13.8


def winkler(stiffness):
    return SOFT.replace("3e5", f"{stiffness:g}")


def deflections(scenario, speed):
    """Under four equal loads, m/N."""
    rail = rail_model(scenario.track, wheel_positions(scenario.wagon))
    return (steady_shapes(rail, speed) @ np.ones(4))[rail.contact]


def closed_form(scenario):
    """w = sum b/(2k) exp(-b x)(cos b x + sin b x), b = (k/4EI)^(1/4), of an endless beam on springs."""
    track = scenario.track
    k = track.foundation.stiffness
    b = (k / (4 * track.rail.youngs_modulus * track.rail.second_moment)) ** 0.25
    x = b * np.abs(np.subtract.outer(*2 * [wheel_positions(scenario.wagon)]))
    return -(b / (2 * k) * np.exp(-x) * (np.cos(x) + np.sin(x))).sum(axis=1)


def test_standing_load_fades_as_the_closed_form_says(shipped):
    track = shipped("paper_80_solid", SOFT).track
    b = (3e5 / (4 * 200e9 * 3.06e-5)) ** 0.25
    assert fading(track.rail, track.foundation, 0.0) == pytest.approx((2 * b, math.sqrt(2)), rel=1e-9)


@pytest.mark.parametrize("length", [30, 36, 44])
def test_the_error_of_the_ends_is_bounded_and_not_far_off(shipped, length):
    """Beside the endless beam; elements of 0.25 m err by 1e-7 here."""
    scenario = shipped("paper_80_solid", SOFT, f"track.domain={{length: {length} m, element_length: 0.25 m}}")
    miss = np.abs(deflections(scenario, 0.0) / closed_form(scenario) - 1.0).max()
    told = error_of_ends(scenario.track.rail, scenario.track.foundation, 0.0, 0.5 * (length - WHEELS))
    assert miss < told < 8.0 * miss


@pytest.mark.parametrize(
    ("foundation", "mass", "speed"),
    [
        (SOFT, 200, 40.0),
        (SOFT, 200, 80.0),
        (SOFT.replace("damping: 0 N s/m^2", "damping: 2e4 N s/m^2"), 60, 44.4),
        (SOFT.replace("shear_stiffness: 0 N", "shear_stiffness: 3e6 N"), 60, 44.4),
    ],
)
@pytest.mark.parametrize("length", [40, 60])
def test_moving_loads_reach_further_and_dampers_change_that(shipped, foundation, mass, speed, length):
    """Beside 400 m of the same rail; the critical speed of the heavy one is 116 m/s."""
    more = (foundation, f"track.rail.mass_per_length={mass} kg/m")
    short, long = (
        shipped("paper_80_solid", *more, f"track.domain={{length: {metres} m, element_length: 0.25 m}}")
        for metres in (length, 400)
    )
    miss = np.abs(deflections(short, speed) / deflections(long, speed) - 1.0).max()
    told = error_of_ends(short.track.rail, short.track.foundation, speed, 0.5 * (length - WHEELS))
    assert 0.5 * miss < told < 20.0 * miss


def test_the_critical_speed_is_the_rail_s(shipped):
    track = shipped("paper_80").track
    model = rail_model(track, wheel_positions(shipped("paper_80").wagon))
    assert rail_reach.critical_speed(track.rail, track.foundation) == pytest.approx(critical_speed(model), rel=1e-12)


@pytest.mark.parametrize("stiffness", [1e6, 1e7, 1e8])
@pytest.mark.parametrize("element", [0.25, 0.5, 0.9])
def test_the_error_of_the_elements(shipped, stiffness, element):
    domain = f"track.domain={{length: 90 m, element_length: {element} m}}"
    scenario = shipped("paper_80_solid", winkler(stiffness), domain)
    miss = np.abs(deflections(scenario, 0.0) / closed_form(scenario) - 1.0).max()
    told = error_of_elements(scenario.track.rail, scenario.track.foundation, element)
    assert told == pytest.approx(miss, rel=0.5)


def test_a_stretch_too_short_for_its_track_is_refused_with_the_length_it_needs(shipped):
    """24 m of a soft track: the deflection was 3.8 % too large without a word."""
    with pytest.raises(ScenarioError, match=r"13.8 m apart, and 7.5 m more .* more than 1 %.*write at least `28.8 m`"):
        shipped("paper_80_solid", SOFT, "track.domain.length=24 m")
    enough = shipped("paper_80_solid", SOFT, "track.domain={length: 28.8 m, element_length: 0.25 m}")
    assert np.abs(deflections(enough, 0.0) / closed_form(enough) - 1.0).max() < 0.01


def test_a_speed_near_the_critical_one_needs_more(shipped):
    heavy = (SOFT, "track.rail.mass_per_length=200 kg/m")
    track = shipped("paper_80_solid", *heavy).track
    slow, fast = (margin_for(track.rail, track.foundation, speed, 0.01) for speed in (20.0, 110.0))
    assert fast > 2.0 * slow
    with pytest.raises(ScenarioError, match=r"track\.domain\.length: must hold the wheels"):
        shipped("paper_80_solid", *heavy, "braking.initial_speed=110 m/s", "track.domain.length=30 m")


def test_the_default_follows_the_track(shipped):
    """1e-6 of the deflection at the ends, elements of 0.4 fading lengths: about 1e-4, at most half the wheelbase."""
    for stiffness, longest in ((3e5, 0.9), (1e7, 0.51), (1e9, 0.16)):
        scenario = shipped("paper_80_solid", winkler(stiffness), "track.domain={}")
        assert scenario.track.domain.length is None
        length, element = computed_lengths(scenario.track, 1.8, 12.0, 80 / 3.6)
        assert element <= longest
        assert error_of_elements(scenario.track.rail, scenario.track.foundation, element) < 1.1e-4
        margin = 0.5 * (length - WHEELS)
        ends = error_of_ends(scenario.track.rail, scenario.track.foundation, 80 / 3.6, margin)
        assert ends <= 1e-6
        assert length == round(length)


def test_a_scenario_without_a_domain_stays_without_one(shipped):
    """Written out and read back it is the same, and a sweep of the track takes its default along."""
    text = "\n".join(line for line in (SCENARIOS / "paper_80.yaml").read_text().splitlines() if "domain:" not in line)
    scenario = parse_scenario(text)
    assert parse_scenario(scenario_to_yaml(scenario)) == scenario
    softer = scenario.with_({"track.foundation.stiffness": 3e5})
    assert softer.track.domain.length is None
    lengths = [computed_lengths(one.track, 1.8, 12.0, 20.0)[0] for one in (scenario, softer)]
    assert lengths[1] > 1.5 * lengths[0]
    assert scenario.with_({"track.domain.length": "60 m"}).track.domain.length == 60.0


def test_given_lengths_stay_as_they_are(shipped):
    assert computed_lengths(shipped("paper_80").track, 1.8, 12.0, 20.0) == (50.0, 0.5)


def test_a_stop_without_a_domain_is_that_of_a_long_one(stop, shipped):
    """Distance to 1e-6, loads to 10 N; and a changed track changes the default with it."""
    long = stop("paper_80_solid", "track.domain={length: 100 m, element_length: 0.5 m}")
    found = stop("paper_80_solid", "track.domain={}")
    assert found.braking_distance_m == pytest.approx(long.braking_distance_m, rel=1e-6)
    assert found.min_wheel_load_N == pytest.approx(long.min_wheel_load_N, abs=10.0)
    soft = stop("paper_80_solid", "track.domain={}", SOFT.replace("damping: 0 N s/m^2", "damping: 1e3 N s/m^2"))
    assert soft.energy_residual < 1e-5
