"""Why a run may take long: what in a scenario asks for many steps, or for much work in each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import shown

_TIGHT: Final = 1e-5
"""From this tolerance on."""
_MANY_CELLS: Final = 240
_MANY_VEHICLES: Final = 20
_HARDLY: Final = 100.0
"""N s/m^2; less damping of a foundation leaves the waves of the rail to themselves."""


def why_long(vehicles: Sequence[Scenario]) -> str:
    """What makes a run of these vehicles long, in words."""
    causes = list(dict.fromkeys(cause for one in vehicles for cause in _causes(one)))
    if len(vehicles) >= _MANY_VEHICLES:
        causes.insert(0, f"the train has {len(vehicles)} vehicles")
    return (
        f"it may take long because {', and '.join(causes)}"
        if causes
        else ("it takes many steps: wheels that shake, lift or land keep them short")
    )


def _causes(scenario: Scenario) -> Iterator[str]:
    wagon, track, liquid = scenario.wagon, scenario.track, scenario.tank.liquid
    if scenario.solver.tolerance < _TIGHT:
        yield f"a tolerance of {shown(scenario.solver.tolerance)} asks for many steps"
    if track.model != "rigid" and track.foundation.damping < _HARDLY:
        yield "track.foundation.damping is next to none, so that wheels go on shaking"
    if wagon.primary_suspension.damping == 0.0:
        yield "wagon.primary_suspension.damping is none, so that bodies go on bouncing"
    if track.unevenness is not None or wagon.wheel_flats:
        yield "steps follow the unevenness of rails and wheels"
    if liquid.model == "shallow-water" and liquid.cells >= _MANY_CELLS:
        yield f"the liquid has {liquid.cells} cells"
