"""Spectra of the longitudinal level of railway track, and their lines (theory section 15).

Every spectrum here is one-sided, S(Omega) in m^3/rad over the wave number Omega in rad/m: the variance is the integral
of S over Omega > 0. All have the form `S = A w_c^2/((Omega^2 + w_r^2)(Omega^2 + w_c^2))`. The vertical profile of FRA
track classes, `0.25 A_v w_c^2/((Omega^2 + w_c^2) Omega^2)`, is that with w_r = 0; another form that is published by the
name of the FRA gives other levels. ERRI B176 has low and high disturbance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from slosh_cli.arrays import Array, Vector
from slosh_cli.scenario import Unevenness
from slosh_cli.scenario.schema_line import LEVEL_BAND


class _Form(NamedTuple):
    """A (m rad) and the corner wave numbers w_r, w_c (rad/m) of a spectrum."""

    level: float
    lower: float
    upper: float


_FRA_LEVELS = (1.2107e-4, 1.0181e-4, 0.6816e-4, 0.5376e-4, 0.2095e-4, 0.0339e-4)
"""A_v of the classes 1 to 6, m^2 rad/m."""
_FORMS = {
    **{f"fra-{number}": _Form(0.25 * level, 0.0, 0.8245) for number, level in enumerate(_FRA_LEVELS, 1)},
    "erri-low": _Form(4.032e-7, 0.0206, 0.8246),
    "erri-high": _Form(1.080e-6, 0.0206, 0.8246),
}


def variance(name: str, shortest: float, longest: float) -> float:
    """Variance (m^2) of a spectrum between two wavelengths (m), in closed form."""
    form, low, high = _FORMS[name], 2.0 * np.pi / longest, 2.0 * np.pi / shortest

    def primitive(corner: float) -> float:
        """Integral of 1/(Omega^2 + corner^2)."""
        if corner == 0.0:
            return 1.0 / low - 1.0 / high
        return float(np.arctan(high / corner) - np.arctan(low / corner)) / corner

    part = primitive(form.lower) - primitive(form.upper)
    return float(form.level * form.upper**2 / (form.upper**2 - form.lower**2) * part)


def _density(form: _Form, number: Vector) -> Array:
    """One-sided density (m^3/rad) at wave numbers (rad/m)."""
    squares = number**2
    found: Array = form.level * form.upper**2 / ((squares + form.lower**2) * (squares + form.upper**2))
    return found


def spectral_lines(unevenness: Unevenness) -> tuple[Vector, Vector, Vector]:
    """Wave numbers (rad/m), amplitudes (m) and phases (rad) of the lines of a spectrum, each (lines,).

    Line k stands in the middle of its interval: `z = sum sqrt(2 S dOmega) cos(Omega_k x + phase_k)`.
    """
    shortest, longest = unevenness.wavelengths
    low, high = 2.0 * np.pi / longest, 2.0 * np.pi / shortest
    spacing = (high - low) / unevenness.lines
    number = low + spacing * (np.arange(unevenness.lines, dtype=np.float64) + 0.5)
    name, scale = unevenness.spectrum, 1.0
    if unevenness.sigma is not None:
        name = {"erri": "erri-low", "fra": "fra-6"}[unevenness.shape]
        scale = unevenness.sigma**2 / variance(name, *LEVEL_BAND)
    assert name is not None
    amplitude: Vector = np.sqrt(2.0 * scale * _density(_FORMS[name], number) * spacing)
    phase = 2.0 * np.pi * np.random.Generator(np.random.PCG64(unevenness.seed)).random(unevenness.lines)
    return number, amplitude, phase


def realised_level(unevenness: Unevenness | None, way: float | None = None) -> float | None:
    """Standard deviation (m) in D1, wavelengths of 3 m to 25 m, of a spectrum's lines.

    Over their whole repeats, or over a `way` (m) from the start. None where the rail has no spectrum.
    """
    if unevenness is None or (unevenness.sigma is None and unevenness.spectrum is None):
        return None
    number, amplitude, phase = spectral_lines(unevenness)
    length = 2.0 * np.pi / number
    inside = (LEVEL_BAND[0] <= length) & (length <= LEVEL_BAND[1])
    if way is None or not inside.any():
        return float(np.sqrt(0.5 * np.sum(amplitude[inside] ** 2)))
    number, amplitude, phase = number[inside], amplitude[inside], phase[inside]
    total = np.zeros(max(int(np.ceil(way)), 2))
    places = np.linspace(0.0, way, total.size)
    for k in range(number.size):
        total += amplitude[k] * np.cos(number[k] * places + phase[k])
    return float(np.sqrt(np.mean(total**2)))


def level_words(unevenness: Unevenness | None) -> str:
    """What a spectrum realises in D1, with its convention; empty where the rail has no spectrum."""
    level = realised_level(unevenness)
    if unevenness is None or level is None:
        return ""
    name = unevenness.spectrum or unevenness.shape
    form = "FRA vertical profile 0.25 A_v w_c^2/((Omega^2 + w_c^2) Omega^2)"
    form = form if name.startswith("fra") else "ERRI B176 A w_c^2/((Omega^2 + w_r^2)(Omega^2 + w_c^2))"
    found = f"level of the rails in D1 (3-25 m), realised over whole repeats: {1e3 * level:.2f} mm"
    return f"{found} ({name}: {form}, one-sided, per rad/m)"
