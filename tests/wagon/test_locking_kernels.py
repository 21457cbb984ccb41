"""Each kernel of the locking wheels alone, against what theory section 8 says of it; vehicles of three wheels."""

from types import SimpleNamespace

import numpy as np
import pytest

from slosh_cli.scenario import Contact
from slosh_cli.scenario.schema_run import ADHESIONS
from slosh_cli.track.contact import ContactModel, contact_model
from slosh_cli.wagon import locking
from slosh_cli.wagon.locking import SWITCH_TOLERANCE
from tests.plain_kernels import as_python

RADIUS, FIRST_WHEEL, FIRST_SPIN = 0.5, 3, 6
NOW = 2.0
TINY = 0.5 * SWITCH_TOLERANCE


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    as_python(monkeypatch, locking, ContactModel)


def brake(torque=lambda wheel, time, spin: (100.0, 0.0)):
    return SimpleNamespace(torque=torque)


def vehicle(**parts):
    """A vehicle at 20 m/s whose wheels are loaded alike; of which a test gives what it looks at."""
    wagon = SimpleNamespace(wheels=3, wheel_radius=RADIUS, first_wheel=FIRST_WHEEL, first_spin=FIRST_SPIN)
    names = ("torque_slope", "creep_by_normal", "creep_by_slip", "creep_by_speed")
    point = SimpleNamespace(
        q=np.zeros(9), v=np.zeros(9), a=np.zeros(9), rail=np.zeros(6), rail_rate=np.zeros(6),
        normal=np.zeros(3), creep=np.full(3, np.nan), torque=np.full(3, np.nan),
    )  # fmt: skip
    point.v[0] = 20.0
    given = {"brake": brake(), "contact": None, "rail": SimpleNamespace(contact=np.array([0, 2, 4]))}
    return SimpleNamespace(
        wagon=wagon,
        points=(point,),
        locked=np.zeros(3, dtype=bool),
        turning=np.ones(3),
        scratch=SimpleNamespace(**{name: np.full(3, np.nan) for name in names}),
        **{**given, **parts},
    )


def test_a_wheel_that_turns_has_its_brake_s_torque_and_a_locked_one_what_the_rail_gives():
    """Against the way it turns; the creep force is that of the load, of `V - R phi'` and of V."""
    contact = SimpleNamespace(creep_force=lambda load, slip, speed: (load + 10 * slip + speed, load, slip, speed))
    seen = []

    def torque(wheel, time, spin):
        seen.append((wheel, time))
        return 100.0 * (wheel + 1) + spin, 7.0 + wheel

    moved = vehicle(contact=contact, brake=brake(torque))
    point = moved.points[0]
    point.normal[:], point.v[FIRST_SPIN:] = (1e3, 2e3, 3e3), (30.0, 0.0, -8.0)
    moved.locked[1], moved.turning[2] = True, -1.0
    locking.wheel_forces(moved, point, NOW)
    slips = [20 - 15.0, 20.0, 20 + 4.0]
    creep = [load + 10 * slip + 20 for load, slip in zip(point.normal, slips, strict=True)]
    assert point.creep.tolist() == creep
    assert point.torque.tolist() == [130.0, creep[1] * RADIUS, -308.0]
    assert seen == [(0, NOW), (2, NOW)]
    slopes = moved.scratch
    assert slopes.torque_slope.tolist() == [7.0, 0.0, 9.0]
    assert slopes.creep_by_normal.tolist() == point.normal.tolist()
    assert slopes.creep_by_slip.tolist() == slips
    assert slopes.creep_by_speed.tolist() == [20.0] * 3


def values_of(moved):
    values = np.full(3, np.nan)
    locking.wheel_values(moved, moved.points[0], NOW, values)
    return values.tolist()


def test_values_are_the_tread_s_speed_and_the_part_of_the_torque_that_is_left():
    """A wheel that stands is held against the torque at rest, one that turns has its own sense."""
    moved = vehicle(brake=brake(lambda wheel, time, spin: (time * (100.0 if spin == 0.0 else 1e9), 0.0)))
    point = moved.points[0]
    point.v[FIRST_SPIN:], point.creep[:] = (30.0, 5.0, -8.0), (np.nan, -300.0, np.nan)
    moved.locked[1], moved.turning[2] = True, -1.0
    assert values_of(moved) == [15.0, 1.0 - 150.0 / 200.0, 4.0]
    point.creep[1], moved.turning[2] = 500.0, 1.0
    assert values_of(moved) == [15.0, 1.0 - 250.0 / 200.0, -4.0]
    moved.brake = brake(lambda wheel, time, spin: (0.5, 0.0))
    point.creep[1] = 0.5
    assert values_of(moved) == [15.0, 0.5, -4.0]


def test_without_torque_a_turning_wheel_cannot_lock_and_a_locked_one_is_to_go():
    moved = vehicle(brake=brake(lambda wheel, time, spin: (0.0, 0.0)))
    moved.points[0].v[FIRST_SPIN:], moved.points[0].creep[:] = -1.0, 300.0
    moved.locked[1] = True
    assert values_of(moved) == [1.0, -1.0, 1.0]


