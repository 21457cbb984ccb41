"""A stopped wagon whose liquid can push it on is not at rest: the largest push beside what holds it."""

import json

import h5py
import numpy as np
import pytest

from slosh_cli.method import START
from slosh_cli.results import rest
from slosh_cli.results.answers import Shown
from slosh_cli.results.hdf5 import write_history
from slosh_cli.results.simulate import simulate
from slosh_cli.solver.excite import Deceleration, excite
from slosh_cli.solver.run import integrate
from slosh_cli.solver.setup import problem
from slosh_cli.wagon.model import CAR_PITCH

ACID = ("tank.coefficients=computed", "tank.modes=3", "tank.liquid.density=1840 kg/m^3", "braking.initial_speed=7 km/h")
NAME = "push of the liquid after the stop over what holds the wagon"


def verdict(result):
    return next((check for check in result.checks if check.name == NAME), None)


def test_a_heavy_liquid_pushes_on_after_a_short_stop(stop, tmp_path):
    """Held still by `tank excite` under the recorded deceleration it pushes with 120 kN; 8 x 5 kN m/0.46 m hold 87."""
    result = stop("paper_80", *ACID)
    found = verdict(result)
    assert found.value == pytest.approx(120e3, rel=0.02)
    assert found.limit == pytest.approx(8 * 5000 / 0.46 + 851, rel=1e-9)
    assert not found.within
    (told,) = (text for text in result.warnings if "at rest" in text)
    assert "119 kN" in told
    assert "87.8 kN" in told
    assert "move on" in told
    assert result.status == "stopped"  # the distance stays that of the first passage
    assert NAME in result.row(Shown.SUMMARY)["not_within"]
    assert "at rest" in result.row(Shown.SUMMARY)["warnings"]
    write_history(result, tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5") as file:
        kept = {check["check"]: check for check in json.loads(file.attrs["checks"])}
    assert kept[NAME]["within"] is False


def test_an_ordinary_stop_is_at_rest(stop):
    found = verdict(stop("paper_80", "tank.coefficients=computed"))
    assert found.within
    assert 0.0 < found.value < found.limit


def test_frozen_loads_runs_without_a_stop_and_high_stop_speeds_have_no_rest(stop):
    assert verdict(stop("paper_80_solid")) is None
    assert verdict(stop("paper_80", "tank.coefficients=computed", "solver.time_limit=2 s")) is None
    assert verdict(stop("paper_80", "tank.coefficients=computed", "braking.stop_speed=5 m/s")) is None


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_modes_swing_as_small_steps_say(shipped, damping):
    """A second method: the same oscillators in steps of 2 ms (velocity Verlet, damping implicit)."""
    scenario = shipped("paper_80", *ACID, f"tank.liquid.damping_ratio={damping}")
    vehicle = integrate(problem(scenario)).train.vehicles[0]
    liquid, pitch = vehicle.liquid, vehicle.points[START].q[CAR_PITCH]
    place, rate = liquid.amplitude[START].copy(), liquid.rate[START].copy()
    step, forces = 2e-3, []
    for _ in range(20_000):
        half = rate + 0.5 * step * acceleration(liquid, pitch, place, rate)
        place += step * half
        rate = (half + 0.5 * step * (liquid.pitch_weight * pitch - liquid.stiffness * place) / liquid.mu) / (
            1.0 + 0.5 * step * liquid.damping / liquid.mu
        )
        forces.append(-2.0 * float(liquid.lambda_1 @ acceleration(liquid, pitch, place, rate)))
    on, back = rest.largest_pushes(vehicle)
    assert on == pytest.approx(max(forces), rel=2e-3)
    assert back == pytest.approx(-min(forces), rel=2e-3)


def acceleration(liquid, pitch, place, rate):
    return (liquid.pitch_weight * pitch - liquid.stiffness * place - liquid.damping * rate) / liquid.mu


def test_cells_push_as_the_tank_alone_does_under_the_recorded_deceleration(shipped):
    """A second way: the car's recorded deceleration, then none, put on the tank alone (which does not pitch)."""
    scenario = shipped("paper_80", *ACID[:3], "tank.liquid.model=shallow-water", "braking.initial_speed=7 km/h")
    result = simulate(scenario)
    end = float(result.time[-1])
    points = [*zip(result.time, -result.channels["car_acceleration"], strict=True), (end, 0.0)]
    found = excite(scenario.tank, Deceleration.table(points), end + 6.0, 0.1)
    after = found.force[found.time > end + 0.1]
    assert verdict(result).value == pytest.approx(float(np.abs(after).max()), rel=0.1)


def test_adhesion_bounds_what_holds(shipped):
    scenario = shipped("paper_80", "braking.torque=100 kN m", "contact.adhesion=wet")
    loads = np.array([9e4, 9e4, 9e4, 8e4])
    assert rest.holding_force(scenario, loads, np.full(4, 1e5)) == pytest.approx(0.3 * 2 * loads.sum() + 851)
