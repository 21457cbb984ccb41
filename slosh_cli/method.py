"""TR-BDF2 as a singly diagonally implicit method: its constants, and curves through the stages of a step.

The trapezoidal rule to `t + gamma h`, then BDF2 to `t + h`, gamma = 2 - sqrt 2: order 2, L-stable, with an embedded
third-order companion: R. E. Bank et al., IEEE Trans. CAD 4 (1985) 436-451; M. E. Hosea and L. F. Shampine, Appl. Numer.
Math. 20 (1996) 21-37.
"""

from __future__ import annotations

import math

from slosh_cli.compiled import inner_kernel, vector_kernel

GAMMA = 2.0 - math.sqrt(2.0)
"""The middle stage lies at this part of the step."""
DIAGONAL = 0.5 * GAMMA
OUTER = 0.25 * math.sqrt(2.0)
"""Weights of start and middle; the end has `DIAGONAL`."""
ERROR_START = (4.0 * OUTER - 1.0) / 3.0
ERROR_MIDDLE = -1.0 / 3.0
ERROR_END = 2.0 * DIAGONAL / 3.0
"""Weights less those of the third-order companion."""
START, MIDDLE, END, BASE = range(4)
"""Places of a step's points: its three stages, and a stage without its own accelerations."""


@inner_kernel
def hermite_weights(step, part):
    """Weights of value and rate at the start and of value and rate at the end of `step` (s), at its fraction `part`."""
    rest = 1.0 - part
    return (
        rest * rest * (1.0 + 2.0 * part),
        step * part * rest * rest,
        part * part * (3.0 - 2.0 * part),
        -step * part * part * rest,
    )


@inner_kernel
def parabola_weights(part):
    """Weights of the values at 0, GAMMA and 1 in the parabola through them, at `part`."""
    return (
        (part - GAMMA) * (part - 1.0) * (1.0 / GAMMA),
        part * (part - 1.0) * (1.0 / (GAMMA * (GAMMA - 1.0))),
        part * (part - GAMMA) * (1.0 / (1.0 - GAMMA)),
    )


@vector_kernel
def hermites(left, left_rate, right, right_rate, weights, row, first):
    """Cubics with given values and rates at both ends of the step into `row` from `first` on."""
    a, b, c, d = weights
    for i in range(left.size):
        row[first + i] = a * left[i] + b * left_rate[i] + c * right[i] + d * right_rate[i]


@vector_kernel
def parabolas(left, middle, right, weights, row, first):
    """Parabolas through the values at the step's three stages into `row` from `first` on."""
    a, b, c = weights
    for i in range(left.size):
        row[first + i] = a * left[i] + b * middle[i] + c * right[i]


@inner_kernel
def step_extremes(left, middle, right):
    """Least and largest value of the parabola through a step's three stages."""
    least, largest = min(left, middle, right), max(left, middle, right)
    first = (middle - left) / GAMMA
    second = (right - middle) / (1.0 - GAMMA) - first
    if second != 0.0:
        part = 0.5 * (GAMMA - first / second)
        if 0.0 < part < 1.0:
            a, b, c = parabola_weights(part)
            value = a * left + b * middle + c * right
            least, largest = min(least, value), max(largest, value)
    return least, largest


@vector_kernel
def predict(values, rates, seconds, more_rates, more_seconds, weight, weight_more, diagonal, base, base_rates):
    """Values and rates of a stage but for its own accelerations, into `base`, `base_rates`."""
    for i in range(values.size):
        base_rates[i] = rates[i] + weight * seconds[i] + weight_more * more_seconds[i]
        base[i] = values[i] + weight * rates[i] + weight_more * more_rates[i] + diagonal * base_rates[i]


@vector_kernel
def difference(start, middle, end, step, result):
    """What the step leaves out of the third-order companion's, into `result`."""
    for i in range(start.size):
        result[i] = step * (ERROR_START * start[i] + ERROR_MIDDLE * middle[i] + ERROR_END * end[i])


@vector_kernel
def line(start, other, part, point):
    """The line from `start` to `other` at its fraction `part`, into `point`."""
    for i in range(point.size):
        point[i] = start[i] + part * (other[i] - start[i])


@vector_kernel
def move(place, rate, second, step, moved, moved_rate):
    """Places and rates of a stage from its accelerations `second`."""
    for i in range(place.size):
        moved[i] = place[i] + step * step * second[i]
        moved_rate[i] = rate[i] + step * second[i]
