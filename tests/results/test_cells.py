"""Cells that are too few for a short stop: the run says so, and how far the distance may be off."""

import json
import math
from pathlib import Path

import pytest

from slosh_cli.results.simulate import simulate
from slosh_cli.scenario.units import STANDARD_GRAVITY
from tests.campaign.wagons import scenario_of

NAME = "time of a wave through a cell over that of the stop, for the liquid's part of the mass"
KEPT = json.loads((Path(__file__).parents[1] / "data" / "hostile_wagons.json").read_text(encoding="utf-8"))
SHORT = scenario_of(KEPT["phys_2_903"])
"""A stop of 1.1 m with 20 cells."""


def said_of(result):
    """The verdict on the cells, or none."""
    return next((one for one in result.checks if one.name == NAME), None)


def with_cells(count):
    return simulate(SHORT.with_({"tank.liquid.cells": count}))


@pytest.fixture(scope="module")
def found():
    return {count: with_cells(count) for count in (20, 40, 320)}


def test_it_falls_with_the_cells_and_bounds_what_they_miss(found):
    reference = found[320].braking_distance_m
    for count in (20, 40):
        missed = 1.0 - found[count].braking_distance_m / reference
        assert 0.0 < missed < 0.7 * said_of(found[count]).value
    shares = [count * said_of(one).value * one.braking_time_s for count, one in found.items()]
    assert shares == pytest.approx([shares[0]] * 3, rel=1e-9)


def test_a_short_stop_with_few_cells_names_the_number_that_would_do(found):
    coarse = said_of(found[20])
    assert not coarse.within
    assert coarse.meaning in found[20].warnings
    assert "Waves cross only 9 cells while the wagon stops" in coarse.meaning
    enough = int(coarse.meaning.rpartition("cells: ")[2].rstrip("`."))
    assert enough == pytest.approx(1.05 * 20 * coarse.value / coarse.limit, abs=1)
    assert said_of(with_cells(enough)).within


def test_the_share_is_what_the_definition_gives_by_hand(found):
    """A rectangular tank: small waves run at sqrt(g h); the liquid's part of the mass is that of both weights."""
    result, tank = found[20], SHORT.tank
    depth = tank.fill * tank.height
    liquid = tank.liquid.density * tank.length * tank.width * depth
    one_cell = tank.length / 20 / math.sqrt(STANDARD_GRAVITY * depth)
    part = liquid * STANDARD_GRAVITY / result.weight_N
    assert 0.5 < part < 0.9
    assert said_of(result).value == pytest.approx(part * one_cell / result.braking_time_s, rel=1e-6)


def test_a_stop_too_short_for_any_number_of_cells_says_so():
    stop = SHORT.with_({"braking.initial_speed": 0.06, "tank.liquid.cells": 2000})
    said = said_of(simulate(stop))
    assert not said.within
    assert "more than the 2000 that there can be" in said.meaning
    assert "Write" not in said.meaning


def test_a_distance_may_be_too_long_as_well_as_too_short(stop):
    """20 cells make 0.422 m of 0.410 m; the sentence claims no side, and no exponent."""
    few = ("tank.liquid.model=shallow-water", "braking.initial_speed=8 km/h", "braking.torque=12 kN m")
    coarse, fine = (stop("tank_wagon", *few, f"tank.liquid.cells={count}") for count in (20, 400))
    missed = coarse.braking_distance_m / fine.braking_distance_m - 1.0
    assert 0.02 < missed < 0.7 * said_of(coarse).value
    assert "may be off by up to 20 %." in said_of(coarse).meaning
    assert said_of(fine).within


def test_an_ordinary_stop_has_cells_enough(stop):
    assert said_of(stop("paper_80", "tank.liquid.model=shallow-water", "tank.liquid.cells=20")).within


def test_other_liquids_and_stops_that_do_not_end_say_nothing(stop):
    assert said_of(stop("paper_80")) is None
    short = ("tank.liquid.model=shallow-water", "solver.time_limit=1 s")
    assert said_of(stop("paper_80", *short)) is None
