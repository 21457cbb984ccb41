"""The tank alone under a prescribed deceleration: what the liquid does, and the files."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping, by_kind
from slosh_cli.application.plotting import writers
from slosh_cli.application.prescription import Amount, Prescription
from slosh_cli.errors import UsageError
from slosh_cli.report import FORMATS
from slosh_cli.results.validity import Check, plain_checks, warnings_of
from slosh_cli.scenario import Scenario, TankScenario, load_any_scenario

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from slosh_cli.application.plotting import Figures
    from slosh_cli.arrays import Array, Vector
    from slosh_cli.results.channels import Channel
    from slosh_cli.results.recommendation import Recommendation
    from slosh_cli.solver.excite import Excitation

_TABLE: Final = "excite.csv"
_HISTORY: Final = "excite.h5"
EXCITATION_FILES: Final = (_HISTORY, _TABLE, *(f"excite.{suffix}" for suffix in FORMATS))
"""Every file that an excitation may write, its history first."""


@dataclass(frozen=True, eq=False, repr=False)
class ExcitationResult:
    """What the liquid of a scenario's tank did to it; `histories` hold forces, moments and levels over time.

    checks, recommendation: whether the liquid's model held, and which one suits; None for a load that is frozen on
    purpose. settings: what was prescribed, as text.
    """

    scenario: Scenario | TankScenario
    histories: Excitation
    checks: tuple[Check, ...]
    recommendation: Recommendation | None
    settings: str

    def __repr__(self) -> str:
        return f"ExcitationResult({self.conditions})"

    @property
    def reason(self) -> str:
        """Why the history ends early; empty when it does not."""
        return self.histories.reason

    @property
    def warnings(self) -> list[str]:
        """What to know before believing it."""
        return warnings_of(self.checks)

    @property
    def room(self) -> float:
        """Height of the roof over the still surface, m."""
        return self.scenario.tank.height * (1.0 - self.scenario.tank.fill)

    @property
    def conditions(self) -> str:
        """Tank, liquid and largest deceleration in one line."""
        from slosh_cli.solver.excite import extreme

        tank = self.scenario.tank
        return (
            f"{self.scenario.name}: {tank.shape}, {tank.length:g} m long, {100.0 * tank.fill:g} % full, "
            f"liquid: {tank.liquid.model}, up to {extreme(self.histories.deceleration):.4g} m/s²"
        )

    def summary(self) -> dict[str, Any]:
        """The answer in plain Python values, with the keys of `slosh tank excite --json` but for `files`.

        `max_...` is the extreme of the magnitude, in either direction.
        """
        from slosh_cli.solver.excite import extreme

        found = self.histories
        return {
            "name": self.scenario.name,
            "liquid_model": self.scenario.tank.liquid.model,
            "max_normalised_force": extreme(found.normalised_force),
            "min_normalised_force": float(found.normalised_force.min()),
            "max_surface_m": found.max_surface,
            "surface_limit_m": self.room,
            "max_moment_N_m": extreme(found.moment),
            "liquid_mass_kg": found.mass,
            "mass_error": found.mass_error,
            "accuracy": found.accuracy,
            "reason": found.reason,
            "checks": plain_checks(self.checks),
            "recommendation": self.recommendation.as_dict() if self.recommendation else None,
            "warnings": self.warnings,
        }

    def to_frame(self) -> pd.DataFrame:
        """The histories as a DataFrame: index `time_s`, the unit in the column names."""
        import pandas as pd

        columns = {name: values for name, (_, values) in _columns(self.histories).items()}
        return pd.DataFrame(columns, index=pd.Index(self.histories.time, name="time_s"))

    def figures(self) -> Figures:
        """What draws deceleration, force, moment and levels over time."""

        def draw() -> Figure:
            from slosh_cli.report.tank_figures import Heading, excitation_figure

            heading = Heading("Tank under deceleration", self.conditions, self.warnings)
            return excitation_figure(self.histories, heading, self.room)

        return {"excite": draw} if self.histories.time.size > 1 else {}

    def keep(self, folder: Path, keeping: Keeping) -> dict[str, Any]:
        """Write table and history into `folder`, then the figure; returns where those lie that could be written."""
        from slosh_cli.results.channels import Channel
        from slosh_cli.results.hdf5 import write_excitation
        from slosh_cli.results.tables import write_table

        found, columns = self.histories, _columns(self.histories)
        values = zip(found.time, *(column for _, column in columns.values()), strict=True)
        rows = [dict(zip(("time_s", *columns), map(float, row), strict=True)) for row in values]
        channels = {Channel("deceleration", "m/s^2", "prescribed deceleration of the tank"): found.deceleration}
        channels |= dict(columns.values())
        shift = Channel("liquid_shift", "m", "shift of the liquid's centre of mass in the tank, positive forward")
        channels[shift] = found.watched.shift
        numbers: Mapping[str, Callable[[Path], object]] = {
            _TABLE: lambda path: write_table(rows, path),
            _HISTORY: lambda path: write_excitation(
                self.scenario, found.time, channels, self._facts(), path, _profiles(found)
            ),
        }
        files = keeping.keep(folder, EXCITATION_FILES, numbers, writers(self.figures()))
        return by_kind(files, table=_TABLE, history=_HISTORY)

    def _facts(self) -> dict[str, Any]:
        """The attributes of the history file."""
        facts = self.summary()
        return facts | {
            "settings": self.settings,
            "warnings": "\n".join(facts["warnings"]),
            "checks": json.dumps(facts["checks"]),
            "recommendation": (facts["recommendation"] or {}).get("sentence", ""),
        }


def excite(
    scenario: Scenario | TankScenario | str | Path,
    deceleration: Amount | None = None,
    ramp: Amount | None = None,
    duration: Amount = "40 s",
    *,
    table: str | Path | None = None,
    interval: Amount = "10 ms",
    motion: str | Path | None = None,
    start: str | None = None,
    probes: Sequence[Amount] = (),
) -> ExcitationResult:
    """Decelerate the tank of a scenario, of a stop or of a tank alone, or of its file, without pitching it.

    The deceleration is reached linearly within `ramp` (at once without one), then held; or it follows `table`, a CSV
    file with the columns time_s and deceleration_m_s2; or from `motion`, one with time_s and displacement_m,
    velocity_m_s or acceleration_m_s2, positive forward. At the `start` of a motion the liquid is at ``"rest"`` (the
    default), so that a first speed comes as a blow, or ``"moving"`` with the tank. `probes` are distances from the rear
    wall at which the surface is told. A liquid that its model cannot follow to the end is a result
    too: see its reason. Raises ScenarioError and UsageError for what cannot be used, TankError where slosh
    coefficients cannot be computed.
    """
    found = load_any_scenario(scenario) if isinstance(scenario, str | Path) else scenario
    file, moved = (None if path is None else Path(path) for path in (table, motion))
    asked = Prescription.read(
        deceleration, ramp, duration, file, interval, motion=moved, start=start, probes=tuple(probes)
    )
    return excited(asked, found)


def excited(prescription: Prescription, scenario: Scenario | TankScenario) -> ExcitationResult:
    """What the liquid does under a prescription.

    Raises TankError where slosh coefficients cannot be computed, UsageError for a probe outside the tank.
    """
    from slosh_cli.solver.excite import excite as integrated

    length = scenario.tank.length
    for place in prescription.probes:
        if not 0.0 <= place <= length:
            rule = f"a probe must lie between the rear wall (0 m) and the front wall ({length:g} m)"
            raise UsageError(f"{rule}; given {place:g} m", "probe")
    asked = prescription
    found = integrated(scenario.tank, asked.deceleration, asked.duration, asked.interval, asked.probes)
    checks, advice = _verdicts(scenario, found) if found.time.size > 1 else ((), None)
    return ExcitationResult(scenario, found, checks, advice, prescription.settings)


def _verdicts(scenario: Scenario | TankScenario, found: Excitation) -> tuple[tuple[Check, ...], Recommendation | None]:
    """Whether the liquid stayed in the range of its model, and which model suits tank and deceleration."""
    from slosh_cli.results.liquid_range import Motion, motion_checks, tank_checks
    from slosh_cli.results.recommendation import recommend
    from slosh_cli.tank.roof import NEARLY_FULL

    tank = scenario.tank
    if tank.liquid.model == "rigid":
        return (), None
    advice = recommend(tank, found.largest_deceleration)
    shift = float(abs(found.watched.shift).max())
    slot_alone = scenario.tank.fill < NEARLY_FULL
    motion = Motion(abs(found.max_surface), found.largest_head, slot_alone=slot_alone, shift=shift)
    return (*tank_checks(tank, advice.sentence), *motion_checks(tank, motion, advice.sentence)), advice


def _columns(found: Excitation) -> dict[str, tuple[Channel, Vector]]:
    """Column of the table -> channel of the history and its values."""
    from slosh_cli.results.channels import CHANNELS, Channel

    columns = {
        "force_N": (CHANNELS["liquid_force"], found.force),
        "moment_N_m": (CHANNELS["liquid_moment"], found.moment),
        "surface_front_m": (CHANNELS["surface_front"], found.surface_front),
        "surface_rear_m": (CHANNELS["surface_rear"], found.surface_rear),
    }
    for place, rises in zip(found.watched.probe_places, found.watched.probes.T, strict=True):
        name = f"surface_at_{place:.6g}"
        columns[f"{name}_m"] = (Channel(name, "m", f"free-surface rise {place:.6g} m from the rear end wall"), rises)
    return columns


def _profiles(found: Excitation) -> Mapping[Channel, Array]:
    """The surface along the tank: its times, its places and its rises (times, places), as they stand in the history."""
    from slosh_cli.results.channels import Channel

    watched = found.watched
    return {
        Channel("profile_time", "s", "times of the profiles of the surface"): watched.profile_times,
        Channel("profile_place", "m", "places of the profiles, from the rear end wall"): watched.places,
        Channel("profile_rise", "m", "free-surface rise, by time and place"): watched.profiles,
    }
