"""Wheels that lock: a set-valued friction torque, transmitted as `f R`, without chatter (theory section 8)."""

import numpy as np
import pytest

WHEELS = (1, 2, 3, 4)
RADIUS = 0.46
EVERY_MS = "output.interval=1 ms"
CASES = {
    "dry, four lock": ("paper_160_solid", "braking.torque=20 kN m"),
    "wet": ("paper_80_solid", "contact.adhesion=wet", "braking.torque=15 kN m"),
    "liquid": ("paper_160", "braking.torque=17.5 kN m"),
    "far too strong": ("paper_80_solid", "braking.torque=45 kN m"),
    "lifting": ("paper_80", "braking.torque=15 kN m"),
}


@pytest.fixture(scope="module", params=CASES, ids=str)
def case(request, stop):
    name, *overrides = CASES[request.param]
    return stop(name, *overrides, EVERY_MS)


def of_wheels(result, quantity):
    """Channel of all wheels (4, n) from the onset on; the row at the onset itself is still without torque."""
    braking = result.time > result.onset_s + 1e-9
    return np.array([result.channels[f"wheel_{i}_{quantity}"][braking] for i in WHEELS])


def locked(result):
    return of_wheels(result, "speed") == 0.0


def switches(result):
    """Times at which each wheel locks or turns again; list of four arrays."""
    time = result.time[result.time > result.onset_s + 1e-9]
    return [time[1:][np.diff(state.astype(int)) != 0] for state in locked(result)]


def test_a_wheel_turns_or_has_exactly_no_speed(case):
    rolling = of_wheels(case, "speed")
    assert rolling.min() == 0.0
    turning = rolling > 0.0
    assert np.mean(rolling[turning] < 1e-3) < 1e-2  # no creeping near zero instead of a lock


def test_locked_wheel_transmits_what_holds_it(case):
    """`f R`, at most T: with the nominal torque on the bogie a tenth of a locked distance would be wrong."""
    torque, creep = of_wheels(case, "brake_torque"), of_wheels(case, "tangential_force")
    held = locked(case)
    assert torque[held] == pytest.approx(creep[held] * RADIUS, rel=1e-12, abs=1e-9)
    assert np.all(torque[held] <= case.torque_N_m)
    assert np.mean(torque[held]) < 0.9 * case.torque_N_m


def test_turning_wheel_feels_the_whole_torque(case):
    assert np.all(of_wheels(case, "brake_torque")[~locked(case)] == case.torque_N_m)


def test_nothing_is_transmitted_before_the_onset(case):
    for wheel in WHEELS:
        assert np.all(case.channels[f"wheel_{wheel}_brake_torque"][case.time < case.onset_s] == 0.0)


def test_wheels_do_not_chatter(case):
    """Lock, release near the end, perhaps lock again: a handful of switches, not hundreds."""
    for times in switches(case):
        assert times.size <= 4
        assert np.all(np.diff(times) > 0.05)
    assert case.work["events"] < 60


def test_locked_times_are_those_of_the_history(case):
    seconds = locked(case).sum(axis=1) * 1e-3
    assert case.locked_time_s == pytest.approx(seconds, abs=5e-3)


def test_wheel_turns_again_when_the_creep_force_outgrows_the_torque(stop):
    """Friction grows as the wagon slows down: the release comes when `f R` reaches T, and then the wheel speeds up."""
    name, *overrides = CASES["dry, four lock"]
    result = stop(name, *overrides, EVERY_MS)
    held, torque, rolling = locked(result), of_wheels(result, "brake_torque"), of_wheels(result, "speed")
    released = 0
    for wheel in range(4):
        for row in np.flatnonzero(held[wheel, :-1] & ~held[wheel, 1:]):
            released += 1
            assert torque[wheel, row] > 0.98 * result.torque_N_m
            assert np.all(np.diff(rolling[wheel, row : row + 10]) > 0)
    assert released >= 1


