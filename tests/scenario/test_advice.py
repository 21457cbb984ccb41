"""What a refusal tells to write is worth what was given, and is accepted; or it is plainly an example."""

import random
import re
from collections.abc import Callable, Iterable, Iterator

import pytest
from malformed_case import BASE, edited
from written_quantities import UNITS, factor, measures, quantity, slip, spelt_number, spelt_unit

from slosh_cli.errors import Problem, ScenarioError, ValueRefused
from slosh_cli.scenario import Liquid, Rectangular, Scenario, TankScenario, parse_scenario
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Count, Leaf, Number, Quantity, Range
from slosh_cli.scenario.schema_polygon import Outline
from slosh_cli.scenario.schema_tank import Baffle, Coefficient
from slosh_cli.scenario.tree import spot_of
from slosh_cli.scenario.units import DIMENSIONS, parse_quantity

SAME = 1e-12
"""Of a value: what the order of a few multiplications may do to it."""


def offers(fix: str) -> list[str]:
    """What a remedy tells to write as it stands: all in back quotes but what follows `such as`."""
    return re.findall("`([^`]*)`", fix.partition("such as")[0])


def every_leaf() -> Iterator[tuple[str, Leaf]]:
    """The leaves of the whole schema with their places."""

    def below(model: type[Part], prefix: str) -> Iterator[tuple[str, Leaf]]:
        for name in model.model_fields:
            spot = spot_of(model, name)
            if spot.leaf is not None:
                yield prefix + name, spot.leaf
            elif spot.part is not None:
                yield from below(spot.part, f"{prefix}{name}.")

    yield from below(Scenario, "")
    for model in (*spot_of(Scenario, "tank").parts.values(), Coefficient, Baffle):
        yield from below(model, f"{model.__name__}.")


LEAVES = dict(every_leaf())
QUANTITIES = {place: leaf for place, leaf in LEAVES.items() if isinstance(leaf, Quantity)}


def outcome(read: Callable[[object], float], text: object) -> float | ValueRefused:
    """The value read, or the refusal."""
    try:
        return read(text)
    except ValueRefused as refused:
        return refused


def is_one_of(found: float, values: Iterable[float]) -> bool:
    """Whether a value is one of several, but for rounding."""
    return any(found == pytest.approx(value, rel=SAME) for value in values)


def test_every_quantity_of_the_right_kind_is_read_or_told_right() -> None:
    chance = random.Random(1)
    counts = {"read": 0, "told": 0, "out of range": 0}
    for leaf in QUANTITIES.values():
        for unit in UNITS.get(leaf.dimension, []) * 20:
            written = quantity(unit, chance)
            found = outcome(leaf.parse, written.text)
            if isinstance(found, float):
                assert len(written.values) == 1
                assert is_one_of(found, written.values), written
                counts["read"] += 1
                continue
            offered = offers(found.fix)
            assert offered or f"such as `{leaf.example}`" in found.fix
            assert all(is_one_of(leaf.parse(offer), written.values) for offer in offered), found
            assert len(written.values) > 1 or (not offered and written.values[0] not in leaf.limits), written
            counts["told" if offered else "out of range"] += 1
    assert min(counts.values()) > 20


@pytest.mark.parametrize("dimension", UNITS)
def test_every_spelling_of_every_unit_is_read(dimension: str) -> None:
    chance = random.Random(dimension)
    for unit in UNITS[dimension]:
        for _ in range(40):
            number, values = spelt_number(chance)
            text = f"{number} {spelt_unit(unit, chance)}"
            if len(values) == 1:
                assert parse_quantity(text, dimension) == pytest.approx(values[0] * factor(unit), rel=SAME), text
            else:
                with pytest.raises(ValueRefused) as caught:
                    parse_quantity(text, dimension)
                found = sorted(parse_quantity(offer, dimension) for offer in offers(caught.value.fix))
                assert found == pytest.approx(sorted(value * factor(unit) for value in values), rel=SAME), text


