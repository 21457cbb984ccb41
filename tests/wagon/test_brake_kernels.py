"""Each kernel of the brake alone, and the brake that a scenario tells, by hand (theory sections 12 and 13)."""

import math

import numpy as np
import pytest

from slosh_cli.scenario import parse_scenario, scenario_to_yaml
from slosh_cli.wagon import brake as kernels
from slosh_cli.wagon.brake import LAWS, Brake, brake_of, torque_brake
from tests.plain_kernels import as_python

TABLE, CAST_IRON, COMPOSITE = range(len(LAWS))
FILL, HOLD, VENT = range(3)


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    as_python(monkeypatch, kernels, Brake)


def cast_iron(speed, force):
    """Karwatzki's law, km/h and kN."""
    return 0.6 * (1.62 * force + 100) / (8.1 * force + 100) * (speed + 100) / (5 * speed + 100)


def composite(speed, force):
    return 0.44 * (0.1 * force + 20) / (0.4 * force + 20) * (speed + 150) / (2 * speed + 150)


def test_nothing_is_held_before_the_onset():
    brake = torque_brake(5e3, 0.5)
    assert brake.torque(0, 9.0, 3.0) == (0.0, 0.0)
    assert brake.application(9.0) == 0.0
    assert not brake.is_on()
    assert (brake.next_break(), list(brake.held)) == (0.5, [1.0] * 4)
    brake.pass_break(0.5, np.zeros(5), 1)
    assert brake.torque(0, 0.5, 3.0) == brake.torque(3, 9.0, 0.0) == (5e3, 0.0)
    assert brake.is_on()
    assert brake.next_break() == math.inf


@pytest.mark.parametrize(("law", "friction"), [(CAST_IRON, cast_iron), (COMPOSITE, composite)])
def test_torque_is_the_friction_of_the_force_that_is_left(law, friction):
    """`n mu(v, p a F) p a F r`: half applied, 60 % left, the arm of a disc."""
    given = {"force": 30e3, "arm": 0.3, "radius": 0.5, "law": law, "held": np.array([1.0, 0.6])}
    brake = torque_brake(3.0, 0.0, ((0.0, 0.0, 0.125, 0.0, 0.0),), wheels=2, **given)
    brake.breaks, brake.mode[1] = 1, HOLD
    found, by_spin = brake.torque(1, 4.0, 40.0)
    assert found == pytest.approx(3 * friction(72.0, 9.0) * 9e3 * 0.3, rel=1e-12)
    sides = [friction(72.0 + change, 9.0) for change in (1e-4, -1e-4)]
    assert by_spin == pytest.approx(3 * 9e3 * 0.3 * (sides[0] - sides[1]) / 2e-4 * 3.6 * 0.5, rel=1e-6)
    at_rest = 3 * friction(0.0, 15.0) * 15e3 * 0.3
    assert brake.torque(0, 4.0, 0.0)[0] == pytest.approx(at_rest, rel=1e-12)
    assert brake.torque(0, 4.0, -40.0) == (pytest.approx(at_rest, rel=1e-12), 0.0)
    assert brake.torque(0, 4.0, 0.0)[1] < 0.0
    assert kernels.holding_torque(brake, 0, 4.0) == pytest.approx(at_rest, rel=1e-12)


def test_friction_of_a_history():
    brake = torque_brake(2.0, 0.0, force=30e3, law=CAST_IRON)
    found = np.zeros((2, 3))
    shares, speeds = np.array([[1.0, 0.5, 0.1], [1.0, 1.0, 0.2]]), np.array([[0.0, 10.0, 20.0], [5.0, 6.0, -7.0]])
    kernels.frictions_of(brake, np.array([0.5, 1.0]), shares, speeds, found)
    forces = 30.0 * np.array([[0.5], [1.0]]) * shares
    assert found == pytest.approx(cast_iron(3.6 * np.maximum(speeds, 0.0), forces), rel=1e-12)


def test_slopes_of_a_friction_table_are_those_of_the_line_that_begins():
    """Per metre a second; none on or beyond the last point, and before the first one."""
    table = {"speeds": np.array([10.0, 40.0, 100.0]), "frictions": np.array([0.4, 0.34, 0.1])}
    brake = torque_brake(2.0, 0.0, **table)
    for speed, value, slope in [
        (9.9, 0.4, 0.0), (10.0, 0.4, -0.002), (25.0, 0.37, -0.002), (40.0, 0.34, -0.004), (70.0, 0.22, -0.004),
        (100.0, 0.1, 0.0), (400.0, 0.1, 0.0),
    ]:  # fmt: skip
        assert brake.friction(speed / 3.6 * (1 + 1e-15), 1.0) == pytest.approx((value, 3.6 * slope), rel=1e-9)
    for speed in (0.0, 80.0, 81.0):
        one = torque_brake(2.0, 0.0, speeds=np.array([80.0]), frictions=np.array([0.3]))
        assert one.friction(speed / 3.6, 1.0) == (0.3, 0.0)


