"""Checks of the plain implementation against exact solutions, its own convergence and the energy ledger."""

import csv
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from . import plain_contact, plain_motion, plain_rail, plain_stop, plain_wagon
from .plain_motion import PHI_DOFS, REACTION_DOFS, W_DOFS, Brake

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "paper_80.yaml"
TABLE = Path(__file__).resolve().parents[1] / "data" / "plain_stops.csv"


def scenario_with(*overrides):
    """The packaged paper wagon with some values replaced."""
    from slosh_cli.scenario import load_scenario

    return load_scenario(SCENARIO, overrides=list(overrides))


LOCKING = (
    "tank.liquid.model=rigid",
    "braking.initial_speed=150 km/h",
    "braking.torque=25 kN m",
    "braking.onset=0.1 s",
    "braking.stop_speed=145 km/h",
)


def test_hertz_constants_of_a_wheel_on_a_rail():
    hertz, ellipse, ratio = plain_contact.hertz_constants(1 / 0.46, 1 / 0.30, 210e9 / (2 * (1 - 0.3**2)))
    b = np.sqrt(ellipse * ratio) * 93e3 ** (1 / 3)
    assert hertz == pytest.approx(9.413e10, rel=1e-4)
    assert (b / ratio, b) == (pytest.approx(7.0e-3, abs=5e-5), pytest.approx(5.3e-3, abs=5e-5))


def test_hertz_constants_of_nearly_a_sphere_on_a_plane():
    radius, modulus = 0.5, 1e11
    hertz, ellipse, _ = plain_contact.hertz_constants(1 / radius, 1 / (radius * 1.001), modulus)
    assert hertz == pytest.approx(4 / 3 * modulus * np.sqrt(radius), rel=1e-3)
    assert ellipse == pytest.approx((3 * radius / (4 * modulus)) ** (2 / 3), rel=1e-3)


def test_steady_rail_approaches_the_infinite_beam_as_h4():
    scenario, V, load = scenario_with(), 40.0, 9e4
    wheels, errors = np.array([3.0, 1.0, -1.0, -3.0]), []
    for length in (1.0, 0.5, 0.25):
        rail = replace(plain_rail.rail_of(scenario, wheels, length), damping=0.0, shear_damping=0.0)
        shapes = plain_rail.solve(rail.stiffness_matrix(V, 0.0), load * rail.wheel_loads())
        stiff = rail.shear - rail.mass * V**2 + 2 * np.sqrt(rail.stiffness * rail.bending)
        exact = load / (2 * np.sqrt(rail.stiffness * stiff))
        errors.append(abs(shapes[rail.wheel_dofs[1], 1] / exact - 1))
    assert errors[-1] < 1e-5
    assert all(coarse / fine == pytest.approx(16, rel=0.1) for coarse, fine in pairwise(errors))


def gaussian(r, order):
    """Derivative of exp(-r^2/2) of the given order (probabilists' Hermite polynomials)."""
    return (-1) ** order * np.polynomial.hermite_e.hermeval(r, [0] * order + [1]) * np.exp(-(r**2) / 2)


def test_rail_matrices_are_the_weak_form_of_the_convected_equation():
    scenario, V, A = scenario_with(), 60.0, 5e4  # an acceleration large enough to be seen
    wheels = np.array([6.9, 5.1, -5.1, -6.9])
    rail, nodes = plain_rail.rail_of(scenario, wheels, 0.1), plain_rail.mesh_nodes(50.0, 0.1, wheels)

    def interpolated(centre):
        values = np.column_stack([gaussian(nodes - centre, 0), gaussian(nodes - centre, 1)]).ravel()
        return np.delete(values, [0, len(values) - 2])

    r = np.linspace(-12.0, 12.0, 4001)
    test, (y, y1, y2, y3, y4) = gaussian(r - 1.0, 0), (gaussian(r, order) for order in range(5))
    stiff = rail.bending * y4 - (rail.shear - rail.mass * V**2) * y2 + rail.stiffness * y
    moving = rail.shear_damping * V * y3 - (rail.damping * V + rail.mass * A) * y1
    damped = rail.damping * y - rail.shear_damping * y2 - 2 * rail.mass * V * y1
    by_stiffness = interpolated(1.0) @ plain_rail.times(rail.stiffness_matrix(V, A), interpolated(0.0))
    by_damping = interpolated(1.0) @ plain_rail.times(rail.damping_matrix(V), interpolated(0.0))
    assert by_stiffness == pytest.approx(np.trapezoid(test * (stiff + moving), r), rel=1e-5)
    assert by_damping == pytest.approx(np.trapezoid(test * damped, r), rel=1e-5)


