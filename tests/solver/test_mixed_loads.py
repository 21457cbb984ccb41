"""Trains whose loads are of different kinds."""

import numpy as np
import pytest

from slosh_cli.scenario.schema_train import COUPLINGS, Coupling, LinearCoupling
from slosh_cli.solver.run import integrate
from slosh_cli.solver.setup import problem, train_problem

MODELS = ("shallow-water", "rigid", "modal")
SETTINGS = (
    "tank.coefficients=computed",
    "output.interval=0.1 s",
    "braking.torque=12 kN m",
    "braking.stop_speed=14 m/s",
)


@pytest.fixture
def each(shipped):
    return [shipped("paper_80_solid", *SETTINGS, f"tank.liquid.model={model}") for model in MODELS]


def test_each_load_moves_as_it_does_alone_where_couplings_have_no_stiffness(each):
    """To the tolerance: the steps are those of the whole train."""
    stops = train_problem(each, Coupling(linear=LinearCoupling(stiffness=0.0)))
    rows = integrate(stops[0]).rows
    for place, (stop, scenario) in enumerate(zip(stops, each, strict=True)):
        one = problem(scenario)
        alone = integrate(one).rows[:, 0]
        common = min(len(alone), len(rows)) - 1
        assert rows[:common, place, 1] == pytest.approx(alone[:common, 1], rel=2e-5)
        assert stop.vehicle.account.surface == pytest.approx(one.vehicle.account.surface, rel=5e-3)
        assert type(stop.vehicle.liquid) is type(one.vehicle.liquid) or scenario.tank.liquid.model == "rigid"


def test_the_ledger_of_mixed_loads_closes_with_friction_and_locked_wheels(each):
    later = [one.with_({"braking.onset": 0.5 + 0.06 * place}) for place, one in enumerate(each)]
    later[1] = later[1].with_({"braking.torque": 40e3})
    train = integrate(train_problem(later, COUPLINGS["screw"])[0]).train
    assert train.vehicles[1].account.locked_time.max() > 0.5
    assert np.abs(train.couplings.largest).max() > 2e4
    assert (train.couplings.taken > 0.0).all()
    assert train.largest_residual < 1e-5
