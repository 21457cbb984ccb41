"""The contract of liquids: every kind has every kernel of `Slosh`, and answers the integrator consistently."""

import inspect

import numpy as np
import pytest
from numba.core.registry import CPUDispatcher
from shallow_tools import CIRCLE, areas, liquid_in

from slosh_cli.compiled import kernel
from slosh_cli.method import BASE, END, START, hermite_weights, parabola_weights
from slosh_cli.tank.cells import CellLiquid, cell_liquid
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.liquid import Ride, Slosh
from slosh_cli.tank.mixed import MixedLiquid, of_one_class
from slosh_cli.tank.modal import ModalLiquid, modal_liquid

KINDS = (Slosh, *Slosh.__subclasses__())
CONTRACT = {name: value for name, value in vars(Slosh).items() if isinstance(value, CPUDispatcher)}
NAMES = {
    "expect", "predict", "inertia", "push", "follow", "error",
    "carry", "energy", "momentum", "highest", "record", "taken", "accept",
}  # fmt: skip
STEP, IMPLICIT = 0.02, 0.006
MODES = [SloshMode(1.9, 900.0, 1500.0, 1100.0, 0.02), SloshMode(5.5, -80.0, 60.0, 150.0, 0.01)]


def arguments(function):
    return list(inspect.signature(function.py_func).parameters)


def modes_in_motion(modes=MODES) -> ModalLiquid:
    liquid = modal_liquid(modes, 9.81, 0.5)
    rng = np.random.default_rng(1)
    for values in (liquid.amplitude, liquid.rate, liquid.second):
        values[:] = rng.normal(size=values.shape)
    return liquid


def still_cells() -> CellLiquid:
    shallow = liquid_in(CIRCLE, 20, 1.2).replaced(columns=0)
    columns = areas(shallow, 1.2), np.zeros(20), np.full(20, 1.2)
    return cell_liquid(shallow, columns, by_force=2e-5, by_moment=1e-6, along_by_force=2e-5)


def mixed(flows: int) -> MixedLiquid:
    """A tank of a train that mixes both kinds: the modes in motion (0) or the still cells (1)."""
    return of_one_class([modes_in_motion(), still_cells()], modal_liquid([], 9.81, 0.5))[flows]


LIQUIDS = {
    "frozen": Slosh.blank, "modes": modes_in_motion, "cells": still_cells,
    "modes of a mixed train": lambda: mixed(0), "cells of a mixed train": lambda: mixed(1),
}  # fmt: skip


@kernel
def answers(liquid, ride, row):
    """All that a liquid tells in a step of a moving tank, but for what it gets ready."""
    liquid.predict(START, STEP, 0.0, IMPLICIT)
    uu, up, pp = liquid.inertia(IMPLICIT)
    force, moment = liquid.push(BASE, IMPLICIT, 0.01, 0.3)
    liquid.follow(END, BASE, IMPLICIT, 0.01, -1.5, 0.2)
    size, by_force, by_moment = liquid.error(STEP, IMPLICIT, 0.1, 1e-3, 1e-2)
    missed = liquid.carry(ride, STEP, 1.0)
    kinetic, potential, loss = liquid.energy(ride, END)
    liquid.record(row, 1, 0.25, hermite_weights(STEP, 0.25), parabola_weights(0.25))
    liquid.accept(STEP)
    return (
        uu, up, pp, force, moment, size, by_force, by_moment, missed, kinetic, potential, loss,
        liquid.highest(), liquid.taken(), liquid.momentum(ride, END),
    )  # fmt: skip


@kernel
def make_ready(liquid, ride):
    return liquid.expect(ride, STEP)


@kernel
def followed(liquid, pitch, pull, acceleration, turning):
    """Force and moment on the tank by the contract: push less inertia times accelerations; then the liquid follows."""
    uu, up, pp = liquid.inertia(IMPLICIT)
    force, moment = liquid.push(BASE, IMPLICIT, pitch, pull)
    liquid.follow(END, BASE, IMPLICIT, pitch, acceleration - pull, turning)
    return force - uu * acceleration - up * turning, moment - up * acceleration - pp * turning