def test_half_of_the_wagon_is_carried_and_moved():
    scenario = scenario_with()
    system = plain_motion.system_of(scenario)
    liquid = 830 * 15.5 * np.pi * 1.5**2 / 2
    assert system.wagon.mass[0, 0] == pytest.approx((30.5e3 + liquid) / 2, rel=1e-9)
    _, N = plain_motion.equilibrium(system, scenario.braking.initial_speed)
    assert N.sum() == pytest.approx((30.5e3 + liquid) / 2 * 9.81, rel=1e-9)
    load = plain_wagon.frozen_load(scenario.tank)
    assert load.centroid == pytest.approx(1.5 * (1 - 4 / (3 * np.pi)), rel=1e-9)


def test_wagon_matrices_reproduce_the_energies_body_by_body():
    scenario, rng = scenario_with(), np.random.default_rng(1)
    wagon, load = plain_motion.half_wagon(scenario), plain_wagon.frozen_load(scenario.tank)
    s, w, th, wb1, tb1, wb2, tb2, w1, w2, w3, w4, p1, p2, p3, p4, beta = u = rng.normal(size=16)
    car = s + (0.9 - 0.46) * (tb1 + tb2) / 2 + th * (2.2 - 0.9)
    bottom = s + (0.9 - 0.46) * (tb1 + tb2) / 2 + th * (1.15 - 0.9)
    twice = 21.3e3 * (car**2 + w**2) + 4.6e5 * th**2
    twice += load.mass * ((bottom + load.centroid * th) ** 2 + w**2) + load.pitch_inertia * th**2
    twice += 1800 * ((s + 0.09 * tb1) ** 2 + wb1**2 + (s + 0.09 * tb2) ** 2 + wb2**2) + 1700 * (tb1**2 + tb2**2)
    twice += 1400 * (4 * s**2 + w1**2 + w2**2 + w3**2 + w4**2) + 120 * (p1**2 + p2**2 + p3**2 + p4**2)
    twice += 2 * 137071 * bottom * beta - 2 * 68461 * th * beta + 442163 * beta**2
    assert u @ wagon.mass @ u == pytest.approx(twice / 2, rel=1e-12)
    primary = [wb1 - 0.9 * tb1 - w1, wb1 + 0.9 * tb1 - w2, wb2 - 0.9 * tb2 - w3, wb2 + 0.9 * tb2 - w4]
    elongations = np.array([*primary, w - 6 * th - wb1, w + 6 * th - wb2])
    elastic = np.array([2.6e6] * 4 + [6.0e6] * 2) @ elongations**2
    slosh = 442163 * 0.69**2 * beta**2 - 2 * 9.81 * 137071 * th * beta - load.mass * 9.81 * load.centroid * th**2
    assert u @ wagon.stiffness @ u == pytest.approx(elastic + slosh / 2, rel=1e-12)
    assert u @ wagon.damping @ u == pytest.approx(np.array([1.5e4] * 4 + [6.5e4] * 2) @ elongations**2, rel=1e-12)


