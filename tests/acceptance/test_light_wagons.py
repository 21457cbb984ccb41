"""A shallow-water liquid that outweighs its wagon, up to a hundred times: two other methods, momentum, energy, effort.

The added mass of the liquid that waves reach within a step is then larger than the wagon: a coupling that takes the
push from the last acceleration swings up and takes ever shorter steps.
"""

import numpy as np
import pytest

from slosh_cli.method import START
from slosh_cli.results.simulate import simulate
from slosh_cli.scenario import Scenario
from slosh_cli.solver.run import integrate
from slosh_cli.solver.setup import problem
from tests.reference_code.plain_shallow import PlainTank, circle

LIQUID = 45_469
"""Mass of the half-filled tank's liquid, kg."""
STIFF = ("primary_suspension", "secondary_suspension")


def light(wagon_mass, *more):
    """The paper's wagon, half full, with a `wagon_mass` (kg) of all parts together, on springs that hardly give."""
    part = wagon_mass / 16
    masses = {"car_body": 10 * part, "bogie": part, "wheelset": part}
    return (
        "paper_80",
        "tank.liquid.model=shallow-water",
        "tank.coefficients=computed",
        *(f"wagon.{name}.mass={mass} kg" for name, mass in masses.items()),
        f"wagon.wheelset.spin_inertia={0.05 * part} kg m^2",
        *(f"wagon.{unit}.stiffness=100 MN/m" for unit in STIFF),
        *(f"wagon.{unit}.damping=1 MN s/m" for unit in STIFF),
        "wagon.running_resistance.constant=0 N",
        "wagon.running_resistance.linear=0 N s/m",
        "wagon.running_resistance.quadratic=0 N s^2/m^2",
        *more,
    )


