"""Trains kept in a file: vehicles from the front, each the wagon, tank and brake of a scenario, and what they share."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from slosh_cli.errors import Problem, ScenarioError, UsageError
from slosh_cli.scenario.document import Document, Origin
from slosh_cli.scenario.loader import Root, load_document, read, scenario_to_yaml
from slosh_cli.scenario.packaged import find_packaged
from slosh_cli.scenario.rules import Finding
from slosh_cli.scenario.schema import Scenario, load_scenario
from slosh_cli.scenario.schema_train import MOST_VEHICLES, SHARED, TRACK_MODEL, TrainBraking, TrainEntry, TrainFile
from slosh_cli.scenario.units import plain

_EVERY: Final = "all"


@dataclass(frozen=True)
class TrainScenario:
    """A train as it is simulated: `vehicles` from the front, each with the onset at which the brake wave reaches it,
    and all with the train's track, contact, solver and output; `own` as they are without what the train says."""

    file: TrainFile
    vehicles: tuple[Scenario, ...]
    own: tuple[Scenario, ...]

    @property
    def name(self) -> str:
        """Name of the train."""
        return self.file.name

    @property
    def liquids(self) -> tuple[str, ...]:
        """The models of the loads that the solver of this train is compiled for; `mixed` where it takes two at once."""
        models = {str(one.tank.liquid.model) for one in self.vehicles}
        if len(models) > 1 and "shallow-water" in models:
            return ("mixed",)
        return tuple(sorted(models - {"rigid"} if len(models) > 1 else models))

    @property
    def text(self) -> str:
        """The train resolved: its own file, and the scenario of every kind of vehicle, as YAML documents."""
        kinds = {scenario_to_yaml(_at_onset(vehicle, 0.0)): None for vehicle in self.vehicles}
        return "---\n".join([scenario_to_yaml(self.file), *kinds])

    def with_(self, overrides: Mapping[str, Any]) -> TrainScenario:
        """A copy with other values, by the keys of `load_train`; values and errors are those of `Scenario.with_`.

        What is said of one vehicle holds there, whatever is said of all.
        """
        wishes = [wish for key, value in overrides.items() if (wish := _wish(key, value, key))]
        asked = {wish.written for wish in wishes}
        rest = {key: value for key, value in overrides.items() if key not in asked}
        document = Document({}, origins={(): Origin()})
        for key in rest:
            if key.partition(".")[0] == "vehicles":
                rule, fix = "must be `all.KEY`, `vehicles.N.KEY` or a key of the train", "write such as `all.tank.fill`"
                document.problems.append(Problem(None, "", rule, f"`{key}`", fix, key))
        if document.problems:
            raise ScenarioError(self.name, document.sorted_problems())
        file = self.file.with_(rest) if rest else self.file
        _check_wishes(document, file, wishes)
        found: list[Scenario] = []
        made: dict[tuple[int, tuple[str, ...]], Scenario] = {}
        for place, scenario in enumerate(self.own, 1):
            mine = _of_vehicle(wishes, place)
            kind = id(scenario), tuple(wish.written for wish in mine)
            if kind not in made:
                made[kind] = _changed(scenario, mine)
            found.append(made[kind])
        return _whole(file, document, Path(self.name), found)

    def spot(self, key: str) -> tuple[Root, str]:
        """What a key of `with_` speaks of: the train's file or a vehicle's scenario (the last one of all), and the key
        there."""
        wish = _wish(key, None, key)
        if wish is None or not 1 <= (wish.place or 1) <= len(self.own):
            return self.file, key
        return self.own[(wish.place or len(self.own)) - 1], wish.key


class _Wish(NamedTuple):  # an override of vehicles: place from the front, None for all; key; value; as it is written
    place: int | None
    key: str
    value: Any
    written: str


def _wish(key: str, value: Any, written: str) -> _Wish | None:
    """The override of vehicles that a `key` asks for; None for one of the train's own."""
    first, _, rest = key.partition(".")
    place, _, inner = rest.partition(".")
    if first == _EVERY and rest:
        return _Wish(None, _in_full(rest, value), value, written)
    if first == "vehicles" and re.fullmatch("0|[1-9][0-9]*", place) and inner:  # one way to write a number, one vehicle
        return _Wish(int(place), _in_full(inner, value), value, written)
    return None


def _in_full(key: str, value: Any) -> str:
    """The key that a vehicle's `track: rigid` is short for; any other key as it is."""
    return TRACK_MODEL if key == "track" and isinstance(value, str) and value.strip() == "rigid" else key


