"""The liquid's force on the tank as a function of the tank's acceleration, where cells come near the roof.

A wagon solves for the acceleration on which the force and it agree: a force that jumps at some acceleration may leave
none.
"""

import numpy as np
import pytest
from shallow_tools import BOX, areas, liquid_in, moving, places

MOMENT = 1e-6
"""A time in which nothing flows, s."""


@pytest.mark.parametrize("share", [0.9, 0.95, 0.99])
def test_the_force_does_not_jump_at_any_acceleration(share):
    """It changes as the acceleration of a cell's mass or two; the last cell is filled to `share` of the height."""
    section = BOX
    liquid = liquid_in(section, 20, 0.55 * section.height)
    depth = 0.55 * section.height * (1.0 + 0.3 * places(liquid) / places(liquid)[-1])
    depth[-1] = share * section.height
    area = areas(liquid, depth)
    at = np.linspace(-15.0, 15.0, 301)
    found = []
    for acceleration in at:
        tank = moving(liquid, depth)
        tank.flow[:] = 0.5 * area
        found.append(tank.advance(acceleration, MOMENT)[0] / MOMENT)
    a_cell = liquid.density * section.area(section.height) * liquid.spacing
    assert np.abs(np.diff(found)).max() < 2.0 * a_cell * (at[1] - at[0])
