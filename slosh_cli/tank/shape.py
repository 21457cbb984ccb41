"""The shape of a slosh mode over the cross-section and along the surface, ready to be drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from slosh_cli.tank.mesh import Floats, Ints

if TYPE_CHECKING:
    from slosh_cli.tank.eigenproblem import HalfSectionElements


@dataclass(frozen=True, eq=False)
class ModeShape:
    """A mode over the whole wetted cross-section, for an amplitude of 1.

    `y`, `z` (nodes,) m and `triangles` (t, 3) cover the section; `potential` (nodes,) is phi of theory
    section 4 in m. `surface_y` (points,) m, from left to right, and `surface_rise` (points,) the surface's
    shape f there, of width-mean 1. Along the tank both go as cos(n pi (x + L/2) / L).
    """

    y: Floats
    z: Floats
    triangles: Ints
    potential: Floats
    surface_y: Floats
    surface_rise: Floats


def mode_shape(elements: HalfSectionElements, kappa: float, potential: Floats) -> ModeShape:
    """The shape of a symmetric mode from its `potential` (unknowns,) and `kappa` = omega^2/g in 1/m."""
    y, z = elements.basis.doflocs
    corners = elements.basis.element_dofs  # vertices 0, 1, 2, then the middles of edges 01, 12, 02
    parts = ([0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5])
    half = _counter_clockwise(np.vstack([corners[part].T for part in parts]).astype(np.int64), y, z)
    surface = elements.surface_unknowns[np.argsort(y[elements.surface_unknowns])]
    left = surface[y[surface] > 0.0][::-1]
    return ModeShape(
        y=np.concatenate([-y, y]),
        z=np.concatenate([z, z]),
        triangles=np.vstack([half[:, ::-1], half + elements.size]),
        potential=np.concatenate([potential, potential]),
        surface_y=np.concatenate([-y[left], y[surface]]),
        surface_rise=kappa * np.concatenate([potential[left], potential[surface]]),
    )


def _counter_clockwise(triangles: Ints, y: Floats, z: Floats) -> Ints:
    a, b, c = triangles.T
    clockwise = (y[b] - y[a]) * (z[c] - z[a]) < (z[b] - z[a]) * (y[c] - y[a])
    return np.where(clockwise[:, None], triangles[:, ::-1], triangles)
