"""The tank alone under a prescribed deceleration: against exact solutions, published peaks and interFoam."""

import math
from pathlib import Path

import numpy as np
import pytest
from tank_examples import cylinder

from slosh_cli.scenario import Liquid, Rectangular, load_tank_scenario
from slosh_cli.solver.excite import Deceleration, excite
from slosh_cli.tank.coefficients import slosh_modes
from slosh_cli.tank.load import frozen_load
from slosh_cli.validation.data_file import data_rows

ROOT = Path(__file__).parents[2]
LEVEL = 0.2 * 9.81


def shipped(name, *overrides):
    return load_tank_scenario(ROOT / "scenarios" / f"{name}.yaml", overrides).tank


def exact_accelerations(mode, deceleration, time):
    """Modal acceleration of an oscillator at rest whose tank is decelerated along a polygon of times and values.

    beta'' + 2 zeta omega beta' + omega^2 beta = (lambda_1/mu) a(t): every jump and every kink adds its own response,
    whose second derivatives are those of the unit step's (and, of a kink, its integral).
    """
    omega, zeta = mode.frequency, mode.damping_ratio
    damped = omega * math.sqrt(1.0 - zeta**2)

    def impulse(t):  # derivative of the step response; zero before t = 0
        later = np.maximum(t, 0.0)
        return np.exp(-zeta * omega * later) * np.sin(damped * later) / damped

    def step(t):  # second derivative of the step response
        later = np.maximum(t, 0.0)
        swing = np.cos(damped * later) - zeta * omega / damped * np.sin(damped * later)
        return np.where(t >= 0.0, np.exp(-zeta * omega * later) * swing, 0.0)

    times, values = deceleration.times, deceleration.values
    total = values[0] * step(time - times[0])
    for k in range(len(times) - 1):
        span = times[k + 1] - times[k]
        if span == 0.0:
            total += (values[k + 1] - values[k]) * step(time - times[k])
        else:
            slope = (values[k + 1] - values[k]) / span
            total += slope * (impulse(time - times[k]) - impulse(time - times[k + 1]))
    return mode.lambda_1 / mode.mu * total


JAGGED = Deceleration.table([(0.5, 0.0), (2.0, 1.5), (7.003, 1.5), (7.003, -0.8), (11.0, 0.2), (30.0, 0.7)])
COURSES = {
    "step": Deceleration.ramped(LEVEL),
    "ramp": Deceleration.ramped(LEVEL, 2.0),
    "odd ramp": Deceleration.ramped(LEVEL, 1.2345678),
    "table": JAGGED,
}


@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize(
    "tank",
    [
        shipped("kolaei_half"),
        shipped("kolaei_three_quarters", "tank.coefficients=computed", "tank.modes=5"),
        cylinder(liquid=Liquid(model="modal", density=998.2, damping_ratio=0.1)),
    ],
    ids=["given", "five modes", "damped"],
)
def test_the_force_is_within_a_millionth_of_the_exact_one(course, tank):
    found = excite(tank, COURSES[course], 40.0, 0.01)
    load = frozen_load(tank)
    force, moment = load.mass * found.deceleration, load.mass * load.centre_height * found.deceleration
    for mode in slosh_modes(tank):
        second = exact_accelerations(mode, COURSES[course], found.time)
        force = force - mode.lambda_1 * second
        moment = moment - mode.lambda_02 * second
        if mode.damping_ratio == 0.0:
            amplitude = (mode.lambda_1 / mode.mu * found.deceleration - second) / mode.frequency**2
            moment = moment + 9.81 * mode.lambda_1 * amplitude
    assert np.abs(found.force - force).max() < 1e-6 * np.abs(force).max()
    if all(mode.damping_ratio == 0.0 for mode in slosh_modes(tank)):
        assert np.abs(found.moment - moment).max() < 1e-6 * np.abs(moment).max()
    assert found.accuracy < 1e-6
    assert found.mass_error == 0.0


