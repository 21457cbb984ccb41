"""The swayed tanks: what is carried of the measurements, and, where their files are at hand, the whole comparison.

`SLOSH_MEASURED` names the folder with the files of the measurements, which are not part of the project.
"""

import csv
import os
from pathlib import Path

import numpy as np
import pytest

from slosh_cli.validation.cases.measured import best_phase, bore_height, decayed, rms, swayed, wave_height
from slosh_cli.validation.data_file import read_case

DATA = read_case("measured").reference
FOLDER = Path(os.environ.get("SLOSH_MEASURED", ""))
needs_the_files = pytest.mark.skipif(
    not (FOLDER / "sway_bore_0.03.csv").is_file(), reason="SLOSH_MEASURED names no folder with the measurements"
)


def columns(name):
    """Columns of a file of the measurements, in its order."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return [np.array([float(row[key]) for row in rows]) for key in rows[0]]


def test_at_most_a_dozen_figures_of_each_experiment_are_carried():
    assert 2 * len(DATA["forced"]) + len(DATA["decay_frequencies"]) <= 12
    assert len(DATA["waves"]["heights"]) <= 12
    assert len(DATA["bore"]["heights"]) <= 12


@needs_the_files
def test_the_figures_carried_are_the_measured_ones():
    for part, name in (("waves", "sway_wave_height_1.73"), ("bore", "sway_bore_0.03")):
        assert {tuple(row) for row in DATA[part]["heights"]} <= set(zip(*columns(name), strict=True))
    for amplitude, *figures in DATA["forced"]:
        assert tuple(figures) in set(zip(*columns(f"sway_amplitude_{amplitude:g}"), strict=True))


@needs_the_files
@pytest.mark.parametrize("amplitude", [0.09, 0.17, 0.32])
def test_every_gentle_forced_point_is_linear_theorys(amplitude):
    points = [row for row in zip(*columns(f"sway_amplitude_{amplitude:g}"), strict=True) if row[1] < 0.8]
    assert len(points) >= 4
    for ratio, moved, phase in points:
        percent, degrees = swayed(DATA, amplitude, ratio)
        assert percent == pytest.approx(moved, rel=0.07), ratio
        assert degrees == pytest.approx(phase, abs=4.0), ratio


def windows(time, moved, periods=6):
    """Amplitude (per cent) and frequency (rad/s) of a decay, by zero crossings of some periods at a time."""
    rising = np.flatnonzero((moved[:-1] < 0) & (moved[1:] >= 0))
    crossings = time[rising] - moved[rising] * np.diff(time)[rising] / np.diff(moved)[rising]
    for begin in range(0, crossings.size - periods, periods):
        inside = (time >= crossings[begin]) & (time <= crossings[begin + periods])
        amplitude = np.sqrt(2) * rms(moved[inside] - moved[inside].mean())
        yield amplitude, 2 * np.pi * periods / (crossings[begin + periods] - crossings[begin])


@needs_the_files
@pytest.mark.parametrize("number", [1, 2, 3])
def test_gentle_free_decay_has_the_frequency_of_linear_theory(number):
    gentle = [frequency for amplitude, frequency in windows(*columns(f"free_decay_{number}")) if 0.2 < amplitude < 0.5]
    assert len(gentle) >= 3
    assert decayed(DATA)[0] == pytest.approx(np.mean(gentle), rel=0.012)


@needs_the_files
def test_the_bore_at_the_probe():
    periods, heights = columns("sway_bore_0.03")
    miss, later = best_phase(bore_height(DATA, periods), heights)
    assert rms(heights) == pytest.approx(0.0272, abs=1e-4)
    assert miss <= 0.0085
    assert abs(later) <= 0.03
    assert bore_height(DATA, periods)(later).max() / heights.max() - 1 == pytest.approx(-0.25, abs=0.02)


@needs_the_files
def test_the_wave_height_of_the_deep_tank_is_beyond_linear_theory():
    times, heights = columns("sway_wave_height_1.73")
    assert rms(wave_height(DATA, "modal", times) - heights) == pytest.approx(0.0243, abs=0.0005)


@needs_the_files
def test_with_dispersion_wave_height_and_bore_are_nearer_to_the_measured_ones():
    times, heights = columns("sway_wave_height_1.73")
    assert rms(wave_height(DATA, "dispersion", times) - heights) < 0.0195
    periods, heights = columns("sway_bore_0.03")
    assert best_phase(bore_height(DATA, periods, "dispersion"), heights)[0] < 0.0065