def test_wagon_at_rest_on_its_rail_stays_at_rest():
    scenario = scenario_with("wagon.running_resistance.constant=0 N")
    system = plain_motion.system_of(scenario, 1.0)
    system = replace(system, resistance=(0.0, 0.0, 0.0))
    start = plain_stop._initial(system, 20.0)
    state = start
    for _ in range(20):
        state = plain_stop.step_of(system, state, 1e-3)
    assert pytest.approx(start.N, rel=1e-8) == state.N
    assert state.motion.u[0] == pytest.approx(20.0, rel=1e-10)


@pytest.fixture(scope="module")
def locking_stops():
    scenario = scenario_with(*LOCKING)
    return [plain_stop.stop(scenario, step) for step in (1e-3, 5e-4, 2.5e-4)]


def test_halving_the_step_quarters_the_error(locking_stops):
    distances = [result.distance for result in locking_stops]
    changes = np.abs(np.diff(distances))
    assert changes[0] / changes[1] == pytest.approx(4, rel=0.1)
    assert changes[1] < 5e-5 * distances[-1]


def test_energy_is_accounted_for_while_wheels_lock(locking_stops):
    assert min(locking_stops[-1].locked_time) > 0.1
    assert locking_stops[-1].energy_residual < 2e-8


def test_wheels_neither_turn_backwards_nor_outrun_the_wagon(locking_stops):
    history = locking_stops[-1].history
    assert history["wheel_speed"].min() >= 0.0
    assert np.all(history["wheel_speed"] <= history["speed"][:, None] * (1 + 1e-4))
    assert np.all(history["wheel_speed"][history["locked"]] == 0.0)


def _explicit(system, dense, x):
    """Right-hand side for an explicit method: wheels turn, wet rail, dense matrices, formulas spelt out."""
    wagon, rail, torque = system.wagon, system.rail, system.torque
    size = wagon.size
    q, u, y, v = np.split(x, [size, 2 * size, 2 * size + rail.size])
    V, radius, contact = u[0], wagon.wheel_radius, system.contact
    N = contact.hertz * np.maximum(y[rail.wheel_dofs] - q[W_DOFS], 0.0) ** 1.5
    slip = V - radius * u[PHI_DOFS]
    mu = 0.30 * (0.6 * np.exp(-0.20 * np.abs(slip)) + 0.4)
    shear = 210e9 / (2 * 1.3)
    eps = shear * np.pi * contact.ellipse * N ** (2 / 3) * 4.12 * np.abs(slip) / V / (4 * mu * N)
    f = 2 * mu * N / np.pi * (0.3 * eps / (1 + (0.3 * eps) ** 2) + np.arctan(0.1 * eps)) * np.sign(slip)
    force = wagon.weight - wagon.damping @ u - wagon.stiffness @ q
    force[0] -= f.sum() + (851 + 13.5 * V + 1.244 * V**2) / 2
    force[W_DOFS] += N
    force[PHI_DOFS] += f * radius - torque
    np.add.at(force, REACTION_DOFS, torque)
    a = np.linalg.solve(wagon.mass, force)
    pressure = -dense["load"] @ N - dense["damping"](V) @ v - dense["stiffness"](V, a[0]) @ y
    return np.concatenate([u, a, v, dense["inverse"] @ pressure])


def _dense(band):
    return np.column_stack([plain_rail.times(band, column) for column in np.eye(band.shape[1])])


