"""What every run is held to: the energy ledger, the weight, the wheels' speeds (theory section 9; acceptance)."""

import numpy as np
import pytest

WHEELS = (1, 2, 3, 4)
SHIPPED = ["paper_80", "paper_80_solid", "paper_160", "paper_160_solid"]
LOCKING = [
    ("paper_160_solid", "braking.torque=20 kN m"),
    ("paper_160", "braking.torque=17.5 kN m"),
    ("paper_160_solid", "contact.adhesion=wet", "braking.torque=30 kN m"),
    ("paper_80_solid", "contact.adhesion=wet", "braking.torque=25 kN m"),
    ("paper_80", "contact.adhesion=wet", "braking.torque=15 kN m"),
    ("paper_80", "braking.torque=10 kN m", "tank.coefficients=computed"),
]
LIFTING = [
    ("paper_80", "braking.torque=15 kN m"),
    ("paper_80", "braking.torque=25 kN m"),
    ("paper_80", "braking.torque=22.5 kN m", "tank.coefficients=computed"),
    (  # a rigid load lifts wheels only on a short wagon that is hard to brake
        "paper_80_solid",
        "wagon.pivot_spacing=5.2 m",
        "wagon.primary_suspension.stiffness=8e5 N/m",
        "braking.torque=40 kN m",
        "contact.adhesion={mu0: 0.9, A: 0.7, B: 0.3 s/m, kA: 1.0, kS: 0.6}",
    ),
]
FINE = ("track.domain.element_length=0.25 m", "solver.tolerance=1e-6")
QUICK_TIGHT = [("paper_80",), ("paper_80_solid",), LOCKING[3]]
SLOW_TIGHT = [("paper_160",), ("paper_160_solid",), *(case for case in LOCKING if case not in QUICK_TIGHT)]


def of_wheels(result, quantity):
    return np.array([result.channels[f"wheel_{i}_{quantity}"] for i in WHEELS])


def check_wheels(result):
    """No wheel turns backwards, none faster than V(1 + 1e-4), no tension, nothing non-finite."""
    braking = result.time >= result.onset_s
    rolling = of_wheels(result, "speed")[:, braking]
    assert rolling.min() >= 0.0
    assert np.all(rolling <= result.channels["speed"][braking] * (1 + 1e-4))
    assert of_wheels(result, "normal_force").min() >= 0.0
    assert min(result.min_wheel_load_N) >= 0.0
    for name, values in result.channels.items():
        assert np.all(np.isfinite(values)), name
    assert np.all(np.diff(result.time) > 0)


def check_weight(result):
    """Sum of the wheel loads averaged over the stop; braking_time_s and both rails."""
    assert result.mean_total_wheel_load_N == pytest.approx(result.weight_N, rel=1e-5)


@pytest.mark.parametrize("case", [(name,) for name in SHIPPED] + LOCKING, ids=" ".join)
def test_ledger_closes_at_default_tolerance(stop, case):
    """Acceptance: to 1e-4 of the initial kinetic energy, in every shipped scenario and with locking wheels."""
    result = stop(*case)
    assert result.status == "stopped"
    assert result.energy_residual < 1e-4
    assert np.abs(result.channels["energy_residual"]).max() <= result.energy_residual
    assert (max(result.locked_time_s) > 1.0) == (len(case) > 1)
    check_wheels(result)
    check_weight(result)


LIGHT = (
    "paper_80_solid", "contact.adhesion=wet", "tank.fill=0.02", "track.foundation.stiffness=7e7 N/m^2",
    "wagon.primary_suspension.stiffness=5e6 N/m", "wagon.primary_suspension.damping=4e4 N s/m",
)  # fmt: skip


@pytest.mark.parametrize("speed", [20, 27, 35, 50])
def test_short_stop_of_a_light_wagon_on_a_stiff_track_closes_too(stop, speed):
    """Nothing shakes there, so that only what a step may take from the speed keeps the steps short."""
    case = (*LIGHT, f"braking.initial_speed={speed} km/h", "braking.torque=7 kN m")
    result, fine = stop(*case), stop(*case, "solver.tolerance=1e-6")
    assert min(result.min_wheel_load_N) > 0.0
    assert result.energy_residual < 1e-4
    assert result.braking_distance_m == pytest.approx(fine.braking_distance_m, rel=6e-5)


def tight(stop, case):
    result = stop(*case, *FINE)
    assert result.status == "stopped"
    assert result.energy_residual < 1e-6
    check_wheels(result)
    check_weight(result)


@pytest.mark.parametrize("case", QUICK_TIGHT, ids=" ".join)
def test_ledger_closes_at_tight_tolerance(stop, case):
    """Acceptance: to 1e-6 at tight tolerance with 0.25 m elements."""
    tight(stop, case)


