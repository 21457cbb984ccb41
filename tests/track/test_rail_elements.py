"""The rail's element matrices and its compiled kernels, against exact integrals of theory section 6."""

import numpy as np
import pytest
from rail_theory import FORMS, SHEAR, WHEELS, dense, exact_form, form_of, free, held_values, hermite, track

from slosh_cli.track.banded import factor_rows, pair_sums, solve_four, solve_one, weighed
from slosh_cli.track.mem import (
    BENDING,
    DRIFT,
    MASS,
    TENSION,
    TWIST,
    critical_speed,
    fitted_nodes,
    rail_model,
    steady_rows,
    steady_shapes,
)
from slosh_cli.track.moving import MATRICES, prepare_rail, rail_ledger, rail_residual, rail_work

UNEVEN = np.array([6.9, 5.1, -5.1, -6.9])
DAMPED = {"damping": 4.9e3, "shear_damping": 1.0e3}


@pytest.fixture(scope="module")
def uneven():
    """A short damped rail with elements of several lengths, its nodes, and its exact matrices."""
    its_track = track(0.7, length=26.0, **DAMPED)
    nodes = fitted_nodes(UNEVEN, 26.0, 0.7)
    exact = {form: exact_form(nodes, *orders) for form, orders in FORMS.items()}
    return rail_model(its_track, UNEVEN), nodes, exact


def exact_matrices(rail, exact, V, A):
    """M, C and K of theory section 6, written out, from the exact forms, for the unknowns that are free."""
    inside = np.ix_(free(rail.nodes), free(rail.nodes))
    mass, stretch, drift, bend, twist = (exact[form][inside] for form in (MASS, TENSION, DRIFT, BENDING, TWIST))
    damping = 4.9e3 * mass + 1.0e3 * stretch - 2 * 60.0 * V * drift
    stiffness = 6.12e6 * bend + 1e7 * mass + (666875.0 - 60.0 * V**2) * stretch
    stiffness = stiffness - (4.9e3 * V + 60.0 * A) * drift - 1.0e3 * V * twist
    return 60.0 * mass, damping, stiffness


@pytest.mark.parametrize("form", FORMS)
def test_forms_are_the_exact_integrals(uneven, form):
    rail, _, exact = uneven
    computed, rows = form_of(rail, form), free(rail.nodes)
    assert np.abs((computed - exact[form])[rows]).max() < 1e-13 * np.abs(exact[form]).max()


def test_deflections_of_both_ends_are_held_by_a_mass_of_their_own(uneven):
    rail, _, _ = uneven
    ends = [0, rail.nodes - 1]
    assert np.array_equal(form_of(rail, MASS)[ends], np.eye(2 * rail.nodes)[ends])
    for form in (TENSION, DRIFT, BENDING, TWIST):
        assert not np.any(form_of(rail, form)[ends])


def test_rows_are_stored_once_for_all_nodes_of_an_even_mesh():
    """Two ends, four wheels and five spans, whatever the number of elements; a span of one element has no inside."""
    sizes = {length: rail_model(track(length), UNEVEN).forms.shape for length in (0.9, 0.5, 0.1)}
    assert set(sizes.values()) == {(11, 60)}
    coarse = rail_model(track(1.8, length=20.0), UNEVEN)
    assert len(coarse.runs) == 9
    assert np.array_equal(coarse.runs[1:, 0], coarse.runs[:-1, 1])


def test_convection_only_turns_energy_over(uneven):
    """INT N N' is skew with both ends held: moving along the rail must not create energy."""
    rail, _, _ = uneven
    inside = free(rail.nodes)
    drift = form_of(rail, DRIFT)[np.ix_(inside, inside)]
    assert np.abs(drift + drift.T).max() < 1e-14 * np.abs(drift).max()
    assert np.abs(drift).max() > 0.1


