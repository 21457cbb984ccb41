"""The answers of a train's stop: of the train, of each vehicle, of each coupling."""

# ruff: noqa: N815  (units such as N keep their case in the names that files and scripts rely on)

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.results.answers import Answers, PerWheel, Place, Shown, Told, computed, derived
from slosh_cli.results.result import Status, liquid_is_in_range
from slosh_cli.results.validity import Check, warnings_of

if TYPE_CHECKING:
    import pandas as pd

    from slosh_cli.results.surface import WettedAreas
    from slosh_cli.scenario import Scenario
    from slosh_cli.scenario.train_file import TrainScenario

_TOLD = Shown.JSON | Shown.SUMMARY | Shown.HISTORY
_EVERYWHERE = ~Shown(0)
_FOR_SLACK = 5e-5
"""Tolerance from which on the largest forces of couplings with slack stay where they are, to a thousandth."""


class VehicleResult(Answers):
    """One vehicle of a train. `recorded` gives its histories by channel name, `wetted` is what a shallow-water liquid
    recorded along the tank."""

    # fmt: off
    name: str = derived("", "name of the vehicle's scenario", Place.NAME, given="name", shown=_TOLD)
    onset_s: float = derived(
        "s", "when the brake wave reaches the vehicle", Place.CONDITIONS, given="braking.onset", shown=_TOLD,
        needed=True)
    distance_m: float = computed("m", "way of the vehicle since its onset", Place.DISTANCE, shown=_TOLD, needed=True)
    liquid_model: str = derived(
        "", "model of the load: rigid, modal or shallow-water", Place.CONDITIONS, given="tank.liquid.model",
        shown=_TOLD, column="liquid", needed=True)
    max_surface_m: float = computed("m", "largest rise of the free surface at an end wall", Place.SURFACE, shown=_TOLD)
    surface_limit_m: float = computed("m", "room above the still surface", Place.SURFACE, shown=_TOLD)
    min_wheel_load_N: PerWheel = computed("N", "least load since the onset", Place.WHEELS, shown=_TOLD)
    max_wheel_load_N: PerWheel = computed("N", "largest load since the onset", Place.WHEELS, shown=_TOLD)
    static_wheel_load_N: PerWheel = computed("N", "load at rest", Place.WHEELS, shown=Shown.HISTORY)
    max_wheel_unloading: float = derived(
        "1", "largest 1 - N/N0 of any wheel", Place.WHEELS, shown=_TOLD,
        of=lambda one: max(1.0 - least / rest for least, rest in zip(
            one.min_wheel_load_N, one.static_wheel_load_N, strict=True)))
    locked_time_s: PerWheel = computed("s", "how long a wheel was locked", Place.WHEELS, shown=_TOLD)
    # fmt: on
    scenario: "Scenario"
    checks: tuple[Check, ...]
    recorded: Callable[[], dict[str, Vector]]
    wetted: "WettedAreas | None" = None

    def __post_init__(self) -> None:
        self._derive()

    @cached_property
    def channels(self) -> Mapping[str, Vector]:
        """Histories by the names of `slosh_cli.results.channels`."""
        return self.recorded()


class CouplingResult(Answers):
    """A coupling of a train; forces are those of the whole coupling, positive in compression. `force` (n,) N and
    `compression` (n,) m are its histories."""

    # fmt: off
    max_compression_N: float = computed("N", "largest compressive force", shown=_TOLD, needed=True)
    max_tension_N: float = computed("N", "largest tensile force", shown=_TOLD, needed=True)
    max_compression_m: float = computed("m", "largest compression", shown=_TOLD)
    max_tension_m: float = computed("m", "largest extension", shown=_TOLD)
    max_compression_s: float = computed("s", "when the compressive force was largest", shown=~Shown.JSON)
    max_tension_s: float = computed("s", "when the tensile force was largest", shown=~Shown.JSON)
    energy_taken_J: float = computed("J", "work that the coupling took, integral of force and rate", shown=_TOLD)
    # fmt: on
    force: Vector
    compression: Vector


