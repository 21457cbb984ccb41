"""Linear systems with known solutions, put through the program's own time loop.

Without contact stiffness, brake, resistance and weight the equations of a stop are linear: wagon and slosh modes
`M x'' + C x' + K x = 0`, the rail likewise, and neither feels the other. The step is fixed by a tolerance that is
never exceeded and a longest step that always is.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import expm

from slosh_cli.method import START
from slosh_cli.solver import advance as loop
from slosh_cli.solver.record import columns_of
from slosh_cli.solver.setup import problem
from slosh_cli.solver.train import new_train
from slosh_cli.solver.vehicle import new_point, new_vehicle
from slosh_cli.tank.modal import ModalLiquid
from slosh_cli.wagon.brake import torque_brake

COORDINATES = 15
CRUISE = 20.0
"""Speed of the loaded system in m/s, so that neither stop nor creepage floor is met."""


@dataclass(frozen=True)
class LinearSystem:
    """`M x'' + C x' + K x = 0`; x holds 15 wagon coordinates and the slosh amplitudes."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray

    def exact(self, x, v, time):
        """Displacements and velocities after `time` by the matrix exponential."""
        size = x.size
        upper = np.hstack([np.zeros((size, size)), np.eye(size)])
        lower = -np.linalg.solve(self.mass, np.hstack([self.stiffness, self.damping]))
        result = expm(time * np.vstack([upper, lower])) @ np.concatenate([x, v])
        return result[:size], result[size:]


def wagon_of(scenario, stiffness_factor):
    """The scenario's own half wagon with slosh modes as a free linear system, springs and dampers made stiffer.

    A soft spring to the ground on every wheel's heave holds what contacts would hold.
    """
    stop = problem(scenario)
    wagon, liquid = stop.vehicle.wagon, stop.vehicle.liquid
    modes = liquid.mu.size if isinstance(liquid, ModalLiquid) else 0
    size = COORDINATES + modes
    mass, damping, stiffness = (np.zeros((size, size)) for _ in range(3))
    mass[:COORDINATES, :COORDINATES] = wagon.mass
    damping[:COORDINATES, :COORDINATES] = stiffness_factor * wagon.damping
    stiffness[:COORDINATES, :COORDINATES] = stiffness_factor * wagon.stiffness
    stiffness[2, 2] -= (stiffness_factor - 1) * wagon.gravity_stiffness  # the load's tilt is no spring
    for wheel in range(7, 11):
        stiffness[wheel, wheel] += 4e5
    for n in range(modes):
        place = COORDINATES + n
        coupling = liquid.lambda_1[n] * wagon.tank_row
        coupling[2] += liquid.lambda_02[n]
        mass[place, :COORDINATES] = mass[:COORDINATES, place] = coupling
        mass[place, place] = liquid.mu[n]
        damping[place, place] = liquid.damping[n]
        stiffness[place, place] = liquid.stiffness[n]
        stiffness[place, 2] = stiffness[2, place] = -liquid.pitch_weight[n]
    system = LinearSystem(mass, damping, stiffness)
    inner = slice(0, COORDINATES)
    free = wagon.replaced(
        mass=mass[inner, inner].copy(),
        damping=damping[inner, inner].copy(),
        stiffness=stiffness[inner, inner].copy(),
        weight=np.zeros(COORDINATES),
    )
    return system, with_parts(stop, wagon=free)


def with_parts(stop, **parts):
    """The stop whose wagon has other parts, with a state of its own."""
    old = stop.vehicle
    names = ("wagon", "liquid", "rail", "contact", "line", "brake", "scales")
    vehicle = new_vehicle(*(parts.get(name, getattr(old, name)) for name in names), old.points[START])
    return replace(stop, train=new_train((vehicle,), stop.train.control, 1e-3))


def linear_stop(stop, step, end):
    """`stop` without contacts, resistance and brake, to be integrated with a fixed `step` (s) until `end` (s)."""
    control = stop.train.control.replaced(
        local_tolerance=1e30,
        stop_speed=-1e9,
        time_limit=end,
        longest_step=step,
        most_slowing=np.inf,
        interval=1e9,
    )
    vehicle = stop.vehicle
    stop = with_parts(
        stop,
        contact=vehicle.contact.replaced(stiffness=0.0),
        line=vehicle.line.replaced(resistance=np.zeros(3)),
        brake=torque_brake(0.0, np.inf),
    )
    return replace(stop, train=stop.train.replaced(control=control))


def march(stop, start, step):
    """Final point after integrating `stop` from `start` in fixed steps of `step` (s) up to its time limit."""
    point, x, v = start
    old = stop.vehicle
    liquid = old.liquid
    if isinstance(liquid, ModalLiquid):
        shape = {name: np.zeros_like(liquid.amplitude) for name in ("amplitude", "rate", "second")}
        liquid = liquid.replaced(**shape)
        liquid.amplitude[START], liquid.rate[START] = x[COORDINATES:], v[COORDINATES:]
    vehicle = new_vehicle(old.wagon, liquid, old.rail, old.contact, old.line, old.brake, old.scales, point)
    vehicle.airborne[:] = True
    train = new_train((vehicle,), stop.train.control, step)
    rows = np.zeros((8, 1, columns_of(vehicle).end))
    steps = round(train.control.time_limit / step)
    outcome = loop.advance(train, rows, steps + 10)
    assert outcome == loop.TIME_LIMIT
    assert train.steps == steps
    assert train.rejected == 0
    assert abs(train.time - train.control.time_limit) < 1e-9
    return vehicle


def started(stop, x, v, rail=None, rail_rate=None):
    """A point with these displacements and velocities (wagon and slosh), moving at the cruising speed on top."""
    start = new_point(START, stop.vehicle.wagon, stop.vehicle.rail)
    start.q[:], start.v[:] = x[:COORDINATES], v[:COORDINATES]
    start.v[0] += CRUISE
    if rail is not None:
        start.rail[:], start.rail_rate[:] = rail, rail_rate
    return start, x, v


def reached(vehicle):
    """Displacements and velocities of wagon and slosh, velocities less the cruising speed."""
    point, liquid = vehicle.points[START], vehicle.liquid
    slosh = (liquid.amplitude[START], liquid.rate[START]) if isinstance(liquid, ModalLiquid) else (np.zeros(0),) * 2
    v = np.concatenate([point.v, slosh[1]])
    v[0] -= CRUISE
    return np.concatenate([point.q, slosh[0]]), v


def tr_bdf2(z):
    """Amplification of one step for y' = lambda y, z = lambda h: trapezoid to gamma h, then BDF2 (Bank et al. 1985).

    `u_g = (1 + g z/2)/(1 - g z/2) u`, `(2 - g) u_1 - u_g/g + (1 - g)^2/g u = (1 - g) z u_1`, g = 2 - sqrt 2.
    """
    g = 2 - np.sqrt(2)
    middle = (1 + g * z / 2) / (1 - g * z / 2)
    return (middle / g - (1 - g) ** 2 / g) / ((2 - g) - (1 - g) * z)
