"""The keys of a brake: what may stand there, what is refused and why (theory sections 12 and 13)."""

import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import parse_scenario, scenario_to_yaml
from slosh_cli.scenario.schema_application import FillingApplication
from slosh_cli.scenario.schema_friction import FrictionTable
from slosh_cli.wagon.torque import brake_torque, constant_torque, moved_mass, total_mass


@pytest.fixture
def braked(shipped):
    """The paper's wagon with these keys in place of its torque."""

    def make(keys, *more):
        text = scenario_to_yaml(shipped("paper_80_solid", *more))
        lines = text.splitlines()
        place = next(i for i, line in enumerate(lines) if line.strip().startswith("torque:"))
        kept = [line for line in lines if not line.strip().startswith(("torque:",))]
        indent = lines[place][: len(lines[place]) - len(lines[place].lstrip())]
        written = [indent + line for line in keys.splitlines()]
        begun = {line.split(":")[0].strip() for line in written}
        body = _without_application(kept, indent) if "application" in begun else kept
        return parse_scenario("\n".join([*body[:place], *written, *body[place:]]) + "\n")

    return make


def _without_application(lines, indent):
    found, skipping = [], False
    for line in lines:
        if line.startswith(f"{indent}application:"):
            skipping = True
            continue
        if skipping and line.startswith(f"{indent} "):
            continue
        skipping = False
        found.append(line)
    return found


BLOCKS = "blocks: {count: 2, force: 25 kN, friction: %s}"


@pytest.mark.parametrize(
    ("friction", "mu"),
    [
        ("cast-iron", 0.6 * (1.62 * 25 + 100) / (8.1 * 25 + 100) * 180 / 500),
        ("composite", 0.44 * (0.1 * 25 + 20) / (0.4 * 25 + 20) * 230 / 310),
        ("0.27", 0.27),
        ("27 %", 0.27),
        ("[[0 km/h, 0.32], [100 km/h, 0.22]]", 0.24),
        ("{law: table, points: [[80 km/h, 0.3]]}", 0.3),
    ],
)
def test_blocks_press_on_the_tread(braked, friction, mu):
    case = braked(BLOCKS % friction)
    assert brake_torque(case, 80 / 3.6) == pytest.approx(2 * mu * 25e3 * 0.46, rel=1e-12)
    assert parse_scenario(scenario_to_yaml(case)) == case


def test_discs_act_at_their_radius(braked):
    case = braked("discs: {faces: 2, force: 20 kN, radius: 0.247 m, friction: 0.35}")
    assert brake_torque(case, 10.0) == pytest.approx(2 * 0.35 * 20e3 * 0.247)


def test_deceleration_is_that_of_the_moved_mass(braked):
    case = braked("deceleration: 0.9 m/s^2")
    assert constant_torque(case) == pytest.approx(0.46 * 0.9 * moved_mass(case) / 8)


@pytest.mark.parametrize(("percentage", "speed", "distance"), [(65, 100, 704.5), (100, 120, 702.8), (50, 160, 2337.4)])
def test_braked_weight_tells_a_distance(braked, percentage, speed, distance):
    """The distance by small steps, with the build-up that belongs to it."""
    case = braked(f"braked_weight: {{percentage: {percentage}, speed: {speed} km/h}}")
    assert case.braking.braked_weight.distance == pytest.approx(distance, abs=0.05)
    force, mass = 8 * constant_torque(case) / 0.46, moved_mass(case)
    v, way, time, step = speed / 3.6, 0.0, 0.0, 1e-3
    while v > 0.0:
        applied = min(max((time + 0.5 * step - 0.2) / 4.0, 0.0), 1.0)
        after = v - step * (applied * force + 851 + 13.5 * v + 1.244 * v * v) / mass
        way, v, time = way + 0.5 * step * (v + max(after, 0.0)), after, time + step
    assert way == pytest.approx(distance, rel=1e-4)


