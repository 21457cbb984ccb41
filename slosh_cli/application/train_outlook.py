"""What can be told of a train's vehicles before anything moves: a data sheet for all that are alike."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from slosh_cli.results.data_sheet import data_sheet
from slosh_cli.scenario import Braking, Scenario
from slosh_cli.scenario.presets import Standing
from slosh_cli.scenario.standing import standings
from slosh_cli.scenario.units import shown

if TYPE_CHECKING:
    from slosh_cli.scenario.train_file import TrainScenario


@dataclass(frozen=True)
class VehicleKind:
    """Vehicles that are alike but for their places: these from the front, the scenario of the first, its data sheet."""

    places: tuple[int, ...]
    vehicle: Scenario
    sheet: dict[str, float | None]

    @property
    def brake(self) -> str:
        """What presses the brake, with its numbers."""
        return _brake_words(self.vehicle.braking)

    def inputs(self) -> dict[str, Standing]:
        """Value, standing and source of what the vehicle's own scenario says."""
        return standings(self.vehicle)

    def as_dict(self) -> dict[str, Any]:
        """The kind as JSON has it."""
        load = self.vehicle.tank.liquid.model
        found = {"vehicles": list(self.places), "name": self.vehicle.name, "liquid_model": load, "brake": self.brake}
        return found | {"data_sheet": self.sheet}


def vehicle_kinds(train: TrainScenario) -> list[VehicleKind]:
    """The kinds of vehicles in the order in which they first come."""
    alike: list[tuple[Scenario, list[int]]] = []
    for place, vehicle in enumerate(train.vehicles, 1):
        for other, places in alike:
            if _is_like(vehicle, other):
                places.append(place)
                break
        else:
            alike.append((vehicle, [place]))
    return [VehicleKind(tuple(places), one, data_sheet(one)) for one, places in alike]


def _is_like(one: Scenario, other: Scenario) -> bool:
    """Whether two vehicles differ by nothing but when the brake wave reaches them."""
    braking = one.braking.model_copy(update={"onset": other.braking.onset})
    return braking == other.braking and one.model_copy(update={"braking": braking}) == other


def _brake_words(braking: Braking) -> str:
    return ", ".join(_parts(braking))


def _parts(braking: Braking) -> Iterator[str]:
    if braking.torque is not None:
        yield f"torque {shown(braking.torque / 1e3)} kN m"
    for name, one in (("blocks", braking.blocks), ("discs", braking.discs)):
        if one is not None:
            points = getattr(one.friction, "points", ())
            ends = dict.fromkeys(shown(friction) for _, friction in (*points[:1], *points[-1:]))
            friction = " ... ".join(ends) or one.friction.law
            yield f"{name} {friction}, {one.count} x {shown(one.force / 1e3)} kN"
    if braking.deceleration is not None:
        yield f"deceleration {shown(braking.deceleration)} m/s^2"
    if braking.braked_weight is not None:
        yield f"braked weight {shown(braking.braked_weight.percentage)} %"
    if braking.load_changeover is not None:
        yield "load changeover"
    if braking.slide_protection is not None:
        yield "slide protection"
