"""Answers that the figures and tables of a study show: the usual ones, or any that are asked for."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Final

from slosh_cli.errors import UsageError
from slosh_cli.results.answers import Answer, PerWheel, Shown
from slosh_cli.results.result import Record, Status
from slosh_cli.results.train_result import TrainResult
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.study.plan import Study

DISTANCE: Final = "braking_distance"
_FORCES: Final = "coupler_forces"
_SHOWABLE: Final = tuple(dict.fromkeys(one.name for of in (Record, TrainResult) for one in of.table(Shown.STUDY)))
NAMES: Final = (DISTANCE, _FORCES, *_SHOWABLE)
"""Every name that a figure of a study may have."""


@dataclass(frozen=True)
class Answered:
    """What a figure shows: its `title`, the `name` of its files, the `label` and `unit` of its vertical axis, and the
    `curves` to which a row of the table adds a value each; a line at its usual `limit`. One that was asked for has the
    same scale in all panels, and no ring at its lowest point."""

    title: str
    name: str
    label: str
    unit: str
    curves: Callable[[Mapping[str, Any]], Iterable[tuple[str, float | None]]]
    limit: float | None = None
    asked: bool = False


def _kilonewtons(value: float | None) -> float | None:
    return None if value is None else value / 1e3


_OF_A_WAGON: Final = (
    Answered(
        "Braking distance", DISTANCE, "braking distance / m", "m",
        lambda row: [(str(row["liquid"]), row.get("braking_distance_m"))],
    ),
)  # fmt: skip
_OF_A_TRAIN: Final = (
    Answered(
        "Braking distance", DISTANCE, "braking distance / m", "m",
        lambda row: [("first vehicle", row.get("braking_distance_m"))],
    ),
    Answered(
        "Coupler forces", _FORCES, "largest coupler force / kN", "kN",
        lambda row: [(way, _kilonewtons(row.get(f"max_{way}_N"))) for way in ("compression", "tension")],
    ),
)  # fmt: skip


_ALIASES: Final[Mapping[str, str]] = {
    "distance": "braking_distance_m", "time": "braking_time_s", "unloading": "max_wheel_unloading",
    "first_lock": "speed_at_first_lock_m_s", "surface": "max_surface_m", "compression": "max_compression_N",
    "tension": "max_tension_N", "longest_lock": "longest_lock_s",
}  # fmt: skip
_PERCENT: Final[Mapping[str, float]] = {"max_wheel_unloading": 60.0}
"""Answers that are told in per cent, with their usual limit."""


def asked_for(study: Study, names: Sequence[str]) -> list[Answered]:
    """What the answers `names` show: names as declared, or short ones. Raises UsageError for others, with a guess."""
    known = {
        one.name: one
        for one in study.answers.table(Shown.STUDY)
        if one.unit and one.kind not in (PerWheel, bool) and not one.given
    }
    short = {alias: name for alias, name in _ALIASES.items() if name in known}
    found = []
    for name in names:
        one = known.get(short.get(name, name))
        if one is None:
            guess = get_close_matches(name, [*short, *known], 1, 0.5)
            within = [other for other in known if name and name in other]
            meant = f"do you mean `{(guess or within)[0]}`? " if guess or within else ""
            raise UsageError(f"no answer is called `{name}`; {meant}known are {', '.join([*short, *known])}", "--show")
        found.append(_answered(one))
    return found


def _answered(one: Answer) -> Answered:
    percent = one.name in _PERCENT
    per, unit = (0.01, "%") if percent else (1e3, "kN") if one.unit == "N" else (1.0, one.unit.removeprefix("1"))
    words = one.name if one.unit == "1" else one.name.removesuffix("_" + re.sub("[ /]", "_", one.unit))
    words = words.replace("_", " ")

    def curves(row: Mapping[str, Any]) -> list[tuple[str, float | None]]:
        value = row.get(one.columns[0]) if row["status"] == Status.STOPPED else None
        return [(str(row.get("liquid", "train")), None if value is None else float(value) * one.per / per)]

    label = f"{words} / {unit}" if unit else words
    return Answered(words.capitalize(), one.name, label, unit, curves, _PERCENT.get(one.name), asked=True)


def usual(study: Study) -> tuple[Answered, ...]:
    """What is shown where nothing is asked for: the distance, and the forces in a train."""
    return _OF_A_TRAIN if isinstance(study.base, TrainScenario) else _OF_A_WAGON
