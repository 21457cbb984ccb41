"""The liquid of a swayed tank beside published measurements: centre of mass, free decay, wave heights, a bore."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np

from slosh_cli.arrays import Array, Vector
from slosh_cli.scenario import Tank, find_packaged, load_any_scenario
from slosh_cli.solver.deceleration import Deceleration
from slosh_cli.solver.excite import Excitation, excite
from slosh_cli.tank.coefficients import tank_modes
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData

_POINTS = 60
"""Points of a motion in a period."""


def compute(data: CaseData) -> Outcome:
    """The figures that the case carries of four experiments."""
    found, panels = Findings(data), []
    for part in (_forced, _decay, _waves, _bore):
        panels.append(part(found, data.reference))
    return found.outcome(Chart(panels))


def swayed(reference: Any, amplitude: float, ratio: float) -> tuple[float, float]:
    """Amplitude (per cent of the length) and phase (degrees) of the centre of mass of the liquid in the sway tank.

    The tank sways as `amplitude` (per cent of its length) times the sine, at `ratio` of the first frequency.
    """
    tank = _tank(reference["sway_tank"], "modal")
    omega = ratio * tank_modes(tank, 1).modes[0].frequency
    lasting = 2 * pi / omega * round(reference["settled"] * omega / (2 * pi))
    run = _moved(tank, lambda t: np.sin(omega * t) * amplitude / 100 * tank.length, 2 * pi / omega, lasting)
    last = run.time > lasting - 20 * pi / omega
    angle, moved = omega * run.time[last], run.watched.shift[last] / tank.length
    sine, cosine = np.linalg.lstsq(np.column_stack([np.sin(angle), np.cos(angle)]), moved, rcond=None)[0]
    return 100 * float(np.hypot(sine, cosine)), float(np.degrees(np.arctan2(cosine, sine)))


def decayed(reference: Any) -> tuple[float, Excitation]:
    """Frequency (rad/s) of the sway tank's liquid that a short pulse woke and that is left to itself; its history."""
    tank = _tank(reference["sway_tank"], "modal")
    pulse = Deceleration.table([(0.0, 0.0), (0.1, 0.1), (0.2, 0.0)])
    run = excite(tank, pulse, 20.0, 0.01)
    moved = run.watched.shift
    rising = np.flatnonzero((moved[:-1] < 0.0) & (moved[1:] >= 0.0))
    crossings = run.time[rising] - moved[rising] * np.diff(run.time)[rising] / np.diff(moved)[rising]
    return 2 * pi * (crossings.size - 1) / float(crossings[-1] - crossings[0]), run


def wave_height(reference: Any, model: str, times: Vector) -> Vector:
    """Wave height (m) at the probe of the 1.73 m tank at `times` (s), by a liquid's `model`."""
    given = reference["waves"]
    omega = 2 * pi / given["period"]
    run = _moved(
        _tank(given, model),
        lambda t: given["amplitude"] * np.cos(omega * t),
        given["period"],
        float(times.max()) + 0.1,
        given["probe"],
    )
    return np.interp(times, run.time, run.watched.probes[:, 0])


def bore_height(reference: Any, periods: Vector, model: str = "shallow-water") -> Callable[[float], Vector]:
    """Wave heights (m) at the probe of the shallow tank at `periods`, read later by a part of a period."""
    given = reference["bore"]
    tank = _tank(given, model)
    period = 2 * pi / (given["ratio"] * tank_modes(tank, 1).modes[0].frequency)
    run = _moved(
        tank,
        lambda t: given["amplitude"] * np.sin(2 * pi / period * t),
        period,
        (float(periods.max()) + 0.2) * period,
        given["probe"],
    )
    return lambda later: np.interp((periods + later) * period, run.time, run.watched.probes[:, 0])


def best_phase(read: Callable[[float], Vector], heights: Vector) -> tuple[float, float]:
    """Root mean square miss (m) of the bore's `heights` (m) with the phase that fits best, and that phase (periods)."""
    return min((rms(read(later) - heights), float(later)) for later in np.arange(-0.05, 0.0501, 0.005))