def test_steps_are_halved_until_the_history_settles(monkeypatch):
    """However coarse the first steps."""
    fine = excite(shipped("kolaei_half"), COURSES["ramp"], 10.0, 1.0)
    monkeypatch.setattr("slosh_cli.solver.excite.FIRST_PHASE", 2.0)
    coarse = excite(shipped("kolaei_half"), COURSES["ramp"], 10.0, 1.0)
    assert 0.0 < coarse.accuracy < 1e-7
    assert np.abs(coarse.force - fine.force).max() < 1e-7 * np.abs(fine.force).max()
    monkeypatch.setattr("slosh_cli.solver.excite.MOST_STEPS", 100)
    rough = excite(shipped("kolaei_half"), COURSES["ramp"], 10.0, 1.0)
    assert rough.accuracy > 1e-7
    assert 10.0 * rough.accuracy > np.abs(rough.force - fine.force).max() / np.abs(fine.force).max()


@pytest.mark.parametrize(
    ("name", "overrides", "ramp", "peak"),
    [
        ("kolaei_half", (), 0.0, 1.82),
        ("kolaei_three_quarters", (), 0.0, 1.71),
        ("kolaei_half", ("tank.coefficients=computed",), 2.0, 1.47),
        ("kolaei_three_quarters", ("tank.coefficients=computed",), 2.0, 1.29),
    ],
)
def test_peaks_of_step_and_ramp(name, overrides, ramp, peak):
    found = excite(shipped(name, *overrides), Deceleration.ramped(LEVEL, ramp))
    assert found.normalised_force.max() == pytest.approx(peak, abs=0.005)
    assert found.force.min() >= 0.0


def test_a_braked_tank_is_pushed_forward_nose_down_and_its_liquid_climbs_in_front():
    for model in ("modal", "shallow-water"):
        liquid = Liquid(model=model, density=830.0)
        found = excite(cylinder(liquid=liquid, length=15.5), Deceleration.ramped(0.2, 20.0), 30.0, 0.05)
        assert found.force[-1] > 0.0
        assert found.moment[-1] > 0.0
        assert found.surface_front[-1] > 0.0 > found.surface_rear[-1]


def test_the_two_liquids_agree_in_a_long_tank_moved_gently():
    course = Deceleration.ramped(0.005, 5.0)
    models = {
        "modal": Liquid(model="modal", density=830.0),
        "shallow-water": Liquid(model="shallow-water", density=830.0, cells=400),
    }
    tanks = {
        model: Rectangular(
            width=2.0, height=2.0, length=30.0, fill=0.4, liquid=liquid, modes=12 if model == "modal" else 1
        )
        for model, liquid in models.items()
    }
    modal, shallow = (excite(tanks[model], course, 25.0, 0.05) for model in models)
    for name in ("force", "moment", "surface_front", "surface_rear"):
        one, other = getattr(modal, name), getattr(shallow, name)
        assert np.abs(one - other).max() < 0.03 * np.abs(one).max(), name


def test_a_rigid_load_follows():
    tank = cylinder(liquid=Liquid(model="rigid", density=998.2))
    found = excite(tank, JAGGED, 20.0, 0.1)
    load = frozen_load(tank)
    np.testing.assert_allclose(found.force, load.mass * found.deceleration)
    np.testing.assert_allclose(found.moment, load.centre_height * found.force)
    assert found.max_surface == 0.0
    assert np.ptp(found.normalised_force) == pytest.approx(1.0 + 0.8 / 1.5, abs=0.02)


def interfoam(level):
    rows = data_rows(f"interfoam_{level}.csv")
    return (np.array([float(row[name]) for row in rows]) for name in ("time_s", "force_N_per_m", "moment_N"))


def channel(cells=120):
    """The tank of the interFoam runs, 1 m wide."""
    liquid = Liquid(model="shallow-water", density=830.0, cells=cells)
    return Rectangular(width=1.0, height=3.0, length=15.5, fill=1.1875 / 3.0, liquid=liquid)