@pytest.mark.parametrize("which", [MASS, BENDING, TENSION])
def test_forms_of_energies_are_symmetric_and_definite(uneven, which):
    rail, _, _ = uneven
    form = form_of(rail, which)[np.ix_(free(rail.nodes), free(rail.nodes))]
    assert np.abs(form - form.T).max() < 1e-15 * np.abs(form).max()
    assert np.linalg.eigvalsh(form)[0] > 0


def test_every_wheel_stands_on_a_node_and_elements_fit_the_wheelbase(uneven):
    rail, nodes, _ = uneven
    assert nodes[0] == -13.0
    assert nodes[-1] == 13.0
    assert np.all(np.diff(nodes) > 0.5 * 0.7)
    assert np.all(np.diff(nodes) < 1.5 * 0.7)
    assert nodes[rail.contact] == pytest.approx(UNEVEN, abs=1e-12)
    assert rail.nodes == nodes.size


def test_wheels_outside_the_domain_are_refused():
    with pytest.raises(ValueError, match="do not fit"):
        rail_model(track(0.5, length=8.0), WHEELS)


def test_forms_of_a_polynomial_deflection_are_its_integrals(uneven):
    """A cubic that vanishes at both ends is represented exactly, whatever the mesh."""
    rail, nodes, _ = uneven
    cubic = np.polynomial.Polynomial([-169.0, 0, 1.0]) * np.polynomial.Polynomial([1.0, 0.3]) * 1e-3
    y = held_values(cubic(nodes), cubic.deriv()(nodes))
    for form, (left, right) in FORMS.items():
        integral = (cubic.deriv(left) * cubic.deriv(right)).integ()
        expected, scale = integral(13.0) - integral(-13.0), np.abs(form_of(rail, form)).max() * (y @ y)
        computed = sum(weighed(row, form, pair_sums(run, y, y)) for run, row in zip(rail.runs, rail.forms, strict=True))
        assert computed == pytest.approx(expected, abs=1e-12 * scale), form


@pytest.mark.parametrize(("V", "A"), [(0.0, 0.0), (44.0, -1.5), (300.0, -40.0)])
def test_steady_matrix_and_residual_are_those_of_the_model(uneven, V, A):
    rail, _, exact = uneven
    M, C, K = exact_matrices(rail, exact, V, A)
    steady, inside = exact_matrices(rail, exact, V, 0.0)[2], free(rail.nodes)
    computed = dense(rail.runs, steady_rows(rail, V))[np.ix_(inside, inside)]
    assert np.abs(computed - steady).max() < 1e-12 * np.abs(steady).max()
    rng, size = np.random.default_rng(3), 2 * rail.nodes
    y, rate, second = rng.normal(size=(3, size))
    for vector in (y, rate, second):
        vector[[0, rail.nodes - 1]] = 0.0
    rows, residual = np.zeros((len(rail.runs), MATRICES)), np.full(size, 7.0)
    for step in (0.0, 0.03):
        for part in (y, rate, second):  # one at a time: none may hide behind the stiffest term
            u, v, a = (part if part is other else np.zeros(size) for other in (y, rate, second))
            rail_residual(rail, u, v, a, step, V, A, rows, residual)
            expected = K @ (u + step**2 * a)[inside] + C @ (v + step * a)[inside] + M @ a[inside]
            assert np.abs(residual[inside] - expected).max() < 1e-12 * np.abs(expected).max()
            assert not np.any(residual[[0, rail.nodes - 1]])


@pytest.mark.parametrize("h", [0.0, 1e-5, 3e-3, 0.07])
def test_stage_matrix_is_factored_and_condensed_on_the_wheels(uneven, h):
    rail, _, exact = uneven
    V, A, nodes, inside = 44.0, -30.0, rail.nodes, free(rail.nodes)
    M, C, K = exact_matrices(rail, exact, V, A)
    work = rail_work(rail)
    work.flexibility[:] = 1.0
    prepare_rail(rail, work, h, V, A)
    under_wheels = np.zeros((2 * nodes, 4))
    under_wheels[rail.contact, np.arange(4)] = 1.0
    expected = np.linalg.solve(M + h * C + h**2 * K, under_wheels[inside])
    (flexibility,) = work.flexibility
    computed = flexibility.transpose(1, 0, 2).reshape(-1, 4)
    assert np.array_equal(work.between, computed[rail.contact])
    assert np.abs(computed[inside] - expected).max() < 1e-9 * np.abs(expected).max()
    assert not np.any(computed[[0, nodes - 1]])


