"""Each kernel of the couplings alone, by hand (theory sections 11 and 16)."""

import math

import numpy as np
import pytest

from slosh_cli import method
from slosh_cli.method import END, MIDDLE, START
from slosh_cli.scenario.schema_train import COUPLINGS, Coupling, LinearCoupling, Spring
from slosh_cli.train import coupling as kernels
from slosh_cli.train.coupling import Couplings, couplings
from tests.plain_kernels import as_python

PUSH = Spring.model_construct(loading=((0.0, 0.0), (1.0, 2.0), (3.0, 12.0)), unloading=((0.0, 0.0), (2.0, 2.0)))
PULL = Spring.model_construct(loading=((0.0, 0.0), (2.0, 6.0)), unloading=((0.0, 0.0), (1.0, 1.0), (2.0, 4.0)))
RUBBING = Coupling.model_construct(compression=PUSH, tension=PULL, transition_stiffness=100.0, damping=0.5)
MIDDLE_AT = 2.0 - math.sqrt(2.0)


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    as_python(monkeypatch, kernels, Couplings, method)


def law(coupling=RUBBING, count=1):
    return couplings(coupling, np.zeros(count), 0.5)


def linear(stiffness=8.0, damping=0.25, count=1):
    return law(Coupling(linear=LinearCoupling(stiffness=stiffness, damping=damping)), count)


def of_stages(made, name, *values):
    """Put the values of the three stages, one each or one for each coupling, into a field."""
    for stage, value in enumerate(values):
        getattr(made, name)[stage] = value


def test_branches_join_the_tables_of_both_directions():
    """The upper one is that of running up: pulled less, pushed more."""
    made = couplings(RUBBING, np.array([12.0, 13.0]), 0.5)
    assert made.upper_places.tolist() == [-2.0, -1.0, 0.0, 1.0, 3.0]
    assert made.upper_forces.tolist() == [-4.0, -1.0, 0.0, 2.0, 12.0]
    assert made.lower_places.tolist() == [-2.0, 0.0, 2.0]
    assert made.lower_forces.tolist() == [-6.0, 0.0, 2.0]
    assert (made.transition, made.damping, made.half, made.rubs) == (100.0, 0.5, 0.5, 1)
    assert made.origin.tolist() == [12.0, 13.0]
    for name in ("compression", "rate", "spring", "force", "turn"):
        assert getattr(made, name).tolist() == [[0.0, 0.0]] * 3
    for name in ("taken", "taken_before", "least", "largest", "nearest", "farthest"):
        assert getattr(made, name).tolist() == [0.0, 0.0]


def test_a_linear_coupling_and_none():
    made = linear()
    assert (made.transition, made.damping, made.rubs) == (8.0, 0.25, 0)
    for place in (-3.0, -0.5, 0.0, 0.25, 4.0):
        assert made.follow(0, 1, 0.1, place, 2.0) == (8.0 * place + 0.5, 8.0, 0.25)
    none = law(None)
    assert (none.damping, none.rubs) == (0.0, 0)
    assert none.follow(0, 1, 0.1, 3.0, 2.0) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("place", "force", "stiffness"),
    [
        (-3.0, -7.0, 3.0), (-2.0, -4.0, 3.0), (-1.5, -2.5, 3.0), (-1.0, -1.0, 1.0), (-0.5, -0.5, 1.0), (0.0, 0.0, 2.0),
        (0.5, 1.0, 2.0), (1.0, 2.0, 5.0), (2.0, 7.0, 5.0), (3.0, 12.0, 5.0), (5.0, 22.0, 5.0),
    ],
)  # fmt: skip
def test_a_branch_goes_on_with_its_last_slopes(place, force, stiffness):
    made = law()
    assert kernels._branch(made.upper_places, made.upper_forces, place) == (force, stiffness)


def test_the_spring_follows_its_compression_and_is_clipped_to_its_branches():
    """`H(t+) = clip(H + k_t (c(t+) - c))`; F has the damping besides."""
    made = law()
    made.compression[START], made.spring[START], made.rate[START] = 2.0, 3.0, 1.0
    assert made.follow(0, 1, 0.1, 2.03, 1.0) == pytest.approx((6.0 + 0.5, 100.0, 0.5), rel=1e-12)
    assert made.follow(0, 1, 0.1, 2.2, 1.0) == pytest.approx((8.0 + 0.5, 5.0, 0.5), rel=1e-12)
    made.rate[START] = -1.0
    assert made.follow(0, 1, 0.1, 1.99, -1.0) == pytest.approx((2.0 - 0.5, 100.0, 0.5), rel=1e-12)
    assert made.follow(0, 1, 0.1, 1.5, -1.0) == pytest.approx((1.5 - 0.5, 1.0, 0.5), rel=1e-12)


