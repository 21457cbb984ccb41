"""Order and stability of the time integrator on stiff linear systems with known solutions (theory section 11)."""

from itertools import pairwise

import numpy as np
import pytest
from linear_systems import LinearSystem, linear_stop, march, reached, started, tr_bdf2, wagon_of, with_parts
from scipy.linalg import eig

from slosh_cli.method import START
from slosh_cli.track.mem import fitted_nodes
from slosh_cli.wagon.model import wheel_positions

MODES = (
    "tank.coefficients=[{frequency: 0.66 rad/s, lambda_1: -1.0e5 kg, lambda_02: -1.1e5 kg m, mu: 3.3e5 kg, "
    "damping_ratio: 0.02}, {frequency: 1.8 rad/s, lambda_1: -1.2e4 kg, lambda_02: -9e3 kg m, mu: 1.2e5 kg}]"
)
END = 2.0
STEPS = [0.02, 0.01, 0.005]


@pytest.fixture(scope="module")
def stiff(shipped):
    """The paper's wagon with springs and dampers 10,000 times stiffer, on soft springs, with two slosh modes."""
    return wagon_of(shipped("paper_160", MODES), 1e4)


def displaced(size):
    """Everything displaced and moving: fast modes are excited as well as slow ones."""
    rng = np.random.default_rng(8)
    x, v = 1e-2 * rng.normal(size=size), 5e-2 * rng.normal(size=size)
    x[0] = 0.0
    return x, v


def modes_of(system):
    """Eigenvalues (1/s) of the linear system and their vectors (displacements, then velocities)."""
    size = system.mass.shape[0]
    zero, unit = np.zeros((size, size)), np.eye(size)
    left = np.block([[zero, unit], [-system.stiffness, -system.damping]])
    right = np.block([[unit, zero], [zero, system.mass]])
    values, vectors = eig(left, right)
    return values, vectors.T


def test_the_system_is_stiff(stiff):
    """Fast decays beside slow motion: the steps of this module are far too long for an explicit method."""
    found, _ = modes_of(stiff[0])
    assert np.abs(found).max() * min(STEPS) > 1e3
    slow = np.abs(found)[(np.abs(found) > 0.1) & (np.abs(found) < 3.0)]
    assert slow.size >= 2


def test_order_2_on_the_stiff_wagon_with_slosh(stiff):
    """Acceptance: order 2 +- 0.1 on a stiff linear system with known solution, through the program's time loop."""
    system, stop = stiff
    x, v = displaced(system.mass.shape[0])
    exact_x, exact_v = system.exact(x, v, END)
    errors = []
    for step in STEPS:
        got_x, got_v = reached(march(linear_stop(stop, step, END), started(stop, x, v), step))
        got_x[0] -= 20.0 * END
        errors.append([np.abs(got_x - exact_x).max(), np.abs(got_v - exact_v).max()])
    orders = [np.log2(np.array(coarse) / fine) for coarse, fine in pairwise(errors)]
    assert np.array(orders) == pytest.approx(2.0, abs=0.1)
    assert errors[-1][0] < 1e-3 * np.abs(exact_x).max()


def test_stiff_motion_is_killed_not_rung(stiff):
    """L-stability: after ten long steps nothing is left of motions that the exact solution lost long ago."""
    system, stop = stiff
    fast = [one for rate, one in zip(*modes_of(system), strict=True) if rate.real < -500.0]
    assert len(fast) == 6
    size = system.mass.shape[0]
    for mode in fast:
        # displacement and velocity in proportion, the larger of them 0.01 (m, rad or their like per second)
        vector = np.real(mode * np.exp(-1j * np.angle(mode[np.abs(mode).argmax()])))
        x, v = np.split(vector * 1e-2 / np.abs(vector).max(), 2)
        end_x, end_v = reached(march(linear_stop(stop, 0.05, 0.5), started(stop, x, v), 0.05))
        exact_x, exact_v = system.exact(x, v, 0.5)
        assert np.abs(end_x[1:size] - exact_x[1:]).max() < 1e-6
        assert np.abs(end_v - exact_v).max() < 1e-6


