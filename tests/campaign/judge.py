"""What every run is held to (theory section 9), and what two runs that differ in one thing must tell of it.

A run is refused with a reason, or it ends with a status. Then nothing in it is infinite or undefined, its ledger
closes, no wheel turns backwards or pulls at the rail, the liquid keeps its mass. Of a part of the runs more is asked:
the distance of a run at a hundredth of the tolerance, of a stronger brake, of more resistance, of a mirrored tank.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import patch

import numpy as np

from slosh_cli.errors import SloshError
from slosh_cli.results import simulate as simulation
from slosh_cli.results.protection import PROTECTION
from slosh_cli.results.result import Result, Status
from slosh_cli.results.train_result import TrainResult
from slosh_cli.scenario import Scenario
from slosh_cli.solver.run import Cancelled
from slosh_cli.solver.setup import ReadyStop
from slosh_cli.tank.cells import CellLiquid

from .trains import train_of
from .wagons import Overrides, scenario_of

LEDGER, LEDGER_LIFTED = 1e-4, 1e-3
"""What a ledger may miss of the initial kinetic energy, with wheels on the rail and with wheels that lifted."""
FALLING = 0.5
"""A ledger that misses more than `LEDGER` after a lift misses at most this part of it at a tenth of the tolerance."""
FINER = 0.01
"""Of the tolerance: the run that a distance is compared with."""
TOLD = 3.0
"""So many times as far off may a distance be as its run says, where slide protection decides."""
FASTER_THAN_TRAIN = 1e-4
"""A braked wheel may run so much faster than the wagon."""
MASS = 1e-9
"""What a liquid's mass may change."""
MIRRORED = 1e-6
"""What a mirrored tank may differ, of the largest force."""
PATIENCE = 60.0
"""Seconds of processor time that a run may take in silence."""
LONGEST = 240.0
"""Seconds of processor time after which a run is given up."""
LONGEST_OTHER = 20.0
"""The same of runs for comparison, which are not judged themselves."""
UNSOLVED = ("no step", "lock and release", "became infinite")
"""What the reasons of runs say that came to no end: nobody's wagon is to blame for it."""


@dataclass(frozen=True)
class Violation:
    """A run that breaks what it is held to: what, by how much, beside which limit."""

    kind: str
    value: float
    limit: float
    told: str = ""

    def __str__(self) -> str:
        return f"{self.kind}: {self.value:.3g} beside {self.limit:.3g}{f' ({self.told})' if self.told else ''}"


@dataclass
class Verdict:
    """How the run of a seed ended, what was looked at, what it breaks."""

    seed: int
    outcome: str = ""
    looked_at: list[str] = field(default_factory=list)
    violations: list[Violation] = field(default_factory=list)
    traits: dict[str, float] = field(default_factory=dict)
    seconds: float = 0.0

    def hold(self, kind: str, value: float, limit: float, told: str = "") -> None:
        """Look at a value that must be at most its limit; what is undefined is not."""
        self.looked_at.append(kind)
        if not value <= limit:
            self.violations.append(Violation(kind, float(value), limit, told))


class _Watch:
    """Progress and cancel of a run in one: how long it was silent, and when to give it up."""

    def __init__(self, longest: float) -> None:
        self.longest = longest
        self.begun = self.heard = time.process_time()
        self.silence = 0.0

    def __call__(self, fraction: float, speed: float) -> None:
        now = time.process_time()
        self.silence, self.heard = max(self.silence, now - self.heard), now

    def is_set(self) -> bool:
        return time.process_time() - self.begun > self.longest


@dataclass(frozen=True)
class _Ran:
    result: Any
    stops: tuple[ReadyStop, ...]
    watch: _Watch
    masses: list[float]
    """Mass of each vehicle's moving liquid at the start, kg; zero where it is not in cells."""


def _run(scenario: Any, longest: float = LONGEST_OTHER) -> _Ran:
    """Simulate a wagon or a train, watched."""
    alone = isinstance(scenario, Scenario)
    name, run = ("problem", simulation.simulate) if alone else ("train_problem", simulation.simulate_train)
    made: list[ReadyStop] = []
    masses: list[float] = []
    build: Callable[..., Any] = getattr(simulation, name)

    def building(*given: Any) -> Any:
        found = build(*given)
        made.extend([found] if alone else found)
        masses.extend(_mass(stop) for stop in made)
        return found

    with patch.object(simulation, name, building):
        watch = _Watch(longest)
        result = run(scenario, progress=watch, cancel=watch)
    return _Ran(result, tuple(made), watch, masses)


def _mass(stop: ReadyStop) -> float:
    liquid = stop.vehicle.liquid
    if not isinstance(liquid, CellLiquid):
        return 0.0
    shallow = liquid.shallow
    return float(shallow.density * shallow.spacing * liquid.start.area.sum())


def judge_wagon(seed: int, overrides: Overrides, thorough: bool = True) -> Verdict:
    """Run a wagon and judge it; `thorough` compares it with other runs."""
    return _judged(seed, lambda: scenario_of(overrides), thorough)


