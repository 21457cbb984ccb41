"""The wagon's matrices against energies spelt out body by body (vehicle sections 1 to 3)."""

import numpy as np
import pytest
from plain_lagrangian import (
    damping_loss,
    half_full_cylinder,
    kinetic_energy,
    plain_matrices,
    potential_energy,
    weights,
)

from slosh_cli.compiled import kernel
from slosh_cli.errors import PhysicsError
from slosh_cli.solver.setup import problem
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.modal import ModalLiquid

NAMES = ["paper_80", "paper_80_solid"]


@pytest.fixture(scope="module", params=NAMES)
def case(request, shipped):
    scenario = shipped(request.param)
    return scenario, problem(scenario).vehicle, half_full_cylinder(scenario)


def random_states(load, count=20):
    rng = np.random.default_rng(11)
    return [rng.normal(size=15 + len(load.modes)) for _ in range(count)]


def test_frozen_load_is_the_half_cylinder(case):
    scenario, _, load = case
    found = frozen_load(scenario.tank)
    assert (found.mass, found.centre_height) == pytest.approx((load.mass, load.centre), rel=1e-9)
    assert found.pitch_inertia == pytest.approx(load.inertia, rel=1e-9)


@kernel
def energies_at(liquid, ride):
    return liquid.energy(ride, 0)


def slosh_energies(vehicle, q, v):
    """Kinetic and potential energy of the modes, beside the frozen load's, at `q` and `v` (15 + modes,)."""
    if not isinstance(vehicle.liquid, ModalLiquid):
        return 0.0, 0.0
    vehicle.liquid.amplitude[0], vehicle.liquid.rate[0] = q[15:], v[15:]
    ride = vehicle.ride
    ride.speed[0], ride.pitch[0], ride.pitch_rate[0] = vehicle.wagon.tank_row @ v[:15], q[2], v[2]
    return energies_at(vehicle.liquid, ride)[:2]


def test_kinetic_energy_of_random_velocities(case):
    scenario, vehicle, load = case
    for v in random_states(load):
        slosh, _ = slosh_energies(vehicle, 0 * v, v)
        expected = kinetic_energy(scenario, load, v)
        assert 0.5 * v[:15] @ vehicle.wagon.mass @ v[:15] + slosh == pytest.approx(expected, rel=1e-12)


def test_potential_energy_of_random_displacements(case):
    scenario, vehicle, load = case
    for q in random_states(load):
        _, slosh = slosh_energies(vehicle, q, 0 * q)
        expected = potential_energy(scenario, load, q)
        assert 0.5 * q[:15] @ vehicle.wagon.stiffness @ q[:15] + slosh == pytest.approx(expected, rel=1e-12)


def test_dampers_lose_what_their_ends_move(case):
    scenario, vehicle, load = case
    for v in random_states(load):
        lost = v[:15] @ vehicle.wagon.damping @ v[:15]
        assert lost == pytest.approx(damping_loss(scenario, load, v), rel=1e-12)


def test_given_modal_damping_is_twice_zeta_omega_mu(shipped):
    given = "[{frequency: 0.6 rad/s, lambda_1: 1e5 kg, lambda_02: 1e4 kg m, mu: 4e5 kg, damping_ratio: 0.03}]"
    vehicle = problem(shipped("paper_80", f"tank.coefficients={given}")).vehicle
    assert vehicle.liquid.damping == pytest.approx([0.5 * 2 * 0.03 * 0.6 * 4e5], rel=1e-12)


def test_one_rail_carries_and_moves_half_of_the_wagon(case):
    scenario, vehicle, load = case
    whole = 21.3e3 + 2 * 1.8e3 + 4 * 1.4e3 + load.mass
    assert vehicle.wagon.mass[0, 0] == pytest.approx(whole / 2, rel=1e-9)
    assert np.diag(vehicle.wagon.mass)[11:] == pytest.approx(60.0)
    assert vehicle.wagon.weight == pytest.approx(weights(scenario, load)[:15], rel=1e-9)
    assert vehicle.wagon.weight.sum() == pytest.approx(-9.81 * whole / 2, rel=1e-9)
    assert vehicle.line.resistance == pytest.approx(np.array([851.0, 13.5, 1.244]) / 2)
    # suspension units are given per unit of the planar model: not halved
    assert np.diag(vehicle.wagon.stiffness)[7:11] == pytest.approx(2.6e6)
    assert np.diag(vehicle.wagon.damping)[7:11] == pytest.approx(1.5e4)
    assert vehicle.brake.count == 5e3  # per wheel: not halved
    for mode, frequency in zip(range(vehicle.liquid.recorded // 2), (0.69,), strict=False):
        halves = (vehicle.liquid.lambda_1[mode], vehicle.liquid.lambda_02[mode], vehicle.liquid.mu[mode])
        assert halves == pytest.approx((137071 / 2, -68461 / 2, 442163 / 2))
        assert vehicle.liquid.stiffness[mode] == pytest.approx(442163 / 2 * frequency**2)


def scaled(scale):
    """The printed coefficients with lambda_1 and lambda_02 enlarged."""
    return (
        f"tank.coefficients=[{{frequency: 0.69 rad/s, lambda_1: {137071 * scale} kg, "
        f"lambda_02: {-68461 * scale} kg m, mu: 442163 kg}}]"
    )


def largest_scale(scenario):
    """Scale of lambda_1 and lambda_02 at which the plain mass matrix loses its definiteness."""
    mass = plain_matrices(scenario, half_full_cylinder(scenario)).mass
    coupling = mass[:15, 15]
    return 1 / np.sqrt(coupling @ np.linalg.solve(mass[:15, :15], coupling) / mass[15, 15])


def test_indefinite_mass_matrix_is_refused(shipped):
    limit = largest_scale(shipped("paper_80"))
    assert 1.0 < limit < 2.0  # so coefficients of the whole tank on half a wagon are refused
    problem(shipped("paper_80", scaled(0.999 * limit)))
    with pytest.raises(PhysicsError, match="not positive definite") as refusal:
        problem(shipped("paper_80", scaled(1.001 * limit)))
    assert refusal.value.where == "tank.coefficients"
    with pytest.raises(PhysicsError, match="not positive definite"):
        problem(shipped("paper_80", scaled(2.0)))


SOFT_TRACK = ("track.foundation.stiffness=1e5 N/m^2", "track.foundation.shear_stiffness=0 N")


def test_supercritical_speed_is_refused(shipped):
    """V_cr = sqrt((k_sm + 2 sqrt(k EI))/m), here 102.1 m/s."""
    heavy = (*SOFT_TRACK, "track.rail.mass_per_length=150 kg/m", "track.domain.length=300 m")
    critical = np.sqrt(2 * np.sqrt(1e5 * 200e9 * 3.06e-5) / 150)
    problem(shipped("paper_80", *heavy, f"braking.initial_speed={0.999 * critical} m/s"))
    with pytest.raises(PhysicsError, match=r"critical speed of 102\.1 m/s") as refusal:
        problem(shipped("paper_80", *heavy, f"braking.initial_speed={1.001 * critical} m/s"))
    assert refusal.value.where == "braking.initial_speed"
