"""Track, contact, solver and output of a stop."""

from collections.abc import Iterator
from typing import Annotated, Final

from pydantic import Field

from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Number, Quantity, Range
from slosh_cli.scenario.rules import Finding, Values
from slosh_cli.scenario.schema_line import GRADIENT, Unevenness
from slosh_cli.scenario.short import Short
from slosh_cli.scenario.units import at_most, shown
from slosh_cli.scenario.words import Choice


class Rail(Part):
    """One rail as an Euler-Bernoulli beam."""

    youngs_modulus: Annotated[float, Quantity("modulus", Range(1e9, 1e13), "200 GPa")] = Field(
        description="Young's modulus of the rail steel, Pa."
    )
    second_moment: Annotated[float, Quantity("second_moment", Range(1e-8, 1e-1), "3.06e-5 m^4")] = Field(
        description="Second moment of area of one rail about its level axis, m^4."
    )
    mass_per_length: Annotated[float, Quantity("mass_per_length", Range(5.0, 1e4), "60 kg/m")] = Field(
        description="Mass of one rail per length, kg/m."
    )


class Foundation(Part):
    """The damped Pasternak foundation under one rail."""

    stiffness: Annotated[float, Quantity("stiffness_per_length", Range(1e5, 1e11), "1.0e7 N/m^2")] = Field(
        description="Vertical stiffness per length of rail, N/m^2."
    )
    shear_stiffness: Annotated[float, Quantity("force", Range(0.0, 1e10), "666875 N")] = Field(
        description="Stiffness of the shear layer, N; 0 N leaves a Winkler foundation."
    )
    damping: Annotated[float, Quantity("damping_per_length", Range(0.0, 1e9), "4.9e3 N s/m^2")] = Field(
        description="Vertical damping per length of rail, N s/m^2."
    )
    shear_damping: Annotated[float, Quantity("shear_damping", Range(0.0, 1e9), "1.0e3 N s")] = Field(
        description="Damping of the shear layer, N s."
    )


class Domain(Part):
    """The stretch of rail that moves with the wagon."""

    length: Annotated[float | None, Quantity("length", Range(5.0, 1000.0), "50 m")] = Field(
        default=None,
        description="Length of the stretch; the rail does not deflect at its ends, m. "
        "Default: as long as this track needs to change the deflection under the wheels by less than 1e-6.",
    )
    element_length: Annotated[float | None, Quantity("length", Range(0.01, 5.0), "0.5 m")] = Field(
        default=None,
        description="Length of a beam element aimed at (the mesh is fitted to the wheels), m. "
        "Default: 0.4 of the length in which a load's deflection fades, (4 EI/k)^(1/4), at most half the wheelbase.",
    )


class Track(Part):
    """The track under one rail."""

    model: Annotated[str, Choice(("moving-element", "rigid"))] = Field(
        default="moving-element",
        description="moving-element: the rail moves in finite elements; rigid: each wheel stands on the rail's static "
        "stiffness, for long trains.",
    )
    rail: Rail = Field(description="The rail.")
    foundation: Foundation = Field(description="What the rail lies on.")
    domain: Domain = Field(default=Domain.model_construct(), description="How much of it is computed, and how finely.")
    gradient: Annotated[float | tuple[tuple[float, float], ...], GRADIENT] = Field(
        default=0.0,
        description="Rise per length of track, uphill in the direction of travel positive; or points [position, "
        "gradient], linear between them and constant beyond.",
    )
    unevenness: Unevenness | None = Field(
        default=None, description="How the unloaded rail deviates from a straight line. Default: not at all."
    )

    @property
    def gradient_points(self) -> tuple[tuple[float, float], ...]:
        """Positions (m) and gradients, linear between them and constant beyond."""
        return ((0.0, self.gradient),) if isinstance(self.gradient, float) else self.gradient


_FRICTION: Final = Number(Range(0.005, 1.5), "0.55")


def _slip_below_area(v: Values) -> Iterator[Finding]:
    if v.has("kA", "kS") and v["kS"] > v["kA"]:
        most = at_most(v["kA"])
        fix = f"write `{most}` or less, or exchange kA and kS"
        yield Finding(("kS",), f"must be at most kA, {most}", f"`{shown(v['kS'])}`", fix)


