"""The free surface along the tank at output instants, for pictures: from the modal amplitudes that a run records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.results.channels import slosh_amplitude
from slosh_cli.results.stored import LARGEST, is_there

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario

_PLACES: Final = 33
_MOST_TIMES: Final = 1000
_MOST_PLACES: Final = 3000
"""Of times, and of places, in a file."""


@dataclass(frozen=True, eq=False)
class SurfaceProfile:
    """Rise of the surface (m) over the still one: `rise` (times, places), at `time` s and at `place` m from the front
    end wall. `standing` is "computed", or "assumed" where the scenario gives modes without their shapes."""

    time: Vector
    place: Vector
    rise: Matrix
    standing: str


def surface_profile(scenario: Scenario, time: Vector, channels: Mapping[str, Vector]) -> SurfaceProfile | None:
    """The surface of a load in modes or frozen, at not more than 1000 instants; None where only its ends are recorded.

    The n-th mode is a cosine of 2 n - 1 half waves (theory section 4), one at the front wall where it lifts the liquid
    there. Given modes count as those, from the lowest frequency on.
    """
    tank = scenario.tank
    if tank.liquid.model not in ("modal", "rigid"):
        return None
    rows = np.unique(np.linspace(0, time.size - 1, min(time.size, _MOST_TIMES)).round().astype(np.int64))
    place = np.linspace(0.0, tank.length, _PLACES)
    rise, standing = np.zeros((rows.size, _PLACES)), "computed"
    if tank.liquid.model == "modal":
        count = sum(slosh_amplitude(n) in channels for n in range(1, len(channels) + 1))
        shapes = [(n, 1.0) for n in range(count)]
        if not isinstance(tank.coefficients, str):
            standing = "assumed"
            order = np.argsort(np.argsort([mode.frequency for mode in tank.coefficients], kind="stable"))
            ways = np.sign([mode.lambda_1 for mode in tank.coefficients])
            shapes = list(zip(order.tolist(), ways.tolist(), strict=True))
        amplitude = np.stack([channels[slosh_amplitude(n + 1)][rows] for n in range(count)], axis=1)
        rise = amplitude @ np.stack([way * np.cos((2 * n + 1) * np.pi * place / tank.length) for n, way in shapes])
    walls = np.stack([channels["surface_front"][rows], channels["surface_rear"][rows]], axis=1)
    if not np.allclose(rise[:, [0, -1]], walls, rtol=1e-9, atol=1e-9, equal_nan=True):
        return None
    return SurfaceProfile(time[rows], place, rise, standing)


def stored_surface(file: Any, name: str) -> SurfaceProfile | list[str]:
    """The surface in the datasets `name` of an open file, or what is wrong with it."""
    held = [file.get(one) for one in (f"{name}_time", f"{name}_place", name)]
    shapes: list[Any] = [getattr(one, "shape", None) for one in held]
    kinds = {getattr(getattr(one, "dtype", None), "kind", "") for one in held}
    columns = all(shape is not None and len(shape) == 1 and 0 < shape[0] <= _MOST_PLACES for shape in shapes[:2])
    if not columns or shapes[2] != (*shapes[0], *shapes[1]) or not kinds <= set("fiu") or not all(map(is_there, held)):
        return [f"its {name} must be numbers in the file itself, as many as it has times and places"]
    time, place, rise = (np.asarray(one[:], dtype=np.float64) for one in held)
    if not all((np.abs(values) < LARGEST).all() for values in (time, place, rise)) or (np.diff(time) < 0.0).any():
        return [f"its {name} must be finite, and its times must not fall"]
    return SurfaceProfile(time, place, rise, str(held[2].attrs.get("standing", "")))
