"""Trains with linear couplings: an oscillator, a chain's modes, a brake wave; and friction that takes what it takes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.schema_train import COUPLINGS, Coupling, LinearCoupling
from slosh_cli.solver.run import Run, integrate
from slosh_cli.solver.setup import problem, train_problem
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Curve, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.wagon import point_wagon
from slosh_cli.validation.runs import scenario


def compute(data: CaseData) -> Outcome:
    """Forces of couplings against closed forms, and the ledger of trains with friction couplings."""
    found = Findings(data)
    pair = _pair(found)
    waves = [_brake_wave(found, build_up, known) for build_up, known in data.reference["wave"]["build_ups"]]
    _chain(found)
    _single(found)
    _friction(found)
    return found.outcome(Chart((pair, Panel("coupling, from the front", "largest compression / kN", tuple(waves)))))


def _train(each: Sequence[Scenario], coupling: Coupling) -> Run:
    return integrate(train_problem(each, coupling)[0])


def _linear(stiffness: float, damping: float = 0.0) -> Coupling:
    return Coupling(linear=LinearCoupling(stiffness=stiffness, damping=damping))


def _inertia(one: Scenario) -> float:
    """Mass (kg) of a wagon with what its wheels' spin adds."""
    wagon = point_wagon(one)
    return wagon.mass + wagon.rotating_mass


def _pair(found: Findings) -> Panel:
    """Two vehicles, steps of different brakes: `F = F0 (1 - cos w t)` with the steady force F0."""
    data, given = found.data, found.data.reference["pair"]
    each = [scenario(data.reference["scenario"], *data.reference["point"], *words) for words in given["vehicles"]]
    run = _train(each, _linear(given["stiffness"]))
    masses, brakes = [_inertia(one) for one in each], [8e3 * torque / 0.46 for torque in given["torques"]]
    steady = (masses[1] * brakes[0] - masses[0] * brakes[1]) / sum(masses)
    pulse = np.sqrt(given["stiffness"] * sum(masses) / np.prod(masses))
    time, force = run.rows[:, 0, 0], run.rows[:, 0, -2]
    exact = steady * (1.0 - np.cos(pulse * np.maximum(time - given["onset"], 0.0)))
    largest = float(run.train.couplings.largest[0])
    found.compare("two vehicles, largest force / kN", largest / 1e3, 2e-3 * steady, "force")
    missed = float(np.abs(force - exact).max()) / steady
    found.limit("two vehicles, force against time, largest deviation over the steady force", missed, "history")
    told = slice(None, None, 20)
    curves = (
        curve("oscillator", time, exact / 1e3, exact=True),
        curve("program", time[told], force[told] / 1e3, marks=True),
    )
    return Panel("time / s", "force / kN", curves)


def _chain(found: Findings) -> None:
    """Equal wagons, braked one after the other: every normal mode answers to every onset."""
    data, given = found.data, found.data.reference["chain"]
    onsets = [given["onset"] + given["lag"] * place for place in range(given["count"])]
    words = (*data.reference["point"], *given["words"])
    each = [scenario(data.reference["scenario"], *words, f"braking.onset={onset} s") for onset in onsets]
    run = _train(each, _linear(given["stiffness"], given["damping"]))
    slowing = -8e3 * given["torque"] / 0.46 / _inertia(each[0])
    exact = _chain_compressions(
        run.rows[:, 0, 0], slowing, onsets, np.array([given["stiffness"], given["damping"]]) / _inertia(each[0])
    )
    found_there = run.rows[:, :-1, -1]
    missed = float(np.abs(found_there - exact).max() / np.abs(exact).max())
    found.limit("chain of equal wagons, compressions, largest deviation over the largest", missed, "history")


def _chain_compressions(time: Vector, slowing: float, onsets: Sequence[float], law: Vector) -> Matrix:
    """Compressions (m) of a chain at `time` (n,) s, (n, couplings); `law`: stiffness and damping over a mass."""
    apart = np.diff(np.eye(len(onsets)), axis=0)
    values, shapes = np.linalg.eigh(apart.T @ apart)
    places = np.zeros((len(time), len(onsets)))
    for value, shape in zip(values, shapes.T, strict=True):
        for part, onset in zip(shape, onsets, strict=True):
            t, square, fading = np.maximum(time - onset, 0.0), law[0] * value, 0.5 * law[1] * value
            if value < 1e-9:
                answer = 0.5 * t * t
            else:
                pulse = np.sqrt(square - fading**2)
                swing = np.cos(pulse * t) + fading / pulse * np.sin(pulse * t)
                answer = (1.0 - np.exp(-fading * t) * swing) / square
            places += np.outer(slowing * part * answer, shape)
    return np.asarray(places @ apart.T, dtype=np.float64)


def _brake_wave(found: Findings, build_up: float, known: float) -> Curve:
    """Stiff couplings between equal wagons: `(m/l) a L^2/(8 c T)` in the middle; the extremes along the train."""
    data, given = found.data, found.data.reference["wave"]
    wagon = scenario(data.reference["scenario"], *given["words"])
    mass, length, count = 1e3 * given["mass"], given["length"], given["count"]
    wagon = wagon.with_({"wagon.car_body.mass": wagon.wagon.car_body.mass + mass - _inertia(wagon)})
    torque, ramp = given["slowing"] * mass * 0.46 / 8.0, {"form": "linear", "time": build_up}
    braked = wagon.with_({"braking.torque": torque, "braking.application": ramp})
    each = [braked.with_({"braking.onset": 0.5 + (place + 0.5) * length / given["speed"]}) for place in range(count)]
    largest = _train(each, _linear(given["stiffness"], given["damping"])).train.couplings.largest / 1e3
    label = f"brake wave, stiff couplings, build-up in {build_up:g} s: largest compression"
    found.compare(f"{label} / kN", float(largest.max()), known, "wave")
    middle = float(np.argmax(largest) + 1 - count / 2)
    found.limit(f"{label}: couplings from the middle", middle, "place")
    return curve(f"build-up in {build_up:g} s", np.arange(1, count), largest, marks=True)


def _single(found: Findings) -> None:
    """A train of one is the wagon."""
    one = scenario(found.data.reference["scenario"], *found.data.reference["alone"])
    alone, train = integrate(problem(one)).rows, _train((one,), COUPLINGS["screw"]).rows
    same = "yes" if np.array_equal(alone, train[:, :, : alone.shape[2]]) else "no"
    found.verdict("a train of one vehicle has every digit of the wagon", same, "yes")


def _friction(found: Findings) -> None:
    """Ledgers with friction couplings, slosh, wheels that lock; what the couplings took."""
    given = found.data.reference["friction"]
    for name in given["couplings"]:
        each = [
            scenario(
                given["scenario"], *given["words"], *words, f"braking.onset={given['onset'] + given['lag'] * place} s"
            )
            for place, words in enumerate(given["vehicles"])
        ]
        train = _train(each, COUPLINGS[name]).train
        locked = max(float(vehicle.account.locked_time.max()) for vehicle in train.vehicles)
        found.verdict(f"{name}: a wheel locks", "yes" if locked > 0.0 else "no", "yes")
        found.limit(f"{name}: energy ledger, largest residual", train.largest_residual, "ledger")
        least = min(float(train.couplings.taken.min()), 0.0)
        found.limit(f"{name}: energy that a coupling gave beyond what it had stored / J", least, "given_back")