def test_banded_solutions_agree_with_dense_ones():
    """Runs of one node, of several, and ends whose rows reach beyond the beam."""
    rng, nodes = np.random.default_rng(4), 30
    bounds = [(0, 1), (1, 12), (12, 13), (13, 29), (29, 30)]
    runs = np.array([(a, b, max(a - 1, 0), min(a + 1, nodes - 1)) for a, b in bounds], dtype=np.uint64)
    rows = rng.normal(size=(5, 2, 6))
    rows[:, 0, 2] += 9.0
    rows[:, 1, 3] += 9.0
    rows[0, :, :2] = rows[-1, :, 4:] = 0.0
    full = dense(runs, rows)
    one, four = rng.normal(size=2 * nodes), rng.normal(size=(nodes, 2, 4))
    expected_one = np.linalg.solve(full, one)
    expected_four = np.linalg.solve(full, four.transpose(1, 0, 2).reshape(-1, 4))
    factors, rows = np.zeros((12, nodes)), rows.reshape(5, 12)
    form = sum(weighed(row, 0, pair_sums(run, one, expected_one)) for run, row in zip(runs, rows, strict=True))
    assert form == pytest.approx(one @ one, rel=1e-11)
    factor_rows(runs, rows, factors)
    solve_one(factors, one)
    solve_four(factors, four)
    assert one == pytest.approx(expected_one, rel=1e-11, abs=1e-13)
    assert four.transpose(1, 0, 2).reshape(-1, 4) == pytest.approx(expected_four, rel=1e-11, abs=1e-13)


def test_energies_use_the_material_velocity(uneven):
    """Kinetic energy and foundation loss of a rail in motion, by quadrature of y_t - V y_r (theory section 9)."""
    rail, nodes, _ = uneven
    rng, V = np.random.default_rng(5), 44.0
    y, rate = rng.normal(size=2 * nodes.size), 300.0 * rng.normal(size=2 * nodes.size)
    y[[0, nodes.size - 1]] = rate[[0, nodes.size - 1]] = 0.0
    points, weights = np.polynomial.legendre.leggauss(6)
    kinetic = elastic = loss = 0.0
    all_y, all_rate = (values.reshape(2, -1).T.ravel() for values in (y, rate))
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


@pytest.mark.parametrize("part", [0.0, 0.9, 0.9999])
@pytest.mark.parametrize("damping", [0.0, 1e5])
@pytest.mark.parametrize("shear", [0.0, SHEAR, 3e6])
def test_steady_shapes_need_no_pivoting_below_the_critical_speed(part, damping, shear):
    """Beside a solution with pivoting, up to next to the critical speed."""
    rail = rail_model(track(0.5, length=50.0, shear=shear, damping=damping), UNEVEN)
    speed = part * critical_speed(rail)
    loads = np.zeros((2 * rail.nodes, 4))
    loads[rail.contact, np.arange(4)] = -1.0
    expected = np.linalg.solve(dense(rail.runs, steady_rows(rail, speed)), loads)
    assert np.abs(steady_shapes(rail, speed) - expected).max() < 1e-10 * np.abs(expected).max()


def test_rail_ends_do_not_move_and_unit_loads_push_down():
    rail = rail_model(track(0.5), WHEELS)
    shapes = steady_shapes(rail, 22.0)
    assert np.all(shapes[rail.contact, np.arange(4)] < 0)
    assert not np.any(shapes[[0, rail.nodes - 1]])
    assert abs(shapes[rail.nodes]).max() < 1e-6 * abs(shapes).max()  # slope at the left end, 36 m from any load
