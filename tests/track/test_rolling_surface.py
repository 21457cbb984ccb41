"""The shape that wheels roll over: tables of spectra, files and dips, flats, and the realised level."""

import numpy as np
import pytest

from slosh_cli.scenario import Dip, Unevenness, WheelFlat
from slosh_cli.track.spectrum import realised_level, spectral_lines, variance
from slosh_cli.track.surface import even_surface, rolling_surface

AHEAD = np.array([7.0, 5.0, -5.0, -7.0])


def surface(unevenness=None, *flats):
    return rolling_surface(unevenness, flats, AHEAD, 0.46)


def trace(found, places, wheel=0):
    heights = np.zeros(len(places))
    found.trace(wheel, np.asarray(places, dtype=float), heights)
    return heights


@pytest.mark.parametrize("given", [{"sigma": 0.02, "shape": "fra"}, {"spectrum": "fra-1"}, {"spectrum": "erri-high"}])
def test_the_table_of_a_spectrum_is_its_sum(given):
    rail = Unevenness(seed=3, **given)
    places = np.concatenate([np.random.default_rng(1).uniform(20.0, 2e4, 400), [631.0, 1e5]])
    number, amplitude, phase = spectral_lines(rail)
    exact = (amplitude * np.cos(np.outer(places + 7.0, number) + phase)).sum(axis=1)
    assert np.abs(trace(surface(rail), places) - exact).max() < 1e-9


def test_the_realised_variance_over_whole_repeats_is_the_spectrums():
    rail = Unevenness(spectrum="fra-4", seed=1)
    spacing = (2 * np.pi / 1.5 - 2 * np.pi / 30) / 400
    heights = trace(surface(rail), 100.0 + np.linspace(0.0, 2 * np.pi / spacing, 20_001))
    assert np.var(heights) == pytest.approx(variance("fra-4", 1.5, 30.0), rel=0.01)


@pytest.mark.parametrize(
    ("name", "millimetres"),
    [
        *(("fra-1", "8.5"), ("fra-2", "7.8"), ("fra-3", "6.4"), ("fra-4", "5.7"), ("fra-5", "3.6"), ("fra-6", "1.43")),
        *(("erri-low", "0.98"), ("erri-high", "1.61")),
    ],
)
def test_levels_in_d1(name, millimetres):
    digits = len(millimetres.partition(".")[2])
    assert f"{1e3 * variance(name, 3.0, 25.0) ** 0.5:.{digits}f}" == millimetres


@pytest.mark.parametrize("shape", ["erri", "fra"])
def test_sigma_is_the_deviation_in_d1(shape):
    rail = Unevenness(sigma=1.2e-3, shape=shape, seed=7)
    assert realised_level(rail) == pytest.approx(1.2e-3, rel=0.02)
    assert realised_level(rail, 50 * 631.0) == pytest.approx(1.2e-3, rel=0.02)
    assert abs(realised_level(rail, 200.0) / 1.2e-3 - 1.0) > 0.02  # a stretch is not its spectrum
    assert realised_level(Unevenness(dips=(Dip(position=50.0, length=1.0, depth=0.002),))) is None


def test_unevenness_sets_in_smoothly():
    found, even = surface(Unevenness(spectrum="fra-1")), surface()
    assert trace(found, [0.0]) == 0.0
    heights = trace(found, np.linspace(0.0, 30.0, 30_001))
    assert np.abs(np.diff(heights, 2)).max() < 3e-7
    assert even.uneven == 0
    assert even_surface().uneven == 0
    assert trace(even, [50.0]) == 0.0


def test_dips_are_cosines_and_may_overlap():
    dips = (Dip(position=50.0, length=1.0, depth=0.002), Dip(position=50.5, length=0.3, depth=-0.001))
    found, x = surface(Unevenness(dips=dips)), np.linspace(49.5, 51.5, 2001)
    exact = np.zeros(x.size)
    for dip in dips:
        inside = (x > dip.position) & (x < dip.position + dip.length)
        exact -= inside * 0.5 * dip.depth * (1 - np.cos(2 * np.pi * (x - dip.position) / dip.length))
    assert np.abs(trace(found, x - 7.0) - exact).max() < 1e-9
    assert found.longest_way == pytest.approx(0.03)


def test_a_measured_rail_is_cubic_between_its_points_and_runs_out():
    x = np.arange(0.0, 100.0, 0.5)
    z = 1e-3 * np.sin(x) + 2e-3
    text = "x_m,z_m " + " ".join(f"{a!r},{b!r}" for a, b in zip(x.tolist(), z.tolist(), strict=True))
    found = surface(Unevenness(file=text))
    inside = np.linspace(30.0, 95.0, 501)
    assert np.abs(trace(found, inside - 7.0) - (1e-3 * np.sin(inside) + 2e-3)).max() < 2e-7
    assert trace(found, [99.5 + 2.0 - 7.0]) == 0.0
    beyond = trace(found, np.linspace(92.4, 94.6, 2001))
    assert np.abs(np.diff(beyond)).max() < 5e-6  # no jump
    assert found.longest_way == pytest.approx(0.1)


def test_a_flat_is_one_smooth_dip_per_turn():
    found = surface(None, WheelFlat(wheel=4, depth=1e-3, length=0.06))
    kernel = type(found).flat.py_func
    turns = 2 * np.pi * np.array([-3.0, 0.0, 5.0])
    middle = 0.03 / 0.46
    for turn in turns:
        assert kernel(found, 3, turn + middle)[0] == pytest.approx(1e-3, rel=1e-9)
        assert kernel(found, 3, turn + 2.001 * middle) == (0.0, 0.0)
        assert kernel(found, 0, turn + middle) == (0.0, 0.0)
    value, slope = kernel(found, 3, 0.3 * middle)
    assert slope == pytest.approx((kernel(found, 3, 0.3 * middle + 1e-7)[0] - value) / 1e-7, rel=1e-5)
