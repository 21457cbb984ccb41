"""The tank: shape, filling, liquid and slosh coefficients."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Literal, Self, TypeAlias

from pydantic import Discriminator, Field, Tag, create_model

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.amounts import AMOUNTS, FILLS, fill_of, wanted_volume
from slosh_cli.scenario.base import Alias, Aliased, Part
from slosh_cli.scenario.leaves import Count, Judge, Number, Quantity, Range
from slosh_cli.scenario.schema_polygon import Outline
from slosh_cli.scenario.units import plain
from slosh_cli.scenario.words import Choice

MOST_CELLS = 2000
"""Finite volumes along a tank."""
_FOLLOWS: Any = None
"""No value of its own: `TankBase.loaded` finds it."""
_DAMPING = Number(Range(0.0, 1.0, below=True), "0.005")


class Liquid(Part):
    """What is in the tank and how it moves."""

    model: Annotated[Literal["rigid", "modal", "shallow-water"], Choice(("rigid", "modal", "shallow-water"))] = Field(
        description="`rigid`: the equivalent solid load. `modal`: a free surface, by linear slosh modes. "
        "`shallow-water`: a free surface with a roof and a bottom, for long tanks."
    )
    density: Annotated[float, Quantity("density", Range(50.0, 2.5e4), "830 kg/m^3")] = Field(
        description="Density of the liquid, kg/m^3."
    )
    damping_ratio: Annotated[float, _DAMPING] = Field(
        default=0.0,
        description="Damping ratio of every computed slosh mode (given coefficients carry their own).",
    )
    cells: Annotated[int, Count(10, MOST_CELLS)] = Field(
        default=120, description="Finite volumes along the tank; only the shallow-water model uses them."
    )
    slot_speed: Annotated[float, Quantity("speed", Range(5.0, 100.0), "30 m/s")] = Field(
        default=30.0,
        description="Speed of pressure waves where the section runs full (shallow-water), m/s: higher is stiffer.",
    )
    dispersion: Annotated[Literal["on", "off"], Choice(("on", "off"))] = Field(
        default="off",
        description="`on`: the shallow-water model with the motion across the section, by which shorter waves run "
        "slower and a part of the liquid rides along at once.",
    )


class Coefficient(Part):
    """One longitudinal slosh mode of the whole tank, in any normalisation."""

    frequency: Annotated[float, Quantity("angular_frequency", Range(1e-3, 1e3), "0.69 rad/s")] = Field(
        description="Natural angular frequency, rad/s (a value in Hz is multiplied by 2 pi)."
    )
    lambda_1: Annotated[float, Quantity("mass", Range(-1e8, 1e8), "137071 kg", nonzero=True)] = Field(
        description="Inertial coupling of the mode with the tank's longitudinal motion, kg; not zero."
    )
    lambda_02: Annotated[float, Quantity("first_moment", Range(-1e9, 1e9), "-68461 kg m")] = Field(
        description="Inertial coupling of the mode with the tank's pitch about its bottom centre, kg m."
    )
    mu: Annotated[float, Quantity("mass", Range(0.0, 1e12, above=True), "442163 kg")] = Field(
        description="Modal mass, kg."
    )
    damping_ratio: Annotated[float, _DAMPING] = Field(default=0.0, description="Damping ratio of the mode.")


@dataclass(frozen=True)
class _ComputedOrGiven(Judge):
    def parse(self, value: object) -> Any:
        if (isinstance(value, list | tuple) and value) or value == "computed":
            return value
        if isinstance(value, str):
            refused = Choice(("computed",)).refusal(value)
            rule, given, fix = "must be `computed` or a list of slosh modes", refused.given, refused.fix
        elif isinstance(value, dict):
            rule, given = "must be `computed` or a list of slosh modes", "a mapping"
            fix = "write each mode as a list item: `- {frequency: ..., lambda_1: ..., lambda_02: ..., mu: ...}`"
        else:
            rule, given = "must be `computed` or a list of at least one slosh mode", plain(value)
            fix = "write `computed`, or `- {frequency: ..., lambda_1: ..., lambda_02: ..., mu: ...}` for each mode"
        raise ValueRefused(rule, given, fix)


def _coefficient_kind(value: Any) -> str:
    return "computed" if isinstance(value, str) else "given"


_Coefficients: TypeAlias = Annotated[
    Annotated[Literal["computed"], Tag("computed")]
    | Annotated[tuple[Coefficient, ...], Field(min_length=1), Tag("given")],
    Discriminator(_coefficient_kind),
    _ComputedOrGiven(),
]


_HEIGHT = Quantity("length", Range(0.0, 20.0), "0.6 m")
_FROM: dict[str, Any] = {  # a key that cannot be written as a class has its fields
    "from": (
        Annotated[float, replace(_HEIGHT, example="0 m")],
        Field(description="Lower edge above the tank's bottom, m."),
    )
}
_Ends: Any = create_model("_Ends", __base__=Part, __doc__="What has a lower edge.", **_FROM)


class Opening(_Ends):  # type: ignore[misc]
    """A part of a baffle's height that is open over the full width of the section."""

    to: Annotated[float, _HEIGHT] = Field(description="Upper edge above the tank's bottom, m; at most the roof.")


