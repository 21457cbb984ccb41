"""What the time loop works on: the constants of a stop and the state at one instant."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slosh_cli.tank.modal import ModalLiquid
from slosh_cli.tank.shallow import ShallowLiquid
from slosh_cli.track.contact import ContactModel
from slosh_cli.track.mem import RailModel
from slosh_cli.wagon.brake import Brake
from slosh_cli.wagon.coordinates import COORDINATES, WHEELS
from slosh_cli.wagon.model import WagonModel

Array = NDArray[np.float64]


LOSSES = 7
"""Ways in which energy leaves or enters the wagon, see `ledger`."""


class Control(NamedTuple):
    """What steers the integrator. SI units.

    `local_tolerance` bounds the error of one step relative to `speed_scale` (15,), `place_scale` (15,) and
    `slosh_scale`; `load_scale` is the static wheel load in N, `approach_scale` its Hertz approach in m. No step is
    longer than `longest_step` (s), nor takes more than `most_slowing` (m/s) from the speed.
    """

    local_tolerance: float
    speed_scale: Array
    place_scale: Array
    slosh_scale: float
    load_scale: float
    approach_scale: float
    stop_speed: float
    time_limit: float
    longest_step: float
    most_slowing: float
    interval: float


class Model(NamedTuple):
    """All constants of one stop. Liquids, brake and rail are used through their kernels only.

    The liquid may be modes (`liquid`), cells (`shallow`), or neither: a frozen load. `tank_push`, `tank_turn` (15,) are
    the wagon's accelerations per newton along x at the tank's bottom centre and per newton metre in the car's pitch.
    """

    wagon: WagonModel
    liquid: ModalLiquid
    rail: RailModel
    contact: ContactModel
    brake: Brake
    control: Control
    shallow: ShallowLiquid
    tank_push: Array
    tank_turn: Array


class Point(NamedTuple):
    """The state at one instant: coordinates, rail and slosh with two time derivatives, contact forces, powers.

    `q`, `v`, `a` (15,); `rail...` (n,); `slosh...` (modes,); `normal`, `creep` (N) and `torque` (N m) (4,);
    `power` (7,) in W, in the order of the ledger's losses.
    """

    q: Array
    v: Array
    a: Array
    rail: Array
    rail_rate: Array
    rail_second: Array
    slosh: Array
    slosh_rate: Array
    slosh_second: Array
    normal: Array
    creep: Array
    torque: Array
    power: Array


class Cells(NamedTuple):
    """A shallow-water liquid at one instant: wetted area m^2, flow m^3/s and depth m of each cell, (cells,)."""

    area: Array
    flow: Array
    depth: Array


def empty_point(unknowns: int, modes: int) -> Point:
    """A zeroed state for a rail of `unknowns` and a liquid of `modes`."""
    sizes = 3 * [COORDINATES] + 3 * [unknowns] + 3 * [modes] + 3 * [WHEELS] + [LOSSES]
    return Point._make(np.zeros(size) for size in sizes)
