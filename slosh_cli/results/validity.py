"""Is an answer inside the range of its own model? The verdicts that go with every result.

A verdict belongs to what it speaks of, so that every command that has the number has the verdict: of a liquid and its
tank in `liquid_range`, of a wagon and its track in `wagon_range`, of a whole run here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from slosh_cli.scenario.schema_limits import Limits

_LEDGER_LIMIT = 1e-3
"""An energy residual above this part of the initial kinetic energy is worth a warning."""
_ROUNDING = 1e-9
"""Part of a limit that a value may exceed it by: 90 t on four axles are 22.5 t, whatever the last digit."""
_DERAILMENT = "EN 14363, quasi-static safety against derailment on twisted track"
PITCH_CHECK = "pitch beyond small angles"


@dataclass(frozen=True)
class Check:
    """One verdict: `value` beside `limit`, and what it means where it is exceeded.

    `kind` is "model" where the equations themselves end, "accuracy" for the integration, "operation" for what railways
    limit or have to deal with, "input" for a value that is probably not what was meant. `standing` says how firm the
    limit is: of a standard for this very case ("standard"), of one for another case ("indicative"), or of nobody but
    this tool or the scenario ("assumed"); `source` is where it stands. Both are empty where the limit is no rule of
    railways.
    """

    name: str
    kind: Literal["model", "accuracy", "operation", "input"]
    value: float
    limit: float
    meaning: str
    standing: Literal["standard", "indicative", "assumed", ""] = ""
    source: str = ""

    @property
    def within(self) -> bool:
        """True when the value does not exceed the limit by more than rounding."""
        return self.value <= self.limit * (1.0 + _ROUNDING)

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON and HDF5."""
        verdict = {"check": self.name, "kind": self.kind, "value": self.value, "limit": self.limit}
        return verdict | {"within": self.within, "standing": self.standing, "source": self.source}


@dataclass(frozen=True)
class Extent:
    """What the verdicts on a run as a whole look at.

    Largest wheel unloading, wheel lift-offs, whether the run ended at the limit of small angles, largest ledger
    residual and what to do about it, the limit of the unloading.
    """

    unloading: float
    lifts: int
    pitched: bool
    residual: float
    residual_cause: str
    unloading_limit: float


def checks(extent: Extent) -> tuple[Check, ...]:
    """All verdicts on a run as a whole."""
    return tuple(_checks(extent))


def _checks(x: Extent) -> Iterator[Check]:
    yield Check(
        "wheels lifted off",
        "model",
        float(x.lifts),
        0.0,
        "Wheels lifted off the rail: after a landing the largest wheel load of an undamped contact does not converge; "
        "use the braking distance, not max_wheel_load_N.",
    )
    yield Check(
        PITCH_CHECK,
        "model",
        float(x.pitched),
        0.0,
        "A pitch angle passed 0.1 rad; small-angle kinematics say nothing beyond, and the run ended there.",
    )
    yield Check(
        "energy ledger residual",
        "accuracy",
        x.residual,
        _LEDGER_LIMIT,
        f"The energy ledger misses {x.residual:.1e} of the initial kinetic energy: {x.residual_cause}.",
    )
    limits, usual = Limits(unloading=x.unloading_limit), Limits()
    standing, source = limits.standing_of(("unloading",), "indicative", _DERAILMENT)
    yield Check(
        "wheel unloading",
        "operation",
        x.unloading,
        x.unloading_limit,
        f"The largest wheel unloading is {x.unloading:.2f} of the static load; the limit is {x.unloading_limit:g}. "
        f"EN 14363 has {usual.unloading:g} for quasi-static runs on twisted track, which is only indicative here.",
        standing,
        source,
    )


def warnings_of(verdicts: Sequence[Check]) -> list[str]:
    """What to tell about the verdicts that are not within their limits; the end at large pitch is the run's reason."""
    return [check.meaning for check in verdicts if not check.within and check.name != PITCH_CHECK]


def plain_checks(verdicts: Sequence[Check]) -> list[dict[str, object]]:
    """The verdicts as JSON and HDF5 have them."""
    return [check.as_dict() for check in verdicts]
