"""Each kernel of the slosh modes alone, against energies, matrices, curves written out (theory sections 3 and 11)."""

import math

import numpy as np
import pytest

from slosh_cli import method
from slosh_cli.method import BASE, END, MIDDLE, START
from slosh_cli.tank import modal
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.liquid import Ride
from slosh_cli.tank.modal import ModalLiquid, modal_liquid
from tests.plain_kernels import as_python

MODES = [
    SloshMode(1.9, 900.0, 1500.0, 1100.0, 0.02), SloshMode(5.5, -80.0, 60.0, 150.0, 0.3),
    SloshMode(8.0, 30.0, -20.0, 90.0, 0.1),
]  # fmt: skip
SHARE, G, IMPLICIT, STEP = 0.5, 9.81, 0.06, 0.2
MIDDLE_AT = 2.0 - math.sqrt(2.0)
LAMBDA_1, LAMBDA_02, MU, OMEGA, ZETA = (
    np.array([getattr(mode, name) for mode in MODES])
    for name in ("lambda_1", "lambda_02", "mu", "frequency", "damping_ratio")
)


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    as_python(monkeypatch, modal, ModalLiquid, method)


def swaying() -> ModalLiquid:
    liquid = modal_liquid(MODES, G, SHARE)
    rng = np.random.default_rng(7)
    for values in (liquid.amplitude, liquid.rate, liquid.second):
        values[:] = rng.normal(size=values.shape)
    return liquid


def test_oscillators_of_the_share_of_a_tank():
    liquid = modal_liquid(MODES, G, SHARE)
    assert liquid.recorded == 6
    assert liquid.lambda_1 == pytest.approx(LAMBDA_1 / 2, rel=1e-15)
    assert liquid.lambda_02 == pytest.approx(LAMBDA_02 / 2, rel=1e-15)
    assert liquid.mu == pytest.approx(MU / 2, rel=1e-15)
    assert liquid.stiffness == pytest.approx(MU / 2 * OMEGA**2, rel=1e-14)
    assert liquid.damping == pytest.approx(ZETA * OMEGA * MU, rel=1e-14)
    assert liquid.pitch_weight == pytest.approx(G * LAMBDA_1 / 2, rel=1e-14)
    assert liquid.side.tolist() == [1.0, -1.0, 1.0]
    for values in (liquid.amplitude, liquid.rate, liquid.second):
        assert values.tolist() == np.zeros((4, 3)).tolist()


def test_energies_are_those_of_the_lagrangian():
    """`T = lambda_1 u' b' + lambda_02 theta' b' + mu b'^2/2`, `V = mu omega^2 b^2/2 - g lambda_1 theta b`, summed."""
    liquid, ride = swaying(), Ride.blank(3)
    ride.speed[:], ride.pitch[:], ride.pitch_rate[:] = (1.0, 2.0, 3.0), (0.01, 0.02, -0.03), (0.5, 0.6, 0.7)
    kinetic, potential, loss = liquid.energy(ride, END)
    place, rate = liquid.amplitude[END], liquid.rate[END]
    expected = SHARE * np.sum(LAMBDA_1 * 3.0 * rate + LAMBDA_02 * 0.7 * rate + 0.5 * MU * rate**2)
    assert kinetic == pytest.approx(expected, rel=1e-12)
    expected = SHARE * np.sum(0.5 * MU * OMEGA**2 * place**2 + G * LAMBDA_1 * 0.03 * place)
    assert potential == pytest.approx(expected, rel=1e-12)
    assert loss == pytest.approx(SHARE * np.sum(2.0 * ZETA * OMEGA * MU * rate**2), rel=1e-12)


def test_momentum_and_force():
    """`-d/dt lambda_1 b'` along the track, `g lambda_1 b - lambda_02 b''` in pitch."""
    liquid = swaying()
    assert liquid.momentum(Ride.blank(3), MIDDLE) == pytest.approx(SHARE * LAMBDA_1 @ liquid.rate[MIDDLE], rel=1e-12)
    force, moment = liquid.force(MIDDLE)
    place, second = liquid.amplitude[MIDDLE], liquid.second[MIDDLE]
    assert force == pytest.approx(-SHARE * LAMBDA_1 @ second, rel=1e-12)
    assert moment == pytest.approx(SHARE * np.sum(G * LAMBDA_1 * place - LAMBDA_02 * second), rel=1e-12)