def _of_vehicle(wishes: Sequence[_Wish], place: int) -> list[_Wish]:
    """What is asked of the vehicle at a `place`: what is said of it alone comes last, so that it holds."""
    return [one for of in (None, place) for one in wishes if one.place == of]


def _changed(scenario: Scenario, wishes: Sequence[_Wish]) -> Scenario:
    """A vehicle with what is asked of it; problems stand at the keys as they are written."""
    mine = {wish.key: wish for wish in wishes}
    try:
        return scenario.with_({key: wish.value for key, wish in mine.items()}) if mine else scenario
    except ScenarioError as error:
        told = [
            replace(one, override=mine[one.override].written) if one.override in mine else one for one in error.problems
        ]
        raise type(error)(error.file, told) from None


def _whole(file: TrainFile, document: Document, path: Path, found: Sequence[Scenario]) -> TrainScenario:
    """The train of such vehicles."""
    return TrainScenario(file, tuple(_along_the_pipe(file, _with_shared(file, document, path, found))), tuple(found))


def is_train_file(path: Path) -> bool:
    """Whether the file describes a train; False where it cannot be read at all."""
    with suppress(ScenarioError):
        data = load_document(path).data
        return isinstance(data, dict) and "vehicles" in data
    return False


def load_train(path: str | Path, overrides: Iterable[str] = ()) -> TrainScenario:
    """Read a train and the scenarios of its vehicles.

    `overrides` are texts ``all.KEY=VALUE`` for every vehicle, ``vehicles.N.KEY=VALUE`` for the N-th from the front, or
    ``KEY=VALUE`` for a key of the train's file. What is said of one vehicle holds there, whatever is said of all.
    Raises ScenarioError, which names the file that is wrong.
    """
    path = Path(path)
    own, wishes = _sorted(overrides)
    document = read(path, own, lambda _: TrainFile)
    file = TrainFile.of(document, str(path))
    total = sum(entry.count for entry in file.vehicles)
    _check_wishes(document, file, wishes)
    if total > MOST_VEHICLES:
        document.add(Finding(("vehicles",), f"must be at most {MOST_VEHICLES} in all", f"{total}", "leave some out"))
    found: list[Scenario] = []
    load = lru_cache(maxsize=None)(load_scenario)
    for number, entry in enumerate(file.vehicles):
        source = _source(document, path, number, entry)
        for place in range(len(found) + 1, len(found) + 1 + entry.count) if source else ():
            mine = _of_vehicle(wishes, place)
            given = {_in_full(key, value): value for key, value in entry.set.items()}
            settings = tuple(f"{key}={json.dumps(value)}" for key, value in given.items())
            try:
                found.append(load(source, (*settings, *(f"{wish.key}={wish.value}" for wish in mine))))
            except ScenarioError as error:
                raise _at_its_place(error, document, path, number, mine) from None
        if document.problems:
            raise ScenarioError(str(path), document.sorted_problems())
    return _whole(file, document, path, found)


def _sorted(overrides: Iterable[str]) -> tuple[list[str], list[_Wish]]:
    """Overrides of the train's file, and those of its vehicles."""
    own, wishes = [], []
    for text in overrides:
        key, equals, value = text.partition("=")
        wish = _wish(key.strip(), value, f"--set {key.strip()}") if equals else None
        if wish is None:
            own.append(text)
        else:
            wishes.append(wish)
    return own, wishes


def _check_wishes(document: Document, file: TrainFile, wishes: Sequence[_Wish]) -> None:
    """Refuse overrides of vehicles that are not there, and values of a vehicle that the train's would displace."""
    total = sum(entry.count for entry in file.vehicles)
    for wish in wishes:
        document.overrides.append(wish.written)
        if wish.place is not None and not 1 <= wish.place <= total:
            rule = f"must name a vehicle from the front, 1 to {total}"
            fix = f"write `vehicles.1.{wish.key}`, or `all.{wish.key}` for every vehicle"
            document.problems.append(Problem(None, "", rule, f"`{wish.place}`", fix, wish.written))
        elif _is_displaced(file, wish.key, wish.place or 1):
            place_of = wish.written.removesuffix(wish.key)
            fix = f"write `{place_of}braking.blocks=...`" if wish.key == "braking" else ""
            option = "--set " if wish.written.startswith("--set ") else ""
            fix = fix or f"write `{option}{_for_all(file, wish.key)}=...`"
            document.problems.append(Problem(None, "", _rule(wish.key), f"`{wish.value}`", fix, wish.written))
    place = 1
    for number, entry in enumerate(file.vehicles):
        for key, value in entry.set.items():
            if _is_displaced(file, _in_full(key, value), place):
                fix = f"write `{key}` for the train, outside of `vehicles:`"
                fix = "write such as `braking.blocks: ...`" if key == "braking" else fix
                document.add(Finding(("vehicles", number, "set", key), _rule(key), plain(value), fix))
        place += entry.count
    if any(problem.override for problem in document.problems):
        raise ScenarioError("", document.sorted_problems())