class Baffle(Part):
    """A transverse wall, closed, perforated or with openings, for the shallow-water model."""

    exactly_one: ClassVar[tuple[tuple[str, ...], ...]] = (("opening", "openings"),)

    position: Annotated[float, Quantity("length", Range(0.0, 200.0), "5 m")] = Field(
        description="Distance from the rear end wall, m; taken to the nearest face between cells."
    )
    opening: Annotated[float | None, Number(Range(0.0, 1.0), "0.3")] = Field(
        default=None,
        description="Open part of the area of an evenly perforated wall, from 0 (a closed bulkhead) to 1 (no wall).",
    )
    openings: tuple[Opening, ...] = Field(
        default=(), description="Where the wall is open, in place of `opening`: heights that do not overlap."
    )

    @property
    def bands(self) -> tuple[tuple[float, float], ...]:
        """From where to where the wall is open, m above the tank's bottom."""
        return tuple((getattr(opening, "from"), opening.to) for opening in self.openings)

    def unwritten(self, *, as_text: bool) -> Collection[str]:  # noqa: ARG002 - as everywhere
        """The way of the two that the wall is not told."""
        return ("openings",) if self.opening is not None else ("opening",)


class TankBase(Aliased):
    """What tanks of every shape have. Values are of the whole tank.

    How much is in it stands in one of four keys. `fill` is the depth whichever was written, in every checked scenario.
    """

    exactly_one: ClassVar[tuple[tuple[str, ...], ...]] = (("fill", *AMOUNTS),)

    length: Annotated[float, Quantity("length", Range(0.05, 200.0), "15.5 m")] = Field(
        description="Inner length between the flat ends, m."
    )
    fill: Annotated[float, Number(FILLS, "0.5")] = Field(
        default=_FOLLOWS, description="Depth of the liquid as a fraction of the tank's inner height."
    )
    volume: Annotated[float | None, Quantity("volume", Range(0.0, 1e5, above=True), "45 m^3")] = Field(
        default=None, description="Volume of the liquid, m^3, in place of the fill."
    )
    mass: Annotated[float | None, Quantity("mass", Range(0.0, 1e8, above=True), "60 t")] = Field(
        default=None, description="Mass of the liquid, kg, in place of the fill."
    )
    gross_mass: Annotated[float | None, Quantity("mass", Range(0.0, 1e8, above=True), "90 t")] = Field(
        default=None, description="Mass of the wagon with its load, kg, in place of the fill; not for a tank alone."
    )
    bottom_height: Annotated[float, Quantity("length", Range(0.0, 6.0), "1.15 m")] = Field(
        default=0.0,
        description="Height of the tank's lowest inner point above the rail head, m. "
        "Required with a wagon, without meaning for a tank alone.",
    )
    liquid: Liquid = Field(description="What is in the tank.")
    coefficients: _Coefficients = Field(
        default="computed",
        description="`computed` from the tank's geometry, or a list of slosh modes to be used as they are.",
    )
    modes: Annotated[int, Count(1, 20)] = Field(
        default=1,
        description="How many odd longitudinal modes to compute; not to be set with given coefficients.",
    )
    baffles: tuple[Baffle, ...] = Field(
        default=(), description="Transverse walls, closed or with openings; the modal liquid knows none."
    )

    def unwritten(self, *, as_text: bool) -> Collection[str]:
        """The number of modes beside given coefficients, where a file must not set it, or where nobody asked for it;
        the fill that follows from another amount."""
        counts = self.coefficients == "computed" and (as_text or "modes" in self.model_fields_set)
        return (*(() if counts else ("modes",)), *(() if "fill" in self.model_fields_set else ("fill",)))

    def loaded(self, tare: float | None) -> Self:
        """This tank with the fill that belongs to its amount of liquid; `tare` (kg) is of the wagon that carries it.

        The amount must have passed the rules of `amounts`.
        """
        if "fill" in self.model_fields_set:
            return self
        tank = self.model_copy()
        vars(tank)["fill"] = fill_of(tank, wanted_volume(tank, tare))
        return tank