def test_a_stage_goes_on_from_the_one_before_and_keeps_what_it_comes_to():
    made = law(count=2)
    of_stages(made, "compression", (9.0, 2.0), (9.0, 2.02), (9.0, 9.0))
    of_stages(made, "spring", (9.0, 3.0), (9.0, 4.0), (9.0, 9.0))
    of_stages(made, "rate", (9.0, 1.0), (9.0, 0.5), (9.0, 9.0))
    of_stages(made, "turn", 9.0, 9.0, 9.0)
    assert made.follow(1, END, 0.1, 2.03, 0.25)[0] == pytest.approx(5.0 + 0.125, rel=1e-12)
    assert made.compression[:, 1].tolist() == [2.0, 2.02, 2.03]
    assert made.spring[:, 1] == pytest.approx([3.0, 4.0, 5.0], rel=1e-12)
    assert made.rate[:, 1].tolist() == [1.0, 0.5, 0.25]
    assert made.turn[:, 1].tolist() == [9.0, 9.0, 4.0]
    assert made.follow(1, START, 0.1, 2.01, 0.75)[0] == pytest.approx(4.0 + 0.375, rel=1e-12)
    assert (made.compression[START, 1], made.spring[START, 1], made.rate[START, 1], made.turn[START, 1]) == (2, 3, 1, 9)
    assert np.all(made.compression[:, 0] == 9.0)
    assert np.all(made.spring[:, 0] == 9.0)


def test_a_rate_that_changes_its_sign_takes_the_spring_to_its_turn_first():
    """From 1 to -3 m/s within 0.4 s, evenly: to the turn in 0.1 s, then back by half of 3 m/s over 0.3 s."""
    made = law()
    of_stages(made, "compression", 0.0, 0.5, 0.0)
    of_stages(made, "spring", 0.0, 0.875, 0.0)
    made.rate[MIDDLE] = 1.0
    turn, end = 0.5 + 0.05, 0.5 + 0.05 - 0.45
    force, by_place, by_rate = made.follow(0, END, 0.4, end, -3.0)
    assert made.turn[END, 0] == pytest.approx(2.0 * turn, rel=1e-12)  # on the upper branch
    assert (force, by_place, by_rate) == pytest.approx((end - 1.5, 1.0, 0.5), rel=1e-12)  # on the lower one
    soft = Coupling.model_construct(compression=PUSH, tension=PULL, transition_stiffness=6.0, damping=0.5)
    made = law(soft)
    of_stages(made, "compression", 0.0, 2.0, 0.0)
    of_stages(made, "spring", 0.0, 7.0, 0.0)
    made.rate[MIDDLE] = 1.0
    force, by_place, by_rate = made.follow(0, END, 0.4, 1.6, -3.0)
    assert made.turn[END, 0] == pytest.approx(7.25, rel=1e-12)
    assert force == pytest.approx(7.25 - 6.0 * 0.45 - 1.5, rel=1e-12)  # between the branches
    # the turn, c + T r^2/(2 (r0 - r)), moves with the end, and with the rate by T r (2 r0 - r)/(2 (r0 - r)^2)
    assert by_place == pytest.approx(5.0, rel=1e-12)
    assert by_rate == pytest.approx(0.5 + (5.0 - 6.0) * 0.4 * -3.0 * 5.0 / (2.0 * 16.0), rel=1e-12)


def test_a_spring_between_its_branches_comes_back_the_way_it_went():
    """From 5 N by 6 N/m over 0.05 m to the turn, and back over 0.45 m: the turn leaves nothing."""
    made = law(Coupling.model_construct(compression=PUSH, tension=PULL, transition_stiffness=6.0, damping=0.5))
    of_stages(made, "compression", 0.0, 2.0, 0.0)
    of_stages(made, "spring", 0.0, 5.0, 0.0)
    made.rate[MIDDLE] = 1.0
    force, by_place, by_rate = made.follow(0, END, 0.4, 1.6, -3.0)
    assert made.turn[END, 0] == pytest.approx(5.3, rel=1e-12)
    assert (force, by_place, by_rate) == pytest.approx((5.0 - 6.0 * 0.4 - 1.5, 6.0, 0.5), rel=1e-12)


def test_a_rate_that_only_comes_to_rest_turns_nothing():
    made = law()
    made.compression[START], made.spring[START] = 2.0, 3.0
    for before, after in ((0.0, -1.0), (1.0, 0.0), (0.0, 0.0)):
        made.rate[START] = before
        force, slope, by_rate = made.follow(0, MIDDLE, 0.4, 1.99, after)
        assert (force, slope, by_rate) == pytest.approx((2.0 + 0.5 * after, 100.0, 0.5), rel=1e-12)
        assert made.turn[MIDDLE, 0] == 3.0


