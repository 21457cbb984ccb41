"""Wheel loads at rest and in steady braking, by hand statics (theory sections 1, 2 and 8)."""

import numpy as np
import pytest
from plain_lagrangian import half_full_cylinder

from slosh_cli.solver.setup import problem

WHEELS = (1, 2, 3, 4)
LOAD_MASS = 830 * 15.5 * np.pi * 1.5**2 / 2
LOAD_HEIGHT = 1.15 + 1.5 - 4 * 1.5 / (3 * np.pi)
WEIGHT = 9.81 * (21.3e3 + 2 * 1.8e3 + 4 * 1.4e3 + LOAD_MASS)
RADIUS, TRACTION, WHEELBASE, PIVOTS = 0.46, 0.90, 1.8, 12.0
BRAKED = ("paper_160_solid", "braking.torque=10 kN m", "solver.tolerance=1e-5")


def of_wheels(result, quantity):
    return np.array([result.channels[f"wheel_{i}_{quantity}"] for i in WHEELS])


def mean(result, values, begin, end):
    rows = (result.time >= begin) & (result.time <= end)
    return np.trapezoid(values[..., rows], result.time[rows], axis=-1) / np.ptp(result.time[rows])


class Statics:
    """Steady braking of one rail's half, averaged over a window: bodies cut free one after another."""

    def __init__(self, result, begin, end):
        self.deceleration = -mean(result, result.channels["car_acceleration"], begin, end)
        self.torque = mean(result, of_wheels(result, "brake_torque"), begin, end)
        self.pitch = mean(result, result.channels["car_pitch"], begin, end)
        self.loads = mean(result, of_wheels(result, "normal_force"), begin, end)
        self.resistance = mean(result, 851 + 13.5 * (v := result.channels["speed"]) + 1.244 * v**2, begin, end) / 2

    @property
    def hand_loads(self):
        """Wheel loads: the car tips about the height where the bogies hold it, the bogies about their axles."""
        a, car, load, bogie = self.deceleration, 21.3e3 / 2, LOAD_MASS / 2, 1.8e3 / 2
        tilt = load * 9.81 * (LOAD_HEIGHT - 1.15) * self.pitch  # the load's centre moves off its support
        tipping = a * (car * (2.2 - TRACTION) + load * (LOAD_HEIGHT - TRACTION)) + tilt
        push = a * (car + load) / 2  # of the car on each bogie, forward, at the traction height
        loads = []
        for sign, (lead, trail) in ((1, (0, 1)), (-1, (2, 3))):
            on_bogie = WEIGHT / 4 + sign * tipping / PIVOTS
            turning = self.torque[lead] + self.torque[trail] + push * (TRACTION - RADIUS) + bogie * a * (0.55 - RADIUS)
            loads += [on_bogie / 2 + turning / WHEELBASE, on_bogie / 2 - turning / WHEELBASE]
        return np.array(loads)

    @property
    def whole_moment(self):
        """Moment of the wheel loads about the wagon's middle, from all masses and spins at once, half a wagon.

        Running resistance acts at the axles. Nothing here knows of bogies, traction height or torque.
        """
        masses = np.array([21.3e3, LOAD_MASS, 2 * 1.8e3, 4 * 1.4e3]) / 2
        heights = np.array([2.2, LOAD_HEIGHT, 0.55, RADIUS])
        spin = 4 * 60.0 / RADIUS
        tilt = LOAD_MASS / 2 * 9.81 * (LOAD_HEIGHT - 1.15) * self.pitch
        return self.deceleration * (masses @ heights + spin) - RADIUS * self.resistance + tilt


@pytest.mark.parametrize("name", ["paper_80", "paper_160_solid"])
def test_wagon_at_rest_stands_evenly(stop, name):
    result = stop(name)
    assert result.weight_N == pytest.approx(WEIGHT, rel=1e-12)
    assert sum(result.static_wheel_load_N) == pytest.approx(WEIGHT / 2, rel=1e-12)
    assert result.static_wheel_load_N == pytest.approx([WEIGHT / 8] * 4, rel=1e-6)


