"""Dense output: the integrator's own interpolation at the output instants, and the extremes between steps."""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel, kernel, part_kernel, vector_kernel
from slosh_cli.solver.cells import FORCE, MOMENT, cells_rise
from slosh_cli.solver.method import GAMMA
from slosh_cli.solver.problem import LOSSES
from slosh_cli.track.contact import creep_force, normal_force
from slosh_cli.wagon.brake import brake_torque
from slosh_cli.wagon.coordinates import COORDINATES, WHEEL_HEAVE, WHEEL_SPIN, WHEELS

# columns of a record; slosh amplitudes and accelerations follow at the end
TIME_COLUMN = 0
PLACE_COLUMN = 1
SPEED_COLUMN = PLACE_COLUMN + COORDINATES
ACCELERATION_COLUMN = SPEED_COLUMN + COORDINATES
NORMAL_COLUMN = ACCELERATION_COLUMN + COORDINATES
CREEP_COLUMN = NORMAL_COLUMN + WHEELS
TORQUE_COLUMN = CREEP_COLUMN + WHEELS
RAIL_COLUMN = TORQUE_COLUMN + WHEELS
ENERGY_COLUMN = RAIL_COLUMN + WHEELS
LOSS_COLUMN = ENERGY_COLUMN + 3
RESIDUAL_COLUMN = LOSS_COLUMN + LOSSES
CELLS_COLUMN = RESIDUAL_COLUMN + 1
"""Force, moment, rise at the front and at the rear wall of a shallow-water liquid."""
SLOSH_COLUMN = CELLS_COLUMN + 4


@inner_kernel
def _hermite_weights(step, part):
    """Weights of value and rate at the start and of value and rate at the end of `step` (s), at its fraction `part`."""
    rest = 1.0 - part
    return (
        rest * rest * (1.0 + 2.0 * part),
        step * part * rest * rest,
        part * part * (3.0 - 2.0 * part),
        -step * part * part * rest,
    )


@inner_kernel
def _parabola_weights(part):
    """Weights of the values at 0, GAMMA and 1 in the parabola through them, at `part`."""
    return (
        (part - GAMMA) * (part - 1.0) * (1.0 / GAMMA),
        part * (part - 1.0) * (1.0 / (GAMMA * (GAMMA - 1.0))),
        part * (part - GAMMA) * (1.0 / (1.0 - GAMMA)),
    )


@vector_kernel
def _hermites(left, left_rate, right, right_rate, weights, row, first, size):
    """Cubics with given values and rates at both ends of the step, `size` of them, into `row` from `first` on."""
    a, b, c, d = weights
    for i in range(size):
        row[first + i] = a * left[i] + b * left_rate[i] + c * right[i] + d * right_rate[i]


@vector_kernel
def _parabolas(left, middle, right, weights, row, first, size):
    """Parabolas through the values at the step's three stages, `size` of them, into `row` from `first` on."""
    a, b, c = weights
    for i in range(size):
        row[first + i] = a * left[i] + b * middle[i] + c * right[i]


@inner_kernel
def _recorded_creep(model, state, row, wheel, normal, weights):
    """Creep force (N) of a wheel: the parabola through the stages' own, whose impulse is that of the equations.

    A creepage interpolated between the stages would not do: the law makes much of little. Only where a wheel leaves the
    rail or lands within the step does the law speak, with the `normal` force (N) of the row.
    """
    start, middle, end = state.start, state.middle, state.end
    if min(start.normal[wheel], middle.normal[wheel], end.normal[wheel], normal) > 0.0:
        return weights[0] * start.creep[wheel] + weights[1] * middle.creep[wheel] + weights[2] * end.creep[wheel]
    speed = row[SPEED_COLUMN]
    slip = speed - model.wagon.wheel_radius * row[SPEED_COLUMN + WHEEL_SPIN + wheel]
    creep, _, _, _ = creep_force(model.contact, normal, slip, speed)
    return creep


@part_kernel
def interpolate(model, state, row, time, step, part, phase):
    """Interpolate the step from `state.start` to `state.end` at its fraction `part` into `row`."""
    start, middle, end = state.start, state.middle, state.end
    row[TIME_COLUMN] = time + part * step
    cubic, parabola = _hermite_weights(step, part), _parabola_weights(part)
    _hermites(start.q, start.v, end.q, end.v, cubic, row, PLACE_COLUMN, COORDINATES)
    _hermites(start.v, start.a, end.v, end.a, cubic, row, SPEED_COLUMN, COORDINATES)
    _parabolas(start.a, middle.a, end.a, parabola, row, ACCELERATION_COLUMN, COORDINATES)
    torque = brake_torque(model.brake, time + part * step, phase)
    radius = model.wagon.wheel_radius
    for i in range(WHEELS):
        under = model.rail.contact[i]
        rail = (
            cubic[0] * start.rail[under]
            + cubic[1] * start.rail_rate[under]
            + cubic[2] * end.rail[under]
            + cubic[3] * end.rail_rate[under]
        )
        normal, _ = normal_force(model.contact, rail - row[PLACE_COLUMN + WHEEL_HEAVE + i])
        creep = _recorded_creep(model, state, row, i, normal, parabola)
        row[RAIL_COLUMN + i] = rail
        row[NORMAL_COLUMN + i] = normal
        row[CREEP_COLUMN + i] = creep
        row[TORQUE_COLUMN + i] = creep * radius if state.locked[i] else torque
    for k in range(3):
        row[ENERGY_COLUMN + k] = (1.0 - part) * state.energies_before[k] + part * state.energies[k]
    _hermites(state.losses_before, start.power, state.losses, end.power, cubic, row, LOSS_COLUMN, LOSSES)
    row[RESIDUAL_COLUMN] = (1.0 - part) * state.residual[0] + part * state.residual[1]
    row[CELLS_COLUMN] = state.push[FORCE]
    row[CELLS_COLUMN + 1] = state.push[MOMENT]
    front, rear = cells_rise(model, state.cells_start)
    front_end, rear_end = cells_rise(model, state.cells_end)
    row[CELLS_COLUMN + 2] = (1.0 - part) * front + part * front_end
    row[CELLS_COLUMN + 3] = (1.0 - part) * rear + part * rear_end
    modes = start.slosh.size
    _hermites(start.slosh, start.slosh_rate, end.slosh, end.slosh_rate, cubic, row, SLOSH_COLUMN, modes)
    _parabolas(
        start.slosh_second, middle.slosh_second, end.slosh_second, parabola, row, SLOSH_COLUMN + modes, modes
    )  # fmt: skip


@kernel
def record_row(model, state, row, time, step, part, phase):
    """`interpolate` for the interpreter."""
    interpolate(model, state, row, time, step, part, phase)


@inner_kernel
def step_extremes(left, middle, right):
    """Least and largest value of the parabola through a step's three stages."""
    least, largest = min(left, middle, right), max(left, middle, right)
    first = (middle - left) / GAMMA
    second = (right - middle) / (1.0 - GAMMA) - first
    if second != 0.0:
        part = 0.5 * (GAMMA - first / second)
        if 0.0 < part < 1.0:
            a, b, c = _parabola_weights(part)
            value = a * left + b * middle + c * right
            least, largest = min(least, value), max(largest, value)
    return least, largest