def test_a_quantity_of_another_kind_is_answered_with_an_example() -> None:
    chance = random.Random(2)
    kinds = [unit for units in UNITS.values() for unit in units]
    for leaf in QUANTITIES.values():
        others = [unit for unit in kinds if measures(unit) != measures(UNITS.get(leaf.dimension, [[("L", 9)]])[0])]
        for unit in others:
            text = quantity(unit, chance).text
            if leaf.dimension == "acceleration" and text.endswith("g"):
                continue  # `0.1 g` is a deceleration as well as a mass
            with pytest.raises(ValueRefused) as caught:
                leaf.parse(text)
            assert offers(caught.value.fix) == []
            assert f"such as `{leaf.example}`" in caught.value.fix


def test_a_slip_is_answered_with_what_was_meant_or_with_an_example() -> None:
    chance = random.Random(3)
    repaired = 0
    for dimension, units in UNITS.items():
        for unit in units * 100:
            written = quantity(unit, chance)
            if len(written.values) > 1:
                continue
            text = written.number + slip(written.unit, chance)
            found = outcome(lambda text, kind=dimension: parse_quantity(text, kind), text)  # type: ignore[misc]
            if isinstance(found, ValueRefused):
                told = [parse_quantity(offer, dimension) for offer in offers(found.fix)]
                assert all(is_one_of(value, written.values) for value in told), found
                repaired += len(told)
    assert repaired > 100


def test_a_bare_number_keeps_its_digits() -> None:
    chance = random.Random(4)
    for leaf in QUANTITIES.values():
        for _ in range(40):
            text, values = spelt_number(chance)
            given = text if chance.random() < 0.5 else values[0]
            with pytest.raises(ValueRefused) as caught:
                leaf.parse(given)
            possible = values if isinstance(given, str) else values[:1]
            scales = [parse_quantity(f"1 {unit}", leaf.dimension) for unit in DIMENSIONS[leaf.dimension].units]
            for offer in offers(caught.value.fix):
                assert is_one_of(leaf.parse(offer), [value * scale for value in possible for scale in scales])


def test_pure_numbers_and_counts_keep_their_value() -> None:
    chance = random.Random(5)
    read = 0
    for place, leaf in LEAVES.items():
        if not isinstance(leaf, Number | Count):
            continue
        for _ in range(400):
            text, values = spelt_number(chance)
            sign, divisor = chance.choice(
                (("", 1), (" %", 100), ("%", 100), (" ‰", 1000), (" percent", 100), (" m", 0))
            )
            possible = [value / divisor for value in values] if divisor else []
            found = outcome(leaf.parse, text + sign)
            if isinstance(found, ValueRefused):
                told = [leaf.parse(float(offer)) for offer in offers(found.fix)]
                assert all(is_one_of(value, possible) for value in told), found
                continue
            assert isinstance(leaf, Number), place
            assert divisor > 1, place
            assert is_one_of(found, possible)
            read += 1
    assert read > 100


def test_limits_are_told_on_the_safe_side() -> None:
    chance = random.Random(6)
    for _ in range(500):
        low = chance.uniform(0.0, 10.0)
        high = low + chance.uniform(0.1, 10.0)
        words = Range(low, high).words("m")
        told = [float(number) for number in re.findall(r"[0-9][0-9.e-]*", words)]
        assert all(low <= number <= high for number in told), words


AWKWARD = {
    "track.domain.length": (5.0, 40.0, "m"),
    "track.domain.element_length": (0.01, 3.0, "m"),
    "wagon.bogie.wheelbase": (0.93, 8.0, "m"),
    "wagon.pivot_spacing": (6.0, 30.0, "m"),
    "wagon.wheelset.wheel_radius": (0.1, 1.5, "m"),
    "contact.adhesion.kA": (0.001, 0.9, ""),
    "contact.adhesion.kS": (0.001, 0.9, ""),
    "output.interval": (1e-4, 1e-3, "s"),
    "solver.time_limit": (10.0, 1e4, "s"),
    "tank.length": (2.0, 30.0, "m"),
    "tank.radius": (0.5, 2.4, "m"),
    "tank.liquid.slot_speed": (5.0, 20.0, "m/s"),
}