class TrainResult(Answers):
    """The stop of a train. `time` (n,) s is that of all histories."""

    # fmt: off
    name: str = derived("", "name of the train", Place.NAME, given="name", shown=_TOLD, needed=True)
    status: Status = computed(
        "", "how the run ended", Place.STATUS, shown=_EVERYWHERE, needed=True, line=Told(1, "status"))
    braking_distance_m: float | None = computed(
        "m", "way of the first vehicle from its onset to the train's stop", Place.DISTANCE, shown=_EVERYWHERE,
        needed=True, line=Told(2, "braking distance of the first vehicle", ".2f", "m"))
    braking_time_s: float | None = computed(
        "s", "from the first vehicle's onset to the train's stop", Place.DISTANCE, shown=_EVERYWHERE,
        line=Told(3, "braking time", ".2f", "s"))
    initial_speed_m_s: float = derived(
        "m/s", "V0, the speed at t = 0", Place.CONDITIONS, given="file.braking.initial_speed", column="v0_km_h",
        per=1 / 3.6, shown=_EVERYWHERE)
    energy_residual: float = computed(
        "1", "what the energy ledger misses, largest over the run, relative to the initial kinetic energy",
        shown=_EVERYWHERE, line=Told(6, "energy ledger, largest residual", ".1e", "of the initial energy"))
    steps: int = computed("1", "accepted steps of the integrator", shown=_EVERYWHERE, line=Told(7, "steps"))
    rejected_steps: int = computed("1", "rejected steps of the integrator", shown=_EVERYWHERE)
    solve_seconds: float = computed(
        "s", "time spent in the solver", shown=_TOLD, line=Told(8, "solver time", ".2f", "s"))
    warnings: tuple[str, ...] = computed("", "what to know before the numbers are used", Place.WORDS, shown=_EVERYWHERE)
    vehicles: tuple[VehicleResult, ...] = computed("", "the vehicles from the front", shown=Shown.JSON)
    couplings: tuple[CouplingResult, ...] = computed("", "the couplings from the front", shown=Shown.JSON)
    max_compression_N: float = derived(
        "N", "largest compressive force of any coupling", shown=_EVERYWHERE,
        of=lambda train: max((one.max_compression_N for one in train.couplings), default=0.0),
        line=Told(4, "compression in the train, largest", ".1f", "kN", per=1e3))
    max_tension_N: float = derived(
        "N", "largest tensile force of any coupling", shown=_EVERYWHERE,
        of=lambda train: max((one.max_tension_N for one in train.couplings), default=0.0),
        line=Told(5, "tension in the train, largest", ".1f", "kN", per=1e3))
    compression_at: int = derived(
        "1", "coupling with the largest compressive force, counted from the front", shown=~Shown.JSON,
        of=lambda train: _place_of(train.couplings, "max_compression_N"))
    tension_at: int = derived(
        "1", "coupling with the largest tensile force, counted from the front", shown=~Shown.JSON,
        of=lambda train: _place_of(train.couplings, "max_tension_N"))
    max_compression_s: float | None = derived(
        "s", "when the largest compressive force of any coupling acts", shown=~Shown.JSON,
        of=lambda train: train.couplings[train.compression_at - 1].max_compression_s if train.couplings else None)
    max_tension_s: float | None = derived(
        "s", "when the largest tensile force of any coupling acts", shown=~Shown.JSON,
        of=lambda train: train.couplings[train.tension_at - 1].max_tension_s if train.couplings else None)
    max_wheel_unloading: float = derived(
        "1", "largest 1 - N/N0 of any wheel of any vehicle", Place.WHEELS, shown=~Shown.JSON,
        of=lambda train: max(one.max_wheel_unloading for one in train.vehicles))
    longest_lock_s: float = derived(
        "s", "how long the wheel was locked that was so longest", Place.WHEELS, shown=~Shown.JSON,
        of=lambda train: max(max(one.locked_time_s) for one in train.vehicles))
    liquid_in_range: bool = derived(
        "", "whether every tank stayed in the range of its liquid's model", Place.RANGE, shown=Shown.STUDY,
        of=lambda train: all(liquid_is_in_range(one) for one in train.vehicles))
    reason: str = computed("", "why the train did not stop", Place.WORDS, shown=~Shown.JSON)
    # fmt: on
    scenario: "TrainScenario"
    time: Vector

    def __post_init__(self) -> None:
        self._derive()

    def summary(self) -> dict[str, Any]:
        """The answer in plain Python values, with the keys of `slosh run --json` but for `files`."""
        found = self.as_dict()
        return found | {"warnings": [*found["warnings"], *([self.reason] if self.reason else [])]}

    @property
    def history(self) -> "TrainHistory":
        """What figures show of the train."""
        couplings = ({"force": one.force, "compression": one.compression} for one in self.couplings)
        return TrainHistory(
            self.name,
            self.time,
            tuple(StoredPart(one.as_attributes(), one.channels) for one in self.vehicles),
            tuple(StoredPart(one.as_attributes(), found) for one, found in zip(self.couplings, couplings, strict=True)),
            self.as_attributes(),
        )

    def to_frame(self) -> "pd.DataFrame":
        """Answers of the vehicles, one row each, counted from 1 at the front."""
        import pandas as pd

        rows = [one.row(Shown.SUMMARY) for one in self.vehicles]
        return pd.DataFrame(rows, index=pd.RangeIndex(1, len(rows) + 1, name="vehicle"))

    def forces(self) -> "pd.DataFrame":
        """Forces (N) of the couplings over time, one column each, counted from 1 at the front."""
        import pandas as pd

        found = {number: one.force for number, one in enumerate(self.couplings, 1)}
        return pd.DataFrame(found, index=pd.Index(self.time, name="time"))


