"""A study: a scenario or a train, what varies in it, and the stops that follow from both."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from dataclasses import replace as copy_of
from itertools import product
from typing import Any, ClassVar, Final

from slosh_cli.errors import Problem, ScenarioError
from slosh_cli.results.answers import Answers
from slosh_cli.results.result import Record
from slosh_cli.results.train_result import TrainResult
from slosh_cli.scenario import OutlivedCoefficientsError, Scenario, parse_quantity
from slosh_cli.scenario.schema_modes import shapes_modes
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.scenario.units import plain
from slosh_cli.study.axis import Axis
from slosh_cli.study.key import stop_key
from slosh_cli.wagon.torque import nominal_torque

SPEED: Final = "braking.initial_speed"
TORQUE: Final = "braking.torque"
_BRAKING: Final = "braking."
LIQUID: Final = "tank.liquid.model"
SOLID: Final = "rigid"
_COEFFICIENTS: Final = "tank.coefficients"

_TRIES: Final = 200
"""Combinations in which a value may prove itself before it is refused, and values of a shape that are tried."""
_LONGEST_INTERVAL: Final = 100.0
"""Output interval in s of a stop whose history nobody keeps."""


@dataclass(frozen=True)
class Stop:
    """One stop to compute: its place in the study, its key, its scenario; what a worker is sent."""

    index: int
    key: str
    scenario: Scenario | TrainScenario
    history: bool = False


@dataclass(frozen=True)
class Study:
    """A grid of stops of `base`; the last of `axes` varies fastest. `WagonStudy` and `TrainStudy` know what of.

    `file` is what messages name: the study file or the scenario. `answers` is the class of a stop's answers;
    `kept` are key paths and values of every stop, beside those of the axes.
    """

    answers: ClassVar[type[Answers]]

    name: str
    base: Scenario | TrainScenario
    axes: tuple[Axis, ...]
    file: str
    histories: bool = False
    kept: Mapping[str, str] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """Number of stops."""
        return math.prod(len(axis.values) for axis in self.axes)

    def positions(self, index: int) -> tuple[int, ...]:
        """Per axis the place of the value that stop `index` takes."""
        places: list[int] = []
        for axis in reversed(self.axes):
            index, place = divmod(index, len(axis.values))
            places.append(place)
        return tuple(reversed(places))

    def values(self, index: int) -> dict[str, str]:
        """Key path to value, as text, of stop `index`."""
        pairs = zip(self.axes, self.positions(index), strict=True)
        return {axis.key: axis.values[place] for axis, place in pairs}

    def stop(self, index: int, key: str | None = None) -> Stop:
        """Stop `index`, whose key need not be found where it is known.

        Raises ScenarioError where its combination of values makes no sound scenario.
        """
        values: dict[str, Any] = {**self.kept, **self.values(index)}
        if self.histories:
            values["description"] = _describe(self.values(index))
        else:
            values["output.interval"] = _LONGEST_INTERVAL
        try:
            scenario = self.base.with_(values)
        except ScenarioError as error:
            axes = {axis.key: axis for axis in self.axes}
            raise type(error)(self.file, [_placed(problem, axes) for problem in error.problems]) from None
        return Stop(index, key or stop_key(scenario), scenario, self.histories)

    @property
    def vehicles(self) -> int:
        """How many vehicles move together in a stop."""
        return 1

    def conditions(self, index: int) -> dict[str, Any]:
        """What the table tells of stop `index` that has no answers, from its texts where they tell."""
        raise NotImplementedError

    @property
    def liquids(self) -> dict[str, int]:
        """The models of the load, each with a stop that has it."""
        raise NotImplementedError

    def check(self) -> None:
        """Raise ScenarioError for the first value of an axis that makes no sound scenario in any combination."""
        for number, axis in enumerate(self.axes):
            for place in range(len(axis.values)):
                self._sound(number, place)

    def _index(self, places: Mapping[int, int]) -> int:
        """The stop at the given places of the axes, by their number; the first place on every other axis."""
        index = 0
        for number, axis in enumerate(self.axes):
            index = index * len(axis.values) + places.get(number, 0)
        return index

    def _sound(self, number: int, place: int) -> int:
        """A stop in which axis `number` takes the value at `place`. Raises ScenarioError where none is sound."""
        first: ScenarioError | None = None
        for index in self._indices_with(number, place):
            try:
                self.stop(index)
            except ScenarioError as error:
                first = first or error
            else:
                return index
        assert first is not None
        raise first

    def _indices_with(self, number: int, place: int) -> Iterator[int]:
        """Stops in which axis `number` takes the value at `place`, spread over the study."""
        below = math.prod(len(axis.values) for axis in self.axes[number + 1 :])
        count = len(self.axes[number].values)
        total = self.size // count
        for turn in range(0, total, max(1, total // _TRIES)):
            above, rest = divmod(turn, below)
            yield (above * count + place) * below + rest


class WagonStudy(Study):
    """A grid of stops of a wagon."""

    answers = Record

    @property
    def _wagon(self) -> Scenario:
        assert isinstance(self.base, Scenario)
        return self.base

    def conditions(self, index: int) -> dict[str, Any]:
        """Speed in km/h, torque in kN m and model of the load of stop `index`, from its texts where they tell."""
        values = self.values(index)
        braking, liquid = self._wagon.braking, self._wagon.tank.liquid
        speed = parse_quantity(values[SPEED], "speed") if SPEED in values else braking.initial_speed
        return {
            "v0_km_h": _tidy(speed * 3.6),
            "torque_kN_m": _tidy(self._torque(index, values) / 1e3),
            "liquid": values.get(LIQUID, str(liquid.model)),
        }

    def _torque(self, index: int, values: dict[str, str]) -> float:
        """Torque (N m) of a fully applied wheel of stop `index` at its initial speed."""
        if TORQUE in values:
            return parse_quantity(values[TORQUE], "torque")
        if self._wagon.braking.torque is not None and not any(key.startswith(_BRAKING) for key in {*values} - {SPEED}):
            return nominal_torque(self._wagon)
        scenario = self.stop(index, "").scenario
        assert isinstance(scenario, Scenario)
        return nominal_torque(scenario)

    @property
    def liquids(self) -> dict[str, int]:
        """The models of the load, each with a stop that has it."""
        for number, axis in enumerate(self.axes):
            if axis.key == LIQUID:
                return {model: self._sound(number, place) for place, model in enumerate(axis.values)}
        return {str(self._wagon.tank.liquid.model): 0}

    def check(self) -> None:
        """As of any study; given slosh coefficients that outlive their tank in any combination are refused, too."""
        self._check_coefficients()
        super().check()

    def _check_coefficients(self) -> None:
        """Raise ScenarioError where slosh coefficients would be used for another tank than the one they belong to."""
        shaping = [number for number, axis in enumerate(self.axes) if shapes_modes(axis.key, self._wagon.tank)]
        choosing = [number for number, axis in enumerate(self.axes) if axis.key in (LIQUID, _COEFFICIENTS)]
        for number in shaping:
            self._check_common_coefficients(self.axes[number])
            some = range(0, len(self.axes[number].values), max(1, len(self.axes[number].values) // _TRIES))
            for places in product(some, *(range(len(self.axes[n].values)) for n in choosing)):
                index = self._index(dict(zip((number, *choosing), places, strict=True)))
                try:
                    self.stop(index)
                except OutlivedCoefficientsError:
                    raise
                except ScenarioError:  # something else: `check` tells of it where no combination is sound
                    continue

    def _check_common_coefficients(self, shape: Axis) -> None:
        """Raise ScenarioError where one list of an axis of coefficients would serve several tanks of another axis."""
        for axis in self.axes:
            lists = [value for value in axis.values if axis.key == _COEFFICIENTS and value != "computed"]
            if lists and len(shape.values) > 1:
                rule = f"must be `computed` where `{shape.key}` varies, because given coefficients belong to one tank"
                problem = Problem(None, axis.key, rule, plain(lists[0]), "write `computed`", override=axis.key)
                raise OutlivedCoefficientsError(self.file, [_placed(problem, {axis.key: axis})])


class TrainStudy(Study):
    """A grid of stops of a train; keys are those of `TrainScenario.with_`."""

    answers = TrainResult

    @property
    def vehicles(self) -> int:
        """How many vehicles move together in a stop."""
        assert isinstance(self.base, TrainScenario)
        return len(self.base.vehicles)

    def conditions(self, index: int) -> dict[str, Any]:
        """Speed in km/h of stop `index`."""
        values, train = self.values(index), self.base
        assert isinstance(train, TrainScenario)
        speed = parse_quantity(values[SPEED], "speed") if SPEED in values else train.file.braking.initial_speed
        return {"v0_km_h": _tidy(speed * 3.6)}

    @property
    def liquids(self) -> dict[str, int]:
        """The kinds of loads that a train has together, each with a stop of it."""
        found: dict[str, int] = {}
        for number, axis in enumerate(self.axes):
            places = range(len(axis.values)) if axis.key.endswith(LIQUID) else (0,)
            for index in (self._sound(number, place) for place in places):
                train = self.stop(index).scenario
                assert isinstance(train, TrainScenario)
                found |= {kind: index for kind in train.liquids if kind not in found}
        return found


def _placed(problem: Problem, axes: Mapping[str, Axis]) -> Problem:
    """A problem with its place as the person wrote it: an option or a line of the study file."""
    axis = axes.get(problem.override)
    if axis is None:
        return problem
    return copy_of(problem, line=axis.line, override="" if axis.line else axis.source)


def _describe(values: Mapping[str, str]) -> str:
    """``braking.torque 5 kN m, tank.fill 0.5``."""
    return ", ".join(f"{key} {value}" for key, value in values.items())


def _tidy(value: float) -> float:
    """Drop the rounding that a change of units leaves behind (80.00000000000001 km/h)."""
    return float(f"{value:.12g}")
