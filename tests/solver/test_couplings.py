"""A train's couplings in the engine: exact oscillators, a brake wave through stiff couplings, momentum, friction."""

from itertools import pairwise

import numpy as np
import pytest

from slosh_cli.compiled import kernel
from slosh_cli.method import DIAGONAL, END, MIDDLE, OUTER, START
from slosh_cli.scenario.schema_train import COUPLINGS, Coupling, LinearCoupling, force_at
from slosh_cli.solver import advance as loop
from slosh_cli.solver.run import integrate
from slosh_cli.solver.setup import problem, train_problem
from slosh_cli.train.coupling import couplings

HEIGHTS = ("traction_height", "coupling_height", "car_body.centre_height", "bogie.centre_height")
RIGID = "{stiffness: 1e9 N/m, damping: 1e6 N s/m}"
POINT_MASS = (
    *(f"wagon.{height}=0.46 m" for height in HEIGHTS),
    "wagon.wheelset.spin_inertia=0.5 kg m^2",
    "wagon.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s^2/m^2}",
    f"wagon.primary_suspension={RIGID}",
    f"wagon.secondary_suspension={RIGID}",
    "tank.fill=0.02",
    "contact.adhesion=1.2",
    "braking.initial_speed=10 m/s",
    "solver.tolerance=1e-6",
    "output.interval=2 ms",
)
"""A wagon that is a point mass but for 5 us in which its wheels wind up, and 0.5 kg m^2 of spin."""
STIFFNESS = 2e5


def inertia(vehicle):
    """Mass (kg) of a whole vehicle with what turns."""
    wagon = vehicle.wagon
    spins = sum(wagon.mass[i, i] for i in range(wagon.first_spin, wagon.coordinates))
    return 2.0 * (wagon.mass[0, 0] + spins / wagon.wheel_radius**2)


def linear(stiffness, damping=0.0):
    return Coupling(linear=LinearCoupling(stiffness=stiffness, damping=damping))


def test_two_vehicles_with_a_linear_coupling_swing_about_the_steady_force(shipped):
    """Step brakes of different strength: `F = F0 (1 - cos w t)`, F0 from both masses, its peak twice that."""
    front = shipped("paper_80_solid", *POINT_MASS, "braking.torque=2.5 kN m", "braking.stop_speed=8.5 m/s")
    rear = shipped("paper_80_solid", *POINT_MASS, "braking.torque=0.4 kN m", "wagon.car_body.mass=10 t")
    stops = train_problem((front, rear), linear(STIFFNESS))
    run = integrate(stops[0])
    masses, brakes = [inertia(stop.vehicle) for stop in stops], [8 * 2.5e3 / 0.46, 8 * 0.4e3 / 0.46]
    steady = (masses[1] * brakes[0] - masses[0] * brakes[1]) / sum(masses)
    pulse = np.sqrt(STIFFNESS * sum(masses) / np.prod(masses))
    time, force = run.rows[:, 0, 0], run.rows[:, 0, -2]
    exact = steady * (1.0 - np.cos(pulse * np.maximum(time - 0.5, 0.0)))
    assert time[-1] > 0.5 + 1.25 * np.pi / pulse
    assert np.abs(force - exact).max() < 2e-5 * steady
    assert run.train.couplings.largest[0] == pytest.approx(2.0 * steady, rel=1e-5)
    assert run.train.largest_residual < 1e-7


def test_equal_masses_with_linear_couplings_are_a_chain(shipped):
    """Five of them, braked one after the other: the normal modes, each an oscillator with its own start."""
    count, torque, damping, lag = 5, 1.5e3, 4e3, 0.1
    onsets = [0.2 + lag * k for k in range(count)]
    each = [shipped("paper_80_solid", *POINT_MASS, "braking.torque=1.5 kN m", f"braking.onset={t} s") for t in onsets]
    each[0] = each[0].with_({"braking.stop_speed": 8.5})
    stops = train_problem(each, linear(STIFFNESS, damping))
    run = integrate(stops[0])
    time, mass = run.rows[:, 0, 0], inertia(stops[0].vehicle)
    apart = np.diff(np.eye(count), axis=0)
    values, shapes = np.linalg.eigh(apart.T @ apart)
    places = np.zeros((len(time), count))
    for value, shape in zip(values, shapes.T, strict=True):
        for push, onset in zip(-8 * torque / 0.46 / mass * shape, onsets, strict=True):
            t = np.maximum(time - onset, 0.0)
            places += np.outer(push * swing(t, STIFFNESS / mass * value, 0.5 * damping / mass * value), shape)
    exact = places @ apart.T
    assert np.abs(run.rows[:, :-1, -1] - exact).max() < 3e-5 * np.abs(exact).max()
    rates = np.gradient(exact, time, axis=0)
    assert run.rows[:, :-1, -2] == pytest.approx(STIFFNESS * exact + damping * rates, abs=60.0)


