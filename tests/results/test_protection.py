"""A distance that hangs on the samples of slide protection says so."""

import pytest

from slosh_cli.results.protection import PROTECTION
from slosh_cli.results.simulate import simulate, simulate_train
from slosh_cli.scenario.schema_run import SMALLEST_TOLERANCE
from tests.campaign.trains import train, train_of
from tests.campaign.wagons import scenario_of, wagon

LIGHT = (
    "braking.blocks={count: 2, force: 40 kN, friction: cast-iron}",
    "contact.adhesion=wet",
    "tank.fill=0.02",
    "braking.slide_protection={}",
)


def said_of(result):
    """The verdict on slide protection, or none."""
    return next((one for one in result.checks if one.name == PROTECTION), None)


@pytest.fixture(scope="module")
def hanging():
    """A short stop whose wheel 2 locks 0.04 s sooner or later, as one sample falls."""
    return simulate(scenario_of(wagon(1220)))


def test_a_distance_that_another_sample_moves_says_how_far(hanging):
    said = said_of(hanging)
    finer = simulate(hanging.scenario.with_({"solver.tolerance": 0.5 * hanging.scenario.solver.tolerance}))
    moved = abs(finer.braking_distance_m / hanging.braking_distance_m - 1.0)
    assert said.value == pytest.approx(moved, rel=1e-9)
    assert said.value > 2e-4 > said.limit == hanging.scenario.solver.tolerance
    assert not said.within
    assert f"it is {finer.braking_distance_m:.6g} m" in said.meaning
    assert said.meaning in hanging.warnings


def test_with_smaller_steps_it_is_resolved(hanging):
    finer = simulate(hanging.scenario.with_({"solver.tolerance": 1e-5}))
    assert said_of(finer).within
    assert said_of(finer).meaning not in finer.warnings


def test_at_the_smallest_tolerance_twice_of_it_is_the_other_run():
    """Half of it would be refused, itself would tell that all is well."""
    result = simulate(scenario_of(wagon(1220)).with_({"solver.tolerance": SMALLEST_TOLERANCE}))
    assert result.slide_protection_cycles > 0
    assert said_of(result).value > 0.0
    assert "with twice the tolerance" in said_of(result).meaning


def test_an_ordinary_stop_is_resolved(stop):
    result = stop("paper_80_solid", *LIGHT)
    assert result.slide_protection_cycles > 0
    assert said_of(result).value < 2e-5


def test_nothing_is_said_where_slide_protection_had_nothing_to_do(stop):
    assert said_of(stop("paper_80_solid")) is None
    dry = stop("paper_80_solid", "braking.slide_protection={}", "braking.torque=2 kN m")
    assert dry.slide_protection_cycles == 0
    assert said_of(dry) is None


def test_a_train_says_it_of_its_first_vehicle():
    """Four wagons at the limit of adhesion: 106.38 m, but 106.47 m with a hundredth of the tolerance."""
    result = simulate_train(train_of(train(210)))
    said = said_of(result.vehicles[0])
    assert said.limit == 1e-4
    assert said.value > 3e-4
    assert not any(said_of(vehicle) for vehicle in result.vehicles[1:])
    assert any(said.meaning in words for words in result.warnings)
