"""Wagons with friction couplings and slosh against the equations written anew, on rails next to rigid."""

import numpy as np
import pytest
from second_train import FrictionSpring, SloshingWagon, second_train
from second_wagon import Brake, filling

from slosh_cli.scenario.schema_train import COUPLINGS
from slosh_cli.solver.run import integrate
from slosh_cli.solver.setup import train_problem
from slosh_cli.tank.coefficients import slosh_modes

RIGID = (
    "track.rail.youngs_modulus=1e13 Pa",
    "track.rail.second_moment=0.1 m^4",
    "track.foundation.stiffness=1e11 N/m^2",
    "tank.coefficients=computed",
    "braking.application=P",
    "braking.initial_speed=60 km/h",
)


def both(shipped, coupling, fills, torques, lag, *more, **how):
    """Our vehicles and their run, and forces (N) and places (m) of the second program at its instants."""
    each = [
        shipped(
            "paper_80", *RIGID, *more, f"tank.fill={fill}", f"braking.torque={torque} N m",
            f"braking.onset={0.5 + lag * k} s",
        )
        for k, (fill, torque) in enumerate(zip(fills, torques, strict=True))
    ]  # fmt: skip
    law = COUPLINGS[coupling]
    run = integrate(train_problem(each, law)[0])

    def spring():
        push, pull = ((way.loading, way.unloading) for way in (law.compression, law.tension))
        return FrictionSpring(push, pull, law.transition_stiffness)

    wagons = []
    for scenario, torque in zip(each, torques, strict=True):
        modes = [(one.frequency, one.lambda_1, one.lambda_02, one.mu) for one in slosh_modes(scenario.tank)]
        brake = Brake(lambda _, share, torque=torque: torque * share, filling(4.0))
        wagons.append(SloshingWagon(scenario, brake, modes))
    return each, run, *second_train(wagons, spring, run.rows[:-1, 0, 0], **how)


@pytest.mark.slow
def test_forces_of_couplings_are_those_of_a_second_program(shipped):
    fills, torques = (0.9, 0.5, 0.5, 0.3, 0.7), (7e3, 3e3, 5e3, 3e3, 6e3)
    ends = ("braking.stop_speed=13 m/s", "output.interval=10 ms", "solver.tolerance=1e-5")
    _, run, forces, places = both(shipped, "screw", fills, torques, 0.06, *ends)
    rows = run.rows[:-1]
    ours = rows[:, :-1, -2].T
    assert np.abs(ours).max() > 40e3
    deviation = np.abs(ours - forces).max() / np.abs(forces).max()
    assert deviation < 0.01, deviation
    assert np.abs(rows[:, :, 1].T - places).max() < 1e-3


def test_blows_of_couplings_with_slack_are_those_of_a_second_program(shipped):
    """A blow lasts some hundredths of a second: a small shift in time is much force, so whole histories need a fine
    tolerance; the largest forces do not."""
    ends = ("braking.stop_speed=15.2 m/s", "output.interval=2 ms")
    wagons = (0.9, 0.3, 0.6), (2e3, 7e3, 4e3), 0.3
    each, run, forces, places = both(
        shipped, "automatic", *wagons, *ends, "solver.tolerance=1e-6", longest=2e-3, rtol=1e-6
    )
    rows = run.rows[:-1]
    most = np.abs(forces).max()
    missed = (rows[:, :-1, -2].T - forces) / most
    assert most > 200e3
    assert np.abs(missed).max() < 0.01
    assert np.sqrt((missed**2).mean()) < 0.002
    assert np.abs(rows[:, :, 1].T - places).max() < 1e-4
    usual = integrate(train_problem([one.with_({"solver.tolerance": 5e-5}) for one in each], COUPLINGS["automatic"])[0])
    for found in (run.train.couplings, usual.train.couplings):
        assert found.largest[1] == pytest.approx(forces[1].max(), rel=2e-3)
        assert found.least[0] == pytest.approx(forces[0].min(), rel=2e-3)
