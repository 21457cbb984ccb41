"""Output between steps: the integrator's own interpolation, not steps made small for it."""

import numpy as np
import pytest

WHEELS = (1, 2, 3, 4)
STOPS = {
    "liquid": ("paper_80",),
    "rigid": ("paper_80_solid",),
    "locking": ("paper_160_solid", "braking.torque=20 kN m"),
    "wet liquid": ("paper_80", "contact.adhesion=wet", "braking.torque=15 kN m"),
}


@pytest.fixture(scope="module", params=STOPS)
def pair(request, stop):
    """A run at the default tolerance and the same at 1e-6, at the same instants."""
    return stop(*STOPS[request.param]), stop(*STOPS[request.param], "solver.tolerance=1e-6")


def of_wheels(result, quantity, rows):
    return np.array([result.channels[f"wheel_{i}_{quantity}"][:rows] for i in WHEELS])


def common_rows(pair):
    """Rows that both runs have at multiples of the interval."""
    rows = min(result.time.size for result in pair) - 1
    assert np.array_equal(pair[0].time[:rows], pair[1].time[:rows])
    return rows


def test_most_rows_lie_between_steps(pair):
    default, _ = pair
    assert default.time.size > 1.2 * default.steps or default.steps > 1000


def test_rows_come_at_the_interval_and_the_last_at_the_end(pair):
    for result in pair:
        assert result.time[:-1] == pytest.approx(0.01 * np.arange(result.time.size - 1), abs=1e-12)
        assert result.time[-1] == pytest.approx(result.onset_s + result.braking_time_s, abs=1e-9)
        assert result.channels["speed"][-1] == pytest.approx(0.02, abs=2e-6)
        assert result.channels["position"][-1] > result.channels["position"][-2]


def test_wheel_loads_between_steps_are_right(pair):
    """Within 0.3 kN of a run at 1e-6, away from switches, whose instants differ by a little between the two."""
    rows = common_rows(pair)
    time, (rough, fine) = pair[0].time[:rows], (of_wheels(result, "normal_force", rows) for result in pair)
    rolling = of_wheels(pair[1], "speed", rows) > 0
    switched = time[1:][np.any(np.diff(rolling.astype(int), axis=1) != 0, axis=0)]
    calm = np.all(np.abs(time[:, None] - np.array([0.5, *switched])) > 0.05, axis=1)
    assert calm.mean() > 0.9
    assert np.abs(rough - fine)[:, calm].max() < 300.0
    assert np.abs(rough - fine).max() < 1000.0


def test_positions_between_steps_are_right(pair):
    rows = common_rows(pair)
    rough, fine = (result.channels["position"][:rows] for result in pair)
    assert np.abs(rough - fine).max() < 1e-4 * fine[-1]


MOTIONS = {"acceleration": 0.01, "car_acceleration": 0.01, "bogie_1_pitch": 0.01, "car_pitch": 0.05, "car_heave": 0.05}
"""Share of the channel's own range; a rigid load's pitch and heave are tenths of a milliradian and micrometres."""


@pytest.mark.parametrize("channel", MOTIONS)
def test_other_motions_between_steps_are_right(pair, channel):
    """At 98 of 100 rows; the rest lie beside locks, whose instants differ between the two."""
    rows = common_rows(pair)
    rough, fine = (result.channels[channel][:rows] for result in pair)
    assert np.quantile(np.abs(rough - fine), 0.98) < MOTIONS[channel] * np.ptp(fine)


def test_speed_is_the_derivative_of_position(stop):
    result = stop("paper_80", "output.interval=2 ms")
    c, middle = result.channels, slice(1, -2)
    for place, rate in (("position", "speed"), ("speed", "acceleration")):
        difference = (c[place][2:-1] - c[place][:-3]) / (result.time[2:-1] - result.time[:-3])
        late = result.time[middle] > 1.0
        scale = np.ptp(c[rate][middle])
        assert np.abs(difference - c[rate][middle])[late].max() < 2e-2 * scale


def test_interval_does_not_change_the_run(stop):
    """Steps are the same whatever is written: end, distance, extremes and ledger agree to the last digit."""
    coarse, fine = stop("paper_80", "output.interval=1 s"), stop("paper_80", "output.interval=1 ms")
    for name in ("braking_distance_m", "min_wheel_load_N", "max_wheel_load_N", "energy_residual", "steps"):
        assert getattr(coarse, name) == getattr(fine, name) == getattr(stop("paper_80"), name)
    every = fine.time.size - 1
    assert np.array_equal(coarse.time[:-1], fine.time[:every:1000])
    for name, values in coarse.channels.items():
        assert values[:-1] == pytest.approx(fine.channels[name][:every:1000], rel=1e-12, abs=1e-12), name


def test_interval_longer_than_the_run_leaves_first_and_last_row(stop):
    result = stop("paper_80", "output.interval=100 s")
    assert result.time == pytest.approx([0.0, stop("paper_80").time[-1]])
    assert result.channels["position"][-1] == pytest.approx(stop("paper_80").channels["position"][-1], rel=1e-12)


def test_extremes_are_at_least_those_of_the_rows(pair):
    """Extremes come from the steps, so they bracket the rows, and lie close to those of a fine record."""
    default, fine = pair
    braking = default.time >= 0.5
    loads = of_wheels(default, "normal_force", default.time.size)[:, braking]
    margin = 1e-3 * default.weight_N / 8
    assert np.all(np.array(default.min_wheel_load_N) <= loads.min(axis=1) + margin)
    assert np.all(np.array(default.max_wheel_load_N) >= loads.max(axis=1) - margin)
    assert default.min_wheel_load_N == pytest.approx(fine.min_wheel_load_N, abs=300.0)
    assert default.max_wheel_load_N == pytest.approx(fine.max_wheel_load_N, abs=300.0)


def test_onset_and_stop_are_step_ends(stop):
    """The brake sets in at its instant, whatever the step or the output interval."""
    for onset in ("0.5 s", "0.123456 s", "3.3333 s"):
        result = stop("paper_80_solid", f"braking.onset={onset}", "output.interval=1 ms")
        instant = float(onset.split()[0])
        torque = result.channels["wheel_1_brake_torque"]
        assert np.all(torque[result.time < instant - 1e-9] == 0.0)
        assert np.all(torque[result.time > instant + 1e-9] == 5e3)
        assert result.braking_time_s == pytest.approx(result.time[-1] - instant, abs=1e-12)
        at_onset = np.interp(instant, result.time, result.channels["position"])
        gone = result.channels["position"][-1] - at_onset
        assert result.braking_distance_m == pytest.approx(gone, abs=1e-5)
