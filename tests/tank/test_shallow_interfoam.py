"""A free-surface computation by others' code (OpenFOAM's interFoam): liquid force and moment over 14 s of braking."""

import numpy as np
import pytest
from shallow_tools import history, liquid_in, moving

from slosh_cli.section import RectangularSection
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.validation.cases import kolaei
from slosh_cli.validation.data_file import data_rows

DEPTH = 1.1875
LARGEST_RMS = {0.6: 0.16, 1.5: 0.11}
LINEAR_RMS = {0.6: 0.218, 1.5: 0.363}


def reference(deceleration):
    rows = data_rows(f"interfoam_{deceleration}.csv")
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.parametrize("deceleration", LARGEST_RMS)
@pytest.mark.parametrize("cells", [60, 120, 240])
def test_force_and_moment_against_interfoam(deceleration, cells):
    """Acceptance: rms of force/(m a) at most 0.16 and 0.11, peak moment within 8 %."""
    data = reference(deceleration)
    liquid = liquid_in(RectangularSection(1.0, 3.0), cells, DEPTH)
    time, force, moment = history(moving(liquid), -deceleration, 14.0, 0.02)
    miss = (force - np.interp(time, data["time_s"], data["force_N_per_m"])) / (liquid.mass * deceleration)
    assert rms(miss) <= LARGEST_RMS[deceleration] + 1e-12
    assert moment.max() == pytest.approx(data["moment_N"].max(), rel=0.03)  # 8 % asked for


@pytest.mark.parametrize("deceleration", LARGEST_RMS)
def test_linear_theory_beside_it(deceleration):
    """One mode of potential flow misses by 0.22 and 0.36."""
    data, mass = reference(deceleration), 830.0 * DEPTH * 15.5
    k = np.pi / 15.5
    frequency = np.sqrt(9.81 * k * np.tanh(k * DEPTH))
    modes = [SloshMode(frequency, 1.0, 0.0, np.pi**2 / 8 / mass * (k * DEPTH) / np.tanh(k * DEPTH))]
    times = kolaei._times()
    inside = (times > 0.01) & (times < 14.0)
    force = kolaei.normalised_force(modes, mass, deceleration, 0.0)[inside]
    given = np.interp(times[inside], data["time_s"], data["force_N_per_m"]) / (mass * deceleration)
    assert rms(force - given) == pytest.approx(LINEAR_RMS[deceleration], abs=0.01)
