"""What a stop really depends on: `slosh check --sensitivity` and scripts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping, by_kind
from slosh_cli.application.plotting import writers
from slosh_cli.errors import UsageError
from slosh_cli.report import FORMATS
from slosh_cli.scenario import Scenario, load_scenario
from slosh_cli.study.sensitivity import DISTANCE, LOCK, SMALL, UNLOADING, Effect, effects

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STEM: Final = "sensitivity"


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity:
    """What a stop depends on. `base` is its own row of a study's table, `effects` one per value, the largest first."""

    scenario: Scenario
    base: Mapping[str, Any]
    effects: tuple[Effect, ...]

    def __repr__(self) -> str:
        told = ", ".join(one.doubt.key for one in self.mattering[:5])
        return f"Sensitivity({self.scenario.name}: {told or 'nothing matters'})"

    @property
    def mattering(self) -> list[Effect]:
        """The effects of what matters."""
        return [one for one in self.effects if one.matters(self.base)]

    def rows(self) -> list[dict[str, Any]]:
        """A row for each value: its ends, what the stop comes to there, whether it matters; SI units."""
        found = []
        for effect in self.effects:
            doubt = effect.doubt
            row: dict[str, Any] = {
                "key": doubt.key, "standing": doubt.standing, "value": doubt.own, "low": doubt.low, "high": doubt.high,
                "matters": effect.matters(self.base), "reason": doubt.reason, "refusal": effect.refusal,
            }  # fmt: skip
            for side, told in zip(("low", "high"), effect.rows, strict=True):
                row |= {f"{name}_{side}": (told or {}).get(name) for name in ("status", DISTANCE, UNLOADING, LOCK)}
            found.append(row)
        return found

    def as_dict(self) -> dict[str, Any]:
        """Plain values, with the keys of `slosh check --sensitivity --json` but for `files`."""
        base = {name: self.base.get(name) for name in ("status", "reason", DISTANCE, UNLOADING, LOCK)}
        return {"base": base, "small": dict(SMALL), "values": self.rows()}

    def figures(self) -> dict[str, Callable[[], Figure]]:
        """What draws the tornado chart."""

        def draw() -> Figure:
            from slosh_cli.report.tornado import tornado

            return tornado(self)

        return {_STEM: draw}


def sensitivity(
    scenario: Scenario | str | Path, *, threads: int | None = None,
    progress: Callable[[int, int], None] = lambda *_: None, cancel: Event | None = None,
) -> Sensitivity:  # fmt: skip
    """Every value that is not certain up and down by its plausible range, one at a time, on the model itself.

    Raises ScenarioError for a file that cannot be used, UsageError where the stop itself comes to no answer.
    """
    stop = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    base, found = effects(stop, threads, progress, cancel or Event())
    if base.get(DISTANCE) is None:
        rule = f"must come to a standstill for its sensitivity; it ended with {base['status']}: {base.get('reason')}"
        raise UsageError(f"{stop.name} {rule}", stop.name)
    return Sensitivity(stop, base, tuple(found))


def keep_sensitivity(found: Sensitivity, folder: Path, keeping: Keeping) -> dict[str, Any]:
    """Write table and tornado chart into `folder`; returns where those lie that could be."""
    from slosh_cli.results.tables import write_rows

    rows: Sequence[Mapping[str, Any]] = found.rows()
    table = f"{_STEM}.csv"
    owned = [table, *(f"{_STEM}.{suffix}" for suffix in FORMATS)]
    wanted = {table: partial(write_rows, list(rows[0]) if rows else ["key"], rows)}
    return by_kind(keeping.keep(folder, owned, wanted, writers(found.figures())), table=table)