def matrices():
    """Mass, damping, stiffness of the modes beside a tank's displacement and pitch, which have a mass of their own."""
    mass, damping, stiffness = (np.zeros((5, 5)) for _ in range(3))
    mass[:2, :2] = [[4e3, 700.0], [700.0, 9e3]]
    for n in range(3):
        mass[2 + n, 2 + n] = SHARE * MU[n]
        mass[0, 2 + n] = mass[2 + n, 0] = SHARE * LAMBDA_1[n]
        mass[1, 2 + n] = mass[2 + n, 1] = SHARE * LAMBDA_02[n]
        damping[2 + n, 2 + n] = SHARE * 2.0 * ZETA[n] * OMEGA[n] * MU[n]
        stiffness[2 + n, 2 + n] = SHARE * MU[n] * OMEGA[n] ** 2
        stiffness[1, 2 + n] = stiffness[2 + n, 1] = -SHARE * G * LAMBDA_1[n]
    return mass, damping, stiffness


def answer(liquid, force, moment, right):
    """Accelerations of the tank, whose inertia the modes change and on which they push."""
    uu, up, pp = liquid.inertia(IMPLICIT)
    whole = matrices()[0][:2, :2] + np.array([[uu, up], [up, pp]])
    return np.linalg.solve(whole, right + np.array([force, moment]))


def test_a_stage_is_that_of_the_whole_system():
    """`(M + d C + d^2 K) a = f - C v - K q`, pitch and its own acceleration included, solved at once."""
    liquid, (mass, damping, stiffness) = swaying(), matrices()
    place, rate = liquid.amplitude[BASE].copy(), liquid.rate[BASE].copy()
    pitch, pushed = 0.02, np.array([500.0, -300.0])
    q, v = np.array([0.0, pitch, *place]), np.array([0.0, 0.0, *rate])
    right = np.array([*pushed, 0.0, 0.0, 0.0]) - damping @ v - stiffness @ q
    exact = np.linalg.solve(mass + IMPLICIT * damping + IMPLICIT**2 * stiffness, right)
    found = answer(liquid, *liquid.push(BASE, IMPLICIT, pitch, 0.0), pushed)
    assert found == pytest.approx(exact[:2], rel=1e-11)
    liquid.follow(MIDDLE, BASE, IMPLICIT, pitch, *found)
    assert liquid.second[MIDDLE] == pytest.approx(exact[2:], rel=1e-10)
    assert liquid.rate[MIDDLE] == pytest.approx(rate + IMPLICIT * exact[2:], rel=1e-10)
    assert liquid.amplitude[MIDDLE] == pytest.approx(place + IMPLICIT**2 * exact[2:], rel=1e-10)


def test_gravity_s_pull_acts_on_the_modes_too():
    """What pulls tank and liquid alike leaves the liquid as it is: the tank's acceleration counts without it."""
    liquid = swaying()
    with_it, without = liquid.push(BASE, IMPLICIT, 0.02, 0.7), liquid.push(BASE, IMPLICIT, 0.02, 0.0)
    uu, up, _ = liquid.inertia(IMPLICIT)
    assert np.subtract(with_it, without) == pytest.approx((0.7 * uu, 0.7 * up), rel=1e-11)


def test_errors_are_filtered_with_the_whole_system():
    """`(M + d C + d^2 K) e = M e_v - d K e_q`; the modes' errors are the step's weights less those of order three."""
    liquid, (mass, damping, stiffness) = swaying(), matrices()
    weights = STEP * np.array([math.sqrt(2.0) - 1.0, -1.0, 2.0 - math.sqrt(2.0)]) / 3.0
    speed, pitch, pitch_rate = 0.3, -0.02, 0.05
    e_q = np.array([0.0, pitch, *(weights @ liquid.rate[:3])])
    e_v = np.array([speed, pitch_rate, *(weights @ liquid.second[:3])])
    right = mass @ e_v - IMPLICIT * stiffness @ e_q
    exact = np.linalg.solve(mass + IMPLICIT * damping + IMPLICIT**2 * stiffness, right)
    size, force, moment = liquid.error(STEP, IMPLICIT, speed, pitch, pitch_rate)
    assert answer(liquid, force, moment, mass[:2, :2] @ e_v[:2]) == pytest.approx(exact[:2], rel=1e-10)
    assert size == pytest.approx(np.abs(e_v[2:]).max(), rel=1e-12)