def test_changeover_presses_the_light_wagon_less(braked):
    keys = BLOCKS % "cast-iron" + "\nload_changeover: {gross_mass: 48 t, empty_share: 0.58}"
    full, light = braked(keys), braked(keys, "tank.fill=0.1")
    assert total_mass(light) < 48e3 < total_mass(full)
    mu = 0.6 * (1.62 * 14.5 + 100) / (8.1 * 14.5 + 100)
    assert brake_torque(light, 0.0) == pytest.approx(2 * mu * 14.5e3 * 0.46)
    assert brake_torque(full, 0.0) > 1.2 * brake_torque(light, 0.0)


def test_words_of_applications(braked):
    assert braked("torque: 5 kN m\napplication: P").braking.application == FillingApplication(time_95=4.0)
    assert braked("torque: 5 kN m\napplication: G").braking.filling_time == 24.0
    assert braked("torque: 5 kN m\napplication: {form: linear, time: 4 s}").braking.filling_time == pytest.approx(3.8)
    table = "torque: 5 kN m\napplication: {form: table, points: [[0 s, 0], [1 s, 0.3], [5 s, 1]]}"
    assert braked(table).braking.filling_time == pytest.approx(1 + 4 * 0.65 / 0.7)
    assert FrictionTable(points=[(0.0, 0.3)]).friction(500.0, 1.0) == (0.3, 0.0)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("torque: 5 kN m\ndeceleration: 0.9 m/s^2", "must not be given beside `torque`"),
        ("application: P", "must have one of the keys torque, blocks, discs, deceleration and braked_weight"),
        (BLOCKS % "cast_iron", "write `cast-iron`"),
        (BLOCKS % "7", "from 0.005 to 1.5"),
        (BLOCKS % "[[0 km/h, 0.3], [0 km/h, 0.2]]", "must rise from point to point, but point 2 does not"),
        (BLOCKS % "[[0, 0.3]]", "point 1: must be a speed with its unit"),
        (BLOCKS % "[]", "must have from 1 to 1000 points"),
        (BLOCKS % "[[0 km/h, 0.3, 4]]", "point 1 is not"),
        (BLOCKS % "[[0 km/h, .nan]]", "point 1: must be a number"),
        ("blocks: {count: 2.5, force: 25 kN, friction: 0.3}", "must be a whole number from 1 to 8"),
        ("braked_weight: {percentage: 65, speed: 110 km/h}", "must be 100, 120, 140 or 160 km/h"),
        ("torque: 5 kN m\napplication: Q", "must be `step`, `P`, `G`"),
        ("torque: 5 kN m\napplication: {form: filling, time_95: 4 s, delay: 4 s}", "must be below time_95"),
        ("torque: 5 kN m\napplication: {form: filling, time_95: 4 s, jump: 0.95}", "below 0.95"),
        ("torque: 5 kN m\napplication: {form: table, points: [[1 s, 0.3]]}", "must begin at 0"),
        ("torque: 5 kN m\napplication: {form: table, points: [[0 s, 1.3]]}", "point 1: must be a number from 0 to 1"),
        ("torque: 5 kN m\nslide_protection: {hold_above: 0.3}", "must be at most vent_above"),
        ("torque: 5 kN m\nslide_protection: {vent_time: 5 ms}", "must be at least the period"),
        ("torque: 5 kN m\nslide_protection: 20 ms", "mapping"),
    ],
)
def test_what_is_no_brake_is_refused_with_the_reason(braked, keys, words):
    with pytest.raises(ScenarioError) as refused:
        braked(keys)
    assert words in str(refused.value)


def test_what_only_a_train_needs_may_stand_in_a_wagon(shipped):
    wagon = shipped("paper_80", "wagon.length_over_buffers=17.5 m", "wagon.coupling_height=1.05 m").wagon
    assert (wagon.length_in_train, wagon.coupling_height) == (17.5, 1.05)
    assert shipped("paper_80").wagon.length_in_train == 17.0
