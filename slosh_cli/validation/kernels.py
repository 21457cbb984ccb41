"""Compiled functions of the program under plain types; each is looked up when it is called."""

from __future__ import annotations

from typing import Any

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.method import BASE, START
from slosh_cli.tank.modal import ModalLiquid
from slosh_cli.track import moving
from slosh_cli.track.contact import ContactModel
from slosh_cli.track.mem import RailModel


def normal_force(model: ContactModel, approach: float) -> float:
    """Normal force in N at an approach in m."""
    contact: Any = model
    return float(contact.normal_force(approach)[0])


def creep_force(model: ContactModel, normal: float, slip: float, speed: float) -> float:
    """Creep force in N under `normal` N at a slip and a train speed in m/s."""
    contact: Any = model
    return float(contact.creep_force(normal, slip, speed)[0])


def residual_forces(rail: RailModel, y: Vector, speed: float) -> Vector:
    """Nodal forces (2 n,) that hold the rail in the steady shape `y` (2 n,) at constant `speed` in m/s."""
    kernel: Any = moving.rail_residual
    still, residual = np.zeros_like(y), np.zeros_like(y)
    kernel(rail, y, still, still, 0.0, speed, 0.0, np.zeros((len(rail.runs), moving.MATRICES)), residual)
    return residual


def move_modes(modes: ModalLiquid, implicit: float, tank_acceleration: float) -> None:
    """Bring the modes, at an implicit stage of `implicit` s, to their start, in a tank that does not pitch."""
    liquid: Any = modes
    liquid.follow(START, BASE, implicit, 0.0, tank_acceleration, 0.0)


def modal_force(modes: ModalLiquid) -> float:
    """Force of the modes at their start on the tank in N, forward."""
    liquid: Any = modes
    return float(liquid.force(START)[0])
