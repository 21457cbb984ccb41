"""The rail's element matrices and its compiled kernels, against exact integrals of model section 6."""

import numpy as np
import pytest
from rail_theory import FORMS, WHEELS, dense, exact_form, free_values, hermite, track

from slosh_cli.track.banded import factor_banded, form_banded, solve_banded_four, solve_banded_one
from slosh_cli.track.mem import fitted_nodes, rail_model, steady_matrix, steady_shapes
from slosh_cli.track.moving import prepare_rail, rail_ledger, rail_residual

UNEVEN = np.array([6.9, 5.1, -5.1, -6.9])
DAMPED = {"damping": 4.9e3, "shear_damping": 1.0e3}


@pytest.fixture(scope="module")
def uneven():
    """A short damped rail with elements of several lengths, its nodes, and its exact matrices."""
    its_track = track(0.7, length=26.0, **DAMPED)
    nodes = fitted_nodes(UNEVEN, 26.0, 0.7)
    exact = {name: exact_form(nodes, *orders) for name, orders in FORMS.items()}
    return rail_model(its_track, UNEVEN), nodes, exact


def exact_matrices(rail, exact, V, A):
    """M, C and K of model section 6, written out, from the exact forms."""
    mass, stretch, drift = exact["mass_form"], exact["tension_form"], exact["drift_form"]
    damping = 4.9e3 * mass + 1.0e3 * stretch - 2 * 60.0 * V * drift
    stiffness = 6.12e6 * exact["bending_form"] + 1e7 * mass + (666875.0 - 60.0 * V**2) * stretch
    stiffness = stiffness - (4.9e3 * V + 60.0 * A) * drift - 1.0e3 * V * exact["twist_form"]
    return 60.0 * mass, damping, stiffness


@pytest.mark.parametrize("name", FORMS)
def test_forms_are_the_exact_integrals(uneven, name):
    rail, _, exact = uneven
    computed = dense(getattr(rail, name))
    assert np.abs(computed - exact[name]).max() < 1e-13 * np.abs(exact[name]).max()


def test_convection_only_turns_energy_over(uneven):
    """INT N N' is skew with both ends held: moving along the rail must not create energy."""
    rail, _, _ = uneven
    drift = dense(rail.drift_form)
    assert np.abs(drift + drift.T).max() < 1e-14 * np.abs(drift).max()
    assert np.abs(drift).max() > 0.1


@pytest.mark.parametrize("name", ["mass_form", "bending_form", "tension_form"])
def test_forms_of_energies_are_symmetric_and_definite(uneven, name):
    rail, _, _ = uneven
    form = dense(getattr(rail, name))
    assert np.abs(form - form.T).max() < 1e-15 * np.abs(form).max()
    assert np.linalg.eigvalsh(form)[0] > 0