def test_the_torque_that_counts_is_that_of_the_way_a_wheel_turns():
    """Wheel 3 turns back at 8 rad/s: its brake is asked for 8 rad/s."""
    asked = []
    moved = vehicle(brake=brake(lambda wheel, time, spin: asked.append((wheel, time, spin)) or (1.0, 0.0)))
    moved.points[0].v[FIRST_SPIN:] = (30.0, 5.0, -8.0)
    moved.points[0].creep[:] = 0.0
    moved.locked[1], moved.turning[2] = True, -1.0
    values_of(moved)
    assert asked == [(0, NOW, 30.0), (1, NOW, 0.0), (2, NOW, 8.0)]


class Bumps:
    """Rails that rise as their place squared, and a wheel that stands on the slope of a flat."""

    uneven = 1

    def rail(self, wheel, place):
        return 1e-4 * place * place, 2e-4 * place

    def flat(self, wheel, angle):
        return 1e-5 * angle, 5e-3


@pytest.fixture
def standing():
    """A vehicle whose wheel 2 stands at its brake's limit: what it has, and `f R` (N m) as it will be `ahead` (s)."""
    steel = {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "rail_crown_radius": 0.3, "kalker_c11": 4.12}
    model = contact_model(Contact(**steel, adhesion=ADHESIONS["dry"]), 0.46)
    fields = {name: getattr(model, name) for name in ("stiffness", "creep_factor", "friction", "friction_limit_ratio",
              "friction_decay", "adhesion_reduction", "slip_reduction")}  # fmt: skip
    contact = SimpleNamespace(**fields, surface=Bumps())
    for name in ("approach", "rising", "normal_force", "creep_force"):
        setattr(contact, name, getattr(ContactModel, name).__get__(contact))
    moved = vehicle(contact=contact)
    point = moved.points[0]
    point.q[0], point.q[FIRST_WHEEL + 1], point.q[FIRST_SPIN + 1] = 0.4, -1.4e-4, 3.0
    point.v[FIRST_WHEEL + 1], point.a[0] = -0.02, -1.5
    point.rail[:], point.rail_rate[:] = (9, 9, -4e-5, 9, 9, 9), (9, 9, -0.005, 9, 9, 9)

    def asked(ahead):
        speed, place = point.v[0] + ahead * point.a[0], point.q[0] + ahead * point.v[0]
        heave = point.q[FIRST_WHEEL + 1] + ahead * point.v[FIRST_WHEEL + 1]
        rail = point.rail[2] + ahead * point.rail_rate[2]
        closed = rail + 1e-4 * place**2 - heave - 3e-5
        return RADIUS * contact.creep_force(contact.stiffness * closed**1.5, speed, speed)[0]

    return moved, asked


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("fall", [-0.02, 0.02])
def test_at_its_limit_a_brake_holds_while_what_the_rail_asks_grows_no_faster(standing, way, fall):
    moved, asked = standing
    point = moved.points[0]
    point.v[0], point.a[0], point.v[FIRST_WHEEL + 1] = way * 20.0, -way * 1.5, fall
    now, rate = abs(asked(0.0)), way * (asked(1e-7) - asked(-1e-7)) / 2e-7
    assert abs(rate) > 1e3

    def holds(part, growth):
        def torque(wheel, time, spin):
            assert (wheel, spin) == (1, 0.0)
            return part * now + growth * (time - NOW), 0.0

        moved.brake.torque = torque
        return locking.wheel_holds(moved, 1, NOW)

    assert now > 5e3
    assert holds(1.0, rate + 1e-3 * abs(rate))
    assert not holds(1.0, rate - 1e-3 * abs(rate))
    assert holds(1.0 + 4 * TINY, rate - abs(rate))
    assert not holds(1.0 - 4 * TINY, rate + abs(rate))
    assert holds(1.0 + TINY, rate + 1e-3 * abs(rate))
    assert not holds(1.0 + TINY, rate - 1e-3 * abs(rate))
    assert holds(1.0 - TINY, rate + 1e-3 * abs(rate))


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("slowing", [1.5, -1.5])
def test_at_its_limit_a_brake_holds_by_how_friction_changes_with_the_speed(standing, way, slowing):
    """On an even rail, where nothing moves up or down: friction grows as a wagon of 1 m/s slows down."""
    moved, _ = standing
    point, contact = moved.points[0], moved.contact
    contact.surface = SimpleNamespace(uneven=0)
    point.v[:], point.rail_rate[:], point.rail[2] = 0.0, 0.0, -4e-5
    point.v[0], point.a[0] = way, -way * slowing

    def asked(ahead):
        speed = way * (1.0 - slowing * ahead)
        return RADIUS * abs(contact.creep_force(contact.stiffness * 1e-4**1.5, speed, speed)[0])

    now, rate = asked(0.0), (asked(1e-7) - asked(-1e-7)) / 2e-7
    assert slowing * rate > 1e3
    for growth, held in ((rate + 1e-3 * abs(rate), True), (rate - 1e-3 * abs(rate), False)):
        moved.brake.torque = lambda wheel, time, spin, growth=growth: (now + growth * (time - NOW), 0.0)
        assert locking.wheel_holds(moved, 1, NOW) == held


