"""The paper's track with other dampings, stiffnesses and meshes, and the same as a `Beam`."""

from __future__ import annotations

from typing import cast

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.scenario import Track
from slosh_cli.validation.exact.steady_rail import Beam
from slosh_cli.validation.runs import scenario

WHEEL_PLACES = np.array([4.0, 0.0, -2.0, -4.0])
"""Places of the wheels in m: the second stands in the middle of the domain and carries the load."""
LOADED = 1


def paper_track(element_length: float, length: float = 80.0, **foundation: float) -> Track:
    """The paper's track, undamped unless `foundation` says otherwise."""
    track = scenario("paper-80-liquid").track
    changes = {"damping": 0.0, "shear_damping": 0.0, **foundation}
    return track.model_copy(
        update={
            "foundation": track.foundation.model_copy(update=changes),
            "domain": track.domain.model_copy(update={"length": length, "element_length": element_length}),
        }
    )


def beam(track: Track) -> Beam:
    """The numbers of a track."""
    rail, foundation = track.rail, track.foundation
    return Beam(
        bending=rail.youngs_modulus * rail.second_moment,
        mass=rail.mass_per_length,
        stiffness=foundation.stiffness,
        shear=foundation.shear_stiffness,
        damping=foundation.damping,
        shear_damping=foundation.shear_damping,
    )


def steady_deflections(track: Track, speed: float) -> tuple[Array, Array]:
    """Nodes (m) and deflection (m, down) per newton under the loaded wheel, as the program computes them."""
    from slosh_cli.track import mem

    rail = mem.rail_model(track, WHEEL_PLACES)
    length, element_length = cast(tuple[float, float], (track.domain.length, track.domain.element_length))
    nodes = mem.fitted_nodes(WHEEL_PLACES, length, element_length)[1:-1]
    return nodes, -mem.steady_shapes(rail, speed)[1 : rail.nodes - 1, LOADED]


def at(nodes: Array, values: Array, r: float) -> float:
    """The value at the node nearest to `r`."""
    return float(values[np.argmin(np.abs(nodes - r))])