def swing(t, square, fading):
    """Answer of an oscillator `y'' + 2 fading y' + square y = 1` from rest."""
    if square < 1e-9:
        return 0.5 * t * t
    pulse = np.sqrt(square - fading**2)
    return (1.0 - np.exp(-fading * t) * (np.cos(pulse * t) + fading / pulse * np.sin(pulse * t))) / square


@pytest.mark.parametrize(("build_up", "largest"), [(4.0, 81e3), (24.0, 13.5e3)])
def test_stiff_couplings_carry_what_the_brake_wave_leaves_out(shipped, build_up, largest):
    """`(m/l) a L^2/(8 c T)` in the middle of thirty wagons of 75 t and 16 m, 0.6 m/s^2, c 250 m/s."""
    mass, length, speed, count = 75e3, 16.0, 250.0, 30
    sets = ("tank.fill=0.02", "wagon.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s^2/m^2}")
    wagon = shipped("paper_80_solid", *sets, "braking.initial_speed=100 km/h", "output.interval=0.1 s")
    empty = inertia(problem(wagon).vehicle)
    wagon = wagon.with_({"wagon.car_body.mass": wagon.wagon.car_body.mass + mass - empty})
    torque = 0.6 * mass * 0.46 / 8.0
    each = [
        wagon.with_(
            {
                "braking.torque": torque,
                "braking.onset": 0.5 + (k + 0.5) * length / speed,
                "braking.application": {"form": "linear", "time": build_up},
                "braking.stop_speed": 14.0,
            }
        )
        for k in range(count)
    ]
    run = integrate(train_problem(each, linear(2e9, 4e6))[0])
    found = run.train.couplings.largest
    assert largest == pytest.approx(mass / length * 0.6 * (count * length) ** 2 / (8 * speed * build_up), rel=5e-3)
    assert found.max() == pytest.approx(largest, rel=0.02)
    assert abs(int(np.argmax(found)) - 14) <= 1


def test_momentum_is_what_rails_and_air_give_and_couplings_cancel(shipped):
    """To rounding, step by step, with friction couplings and wheels that lock."""
    sets = ("wagon.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s^2/m^2}",)
    each = [shipped("paper_80_solid", *sets, f"braking.onset={0.2 + 0.1 * k} s", f"braking.torque={5 + 20 * k} kN m")
            for k in range(3)]  # fmt: skip
    train = train_problem(each, COUPLINGS["screw"])[0].train
    rows = np.zeros((2000, 3, 200))
    largest = missed = 0.0
    for _ in range(400):
        before, steps, clock = [state(vehicle, START) for vehicle in train.vehicles], train.steps, train.time
        assert loop.advance(train, rows, 1) == loop.RUNNING
        if train.steps == steps:
            continue
        gained = impulse = 0.0
        for vehicle, (held, creep) in zip(train.vehicles, before, strict=True):
            (_, middle), (momentum, end) = state(vehicle, MIDDLE), state(vehicle, END)
            gained += momentum - held
            impulse -= (train.time - clock) * (OUTER * (creep + middle) + DIAGONAL * end)
        missed, largest = max(missed, abs(gained - impulse)), max(largest, abs(impulse))
    assert any(vehicle.locked.any() for vehicle in train.vehicles)
    assert np.abs(train.couplings.force).max() > 5e3
    assert largest > 100.0
    assert missed < 1e-8 * largest


def state(vehicle, stage):
    """Momentum (N s) along the track and sum of creep forces (N)."""
    point = vehicle.points[stage]
    return float(vehicle.wagon.mass[0] @ point.v), float(point.creep.sum())


