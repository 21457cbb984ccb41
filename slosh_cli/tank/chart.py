"""How a tank's slosh modes change with its filling: the data behind the chart for the wall."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from slosh_cli.section import TankGeometry, section_of
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.longitudinal import longitudinal_modes, mode_number
from slosh_cli.tank.mesh import Floats


@dataclass(frozen=True, eq=False)
class FillChart:
    """Slosh modes against the filling.

    `fill` (fills,) is depth over height and `numbers` the modes' half waves n; `frequency` rad/s,
    `mass_fraction` and `height` m above the lowest point are (modes, fills). Where a filling cannot be
    represented they are NaN and `skipped` holds its reason.
    """

    fill: Floats
    numbers: tuple[int, ...]
    frequency: Floats
    mass_fraction: Floats
    height: Floats
    skipped: dict[float, str]


def fill_chart(
    tank: TankGeometry, fills: Sequence[float], count: int = 1, progress: Callable[[int, int], None] | None = None
) -> FillChart:
    """The first `count` odd modes at each of `fills` (depth over height, between 0 and 1).

    The tank's own filling and its liquid have no part in it. `progress` is told how many of how many are done.
    """
    section = section_of(tank)
    values = np.full((3, count, len(fills)), np.nan)
    skipped: dict[float, str] = {}
    for column, fill in enumerate(fills):
        if progress is not None:
            progress(column, len(fills))
        depth = fill * section.height
        try:
            modes = longitudinal_modes(section, depth, tank.length, count).modes
        except TankError as error:
            skipped[float(fill)] = error.message
            continue
        volume = section.area(depth) * tank.length
        for row, mode in enumerate(modes):
            fraction = mode.lambda_1**2 / (mode.mu * volume)
            values[:, row, column] = mode.frequency, fraction, mode.lambda_02 / mode.lambda_1
    numbers = tuple(mode_number(position) for position in range(count))
    frequency, mass_fraction, height = values
    return FillChart(np.array(fills, dtype=np.float64), numbers, frequency, mass_fraction, height, skipped)
