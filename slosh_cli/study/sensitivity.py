"""What a stop depends on: values up and down by what they may plausibly be off, one at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import Event
from typing import Any, Final

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.leaves import Quantity
from slosh_cli.scenario.plain_data import plain_data
from slosh_cli.scenario.standing import YOURS, standings
from slosh_cli.scenario.tree import Spot, value_at
from slosh_cli.scenario.units import shown
from slosh_cli.scenario.yaml_text import parse
from slosh_cli.study.outcome import FinishedStop
from slosh_cli.study.plan import Stop
from slosh_cli.study.threads import Threads, available_cores, warm_up

DISTANCE: Final = "braking_distance_m"
UNLOADING: Final = "max_wheel_unloading"
LOCK: Final = "speed_at_first_lock_m_s"
SMALL: Final[Mapping[str, float]] = {DISTANCE: 5e-3, UNLOADING: 0.01, LOCK: 0.3}
"""What does not matter: part of the distance, change of unloading, change of the speed (m/s) at the first lock."""
_TABLE: Final = Path(__file__).resolve().parent.parent / "presets" / "plausible.yaml"
_ANY: Final = {"times": [0.9, 1.1], "reason": "assumed; 10 % where nothing is known of it"}
_MODAL: Final = "tank.liquid.damping_ratio"
_FRICTIONS: Final = ("braking.blocks.friction", "braking.discs.friction")
_INTERVAL: Final = 100.0
"""Output interval in s of stops whose history nobody keeps."""


@dataclass(frozen=True)
class Doubt:
    """A value of the scenario and how far it may be off: key path, texts of the value itself and of both ends.

    `standing` is that of `standings`. `ends` are what the scenario takes at both of them: SI numbers or words. They are
    put at `place`, the key itself where it is empty.
    """

    key: str
    own: str
    low: str
    high: str
    standing: str
    reason: str
    ends: tuple[Any, Any]
    place: str = ""


@dataclass(frozen=True)
class Effect:
    """What a stop comes to with a value at both its ends: the rows of a study's table.

    None where the scenario is not sound there; `refusal` says why.
    """

    doubt: Doubt
    rows: tuple[Mapping[str, Any] | None, Mapping[str, Any] | None]
    refusal: str = ""

    def change(self, base: Mapping[str, Any], name: str) -> tuple[float | None, float | None]:
        """How an answer changes at both ends; None where one of the two has no number."""
        low, high = (_difference(row, base, name) for row in self.rows)
        return low, high

    def matters(self, base: Mapping[str, Any]) -> bool:
        """Whether an answer changes by more than is `SMALL`, or a stop ends otherwise or locks otherwise."""
        for row in self.rows:
            if row is not None and (row["status"] != base["status"] or (row.get(LOCK) is None) != (base[LOCK] is None)):
                return True
        scale = {DISTANCE: base[DISTANCE] or 1.0}
        changes = ((name, change) for name in SMALL for change in self.change(base, name) if change is not None)
        return any(abs(change) > SMALL[name] * scale.get(name, 1.0) for name, change in changes)


def doubts(scenario: Scenario) -> Iterator[Doubt]:
    """Every value that is not certain: those of the package's table, and what presets assume."""
    table, data, known = _plausible(), plain_data(scenario, as_text=False), standings(scenario)
    assumed = {key: _ANY for key, one in known.items() if one.standing == "assumed" and key not in table}
    for key, entry in (table | assumed).items():
        if key == _MODAL and scenario.tank.liquid.model != "modal":
            continue
        standing = next((one.standing for name, one in known.items() if f"{name}.".startswith(f"{key}.")), YOURS)
        found = _doubt(scenario, data, key, entry, standing)
        if found is not None:
            yield found


def effects(
    scenario: Scenario, threads: int | None, progress: Callable[[int, int], None], cancel: Event
) -> tuple[Mapping[str, Any], list[Effect]]:
    """The row of the scenario itself and every effect, the largest change of distance first."""
    scenario = scenario.with_({"output.interval": _INTERVAL})
    stops, places, refused = [Stop(0, "", scenario)], {}, {}
    found = list(doubts(scenario))
    for number, doubt in enumerate(found):
        for end, value in enumerate(doubt.ends):
            try:
                varied = scenario.with_({doubt.place or doubt.key: value})
            except ScenarioError as error:
                refused[number] = error.problems[0].rule if error.problems else str(error)
                continue
            if (doubt.low, doubt.high)[end] != doubt.own:
                places[number, end] = len(stops)
                stops.append(Stop(len(stops), "", varied))
            else:
                places[number, end] = 0
    rows = _rows(stops, threads, progress, cancel)
    told = []
    for number, doubt in enumerate(found):
        low, high = (rows[places[number, end]] if (number, end) in places else None for end in (0, 1))
        told.append(Effect(doubt, (low, high), refused.get(number, "")))
    return rows[0], sorted(told, key=lambda one: -_size(one, rows[0]))