class Adhesion(Part):
    """Parameters of Polach's creep force law, mu = mu0 ((1 - A) exp(-B v) + A)."""

    rules = (_slip_below_area,)

    mu0: Annotated[float, _FRICTION] = Field(description="Coefficient of friction at zero slip velocity.")
    A: Annotated[float, Number(Range(0.0, 1.0), "0.4")] = Field(
        description="Friction at infinite slip velocity, as a fraction of mu0."
    )
    B: Annotated[float, Quantity("inverse_speed", Range(0.0, 100.0), "0.6 s/m")] = Field(
        description="Rate at which friction falls with slip velocity, s/m."
    )
    kA: Annotated[float, Number(Range(0.001, 1.0), "1.0")] = Field(  # noqa: N815 - the symbol of the law
        description="Reduction factor in the area of adhesion."
    )
    kS: Annotated[float, Number(Range(0.001, 1.0), "0.4")] = Field(  # noqa: N815 - the symbol of the law
        description="Reduction factor in the area of slip; at most kA."
    )


ADHESIONS: dict[str, Adhesion] = {
    "dry": Adhesion.model_construct(mu0=0.55, A=0.40, B=0.60, kA=1.00, kS=0.40),
    "wet": Adhesion.model_construct(mu0=0.30, A=0.40, B=0.20, kA=0.30, kS=0.10),
}
"""Polach's sets for dry and wet rail (Wear 258, 2005)."""


def coulomb_adhesion(coefficient: float) -> Adhesion:
    """Plain Coulomb friction with a constant `coefficient`, in the parameters of Polach's law.

    A = 1 and B = 0 keep mu at the coefficient whatever the slip, and equal reduction factors of 1 give the
    steepest start. Then `f = mu N (2/pi) (eps / (1 + eps^2) + atan(eps))` rises with the slip and never exceeds
    mu N; what is missing is `mu N 4 / (3 pi eps^3)` for large eps. On a locked steel wheel of 0.3 to 0.6 m under 20
    to 110 kN, where eps is 85 to 190 over mu, that is 3e-6 of mu N at most for mu = 1.5 and 3e-9 for 0.15.
    """
    return Adhesion.model_construct(mu0=coefficient, A=1.0, B=0.0, kA=1.0, kS=1.0)


class Contact(Part):
    """The contact of wheel and rail."""

    youngs_modulus: Annotated[float, Quantity("modulus", Range(1e9, 1e13), "210 GPa")] = Field(
        description="Young's modulus of wheel and rail, Pa."
    )
    poisson_ratio: Annotated[float, Number(Range(0.0, 0.5, below=True), "0.3")] = Field(
        description="Poisson's ratio of wheel and rail."
    )
    rail_crown_radius: Annotated[float, Quantity("length", Range(0.01, 20.0), "0.3 m")] = Field(
        description="Radius of the rail head across the track, m."
    )
    kalker_c11: Annotated[float, Number(Range(0.1, 100.0), "4.12")] = Field(
        description="Kalker's longitudinal creep coefficient."
    )
    adhesion: Annotated[
        Adhesion,
        Short(ADHESIONS, _FRICTION, coulomb_adhesion, "a coefficient of friction from 0.005 to 1.5", "0.15"),
    ] = Field(description="`dry`, `wet`, a coefficient of plain Coulomb friction, or Polach's parameters in a mapping.")
    stiffness: Annotated[float | None, Quantity("contact_stiffness", Range(1e7, 1e15), "9.4e10 N/m^1.5")] = Field(
        default=None,
        description="Hertzian contact stiffness of one wheel, N/m^1.5, instead of the computed one.",
    )


SMALLEST_TOLERANCE = 1e-8
"""Below it rounding rules."""


class Solver(Part):
    """Accuracy and patience."""

    tolerance: Annotated[float, Number(Range(SMALLEST_TOLERANCE, 1e-2), "1e-4")] = Field(
        default=1e-4, description="Relative error aimed at in the braking distance."
    )
    time_limit: Annotated[float, Quantity("time", Range(0.01, 1e5), "600 s")] = Field(
        default=600.0, description="A run that has not stopped by this time ends, s."
    )


class Output(Part):
    """What is written."""

    interval: Annotated[float, Quantity("time", Range(1e-4, 100.0), "10 ms")] = Field(
        default=0.01, description="Time between two rows of the history, s."
    )
