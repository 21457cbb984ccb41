"""Computed modes are kept by geometry; the first time takes little, the second nothing."""

import math
import threading
import time

import pytest
from tank_examples import cylinder

from slosh_cli.scenario import Liquid
from slosh_cli.section import EllipticalSection
from slosh_cli.tank import longitudinal
from slosh_cli.tank.coefficients import computed_modes
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.longitudinal import longitudinal_modes

LENGTH = 5.75


def test_three_modes_of_a_cylinder_take_half_a_second_and_nothing_the_second_time():
    section = EllipticalSection(1.2, 1.2)
    longitudinal_modes(section, 1.0, LENGTH, 1)  # imports scikit-fem
    taken = [longitudinal_modes(section, 2.4 * fill, 5.76, 3).solve_seconds for fill in (0.5, 0.6, 0.75, 0.9)]
    assert min(taken) < 0.5
    assert max(taken) < 2.0
    started = time.perf_counter()
    again = longitudinal_modes(section, 2.4 * 0.9, 5.76, 3)
    assert time.perf_counter() - started < 0.002
    assert again is longitudinal_modes(section, 2.4 * 0.9, 5.76, 3)


def test_the_density_is_not_part_of_the_key():
    before = computed_modes(cylinder(0.31), 2)
    done = longitudinal._CACHE.computed
    other = Liquid(model="modal", density=830.0)
    after = computed_modes(cylinder(0.31, liquid=other), 2)
    assert longitudinal._CACHE.computed == done
    assert after[0].mu / before[0].mu == pytest.approx(830.0 / 998.2)


def test_threads_share_one_computation():
    done = longitudinal._CACHE.computed
    found = []
    threads = [threading.Thread(target=lambda: found.append(computed_modes(cylinder(0.37), 1))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert longitudinal._CACHE.computed == done + 1
    assert len(found) == 4
    assert len(set(found)) == 1


def test_what_never_settles_is_refused(monkeypatch):
    monkeypatch.setattr(longitudinal, "_MOST_UNKNOWNS", 100)
    with pytest.raises(TankError, match=r"still change by .* ask for fewer modes"):
        longitudinal_modes(EllipticalSection(1.2, 1.2), 1.9, 5.77, 3)


@pytest.mark.parametrize(("count", "length"), [(0, 5.75), (-1, 5.75), (1, 0.0), (1, -1.0), (1, math.nan)])
def test_senseless_counts_and_lengths_are_refused(count, length):
    with pytest.raises(ValueError, match="must be positive"):
        longitudinal_modes(EllipticalSection(1.2, 1.2), 1.2, length, count)