def judge_train(seed: int, overrides: Overrides, thorough: bool = True) -> Verdict:
    """The same of a train."""
    return _judged(seed, lambda: train_of(overrides), thorough)


def _judged(seed: int, make: Callable[[], Any], thorough: bool) -> Verdict:
    verdict, begun = Verdict(seed), time.process_time()
    try:
        scenario = make()
        ran = _run(scenario, LONGEST)
        _judge_run(verdict, ran)
        if thorough:
            _compare(verdict, scenario, ran)
    except SloshError as refused:
        verdict.outcome = verdict.outcome or f"refused: {str(refused).splitlines()[-1][:90]}"
    except Cancelled:
        if verdict.outcome:
            verdict.looked_at.append("a run for comparison was given up")
        else:
            verdict.outcome = "given up"
            verdict.violations.append(Violation("takes too long", time.process_time() - begun, LONGEST))
    except Exception as error:
        verdict.outcome = "exception"
        verdict.violations.append(Violation("exception", 1.0, 0.0, repr(error)[:200]))
    verdict.seconds = time.process_time() - begun
    return verdict


def _vehicles(result: Any) -> tuple[Any, ...]:
    return result.vehicles if isinstance(result, TrainResult) else (result,)


def _lifted(ran: _Ran) -> bool:
    return any(stop.vehicle.account.lifted for stop in ran.stops)


def _judge_run(verdict: Verdict, ran: _Ran) -> None:
    result, lifted = ran.result, _lifted(ran)
    verdict.outcome = str(result.status)
    verdict.traits |= {
        "residual": result.energy_residual,
        "steps": float(result.steps),
        "lifted": float(lifted),
        "locked": max(max(one.locked_time_s) for one in _vehicles(result)),
        "distance": result.braking_distance_m or math.nan,
        "silence": ran.watch.silence,
    }
    if result.status is Status.FAILED:
        verdict.outcome += f": {result.reason[:40]}"
        unsolved = any(words in result.reason for words in UNSOLVED)
        verdict.hold("comes to an end", float(unsolved), 0.0, result.reason[:100])
    else:
        verdict.hold(
            "ledger, lifted" if lifted else "ledger", result.energy_residual, LEDGER_LIFTED if lifted else LEDGER
        )
    verdict.hold("status has its answer", float((result.status is Status.STOPPED) != (result.reason == "")), 0.0)
    verdict.hold("heard of while it runs", ran.watch.silence, PATIENCE)
    verdict.hold("finite", _undefined(result), 0.0)
    for one, stop in zip(_vehicles(result), ran.stops, strict=True):
        _judge_wheels(verdict, result, one, stop)
    changed = [abs(_mass(stop) / before - 1.0) for stop, before in zip(ran.stops, ran.masses, strict=True) if before]
    if changed:
        verdict.hold("mass of the liquid", max(changed), MASS)


def _undefined(result: Any) -> float:
    """How many values of all histories and answers are infinite or undefined."""
    arrays = [result.time, *(values for one in _vehicles(result) for values in one.channels.values())]
    numbers = [result.energy_residual, *(one.max_surface_m for one in _vehicles(result))]
    numbers += [] if result.braking_distance_m is None else [result.braking_distance_m, result.braking_time_s]
    return float(sum(np.count_nonzero(~np.isfinite(values)) for values in [*arrays, np.array(numbers)]))


def _judge_wheels(verdict: Verdict, result: Any, one: Any, stop: ReadyStop) -> None:
    """No wheel turns against its wagon or pulls at the rail; once braked it does not run ahead of it."""
    channels, speed = one.channels, one.channels["speed"]
    rolling = np.array([channels[f"wheel_{i}_speed"] for i in range(1, 5)])
    loads = np.array([channels[f"wheel_{i}_normal_force"] for i in range(1, 5)])
    braked = result.time >= one.scenario.braking.onset
    floor = np.minimum(speed, 0.0)
    verdict.hold("wheel backwards", float((floor - rolling).max()), 1e-6 if isinstance(result, TrainResult) else 0.0)
    verdict.hold("tension at the rail", float(-loads.min()), 0.0)
    if braked.any() and isinstance(result, Result):
        creep = np.array([channels[f"wheel_{i}_tangential_force"] for i in range(1, 5)])[:, braked]
        # without a brake that presses, resistance slows the wagon, and the rail its wheels, which then run ahead
        ahead = np.where(creep > 0.0, rolling[:, braked] - speed[braked] * (1.0 + FASTER_THAN_TRAIN), 0.0)
        verdict.hold("wheel ahead of its wagon", float(ahead.max()), 1e-9)


