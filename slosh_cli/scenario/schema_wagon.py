"""The wagon: bodies, suspension, running resistance. Values are of the whole wagon unless a text says not."""

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Final, Literal, TypeAlias

from pydantic import Discriminator, Field, Tag

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Alias, Aliased, Part
from slosh_cli.scenario.leaves import Count, Judge, Quantity, Range
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.units import at_most, plain, shown
from slosh_cli.scenario.words import Choice

_Stiffness = Annotated[float, Quantity("stiffness", Range(1e4, 1e12), "2.6e6 N/m")]
_Damping = Annotated[float, Quantity("damping", Range(0.0, 1e10), "1.5e4 N s/m")]

_COUPLING_HEIGHT: Final = 1.06
"""m."""


class CarBody(Part):
    """The car body with the empty tank, without bogies, wheelsets and load."""

    mass: Annotated[float, Quantity("mass", Range(500.0, 2e5), "21.3 t")] = Field(
        description="Mass of the car body with its empty tank, kg."
    )
    pitch_inertia: Annotated[float, Quantity("moment_of_inertia", Range(500.0, 1e8), "4.6e5 kg m^2")] = Field(
        description="Moment of inertia in pitch about the centre of mass, kg m^2."
    )
    centre_height: Annotated[float, Quantity("length", Range(0.2, 6.0), "2.2 m")] = Field(
        description="Height of the centre of mass above the rail head, m."
    )


class Bogie(Part):
    """One of the two bogie frames, without its wheelsets."""

    mass: Annotated[float, Quantity("mass", Range(50.0, 3e4), "1.8 t")] = Field(
        description="Mass of one bogie frame without its wheelsets, kg."
    )
    pitch_inertia: Annotated[float, Quantity("moment_of_inertia", Range(5.0, 1e6), "1700 kg m^2")] = Field(
        description="Moment of inertia of one frame in pitch about its centre of mass, kg m^2."
    )
    centre_height: Annotated[float, Quantity("length", Range(0.05, 3.0), "0.55 m")] = Field(
        description="Height of the frame's centre of mass above the rail head, m."
    )
    wheelbase: Annotated[float, Quantity("length", Range(0.5, 8.0), "1.8 m")] = Field(
        description="Distance between the two axles of one bogie, m."
    )


class Wheelset(Aliased):
    """One of the four wheelsets: two wheels on an axle."""

    aliases: ClassVar[tuple[Alias, ...]] = (
        Alias("wheel_diameter", "wheel_radius", 2.0, "0.92 m", "Rolling diameter of the wheels, m, for the radius."),
    )

    mass: Annotated[float, Quantity("mass", Range(50.0, 1e4), "1.4 t")] = Field(description="Mass of one wheelset, kg.")
    spin_inertia: Annotated[float, Quantity("moment_of_inertia", Range(0.5, 5e3), "120 kg m^2")] = Field(
        description="Moment of inertia of one wheelset about its axle, kg m^2."
    )
    wheel_radius: Annotated[float, Quantity("length", Range(0.1, 1.5), "0.46 m")] = Field(
        description="Rolling radius of the wheels, m."
    )


class Suspension(Part):
    """One suspension unit of the planar model: one wheel (primary) or one side of one bogie (secondary)."""

    stiffness: _Stiffness = Field(description="Vertical stiffness of one unit, N/m.")
    damping: _Damping = Field(description="Vertical viscous damping of one unit, N s/m.")


@dataclass(frozen=True)
class _SpringsOrNone(Judge):
    def parse(self, value: object) -> Any:
        if value == "none" or isinstance(value, dict | Suspension):
            return value
        fix = "write `none`, or something such as `{stiffness: 6 MN/m, damping: 65 kN s/m}`"
        if isinstance(value, str):
            refused = Choice(("none",)).refusal(value)
            fix = refused.fix if Choice(("none",)).guess(value) else fix
        raise ValueRefused("must be `none` or a mapping of stiffness and damping", plain(value), fix)


def _suspension_kind(value: Any) -> str:
    return "none" if isinstance(value, str) else "springs"


_SecondarySuspension: TypeAlias = Annotated[
    Annotated[Suspension, Tag("springs")] | Annotated[Literal["none"], Tag("none")],
    Discriminator(_suspension_kind),
    _SpringsOrNone(),
]


