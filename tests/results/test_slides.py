"""Wheels that locked: from when, at which speed, how far, and the flat that they wear."""

import math

import numpy as np
import pytest

from slosh_cli.results.channels import wheel
from slosh_cli.results.slides import Slide, flat_of, slide_check
from slosh_cli.solver.run import integrate
from slosh_cli.solver.setup import problem

SEVERE, MILD = 55e-9 / 1e-6 / 7850, 5.3e-9 / 7850
HARD = "braking.torque=20 kN m"


def test_a_short_slide_wears_by_its_length_and_a_long_one_by_its_work():
    """8 kN turn mild at 10.4 N/mm^2, on 770 mm^2: after that the volume pi d^2 sqrt(R r) grows by the friction work."""
    length, depth = flat_of(8e3, 10.0, 0.46, 0.3)
    assert depth == pytest.approx(SEVERE * 10)
    assert length == pytest.approx(math.sqrt(8 * 0.46 * depth))
    volume = [math.pi * math.sqrt(0.46 * 0.3) * flat_of(8e3, way, 0.46, 0.3)[1] ** 2 for way in (100.0, 150.0)]
    assert volume[1] - volume[0] == pytest.approx(MILD * 8e3 * 50, rel=1e-9)
    turn = 8e3 / 10.4e6 / (2 * math.pi * math.sqrt(0.46 * 0.3)) / SEVERE
    before, after = (flat_of(8e3, part * turn, 0.46, 0.3)[1] for part in (1 - 1e-9, 1 + 1e-9))
    assert before == pytest.approx(after, rel=1e-8)


@pytest.mark.parametrize(("force", "distance"), [(0.0, 0.0), (8e3, 0.0), (0.0, 5.0)])
def test_no_slide_no_flat(force, distance):
    assert flat_of(force, distance, 0.46, 0.3) == (0.0, 0.0)


def test_the_verdict_names_wheel_time_speed_way_and_flat(shipped):
    check = slide_check([Slide(4, 1.25, 12.5, 3.2, 4.0, 32e3)], shipped("paper_80"))
    length, depth = flat_of(8e3, 4.0, 0.46, 0.3)
    assert not check.within
    assert (check.standing, check.value) == ("assumed", 1.25)
    assert "wheel 4 for 1.25 s (locks 12.50 s into the run at 3.20 m/s, slides 4 m at a stretch" in check.meaning
    assert f"{1e3 * length:.2g} mm length and {1e3 * depth:.1g} mm depth" in check.meaning
    assert "Braghin" in check.source
    assert slide_check([], shipped("paper_80")).within


def test_long_slides_have_plain_digits(shipped):
    check = slide_check([Slide(1, 90.0, 1.0, 44.4, 2346.0, 5e8)], shipped("paper_80"))
    assert "slides 2350 m at a stretch" in check.meaning
    assert "e+" not in check.meaning


def test_the_first_lock_and_the_slide_are_those_of_the_history(stop):
    result = stop("paper_80_solid", HARD, "output.interval=1 ms")
    still = np.abs(result.channels[wheel(4, "speed")]) < 1e-9
    first = int(np.argmax(still))
    speed, time = result.channels["speed"], result.time
    assert result.speed_at_first_lock_m_s == pytest.approx(speed[first], abs=0.02)
    account = integrate(problem(result.scenario)).train.vehicles[0].account
    assert account.lock_time[3] == pytest.approx(time[first], abs=2e-3)
    stretch = slice(first, None)
    force = result.channels[wheel(4, "tangential_force")][stretch] * speed[stretch]
    work = float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(time[stretch])))
    assert account.slid[3] == pytest.approx(
        result.channels["position"][-1] - result.channels["position"][first], rel=1e-3
    )
    assert account.slid_work[3] == pytest.approx(work, rel=1e-3)
    assert account.lock_time[0] == account.slid[0] == 0.0


def test_without_a_lock_there_is_no_speed(stop):
    result = stop("paper_80_solid")
    assert result.speed_at_first_lock_m_s is None
    assert result.summary()["speed_at_first_lock_m_s"] is None
    assert math.isnan(result.as_attributes()["speed_at_first_lock_m_s"])
