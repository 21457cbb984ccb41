"""Is a run inside the range of its own model? The verdicts that go with every result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

UNLOADING_LIMIT = 0.6
"""Usual limit of the wheel unloading dQ/Q0: EN 14363, assessment of safety against derailment on twisted track."""
FREQUENCY_LIMIT = 0.05
"""Shallow water is used where its first frequency is this close to potential flow's."""
LEDGER_LIMIT = 1e-3
"""An energy residual above this part of the initial kinetic energy is worth a warning."""


@dataclass(frozen=True)
class Check:
    """One verdict: `value` beside `limit`, and what it means where it is exceeded.

    `kind` is "model" where the equations themselves end, "accuracy" for the integration, "operation" for a limit that
    railways set themselves.
    """

    name: str
    kind: Literal["model", "accuracy", "operation"]
    value: float
    limit: float
    meaning: str

    @property
    def within(self) -> bool:
        """True when the value does not exceed the limit."""
        return self.value <= self.limit

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON and HDF5."""
        return {"check": self.name, "kind": self.kind, "value": self.value, "limit": self.limit, "within": self.within}


@dataclass(frozen=True)
class Extent:
    """What the verdicts look at: surface rise, room above and depth below the still surface (m), how much too high the
    first frequency of shallow water is, its largest head of pressure under the roof (m), largest wheel unloading, wheel
    lift-offs, largest ledger residual."""

    liquid_model: str
    rise: float
    room: float
    depth: float
    frequency_excess: float
    head: float
    unloading: float
    lifts: int
    pitch_limit: bool
    residual: float


def checks(extent: Extent) -> tuple[Check, ...]:
    """All verdicts on a run."""
    return tuple(_checks(extent))


def _checks(x: Extent) -> Iterator[Check]:
    if x.liquid_model == "modal":
        yield Check(
            "surface rise over the room above and below",
            "model",
            x.rise / min(x.room, x.depth),
            1.0,
            f"The surface moves by {x.rise:.2f} m at the end walls, but there is {x.room:.2f} m of room above it and "
            f"{x.depth:.2f} m of liquid below: this stop lies outside the linear theory of the modal liquid, which "
            "then overstates the shift of weight. Compare with tank.liquid.model: shallow-water.",
        )
    if x.liquid_model == "shallow-water":
        yield Check(
            "excess of the first slosh frequency",
            "model",
            x.frequency_excess,
            FREQUENCY_LIMIT,
            f"Shallow water overstates the first slosh frequency of this tank by {x.frequency_excess:.1%}: it is too "
            "deep for its length. Compare with tank.liquid.model: modal at small surface rise.",
        )
        yield Check(
            "head of pressure under the roof",
            "accuracy",
            x.head,
            0.0,
            f"The liquid struck the roof (head up to {x.head:.1f} m): peak forces and wheel loads depend on "
            "tank.liquid.slot_speed there; the braking distance hardly does.",
        )
    yield Check(
        "wheels lifted off",
        "model",
        float(x.lifts),
        0.0,
        "Wheels lifted off the rail: after a landing the largest wheel load of an undamped contact does not converge; "
        "use the braking distance, not max_wheel_load_N.",
    )
    yield Check(
        "pitch beyond small angles",
        "model",
        float(x.pitch_limit),
        0.0,
        "A pitch angle passed 0.1 rad; small-angle kinematics say nothing beyond, and the run ended there.",
    )
    yield Check(
        "energy ledger residual",
        "accuracy",
        x.residual,
        LEDGER_LIMIT,
        f"The energy ledger misses {x.residual:.1e} of the initial kinetic energy: lower solver.tolerance or refine "
        "track.domain.element_length.",
    )
    yield Check(
        "wheel unloading",
        "operation",
        x.unloading,
        UNLOADING_LIMIT,
        f"The largest wheel unloading is {x.unloading:.2f} of the static load; the usual limit is {UNLOADING_LIMIT} "
        "(EN 14363).",
    )


def warnings_of(verdicts: Sequence[Check]) -> list[str]:
    """What to tell about the verdicts that are not within their limits; the pitch limit is told by the run's reason."""
    return [check.meaning for check in verdicts if not check.within and check.name != "pitch beyond small angles"]
