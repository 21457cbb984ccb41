"""A run is a list of vehicles: how many there are, and how many wheels each has, is data."""

import numpy as np
import pytest
from scipy.integrate import quad

from slosh_cli.arrays import Vector
from slosh_cli.compiled import kernel
from slosh_cli.method import END, START
from slosh_cli.solver import advance as loop
from slosh_cli.solver.contacts import compliance
from slosh_cli.solver.initial import initial_point
from slosh_cli.solver.record import columns_of
from slosh_cli.solver.setup import problem
from slosh_cli.solver.stage import prepare_stage, solve_stage
from slosh_cli.solver.train import new_train
from slosh_cli.solver.vehicle import Scales, new_vehicle
from slosh_cli.track.mem import rail_model
from slosh_cli.wagon.brake import torque_brake
from slosh_cli.wagon.model import CAR_HEAVE, CAR_PITCH, FIRST_BOGIE, WagonModel

G = 9.81


def run(train):
    """The rows of a run to its end."""
    widest = max(columns_of(vehicle).end for vehicle in train.vehicles)
    rows = np.zeros((20_000, len(train.vehicles), widest))
    outcome = loop.RUNNING
    while outcome == loop.RUNNING:
        outcome = loop.advance(train, rows, 1000)
    assert outcome == loop.STOPPED
    return rows[: train.rows]


def train_of(*scenarios):
    stops = [problem(scenario) for scenario in scenarios]
    return new_train(tuple(stop.vehicle for stop in stops), stops[0].train.control, 1e-3)


@pytest.mark.parametrize("name", ["paper_80", "paper_80_solid"])
def test_vehicles_without_couplings_stop_as_each_alone(shipped, name):
    """Three of the same, and one of them alone; the machine code is the same for both."""
    scenario = shipped(name, "output.interval=0.1 s")
    alone = train_of(scenario)
    one = run(alone)[:, 0]
    kernels = len(loop.advance.signatures)
    train = train_of(scenario, scenario, scenario)
    rows = run(train)
    assert len(loop.advance.signatures) == kernels
    assert train.steps == alone.steps
    for k in range(3):
        assert rows[:, k] == pytest.approx(one, rel=1e-12, abs=1e-9)
    assert train.initial_kinetic == pytest.approx(3 * alone.initial_kinetic, rel=1e-14)
    assert train.largest_residual == pytest.approx(alone.largest_residual, rel=1e-6)


def test_vehicles_of_different_sizes_share_one_run(shipped):
    """Another rail, another load, another brake beside it: each keeps its own distance, to the tolerance."""
    tight = ("solver.tolerance=1e-6", "output.interval=0.1 s", "braking.stop_speed=2 m/s")
    long_rail = shipped("paper_80_solid", *tight, "track.domain.length=60 m", "braking.torque=5 kN m")
    light = shipped("paper_80_solid", *tight, "tank.fill=0.3", "braking.torque=3.2 kN m")
    places = [run(train_of(scenario))[:, 0, 1:3] for scenario in (long_rail, light)]
    rows = run(train_of(long_rail, light))
    for k, place in enumerate(places):
        common = min(len(place), len(rows)) - 1
        assert rows[:common, k, 1] == pytest.approx(place[:common, 0], rel=2e-6, abs=1e-6)


@kernel
def stage_with(train, force, step, stiffness: Vector):
    """Acceleration of the coupling point at a stage from the start under a coupling force, and the compliance there."""
    vehicle = train.vehicles[0]
    vehicle.coupling_force = force
    if not solve_stage(train, END, step, 0.0):
        return np.nan, np.nan
    row, a, total, give = vehicle.wagon.coupling_row, vehicle.points[END].a, 0.0, 0.0
    for i in range(row.size):
        total += row[i] * a[i]
    compliance(vehicle, step, stiffness)
    for i in range(row.size):
        give += row[i] * stiffness[i]
    return total, give


@pytest.mark.parametrize("name", ["paper_80", "paper_80_solid"])
@pytest.mark.parametrize("step", [1e-4, 2e-3, 2e-2])
def test_a_stage_is_affine_in_the_coupling_force(shipped, name, step):
    """Free acceleration plus compliance times force: what couplings of a train need to know of a vehicle."""
    found = []
    for force in (0.0, 10.0):
        train = problem(shipped(name)).train
        vehicle = train.vehicles[0]
        rows = np.zeros((8, 1, columns_of(vehicle).end))
        loop.advance(train, rows, 3)
        start, base, end = (vehicle.points[stage] for stage in (START, 3, END))
        for quantity in ("q", "v", "rail", "rail_rate"):
            getattr(base, quantity)[:] = getattr(start, quantity)
        for quantity in ("a", "rail_second", "normal"):
            getattr(end, quantity)[:] = getattr(start, quantity)
        prepare(vehicle, step)
        found.append(stage_with(train, force, step, np.zeros(15)))
    (free, give), (pushed, _) = found
    assert (pushed - free) / 10.0 == pytest.approx(give, rel=1e-3)
    inverse_of_mass = 1.0 / vehicle.wagon.mass[0, 0]
    assert give > 0.9 * inverse_of_mass


@kernel
def prepare(vehicle, step):
    prepare_stage(vehicle, step, vehicle.points[0].v[0], vehicle.points[0].a[0])
    vehicle.liquid.predict(0, 0.0, 0.0, step)


