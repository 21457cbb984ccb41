"""The answers of one stop: what a run comes to, in memory or read back from its file."""

# ruff: noqa: N815  (units such as N keep their case in the names that files and scripts rely on)

from collections.abc import Mapping
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.errors import UsageError
from slosh_cli.results.answers import Answers, PerWheel, Place, Shown, Told, computed, derived
from slosh_cli.results.channels import LINE_CHANNELS, TIME, channel, wheel
from slosh_cli.results.validity import PITCH_CHECK, Check
from slosh_cli.version import install_command
from slosh_cli.wagon.torque import nominal_torque

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from slosh_cli.results.recommendation import Recommendation
    from slosh_cli.scenario import Scenario


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
    Status.PITCH_LIMIT: "A body pitched further than small angles can describe. Lower the torque, "
    "or compare with `--set tank.liquid.model=rigid`.",
    Status.FAILED: "Look at the last moments in the history file.",
}

_NOT_THE_LIQUID = ("wheels lifted off", PITCH_CHECK)
"""Checks of the model's range that are not about the liquid: what they tell leaves the distance alone."""
_LOCKED_SPEED = 1e-3
"""Circumferential speed in m/s below which a wheel under a moving wagon counts as locked in a history."""
_WORST = 5
"""Exceeded checks that the short form of a record names."""


def liquid_is_in_range(run: Any) -> bool:
    """Whether the liquid of a run with `checks` stayed in the range of its model."""
    return all(check.within for check in _of_range(run) if check.name not in _NOT_THE_LIQUID)


def _of_range(run: "Record") -> tuple[Check, ...]:
    """The checks of the model's range."""
    return tuple(check for check in run.checks if check.kind == "model")


def _unloading(run: "Record") -> PerWheel:
    loads = zip(run.min_wheel_load_N, run.static_wheel_load_N, strict=True)
    return tuple(1.0 - least / static for least, static in loads)