def test_a_train_of_one_is_the_wagon(shipped):
    scenario = shipped("paper_80_solid", "output.interval=1 s")
    alone, train = (integrate(stop) for stop in (problem(scenario), train_problem((scenario,), COUPLINGS["screw"])[0]))
    assert np.array_equal(alone.rows[:, 0, : train.rows.shape[2]], train.rows[:, 0])
    assert train.train.steps == alone.train.steps


def test_a_coupling_without_stiffness_leaves_two_stops(shipped):
    """Each stops where it stops alone, to the tolerance."""
    sets = ("braking.stop_speed=5 m/s", "output.interval=1 s")
    each = [shipped("paper_80_solid", *sets, f"braking.torque={torque} kN m") for torque in (5, 6)]
    rows = integrate(train_problem(each, linear(0.0))[0]).rows
    for k, scenario in enumerate(each):
        alone = integrate(problem(scenario)).rows[:, 0]
        common = min(len(alone), len(rows)) - 1
        assert rows[:common, k, 1] == pytest.approx(alone[:common, 1], rel=1e-4)


@kernel
def drive(law, places, forces):
    for i in range(places.size):
        forces[i], _, _ = law.follow(0, 1, 1e-3, places[i], 0.0)
        law.compression[0, 0], law.spring[0, 0] = law.compression[1, 0], law.spring[1, 0]


def along(*corners):
    """Compressions (m) between the corners, in tenths of a millimetre."""
    ways = [np.linspace(a, b, max(round(abs(b - a) / 1e-4), 1) + 1)[1:] for a, b in pairwise(corners)]
    return np.concatenate(ways)


@pytest.mark.parametrize("name", ["screw", "automatic"])
def test_a_friction_spring_keeps_to_its_definition(name):
    """Loops within loops, slack, stop: each step is the clip of its definition; round trips never give energy."""
    coupling = COUPLINGS[name]
    places = along(0.0, 0.08, 0.03, 0.06, 0.04, 0.118, -0.02, -0.09, -0.05, -0.07, 0.02, 0.119, 0.0)
    forces = np.zeros(places.size)
    law = couplings(coupling, np.zeros(1), 0.5)
    drive(law, places, forces)
    held, before = 0.0, 0.0
    for place, force in zip(places, forces, strict=True):
        side, sign = (coupling.compression, 1.0) if place >= 0.0 else (coupling.tension, -1.0)
        ends = sorted(sign * force_at(branch, abs(place)) for branch in (side.loading, side.unloading))
        held, before = np.clip(held + coupling.transition_stiffness * (place - before), *ends), place
        assert force == pytest.approx(held, abs=1e-6 * max(abs(ends[0]), abs(ends[1])) + 1e-6)
    work = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(places) * (forces[1:] + forces[:-1]))])
    for level in np.arange(-0.08, 0.11, 0.01):
        passed = np.flatnonzero(np.abs(places - level) < 1e-9)
        for first, last in pairwise(passed):
            if forces[last] >= forces[first] - 1e-9:
                assert work[last] >= work[first] - 1e-6


@kernel
def follow(law, apart, place, rate):
    return law.follow(0, 1, apart, place, rate)


def on_the_way(name, start, rate):
    """A coupling's law that stands loaded at `start` (m) with a `rate` (m/s)."""
    law = couplings(COUPLINGS[name], np.zeros(1), 0.5)
    drive(law, along(0.0, start), np.zeros(along(0.0, start).size))
    law.rate[0, 0] = rate
    return law


TURNS = [("screw", 0.05, 0.1), ("screw", -0.03, -0.1), ("automatic", 0.06, 0.1), ("screw", 0.05, 0.02)]


@pytest.mark.parametrize(("name", "start", "rate"), TURNS)
@pytest.mark.parametrize("part", [0.2, 0.5, 0.9])
def test_a_spring_that_turns_back_within_a_step_goes_there_first(name, start, rate, part):
    """At a constant deceleration, against the way there and back in small pieces."""
    apart, end = 0.04, rate * (1.0 - 1.0 / part)
    turn, back = start + 0.5 * rate * part * apart, 0.5 * end * (1.0 - part) * apart
    pieces = along(0.0, start, turn, turn + back)
    forces = np.zeros(pieces.size)
    drive(couplings(COUPLINGS[name], np.zeros(1), 0.5), pieces, forces)
    found, _, _ = follow(on_the_way(name, start, rate), apart, turn + back, end)
    assert found == pytest.approx(forces[-1], rel=1e-9)