def test_a_coupling_force_on_a_free_wagon_is_mass_times_acceleration(shipped):
    """Held by nothing but a constant force at its couplings, a rigid wagon loses what the force takes."""
    quiet = ("braking.onset=100 s", "wagon.running_resistance.constant=0 N", "wagon.running_resistance.linear=0 N s/m")
    scenario = shipped(
        "paper_80_solid", *quiet, "wagon.running_resistance.quadratic=0 N s^2/m^2", "output.interval=1 s"
    )
    train = train_of(scenario)
    vehicle, force = train.vehicles[0], -20e3
    vehicle.coupling_force = force
    rows = np.zeros((2000, 1, columns_of(vehicle).end))
    while train.time < 3.0:
        assert loop.advance(train, rows, 10) == loop.RUNNING
    wagon, v = vehicle.wagon, vehicle.points[START].v
    inertia = wagon.mass[0, 0] + sum(wagon.mass[i, i] for i in range(11, 15)) / wagon.wheel_radius**2
    assert v[0] == pytest.approx(80 / 3.6 + force / inertia * train.time, rel=2e-4)


def eight_wheels():
    """Half a vehicle of 40 t with eight wheels in four bogies: car on bogies on wheels, all springs alike."""
    pivots, bogies, wheels = (6.0, 3.0, -3.0, -6.0), 4, 8
    first_wheel = FIRST_BOGIE + 2 * bogies
    first_spin, coordinates = first_wheel + wheels, first_wheel + 2 * wheels
    mass, stiffness, weight = np.zeros((coordinates,) * 2), np.zeros((coordinates,) * 2), np.zeros(coordinates)

    def put(matrix, value, terms):
        row = np.zeros(coordinates)
        for place, factor in terms:
            row[place] = factor
        matrix += value * np.outer(row, row)

    masses = {CAR_HEAVE: 12e3, **{FIRST_BOGIE + 2 * b: 1e3 for b in range(bogies)}}
    masses |= {first_wheel + w: 0.5e3 for w in range(wheels)}
    mass[0, 0] = sum(masses.values())
    mass[CAR_PITCH, CAR_PITCH] = 2e5
    for place, value in masses.items():
        mass[place, place] = value
        weight[place] = -G * value
    for b, pivot in enumerate(pivots):
        heave = FIRST_BOGIE + 2 * b
        mass[heave + 1, heave + 1] = 800.0
        put(stiffness, 3e6, [(CAR_HEAVE, 1.0), (CAR_PITCH, -pivot), (heave, -1.0)])
        for w, arm in ((2 * b, 0.5), (2 * b + 1, -0.5)):
            put(stiffness, 2e6, [(heave, 1.0), (heave + 1, -arm), (first_wheel + w, -1.0)])
            mass[first_spin + w, first_spin + w] = 60.0
    along = np.zeros(coordinates)
    along[0] = 1.0
    wagon = WagonModel.blank(
        coordinates,
        wheels=wheels,
        bogies=bogies,
        coordinates=coordinates,
        first_wheel=first_wheel,
        first_spin=first_spin,
        frame=np.repeat(np.arange(FIRST_BOGIE + 1, first_wheel, 2), 2),
        mass=mass,
        damping=0.01 * stiffness,
        stiffness=stiffness,
        weight=weight,
        coupling_row=along,
        car_row=along,
        wheel_radius=0.46,
    )
    return wagon, np.array([pivot + arm for pivot in pivots for arm in (0.5, -0.5)])


def test_a_vehicle_of_eight_wheels_stops_as_a_point_mass(shipped):
    """No slip to speak of, a frozen load: `V dV/a` with resistance, the spins' inertia in the mass."""
    scenario = shipped("paper_80_solid", "braking.torque=2 kN m", "braking.onset=0 s", "track.domain.length=60 m")
    stop = problem(scenario)
    wagon, wheels = eight_wheels()
    rail, old, speed = rail_model(scenario.track, wheels), stop.vehicle, 15.0
    start = initial_point(wagon, rail, old.contact, speed)
    assert start.normal.sum() == pytest.approx(G * wagon.mass[0, 0], rel=1e-9)
    scales = Scales(speed=np.full(wagon.coordinates, speed), place=np.ones(wagon.coordinates), slosh=1.0, load=25e3)
    brake = torque_brake(old.brake.count, old.brake.starts[0], wheels=8)
    vehicle = new_vehicle(wagon, old.liquid, rail, old.contact, old.line, brake, scales, start)
    train = new_train((vehicle,), stop.train.control, 1e-3)
    rows = run(train)
    inertia = wagon.mass[0, 0] + 8 * 60.0 / 0.46**2
    a, b, c = vehicle.line.resistance
    exact, _ = quad(lambda v: v * inertia / (8 * 2e3 / 0.46 + a + b * v + c * v * v), 0.02, speed)
    assert vehicle.points[START].q[0] == pytest.approx(exact, rel=2e-3)
    assert train.largest_residual < 1e-4
    normal = rows[:, 0, columns_of(vehicle).normal :][:, :8]
    assert np.mean(normal.sum(axis=1)) == pytest.approx(G * wagon.mass[0, 0], rel=1e-3)
