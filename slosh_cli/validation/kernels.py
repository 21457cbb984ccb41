"""Compiled functions of the program under plain names and types; each is looked up when it is called."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from slosh_cli.tank import modal
from slosh_cli.track import contact, moving
from slosh_cli.track.contact import ContactModel
from slosh_cli.track.mem import RailModel

Array = NDArray[np.float64]


def normal_force(model: ContactModel, approach: float) -> float:
    """Normal force in N at an approach in m."""
    kernel: Any = contact.normal_force
    return float(kernel(model, approach)[0])


def creep_force(model: ContactModel, normal: float, slip: float, speed: float) -> float:
    """Creep force in N under `normal` N at a slip and a train speed in m/s."""
    kernel: Any = contact.creep_force
    return float(kernel(model, normal, slip, speed)[0])


def rail_residual(rail: RailModel, y: Array, speed: float) -> Array:
    """Nodal forces (2 n,) that hold the rail in the steady shape `y` (2 n,) at constant `speed` in m/s."""
    kernel: Any = moving.rail_residual
    still, residual = np.zeros_like(y), np.zeros_like(y)
    kernel(rail, y, still, still, 0.0, speed, 0.0, np.zeros((len(rail.runs), moving.MATRICES)), residual)
    return residual


def liquid_acceleration(
    liquid: modal.ModalLiquid, amplitude: Array, rate: Array, step: float, tank_acceleration: float
) -> Array:
    """Modal accelerations (modes,) at an implicit stage of `step` s in a tank that does not pitch."""
    kernel: Any = modal.liquid_follow
    result = np.zeros_like(amplitude)
    kernel(liquid, amplitude, rate, step, 0.0, tank_acceleration, 0.0, result)
    return result


def liquid_force(liquid: modal.ModalLiquid, amplitude: Array, acceleration: Array) -> float:
    """Force of the modes on the tank in N, forward."""
    kernel: Any = modal.liquid_force
    return float(kernel(liquid, amplitude, acceleration)[0])