class Record(Answers):
    """One stop of one wagon: in memory a `Result`, read back from its file a `History`.

    The first attributes are the table of answers: SI units throughout, the unit is part of a name.
    time: (n,) s, at the output interval; the first row is t = 0, the last the end of the run.
    channels: name -> (n,) array; names, units and signs are those of `slosh_cli.results.channels`.
    """

    # fmt: off
    name: str = derived("", "name of the scenario", Place.NAME, given="name", shown=~Shown.STUDY, needed=True)
    status: Status = computed("", "how the run ended", Place.STATUS, needed=True, line=Told(1, "status"))
    braking_distance_m: float | None = computed(
        "m", "from the onset to the stop speed; none when the wagon did not stop", Place.DISTANCE, needed=True,
        line=Told(2, "braking distance", ".2f", "m"))
    braking_time_s: float | None = computed(
        "s", "from the onset to the stop speed; none when the wagon did not stop", Place.DISTANCE,
        line=Told(3, "braking time", ".2f", "s"))
    initial_speed_m_s: float = derived(
        "m/s", "V0, the speed at t = 0", Place.CONDITIONS, given="braking.initial_speed", needed=True,
        column="v0_km_h", per=1 / 3.6)
    torque_N_m: float = derived(
        "N m", "brake torque per wheel, fully applied, at the initial speed", Place.CONDITIONS,
        of=lambda run: nominal_torque(run.scenario), needed=True, column="torque_kN_m", per=1e3)
    onset_s: float = derived(
        "s", "time at which the brake sets in", Place.CONDITIONS, given="braking.onset", needed=True,
        shown=Shown.HISTORY)
    liquid_model: str = derived(
        "", "model of the load: rigid, modal or shallow-water", Place.CONDITIONS, given="tank.liquid.model",
        needed=True, column="liquid")
    liquid_in_range: bool = derived(
        "", "whether the run stayed in the range of the liquid's model", Place.RANGE, shown=Shown.STUDY,
        of=liquid_is_in_range)
    fill: float = derived(
        "1", "depth of the still liquid over the tank's inner height", Place.SURFACE, given="tank.fill",
        shown=~Shown.JSON)
    max_surface_m: float = computed(
        "m", "largest rise of the free surface at an end wall", Place.SURFACE,
        line=Told(4, "surface rise at an end wall, largest", ".2f", "m"))
    surface_limit_m: float = computed("m", "room above the still surface", Place.SURFACE, needed=True)
    min_wheel_load_N: PerWheel = computed(
        "N", "least load from onset to stop, from the integrator's own steps", Place.WHEELS,
        line=Told(2, "least / kN", ".1f", per=1e3))
    max_wheel_load_N: PerWheel = computed(
        "N", "largest load from onset to stop, from the integrator's own steps", Place.WHEELS,
        line=Told(3, "most / kN", ".1f", per=1e3))
    static_wheel_load_N: PerWheel = computed(
        "N", "load of the wagon at rest", Place.WHEELS, shown=~Shown.JSON, needed=True,
        line=Told(1, "at rest / kN", ".1f", per=1e3))
    wheel_unloading: PerWheel = derived(
        "1", "largest 1 - N/N0 from onset to stop", Place.WHEELS, shown=Shown(0), of=_unloading,
        line=Told(4, "unloading / %", ".1f", per=0.01))
    max_wheel_unloading: float = derived(
        "1", "largest 1 - N/N0 of any wheel, from onset to stop; 1 means that a wheel lost contact",
        of=lambda run: max(_unloading(run)),
        line=Told(7, "wheel unloading, largest", ".1f", "% (usual limit: 60 %)", per=0.01))
    locked_time_s: PerWheel = computed(
        "s", "how long a wheel was locked", Place.WHEELS, line=Told(5, "locked / s", ".2f"))
    brake_torque_max_N_m: PerWheel = computed(
        "N m", "largest brake torque transmitted to a wheel", shown=~(Shown.SUMMARY | Shown.STUDY))
    speed_at_first_lock_m_s: float | None = computed(
        "m/s", "speed of the wagon when the first wheel locked; none when none did", Place.WHEELS,
        line=Told(8, "speed at the first lock", ".2f", "m/s"), default_factory=lambda: None)
    slide_protection_cycles: float | None = computed(
        "1", "how often slide protection began to vent, all wheelsets; none without it", shown=~Shown.STUDY)
    slide_protection_air: float | None = computed(
        "1", "air that slide protection used: fillings of one wheelset's brake, all wheelsets; none without it",
        shown=~Shown.STUDY)
    mean_total_wheel_load_N: float = computed(
        "N", "sum of all wheel loads, mean from onset to stop", shown=~Shown.JSON,
        line=Told(9, "mean sum of wheel loads / weight - 1", ".1e"))
    weight_N: float = computed("N", "weight of wagon and load", shown=~Shown.JSON)
    unevenness_d1_m: float | None = computed(
        "m", "standard deviation in D1 (3-25 m) that a spectrum of the rails realises over the way; else none",
        shown=Shown.JSON | Shown.HISTORY, default_factory=lambda: None, optional=True,
        line=Told(13, "level of the rails in D1 over the way", ".2f", "mm (one-sided spectrum, per rad/m)", per=1e-3))
    energy_residual: float = computed(
        "1", "what the energy ledger misses, largest over the run, relative to the initial kinetic energy",
        line=Told(10, "energy ledger, largest residual", ".1e", "of the initial energy"))
    steps: int = computed("1", "accepted steps of the integrator", line=Told(11, "steps"))
    rejected_steps: int = computed("1", "rejected steps of the integrator")
    solve_seconds: float = computed("s", "time spent in the solver", shown=~Shown.STUDY, line=Told(12, "solver time"))
    in_model_range: bool = derived(
        "", "false where a check says that the run left the range of its own model",
        of=lambda run: all(check.within for check in _of_range(run)), line=Told(5, "within the range of its model"))
    checks: tuple[Check, ...] = computed(
        "", "verdicts: values beside their limits", shown=Shown.JSON | Shown.HISTORY, default_factory=tuple)
    not_within: str = derived(
        "", "names of the checks that are not within their limits", Place.WORDS, shown=Shown.SUMMARY | Shown.STUDY,
        of=lambda run: "; ".join(check.name for check in run.checks if not check.within))
    reason: str = computed(
        "", "why the wagon did not stop", Place.WORDS, shown=~Shown.JSON, needed=True, default_factory=str)
    warnings: tuple[str, ...] = computed(
        "", "what to know before the numbers are used", Place.WORDS, needed=True, default_factory=tuple)
    # fmt: on
    time: Vector
    channels: Mapping[str, Vector]

    @property
    def torque_words(self) -> str:
        """The brake torque per wheel: of one that grows towards the stop, at the initial speed and at its largest."""
        most = max(getattr(self, "brake_torque_max_N_m", (0.0,)))  # files of earlier versions have none
        grown = f" to {most / 1e3:.4g}" if most > 1.001 * self.torque_N_m else ""
        return f"{self.torque_N_m / 1e3:.4g}{grown} kN m per wheel"

    @property
    def has_liquid(self) -> bool:
        """Whether the load can slosh."""
        return self.liquid_model != "rigid"

    def has_figure(self, name: str) -> bool:
        """Whether there is what the figure `name` shows: a liquid, a line that is not level or not even."""
        applied = self.channels.get("brake_application", np.zeros(0))  # files of earlier versions have none
        suits = {
            "slosh": self.has_liquid,
            "brake": bool(np.any(applied % 1.0)) or wheel(1, "friction") in self.channels,
            "line": not LINE_CHANNELS.keys().isdisjoint(self.channels),
        }
        return suits.get(name, True)

    def locked_stretches(self, i: int) -> list[tuple[float, float]]:
        """Start and duration in s of every stretch in which wheel `i` stands while the wagon moves."""
        locked = np.abs(self.channels[wheel(i, "speed")]) < _LOCKED_SPEED
        locked &= self.channels["speed"] > _LOCKED_SPEED
        edges = np.flatnonzero(np.diff(np.concatenate(([False], locked, [False])).astype(np.int8)))
        last = len(self.time) - 1
        return [
            (float(self.time[start]), float(self.time[min(end, last)] - self.time[start]))
            for start, end in edges.reshape(-1, 2)
        ]

    def __repr__(self) -> str:
        """What it was, how it ended, and the checks exceeded most: less than a screen."""
        found = vars(self)  # a file of an earlier version may lack some
        load = f"{self.torque_words}, load: {self.liquid_model}"
        lines = [f"{type(self).__name__} {self.name}: {self.initial_speed_m_s * 3.6:.4g} km/h, {load}"]
        if self.braking_distance_m is None:
            lines.append(f"  {self.status}, no braking distance: {self.reason}")
        else:
            lines.append(
                f"  {self.status} after {self.braking_distance_m:.2f} m and {found.get('braking_time_s', np.nan):.2f} s"
            )
        over = [check for check in found.get("checks", ()) if not check.within]
        over.sort(key=lambda check: check.value / check.limit if check.limit else np.inf, reverse=True)
        lines += [f"  over its limit: {check.name} ({check.value:.3g} > {check.limit:.3g})" for check in over[:_WORST]]
        return "\n".join([*lines, *([f"  and {len(over) - _WORST} more"] if len(over) > _WORST else [])])

    def to_frame(self) -> "pd.DataFrame":
        """The history as a DataFrame: index `time` in s, one column per channel, all in SI units."""
        import pandas as pd

        return pd.DataFrame(dict(self.channels), index=pd.Index(self.time, name=TIME.name))

    def to_xarray(self) -> "xr.Dataset":
        """The history as a Dataset over `time`, units and meanings as attributes of its variables, answers as its own.

        Raises UsageError where xarray is not installed.
        """
        try:
            import xarray as xr
        except ImportError as error:
            raise UsageError(f"to_xarray needs xarray; install it with: {install_command('xarray')}") from error
        pairs = [(TIME, self.time), *((channel(name), values) for name, values in self.channels.items())]
        columns = {
            info.name: (TIME.name, values, {"units": info.unit, "long_name": info.long_name}) for info, values in pairs
        }
        facts = self.as_attributes()  # netCDF knows no true and false
        plain = {name: int(value) if isinstance(value, bool) else value for name, value in facts.items()}
        return xr.Dataset(columns, attrs=plain).set_coords(TIME.name)


