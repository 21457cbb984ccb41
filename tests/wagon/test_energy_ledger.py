"""The energy ledger, added up again from a recorded history by formulas of its own (theory section 9)."""

import numpy as np
import pytest
from plain_lagrangian import elongations, half_full_cylinder, plain_matrices
from test_equations_of_motion import RADIUS, STOP, displacements, of_wheels

from slosh_cli.solver.setup import problem
from slosh_cli.track.moving import rail_ledger

LOST = ("brake", "creep", "suspension", "foundation", "resistance", "slosh_damping")
STORED = ("kinetic", "elastic", "slosh")


@pytest.fixture(scope="module")
def run(stop):
    return stop(*STOP)


@pytest.fixture(scope="module")
def rates(run):
    """Velocities (17, n): speeds as recorded, the rest by differences over 1 ms."""
    q = displacements(run)
    v = np.gradient(q, run.time, axis=1)
    v[0] = run.channels["speed"]
    v[11:15] = of_wheels(run, "speed") / RADIUS
    return v


def initial_kinetic(run):
    load = half_full_cylinder(run.scenario)
    mass = 21.3e3 + 2 * 1.8e3 + 4 * 1.4e3 + load.mass + 4 * 120 / RADIUS**2
    return 0.5 * mass * run.initial_speed_m_s**2


def taken(run, power):
    """Running integral of a power (W of the whole wagon), from t = 0."""
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(run.time)
    return np.concatenate([[0.0], np.cumsum(steps)])


def close(run, name, power, share):
    """Largest gap between a recorded loss and the integral of `power`, relative to the initial kinetic energy."""
    gap = np.abs(run.channels[f"energy_{name}"] - taken(run, power)).max()
    assert gap < share * initial_kinetic(run), (name, gap / initial_kinetic(run))


def test_initial_kinetic_energy_is_that_of_wagon_and_wheels(run):
    rail = 1e-6  # the rail's dip runs along with the wagon
    assert run.energy["initial_kinetic"] == pytest.approx(initial_kinetic(run), rel=rail)
    assert run.channels["energy_kinetic"][0] == pytest.approx(run.energy["initial_kinetic"], rel=1e-12)


def test_brakes_take_torque_times_rotation_against_the_bogie(run, rates):
    """The row at the onset still belongs to the time before."""
    torque, spin = of_wheels(run, "brake_torque"), of_wheels(run, "speed") / RADIUS
    power = 2 * (torque * (spin - rates[[4, 4, 6, 6]])).sum(axis=0)
    onset = np.argmin(np.abs(run.time - 0.5))
    assert np.all(torque[:, onset] == 0.0)
    assert np.all(torque[:, onset + 1] == 17.5e3)
    power[onset] = power[onset + 1]
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[onset + 1 :] + power[onset:-1]) * np.diff(run.time[onset:]))])
    assert run.channels["energy_brake"][onset:] == pytest.approx(work, abs=1e-5 * initial_kinetic(run))
    assert np.all(run.channels["energy_brake"][: onset + 1] == 0.0)
    assert run.energy["brake"] > 0.1 * initial_kinetic(run)


def test_creep_takes_force_times_slip(run):
    slip = run.channels["speed"] - of_wheels(run, "speed")
    close(run, "creep", 2 * (of_wheels(run, "tangential_force") * slip).sum(axis=0), 1e-5)
    assert run.energy["creep"] > 0.3 * initial_kinetic(run)


def test_resistance_takes_force_times_speed(run):
    V = run.channels["speed"]
    close(run, "resistance", (851 + 13.5 * V + 1.244 * V**2) * V, 1e-8)


def test_dampers_take_what_their_ends_move(run, rates):
    power = 0.0
    for unit, speed in elongations_of(run, rates):
        power = power + 2 * unit.damping * speed**2
    assert run.channels["energy_suspension"] == pytest.approx(taken(run, power), abs=1e-2 * run.energy["suspension"])


def elongations_of(run, motion):
    """Suspension units and the relative motion of their ends along the record."""
    unit = np.eye(motion.shape[0])
    per_coordinate = [elongations(run.scenario, row) for row in unit]
    for k, (suspension, _) in enumerate(per_coordinate[0]):
        yield suspension, np.array([found[k][1] for found in per_coordinate]) @ motion


def test_slosh_damping_takes_its_share(run, rates):
    modes = half_full_cylinder(run.scenario).modes
    power = sum(2 * zeta * omega * mu * rates[15 + n] ** 2 for n, (omega, _, _, mu, zeta) in enumerate(modes))
    close(run, "slosh_damping", power, 1e-6)
    assert run.energy["slosh_damping"] > 1e-4 * initial_kinetic(run)