def test_work_has_the_method_s_weights():
    """`h (sqrt(2)/4 (P0 + P1) + (1 - sqrt(2)/2) P2)`, powers at the three stages."""
    made = law(count=2)
    of_stages(made, "force", (3.0, 1.0), (5.0, 2.0), (-7.0, 3.0))
    of_stages(made, "rate", (2.0, 4.0), (0.5, 2.0), (1.0, 4.0 / 3.0))
    made.taken[:] = 10.0, 20.0
    outer, last = math.sqrt(2.0) / 4.0, 1.0 - math.sqrt(2.0) / 2.0
    first = 10.0 + 0.1 * (outer * (6.0 + 2.5) + last * -7.0)
    assert made.settle(0.1) == pytest.approx(first + 20.0 + 0.1 * 4.0, rel=1e-14)
    assert made.taken == pytest.approx([first, 20.4], rel=1e-14)
    assert made.taken_before.tolist() == [10.0, 20.0]


def test_extremes_of_a_spring_with_friction_are_at_stages_and_turns():
    made = law()
    for values in (
        (1, 2, 3, 4, 5),
        (5, 4, 3, 2, 1),
        (3, 1, 2, 5, 4),
        (2, 5, 4, 1, 3),
        (2, 3, 1, 4, 3),
        (2, 3, 5, 3, 4),
    ):
        start, one, middle, two, end = values
        of_stages(made, "force", start, middle, end)
        of_stages(made, "turn", 99.0, one, two)
        assert made._extremes(0) == (min(values), max(values))


def parabola(part, top=6.0):
    """A force (N) with its largest value, or its least, in the middle of the step."""
    return top - 16.0 * (part - 0.5) ** 2


STAGES = (0.0, MIDDLE_AT, 1.0)


def test_extremes_of_an_elastic_coupling_are_the_parabola_s():
    made = linear()
    of_stages(made, "force", *(parabola(part) for part in STAGES))
    of_stages(made, "turn", 99.0, 99.0, 99.0)
    assert made._extremes(0) == pytest.approx((2.0, 6.0), rel=1e-12)


def test_an_accepted_step_leaves_its_extremes_and_its_end():
    made = linear(count=2)
    of_stages(made, "force", *((parabola(part), -parabola(part)) for part in STAGES))
    of_stages(made, "compression", *((parabola(part, 1.0), -parabola(part, 1.0)) for part in STAGES))
    of_stages(made, "rate", 1.0, 2.0, 3.0)
    of_stages(made, "spring", 4.0, 5.0, 6.0)
    made.least[:], made.largest[:], made.nearest[:], made.farthest[:] = (3.0, 0.0), (9.0, -3.0), (0.5, 7.0), (-4.0, 1.0)
    made.least_time[:], made.largest_time[:] = 1.0, 1.0
    made.accept(2.0)
    assert made.least == pytest.approx([2.0, -6.0])
    assert made.largest == pytest.approx([9.0, -2.0])
    assert made.least_time.tolist() == [2.0, 2.0]
    assert made.largest_time.tolist() == [1.0, 2.0]
    assert made.nearest == pytest.approx([1.0, 7.0])
    assert made.farthest == pytest.approx([-4.0, -1.0])
    for name in ("force", "compression", "rate", "spring"):
        values = getattr(made, name)
        assert values[START].tolist() == values[END].tolist()
    made.accept(3.0)
    assert made.least_time.tolist() == [2.0, 2.0]
    assert made.largest_time.tolist() == [1.0, 2.0]


def test_extremes_that_only_come_back_keep_their_times():
    """What is as large as before is not noted anew."""
    made = linear()
    made.force[:] = 5.0
    made.least[:], made.largest[:], made.least_time[:], made.largest_time[:] = 5.0, 5.0, 1.0, 1.0
    made.accept(2.0)
    assert (made.least_time[0], made.largest_time[0]) == (1.0, 1.0)


@pytest.mark.parametrize("part", [0.0, 0.3, MIDDLE_AT, 0.9, 1.0])
def test_a_row_has_the_force_and_the_compression_within_the_step(part):
    """A cubic of the compression over a step of 0.2 s is met, and a parabola of the force."""
    made, row, step = linear(count=2), np.full(5, np.nan), 0.2

    def place(time):
        return 3.0 + 2.0 * time - 5.0 * time**2 + 40.0 * time**3

    for stage, at in zip((START, MIDDLE, END), STAGES, strict=True):
        time = step * at
        made.compression[stage, 1], made.rate[stage, 1] = place(time), 2.0 - 10.0 * time + 120.0 * time**2
        made.force[stage, 1] = parabola(at)
    made.record(1, row, method.hermite_weights(step, part), method.parabola_weights(part))
    assert row[3:] == pytest.approx([parabola(part), place(step * part)], rel=1e-12)
    assert np.isnan(row[:3]).all()


@pytest.mark.parametrize(("forces", "told"), [((0.0, 6.0, 6.0), 6.0), ((0.0, -6.0, -6.0), -6.0)])
def test_a_force_with_friction_is_told_within_its_extremes(forces, told):
    made, row = law(), np.zeros(2)
    of_stages(made, "force", *forces)
    of_stages(made, "turn", *forces)
    made.record(0, row, method.hermite_weights(0.2, 0.75), method.parabola_weights(0.75))
    assert row[0] == told


def test_packaged_couplings_rub():
    for coupling in COUPLINGS.values():
        assert law(coupling).rubs == 1
