"""How a run can end, and that what it says about it is consistent (theory section 8)."""

import numpy as np
import pytest

QUIET = (
    "wagon.running_resistance.linear=0 N s/m",
    "wagon.running_resistance.quadratic=0 N s^2/m^2",
)
MASS = 21.3e3 + 2 * 1.8e3 + 4 * 1.4e3 + 830 * 15.5 * np.pi * 1.5**2 / 2 + 4 * 120 / 0.46**2


def test_stop_is_the_first_passage_of_the_stop_speed(stop):
    for speed in ("20 m/s", "0.02 m/s", "1e-4 m/s"):
        result = stop("paper_80_solid", f"braking.stop_speed={speed}", "output.interval=1 ms")
        assert result.status == "stopped"
        limit = float(speed.split()[0])
        assert result.channels["speed"][-1] == pytest.approx(limit, abs=1e-6)
        assert np.all(result.channels["speed"][:-1] > limit - 1e-6)
        onset = np.argmin(np.abs(result.time - 0.5))
        gone = result.channels["position"][-1] - result.channels["position"][onset]
        assert result.braking_distance_m == pytest.approx(gone, rel=1e-9)
        assert result.braking_time_s == pytest.approx(result.time[-1] - 0.5, abs=1e-12)


def test_running_resistance_alone_stops_a_slow_wagon(stop):
    """Without torque: constant resistance on mass and rotating mass."""
    result = stop("paper_80_solid", *QUIET, "braking.initial_speed=2 m/s", "braking.torque=0 N m")
    assert result.status == "stopped"
    deceleration = 851 / MASS
    at_onset = 2.0 - deceleration * 0.5
    assert result.braking_time_s == pytest.approx((at_onset - 0.02) / deceleration, rel=1e-6)
    assert result.braking_distance_m == pytest.approx((at_onset**2 - 0.02**2) / (2 * deceleration), rel=1e-6)


def test_time_limit_ends_a_run_where_it_stands(stop):
    whole, cut = stop("paper_80"), stop("paper_80", "solver.time_limit=3 s")
    assert cut.status == "time-limit"
    assert cut.braking_distance_m is None
    assert cut.braking_time_s is None
    assert cut.reason
    assert cut.time[-1] == pytest.approx(3.0, abs=1e-9)
    row = np.argmin(np.abs(whole.time - 3.0))
    assert cut.channels["position"][-1] == pytest.approx(whole.channels["position"][row], rel=1e-5)


def test_run_at_the_pitch_limit_ends_at_a_tenth_of_a_radian(stop):
    """Theory section 9: small-angle kinematics say nothing beyond."""
    result = stop("paper_160", "braking.torque=20 kN m")
    assert result.status == "pitch-limit"
    assert result.braking_distance_m is None
    assert "0.1 rad" in result.reason
    pitches = np.array([result.channels[name] for name in ("car_pitch", "bogie_1_pitch", "bogie_2_pitch")])
    assert np.abs(pitches[:, -1]).max() == pytest.approx(0.1, abs=1e-5)
    assert np.abs(pitches[:, :-1]).max() < 0.1


@pytest.mark.parametrize(
    "overrides",
    [
        ("braking.initial_speed=0.5 m/s", "braking.onset=100 s"),  # coasts to rest before the brakes set in
        ("braking.initial_speed=0.03 m/s", "braking.torque=20 kN m"),
        ("solver.time_limit=0.3 s", "braking.onset=0.2 s"),
        ("braking.initial_speed=0.1 m/s",),
    ],
    ids=lambda overrides: overrides[0],
)
def test_a_run_that_stopped_has_a_distance_and_any_other_a_reason(stop, overrides):
    result = stop("paper_80", *overrides)
    assert (result.status == "stopped") == (result.braking_distance_m is not None)
    assert (result.status == "stopped") == (result.braking_time_s is not None)
    assert (result.status == "stopped") == (result.reason == "")
