"""Searches along one key: on curves that are known, and on the model beside a bisection by hand."""

import json
import math
from collections.abc import Callable, Sequence

import pytest

from slosh_cli import Scenario, find, load_scenario, optimum, simulate
from slosh_cli.errors import SloshError
from slosh_cli.study.search import Passage, Sample, Sampled, beside, least, passages, refined

TOLERANCE = 1e-4


def sampled(curve: Callable[[float], float | None], limit: float = math.inf) -> Sampled:
    """A curve on 0..10; stops beyond `limit` are outside it."""

    def compute(places: Sequence[float]) -> list[Sample]:
        return [Sample(x, curve(x), {"limit": x <= limit}, "stopped", "", {}) for x in places]

    found = Sampled(compute, 0.0, 10.0)
    found.scan(17)
    return found


def first_of(curve: Callable[[float], float | None], target: float) -> Passage:
    points = sampled(curve)
    return refined(points, passages(points, target)[0], target, TOLERANCE)


def test_a_crossing_is_closed_in() -> None:
    found = first_of(lambda x: x**3, 100.0)
    assert found.kind == "crossing"
    assert found.x == pytest.approx(100.0 ** (1 / 3), rel=1e-4)
    assert found.above.x - found.below.x <= 3e-4 * found.x


@pytest.mark.parametrize("slope", [0.0, 30.0, -3.0])
def test_a_jump_is_told_with_both_sides(slope: float) -> None:
    found = first_of(lambda x: 300.0 + slope * (x - 3.3) + (50.0 if x > 3.3 else 0.0), 320.0)
    assert found.kind == "jump"
    assert found.below.x <= 3.3 < found.above.x
    assert (found.below.value, found.above.value) == (pytest.approx(300.0, abs=0.1), pytest.approx(350.0, abs=0.1))


def test_a_steep_curve_is_no_jump() -> None:
    assert first_of(lambda x: 300.0 + 40.0 * math.tanh(100.0 * (x - 3.3)), 310.0).kind == "crossing"


def test_the_end_of_a_plateau_is_found() -> None:
    found = first_of(lambda x: max(0.0, x - 4.2), 0.0)
    assert found.x == pytest.approx(4.2, rel=1e-4)


def test_an_answer_that_never_leaves_the_value_does_not_pass_it() -> None:
    """No wheel locks at any stop: there is no first lock at the low end."""
    assert passages(sampled(lambda x: 0.0), 0.0) == []
    (touched,) = passages(sampled(lambda x: x), 10.0)
    assert touched.x == 10.0


def test_several_crossings_are_told_and_stops_without_an_answer_are_no_crossing() -> None:
    assert len(passages(sampled(math.sin), 0.5)) == 4
    gap = first_of(lambda x: None if 3.0 < x < 5.0 else x, 4.0)
    assert (gap.kind, gap.below.x, gap.above.x) == ("gap", pytest.approx(3.0, abs=0.1), pytest.approx(5.0, abs=0.1))
    hidden = first_of(lambda x: None if 4.05 < x < 4.1 else x, 4.08)
    assert hidden.kind == "gap"


@pytest.mark.parametrize(
    ("curve", "limit", "place", "held"),
    [
        (lambda x: 10.0 + (x - 6.1) ** 2, math.inf, 6.1, "inside"),
        (lambda x: 10.0 - x, math.inf, 10.0, "end"),
        (lambda x: 20.0 - x, 7.3, 7.3, "limit"),
        (lambda x: 20.0 - x + (9.0 if x > 7.3 else 0.0), math.inf, 7.3, "jump"),
        (lambda x: 20.0 - x if x < 7.3 else None, math.inf, 7.3, "gap"),
    ],
)
def test_an_optimum_and_what_holds_it(
    curve: Callable[[float], float | None], limit: float, place: float, held: str
) -> None:
    points = sampled(curve, limit)
    best = least(points, TOLERANCE)
    assert best is not None
    assert best.x == pytest.approx(place, abs=0.05 if held == "inside" else 2e-3)
    assert beside(points, best, TOLERANCE) == held


def test_nothing_within_the_limits_is_no_optimum() -> None:
    assert least(sampled(lambda x: x, -1.0), TOLERANCE) is None


@pytest.fixture(scope="module")
def solid() -> Scenario:
    return load_scenario("paper-80-liquid", ["tank.liquid.model=rigid", "braking.initial_speed=150 km/h"])


def test_it_agrees_with_a_bisection_by_hand(solid: Scenario) -> None:
    low, high = 2.0, 18.0
    while high - low > 1e-4 * low:
        middle = 0.5 * (low + high)
        stop = simulate(solid.with_({"braking.torque": f"{middle!r} kN m"}))
        low, high = (low, middle) if max(stop.locked_time_s) > 0.0 else (middle, high)
    found = find(solid, "braking.torque=2:18 kN m", "first_lock")
    assert found.kind == "change"
    assert found.value == pytest.approx(low, rel=1e-3)


def test_the_jump_of_the_distance_is_told(solid: Scenario) -> None:
    found = find(solid, "braking.torque=19.6:20 kN m", "braking_distance=360 m", points=5)
    assert (found.kind, found.value) == ("jump", None)
    passage = found.passage
    assert passage is not None
    assert passage.below.value == pytest.approx(334.0, abs=3.0)
    assert passage.above.value == pytest.approx(385.0, abs=4.0)
    assert json.loads(json.dumps(found.as_dict()))["crossings"][0]["kind"] == "jump"


def test_a_limit_holds_the_shortest_distance(solid: Scenario) -> None:
    found = optimum(solid, "braking.torque=12:20 kN m", within="max_wheel_unloading<=0.6", points=5)
    assert found.kind == "limit"
    assert found.best is not None
    assert found.best.row["max_wheel_unloading"] == pytest.approx(0.6, abs=1e-3)


@pytest.mark.parametrize(
    ("vary", "until", "words"),
    [
        ("braking.torque=30:2 kN m", "first_lock", "write `2:30 kN m`"),
        ("braking.torque=2:2 kN m", "first_lock", "two different ends"),
        ("braking.torque=nan:30 kN m", "first_lock", "a range LOW:HIGH"),
        ("braking.torque=2:30:1 kN m", "first_lock", "a range LOW:HIGH"),
        ("braking.torque=2:30 kNn", "first_lock", "must be a torque with its unit"),
        ("braking.torque=2:30", "first_lock", "must be a torque with its unit"),
        ("braking.torqe=2:30 kN m", "first_lock", "torque"),
        ("contact.adhesion", "first_lock", "must have a range"),
        ("braking.torque", "max_wheel_unloding=0.6", "write `max_wheel_unloading`; the answers are first_lock"),
        ("braking.torque", "braking_distance=700", "without a unit"),
        ("braking.torque", "braking_distance=700 mtr", "a length with its unit"),
        ("braking.torque", "max_wheel_unloading=nan", "a number without a unit"),
        ("braking.torque", "max_wheel_unloading", "an equals sign"),
        ("braking.torque", "first_lock=1", "`first_lock` alone"),
    ],
)
def test_wrong_input_is_refused_with_what_to_write(solid: Scenario, vary: str, until: str, words: str) -> None:
    with pytest.raises(SloshError) as caught:
        find(solid, vary, until)
    assert words in str(caught.value)


def test_a_key_alone_is_searched_around_the_files_own_value(solid: Scenario) -> None:
    found = find(solid, "tank.fill", "braking_distance=100 m", points=5)
    assert (found.kind, found.value) == ("none", None)
    assert found.search.span.words == "0.25 to 0.95, around the file's own 0.5"