class RunningResistance(Part):
    """Running resistance of the whole wagon, constant + linear V + quadratic V^2."""

    constant: Annotated[float, Quantity("force", Range(0.0, 1e5), "851 N")] = Field(
        description="Part that does not depend on speed, N."
    )
    linear: Annotated[float, Quantity("damping", Range(0.0, 1e4), "13.5 N s/m")] = Field(
        description="Factor of the speed, N s/m."
    )
    quadratic: Annotated[float, Quantity("quadratic_resistance", Range(0.0, 1e3), "1.244 N s^2/m^2")] = Field(
        description="Factor of the squared speed, N s^2/m^2."
    )


class WheelFlat(Part):
    """A flat on a wheel: one smooth dip of its tread per turn."""

    wheel: Annotated[int, Count(1, 4)] = Field(description="Number of the wheel, 1 leading to 4 trailing.")
    depth: Annotated[float, Quantity("length", Range(0.0, 0.02, above=True), "1 mm")] = Field(
        description="What the flat takes off the wheel's radius in its middle, m."
    )
    length: Annotated[float, Quantity("length", Range(0.005, 1.0), "60 mm")] = Field(
        description="Length of the flat along the tread, m."
    )


def _flats_on_their_wheels(v: Values) -> Iterator[Finding]:
    """A wheel has one flat, on a quarter of its tread at most."""
    wheels = [flat.wheel for flat in v.get("wheel_flats", ())]
    for number, wheel in enumerate(wheels):
        if wheel in wheels[:number]:
            rule, given = "must be another wheel for each flat", f"wheel {wheel} again"
            yield Finding(("wheel_flats", number, "wheel"), rule, given, "keep one of them")
    if not v.has("wheelset.wheel_radius"):
        return
    most = 0.5 * math.pi * v["wheelset.wheel_radius"]
    for number, flat in enumerate(v.get("wheel_flats", ())):
        if flat.length > most:
            rule = f"must be at most a quarter of the wheel's circumference, {at_most(most)} m"
            given = f"`{shown(flat.length)} m`"
            yield Finding(("wheel_flats", number, "length"), rule, given, f"write `{at_most(most)} m` or less")


class Wagon(Part):
    """A four-axle wagon on two bogies."""

    rules = (_flats_on_their_wheels,)

    car_body: CarBody = Field(description="The car body with the empty tank.")
    bogie: Bogie = Field(description="One of the two equal bogie frames.")
    wheelset: Wheelset = Field(description="One of the four equal wheelsets.")
    pivot_spacing: Annotated[float, Quantity("length", Range(1.5, 60.0), "12 m")] = Field(
        description="Distance between the two bogie pivots, m."
    )
    traction_height: Annotated[float, Quantity("length", Range(0.0, 4.0), "0.90 m")] = Field(
        description="Height above the rail head at which bogies and car body pull each other along, m."
    )
    primary_suspension: Suspension = Field(description="Between wheelset and bogie frame: one unit per wheel.")
    secondary_suspension: _SecondarySuspension = Field(
        description="Between bogie frame and car body: one unit per bogie and side of the wagon; `none` for bogies "
        "such as the Y25, whose pivots carry the car without springs."
    )
    running_resistance: RunningResistance = Field(description="Running resistance of the whole wagon.")
    wheel_flats: tuple[WheelFlat, ...] = Field(default=(), description="Flats on wheels, one per wheel at most.")
    length_over_buffers: Annotated[float | None, Quantity("length", Range(3.0, 100.0), "17 m")] = Field(
        default=None,
        description="Length that the wagon takes in a train, m; a wagon alone does not use it. "
        "Default: the pivot spacing and 5 m.",
    )
    coupling_height: Annotated[float, Quantity("length", Range(0.2, 4.0), "1.06 m")] = Field(
        default=_COUPLING_HEIGHT, description="Height of the couplings above the rail head, m; matters in a train."
    )

    @property
    def length_in_train(self) -> float:
        """Length over buffers, m."""
        return self.pivot_spacing + 5.0 if self.length_over_buffers is None else self.length_over_buffers

    def unwritten(self, *, as_text: bool) -> Collection[str]:  # noqa: ARG002 - the same for both
        """Flats of round wheels, the usual height of couplings."""
        usual = {"wheel_flats": (), "coupling_height": _COUPLING_HEIGHT}
        return [name for name, value in usual.items() if getattr(self, name) == value]