class Result(Record):
    """One stop in memory.

    recommendation: the model of the liquid that suits the stop; None for a rigid load.
    energy: final ledger in J. work: counts of Newton iterations, factorisations, right-hand sides, events.

    Raises ValueError when a channel's length differs from that of `time`, KeyError for an unknown channel.
    """

    recommendation: "Recommendation | None" = computed(
        "", "the model of the liquid that suits the stop; none for a rigid load", shown=Shown.JSON | Shown.HISTORY,
        line=Told(6, "model of the liquid that suits"), default_factory=lambda: None,
    )  # fmt: skip
    scenario: "Scenario"
    energy: Mapping[str, float]
    work: Mapping[str, int]

    def __post_init__(self) -> None:
        time = _read_only(self.time)
        columns = {name: _read_only(values) for name, values in self.channels.items()}
        for name, values in columns.items():
            channel(name)
            if values.shape != time.shape:
                raise ValueError(f"Channel {name!r} must have shape {time.shape}, but has {values.shape}.")
        found = {"status": Status(self.status), "time": time, "channels": columns}
        for name, value in found.items():
            object.__setattr__(self, name, value)
        for one in self.table():
            if one.of or one.given:
                object.__setattr__(self, one.name, one.value_in(self))

    @property
    def microseconds_per_step(self) -> float:
        """Time spent in the solver per accepted step, in microseconds."""
        return 1e6 * self.solve_seconds / max(self.steps, 1)

    def summary(self) -> dict[str, Any]:
        """The answer in plain Python values, with the keys of `slosh run --json` but for `files`.

        The reason of a run that did not stop is the last of its `warnings`.
        """
        found = self.as_dict()
        return found | {"warnings": [*found["warnings"], *([self.reason] if self.reason else [])]}


def _read_only(values: Vector) -> Vector:
    view = (values if values.size > 200_000 else np.ascontiguousarray(values, np.float64)).view()  # or held twice
    view.setflags(write=False)
    return view
