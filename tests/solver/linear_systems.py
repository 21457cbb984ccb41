"""Linear systems with known solutions, put through the program's own time loop.

Without contact stiffness, brake, resistance and weight the equations of a stop are linear: wagon and slosh modes
`M x'' + C x' + K x = 0`, the rail likewise, and neither feels the other. The step is fixed by a tolerance that is
never exceeded and a longest step that always is.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import expm
from slosh_cli.solver.problem import empty_point
from slosh_cli.solver.state import REJECTED, STEPS, TIME, new_scratch, new_state

from slosh_cli.solver import advance as loop
from slosh_cli.solver.events import EVENT_COUNT
from slosh_cli.solver.record import SLOSH_COLUMN
from slosh_cli.solver.setup import problem
from slosh_cli.wagon.brake import Brake

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
    model, wagon, liquid = stop.model, stop.model.wagon, stop.model.liquid
    modes = liquid.mu.size
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
    free = wagon._replace(
        mass=mass[inner, inner].copy(),
        damping=damping[inner, inner].copy(),
        stiffness=stiffness[inner, inner].copy(),
        weight=np.zeros(COORDINATES),
        resistance=np.zeros(3),
    )
    return system, replace(stop, model=model._replace(wagon=free))


def linear_stop(stop, step, end):
    """`stop` without contacts and brake, to be integrated with a fixed `step` (s) until `end` (s)."""
    model = stop.model
    control = model.control._replace(
        local_tolerance=1e30,
        approach_scale=np.inf,
        stop_speed=-1e9,
        time_limit=end,
        longest_step=step,
        most_slowing=np.inf,
        interval=1e9,
    )
    contact = model.contact._replace(stiffness=0.0)
    return replace(stop, model=model._replace(contact=contact, brake=Brake(0.0, np.inf), control=control))


def march(stop, start, step):
    """Final point after integrating `stop` from `start` in fixed steps of `step` (s) up to its time limit."""
    model, modes = stop.model, start.slosh.size
    state = new_state(start, stop.cells, EVENT_COUNT, step)
    state.airborne[:] = True
    scratch = new_scratch(model.rail, modes, stop.cells.area.size)
    rows = np.zeros((8, SLOSH_COLUMN + 2 * modes))
    steps = round(model.control.time_limit / step)
    assert loop.begin(model, scratch, state)
    outcome = loop.advance(model, scratch, state, rows, steps + 10)
    assert outcome == loop.TIME_LIMIT
    assert state.counts[STEPS] == steps
    assert state.counts[REJECTED] == 0
    assert abs(state.clock[TIME] - model.control.time_limit) < 1e-9
    return state.start


def started(stop, x, v, rail=None, rail_rate=None):
    """A point with these displacements and velocities (wagon and slosh), moving at the cruising speed on top."""
    model = stop.model
    unknowns, modes = 2 * model.rail.nodes, model.liquid.mu.size
    start = empty_point(unknowns, modes)
    start.q[:], start.v[:] = x[:COORDINATES], v[:COORDINATES]
    start.v[0] += CRUISE
    start.slosh[:], start.slosh_rate[:] = x[COORDINATES:], v[COORDINATES:]
    if rail is not None:
        start.rail[:], start.rail_rate[:] = rail, rail_rate
    return start


def reached(point):
    """Displacements and velocities of wagon and slosh, velocities less the cruising speed."""
    v = np.concatenate([point.v, point.slosh_rate])
    v[0] -= CRUISE
    return np.concatenate([point.q, point.slosh]), v


def tr_bdf2(z):
    """Amplification of one step for y' = lambda y, z = lambda h: trapezoid to gamma h, then BDF2 (Bank et al. 1985).

    `u_g = (1 + g z/2)/(1 - g z/2) u`, `(2 - g) u_1 - u_g/g + (1 - g)^2/g u = (1 - g) z u_1`, g = 2 - sqrt 2.
    """
    g = 2 - np.sqrt(2)
    middle = (1 + g * z / 2) / (1 - g * z / 2)
    return (middle / g - (1 - g) ** 2 / g) / ((2 - g) - (1 - g) * z)
