"""The state at t = 0: the wagon at rest on its springs, the rail in its steady shape at V0 (theory section 6)."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.errors import PhysicsError
from slosh_cli.method import START
from slosh_cli.solver.vehicle import Point, new_point
from slosh_cli.track.contact import ContactModel
from slosh_cli.track.mem import RailModel, steady_shapes
from slosh_cli.wagon.model import WagonModel


def _settled_wagon(wagon: WagonModel, flexibility: Matrix, contact: ContactModel) -> tuple[Vector, Vector]:
    """Coordinates and wheel loads of the wagon at rest on a rail of steady `flexibility` (wheels, wheels), m/N.

    Newton on the vertical and pitch coordinates; the loads follow from the approach they need:
    `N = C_H (y - w)^1.5`, `y = flexibility @ N`.
    """
    settling, count = np.arange(1, wagon.first_spin), wagon.wheels
    wheels = np.arange(wagon.first_wheel, wagon.first_spin) - 1
    stiffness = wagon.stiffness[np.ix_(settling, settling)]
    size = settling.size
    loads = np.full(count, -wagon.weight[wagon.heaves].sum() / count)
    q = np.zeros(size)
    for _ in range(50):
        approach = (loads / contact.stiffness) ** (2 / 3)
        jacobian = np.zeros((size + count,) * 2)
        jacobian[:size, :size] = stiffness
        jacobian[wheels, size + np.arange(count)] = -1
        jacobian[size + np.arange(count), wheels] = 1
        jacobian[size:, size:] = np.diag(approach / (1.5 * loads)) - flexibility
        missing = np.concatenate([stiffness @ q - wagon.weight[settling], q[wheels] + approach - flexibility @ loads])
        missing[wheels] -= loads
        change = np.linalg.solve(jacobian, -missing)
        q += change[:size]
        loads = np.maximum(loads + change[size:], 0.1 * loads)
        if np.abs(change[size:]).max() < 1e-11 * loads.max():
            full = np.zeros(wagon.coordinates)
            full[settling] = q
            return full, loads
    raise PhysicsError("The wagon finds no equilibrium on this track; its springs are too soft.", "wagon")


def initial_point(wagon: WagonModel, rail: RailModel, contact: ContactModel, speed: float) -> Point:
    """Steady running at `speed` (m/s), wheels rolling without slip, liquid level and at rest."""
    shapes = steady_shapes(rail, speed)
    q, loads = _settled_wagon(wagon, shapes[rail.contact], contact)
    point = new_point(START, wagon, rail)
    point.q[:] = q
    point.v[0] = speed
    point.v[wagon.first_spin :] = speed / wagon.wheel_radius
    point.rail[:] = shapes @ loads
    point.normal[:] = loads
    return point
