"""The parts of a history file: columns with their units, and the surface along the tank with its coordinates."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterator
from datetime import UTC, datetime
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.channels import Channel
from slosh_cli.results.stored import faults_of_shape, is_there
from slosh_cli.results.surface import SurfaceProfile
from slosh_cli.version import __version__

if TYPE_CHECKING:
    import h5py

SURFACE: Final = "surface_profile"
"""Name of the surface along the tank, and how the names of its coordinates begin."""
_IN_RUNS: Final = (f"{SURFACE}_time", f"{SURFACE}_place", SURFACE)
_IN_EXCITATIONS: Final = ("profile_time", "profile_place", "profile_rise")
_MOST_NUMBERS: Final = 20_000_000
"""Of a surface; that of a run has at most half a million."""
_HIGHEST: Final = 1e3
"""No surface rises or falls by so many metres."""


def write_channel(group: h5py.Group, info: Channel, values: Array) -> h5py.Dataset:
    """Write numbers with their unit and meaning."""
    dataset = group.create_dataset(info.name, data=values, dtype="<f8")
    dataset.attrs["units"] = info.unit
    dataset.attrs["long_name"] = info.long_name
    return dataset


def write_surface(group: h5py.Group, profile: SurfaceProfile) -> None:
    """Write the surface along the tank, (times, places), with its coordinates."""
    time, place, name = _IN_RUNS
    instants = Channel(time, "s", "instants of the surface along the tank")
    places = Channel(place, "m", "distance from the front end wall; twice where a baffle stands")
    scales = [write_channel(group, instants, profile.time), write_channel(group, places, profile.place)]
    rise = group.create_dataset(name, data=profile.rise, dtype="<f4", compression="gzip", shuffle=True)
    rise.attrs.update({"units": "m", "long_name": "rise of the free surface", "standing": profile.standing})
    for axis, scale in enumerate(scales):
        scale.make_scale(_IN_RUNS[axis])
        rise.dims[axis].attach_scale(scale)


def stored_surface(group: h5py.Group, excited: bool = False) -> tuple[SurfaceProfile | None, list[str]]:
    """The surface along the tank in a file, or that of a tank alone, whose places are as they stand there; and what is
    wrong with it. None where there is none, or no sound one."""
    names = _IN_EXCITATIONS if excited else _IN_RUNS
    if not any(name in group for name in names):
        return None, []
    faults = list(_faults_of_kind(group, names))
    if faults:
        return None, faults
    time, place, rise = (np.asarray(group[name][:], dtype=np.float64) for name in names)
    standing = group[names[2]].attrs.get("standing", "computed" if excited else None)
    faults = list(_faults_of_numbers(names, time, place, rise, standing))
    return (None, faults) if faults else (SurfaceProfile(time, place, rise, standing), [])


def _faults_of_kind(group: h5py.Group, names: tuple[str, str, str]) -> Iterator[str]:
    """What keeps the datasets, not read yet, from being a surface and its coordinates."""
    missing = [name for name in names if name not in group]
    if missing:
        yield f"its surface along the tank lacks {', '.join(missing)}"
        return
    coordinates = [fault for name in names[:2] for fault in faults_of_shape(name, group.get(name))]
    yield from coordinates
    shape, dtype = getattr(group[names[2]], "shape", None), getattr(group[names[2]], "dtype", None)
    if coordinates:
        return
    wanted = (group[names[0]].shape[0], group[names[1]].shape[0])
    if shape != wanted or getattr(dtype, "kind", "") not in "fiu":
        yield f"its {names[2]} must be numbers, as many as its coordinates ({wanted[0]} by {wanted[1]})"
    elif wanted[0] * wanted[1] > _MOST_NUMBERS:
        yield f"its {names[2]} must have at most {_MOST_NUMBERS} numbers"
    elif not is_there(group[names[2]], 8 * _MOST_NUMBERS):
        yield f"its {names[2]} must be in the file itself"


def _faults_of_numbers(names: tuple[str, ...], time: Array, place: Array, rise: Array, standing: Any) -> Iterator[str]:
    """What is wrong with the numbers of a surface."""
    if not np.isfinite(time).all() or (np.diff(time) <= 0.0).any():
        yield f"its {names[0]} must be finite and rise"
    if not np.isfinite(place).all() or (np.diff(place) < 0.0).any():
        yield f"its {names[1]} must be finite and must not fall"
    if not (np.abs(rise) < _HIGHEST).all():
        yield f"its {names[2]} must be finite, and within {_HIGHEST:g} m"
    if standing not in ("computed", "assumed"):
        yield f"its {names[2]} must be computed or assumed"


def circumstances() -> dict[str, Any]:
    """Which program wrote the file, when and where."""
    return {
        "program": "slosh",
        "program_version": __version__,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "python_version": platform.python_version(),
        "numpy_version": np.__version__,
        "numba_version": version("numba"),
        "platform": f"{platform.platform()} {sys.byteorder}-endian",
    }
