"""Five wagons with friction couplings and slosh against the equations written anew, on rails next to rigid."""

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
    "braking.stop_speed=13 m/s",
    "output.interval=10 ms",
    "solver.tolerance=1e-5",
)
FILLS, TORQUES, LAG = (0.9, 0.5, 0.5, 0.3, 0.7), (7e3, 3e3, 5e3, 3e3, 6e3), 0.06


@pytest.mark.slow
def test_forces_of_couplings_are_those_of_a_second_program(shipped):
    each = [
        shipped(
            "paper_80", *RIGID, f"tank.fill={fill}", f"braking.torque={torque} N m", f"braking.onset={0.5 + LAG * k} s"
        )
        for k, (fill, torque) in enumerate(zip(FILLS, TORQUES, strict=True))
    ]
    rows = integrate(train_problem(each, COUPLINGS["screw"])[0]).rows[:-1]
    law = COUPLINGS["screw"]

    def spring():
        push, pull = ((way.loading, way.unloading) for way in (law.compression, law.tension))
        return FrictionSpring(push, pull, law.transition_stiffness)

    wagons = []
    for scenario, torque in zip(each, TORQUES, strict=True):
        modes = [(one.frequency, one.lambda_1, one.lambda_02, one.mu) for one in slosh_modes(scenario.tank)]
        brake = Brake(lambda _, share, torque=torque: torque * share, filling(4.0))
        wagons.append(SloshingWagon(scenario, brake, modes))
    forces, places = second_train(wagons, spring, rows[:, 0, 0])
    ours = rows[:, :-1, -2].T
    assert np.abs(ours).max() > 40e3
    deviation = np.abs(ours - forces).max() / np.abs(forces).max()
    assert deviation < 0.01, deviation
    assert np.abs(rows[:, :, 1].T - places).max() < 1e-3