def test_a_stage_begins_from_its_weights():
    liquid = swaying()
    place, rate, second = liquid.amplitude.copy(), liquid.rate.copy(), liquid.second.copy()
    liquid.predict(MIDDLE, 0.03, 0.05, IMPLICIT)
    rates = rate[START] + 0.03 * second[START] + 0.05 * second[MIDDLE]
    places = place[START] + 0.03 * rate[START] + 0.05 * rate[MIDDLE] + IMPLICIT * rates
    assert liquid.rate[BASE] == pytest.approx(rates, rel=1e-12)
    assert liquid.amplitude[BASE] == pytest.approx(places, rel=1e-12)
    assert liquid.amplitude[:3].tolist() == place[:3].tolist()


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_surface_rises_at_either_wall_by_the_parabola_of_the_step(sign):
    """Between the stages the modes sum up to 6 m at one wall, and the second one counts the other way."""
    liquid = modal_liquid(MODES, G, SHARE)
    for stage, part in ((START, 0.0), (MIDDLE, MIDDLE_AT), (END, 1.0)):
        whole = sign * (6.0 - 16.0 * (part - 0.5) ** 2)
        liquid.amplitude[stage] = whole + 1.0, 3.0, 2.0
        assert liquid.rise(stage) == pytest.approx(whole, rel=1e-12)
    assert liquid.highest() == pytest.approx(6.0, rel=1e-12)
    liquid.amplitude[:] = 0.0
    assert liquid.highest() == 0.0


def test_the_surface_falls_less_than_it_rises():
    liquid = modal_liquid(MODES[:1], G, SHARE)
    for values, told in (((-1.0, 0.5, 2.0), 2.0), ((-2.0, -0.5, 1.0), 2.0)):
        liquid.amplitude[:3, 0] = values[0], values[0] + MIDDLE_AT * (values[2] - values[0]), values[2]
        assert liquid.highest() == pytest.approx(told, rel=1e-12)


@pytest.mark.parametrize("part", [0.0, 0.4, 1.0])
def test_a_row_has_amplitudes_along_a_cubic_and_accelerations_along_a_parabola(part):
    liquid, row = modal_liquid(MODES, G, SHARE), np.full(9, np.nan)
    scale = np.array([1.0, -2.0, 0.5])
    for stage, at in ((START, 0.0), (MIDDLE, MIDDLE_AT), (END, 1.0)):
        time = STEP * at
        liquid.amplitude[stage], liquid.rate[stage] = scale * (1 + time + 40 * time**3), scale * (1 + 120 * time**2)
        liquid.second[stage] = scale * (3.0 - 5.0 * at + 2.0 * at * at)
    liquid.record(row, 2, part, method.hermite_weights(STEP, part), method.parabola_weights(part))
    time = STEP * part
    assert row[2:5] == pytest.approx(scale * (1 + time + 40 * time**3), rel=1e-12)
    assert row[5:8] == pytest.approx(scale * (3.0 - 5.0 * part + 2.0 * part * part), rel=1e-12, abs=1e-12)
    assert np.isnan(row[[0, 1, 8]]).all()


def test_the_end_becomes_the_start():
    liquid = swaying()
    kept = [values.copy() for values in (liquid.amplitude, liquid.rate, liquid.second)]
    liquid.accept(STEP)
    for values, before in zip((liquid.amplitude, liquid.rate, liquid.second), kept, strict=True):
        assert values[START].tolist() == before[END].tolist()
        assert values[1:].tolist() == before[1:].tolist()