def test_application_of_a_stretch():
    """`base + slope tau + amplitude exp(-rate tau)`, tau from the stretch's start."""
    brake = torque_brake(1.0, 1.0, ((0.0, 0.25, 0.5, 0.0, 3.0), (2.0, 0.5, 0.125, -0.25, 0.5)))
    brake.breaks = 1
    assert brake.application(1.5) == 0.5
    brake.breaks = 2
    brake.amplitude[1] = 1.0
    assert brake.application(5.0) == pytest.approx(0.5 + 0.125 * 2.0 + math.exp(-1.0), rel=1e-15)
    brake.amplitude[1] = -0.25
    assert brake.application(5.0) == pytest.approx(0.5 + 0.125 * 2.0 - 0.25 * math.exp(-1.0), rel=1e-15)


def test_breaks_are_passed_when_they_are_due():
    """A stretch and a look at the slip may be due at once; what is passed is not passed again."""
    stretches = ((0.0, 0.0, 0.5, 0.0, 0.0), (2.0, 1.0, 0.0, 0.0, 0.0))
    brake, v = torque_brake(1.0, 1.0, stretches, period=0.75, next_sample=1.0), np.zeros(5)
    assert brake.next_break() == 1.0
    assert not brake.pass_break(0.99, v, 1)
    assert (brake.breaks, brake.next_sample) == (0, 1.0)
    assert brake.pass_break(1.0, v, 1)
    assert (brake.breaks, brake.next_sample, brake.next_break()) == (1, 1.75, 1.75)
    assert not brake.pass_break(1.75, v, 1)
    assert (brake.breaks, brake.next_sample) == (1, 2.5)
    brake.next_sample = math.inf
    assert brake.next_break() == 3.0
    assert brake.pass_break(3.0, v, 1)
    assert (brake.breaks, brake.next_break()) == (2, math.inf)
    assert not brake.pass_break(9.0, v, 1)


PROTECTED = {"radius": 0.5, "hold_above": 0.25, "vent_above": 0.5, "release_speed": 2.0, "fill_time": 0.4,
             "vent_time": 0.2}  # fmt: skip


def watched(**given):
    return torque_brake(1e4, 0.0, wheels=3, **(PROTECTED | {"period": 0.1, "next_sample": 0.0} | given))


def looked(brake, time, slips, speed=8.0):
    """Whether a look at wheels that slip so at a `speed` (m/s) changes anything."""
    return brake.sample(time, np.array([speed, 0.0, *((1 - slip) * speed / 0.5 for slip in slips)]), 2)


def test_a_wheel_is_held_above_one_limit_and_vented_above_the_other():
    brake = watched()
    assert not looked(brake, 0.0, (0.0, 0.25, -1.0))
    assert list(brake.mode) == [FILL] * 3
    assert looked(brake, 0.1, (0.25, 0.375, 0.625))
    assert list(brake.mode) == [FILL, HOLD, VENT]
    assert not looked(brake, 0.2, (0.25, 0.5, 0.625))
    assert list(brake.mode) == [FILL, HOLD, VENT]
    assert looked(brake, 0.3, (0.25, 0.5, 0.5))
    assert list(brake.mode) == [FILL, HOLD, HOLD]
    assert looked(brake, 0.4, (0.625, 0.5, 0.5))
    assert list(brake.vents) == [1, 0, 1]


def test_release_speed_and_standstill():
    brake = watched()
    assert looked(brake, 0.0, (1.0,) * 3, speed=2.0)
    assert looked(brake, 0.1, (1.0,) * 3, speed=1.99)
    assert list(brake.mode) == [FILL] * 3
    brake = watched(release_speed=0.0)
    assert not looked(brake, 0.0, (1.0,) * 3, speed=0.0)
    assert looked(brake, 0.0, (1.0,) * 3, speed=1e-3)