def test_heaves_at_rest_are_those_of_springs_in_series(shipped):
    start = problem(shipped("paper_80", "braking.initial_speed=0.1 m/s")).vehicle.points[0]
    car, bogie, wheel = start.q[1], start.q[3], start.q[7:9].mean()
    above_bogie = 9.81 * (21.3e3 + LOAD_MASS) / 4
    assert bogie - car == pytest.approx(above_bogie / 6.0e6, rel=1e-6)
    assert wheel - bogie == pytest.approx((above_bogie + 9.81 * 1.8e3 / 2) / 2 / 2.6e6, rel=1e-6)
    approach = (WEIGHT / 8 / 9.413e10) ** (2 / 3)
    contact = problem(shipped("paper_80")).vehicle.rail.contact
    assert start.rail[contact] - start.q[7:11] == pytest.approx(approach, rel=1e-3)
    assert abs(start.q[2]) < 1e-9  # no pitch but what the rail's lag makes


STEADY = (
    "paper_160_solid",
    "braking.torque=0 N m",
    "wagon.running_resistance.constant=0 N",
    "wagon.running_resistance.linear=0 N s/m",
    "wagon.running_resistance.quadratic=0 N s^2/m^2",
    "solver.time_limit=5 s",
)


def test_wagon_that_nothing_disturbs_rolls_on_for_ever(stop):
    """The initial state is the steady state: rail shape at V0, springs, contacts."""
    result = stop(*STEADY)
    assert result.status == "time-limit"
    assert result.channels["speed"] == pytest.approx(160 / 3.6, rel=1e-12)
    assert result.channels["position"] == pytest.approx(160 / 3.6 * result.time, rel=1e-12, abs=1e-9)
    assert of_wheels(result, "normal_force") == pytest.approx(WEIGHT / 8, rel=1e-6)
    for wheel, normal in zip(WHEELS, of_wheels(result, "normal_force"), strict=True):
        assert np.ptp(normal) < 1e-6 * WEIGHT, wheel
    assert np.abs(of_wheels(result, "tangential_force")).max() < 1e-3


def test_slope_work_of_steady_rolling_feeds_the_foundation(stop):
    """What the wheels climb is what the foundation's dampers take (theory section 9); the speed does not know it."""
    result = stop(*STEADY)
    climbed, taken = (result.channels[f"energy_{name}"] for name in ("slope_work", "foundation"))
    assert climbed[-1] > 100.0
    assert climbed == pytest.approx(taken, rel=1e-4)  # and finer elements come closer, as h^4
    finer = stop(*STEADY, "track.domain.element_length=0.25 m").channels
    gaps = [
        abs(work / lost - 1)
        for work, lost in ((climbed[-1], taken[-1]), (finer["energy_slope_work"][-1], finer["energy_foundation"][-1]))
    ]
    assert gaps[0] / gaps[1] > 10


@pytest.mark.parametrize("window", [(8.0, 12.0), (14.0, 18.0)])
def test_steady_braking_shifts_wheel_loads_as_hand_statics_say(stop, window):
    """Mid-stop, rigid load, 10 kN m: to a newton of 15 to 25 kN moved (a per cent was asked for)."""
    statics = Statics(stop(*BRAKED), *window)
    expected = statics.hand_loads
    transfer = np.abs(expected - WEIGHT / 8)
    assert transfer.min() > 15e3
    assert np.abs(statics.loads - expected).max() < 1.0


@pytest.mark.parametrize("window", [(8.0, 12.0), (14.0, 18.0)])
def test_moment_of_the_wheel_loads_balances_the_whole_wagon(stop, window):
    statics = Statics(stop(*BRAKED), *window)
    arms = np.array([6.9, 5.1, -5.1, -6.9])
    assert statics.loads @ arms == pytest.approx(statics.whole_moment, rel=1e-4)
    assert statics.loads.sum() == pytest.approx(WEIGHT / 2, rel=1e-5)


def test_brakes_pitch_the_bogies_nose_down_and_load_their_leading_wheels(stop):
    result = stop(*BRAKED)
    braking = (result.time > 1.0) & (result.time < 20.0)
    for bogie, (lead, trail) in ((1, (0, 1)), (2, (2, 3))):
        assert np.all(result.channels[f"bogie_{bogie}_pitch"][braking] > 0)
        normal = of_wheels(result, "normal_force")[:, braking]
        assert np.all(normal[lead] > WEIGHT / 8)
        assert np.all(normal[trail] < WEIGHT / 8)
    assert np.all(result.channels["car_pitch"][braking] > 0)


def test_load_of_these_statics_is_that_of_the_half_cylinder(shipped):
    load = half_full_cylinder(shipped("paper_160_solid"))
    assert (load.mass, load.centre) == pytest.approx((LOAD_MASS, LOAD_HEIGHT - 1.15), rel=1e-12)