class HorizontalCylinder(TankBase):
    """A circular cylinder lying along the track."""

    aliases: ClassVar[tuple[Alias, ...]] = (
        Alias("diameter", "radius", 2.0, "3 m", "Inner diameter, m, in place of the radius."),
    )

    shape: Literal["horizontal-cylinder"] = Field(
        default="horizontal-cylinder", description="Cross-section: a circle of the given radius."
    )
    radius: Annotated[float, Quantity("length", Range(0.02, 10.0), "1.5 m")] = Field(description="Inner radius, m.")

    @property
    def height(self) -> float:
        """Inner height, m."""
        return 2.0 * self.radius

    @property
    def width(self) -> float:
        """Largest inner width, m."""
        return 2.0 * self.radius


class Rectangular(TankBase):
    """A box."""

    shape: Literal["rectangular"] = Field(default="rectangular", description="Cross-section: a rectangle.")
    width: Annotated[float, Quantity("length", Range(0.02, 20.0), "2.4 m")] = Field(description="Inner width, m.")
    height: Annotated[float, Quantity("length", Range(0.02, 20.0), "2.0 m")] = Field(description="Inner height, m.")


class Elliptical(TankBase):
    """An elliptical cylinder lying along the track, its axes upright and level."""

    shape: Literal["elliptical"] = Field(default="elliptical", description="Cross-section: an ellipse.")
    width: Annotated[float, Quantity("length", Range(0.02, 20.0), "2.6 m")] = Field(
        description="Inner width, the level axis of the ellipse, m."
    )
    height: Annotated[float, Quantity("length", Range(0.02, 20.0), "2.2 m")] = Field(
        description="Inner height, the upright axis of the ellipse, m."
    )


class Polygon(TankBase):
    """A tank of any straight-sided cross-section that is symmetric about its upright centre line."""

    shape: Literal["polygon"] = Field(default="polygon", description="Cross-section: a polygon.")
    points: Annotated[tuple[tuple[float, float], ...], Outline(20.0)] = Field(
        description="Corners [y, z] in order around the section, m: y from the centre, z from the bottom."
    )

    @property
    def height(self) -> float:
        """Inner height, m."""
        return max(z for _, z in self.points)

    @property
    def width(self) -> float:
        """Largest inner width, m."""
        return 2.0 * max(y for y, _ in self.points)


Tank: TypeAlias = Annotated[HorizontalCylinder | Rectangular | Elliptical | Polygon, Field(discriminator="shape")]
