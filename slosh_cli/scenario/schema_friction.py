"""What presses and rubs in a brake, and the laws of its friction (theory section 12).

A class of a friction law gives `friction(speed, force)`: the coefficient and its derivative by the speed (h/km), of a
speed in km/h and a force in kN.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Final, Literal, TypeAlias

from pydantic import Field

from slosh_cli.friction import cast_iron, composite
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Count, Number, Quantity, Range
from slosh_cli.scenario.points import NumberOrPoints, Points
from slosh_cli.scenario.short import Short

KM_H: Final = 3.6
"""A metre per second in km/h."""
_COEFFICIENT: Final = Number(Range(0.005, 1.5), "0.15")
_BY_SPEED: Final = Points(
    Quantity("speed", Range(0.0, 200.0), "100 km/h"), _COEFFICIENT, "[[0 km/h, 0.32], [100 km/h, 0.25]]"
)


class _CastIron(Part):
    """Cast-iron blocks, whose friction triples towards the stop."""

    law: Literal["cast-iron"] = Field(default="cast-iron", description="Friction law: cast-iron blocks, Karwatzki.")

    def friction(self, speed: float, force: float) -> tuple[float, float]:
        """Karwatzki's law of cast iron."""
        return cast_iron(speed, force)


class _Composite(Part):
    """Composite blocks (K)."""

    law: Literal["composite"] = Field(default="composite", description="Friction law: composite blocks, Karwatzki.")

    def friction(self, speed: float, force: float) -> tuple[float, float]:
        """Karwatzki's law of composite blocks."""
        return composite(speed, force)


class FrictionTable(Part):
    """Friction by speed; of one point, the same at every speed."""

    law: Literal["table"] = Field(default="table", description="Friction law: points of speed and coefficient.")
    points: Annotated[tuple[tuple[float, float], ...], _BY_SPEED] = Field(
        description="Points [speed, coefficient]; straight lines between them, constant beyond."
    )

    def friction(self, speed: float, force: float) -> tuple[float, float]:  # noqa: ARG002 - of other laws
        """The straight line of the table's points at a speed."""
        for (v0, mu0), (v1, mu1) in pairwise((v * KM_H, mu) for v, mu in self.points):
            if v0 <= speed < v1:
                slope = (mu1 - mu0) / (v1 - v0)
                return mu0 + slope * (speed - v0), slope
        return self.points[0 if speed < self.points[0][0] * KM_H else -1][1], 0.0


def _by_speed(value: float | tuple[tuple[float, float], ...]) -> FrictionTable:
    return FrictionTable.model_construct(points=((0.0, value),) if isinstance(value, float) else value)


_FrictionLaw: TypeAlias = Annotated[
    Annotated[_CastIron | _Composite | FrictionTable, Field(discriminator="law")],
    Short(
        {"cast-iron": _CastIron.model_construct(), "composite": _Composite.model_construct()},
        NumberOrPoints(_COEFFICIENT, _BY_SPEED),
        _by_speed,
        "a coefficient of friction from 0.005 to 1.5, a list of points [speed, coefficient]",
        "0.15",
    ),
]


class Blocks(Part):
    """Brake blocks on the tread of each wheel."""

    count: Annotated[int, Count(1, 8)] = Field(description="Blocks on one wheel.")
    force: Annotated[float, Quantity("force", Range(1.0, 5e5), "25 kN")] = Field(
        description="Force of one block at full application, N."
    )
    friction: _FrictionLaw = Field(
        description="`cast-iron`, `composite`, a coefficient (LL block 0.15, K block 0.27), or points [speed, value]."
    )

    def arm(self, wheel_radius: float) -> float:
        """Where the friction acts, m from the axis: at the tread."""
        return wheel_radius


class Discs(Part):
    """Brake discs on each wheelset, its half for one wheel."""

    faces: Annotated[int, Count(1, 16)] = Field(
        description="Friction faces for one wheel: half of those of its wheelset."
    )
    force: Annotated[float, Quantity("force", Range(1.0, 5e5), "20 kN")] = Field(
        description="Clamping force of one disc, counted once for each of its faces, at full application, N."
    )
    radius: Annotated[float, Quantity("length", Range(0.02, 1.0), "0.247 m")] = Field(
        description="Mean radius of friction, m."
    )
    friction: _FrictionLaw = Field(
        description="A coefficient (pads 0.35), `cast-iron`, `composite`, or points [speed of the tread, value]."
    )

    @property
    def count(self) -> int:
        """Friction faces for one wheel."""
        return self.faces

    def arm(self, wheel_radius: float) -> float:  # noqa: ARG002 - blocks need it
        """Where the friction acts, m from the axis."""
        return self.radius
