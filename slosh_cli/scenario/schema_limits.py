"""What verdicts hold a wagon, its brake and its load against; every limit has a usual value."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Number, Quantity, Range
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.units import shown

_SHARE = Range(0.0, 1.0)


def _low_below_high(v: Values) -> Iterator[Finding]:
    """Shares that are not allowed lie between the two; the wrong way round they would allow everything."""
    if v.has("filling_low", "filling_high") and v["filling_low"] > v["filling_high"]:
        rule = f"must be at most `filling_high`, {shown(v['filling_high'])}"
        fix = "write a lower value, or a higher `filling_high`"
        yield Finding(("filling_low",), rule, f"`{shown(v['filling_low'])}`", fix)


class Limits(Part):
    """Limits of verdicts, and what they need to know of the substance. Verdicts change no other answer."""

    rules = (_low_below_high,)

    axle_load: Annotated[float, Quantity("mass", Range(1e3, 1e5), "22.5 t")] = Field(
        default=22_500.0, description="Largest axle load, kg; category D of EN 15528 where it is left out."
    )
    tau: Annotated[float, Number(Range(0.0, 1.0, above=True), "0.12")] = Field(
        default=0.12, description="Largest brake force over weight of a wagon without wheel slide protection."
    )
    tau_with_protection: Annotated[float, Number(Range(0.0, 1.0, above=True), "0.15")] = Field(
        default=0.15, description="Largest brake force over weight of a wagon with wheel slide protection."
    )
    unloading: Annotated[float, Number(Range(0.0, 1.0, above=True), "0.6")] = Field(
        default=0.6, description="Largest wheel unloading, 1 - N/N0."
    )
    filling_low: Annotated[float, Number(_SHARE, "0.2")] = Field(
        default=0.2,
        description="Share of the capacity up to which a large shell in one part may be filled (ADR).",
    )
    filling_high: Annotated[float, Number(_SHARE, "0.8")] = Field(
        default=0.8, description="Share of the capacity from which on such a shell may be filled (ADR 4.3.2.2.4)."
    )
    part_volume: Annotated[float, Quantity("volume", Range(0.0, 1e5), "7500 L")] = Field(
        default=7.5, description="A shell in parts of at most this capacity, m^3, may be filled to any share."
    )
    wall_opening: Annotated[float, Number(_SHARE, "0.3")] = Field(
        default=0.3, description="A baffle divides a shell into parts where at most this share of its area is open."
    )
    exempt_viscosity: Annotated[float, Quantity("kinematic_viscosity", Range(0.0, 1e3), "2680 mm^2/s")] = Field(
        default=2.68e-3, description="A liquid as viscous as this at 20 degC, m^2/s, may fill any share of a shell."
    )
    viscosity: Annotated[float, Quantity("kinematic_viscosity", Range(0.0, 1e3), "0.6 mm^2/s")] = Field(
        default=6e-7,
        description="Kinematic viscosity of the liquid at 20 degC, m^2/s; gasoline's by default.",
    )
    filling_degree: Annotated[float, Number(Range(0.5, 1.0), "1.0")] = Field(
        default=1.0,
        description="Share of the capacity that the liquid may take at 50 degC: 1, 0.98, 0.97 or 0.95 by its dangers "
        "(ADR 4.3.2.2.1 a to d).",
    )
    filling_celsius: Annotated[float, Number(Range(-60.0, 50.0), "15")] = Field(
        default=15.0, description="Mean temperature of the liquid when it was filled in, a number of degC."
    )
    expansion_per_kelvin: Annotated[float, Number(Range(0.0, 0.01), "0.0012")] = Field(
        default=1.2e-3,
        description="Mean cubical expansion of the liquid from 15 to 50 degC, a number per kelvin; about gasoline's "
        "where it is left out.",
    )

    def standing_of(
        self, keys: tuple[str, ...], usual: Literal["standard", "indicative", "assumed"], source: str
    ) -> tuple[Literal["standard", "indicative", "assumed"], str]:
        """Standing and source of the limits under `keys`: the usual ones, or that the scenario has its own."""
        own = [f"limits.{key}" for key in keys if getattr(self, key) != type(self).model_fields[key].default]
        return ("assumed", f"{', '.join(own)} of the scenario; usual: {source}") if own else (usual, source)