def _compare(verdict: Verdict, scenario: Any, ran: _Ran) -> None:
    """Hold the run against others that differ in one thing."""
    if ran.result.status is not Status.STOPPED:
        return
    solver = scenario.vehicles[0].solver if isinstance(ran.result, TrainResult) else scenario.solver
    if isinstance(scenario, Scenario):
        for kind, other in (*_stronger(scenario, ran), *_same(scenario)):
            _compare_other(verdict, kind, scenario, other, ran)
    _compare_ledger(verdict, scenario, ran, solver.tolerance)
    _compare_finer(verdict, scenario, ran, solver.tolerance)


def _at(scenario: Any, tolerance: float) -> Any:
    prefix = "" if isinstance(scenario, Scenario) else "all."
    return scenario.with_({f"{prefix}solver.tolerance": tolerance})


def _distance(result: Any) -> float:
    """The distance; infinite of a wagon that did not stop, undefined of one that has none."""
    if result.braking_distance_m is not None:
        return float(result.braking_distance_m)
    return math.inf if result.status is Status.TIME_LIMIT else math.nan


def _compare_ledger(verdict: Verdict, scenario: Any, ran: _Ran, tolerance: float) -> None:
    residual = ran.result.energy_residual
    if _lifted(ran) and residual > LEDGER:
        finer = _run(_at(scenario, 0.1 * tolerance)).result.energy_residual
        verdict.hold("ledger falls with the tolerance", finer, FALLING * residual)


def _compare_finer(verdict: Verdict, scenario: Any, ran: _Ran, tolerance: float) -> None:
    finer = _distance(_run(_at(scenario, FINER * tolerance)).result)
    flowing = any(isinstance(stop.vehicle.liquid, CellLiquid) for stop in ran.stops)
    said = [one for one in _vehicles(ran.result)[0].checks if one.name == PROTECTION]
    protected, told = bool(said), [one.value for one in said if not one.within]
    apart = {"cells": flowing, "lifted": _lifted(ran), "slide protection at work": protected}
    sort = "".join(f", {name}" for name, is_so in apart.items() if is_so)
    # a distance is told where the stop speed is passed, not nearer than a hundredth of a millimetre
    miss = max(abs(_distance(ran.result) - finer) - 1e-5, 0.0) / finer
    verdict.traits["miss"] = miss
    words = f"{finer:.6g} m, locked {verdict.traits['locked']:.3g} s"
    if told:  # the run says itself how far it is off
        verdict.hold("distance of a finer run, told by the run", miss, TOLD * told[0], words)
    else:
        verdict.hold(f"distance of a finer run{sort}", miss, tolerance, words)


def _compare_other(verdict: Verdict, kind: str, scenario: Scenario, changes: Mapping[str, Any], ran: _Ran) -> None:
    """A run that must stop no later than another (`kind` begins with "no longer"), or in the same distance."""
    found, own = _distance(_run(scenario.with_(changes)).result), _distance(ran.result)
    if kind.startswith("no longer"):
        verdict.hold(kind, found / own - 1.0, scenario.solver.tolerance, str(changes)[:80])
    else:
        verdict.hold(kind, abs(found / own - 1.0), MIRRORED, str(changes)[:80])


def _stronger(scenario: Scenario, ran: _Ran) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """A brake 5 % stronger, a resistance 20 % larger: of a load that does not move, and below saturation."""
    if scenario.tank.liquid.model != "rigid" or max(ran.result.locked_time_s) > 0.0 or _lifted(ran):
        return
    if scenario.braking.slide_protection is not None:
        return  # what it lets go follows samples, not the force
    if _creepage(ran.result) < 0.05:
        yield "no longer with a stronger brake", _stronger_brake(scenario)
    if scenario.braking.braked_weight is not None:
        return  # which tells the distance with the resistance: the more of it, the weaker the brake
    resistance = scenario.wagon.running_resistance
    yield "no longer with more resistance", {"wagon.running_resistance.constant": 1.2 * resistance.constant + 100.0}


def _creepage(result: Result) -> float:
    fast = result.channels["speed"] > 1.0
    return max(
        (float(result.channels[f"wheel_{i}_creepage"][fast].max()) for i in range(1, 5) if fast.any()), default=0.0
    )


def _stronger_brake(scenario: Scenario) -> Mapping[str, Any]:
    braking = scenario.braking
    keys = {"torque": braking.torque, "deceleration": braking.deceleration}
    keys |= {"blocks.force": braking.blocks.force if braking.blocks else None}
    keys |= {"discs.force": braking.discs.force if braking.discs else None}
    keys |= {"braked_weight.percentage": braking.braked_weight.percentage if braking.braked_weight else None}
    return {f"braking.{key}": 1.05 * value for key, value in keys.items() if value is not None}


def _same(scenario: Scenario) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """What must change nothing: a tank mirrored left to right, its corners told from another one on; other rows."""
    yield "same with other rows", {"output.interval": 0.05}
    if scenario.tank.shape == "polygon":
        points = scenario.tank.points
        mirrored = [[-y, z] for y, z in points[2:] + points[:2]]
        yield "same with a mirrored section", {"tank.points": mirrored}