def remedies(problem: Problem) -> list[str]:
    """The values that a remedy offers for the key of its problem."""
    return [offer for offer in offers(problem.fix) if re.match("[0-9]", offer)]


def problems_of(scenario: Scenario, changes: dict[str, object]) -> dict[tuple[str, str], Problem]:
    """What is wrong with a changed scenario, by key and the words of the rule without its numbers."""
    try:
        scenario.with_(changes)
    except ScenarioError as error:
        return {(entry.key, re.sub("[0-9.e+-]+", "#", entry.rule)): entry for entry in error.problems}
    return {}


def test_the_remedy_of_every_rule_mends_what_the_rule_found() -> None:
    chance = random.Random(7)
    base = parse_scenario(edited(("model: modal", "model: shallow-water"), ("adhesion: dry", "adhesion: 0.3")))
    mended: dict[str, int] = {}
    for _ in range(250):
        chosen = chance.sample(sorted(AWKWARD), 5)
        changes: dict[str, object] = {key: chance.uniform(*AWKWARD[key][:2]) for key in chosen}
        for (key, rule), problem in problems_of(base, changes).items():
            for offer in remedies(problem):
                assert (key, rule) not in problems_of(base, {**changes, key: offer if " " in offer else float(offer)})
                mended[key] = mended.get(key, 0) + 1
    told = {"track.domain.length", "track.domain.element_length", "contact.adhesion.kS", "output.interval"}
    assert told | {"tank.liquid.slot_speed"} <= set(mended)


def test_the_slot_of_a_high_tank_is_told_right() -> None:
    liquid = Liquid(model="shallow-water", density=1000.0)
    low = TankScenario(format=1, name="low", tank=Rectangular(length=30, fill=0.5, liquid=liquid, width=2, height=10))
    with pytest.raises(ScenarioError) as caught:
        low.with_({"tank.height": 19.0})
    (offer,) = remedies(caught.value.problems[0])
    assert low.with_({"tank.height": 19.0, "tank.liquid.slot_speed": offer}).tank.height == 19.0


def test_a_baffle_may_stand_where_it_is_told_to() -> None:
    base = parse_scenario(edited(("model: modal", "model: shallow-water")))
    chance = random.Random(8)
    for _ in range(30):
        length = chance.uniform(3.0, 20.0)
        with pytest.raises(ScenarioError) as caught:
            base.with_({"tank.length": length, "tank.baffles": [{"position": 0.0, "opening": 0.3}]})
        ends = offers(caught.value.problems[0].fix)
        assert len(ends) == 2
        for end in ends:
            baffles = [{"position": end, "opening": 0.3}]
            assert len(base.with_({"tank.length": length, "tank.baffles": baffles}).tank.baffles) == 1


def test_an_outline_may_lie_where_it_is_told_to() -> None:
    chance = random.Random(9)
    leaf = Outline(20.0)
    for _ in range(200):
        offset = chance.uniform(-3.0, 3.0) * 10 ** chance.randrange(-4, 1)
        corners = [[-1.2, offset], [1.2, offset], [1.2, 2.0 + offset], [-1.2, 2.0 + offset]]
        with pytest.raises(ValueRefused, match="lowest point at z = 0") as caught:
            leaf.parse(corners)
        words = re.search(r"(add|take) ([0-9.e-]+) ", caught.value.fix)
        assert words is not None
        shift = float(words[2]) * (1.0 if words[1] == "add" else -1.0)
        leaf.parse([[y, z + shift] for y, z in corners])


def test_a_missing_key_is_answered_with_an_example() -> None:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(BASE.replace("  radius: 1.5 m\n", ""))
    assert [offers(problem.fix) for problem in caught.value.problems] == [[]]