def test_a_brake_holds_where_nothing_grows(standing):
    moved, asked = standing
    point = moved.points[0]
    point.v[:], point.a[:], point.rail_rate[:] = 0.0, 0.0, 0.0
    assert asked(0.0) == 0.0
    assert locking.wheel_holds(moved, 1, NOW)


def test_a_brake_without_torque_holds_nothing(standing):
    moved, _ = standing
    for torque in (0.0, -1.0):
        moved.brake.torque = lambda wheel, time, spin, torque=torque: (torque, 0.0)
        assert locking.wheel_holds(moved, 1, NOW) is False
    moved.brake.torque = lambda wheel, time, spin: (0.5, 0.0)
    moved.points[0].q[FIRST_WHEEL + 1] = 1.0  # off the rail
    assert locking.wheel_holds(moved, 1, NOW)


def test_a_small_torque_does_not_hold_against_a_small_force(standing):
    """`f R` of 0.25 N m."""
    moved, _ = standing
    for way in (1.0, -1.0):
        moved.contact.creep_force = lambda normal, slip, speed, way=way: (way * 0.5, 0.0, 0.0, 0.0)
        for torque, held in ((0.2, False), (0.3, True)):
            moved.brake.torque = lambda wheel, time, spin, torque=torque: (torque, 0.0)
            assert locking.wheel_holds(moved, 1, NOW) == held


@pytest.fixture
def told(monkeypatch):
    """Vehicles whose wheels are held as told."""

    def make(holds, **state):
        def wheel_holds(vehicle, wheel, time):
            assert time == NOW
            return holds[wheel]

        monkeypatch.setattr(locking, "wheel_holds", wheel_holds)
        moved = vehicle()
        moved.points[0].v[FIRST_SPIN:] = (1.0, -2.0, 3.0)
        for name, values in state.items():
            getattr(moved, name)[:] = values
        return moved

    return make


def spins(moved):
    return moved.points[0].v[FIRST_SPIN:].tolist()


@pytest.mark.parametrize(
    ("before", "after", "switched"),
    [
        (1.0, 0.0, True),
        (1.0, TINY, True),
        (1.0, SWITCH_TOLERANCE, True),
        (1.0, 3 * TINY, False),
        (3 * TINY, TINY, True),
        (SWITCH_TOLERANCE, 0.0, False),
        (TINY, -TINY, False),
        (TINY, -SWITCH_TOLERANCE, False),
        (TINY, -3 * TINY, True),
        (-1.0, -1.0, True),
        (0.0, 1.0, False),
    ],
)
@pytest.mark.parametrize("speed", [20.0, 0.0, -20.0])
def test_a_value_that_was_armed_or_is_clearly_beyond_zero_switches_its_wheel(told, before, after, switched, speed):
    moved = told((False, True, False), locked=(True, False, True), turning=0.0)
    moved.points[0].v[0] = speed
    values = np.array([1.0, before, before]), np.array([1.0, after, after])
    assert locking.switch_reached(moved, NOW, *values) is switched
    way = -1.0 if speed < 0.0 else 1.0
    assert moved.locked.tolist() == ([True, True, False] if switched else [True, False, True])
    assert spins(moved) == ([1.0, 0.0, 0.0] if switched else [1.0, -2.0, 3.0])
    assert moved.turning.tolist() == ([0.0, way, way] if switched else [0.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("before", "after", "now"),
    [
        (1.0, -1.0, True),  # in the middle of the step, where the shortest step ends
        (1.0, -0.9, False),
        (0.9, -1.0, True),
        (0.0, -3 * TINY, True),
        (0.0, -SWITCH_TOLERANCE, False),
        (0.0, 1.0, False),
    ],
)
def test_an_event_within_the_shortest_step_of_the_start_switches_wheels_that_it_changes(told, before, after, now):
    """Wheel 1 is locked and held: nothing changes. Wheel 2 is to be released, wheel 3 to be locked."""
    moved = told((True, False, True), locked=(True, True, False), turning=0.0)
    values = np.full(3, before), np.full(3, after)
    assert locking.switch_at_start(moved, NOW, *values, 4.0, 2.0) is now
    assert moved.locked.tolist() == ([True, False, True] if now else [True, True, False])
    assert spins(moved) == ([1.0, 0.0, 0.0] if now else [1.0, -2.0, 3.0])
    assert moved.turning.tolist() == ([0.0, 1.0, 1.0] if now else [0.0] * 3)


def test_a_break_of_the_torque_lets_go_what_is_held_no_longer_and_the_rest_turns_its_way(told):
    moved = told((True, True, False), locked=(False, True, True), turning=0.0)
    moved.points[0].v[[0, FIRST_SPIN]] = -20.0, 0.0
    locking.let_go(moved, NOW)
    assert moved.locked.tolist() == [False, True, False]
    assert moved.turning.tolist() == [1.0, -1.0, -1.0]
    moved = told((True, True, True), turning=0.0)
    locking.let_go(moved, NOW)
    assert not moved.locked.any()
    assert moved.turning.tolist() == [1.0, -1.0, 1.0]
