"""Each vehicle of a train meets the line where it is: histories and motion (theory sections 14 to 16)."""

import numpy as np
import pytest

from slosh_cli.results.simulate import simulate_train
from slosh_cli.scenario.train_file import load_train

UP, FROM, TO = 0.01, 100.0, 101.0
FREE = (
    "{tank.liquid.model: rigid, wagon.length_over_buffers: 20 m, "
    "wagon.running_resistance: {constant: 0 N, linear: 0 N s/m, quadratic: 0 N s^2/m^2}"
)
TRAIN = f"""\
format: 1
name: hill
vehicles:
  - {{scenario: tank-wagon, set: {FREE}, track.gradient: [[{FROM} m, 0], [{TO} m, {UP}]]}}}}
  - {{scenario: tank-wagon, count: 2, set: {FREE}}}}}
coupling: {{linear: {{stiffness: 0 N/m}}}}
braking: {{initial_speed: 72 km/h, onset: 9.9 s, stop_speed: 1 m/s}}
solver: {{time_limit: 10 s}}
output: {{interval: 10 ms}}
"""


@pytest.fixture(scope="module")
def hill(tmp_path_factory):
    """Three vehicles that know nothing of each other roll from the level onto a slope of 1 %."""
    file = tmp_path_factory.mktemp("hill") / "hill.yaml"
    file.write_text(TRAIN, encoding="utf-8")
    return simulate_train(load_train(file))


def test_each_vehicle_begins_to_climb_at_its_own_time(hill):
    """At 20 m/s and with 20 m between them, one second after the other."""
    for number, vehicle in enumerate(hill.vehicles):
        gradient, speed = vehicle.channels["line_gradient"], vehicle.channels["speed"]
        begun = hill.time[np.flatnonzero(gradient > 0.0)[0]]
        assert begun == pytest.approx(FROM / 20.0 + number, abs=0.015)
        level = hill.time < begun
        assert speed[level] == pytest.approx(20.0, abs=5e-3)
        climbs = np.flatnonzero((gradient == UP) & (hill.time < 9.5))
        slowing = np.polyfit(hill.time[climbs], speed[climbs], 1)[0]
        assert 0.95 < -slowing / (9.80665 * UP) < 1.0  # wheels turn


def test_heights_are_those_of_the_line_under_each_vehicle(hill):
    for number, vehicle in enumerate(hill.vehicles):
        along = vehicle.channels["position"] - 20.0 * number
        climbed = np.where(along > TO, (along - 0.5 * (FROM + TO)) * UP, 0.0)
        outside = (along < FROM) | (along > TO)
        assert vehicle.channels["line_height"][outside] == pytest.approx(climbed[outside], abs=1e-9)