@pytest.mark.slow
@pytest.mark.parametrize("case", SLOW_TIGHT, ids=" ".join)
def test_ledger_closes_at_tight_tolerance_in_every_other_stop(stop, case):
    tight(stop, case)


@pytest.mark.parametrize("case", LIFTING, ids=["dry 15", "dry 25", "computed 22.5", "short and rigid"])
def test_ledger_closes_with_wheels_lifting_and_the_run_says_so(stop, case):
    """Acceptance: to 1e-3, and a warning; the largest wheel load of an undamped contact does not converge then."""
    result = stop(*case)
    assert result.status in ("stopped", "pitch-limit")
    assert min(result.min_wheel_load_N) == 0.0
    assert result.max_wheel_unloading == 1.0
    assert result.energy_residual < 1e-3
    assert any("lifted" in warning and "max_wheel_load_N" in warning for warning in result.warnings)
    check_wheels(result)


@pytest.mark.parametrize("case", [(name,) for name in SHIPPED] + LOCKING[:2], ids=" ".join)
def test_wheels_that_stay_down_are_not_said_to_lift(stop, case):
    result = stop(*case)
    assert min(result.min_wheel_load_N) > 0.0
    assert not any("lifted" in warning for warning in result.warnings)


UNDAMPED = ("track.foundation.damping=0 N s/m^2", "track.foundation.shear_damping=0 N s")
HARD_AND_LIGHT = ("paper_80_solid", "tank.fill=0.02", "braking.torque=60 kN m", "braking.initial_speed=30 km/h")


def test_wheels_that_land_on_a_track_without_damping_give_no_distance(stop):
    """What landings put into such a rail stays in it: the distance would follow the tolerance, not the wagon."""
    result = stop(*HARD_AND_LIGHT, *UNDAMPED)
    assert max(c.value for c in result.checks if c.name == "wheels lifted off") > 100
    assert result.status == "failed"
    assert result.braking_distance_m is None
    assert "track.foundation.damping" in result.reason
    assert "tolerance" not in f"{result.reason} {result.status.remedy}"


@pytest.mark.parametrize("tolerance", ["1e-2", "1e-3", "1e-4"])
def test_wheels_that_land_on_a_track_with_damping_give_a_distance(stop, tolerance):
    """The same wagon on the paper's own track: the ledger closes, and the distance is within the tolerance."""
    result, fine = (
        stop(*HARD_AND_LIGHT, f"solver.tolerance={tolerance}"),
        stop(*HARD_AND_LIGHT, "solver.tolerance=1e-6"),
    )
    assert min(fine.min_wheel_load_N) == 0.0
    assert result.status == fine.status == "stopped"
    assert fine.energy_residual < 1e-6
    assert result.braking_distance_m == pytest.approx(fine.braking_distance_m, rel=float(tolerance))


def test_few_lifts_on_a_track_without_damping_do_no_harm(stop):
    """Two lift-offs of a light wagon: what they leave in the rail is far less than the tolerance."""
    case = ("paper_80_solid", "tank.fill=0.02", "braking.torque=15 kN m", "braking.initial_speed=30 km/h", *UNDAMPED)
    result, fine = stop(*case), stop(*case, "solver.tolerance=1e-5")
    assert min(result.min_wheel_load_N) == 0.0
    assert result.status == "stopped"
    assert result.braking_distance_m == pytest.approx(fine.braking_distance_m, rel=1e-4)


def test_lifted_wheel_carries_and_brakes_nothing(stop):
    result = stop(*LIFTING[0], "output.interval=1 ms")
    normal, creep = of_wheels(result, "normal_force"), of_wheels(result, "tangential_force")
    gap = of_wheels(result, "heave") - of_wheels(result, "rail_deflection")
    apart = gap > 1e-9
    assert apart.any()
    assert np.all(normal[apart] == 0.0)
    assert np.all(creep[apart] == 0.0)
    assert np.all(normal[gap < -1e-9] > 0.0)


def test_vertical_impulse_balances_with_wheels_lifting(stop):
    """The mean wheel load differs from the weight by what the bodies' upward momentum changed, and no more."""
    result = stop(*LIFTING[0], "output.interval=1 ms")
    c, rows = result.channels, result.time >= 0.5
    load = 830 * 15.5 * np.pi * 1.5**2 / 2
    momentum = (21.3e3 + load) * c["car_heave"] + 1.8e3 * (c["bogie_1_heave"] + c["bogie_2_heave"])
    momentum = momentum + 1.4e3 * of_wheels(result, "heave").sum(axis=0)
    rise = np.gradient(momentum, result.time, edge_order=2)[rows]
    impulse = (result.mean_total_wheel_load_N - result.weight_N) * result.braking_time_s
    assert abs(impulse) > 1e-5 * result.weight_N * result.braking_time_s
    assert impulse == pytest.approx(rise[-1] - rise[0], abs=2e-6 * result.weight_N * result.braking_time_s)
