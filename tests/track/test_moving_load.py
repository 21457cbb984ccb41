"""Rail under moving loads: closed form, damping, and free waves (theory section 6)."""

from itertools import pairwise

import numpy as np
import pytest
from rail_theory import EI, LOADED, MASS, SHEAR, WHEELS, K, closed_form, fourier_deflection, held_values, track

from slosh_cli.track.mem import critical_speed, fitted_nodes, rail_model, steady_shapes
from slosh_cli.track.moving import MATRICES, rail_residual

SPEEDS = [0.0, 22.0, 44.0, 100.0, 300.0]
LENGTHS = [1.0, 0.5, 0.25]
DAMPINGS = [(0.0, 0.0), (4.9e3, 0.0), (0.0, 2.0e4), (2.0e5, 5.0e4)]


def deflections(rail, speed):
    """Deflection (m, down) of all nodes but the ends per newton under the loaded wheel."""
    return -steady_shapes(rail, speed)[1 : rail.nodes - 1, LOADED]


def error_under_the_load(element_length, speed, shear):
    rail = rail_model(track(element_length, shear=shear), WHEELS)
    exact = closed_form(0.0, speed, shear)
    return abs(-steady_shapes(rail, speed)[rail.contact[LOADED], LOADED] / exact - 1)


@pytest.mark.parametrize("shear", [SHEAR, 0.0], ids=["shear layer", "Winkler"])
@pytest.mark.parametrize("speed", SPEEDS)
def test_deflection_under_a_moving_load_converges_with_order_4(speed, shear):
    """Acceptance: order 4 +- 0.2, error below 2e-5 at 0.25 m."""
    errors = [error_under_the_load(length, speed, shear) for length in LENGTHS]
    orders = [np.log2(coarse / fine) for coarse, fine in pairwise(errors)]
    assert orders == pytest.approx([4.0, 4.0], abs=0.2)
    assert errors[-1] < 2e-5


@pytest.mark.parametrize("shear", [SHEAR, 0.0], ids=["shear layer", "Winkler"])
@pytest.mark.parametrize("speed", SPEEDS)
def test_whole_shape_under_a_moving_load(speed, shear):
    length = 0.25
    rail = rail_model(track(length, shear=shear), WHEELS)
    nodes = fitted_nodes(WHEELS, 80.0, length)[1:-1]
    exact = closed_form(nodes, speed, shear)
    assert np.abs(deflections(rail, speed) - exact).max() < 3e-5 * exact.max()


def test_every_wheel_bends_the_rail_alike():
    rail = rail_model(track(0.5), WHEELS)
    shapes = -steady_shapes(rail, 44.0)[rail.contact]
    assert shapes == pytest.approx(closed_form(WHEELS[:, None] - WHEELS, 44.0), rel=2e-3, abs=1e-4 * shapes.max())


@pytest.mark.parametrize("shear", [SHEAR, 0.0])
def test_critical_speed_is_where_the_closed_form_ends(shear):
    rail = rail_model(track(0.5, shear=shear), WHEELS)
    critical = critical_speed(rail)
    assert critical == pytest.approx(np.sqrt((shear + 2 * np.sqrt(K * EI)) / MASS), rel=1e-12)
    # the slowest free wave of the track: least phase speed over all wave numbers
    xi = np.linspace(0.5, 3.0, 200_001)
    assert critical == pytest.approx(np.sqrt((EI * xi**4 + shear * xi**2 + K) / MASS / xi**2).min(), rel=1e-9)


@pytest.mark.parametrize("speed", [22.0, 44.0, 300.0])
@pytest.mark.parametrize(("damping", "shear_damping"), DAMPINGS)
def test_damped_shape_is_the_fourier_integral(speed, damping, shear_damping):
    """C(V) and the velocity terms of K: a steady shape with either damping, ahead of and behind the load."""
    length = 0.125
    rail = rail_model(track(length, damping=damping, shear_damping=shear_damping), WHEELS)
    nodes = fitted_nodes(WHEELS, 80.0, length)[1:-1]
    computed = deflections(rail, speed)
    peak = computed.max()
    for r in (-3.0, -1.0, -0.5, 0.0, 0.5, 1.0, 3.0):
        exact = fourier_deflection(r, speed, SHEAR, damping, shear_damping)
        assert computed[np.argmin(np.abs(nodes - r))] == pytest.approx(exact, abs=1e-5 * peak)


def test_damped_rail_lags_behind_the_load():
    rail = rail_model(track(0.25, damping=2.0e5), WHEELS)
    nodes = fitted_nodes(WHEELS, 80.0, 0.25)[1:-1]
    shape = deflections(rail, 44.0)
    behind, ahead = shape[np.argmin(np.abs(nodes + 1.0))], shape[np.argmin(np.abs(nodes - 1.0))]
    assert behind > 1.01 * ahead


def free_wave(element_length, speed, acceleration):
    """What is missing when a damped free wave, seen from the wagon, is put into the rail's equations.

    `y(x, t) = Re e^(i (kappa x - omega t))` solves the rail's equation without loads when
    `m omega^2 + i omega (alpha + lam kappa^2) = EI kappa^4 + k_sm kappa^2 + k`; seen from r = x - s(t) it must
    satisfy the convected equation with all terms of C(V) and K(V, A). The residual is weighed with a smooth packet
    inside the domain and set beside the largest of the three terms.
    """
    damping, shear_damping, kappa = 2.0e4, 5.0e3, 0.8
    its_track = track(element_length, damping=damping, shear_damping=shear_damping)
    rail, nodes = rail_model(its_track, WHEELS), fitted_nodes(WHEELS, 80.0, element_length)
    loss = damping + shear_damping * kappa**2
    omega = np.roots([MASS, 1j * loss, -(EI * kappa**4 + SHEAR * kappa**2 + K)])[0]
    rate = 1j * (kappa * speed - omega)  # d/dt at fixed r
    wave, zero = np.exp(1j * kappa * nodes), np.zeros(2 * nodes.size)
    in_time = [wave, rate * wave, (rate**2 + 1j * kappa * acceleration) * wave]
    states = [held_values(part.real, (1j * kappa * part).real) for part in in_time]
    inside = np.where(np.abs(nodes) < 30.0, np.cos(np.pi * nodes / 60.0), 0.0)
    envelope, slope = inside**4, -4 * inside**3 * np.sin(np.pi * nodes / 60.0) * np.pi / 60.0
    packet = held_values(envelope * wave, (slope + 1j * kappa * envelope) * wave)

    def missing(*state):
        result = np.zeros(zero.size)
        rail_residual(rail, *state, 0.0, speed, acceleration, np.zeros((len(rail.runs), MATRICES)), result)
        return abs(packet.conj() @ result)

    terms = [missing(*(state if i == k else zero for i, state in enumerate(states))) for k in range(3)]
    return missing(*states) / max(terms)


MOTIONS = [(0.0, 0.0), (44.0, 0.0), (300.0, 0.0), (44.0, -2000.0), (300.0, 5e4)]


@pytest.mark.parametrize(("speed", "acceleration"), MOTIONS)
def test_free_waves_satisfy_the_convected_equation(speed, acceleration):
    """Every inertia, damping and convection term at once, acceleration included, without any load."""
    coarse, fine = free_wave(0.5, speed, acceleration), free_wave(0.25, speed, acceleration)
    assert fine < 1e-6
    assert np.log2(coarse / fine) == pytest.approx(4.0, abs=0.2)