@pytest.mark.parametrize("wheel", [7, 10])
@pytest.mark.parametrize("z", [1e-2, 1.0, 30.0, 1e3, 1e5])
def test_undamped_oscillator_is_amplified_as_tr_bdf2_does(stiff, z, wheel):
    """One wheel on a spring alone: every step multiplies `v + i omega x` by the method's rational function."""
    _, stop = stiff
    mass, omega, step, steps = 700.0, 40.0, z / 40.0, 3
    wagon = stop.vehicle.wagon.replaced(
        mass=np.diag(np.full(15, mass)), damping=np.zeros((15, 15)), stiffness=np.zeros((15, 15))
    )
    wagon.stiffness[wheel, wheel] = mass * omega**2
    x = np.zeros(17)
    x[wheel] = 1e-3
    lone = with_parts(stop, wagon=wagon)
    point = march(linear_stop(lone, step, steps * step), started(lone, x, 0 * x), step).points[START]
    expected = tr_bdf2(1j * z) ** steps * 1j * omega * 1e-3
    got = point.v[wheel] + 1j * omega * point.q[wheel]
    assert abs(got - expected) < 1e-9 * abs(1j * omega * 1e-3)
    if z > 1e4:
        assert abs(got) < 1e-12 * omega  # (2.4/z)^3: killed, where the trapezoidal rule would ring for ever


def test_tr_bdf2_is_of_order_2_and_l_stable():
    """The function compared with above: what it must be, from its definition."""
    z = np.array([0.02, 0.01]) * 1j
    errors = np.abs(tr_bdf2(z) - np.exp(z))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(3.0, abs=0.01)
    assert abs(tr_bdf2(-1e12)) < 1e-11
    assert np.all(np.abs(tr_bdf2(1j * np.geomspace(1e-3, 1e6, 1000))) <= 1.0)


def rail_system(rail, speed):
    """M, C, K of the model's rail at constant speed as full matrices."""

    def full(rows):
        matrix = np.zeros((2, rail.nodes, 2, rail.nodes + 2))  # a column of zeros beyond either end
        for (first, end, *_), row in zip(rail.runs.astype(int), rows.reshape(-1, 2, 3, 2), strict=True):
            for node in range(first, end):
                matrix[:, node, :, node : node + 3] = row.transpose(0, 2, 1)
        return matrix[..., 1:-1].reshape(2 * rail.nodes, -1)

    mass, stretch, drift, bend, twist = (full(rows) for rows in np.split(rail.forms, 5, axis=1))
    tension = rail.shear_stiffness - rail.mass * speed**2
    stiffness = rail.bending_stiffness * bend + rail.stiffness * mass + tension * stretch
    stiffness -= rail.damping * speed * drift + rail.shear_damping * speed * twist
    damping = rail.damping * mass + rail.shear_damping * stretch - 2 * rail.mass * speed * drift
    return LinearSystem(rail.mass * mass, damping, stiffness)


def test_order_2_on_the_moving_rail(shipped):
    """The rail of a wagon at constant speed, let go from a smooth dent: stiff, convected, damped."""
    scenario = shipped("paper_160_solid", "track.domain.length=26 m", "track.domain.element_length=0.9 m")
    _, stop = wagon_of(scenario, 1.0)
    rail, end, rest = stop.vehicle.rail, 0.02, np.zeros(15)
    system = rail_system(rail, 20.0)
    nodes = fitted_nodes(wheel_positions(scenario.wagon), 26.0, 0.9)
    dent = -1e-3 * np.exp(-((nodes / 3.0) ** 2))
    shape = np.concatenate([[0.0], dent[1:-1], [0.0], -2 * nodes / 9.0 * dent])
    exact_y, exact_rate = system.exact(shape, 0 * shape, end)
    errors = []
    for step in (2e-4, 1e-4, 5e-5):
        start = started(stop, rest, rest, shape, 0 * shape)
        point = march(linear_stop(stop, step, end), start, step).points[START]
        errors.append([np.abs(point.rail - exact_y).max(), np.abs(point.rail_rate - exact_rate).max()])
    orders = [np.log2(np.array(coarse) / fine) for coarse, fine in pairwise(errors)]
    assert np.array(orders) == pytest.approx(2.0, abs=0.1)


def test_rail_vibrations_far_faster_than_the_step_die_at_once(shipped):
    _, stop = wagon_of(shipped("paper_160_solid"), 1.0)
    rng, size = np.random.default_rng(2), 2 * stop.vehicle.rail.nodes
    shape, rest = 1e-3 * rng.normal(size=size), np.zeros(15)
    shape[[0, size // 2 - 1]] = 0.0
    point = march(linear_stop(stop, 0.25, 1.0), started(stop, rest, rest, shape, 0 * shape), 0.25).points[START]
    assert np.abs(point.rail).max() < 1e-3 * np.abs(shape).max()