def moving_ride() -> Ride:
    ride = Ride.blank(3)
    ride.speed[:], ride.acceleration[:], ride.pitch[:] = (20.0, 19.98, 19.97), -1.5, 0.01
    return ride


def test_the_contract_is_whole():
    assert set(CONTRACT) == NAMES
    assert len(KINDS) == 4


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_every_kernel_with_the_same_arguments(kind):
    for name, function in CONTRACT.items():
        own = getattr(kind, name)
        assert isinstance(own, CPUDispatcher), f"{kind.__name__} has no kernel {name}"
        assert arguments(own) == arguments(function), f"{kind.__name__}.{name}"
        assert own.py_func.__doc__, f"{kind.__name__}.{name}"


@pytest.mark.parametrize("liquid", LIQUIDS)
def test_a_kind_records_as_many_numbers_as_it_says(liquid):
    made, row = LIQUIDS[liquid](), np.full(12, np.nan)
    assert make_ready(made, moving_ride())[0]
    answers(made, moving_ride(), row)
    assert np.flatnonzero(np.isfinite(row)).tolist() == list(range(1, 1 + made.recorded))


@pytest.mark.parametrize(
    "modes", [[], [SloshMode(1.9, 0.0, 0.0, 1100.0, 0.02)]], ids=["no modes", "a mode that nothing moves"]
)
def test_modes_that_carry_nothing_are_a_frozen_load(modes):
    liquid, ride = modal_liquid(modes, 9.81, 0.5), moving_ride()
    told = [answers(one, ride, np.zeros(4)) for one in (liquid, Slosh.blank())]
    assert told[0] == told[1] == 15 * (0.0,)
    assert make_ready(liquid, ride) == make_ready(Slosh.blank(), ride) == (True, 0.0, 0.0)


def test_a_frozen_load_answers_nothing_and_records_nothing():
    assert Slosh.blank().recorded == 0
    assert followed(Slosh.blank(), 0.01, 0.4, -1.5, 0.2) == (0.0, 0.0)


def test_push_and_inertia_give_the_force_of_the_modes_that_follow():
    liquid = modes_in_motion()
    found = followed(liquid, 0.01, 0.4, -1.5, 0.2)
    assert found == pytest.approx(liquid.force(END), rel=1e-12)
    assert abs(found[0]) > 100.0


def test_the_modes_equations_hold_where_they_follow():
    """mu a + c v + k x + lambda_1 u'' + lambda_02 pitch'' = g lambda_1 pitch, the pitch that of the stage's end."""
    liquid, pitch, turning = modes_in_motion(), 0.01, 0.2
    followed(liquid, pitch, 0.4, -1.1, turning)
    place, rate, second = (values[END] for values in (liquid.amplitude, liquid.rate, liquid.second))
    left = liquid.mu * second + liquid.damping * rate + liquid.stiffness * place
    right = liquid.pitch_weight * (pitch + IMPLICIT**2 * turning) - liquid.lambda_1 * -1.5 - liquid.lambda_02 * turning
    assert left == pytest.approx(right, rel=1e-9)


def test_still_cells_in_a_still_tank_stay_so():
    liquid, ride, row = still_cells(), Ride.blank(3), np.zeros(6)
    before = liquid.start.area.copy()
    ready, force, moment = make_ready(liquid, ride)
    assert ready
    told = answers(liquid, ride, row)
    scale = liquid.shallow.mass * 9.81
    assert (force, moment, told[3], told[4]) == pytest.approx(4 * (0.0,), abs=1e-12 * scale)
    assert (told[8], told[9], told[13]) == pytest.approx(3 * (0.0,), abs=1e-9)
    assert liquid.start.area == pytest.approx(before, rel=1e-12)
    assert liquid.last_step == STEP
    assert row[1:] == pytest.approx(np.zeros(5), abs=1e-12 * scale)
