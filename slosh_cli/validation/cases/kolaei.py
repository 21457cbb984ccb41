"""Table 1 of the paper: the largest force of the liquid on a braked tank, over mass times deceleration."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import sin

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.method import BASE, START
from slosh_cli.scenario import find_packaged, load_tank_scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.tank import modal
from slosh_cli.tank.coefficients import SloshMode, computed_modes, slosh_modes
from slosh_cli.tank.load import frozen_load
from slosh_cli.validation import kernels
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Curve, Panel, curve
from slosh_cli.validation.data_file import CaseData, data_rows

_Choices = Mapping[str, Sequence[SloshMode]]
DURATION = 40.0
_SHOWN = 12.0  # s of it in the figure
_STEP = 0.01
PRINTED, _PAIR = "printed, 1 mode", "computed, 1 mode"


def compute(data: CaseData) -> Outcome:
    """Step and ramp with printed and computed coefficients; only the physically consistent pair decides."""
    found, panels = Findings(data), []
    table = {row["fill_over_radius"]: float(row["max_normalised_force"]) for row in data_rows("table1.csv")}
    for fill, name in data.reference["tanks"].items():
        tank = load_tank_scenario(find_packaged(name)).tank
        mass = frozen_load(tank).mass
        more = data.reference["modes"]
        choices = {
            PRINTED: slosh_modes(tank),
            _PAIR: computed_modes(tank, 1),
            f"computed, {more} modes": computed_modes(tank, more),
        }
        _start(found, fill, choices, mass)
        curves = _largest(found, fill, choices, mass, table[fill])
        panels.append(Panel("time / s", "force over m a", curves, title=f"filled to h/R = {fill}"))
        _bound(found, fill, choices, mass)
    wagon = load_tank_scenario(find_packaged("paper-80-liquid")).tank
    choices = {PRINTED: slosh_modes(wagon), _PAIR: computed_modes(wagon, 1)}
    _bound(found, "1.0 of the wagon's tank", choices, frozen_load(wagon).mass)
    for words, modes in choices.items():
        found.note(f"height lambda_02/lambda_1 of the wagon's tank, {words} / m", modes[0].height)
    return found.outcome(Chart(panels))


def _start(found: Findings, fill: str, choices: _Choices, mass: float) -> None:
    """What does not slosh resists at once."""
    for words, modes in choices.items():
        still = 1.0 - sum(mode.slosh_mass for mode in modes) / mass
        force = normalised_force(modes, mass, found.data.reference["deceleration"], 0.0)[0]
        found.compare(
            f"force over m a as the step begins, fill h/R = {fill}, coefficients {words}",
            float(force),
            still,
            "closed_form",
            _AT_REST,
        )


def _largest(found: Findings, fill: str, choices: _Choices, mass: float, printed: float) -> list[Curve]:
    """Every combination of excitation and coefficients beside the table's value; returns curves of single modes."""
    given, shown = found.data.reference, _times() <= _SHOWN
    curves = [curve("Table 1", [0, _SHOWN], [printed] * 2, exact=True)]
    for ramp in (0.0, given["ramp"]):
        shape = f"{ramp:.1f} s ramp" if ramp else "step"
        for words, modes in choices.items():
            force = normalised_force(modes, mass, given["deceleration"], ramp)
            largest = float(force.max())
            quantity = f"largest force over m a, fill h/R = {fill}, {shape}, coefficients {words}"
            if ramp and words == _PAIR:
                consistent = f"{quantity}: the physically consistent pair (consistent with a {ramp:.1f} s ramp)"
                found.compare(consistent, largest, printed, "table")
            else:
                found.note(quantity, largest, printed)
            if len(modes) == 1:
                exact = _peak(modes[0].slosh_mass / mass, modes[0].frequency, ramp)
                found.compare(f"{quantity}: closed form", largest, exact, "closed_form", _CLOSED)
                curves.append(curve(f"{shape}, {words}", _times()[shown], force[shown]))
    return curves


_AT_REST = "What does not slosh resists at once: 1 - sum of lambda_1^2/(mu m)"
_CLOSED = "Undamped oscillator under a ramp of duration T: 1 + (lambda_1^2/(mu m)) |sin(omega T/2)/(omega T/2)|"


def _times() -> Array:
    return np.asarray(np.arange(round(DURATION / _STEP) + 1) * _STEP)


def normalised_force(modes: Sequence[SloshMode], mass: float, deceleration: float, ramp: float) -> Array:
    """Force of the liquid on the whole tank over m a, every _STEP s, from the kernels that run in a stop.

    The tank moves as prescribed and does not pitch. Trapezoidal rule; steps are 1/300 of the first period.
    """
    liquid = modal.modal_liquid(modes, STANDARD_GRAVITY, 1.0)
    given, half = _deceleration(deceleration, ramp), 0.5 * _STEP
    kernels.move_modes(liquid, 0.0, -given(0.0))
    forces = []
    for time in _times():
        forces.append((kernels.modal_force(liquid) + mass * given(time)) / (mass * deceleration))
        amplitude, rate, second = (values[START] for values in (liquid.amplitude, liquid.rate, liquid.second))
        liquid.amplitude[BASE] = amplitude + _STEP * rate + half**2 * second
        liquid.rate[BASE] = rate + half * second
        kernels.move_modes(liquid, half, -given(time + _STEP))
    return np.array(forces)


def _deceleration(level: float, ramp: float) -> Callable[[float], float]:
    return lambda time: level if ramp == 0.0 else level * min(time / ramp, 1.0)


def _peak(fraction: float, frequency: float, ramp: float) -> float:
    phase = 0.5 * frequency * ramp
    return 1.0 + fraction * (abs(sin(phase) / phase) if phase else 1.0)


def _bound(found: Findings, fill: str, choices: _Choices, mass: float) -> None:
    """The strict bound that the printed coefficients of the half-full tank break."""
    bound = 8 / np.pi**2
    for words in (PRINTED, _PAIR):
        share = choices[words][0].slosh_mass / mass
        found.note(f"slosh mass over liquid mass, h/R = {fill}, {words} (at most 8/pi^2 with flat ends)", share, bound)