def by_small_steps(scenario: Scenario, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Instants and speeds of a rigid tank under the brakes' force: a step of the liquid's, then one of the tank's.

    `m dv/dt = -8 T/R + walls`, in steps in which no wave crosses a cell; explicit, and stable as the waves of such a
    step reach less than the wagon weighs.
    """
    wagon, tank, braking = scenario.wagon, scenario.tank, scenario.braking
    radius = wagon.wheelset.wheel_radius
    mass = wagon.car_body.mass + 2 * wagon.bogie.mass + 4 * wagon.wheelset.mass
    mass += 4 * wagon.wheelset.spin_inertia / radius**2
    section = circle(tank.radius, tank.liquid.slot_speed)
    area = float(np.interp(tank.fill * 2 * tank.radius, section.depth, section.area))
    liquid = PlainTank(section, tank.length / cells, np.full(cells, area), np.zeros(cells))
    times, speeds = [0.0], [braking.initial_speed]
    while speeds[-1] > braking.stop_speed:
        walls, _, _ = liquid._step(liquid.time, 0.0)  # no time passes
        slowing = (tank.liquid.density * walls - 8 * braking.torque / radius) / mass
        _, _, step = liquid._step(np.inf, slowing)
        liquid.time += step
        times.append(liquid.time)
        speeds.append(speeds[-1] + step * slowing)
    return np.array(times), np.array(speeds)


GENTLE = ("braking.torque=2.5 kN m", "braking.onset=0 s", "solver.time_limit=120 s")
ROOF = ("braking.torque=3 kN m", "braking.onset=0 s", "solver.time_limit=120 s", "tank.fill=0.8")


@pytest.mark.parametrize("ratio", [1, 5, 20, 56])
def test_speed_and_distance_are_those_of_an_explicit_coupling_in_small_steps(stop, shipped, ratio):
    """Bores run, the roof stays dry."""
    case = light(LIQUID / ratio, *GENTLE)
    result = stop(*case)
    time, speed = by_small_steps(shipped(*case), 400)
    assert result.braking_distance_m == pytest.approx(np.trapezoid(speed, time), rel=1e-3)
    assert result.braking_time_s == pytest.approx(time[-1], rel=3e-3)
    at = np.linspace(0.0, 0.95 * time[-1], 200)
    apart = np.interp(at, result.time, result.channels["speed"]) - np.interp(at, time, speed)
    assert np.sqrt(np.mean(apart**2)) < 2e-3 * speed[0]
    assert result.energy_residual < 1e-5
    assert result.steps < 2500


@pytest.mark.parametrize("ratio", [5, 56])
def test_so_they_are_where_the_liquid_strikes_the_roof(stop, shipped, ratio):
    """A tank four fifths full: the liquid weighs 1.7 times as much again."""
    case = light(LIQUID / ratio, *ROOF)
    result = stop(*case)
    (head,) = (check.value for check in result.checks if check.name.startswith("head"))
    assert head > 0.2
    time, speed = by_small_steps(shipped(*case), 400)
    assert result.braking_distance_m == pytest.approx(np.trapezoid(speed, time), rel=1e-3)
    assert result.energy_residual < 2e-5
    assert result.steps < 2500


def test_a_small_push_meets_the_resistance_of_the_waves_it_sends_out(shipped):
    """Closed form: two walls send waves out with the force `Z v`, `Z = 2 rho A c`, of linear shallow water.

    So `v = -(F/Z) (1 - exp(-Z t/m))` until the waves have run through the tank; then the far wall's come back and the
    tank goes three times as fast. The liquid weighs 21 times the wagon.
    """
    length, width, depth, density, force = 15.5, 2.5, 0.3, 1500.0, 8 * 2.0 / 0.46
    gentle = ("braking.torque=2 N m", "braking.onset=0 s", "braking.initial_speed=4 m/s", "solver.tolerance=1e-5")
    paper = shipped(*light(820.0, *gentle, "solver.time_limit=12 s"))
    tank = {"shape": "rectangular", "length": length, "width": width, "height": 2.0, "fill": depth / 2.0}
    liquid = {"model": "shallow-water", "density": density, "cells": 120}
    own = {"bottom_height": paper.tank.bottom_height, "coefficients": "computed", "liquid": liquid}
    result = simulate(paper.with_({"tank": tank | own}))
    wave = np.sqrt(9.81 * depth)
    resistance = 2 * density * width * depth * wave
    mass = 820.0 + 4 * paper.wagon.wheelset.spin_inertia / 0.46**2
    change = result.channels["speed"] - 4.0
    before = result.time < 0.95 * length / wave
    exact = -force / resistance * (1 - np.exp(-resistance * result.time[before] / mass))
    assert paper.wagon.wheelset.wheel_radius == 0.46
    missed = np.abs(change[before] - exact) / (force / resistance)
    assert missed.max() < 0.025  # while wheels and bogies take up the force
    assert missed[result.time[before] > 2.0].max() < 0.01
    assert change[-1] == pytest.approx(-3 * force / resistance, rel=0.01)


def whole_momentum(vehicle):
    """Momentum along the track of half the wagon and of its liquid, N s, with what the push still owes the wagon."""
    wagon, v = vehicle.wagon, vehicle.points[START].v
    liquid = vehicle.liquid.shallow
    tank = float(wagon.tank_row @ v) + liquid.centre_height * v[2]
    own = liquid.density * liquid.spacing * float(vehicle.liquid.start.flow.sum())
    return float(wagon.mass[0] @ v) + liquid.mass * tank + own + vehicle.liquid.left_force


@pytest.mark.parametrize("until", ["1 s", "5 s"])
def test_nothing_but_the_wheels_takes_momentum(shipped, until):
    """No wheel locks, so each one's spin tells the impulse of its creep force: `I phi' = INT (f R - T) dt`."""
    case = light(LIQUID / 50, "braking.torque=2.5 kN m", f"solver.time_limit={until}")
    stop_ = problem(shipped(*case))
    vehicle = stop_.vehicle
    before, start = whole_momentum(vehicle), vehicle.points[START]
    spins = start.v[-4:].copy()
    train = integrate(stop_).train
    assert vehicle.account.locked_time.max() == 0.0
    wagon, brake = vehicle.wagon, vehicle.brake
    braked = brake.count * (train.time - brake.starts[0])
    taken = float(np.sum(wagon.mass[-1, -1] * (start.v[-4:] - spins) + braked)) / wagon.wheel_radius
    after = whole_momentum(vehicle)
    assert before - after == pytest.approx(taken, rel=5e-6)


def at_fixed_steps(scenario, step):
    """Place and speed after 6 s in steps of one length, and the steps that followed the liquid."""
    stop_ = problem(scenario)
    stop_.train.control.longest_step, stop_.train.control.local_tolerance = step, 1e3
    integrate(stop_)
    assert stop_.vehicle.liquid.following > 0.0
    start = stop_.vehicle.points[START]
    return np.array([start.q[0], start.v[0]])


def test_a_followed_push_is_of_second_order_in_the_step(shipped):
    case = ("braking.torque=0.5 kN m", "braking.onset=0.5 s", "tank.liquid.cells=30", "solver.time_limit=6 s")
    scenario = shipped(*light(LIQUID / 20, *case))
    steps = np.array([0.02, 0.01, 0.005])
    exact = at_fixed_steps(scenario, 0.00125)
    misses = np.array([np.abs(at_fixed_steps(scenario, step) - exact) for step in steps])
    orders = np.polyfit(np.log(steps), np.log(misses), 1)[0]
    assert orders.min() > 1.7, misses
    assert misses[2, 0] < 1e-6 * exact[0]


def random_stop(seed):
    """Overrides of a stop with a wagon from a half of the liquid's mass to a hundredth of it."""
    draw = np.random.default_rng(seed)
    length, mass = draw.uniform(6.0, 16.0), LIQUID / 10 ** draw.uniform(0.3, 1.7)
    return light(
        max(mass, 810.0),
        f"tank.length={length} m",
        f"wagon.pivot_spacing={0.7 * length} m",
        f"tank.fill={draw.uniform(0.15, 0.9)}",
        f"tank.liquid.cells={draw.choice([12, 30, 60])}",
        f"tank.liquid.density={draw.uniform(700.0, 1500.0)} kg/m^3",
        f"braking.initial_speed={draw.uniform(4.0, 35.0)} m/s",
        f"braking.torque={10 ** draw.uniform(3.3, 4.0)} N m",
        "solver.time_limit=90 s",
    )


@pytest.mark.parametrize("seed", range(10))
def test_any_of_them_ends_soon_and_closes_its_ledger(stop, seed):
    result = stop(*random_stop(seed))
    assert result.status == "stopped"
    assert result.steps < 4000
    assert result.energy_residual < 5e-5


@pytest.mark.parametrize("speed", [4, 12])
def test_what_the_walls_turn_is_booked(stop, speed):
    """Soft springs, a short stop: the liquid's walls turn the car by more than the ledger may miss."""
    soft = ("wagon.secondary_suspension.stiffness=2 MN/m", "wagon.primary_suspension.stiffness=2 MN/m")
    result = stop(*light(LIQUID / 5, "braking.torque=5 kN m", f"braking.initial_speed={speed} m/s", *soft))
    assert result.status == "stopped"
    assert result.energy_residual < 2e-5