def test_kinetic_energy_is_that_of_the_recorded_speeds(run, rates):
    """Away from onset and locks, where differences over 1 ms do not give the bogies' pitch rates."""
    mass = plain_matrices(run.scenario, half_full_cylinder(run.scenario)).mass
    kinetic = 2 * 0.5 * np.einsum("in,ij,jn->n", rates, mass, rates)
    torque = of_wheels(run, "brake_torque")
    jumps = run.time[1:][np.any(np.abs(np.diff(torque, axis=1)) > 100.0, axis=0)]
    calm = np.all(np.abs(run.time[:, None] - jumps) > 0.1, axis=1)
    assert calm.mean() > 0.9
    gap = np.abs(run.channels["energy_kinetic"] - kinetic)[calm]
    assert gap.max() < 5e-6 * initial_kinetic(run)


def test_elastic_energy_at_the_start_is_of_springs_contacts_and_rail(run):
    """`2/5 N approach` in every contact; the rail's share by its kernel, which has a test of its own."""
    stop, q = problem(run.scenario), displacements(run)[:, :1]
    start = stop.vehicle.points[0].rail
    _, rail, _ = rail_ledger(stop.vehicle.rail, start, 0 * start, run.initial_speed_m_s)
    springs = sum(unit.stiffness * length**2 for unit, length in elongations_of(run, q))[0]
    approach = (of_wheels(run, "rail_deflection") - of_wheels(run, "heave"))[:, 0]
    contacts = 2 * 0.4 * of_wheels(run, "normal_force")[:, 0] @ approach
    assert run.channels["energy_elastic"][0] == pytest.approx(springs + contacts + 2 * rail, rel=1e-9)


def test_potential_energy_at_the_end_is_of_weights_tilt_and_modes(run):
    """At a step's end, where nothing is interpolated, to a thousandth of a joule: the load's tilt is a few."""
    load, q = half_full_cylinder(run.scenario), displacements(run)[:, -1]
    plain = plain_matrices(run.scenario, load)
    springs = sum(unit.stiffness * length**2 for unit, length in elongations_of(run, q))
    expected = q @ plain.stiffness @ q - 2 * plain.weight @ q - springs
    tilt = load.mass * 9.81 * load.centre * q[2] ** 2 / 2
    assert run.energy["slosh"] == pytest.approx(expected, abs=1e-3)
    assert tilt > 0.1


def test_elastic_and_potential_energy_are_those_of_the_recorded_places(run):
    """Springs, contacts and rail are elastic; weights, the load's tilt and the modes' own are the rest."""
    load, q = half_full_cylinder(run.scenario), displacements(run)
    plain = plain_matrices(run.scenario, load)
    springs = sum(unit.stiffness * length**2 for unit, length in elongations_of(run, q))
    everything = np.einsum("in,ij,jn->n", q, plain.stiffness, q) - 2 * plain.weight @ q
    potential = everything - springs
    assert np.abs(run.channels["energy_slosh"] - potential).max() < 1e-6 * initial_kinetic(run)
    approach = np.maximum(of_wheels(run, "rail_deflection") - of_wheels(run, "heave"), 0.0)
    contacts = 2 * (0.4 * of_wheels(run, "normal_force") * approach).sum(axis=0)
    # a rail that bends under loads of nearly steady shape stores half of force times deflection
    rail = -(of_wheels(run, "normal_force") * of_wheels(run, "rail_deflection")).sum(axis=0)
    elastic = run.channels["energy_elastic"]
    assert elastic - springs - contacts == pytest.approx(rail, rel=0.05)


def test_ledger_is_the_sum_of_its_parts(run):
    now = sum(run.channels[f"energy_{name}"] for name in STORED)
    lost = sum(run.channels[f"energy_{name}"] for name in LOST)
    balance = now + lost - run.channels["energy_slope_work"]
    residual = (balance - balance[0]) / run.energy["initial_kinetic"]
    # stored energies are interpolated between steps, so a row may see a little more than the steps do
    assert np.abs(residual - run.channels["energy_residual"]).max() < 1e-6
    assert np.abs(run.channels["energy_residual"]).max() <= run.energy_residual
    for name in (*LOST, *STORED, "slope_work"):
        assert run.energy[name] == pytest.approx(run.channels[f"energy_{name}"][-1], rel=1e-9, abs=1e-3), name


def test_losses_only_grow(run):
    for name in ("creep", "suspension", "foundation", "resistance", "slosh_damping"):
        assert np.all(np.diff(run.channels[f"energy_{name}"]) > -1e-9 * initial_kinetic(run)), name
    assert run.energy["foundation"] == pytest.approx(run.energy["slope_work"], rel=0.05)
