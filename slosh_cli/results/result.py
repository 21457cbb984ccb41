"""The result of one stop, in memory."""

# ruff: noqa: N802, N815  (units such as N keep their case in the names that files and scripts rely on)

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from slosh_cli.results.channels import TIME, channel
from slosh_cli.results.validity import Check, plain

if TYPE_CHECKING:
    import pandas as pd

    from slosh_cli.results.recommendation import Recommendation
    from slosh_cli.scenario import Scenario

Vector = NDArray[np.float64]
PerWheel = tuple[float, float, float, float]


class Status(StrEnum):
    """How a run ended. Only `STOPPED` has a distance; `PITCH_LIMIT`, where small angles end, is a result of a study."""

    STOPPED = "stopped"
    TIME_LIMIT = "time-limit"
    PITCH_LIMIT = "pitch-limit"
    FAILED = "failed"

    @classmethod
    def _missing_(cls, value: object) -> "Status | None":
        """The status that files of earlier versions call by another name."""
        return cls.PITCH_LIMIT if value == "overturned" else None

    @property
    def is_failure(self) -> bool:
        """Whether a study has nothing to tell of such a run."""
        return self in (Status.TIME_LIMIT, Status.FAILED)

    @property
    def remedy(self) -> str:
        """What the user can do about it; empty for a wagon that stopped."""
        return _REMEDIES[self]


_REMEDIES = {
    Status.STOPPED: "",
    Status.TIME_LIMIT: "Raise solver.time_limit, or brake harder: brake and resistance may be too weak.",
    Status.PITCH_LIMIT: "A body pitched beyond what small angles can describe. Lower the torque, "
    "or compare with `--set tank.liquid.model=rigid`.",
    Status.FAILED: "Look at the last moments in the history file.",
}


@dataclass(frozen=True, eq=False, kw_only=True)
class Result:
    """One stop of one wagon. SI units throughout, the unit is part of a name where it is a plain number.

    time: (n,) s, at the output interval; the first row is t = 0, the last the end of the run.
    channels: name -> (n,) array; names, units and signs are those of `slosh_cli.results.channels`.
    braking_distance_m, braking_time_s: from the onset to the stop speed; None when the wagon did not stop.
    max_surface_m: largest rise of the free surface at an end wall; surface_limit_m: the room above it.
    min_wheel_load_N, max_wheel_load_N: extremes from onset to stop, from the integrator's own steps.
    recommendation: the model of the liquid that suits the stop; None for a rigid load.
    energy_residual: largest over the run, relative to the initial kinetic energy; energy: final ledger in J.
    work: counts of Newton iterations, factorisations, right-hand sides, events.

    Raises ValueError when a channel's length differs from that of `time`, KeyError for an unknown channel.
    """

    scenario: "Scenario"
    status: Status
    reason: str = ""
    warnings: tuple[str, ...] = ()
    checks: tuple[Check, ...] = ()
    recommendation: "Recommendation | None" = None
    time: Vector = field(repr=False)
    channels: Mapping[str, Vector] = field(repr=False)
    braking_distance_m: float | None
    braking_time_s: float | None
    max_surface_m: float
    surface_limit_m: float
    min_wheel_load_N: PerWheel
    max_wheel_load_N: PerWheel
    static_wheel_load_N: PerWheel
    mean_total_wheel_load_N: float
    weight_N: float
    locked_time_s: PerWheel
    energy_residual: float
    energy: Mapping[str, float] = field(repr=False)
    steps: int
    rejected_steps: int
    work: Mapping[str, int] = field(repr=False)
    solve_seconds: float

    def __post_init__(self) -> None:
        time = _read_only(self.time)
        channels = {name: _read_only(values) for name, values in self.channels.items()}
        for name, values in channels.items():
            channel(name)
            if values.shape != time.shape:
                raise ValueError(f"Channel {name!r} must have shape {time.shape}, but has {values.shape}.")
        object.__setattr__(self, "status", Status(self.status))
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "channels", channels)

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.scenario.name

    @property
    def initial_speed_m_s(self) -> float:
        """V0, the speed at t = 0, in m/s."""
        return self.scenario.braking.initial_speed

    @property
    def torque_N_m(self) -> float:
        """Brake torque per wheel in N m."""
        return self.scenario.braking.torque

    @property
    def onset_s(self) -> float:
        """Time at which the brake sets in, in s."""
        return self.scenario.braking.onset

    @property
    def liquid_model(self) -> str:
        """Model of the load: "rigid", "modal", ..."""
        return str(self.scenario.tank.liquid.model)

    @property
    def max_wheel_unloading(self) -> float:
        """Largest 1 - N/N0 of any wheel, from onset to stop; 1 means that a wheel lost contact."""
        pairs = zip(self.min_wheel_load_N, self.static_wheel_load_N, strict=True)
        return max(1.0 - least / static for least, static in pairs)

    @property
    def in_model_range(self) -> bool:
        """False where a check says that the run left the range of its own model."""
        return all(check.within for check in self.checks if check.kind == "model")

    @property
    def microseconds_per_step(self) -> float:
        """Time spent in the solver per accepted step, in microseconds."""
        return 1e6 * self.solve_seconds / max(self.steps, 1)

    def to_frame(self) -> "pd.DataFrame":
        """The history as a DataFrame: index `time` in s, one column per channel, all in SI units."""
        return frame(self.time, self.channels)

    def summary(self) -> dict[str, Any]:
        """The answer in plain Python values, with the keys of `slosh run --json` but for `files`.

        The reason of a run that did not stop is the last of its `warnings`.
        """
        return {
            "name": self.name,
            "status": str(self.status),
            "braking_distance_m": self.braking_distance_m,
            "braking_time_s": self.braking_time_s,
            "initial_speed_m_s": self.initial_speed_m_s,
            "torque_N_m": self.torque_N_m,
            "liquid_model": self.liquid_model,
            "max_surface_m": self.max_surface_m,
            "surface_limit_m": self.surface_limit_m,
            "min_wheel_load_N": list(self.min_wheel_load_N),
            "max_wheel_load_N": list(self.max_wheel_load_N),
            "max_wheel_unloading": self.max_wheel_unloading,
            "locked_time_s": list(self.locked_time_s),
            "energy_residual": self.energy_residual,
            "steps": self.steps,
            "rejected_steps": self.rejected_steps,
            "solve_seconds": self.solve_seconds,
            "in_model_range": self.in_model_range,
            "checks": plain(self.checks),
            "warnings": [*self.warnings, *([self.reason] if self.reason else [])],
            **({"recommendation": self.recommendation.as_dict()} if self.recommendation else {}),
        }


def _read_only(values: Vector) -> Vector:
    view = np.ascontiguousarray(values, dtype=np.float64).view()
    view.setflags(write=False)
    return view


def frame(time: Vector, channels: Mapping[str, Vector]) -> "pd.DataFrame":
    """Channels over time as a DataFrame with the index `time` in s."""
    import pandas as pd

    return pd.DataFrame(dict(channels), index=pd.Index(time, name=TIME.name))
