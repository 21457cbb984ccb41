"""A single wave under a wheel on a rigid rail gives the closed form; a spectrum realises its variance."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.result import Result
from slosh_cli.scenario import Unevenness
from slosh_cli.track.spectrum import spectral_lines
from slosh_cli.track.surface import rolling_surface
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.runs import stop

_SETTLED = 40.0
"""The wave has been whole for long from here on, m."""
_FORMS = {"fra": (0.0, 0.8245), "erri": (0.0206, 0.8246)}
"""Corner wave numbers w_r and w_c, rad/m."""
_LEVELS = {
    "fra-1": 0.25 * 1.2107e-4, "fra-2": 0.25 * 1.0181e-4, "fra-3": 0.25 * 0.6816e-4, "fra-4": 0.25 * 0.5376e-4,
    "fra-5": 0.25 * 0.2095e-4, "fra-6": 0.25 * 0.0339e-4, "erri-low": 4.032e-7, "erri-high": 1.080e-6,
}  # fmt: skip
"""A of the one-sided density `A w_c^2/((Omega^2 + w_r^2)(Omega^2 + w_c^2))`, m rad."""


def compute(data: CaseData) -> Outcome:
    """Load amplitudes over single waves, variances over whole repeats, levels in D1."""
    found, given, lengths, ours, exact = Findings(data), data.reference, [], [], []
    for short, long in given["waves"]:
        words = f"{{spectrum: {given['level']}, seed: 1, lines: 1, wavelengths: [{short} m, {long} m]}}"
        result = stop(given["scenario"], *given["soft"], f"track.unevenness={words}")
        wave, phase, amplitude, expected = _response(result)
        lengths.append(2.0 * np.pi / wave)
        ours.append(amplitude / 1e3)
        exact.append(expected / 1e3)
        label = f"{lengths[-1]:.3g} m"
        found.compare(f"load amplitude over waves of {label} / kN", amplitude / 1e3, expected / 1e3, "response")
        found.compare(f"load in phase with waves of {label}, cosine + 2", 2.0 + np.cos(phase), 1.0, "response")
    for name, level in given["levels"].items():
        rail = Unevenness(spectrum=name, seed=1)
        found.compare(f"variance over whole repeats, {name} / mm^2", 1e6 * float(np.var(_repeat(rail))),
                      1e6 * _integral(name, *rail.wavelengths), "variance")  # fmt: skip
        found.compare(f"standard deviation in D1, {name} / mm", 1e3 * _in_d1(rail), float(level), "level")
    curves = [curve("closed form", lengths, exact, exact=True), curve("program", lengths, ours, marks=True)]
    return found.outcome(Chart((Panel("wavelength / m", "load amplitude / kN", curves),)))


def _response(result: Result) -> tuple[float, float, float, float]:
    """Wave number, phase and amplitude (N) of the leading wheel's load over the wave, amplitude of the closed form."""
    rail = result.scenario.track.unevenness
    assert rail is not None
    (wave,), (height,), (start,) = spectral_lines(rail)
    settled = result.channels["position"] > _SETTLED
    place = result.channels["position"][settled] + _ahead(result)
    load = result.channels["wheel_1_normal_force"][settled]
    turn = wave * place + start
    cosine, sine, _ = np.linalg.lstsq(
        np.column_stack([np.cos(turn), np.sin(turn), np.ones_like(turn)]), load, rcond=None
    )[0]
    mass, radian = 0.5 * result.scenario.wagon.wheelset.mass, wave * result.initial_speed_m_s
    hertz = result.scenario.contact.stiffness
    assert hertz is not None
    stiffness = 1.5 * hertz ** (2 / 3) * result.static_wheel_load_N[0] ** (1 / 3)
    inertia = mass * radian**2
    return float(wave), float(np.arctan2(-sine, cosine)), float(np.hypot(cosine, sine)), float(
        inertia * height / (1.0 - inertia / stiffness)
    )  # fmt: skip


def _ahead(result: Result) -> float:
    wagon = result.scenario.wagon
    return 0.5 * (wagon.pivot_spacing + wagon.bogie.wheelbase)


def _repeat(rail: Unevenness) -> Array:
    """Heights (m) of the program's rail over a whole repeat, behind the smooth start."""
    number, _, _ = spectral_lines(rail)
    places = 50.0 + np.linspace(0.0, 2.0 * np.pi / float(number[1] - number[0]), 20_001)[:-1]
    return rolling_surface(rail, (), np.zeros(4), 0.46).levels(places)


def _in_d1(rail: Unevenness) -> float:
    """Standard deviation (m) of what is between 3 m and 25 m in a repeat of the rail, by its discrete spectrum."""
    heights = _repeat(rail)
    number, _, _ = spectral_lines(rail)
    carrier, spacing = float(number[0]), float(number[1] - number[0])
    places = 50.0 + 2.0 * np.pi / spacing * np.arange(heights.size) / heights.size
    # the lines stand at `carrier + k spacing`: moved down by the carrier they are whole numbers of waves
    lines = 2.0 * np.abs(np.fft.fft(heights * np.exp(-1j * carrier * places))[: heights.size // 2]) / heights.size
    length = 2.0 * np.pi / (carrier + spacing * np.arange(lines.size))
    return float(np.sqrt(0.5 * np.sum(lines[(length >= 3.0) & (length <= 25.0)] ** 2)))


def _integral(name: str, short: float, long: float) -> float:
    """Variance (m^2) of a spectrum between two wavelengths (m), by quadrature."""
    from scipy.integrate import quad

    lower, upper = _FORMS[name.partition("-")[0]]

    def density(number: float) -> float:
        return _LEVELS[name] * upper**2 / ((number**2 + lower**2) * (number**2 + upper**2))

    return float(quad(density, 2.0 * np.pi / long, 2.0 * np.pi / short, epsrel=1e-12)[0])
