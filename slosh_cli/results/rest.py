"""Is a stopped wagon at rest for good? What liquid and gradient can still push, beside what holds the wagon.

A run ends at the first passage of the stop speed. The liquid then still moves. Here the tank is held still, with the
pitch that it has, and the liquid goes on by itself; brakes, rails and running resistance hold the wagon as long as the
largest force of that liquid stays below what they can bear.
"""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.method import START
from slosh_cli.results.line import gradient_at
from slosh_cli.results.validity import Check
from slosh_cli.scenario import Scenario
from slosh_cli.solver import excite_kernels
from slosh_cli.solver.setup import HALF, ReadyStop
from slosh_cli.solver.vehicle import Vehicle
from slosh_cli.tank.cells import CellLiquid
from slosh_cli.tank.liquid import Slosh
from slosh_cli.tank.modal import ModalLiquid
from slosh_cli.tank.shallow import WORK_ROWS
from slosh_cli.wagon.brake import holding_torque
from slosh_cli.wagon.model import CAR_PITCH, POSITION

_PERIODS = 4.0
"""Periods of the first mode that the modes are looked at for."""
_SAMPLES = 400
"""Instants per period of the fastest mode, at which its force is looked at."""
_CELL_PERIODS = 0.5
"""Periods of the first mode that cells are carried on for: in half of one every wave reaches the wall ahead of it,
and bores lose their height from one passage to the next."""
_CELL_SAMPLES = 60
"""Instants per period between which the mean force of the cells is looked at."""
_REST_SPEED = 0.1
"""A stop speed (m/s) up to which a stopped wagon is as good as at rest."""


def rest_checks(scenario: Scenario, stop: ReadyStop) -> tuple[Check, ...]:
    """Whether a stopped wagon can be pushed on by its liquid, or by gravity on a gradient; nothing for a frozen load on
    the level and for a high stop speed."""
    gradient = gradient_at(scenario, float(stop.vehicle.points[START].q[POSITION]))
    frozen = type(stop.vehicle.liquid) is Slosh
    if (frozen and not gradient) or scenario.braking.stop_speed > _REST_SPEED:
        return ()
    vehicle, wheels = stop.vehicle, range(stop.vehicle.wagon.wheels)
    torques = np.array([holding_torque(vehicle.brake, wheel, stop.train.time) for wheel in wheels])
    (on, back), held = largest_pushes(vehicle), holding_force(scenario, stop.static_loads, torques)
    rolling = stop.weight / HALF * gradient
    on, back = on - rolling, back + rolling
    push, way = max(on, back), "on" if on > held else "back"
    pusher = "the gradient" if frozen else "its liquid and the gradient" if gradient else "its liquid"
    return (
        Check(
            f"push of {pusher.replace('its', 'the')} after the stop over what holds the wagon",
            "operation",
            push,
            held,
            f"The wagon stops, but it is not at rest: held still, {pusher} would push it {way} with up to "
            f"{push / 1e3:.3g} kN, and brakes and resistance hold {held / 1e3:.3g} kN. It will move on again; the "
            "braking distance is that of the first stop.",
        ),
    )


def holding_force(scenario: Scenario, static_loads: Vector, torques: Vector) -> float:
    """Largest force (N) along the track that a standing wagon bears: eight braked wheels and running resistance.

    Of the wheels on one rail: `static_loads` (4,) N and the `torques` (4,) N m that their brakes can hold.
    """
    wagon = scenario.wagon
    wheels = np.minimum(torques / wagon.wheelset.wheel_radius, scenario.contact.adhesion.mu0 * static_loads)
    return float(wheels.sum() / HALF + wagon.running_resistance.constant)


def largest_pushes(vehicle: Vehicle) -> tuple[float, float]:
    """Largest forces (N, of the whole tank) of the liquid on the tank held still from now on: forward, backward."""
    liquid, pitch = vehicle.liquid, float(vehicle.points[START].q[CAR_PITCH])
    forces = np.zeros(1)
    if isinstance(liquid, CellLiquid):
        forces = _push_of_cells(liquid, pitch)
    elif isinstance(liquid, ModalLiquid):
        forces = _push_of_modes(liquid, pitch)
    return max(float(forces.max(initial=0.0)) / HALF, 0.0), max(-float(forces.min(initial=0.0)) / HALF, 0.0)


def _push_of_modes(liquid: ModalLiquid, pitch: float) -> Vector:
    """Force (N) of half a tank's modes over time: each swings freely about where the `pitch` (rad) lets it rest."""
    frequency = np.sqrt(liquid.stiffness / liquid.mu)
    decay = 0.5 * liquid.damping / liquid.mu
    swing = np.sqrt(frequency**2 - decay**2)
    place = liquid.amplitude[START] - liquid.pitch_weight * pitch / liquid.stiffness
    other = (liquid.rate[START] + decay * place) / swing
    duration = 2.0 * np.pi * _PERIODS / frequency.min()
    count = min(int(_PERIODS * _SAMPLES * frequency.max() / frequency.min()), 100_000)
    time = np.linspace(0.0, duration, count)[:, None]
    fade, cosine, sine = np.exp(-decay * time), np.cos(swing * time), np.sin(swing * time)
    amplitude = fade * (place * cosine + other * sine)
    rate = fade * ((swing * other - decay * place) * cosine - (swing * place + decay * other) * sine)
    acceleration = -(frequency**2) * amplitude - 2.0 * decay * rate
    return np.asarray(-acceleration @ liquid.lambda_1, dtype=np.float64)


def _push_of_cells(cells: CellLiquid, pitch: float) -> Vector:
    """Mean forces (N) of half a tank's cells over short stretches of time."""
    liquid, start = cells.shallow, cells.start
    area, flow, depth = start.area.copy(), start.flow.copy(), start.depth.copy()
    table, still = liquid.table, liquid.still_depth
    mean_depth = np.interp(still, table.depth, table.area) / np.interp(still, table.depth, table.width)
    period = 2.0 * liquid.cells * liquid.spacing / np.sqrt(liquid.gravity * mean_depth)
    count = int(_CELL_PERIODS * _CELL_SAMPLES)
    lengths = np.full(count, period / _CELL_SAMPLES)
    leaning = np.full(count, liquid.gravity * pitch)
    rows, work = np.zeros((count, 6)), np.zeros((WORK_ROWS, liquid.cells + 1))
    done = excite_kernels.cells_history(liquid, area, flow, depth, lengths, leaning, work, np.zeros(4), rows)
    return np.asarray(rows[:done, 0] / lengths[:done] - liquid.mass * liquid.gravity * pitch, dtype=np.float64)
