"""Whole histories of the solver against the equations written anew for scipy, on a rail next to rigid."""

import numpy as np
import pytest
from second_wagon import Brake, filling, pressed, ramp, second_stop

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


IRON = "blocks: {count: 2, force: 25 kN, friction: cast-iron}"
COMPOSITE = "blocks: {count: 1, force: 30 kN, friction: composite}"
DISCS = "discs: {faces: 2, force: 20 kN, radius: 0.247 m, friction: [[0 km/h, 0.40], [60 km/h, 0.35], [90 km/h, 0.28]]}"
RAMP = "application: {form: linear, time: 4 s}"
LATE = "application: {form: filling, time_95: 5 s, delay: 1 s, jump: 0.2}"
CAST_IRON = pressed(2, 25, 0.46, "cast-iron")
OWN = pressed(2, 20, 0.247, ((0, 0.40), (60, 0.35), (90, 0.28)))
BRAKES = {
    "cast iron, ramped": (f"{IRON}, {RAMP}", Brake(CAST_IRON, ramp(4.0), (4.0,))),
    "cast iron, P": (f"{IRON}, application: P", Brake(CAST_IRON, filling(4.0))),
    "K blocks, ramped": (f"{COMPOSITE}, {RAMP}", Brake(pressed(1, 30, 0.46, "composite"), ramp(4.0), (4.0,))),
    "discs, late": (f"{DISCS}, {LATE}", Brake(OWN, filling(5.0, 1.0, 0.2), (1.0,))),
}


@pytest.mark.parametrize("name", BRAKES)
def test_a_brake_that_builds_up_and_fades(stop, name):
    keys, brake = BRAKES[name]
    ours = stop("paper_80_solid", *RIGID, f"braking={{initial_speed: 100 km/h, onset: 0.5 s, {keys}}}")
    theirs = second_stop(ours.scenario, brake, ours.time)
    assert not theirs.changes
    assert theirs.time.size >= ours.time.size - 1
    found = deviations(ours, theirs)
    assert max(found.values()) < 1e-3, found
    assert ours.braking_distance_m == pytest.approx(theirs.distance, rel=1e-6)


def test_cast_iron_locks_wheels_towards_the_stop(stop):
    """Blocks of a loaded wagon on poor adhesion: torque grows as speed falls, and the lock comes late."""
    keys, brake = BRAKES["cast iron, ramped"]
    words = ("contact.adhesion=0.1", f"braking={{initial_speed: 100 km/h, onset: 0.5 s, {keys}}}")
    ours = stop("paper_80_solid", *RIGID, *words)
    theirs = second_stop(ours.scenario, brake, ours.time, rtol=1e-7)
    found = deviations(ours, theirs)
    assert max(found.values()) < 1e-3, found
    assert ours.braking_distance_m == pytest.approx(theirs.distance, rel=1e-6)
    assert len([one for one in theirs.changes if one[2]]) == sum(seconds > 0 for seconds in ours.locked_time_s) > 0
    assert min(at for at, _, _ in theirs.changes) > 0.5 * ours.time[-1]
