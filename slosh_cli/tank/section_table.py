"""A cross-section as a table that compiled kernels can read: area, moments and width against depth, with a slot.

Where the section runs full, a narrow slot above the roof (Preissmann's) keeps the open-channel equations valid: the
depth in it is the pressure head, and its width sets the speed of pressure waves, `c^2 = g A / b`; J. A. Cunge and M.
Wegner, La Houille Blanche 1 (1964) 33-39.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slosh_cli.tank.section import Section

Array = NDArray[np.float64]
NODES = 400
"""Depths of the table, crowded towards bottom and roof where the width varies fastest."""


class SectionTable(NamedTuple):
    """Section at the depths (K,) m up to where the slot of `slot_width` (m) takes over; the roof is at `roof` (m).

    `area` m^2, `width` m, `first` = INT z b dz m^3, `pressure` = INT (h - z) b dz m^3 (the moment I1 of the
    equations) and `pressure_arm` = INT (h - z) z b dz m^4, each (K,).
    """

    depth: Array
    area: Array
    width: Array
    first: Array
    pressure: Array
    pressure_arm: Array
    slot_width: float
    roof: float


def _slot_start(section: Section, slot_width: float) -> float:
    """Depth (m) above which the section is narrower than the slot all the way to the roof."""
    depths = section.height * (1 - np.geomspace(1e-9, 0.5, 2000))  # from the roof down to the middle
    wide = [section.surface_width(float(depth)) >= slot_width for depth in depths]
    first = int(np.argmax(wide))
    return section.height if first == 0 else float(depths[first])


def section_table(section: Section, gravity: float, slot_speed: float) -> SectionTable:
    """Tabulate `section`; pressure waves in the full section run at `slot_speed` (m/s). Gravity in m/s^2."""
    slot_width = gravity * section.area(section.height) / slot_speed**2
    top = _slot_start(section, slot_width)
    depth = 0.5 * top * (1 - np.cos(np.linspace(0, np.pi, NODES)))
    area = np.array([section.area(float(h)) for h in depth])
    centroid = np.array([section.centroid_height(float(h)) for h in depth])
    second = np.array([section.second_moment(float(h)) for h in depth]) + area * centroid**2
    width = np.array([section.surface_width(float(h)) for h in depth])
    width[0] = section.surface_width(1e-12 * section.height)  # the limit from inside, as at the top
    width[-1] = max(slot_width, section.surface_width(top * (1 - 1e-9)))
    first = area * centroid
    return SectionTable(
        depth=depth,
        area=area,
        width=width,
        first=first,
        pressure=depth * area - first,
        pressure_arm=depth * first - second,
        slot_width=slot_width,
        roof=section.height,
    )