def rms(values: Array) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def _forced(found: Findings, reference: Any) -> Panel:
    amplitudes, ratios, moved, phases = np.array(reference["forced"]).T
    calculated = []
    for amplitude, ratio, measured, phase in zip(amplitudes, ratios, moved, phases, strict=True):
        percent, degrees = swayed(reference, amplitude, ratio)
        calculated.append(percent)
        name = f"swayed by {amplitude:g} % at {ratio:g} omega_1"
        found.compare(f"centre of mass, {name} / % of the length", percent, measured, "forced", _BAEUERLEIN)
        found.compare(f"phase, {name} / degrees", degrees, phase, "phase", _BAEUERLEIN)
    curves = (curve("measured", ratios, moved, exact=True, marks=True), curve("modal", ratios, calculated, marks=True))
    return Panel("frequency over omega_1", "centre of mass / % of the length", curves, title="swayed")


def _decay(found: Findings, reference: Any) -> Panel:
    frequency, run = decayed(reference)
    for measured in reference["decay_frequencies"]:
        found.compare(f"free decay beside {measured} rad/s / rad/s", frequency, measured, "decay", _BAEUERLEIN)
    tank = _tank(reference["sway_tank"], "modal")
    shown = curve("modal", run.time, 100 * run.watched.shift / tank.length)
    return Panel("time / s", "centre of mass / % of the length", (shown,), title="free decay")


def _waves(found: Findings, reference: Any) -> Panel:
    times, heights = np.array(reference["waves"]["heights"]).T
    linear = wave_height(reference, "modal", times)
    found.limit("rms at 1.73 m, linear theory / m", rms(linear - heights), "waves", _FALTINSEN)
    found.note("rms at 1.73 m, shallow water / m", rms(wave_height(reference, "shallow-water", times) - heights))
    dispersed = wave_height(reference, "dispersion", times)
    found.limit("rms at 1.73 m, with dispersion / m", rms(dispersed - heights), "waves_dispersed", _FALTINSEN)
    found.note("trough at 1.73 m, linear theory / m", float(linear.min()), float(heights.min()), _FALTINSEN)
    every = np.linspace(0.0, float(times.max()), 400)
    curves = (
        curve("measured", times, heights, exact=True, marks=True),
        curve("modal", every, wave_height(reference, "modal", every)),
        curve("with dispersion", every, wave_height(reference, "dispersion", every)),
    )
    return Panel("time / s", "wave height / m", curves, title="1.73 m long, 0.6 m deep")


def _bore(found: Findings, reference: Any) -> Panel:
    periods, heights = np.array(reference["bore"]["heights"]).T
    miss, later = best_phase(bore_height(reference, periods), heights)
    found.limit("rms of the bore / m", miss, "bore", _BOUSCASSE)
    dispersed, _ = best_phase(bore_height(reference, periods, "dispersion"), heights)
    found.limit("rms of the bore with dispersion / m", dispersed, "bore_dispersed", _BOUSCASSE)
    found.limit("part of a period by which the bore is early", later, "bore_phase", _BOUSCASSE)
    every = np.linspace(float(periods.min()), float(periods.max()), 600)
    shown = bore_height(reference, every)(later)
    peak, measured = float(shown.max()), float(heights.max())
    found.note("peak of the bore / m", peak, measured, _BOUSCASSE)
    curves = (curve("measured", periods, heights, exact=True, marks=True), curve("shallow water", every, shown))
    return Panel("time over period", "wave height / m", curves, title="1 m long, 0.03 m deep")


_BAEUERLEIN = "B. Baeuerlein and K. Avila, J. Fluid Mech. 925 (2021) A22"
_FALTINSEN = "O. M. Faltinsen et al., J. Fluid Mech. 407 (2000) 201"
_BOUSCASSE = "B. Bouscasse et al., Int. J. Nonlin. Sci. Num. Sim. 14 (2013) 123"


def _tank(given: Any, model: str) -> Tank:
    """A box from its description in the data file, with the liquid's `model`; `dispersion` is shallow water's."""
    kind = "shallow-water" if model == "dispersion" else model
    liquid = f"{{model: {kind}, {given[kind]}, dispersion: {'on' if kind != model else 'off'}}}"
    modes = ", modes: 5" if model == "modal" else ""
    words = f"tank={{shape: rectangular, {given['box']}, liquid: {liquid}{modes}}}"
    return load_any_scenario(find_packaged("kolaei-half"), [words]).tank


def _moved(
    tank: Tank, course: Callable[[Vector], Vector], period: float, duration: float, *probes: float
) -> Excitation:
    """The tank displaced (m) by `course` of time (s) from rest through `duration` (s)."""
    times = np.linspace(0.0, duration, round(_POINTS * duration / period) + 1)
    motion = Deceleration.of_motion("displacement_m", times, course(times), at_rest=True)
    return excite(tank, motion, duration, period / _POINTS, probes)
