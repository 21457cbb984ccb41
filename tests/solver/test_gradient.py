"""Gravity along the track acts on every mass: on wagon, frozen load and moving liquid alike (theory section 8)."""

import numpy as np
import pytest

from slosh_cli.method import START
from slosh_cli.solver import advance as loop
from slosh_cli.solver.record import columns_of
from slosh_cli.solver.setup import problem
from slosh_cli.solver.vehicle import GRADIENT
from slosh_cli.tank.cells import CellLiquid
from slosh_cli.tank.modal import ModalLiquid

FREE = (
    "braking.onset=100 s", "wagon.running_resistance.constant=0 N", "wagon.running_resistance.linear=0 N s/m",
    "wagon.running_resistance.quadratic=0 N s^2/m^2", "output.interval=10 s", "solver.tolerance=1e-5",
    "tank.coefficients=computed",
)  # fmt: skip
PULL = 0.3
"""m/s^2, downhill on 30 permille."""


def whole_momentum(vehicle):
    """Momentum along the track of half the wagon and its load, with what the cells' push still owes the wagon."""
    wagon, v, liquid = vehicle.wagon, vehicle.points[START].v, vehicle.liquid
    momentum = float(wagon.mass[0] @ v)
    if isinstance(liquid, ModalLiquid):
        momentum += float(liquid.lambda_1 @ liquid.rate[START])
    if isinstance(liquid, CellLiquid):
        shallow = liquid.shallow
        momentum += shallow.mass * float(wagon.tank_row @ v + shallow.centre_height * v[2]) + liquid.left_force
        momentum += shallow.density * shallow.spacing * float(liquid.start.flow.sum())
    return momentum


@pytest.mark.parametrize("model", ["rigid", "modal", "shallow-water"])
def test_a_free_roll_leaves_the_liquid_at_rest_up_to_the_spins_inertia(shipped, model):
    stop = problem(shipped("paper_80", *FREE, f"tank.liquid.model={model}"))
    vehicle, train = stop.vehicle, stop.train
    vehicle.line.pull = PULL
    rows, liquid = np.zeros((50, 1, columns_of(vehicle).end)), vehicle.liquid
    while train.time < 8.0:
        assert loop.advance(train, rows, 10) == loop.RUNNING
    wagon, v = vehicle.wagon, vehicle.points[START].v
    mass = wagon.mass[0, 0] + (liquid.shallow.mass if isinstance(liquid, CellLiquid) else 0.0)
    spins = sum(wagon.mass[i, i] for i in range(11, 15)) / wagon.wheel_radius**2
    given = whole_momentum(vehicle) - (mass + spins) * 80 / 3.6 + 60.0 * v[11:].sum() / wagon.wheel_radius
    assert given == pytest.approx(PULL * mass * train.time, rel=1e-7)
    slower = spins / (mass + spins)
    assert v[0] - 80 / 3.6 == pytest.approx(PULL * (1.0 - slower) * train.time, rel=5e-3)  # the liquid swings a little
    left = PULL * slower / 9.81  # what the spins' inertia leaves of the pull, as a tilt of the surface
    if isinstance(liquid, ModalLiquid):
        assert np.abs(liquid.amplitude[START]).max() < 2.5 * left * 15.5 / 2
    if isinstance(liquid, CellLiquid):
        assert np.ptp(liquid.start.depth) < 2.5 * left * 15.5
    assert abs(train.residual) < 2e-6
    assert vehicle.account.losses[GRADIENT] < -0.5 * PULL * mass * 8.0 * 22.0


@pytest.mark.parametrize(("gradient", "pull"), [("0.010", -0.0981), ("-3 %", 0.2943), ("0", 0.0)])
def test_the_scenarios_gradient_is_a_pull_against_the_travel(shipped, gradient, pull):
    line = problem(shipped("paper_80_solid", f"track.gradient={gradient}")).vehicle.line
    assert line.pull == pytest.approx(pull, rel=1e-12)