def test_every_wheel_stands_on_a_node_and_elements_fit_the_wheelbase(uneven):
    rail, nodes, _ = uneven
    assert nodes[0] == -13.0
    assert nodes[-1] == 13.0
    assert np.all(np.diff(nodes) > 0.5 * 0.7)
    assert np.all(np.diff(nodes) < 1.5 * 0.7)
    # an unknown's node: the unknowns are slope, then deflection and slope node by node
    assert nodes[(rail.contact + 1) // 2] == pytest.approx(UNEVEN, abs=1e-12)
    assert np.all(rail.contact % 2 == 1)


def test_wheels_outside_the_domain_are_refused():
    with pytest.raises(ValueError, match="do not fit"):
        rail_model(track(0.5, length=8.0), WHEELS)


def test_forms_of_a_polynomial_deflection_are_its_integrals(uneven):
    """A cubic that vanishes at both ends is represented exactly, whatever the mesh."""
    rail, nodes, _ = uneven
    cubic = np.polynomial.Polynomial([-169.0, 0, 1.0]) * np.polynomial.Polynomial([1.0, 0.3]) * 1e-3
    y = free_values(nodes, cubic(nodes), cubic.deriv()(nodes))
    for name, (left, right) in FORMS.items():
        integral = (cubic.deriv(left) * cubic.deriv(right)).integ()
        expected, scale = integral(13.0) - integral(-13.0), np.abs(dense(getattr(rail, name))).max() * (y @ y)
        assert form_banded(getattr(rail, name), y, y) == pytest.approx(expected, abs=1e-12 * scale), name


@pytest.mark.parametrize(("V", "A"), [(0.0, 0.0), (44.0, -1.5), (300.0, -40.0)])
def test_steady_matrix_and_residual_are_those_of_the_model(uneven, V, A):
    rail, _, exact = uneven
    M, C, K = exact_matrices(rail, exact, V, A)
    steady = exact_matrices(rail, exact, V, 0.0)[2]
    assert np.abs(dense(steady_matrix(rail, V)) - steady).max() < 1e-12 * np.abs(steady).max()
    rng, size = np.random.default_rng(3), M.shape[0]
    y, rate, second = rng.normal(size=size), rng.normal(size=size), rng.normal(size=size)
    scratch, residual = np.zeros((3, size)), np.full(size, 7.0)
    for part in (y, rate, second):  # one at a time: none may hide behind the stiffest term
        states = [part if part is other else np.zeros(size) for other in (y, rate, second)]
        rail_residual(rail, *states, V, A, scratch, residual)
        expected = K @ states[0] + C @ states[1] + M @ states[2]
        assert np.abs(residual - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("h", [0.0, 1e-5, 3e-3, 0.07])
def test_stage_matrix_is_factored_and_condensed_on_the_wheels(uneven, h):
    rail, _, exact = uneven
    V, A, size = 44.0, -30.0, rail.mass_form.shape[1]
    M, C, K = exact_matrices(rail, exact, V, A)
    factors, flexibility = np.zeros((7, size)), np.ones((4, size))
    prepare_rail(rail, h, V, A, factors, flexibility)
    under_wheels = np.zeros((size, 4))
    under_wheels[rail.contact, np.arange(4)] = 1.0
    expected = np.linalg.solve(M + h * C + h**2 * K, under_wheels)
    assert np.abs(flexibility.T - expected).max() < 1e-9 * np.abs(expected).max()


def test_banded_solutions_agree_with_dense_ones():
    rng = np.random.default_rng(4)
    band = rng.normal(size=(7, 30))
    band[3] += 9.0
    full = dense(band)
    for offset in (-3, -2, -1, 1, 2, 3):  # what lies outside the matrix is zero
        band[3 + offset, [i for i in range(30) if not 0 <= i + offset < 30]] = 0.0
    one, four = rng.normal(size=30), rng.normal(size=(4, 30))
    expected_one, expected_four = np.linalg.solve(full, one), np.linalg.solve(full, four.T).T
    assert form_banded(band, four[0], one) == pytest.approx(four[0] @ full @ one, rel=1e-12)
    factors = band.copy()
    factor_banded(factors)
    solve_banded_one(factors, one)
    solve_banded_four(factors, four)
    assert one == pytest.approx(expected_one, rel=1e-11, abs=1e-13)
    assert four == pytest.approx(expected_four, rel=1e-11, abs=1e-13)


def test_energies_use_the_material_velocity(uneven):
    """Kinetic energy and foundation loss of a rail in motion, by quadrature of y_t - V y_r (model section 9)."""
    rail, nodes, _ = uneven
    rng, V = np.random.default_rng(5), 44.0
    y, rate = rng.normal(size=rail.mass_form.shape[1]), 300.0 * rng.normal(size=rail.mass_form.shape[1])
    points, weights = np.polynomial.legendre.leggauss(6)
    kinetic = elastic = loss = 0.0
    all_y, all_rate = (np.insert(values, [0, values.size - 1], 0.0) for values in (y, rate))
    for e, length in enumerate(np.diff(nodes)):
        shapes = hermite(length)
        x, w = 0.5 * length * (points + 1), 0.5 * length * weights

        def field(values, order, shapes=shapes, x=x, e=e):
            return sum(c * shape.deriv(order)(x) for c, shape in zip(values[2 * e : 2 * e + 4], shapes, strict=True))

        speed, shear_speed = (field(all_rate, k) - V * field(all_y, k + 1) for k in (0, 1))
        kinetic += w @ (0.5 * 60.0 * speed**2)
        loss += w @ (4.9e3 * speed**2 + 1.0e3 * shear_speed**2)
        strain = 6.12e6 * field(all_y, 2) ** 2 + 666875.0 * field(all_y, 1) ** 2 + 1e7 * field(all_y, 0) ** 2
        elastic += w @ (0.5 * strain)
    assert rail_ledger(rail, y, rate, V) == pytest.approx((kinetic, elastic, loss), rel=1e-11)


def test_rail_ends_do_not_move_and_unit_loads_push_down():
    rail = rail_model(track(0.5), WHEELS)
    shapes = steady_shapes(rail, 22.0)
    assert np.all(shapes[rail.contact, np.arange(4)] < 0)
    assert abs(shapes[0]).max() < 1e-6 * abs(shapes).max()  # slope at the left end, 36 m from any load