def test_a_held_wheel_stays_held_below_its_torque(case):
    """While locked, `f R < T` at every recorded instant but within a step of the release."""
    held, torque = locked(case), of_wheels(case, "brake_torque")
    inside = held.copy()
    inside[:, :-2] &= held[:, 1:-1] & held[:, 2:]
    assert np.all(torque[inside] < case.torque_N_m)


def test_wheel_locks_where_torque_beats_adhesion(stop):
    """Rigid, dry, 80 km/h: the peak of Polach's curve on the least loaded wheel decides; 10 kN m none, 15 some."""
    assert max(stop("paper_80_solid", "braking.torque=10 kN m").locked_time_s) == 0.0
    some = stop("paper_80_solid", "braking.torque=15 kN m").locked_time_s
    assert some[0] == some[2] == 0.0  # the leading wheels carry more
    assert min(some[1], some[3]) > 5.0


FORK = ("paper_160_solid", "braking.initial_speed=150 km/h")


def test_locked_distances_of_the_fork(stop):
    """Theory section 11: rigid, 150 km/h, dry: 334 m at 19.6 kN m with three wheels locked, 388 m at 20 with four."""
    short, long = stop(*FORK, "braking.torque=19.6 kN m"), stop(*FORK, "braking.torque=20 kN m")
    assert short.braking_distance_m == pytest.approx(334.0, abs=0.5)
    assert long.braking_distance_m == pytest.approx(388.0, abs=0.5)
    assert [seconds > 0 for seconds in short.locked_time_s] == [False, True, True, True]
    assert min(long.locked_time_s) > 10.0


def test_locked_wagon_slides_like_a_block(stop):
    """All wheels locked before long: `m dV/dt = -8 f(V) - resistance`, and no rotating mass any more."""
    result = stop("paper_80_solid", "braking.torque=35 kN m", EVERY_MS)
    c, sliding = result.channels, (result.time > 1.0) & (result.time < 9.5)
    mass = 21.3e3 + 2 * 1.8e3 + 4 * 1.4e3 + 830 * 15.5 * np.pi * 1.5**2 / 2
    V, time = c["speed"][sliding], result.time[sliding]
    assert V[-1] > 1.0
    # Polach's dry law, fully sliding: creepage 1; the check numbers of theory section 7 give the ellipse
    mu = 0.55 * (0.6 * np.exp(-0.6 * V) + 0.4)
    deceleration = (851 + 13.5 * V + 1.244 * V**2) / mass
    for wheel in WHEELS:
        assert np.all(c[f"wheel_{wheel}_speed"][sliding] == 0.0)
        N = c[f"wheel_{wheel}_normal_force"][sliding]
        eps = 210e9 / 2.6 * np.pi * 7.0e-3 * 5.3e-3 * (N / 93e3) ** (2 / 3) * 4.12 / (4 * mu * N)
        force = 2 * mu * N / np.pi * (eps / (1 + eps**2) + np.arctan(0.4 * eps))
        deceleration = deceleration + 2 * force / mass
    assert V[0] - V[-1] == pytest.approx(np.trapezoid(deceleration, time), rel=1e-3)


@pytest.mark.parametrize("torque", [50, 60, 80, 120, 500])
def test_wheels_that_lift_and_land_hard_do_not_end_the_run(stop, torque):
    """A torque far beyond adhesion throws the bogies about; wheels land at metres a second and the run goes on."""
    result = stop("paper_80_solid", f"braking.torque={torque} kN m")
    assert result.status in ("stopped", "pitch-limit"), result.reason
    assert min(result.min_wheel_load_N) == 0.0
    assert result.energy_residual < 1e-3


def test_torque_without_speed_never_drives_a_wheel_back(stop):
    """Onset at the very start, a stop speed far below the creepage floor, a torque beyond all measure."""
    result = stop(
        "paper_80_solid",
        "braking.initial_speed=2 m/s",
        "braking.onset=0 s",
        "braking.stop_speed=1e-4 m/s",
        "braking.torque=1000 kN m",
    )
    assert result.status == "stopped"
    assert min(of_wheels(result, "speed").ravel()) == 0.0
    assert result.channels["speed"].min() >= 0.9e-4
    assert result.braking_time_s == pytest.approx(result.time[-1])