def _rows(
    stops: list[Stop], threads: int | None, progress: Callable[[int, int], None], cancel: Event
) -> dict[int, Mapping[str, Any]]:
    """The rows of a study's table by the numbers of the stops."""
    warm_up(stops[0].scenario)
    found: dict[int, FinishedStop] = {}
    for batch in Threads(threads or available_cores()).outcomes(iter(stops), len(stops), cancel):
        found |= {one.index: one for one in batch}
        progress(len(found), len(stops))
    return {number: one.answer for number, one in found.items()}


def _size(effect: Effect, base: Mapping[str, Any]) -> float:
    changes = [abs(change) for change in effect.change(base, DISTANCE) if change is not None]
    return max(changes, default=0.0)


def _difference(row: Mapping[str, Any] | None, base: Mapping[str, Any], name: str) -> float | None:
    value, own = (row or {}).get(name), base.get(name)
    return None if value is None or own is None else float(value) - float(own)


@cache
def _plausible() -> dict[str, dict[str, Any]]:
    data = parse(_TABLE.read_text(encoding="utf-8"), _TABLE.name).data
    return {str(key): dict(entry) for key, entry in data.items()}


def _doubt(
    scenario: Scenario, data: Mapping[str, Any], key: str, entry: Mapping[str, Any], standing: str
) -> Doubt | None:
    """The doubt of a key; None where the scenario has no such number. `data` is the scenario as plain data."""
    path = tuple(key.split("."))
    own, spot = value_at(data, path), Spot(part=Scenario).at(data, path)
    reason = entry["reason"]
    if spot is not None and spot.short is not None and own is not None:
        if "from" not in entry:
            return _friction(scenario, key, standing, entry) if key in _FRICTIONS else None  # a word of a preset
        words = (word for word, one in spot.short.known.items() if plain_data(one, as_text=False) == own)
        low, high = entry["from"], entry["to"]
        return Doubt(key, next(words, "its own"), low, high, standing, reason, (low, high))
    if spot is None or spot.leaf is None or not isinstance(own, float) or ("times" in entry and own == 0.0):
        return None
    if "times" in entry:
        ends = [float(own * times) for times in entry["times"]]
    else:
        told = [float(spot.leaf.parse(entry[name])) for name in ("from", "to")]
        ends = [min(told[0], own), max(told[1], own)]
    unit = f" {spot.leaf.unit}" if isinstance(spot.leaf, Quantity) else ""
    texts = [f"{shown(float(f'{value:.6g}'))}{unit}" for value in (own, *ends)]
    return Doubt(key, texts[0], texts[1], texts[2], standing, reason, (ends[0], ends[1]))


def _friction(scenario: Scenario, key: str, standing: str, entry: Mapping[str, Any]) -> Doubt:
    """The doubt of a friction: points are scaled; a law, which depends on force and speed, at its arm.

    Blocks are discs that rub at the radius of the wheel, to the last digit, so a larger arm is a larger friction.
    """
    rubbing, wheel_radius = scenario.braking.rubbing, scenario.wagon.wheelset.wheel_radius
    assert rubbing is not None
    law, times = rubbing.friction, entry["times"]
    told = [f"{factor:g} times" for factor in times]
    if law.law == "table":
        ends = [[[speed, value * factor] for speed, value in law.points] for factor in times]
        if len(law.points) > 1:
            return Doubt(key, "its points", told[0], told[1], standing, entry["reason"], (ends[0], ends[1]))
        own, low, high = (shown(float(f"{law.points[0][1] * factor:.6g}")) for factor in (1.0, *times))
        return Doubt(key, own, low, high, standing, entry["reason"], (ends[0], ends[1]))
    faces = {"faces": rubbing.count, "force": rubbing.force, "friction": law.law}
    discs = [faces | {"radius": factor * rubbing.arm(wheel_radius)} for factor in times]
    ends_at = (discs[0], discs[1])
    return Doubt(key, law.law, told[0], told[1], standing, entry["reason"], ends_at, "braking.discs")