@pytest.mark.parametrize(("level", "rms", "interval"), [(0.6, 0.134, 0.02), (1.5, 0.111, 0.02), (1.5, 0.111, 0.01)])
def test_shallow_water_against_interfoam(level, rms, interval):
    time, force, moment = interfoam(level)
    found = excite(channel(), Deceleration.ramped(level), 14.0, interval)
    at = time <= 14.0
    off = np.interp(time[at], found.time, found.force) - force[at]
    assert math.sqrt(np.mean(off**2)) / (found.mass * level) == pytest.approx(rms, abs=0.004)
    assert found.moment.max() == pytest.approx(moment[at].max(), rel=0.02)
    assert found.mass_error < 1e-12
    assert found.reason == ""


def test_the_cells_keep_the_impulse_whatever_the_interval():
    """Force is the mean over the interval around each time, so that its sum is the impulse."""
    fine, coarse = (excite(channel(), Deceleration.ramped(0.6, 1.0), 10.0, interval) for interval in (0.02, 0.2))

    def impulse(found):
        return np.trapezoid(found.force, found.time)  # half intervals at both ends, whole ones between

    assert impulse(coarse) == pytest.approx(impulse(fine), rel=2e-4)


@pytest.mark.parametrize("level", [3.0, 9.0])
@pytest.mark.parametrize("model", ["rectangular", "cylinder"])
def test_a_violently_braked_shallow_liquid_runs_dry_and_full_and_keeps_its_mass(model, level):
    tank = channel(60) if model == "rectangular" else cylinder(liquid=channel(60).liquid, radius=1.5, length=15.5)
    found = excite(tank, Deceleration.ramped(level), 20.0, 0.02)
    assert found.reason == ""
    assert found.mass_error < 1e-12
    assert np.isfinite(found.force).all()
    assert found.surface_front.max() <= tank.height * (1.0 - tank.fill) * (1.0 + 1e-9)
    assert found.surface_rear.min() >= -tank.height * tank.fill * (1.0 + 1e-9)


def test_a_course_is_linear_between_its_times():
    instants = np.array([0.0, 0.5, 1.25, 7.003, 9.0, 40.0])
    np.testing.assert_allclose(JAGGED.after(instants)[[0, 1, 2, 3, 5]], [0.0, 0.0, 0.75, -0.8, 0.7])
    assert JAGGED.before(instants)[3] == pytest.approx(1.5)
    fine = np.linspace(0.0, 40.0, 400_001)
    middle = JAGGED.after(0.5 * (fine[1:] + fine[:-1]))
    lost = np.concatenate([[0.0], np.cumsum(middle * np.diff(fine))])
    np.testing.assert_allclose(JAGGED.speed_lost(instants), np.interp(instants, fine, lost), atol=2e-4)
    assert JAGGED.largest(40.0) == 1.5
    assert JAGGED.largest(0.8) == pytest.approx(0.3)


@pytest.mark.parametrize("points", [[], [(0.0, math.nan)], [(1.0, 0.0), (0.5, 1.0)]])
def test_a_course_that_is_none_is_refused(points):
    with pytest.raises(ValueError, match="times"):
        Deceleration.table(points)


def test_rows_lie_at_the_interval_and_at_the_end():
    found = excite(cylinder(), Deceleration.ramped(1.0, 0.7), 1.05, 0.1)
    np.testing.assert_allclose(found.time, [*np.arange(11) * 0.1, 1.05])
    assert found.deceleration[7] == 1.0
    with pytest.raises(ValueError, match="positive"):
        excite(cylinder(), Deceleration.ramped(1.0), 0.0)
    with pytest.raises(ValueError, match="zero throughout"):
        excite(cylinder(), Deceleration.table([(50.0, 0.0), (60.0, 1.0)]), 40.0)


def test_the_largest_head_under_the_roof_goes_with_the_history():
    """A level tank has none; one whose front runs full under 1 g stands under metres of pressure there."""
    calm = excite(cylinder(liquid=Liquid(model="shallow-water", density=998.2)), Deceleration.ramped(0.1, 5.0), 10.0)
    assert calm.largest_head == 0.0
    hard = excite(cylinder(0.9, liquid=Liquid(model="shallow-water", density=998.2)), Deceleration.ramped(9.81), 5.0)
    assert hard.largest_head > 2.0