def _is_displaced(file: TrainFile, key: str, place: int) -> bool:
    """Whether the train, or its first vehicle, says for all what `key` would say of the vehicle at a `place`."""
    part = key.partition(".")[0]
    own = key == TRACK_MODEL and file.track is None
    shared = part in SHARED and not own and (place > 1 or getattr(file, part) is not None)
    return shared or key in {"braking", *(f"braking.{name}" for name in TrainBraking.model_fields)}


def _rule(key: str) -> str:
    """Why a vehicle must not have the value of a displaced `key`."""
    if key == "braking":
        return "must be given key by key: initial speed, onset and stop speed are the train's"
    return "must be said of the whole train, not of a vehicle"


def _for_all(file: TrainFile, key: str) -> str:
    """How an override says `key` for the whole train: by its first vehicle where its own file says nothing of it."""
    part = key.partition(".")[0]
    return f"{_EVERY}.{key}" if part in SHARED and getattr(file, part) is None else key


def _source(document: Document, path: Path, number: int, entry: TrainEntry) -> Path | None:
    """The file of a vehicle's scenario; None, with a problem, where there is none or it describes a train."""
    where, found = ("vehicles", number, "scenario"), path.parent / entry.scenario
    if not os.path.isfile(found):
        try:
            return find_packaged(entry.scenario)
        except UsageError as error:
            rule = "must be the path of a scenario from this file, or the name of a packaged one"
            fix = error.message.rpartition("; ")[2]
            document.add(Finding(where, rule, f"`{entry.scenario}`, and there is no {found}", fix))
            return None
    if is_train_file(found):
        rule, fix = "must be the scenario of one vehicle", "name a scenario, or write that train's vehicles here"
        document.add(Finding(where, rule, f"`{entry.scenario}`, a train", fix))
        return None
    return found


def _at_its_place(
    error: ScenarioError, document: Document, path: Path, number: int, wishes: Sequence[_Wish]
) -> ScenarioError:
    """What is wrong with a vehicle's own values, at the lines of the train's file or the overrides that gave them; what
    is wrong with its scenario as it is stays as it is."""
    written = {f"--set {wish.key}": wish.written for wish in wishes}

    def moved(problem: Problem) -> Problem:
        if problem.override in written:
            return replace(problem, override=written[problem.override])
        name = problem.override.removeprefix("--set ")
        place, inner = ("vehicles", number, "set", name), problem.key if problem.key.startswith(f"{name}.") else name
        return replace(problem, line=document.origin(place).line, key=f"vehicles.{number}.set.{inner}", override="")

    own = [problem for problem in error.problems if not problem.override]
    return error if own else ScenarioError(str(path), [moved(problem) for problem in error.problems])


def _with_shared(file: TrainFile, document: Document, path: Path, found: Sequence[Scenario]) -> Iterator[Scenario]:
    """The vehicles with what the train says for all of them, or else the first one; each kind is checked once."""
    settings = {key: getattr(found[0], key) for key in SHARED} | file.settings
    lent = {key: name for key, name in found[0].presets.items() if key.split(".")[0] in {*SHARED} - {*file.settings}}
    kinds: dict[int, Scenario] = {}
    for number, scenario in enumerate(found, 1):
        if id(scenario) not in kinds:
            own = {} if file.track is not None else {TRACK_MODEL: scenario.track.model}
            try:
                made = scenario.with_(settings | own)
            except ScenarioError as error:
                told = [replace(problem, line=document.origin(("braking",)).line) for problem in error.problems]
                raise ScenarioError(f"{path}, vehicle {number} ({scenario.name})", told) from None
            kinds[id(scenario)] = made.model_copy(update={"presets": made.presets | lent}) if lent else made
        yield kinds[id(scenario)]


def _along_the_pipe(file: TrainFile, vehicles: Iterable[Scenario]) -> Iterator[Scenario]:
    """The vehicles with their onsets: the wave comes to the middle of each from the front of the train."""
    front = 0.0
    for scenario in vehicles:
        length = scenario.wagon.length_in_train
        yield _at_onset(scenario, file.braking.onset + (front + 0.5 * length) / file.brake_pipe.speed)
        front += length


def _at_onset(scenario: Scenario, onset: float) -> Scenario:
    return scenario.model_copy(update={"braking": scenario.braking.model_copy(update={"onset": onset})})