def test_steps_agree_with_an_explicit_method_of_order_eight():
    scenario = scenario_with("contact.adhesion=wet", "braking.torque=15 kN m")
    system = plain_motion.system_of(scenario, 2.0)
    rail, size, end = system.rail, system.wagon.size, 0.1
    start = plain_stop._initial(system, scenario.braking.initial_speed)
    start = replace(start, brake=Brake(True, start.brake.locked))
    dense = {
        "load": rail.wheel_loads(),
        "inverse": np.linalg.inv(_dense(rail.mass_matrix)),
        "damping": lambda V: _dense(rail.damping_matrix(V)),
        "stiffness": lambda V, A: _dense(rail.stiffness_matrix(V, A)),
    }
    motion = start.motion
    first = np.concatenate([motion.q, motion.u, motion.y, motion.v])
    exact = solve_ivp(
        lambda _, x: _explicit(system, dense, x), (0, end), first, method="DOP853", rtol=1e-8, atol=1e-10
    ).y[:, -1]
    errors = []
    for steps in (50, 100):
        state = start
        for _ in range(steps):
            state = plain_stop.step_of(system, state, end / steps)
        errors.append(np.max(np.abs(state.motion.u[PHI_DOFS] - exact[size + np.array(PHI_DOFS)])))
        error_s = abs(state.motion.q[0] - exact[0])
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.2)
    assert errors[1] < 1e-2
    assert error_s < 1e-5


def test_load_transfer_balances_the_moment_of_inertia_forces():
    scenario = scenario_with(
        "tank.liquid.model=rigid",
        "wagon.secondary_suspension.damping=4e5 N s/m",  # so that a second of ringing is enough
        "braking.initial_speed=160 km/h",
        "braking.torque=10 kN m",
        "braking.stop_speed=140 km/h",
    )
    system = plain_motion.system_of(scenario)
    history = plain_stop.stop(scenario, 1e-3).history
    late = slice(np.searchsorted(history["time"], history["time"][-1] - 0.5), None)
    time, speed, load = history["time"][late], history["speed"][late], plain_wagon.frozen_load(scenario.tank)
    mean = np.trapezoid(history["loads"][late], time, axis=0) / np.ptp(time)
    deceleration = (speed[0] - speed[-1]) / np.ptp(time)
    masses = np.array([21.3e3, load.mass, 2 * 1.8e3, 4 * 1.4e3]) / 2
    heights = np.array([2.2, 1.15 + load.centroid, 0.55, 0.46])
    spin, resistance = 4 * 60.0 / 0.46, system.resisting_force(speed.mean())[0]  # it acts at axle height
    tilted = load.mass / 2 * 9.81 * load.centroid * history["pitch"][late, 0].mean()
    transfer = deceleration * (masses @ heights + spin) - 0.46 * resistance + tilted
    assert mean @ system.wagon.axle_positions == pytest.approx(transfer, rel=1e-3)
    assert mean.sum() == pytest.approx(-system.wagon.weight.sum(), rel=1e-4)


def stored_rows(name):
    """Rows of the stored table for one stop, the longer step first."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return [row for row in csv.DictReader(file) if row["stop"] == name]


def test_stored_stop_is_made_again_to_the_digit():
    row = stored_rows("quick")[0]
    result = plain_stop.stop(scenario_with(*row["overrides"].split("; ")), float(row["step_s"]))
    assert result.distance == pytest.approx(float(row["distance_m"]), abs=2e-6)
    for wheel in range(4):
        assert result.min_loads[wheel] == pytest.approx(float(row[f"min_load_{wheel + 1}_N"]), abs=0.2)
        assert result.max_loads[wheel] == pytest.approx(float(row[f"max_load_{wheel + 1}_N"]), abs=0.2)
        assert result.locked_time[wheel] == pytest.approx(float(row[f"locked_time_{wheel + 1}_s"]), abs=2e-5)


@pytest.mark.parametrize("name", ["locking", "wet", "paper-80-liquid", "fast", "quick", "three-lock", "four-lock"])
def test_stored_stops_have_converged(name):
    coarse, fine = stored_rows(name)
    assert float(fine["step_s"]) == pytest.approx(0.5 * float(coarse["step_s"]))
    assert float(fine["distance_m"]) == pytest.approx(float(coarse["distance_m"]), rel=2e-5)
    for wheel in range(1, 5):
        for column in (f"min_load_{wheel}_N", f"max_load_{wheel}_N"):
            assert float(fine[column]) == pytest.approx(float(coarse[column]), abs=100.0)
    assert float(fine["energy_residual"]) < 2e-7