def test_shares_and_air_over_a_cycle():
    """Vented for 0.2 s, held for 0.1 s, filled for 0.3 s, vented again; by the closed forms."""
    brake = watched()
    looked(brake, 1.0, (0.0, 0.0, 0.9))
    for time, slip, vented in ((1.1, 0.9, 0.05), (1.2, 0.4, 0.15), (1.3, 0.0, 0.2)):
        assert brake.share(2, time - 0.05) == pytest.approx(math.exp(-vented / 0.2), rel=1e-12)
        looked(brake, time, (0.0, 0.0, slip))
    share = math.exp(-1.0)
    assert brake.share(2, 1.3) == pytest.approx(share, rel=1e-12)
    assert brake.air[2] == pytest.approx(1.0 - share, rel=1e-12)
    filled = 1.0 - (1.0 - share) * math.exp(-0.3 / 0.4)
    assert brake.share(2, 1.6) == pytest.approx(filled, rel=1e-12)
    looked(brake, 1.6, (0.0, 0.0, 0.9))
    looked(brake, 1.7, (0.0, 0.0, 0.0))
    assert brake.held[2] == pytest.approx(filled * math.exp(-0.5), rel=1e-12)
    assert brake.air[2] == pytest.approx(1.0 - share + filled * (1.0 - math.exp(-0.5)), rel=1e-12)
    assert brake.vents[2] == 2
    assert [brake.share(wheel, 1.75) for wheel in (0, 1)] == [1.0, 1.0]
    assert (list(brake.air[:2]), list(brake.vents[:2])) == ([0.0, 0.0], [0, 0])


def braked(scenario, keys):
    """The scenario with these keys in place of its torque."""
    text = scenario_to_yaml(scenario)
    line = next(line for line in text.splitlines() if line.strip().startswith("torque:"))
    return parse_scenario(text.replace(line, f"  {keys}"))


def test_the_brake_that_a_scenario_tells(shipped):
    """Fields by hand, and the torque of blocks half way down their table."""
    paper = shipped("paper_80_solid", "braking.onset=0.7 s", "braking.application={form: linear, time: 4 s}")
    plain = brake_of(paper)
    assert (plain.count, plain.force, plain.arm, plain.law) == (5e3, 1.0, 1.0, TABLE)
    assert (plain.next_sample, plain.period) == (math.inf, math.inf)
    assert plain.starts.tolist() == [0.7, 4.7]
    assert plain.slope.tolist() == [0.25, 0.0]
    table = "[[0 km/h, 0.4], [90 km/h, 0.2]]"
    blocks = brake_of(braked(paper, f"blocks: {{count: 2, force: 25 kN, friction: {table}}}"))
    assert (blocks.count, blocks.force, blocks.arm, blocks.radius, blocks.law) == (2, 25e3, 0.46, 0.46, TABLE)
    blocks.breaks = 2
    assert blocks.torque(0, 5.0, 12.5 / 0.46)[0] == pytest.approx(2 * 0.3 * 25e3 * 0.46, rel=1e-12)
    discs = brake_of(braked(paper, "discs: {faces: 3, force: 20 kN, radius: 0.247 m, friction: composite}"))
    assert (discs.count, discs.arm, discs.radius, discs.law) == (3, 0.247, 0.46, COMPOSITE)


def test_the_changeover_leaves_its_share_of_every_stretch(shipped):
    """The paper's wagon of 75 t is light for a changeover at 100 t, not for one at 48 t."""
    filling = "braking.application={form: filling, time_95: 4 s, delay: 1 s, jump: 0.2}"
    for mass, left in ((100, 0.5), (48, 1.0)):
        changeover = f"braking.load_changeover={{gross_mass: {mass} t, empty_share: 0.5}}"
        brake = brake_of(shipped("paper_80_solid", "braking.onset=1 s", filling, changeover))
        assert brake.starts.tolist() == [1.0, 2.0]
        brake.breaks = 2
        assert brake.application(2.0) == pytest.approx(0.2 * left)
        assert brake.application(5.0) == pytest.approx(0.95 * left)
        table = "braking.application={form: table, points: [[0 s, 0], [2 s, 1], [4 s, 1]]}"
        rising = brake_of(shipped("paper_80_solid", "braking.onset=1 s", table, changeover))
        rising.breaks = 1
        assert rising.application(2.0) == pytest.approx(0.5 * left)


def test_slide_protection_looks_first_at_the_onset(shipped):
    keys = "braking.slide_protection={period: 30 ms, hold_above: 0.12, vent_above: 0.3, fill_time: 0.5 s}"
    brake = brake_of(shipped("paper_80_solid", "braking.onset=0.7 s", keys))
    assert (brake.next_sample, brake.sampled, brake.period) == (0.7, 0.7, 0.03)
    assert (brake.hold_above, brake.vent_above, brake.fill_time, brake.vent_time) == (0.12, 0.3, 0.5, 0.15)
    assert brake.release_speed == pytest.approx(5 / 3.6)
