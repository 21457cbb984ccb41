"""Slosh modes against the filling."""

import math

import numpy as np
import pytest
from tank_examples import THREE_TROUGHS, box, cylinder, polygon

from slosh_cli.tank.chart import fill_chart
from slosh_cli.tank.coefficients import computed_modes
from slosh_cli.tank.load import frozen_load


def test_chart_of_a_box_has_its_closed_forms():
    fills = np.array([0.1, 0.4, 0.9])
    chart = fill_chart(box(), fills, 2)
    k = np.array([[1.0], [3.0]]) * math.pi / 5.75
    depth = 3.0 * fills
    assert chart.numbers == (1, 3)
    assert chart.fill == pytest.approx(fills)
    assert chart.frequency == pytest.approx(np.sqrt(9.81 * k * np.tanh(k * depth)), rel=1e-6)
    fraction = 8.0 / (k * 5.75) ** 2 * np.tanh(k * depth) / (k * depth)
    assert chart.mass_fraction == pytest.approx(fraction, rel=1e-5)
    assert chart.height == pytest.approx(depth - 2.0 / k * np.tanh(k * depth / 2.0), rel=1e-5)
    assert chart.skipped == {}


def test_chart_of_a_cylinder_is_what_the_tank_has_at_that_filling():
    chart = fill_chart(cylinder(0.3), [0.5], 1)
    mode = computed_modes(cylinder(0.5), 1)[0]
    assert chart.frequency[0, 0] == mode.frequency
    assert chart.height[0, 0] == pytest.approx(mode.height)
    assert chart.mass_fraction[0, 0] == pytest.approx(mode.slosh_mass / frozen_load(cylinder(0.5)).mass)


def test_fillings_that_cannot_be_represented_are_gaps_with_a_reason():
    chart = fill_chart(polygon(THREE_TROUGHS), [0.2, 0.375, 0.7])
    assert np.isnan(chart.frequency[0]).tolist() == [False, True, False]
    assert np.isnan(chart.height[0]).tolist() == [False, True, False]
    assert list(chart.skipped) == [0.375]
    assert "separate troughs" in chart.skipped[0.375]