@pytest.mark.parametrize(("name", "start", "rate"), TURNS)
@pytest.mark.parametrize("back", [-0.01, -0.4])
def test_derivatives_of_a_force_are_those_of_its_differences(name, start, rate, back):
    """Without a turn, with one that leaves the branch, and with one as far as the other branch."""
    for end in (0.5 * rate, back * rate, 20.0 * back * rate):
        place = start + 0.02 * (rate + end)
        law = on_the_way(name, start, rate)
        _, by_place, by_rate = follow(law, 0.04, place, end)
        change = [
            follow(law, 0.04, place + 1e-8 * i, end + 1e-6 * j)[0]
            - follow(law, 0.04, place - 1e-8 * i, end - 1e-6 * j)[0]
            for i, j in ((1, 0), (0, 1))
        ]
        assert by_place == pytest.approx(change[0] / 2e-8, rel=1e-4, abs=1.0)
        assert by_rate == pytest.approx(change[1] / 2e-6, rel=1e-4, abs=1.0)


@pytest.mark.parametrize("name", ["screw", "automatic"])
def test_half_the_tolerance_leaves_the_largest_force(shipped, name):
    largest = []
    for tolerance in (1e-4, 2.5e-5):
        each = [
            shipped(
                "paper_80_solid", f"braking.onset={0.5 + 0.06 * k} s", "braking.torque=4 kN m", "output.interval=1 s",
                "braking.application=P", "tank.fill=0.9", f"solver.tolerance={tolerance}", "braking.stop_speed=8 m/s",
            )
            for k in range(6)
        ]  # fmt: skip
        train = integrate(train_problem(each, COUPLINGS[name])[0]).train
        assert train.largest_residual < 1e-5
        assert (train.couplings.taken > -1e-3).all()
        largest.append(train.couplings.largest.max())
    assert largest[0] == pytest.approx(largest[1], rel=2e-3)


def test_wheels_of_a_vehicle_that_is_pulled_back_turn_back(shipped):
    """The light vehicle stops first, and the soft coupling takes it back; a step or two for each of its wheels."""
    each = [
        shipped(
            "paper_80_solid", "braking.initial_speed=30 km/h", "output.interval=1 s", f"braking.torque={torque} kN m",
            f"tank.fill={fill}", "tank.coefficients=computed",
        )
        for torque, fill in ((10, 0.1), (3, 0.9))
    ]  # fmt: skip
    train = integrate(train_problem(each, linear(1.4e5))[0]).train
    assert train.vehicles[1].points[START].v[0] < -0.1
    assert (train.vehicles[1].turning == -1.0).all()
    assert train.rejected < 200


def test_brakes_of_several_vehicles_may_break_at_once_but_for_rounding(shipped):
    """0.3 s and 15 samples of 50 ms are not 1.05 s to the last bit."""
    protected = "braking.slide_protection={period: 50 ms}"
    each = [
        shipped(
            "paper_80_solid", "output.interval=1 s", "braking.stop_speed=18 m/s", f"braking.onset={onset!r} s", *more
        )
        for onset, more in ((0.3, (protected,)), (1.05, ("braking.application={form: linear, time: 3 s}",)))
    ]
    run = integrate(train_problem(each, linear(1e6))[0])
    assert run.outcome == loop.STOPPED
    assert run.train.steps < 1000


def test_vehicles_that_stand_while_their_train_still_rolls_do_not_slide(shipped):
    """The light vehicle stands on locked wheels, held by its brake; one whose brake is too strong slides there."""

    def light(torque):
        each = [
            shipped(
                "paper_80_solid", "braking.initial_speed=30 km/h", "output.interval=1 s", f"tank.fill={fill}",
                "tank.coefficients=computed", f"braking.torque={own} kN m",
            )
            for own, fill in ((torque, 0.1), (2.5, 0.9))
        ]  # fmt: skip
        return integrate(train_problem(each, linear(5e4))[0]).train.vehicles[0]

    for torque in (4, 5):
        stood = light(torque)
        assert stood.locked.all()
        assert abs(stood.points[START].v[0]) < 1e-4
        assert (stood.account.locked_time == 0.0).all()
    slid = light(60)
    assert (slid.account.locked_time > 9.0).all()
    assert (slid.account.slid > 40.0).all()
