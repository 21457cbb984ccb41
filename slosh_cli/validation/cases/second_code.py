"""The wagon with its slosh mode in a second code, exudyn; runs only where the extra `validation` is installed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.result import Result
from slosh_cli.tank.coefficients import slosh_modes
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.exudyn_wagon import Histories, exudyn_stop
from slosh_cli.validation.runs import stop


@dataclass(frozen=True, eq=False)
class Pair:
    """One history by both programs, at the program's output times, and what differences are measured by."""

    name: str
    unit: str
    time: Array
    ours: Array
    theirs: Array
    scale: float

    @property
    def label(self) -> str:
        """Name and unit, for an axis."""
        return f"{self.name} / {self.unit}"

    @property
    def deviation(self) -> float:
        """Largest difference over the scale."""
        return float(np.abs(self.ours - self.theirs).max() / self.scale)


def compute(data: CaseData) -> Outcome:
    """Gentle braking with all finite motions decides, and the paper's torque with a linear slosh body."""
    found = Findings(data)
    given = data.reference
    gentle = _pairs(data, given["gentle_torque"], linear=False)
    for pair in gentle:
        found.limit(f"{pair.name}, {given['gentle_torque']}", pair.deviation, "histories")
    linear = _pairs(data, given["paper_torque"], linear=True)
    for pair in linear:
        found.limit(f"{pair.name}, {given['paper_torque']}, linear slosh body", pair.deviation, "histories")
    for pair in _pairs(data, given["paper_torque"], linear=False):
        found.note(f"{pair.name}, {given['paper_torque']}, finite motions", pair.deviation)
    panels = []
    for pair in (linear[1], linear[4], linear[-1]):
        lines = (curve("exudyn", pair.time, pair.theirs, exact=True), curve("slosh", pair.time, pair.ours))
        panels.append(Panel("time / s", pair.label, lines, title=given["paper_torque"]))
    return found.outcome(Chart(panels))


def _pairs(data: CaseData, torque: str, *, linear: bool) -> list[Pair]:
    result = stop(data.reference["scenario"], *data.reference["overrides"], f"braking.torque={torque}")
    (mode,) = slosh_modes(result.scenario.tank)
    duration = float(result.time[-1])
    return _paired(result, exudyn_stop(result.scenario, mode, duration, data.reference["step"], linear=linear))


def _paired(result: Result, second: Histories) -> list[Pair]:
    def pair(name: str, unit: str, channel: str, theirs: Array, scale: float) -> Pair:
        at_ours = np.interp(result.time, second.time, theirs)
        return Pair(name, unit, result.time, result.channels[channel], at_ours, scale)

    pairs = [pair("speed", "m/s", "speed", second.speed, result.initial_speed_m_s)]
    for i in WHEELS:
        load = result.static_wheel_load_N[i - 1]
        pairs.append(pair(f"load of wheel {i}", "N", wheel(i, "normal_force"), second.loads[:, i - 1], load))
    pairs.append(pair("car heave", "m", "car_heave", second.heave, float(np.abs(second.heave).max())))
    pairs.append(pair("car pitch", "rad", "car_pitch", second.pitch, float(np.abs(second.pitch).max())))
    amplitude = second.amplitude
    pairs.append(pair("slosh amplitude", "m", "slosh_1_amplitude", amplitude, float(np.abs(amplitude).max())))
    return pairs
