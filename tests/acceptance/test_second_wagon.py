"""Whole histories of the solver against the equations written anew for scipy, on a rail next to rigid."""

import numpy as np
import pytest
from second_wagon import Brake, second_stop

RIGID = (
    "tank.coefficients=computed",
    "track.rail.youngs_modulus=1e13 Pa",
    "track.rail.second_moment=0.1 m^4",
    "track.foundation.stiffness=1e11 N/m^2",
    "solver.tolerance=1e-6",
)


def deviations(ours, theirs):
    """Largest difference of each history over its own scale."""
    n, c, x = theirs.time.size, ours.channels, theirs.states

    def wheels(quantity):
        return np.array([c[f"wheel_{i}_{quantity}"] for i in (1, 2, 3, 4)])[:, :n]

    pairs = {
        "position": (c["position"][:n], x[0]),
        "speed": (c["speed"][:n], x[15]),
        "car pitch": (c["car_pitch"][:n], x[2]),
        "car heave": (c["car_heave"][:n], x[1]),
        "wheel speed": (wheels("speed"), x[26:30] * ours.scenario.wagon.wheelset.wheel_radius),
        "wheel load": (wheels("normal_force"), theirs.loads),
        "torque": (wheels("brake_torque"), theirs.torques),
    }
    return {name: float(np.abs(a - b).max() / np.abs(b).max()) for name, (a, b) in pairs.items()}


def constant(torque):
    return Brake(lambda _, share: torque * share)


def test_a_step_of_constant_torque(stop):
    ours = stop("paper_80_solid", *RIGID)
    theirs = second_stop(ours.scenario, constant(5e3), ours.time)
    assert not theirs.changes
    assert theirs.time.size >= ours.time.size - 1
    found = deviations(ours, theirs)
    assert max(found.values()) < 5e-4, found
    assert ours.braking_distance_m == pytest.approx(theirs.distance, rel=1e-8)


@pytest.mark.parametrize(
    ("torque", "more"),
    [(25, ("braking.initial_speed=150 km/h",)), (15, ("contact.adhesion=wet",)), (4.4, ("contact.adhesion=0.1",))],
)
def test_wheels_that_lock_and_turn_again(stop, torque, more):
    """On falling friction all four lock and two turn again; at 0.1 the trailing wheel of each bogie locks."""
    ours = stop("paper_80_solid", *RIGID, *more, f"braking.torque={torque} kN m")
    theirs = second_stop(ours.scenario, constant(torque * 1e3), ours.time, rtol=1e-7)
    found = deviations(ours, theirs)
    assert max(found.values()) < 1e-3, found
    assert ours.braking_distance_m == pytest.approx(theirs.distance, rel=1e-6)
    assert [wheel for _, wheel, stands in theirs.changes if stands] == [3, 1] + [2, 0] * (torque != 4.4)
    ends = [*theirs.changes, *((float(ours.time[-1]), wheel, False) for wheel in range(4))]
    for wheel, seconds in enumerate(ours.locked_time_s):
        locked = next((at for at, i, stands in ends if i == wheel and stands), None)
        free = next(at for at, i, stands in ends if i == wheel and not stands)
        assert seconds == pytest.approx(0.0 if locked is None else free - locked, abs=1e-3)