def _place_of(couplings: Sequence[CouplingResult], answer: str) -> int:
    """The coupling with the largest answer, counted from the front; 0 without any."""
    numbered = enumerate(couplings, 1)
    return max(numbered, key=lambda one: float(getattr(one[1], answer)), default=(0, None))[0]


@dataclass(frozen=True, eq=False)
class StoredPart:
    """A vehicle or a coupling of a train as its file has it: answers by name, histories by channel name."""

    facts: Mapping[str, Any]
    channels: Mapping[str, Vector]


@dataclass(frozen=True, eq=False)
class TrainHistory:
    """A train's run as its file has it: name, `time` (n,) s, vehicles and couplings from the front, `facts` by name.

    `scenario_text` has the train's own file first; figures do without it.
    """

    name: str
    time: Vector
    vehicles: tuple[StoredPart, ...]
    couplings: tuple[StoredPart, ...]
    facts: Mapping[str, Any] = field(default_factory=dict)
    scenario_text: str = ""

    @property
    def status(self) -> Status:
        """How the run ended."""
        return Status(self.facts["status"])


def gathered(verdicts: Sequence[Sequence[Check]]) -> tuple[str, ...]:
    """Warnings of all vehicles: one for each check, of the vehicle that is furthest beyond its limit."""
    found: dict[str, list[tuple[float, int, str]]] = {}
    for number, checks in enumerate(verdicts, 1):
        for check in checks:
            for meaning in warnings_of([check]):
                over = check.value / check.limit if check.limit else np.inf
                found.setdefault(check.name, []).append((over, number, meaning))
    told = []
    for cases in found.values():
        _, number, meaning = max(cases, key=lambda case: case[0])  # the first of several alike
        others = f" (and {len(cases) - 1} more)" if len(cases) > 1 else ""
        told.append(f"vehicle {number}{others}: {meaning}")
    return tuple(told)


def slack_warnings(train: "TrainScenario") -> tuple[str, ...]:
    """What a tolerance that is coarse for couplings with slack leaves open."""
    coupling, tolerance = train.file.coupling, train.vehicles[0].solver.tolerance
    springs = [spring for spring in (coupling.compression, coupling.tension) if spring is not None]
    slack = any(spring.loading[1][1] == 0.0 for spring in springs)
    if not slack or tolerance <= _FOR_SLACK or len(train.vehicles) < 2:
        return ()
    return (
        f"The couplings have slack, and solver.tolerance is {tolerance:g}: where vehicles run into each other, forces "
        "of single couplings may err by a hundredth, small ones by more. Write `solver: {tolerance: 5.0e-5}`.",
    )
