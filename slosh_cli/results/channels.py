"""The channels of a run's history: name, unit and meaning of each.

Forces, energies and masses are those of the whole wagon; wheel forces are those of one wheel on one rail.
Heaves are positive up and measured from the unloaded geometry, pitch angles are positive nose-down.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from slosh_cli.arrays import Vector

WHEELS = (1, 2, 3, 4)
"""Wheel numbers: 1 leads the front bogie, 4 trails the rear bogie."""
_BOGIES = (1, 2)
_MOST_COPIED = 200_000
"""Rows of a history up to which channels are copied out of the record; memory would have to hold longer ones twice."""


@dataclass(frozen=True, slots=True)
class Channel:
    """One quantity recorded over time: `name` in files and code, SI `unit`, `long_name` for people."""

    name: str
    unit: str
    long_name: str


def wheel(i: int, quantity: str) -> str:
    """Name of the channel that holds `quantity` (say "normal_force") of wheel `i`, 1 to 4."""
    return f"wheel_{i}_{quantity}"


def slosh_amplitude(n: int) -> str:
    """Name of the amplitude channel of the `n`-th longitudinal slosh mode, counted from 1."""
    return f"slosh_{n}_amplitude"


_WAGON = (
    Channel("position", "m", "distance travelled by the wheels since t = 0"),
    Channel("speed", "m/s", "train speed (wheels)"),
    Channel("acceleration", "m/s^2", "longitudinal acceleration of the wheels (carries bogie-pitch ringing)"),
    Channel("car_acceleration", "m/s^2", "longitudinal acceleration of the car body's centre"),
    Channel("car_heave", "m", "vertical displacement of the car body, positive up"),
    Channel("car_pitch", "rad", "pitch angle of the car body, positive nose-down"),
)

_BOGIE = (
    ("heave", "m", "vertical displacement of bogie {i}, positive up"),
    ("pitch", "rad", "pitch angle of bogie {i}, positive nose-down"),
)

_WHEEL = (
    ("heave", "m", "vertical displacement of wheel {i}, positive up"),
    ("speed", "m/s", "circumferential speed of wheel {i}"),
    ("creepage", "1", "longitudinal creepage of wheel {i}, (V - R phi') / V"),
    ("normal_force", "N", "normal contact force of wheel {i}"),
    ("tangential_force", "N", "tangential contact force of wheel {i}, positive when it brakes"),
    ("brake_torque", "N m", "brake torque transmitted to wheel {i}"),
    ("rail_deflection", "m", "rail displacement under wheel {i}, positive up"),
    ("held_torque", "N m", "torque that the brake of wheel {i} can hold"),
)

_BRAKE = Channel("brake_application", "1", "part of the full brake force that presses, without slide protection")

_OPTIONAL = (
    ("friction", "1", "friction coefficient of the brake of wheel {i}"),
    ("slide_protection_share", "1", "part of the brake force that slide protection leaves to wheel {i}"),
)
"""Of wheels with a brake that has it."""

_LIQUID = (
    Channel("liquid_force", "N", "longitudinal force of the liquid on the tank, positive forward"),
    Channel("liquid_moment", "N m", "moment of the liquid about the tank's bottom centre, nose-down"),
    Channel("surface_front", "m", "free-surface rise at the front end wall"),
    Channel("surface_rear", "m", "free-surface rise at the rear end wall"),
)

_ENERGY = (
    Channel("energy_kinetic", "J", "kinetic energy of wagon, load and rail"),
    Channel("energy_elastic", "J", "elastic energy of suspensions, contacts, rail and foundation"),
    Channel("energy_slosh", "J", "potential energy of the liquid's motion and of gravity"),
    Channel("energy_brake", "J", "energy taken by the brakes so far"),
    Channel("energy_creep", "J", "energy taken by creep in the contacts so far"),
    Channel("energy_suspension", "J", "energy taken by the suspension dampers so far"),
    Channel("energy_foundation", "J", "energy taken by the track foundation so far"),
    Channel("energy_resistance", "J", "energy taken by the running resistance so far"),
    Channel("energy_slosh_damping", "J", "energy taken by slosh damping so far"),
    Channel("energy_slope_work", "J", "work of the rail's slope under the wheels, and of flats, so far"),
    Channel("energy_gradient", "J", "work done against gravity on the gradient so far"),
    Channel("energy_residual", "1", "residual of the energy ledger over the initial kinetic energy"),
)


def _fixed_channels() -> tuple[Channel, ...]:
    bogies = (
        Channel(f"bogie_{i}_{quantity}", unit, meaning.format(i=i))
        for i in _BOGIES
        for quantity, unit, meaning in _BOGIE
    )
    wheels = (
        Channel(wheel(i, quantity), unit, meaning.format(i=i)) for i in WHEELS for quantity, unit, meaning in _WHEEL
    )
    return (*_WAGON, *bogies, *wheels, _BRAKE, *_LIQUID, *_ENERGY)


COUPLING_CHANNELS = (
    Channel("force", "N", "force of the whole coupling, positive in compression"),
    Channel("compression", "m", "compression of the coupling since the start"),
)
"""What each coupling of a train has."""
TIME = Channel("time", "s", "time since the start of the run")
CHANNELS: Mapping[str, Channel] = MappingProxyType({channel.name: channel for channel in _fixed_channels()})
"""Every channel that each run has, in file order. On top come slosh amplitudes, one per mode, and what only some brakes
have."""

_OF_SOME_BRAKES = {
    wheel(i, quantity): Channel(wheel(i, quantity), unit, meaning.format(i=i))
    for quantity, unit, meaning in _OPTIONAL
    for i in WHEELS
}
LINE_CHANNELS: Mapping[str, Channel] = MappingProxyType(
    {
        one.name: one
        for one in (
            Channel("line_gradient", "1", "gradient where the wagon is, uphill positive; not on a level line"),
            Channel(
                "line_height", "m", "height of the line where the wagon is, zero at the start; not on a level line"
            ),
            Channel("rail_level", "m", "height of the unloaded rail under wheel 1; not on even rails"),
        )
    }
)
"""Channels of runs whose line is not level or not even."""
_SLOSH_AMPLITUDE = re.compile(r"slosh_([1-9][0-9]*)_amplitude")


def channel(name: str) -> Channel:
    """Unit and meaning of the channel called `name`.

    Raises KeyError when no channel has that name.
    """
    known = CHANNELS.get(name) or LINE_CHANNELS.get(name) or _OF_SOME_BRAKES.get(name)
    if known is not None:
        return known
    match = _SLOSH_AMPLITUDE.fullmatch(name)
    if match:
        return Channel(name, "m", f"amplitude of longitudinal slosh mode {match[1]}")
    raise KeyError(f"There is no channel named {name!r}.")


def read_only(values: Vector) -> Vector:
    """The values (n,) of a channel as nobody can change them."""
    whole = values if values.size > _MOST_COPIED else np.ascontiguousarray(values, dtype=np.float64)
    view = whole.view()
    view.setflags(write=False)
    return view
