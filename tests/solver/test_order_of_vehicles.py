"""A train turned round: with brakes that set in at once the same forces, pulled where they pushed."""

import numpy as np

from slosh_cli.scenario.schema_train import COUPLINGS
from slosh_cli.solver.run import integrate
from slosh_cli.solver.setup import train_problem

TORQUES = (7e3, 3e3, 5e3, 4e3)


def test_turned_round_a_train_pulls_where_it_pushed(shipped):
    """The automatic coupling is the same in both directions; liquid and brakes take every coupling beyond its slack."""
    settings = ("braking.stop_speed=12 m/s", "output.interval=0.1 s", "solver.tolerance=1e-6")
    each = [shipped("paper_80", *settings, f"braking.torque={torque} N m") for torque in TORQUES]
    there, back = (integrate(train_problem(order, COUPLINGS["automatic"])[0]) for order in (each, each[::-1]))
    common = min(len(there.rows), len(back.rows)) - 1
    forces, turned = there.rows[:common, :-1, -2], back.rows[:common, -2::-1, -2]
    scale = np.abs(forces).max()
    assert scale > 100e3
    assert np.abs(forces + turned).max() < 1e-2 * scale
    assert np.abs(there.train.couplings.largest + back.train.couplings.least[::-1]).max() < 1e-3 * scale
