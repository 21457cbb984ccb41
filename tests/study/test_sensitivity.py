"""What a stop depends on: ends, standings and effects of every uncertain value."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from slosh_cli.application.keeping import Keeping
from slosh_cli.application.sensitivity import Sensitivity, keep_sensitivity, sensitivity
from slosh_cli.application.stop import simulate
from slosh_cli.errors import UsageError
from slosh_cli.scenario import Scenario, load_scenario
from slosh_cli.study.sensitivity import DISTANCE, LOCK, SMALL, UNLOADING, Doubt, Effect, doubts
from slosh_cli.wagon.torque import brake_torque

_RIGID = ("tank.liquid.model=rigid", "solver.tolerance=1e-3", "tank.coefficients=computed")
_WORN = Doubt("contact.kalker_c11", "4", "3", "5", "yours", "wear", (3.0, 5.0))


@pytest.fixture(scope="module")
def stop() -> Scenario:
    return load_scenario("tank-wagon", [*_RIGID, "wagon.use=zacns-like"])


@pytest.fixture(scope="module")
def found(stop: Scenario) -> Sensitivity:
    return sensitivity(stop, threads=2)


def _row(distance: float | None = 100.0, lock: float | None = None, status: str = "stopped") -> Mapping[str, Any]:
    return {"status": status, DISTANCE: distance, UNLOADING: 0.3, LOCK: lock}


def test_each_doubt_tells_its_standing_its_ends_and_why(stop: Scenario) -> None:
    told = {one.key: one for one in doubts(stop)}
    assert told["wagon.car_body.pitch_inertia"].standing == "assumed"
    assert told["track.rail.youngs_modulus"].standing == "yours"
    mass = told["wagon.wheelset.mass"]
    assert mass.ends[0] == pytest.approx(0.9 * stop.wagon.wheelset.mass)
    assert mass.reason.startswith("assumed; 10 %")
    assert "wagon.wheelset.wheel_radius" not in told  # published
    tank = stop.with_({"tank.use": "zacns-like"})
    assert tank.presets["tank.radius"] == "zacns-like"
    assert {one.key: one.standing for one in doubts(tank)}["tank.radius"] == "assumed"  # of the preset's diameter
    assert told["contact.adhesion"].ends == ("wet", "dry")
    assert "tank.liquid.damping_ratio" not in told
    assert all(one.reason and one.low != one.high for one in told.values())
    assert all(low <= high for low, high in (one.ends for one in told.values() if one.key != "contact.adhesion"))
    assert {one.standing for one in doubts(load_scenario("tank-wagon", _RIGID))} <= {"yours", "default"}


def test_the_values_of_a_brake_from_a_preset_go_up_and_down() -> None:
    braking = "braking={use: k-blocks, initial_speed: 80 km/h, onset: 0.5 s}"
    told = {one.key: one for one in doubts(load_scenario("tank-wagon", [*_RIGID, braking]))}
    friction = told["braking.blocks.friction"]
    assert (friction.own, friction.low, friction.high, friction.standing) == ("0.27", "0.216", "0.324", "assumed")
    assert [points[0][1] for points in friction.ends] == pytest.approx([0.216, 0.324])
    assert told["braking.application.time_95"].ends == pytest.approx((3.6, 4.4))


_TWO = {"count": 2, "force": "10 kN"}
_BRAKES = [
    ({"use": "k-blocks"}, "blocks", "0.27", ("0.216", "0.324")),
    ({"use": "disc-brake"}, "discs", "0.35", ("0.2975", "0.4025")),
    (
        {"blocks": {"count": 2, "force": "10 kN", "friction": "composite"}},
        "blocks",
        "composite",
        ("0.8 times", "1.2 times"),
    ),
    (
        {"blocks": {"count": 2, "force": "10 kN", "friction": [["0 km/h", 0.3], ["90 km/h", 0.2]]}},
        "blocks",
        "its points",
        (),
    ),
]


@pytest.mark.parametrize(("brake", "kind", "own", "ends"), _BRAKES)
def test_friction_of_a_brake_is_varied(
    stop: Scenario, brake: Mapping[str, Any], kind: str, own: str, ends: tuple[str, ...]
) -> None:
    """Coefficient, points and law: the torque at both ends is the own one times what the table says.

    A word that a preset assumes, such as the position P, has no ends.
    """
    braked = stop.with_({f"braking.{key}": value for key, value in brake.items()})
    told = {one.key: one for one in doubts(braked)}
    friction = told[f"braking.{kind}.friction"]
    assert friction.own == own
    assert not ends or (friction.low, friction.high) == ends
    for end, factor in zip(friction.ends, (0.85, 1.15) if kind == "discs" else (0.8, 1.2), strict=True):
        varied = braked.with_({friction.place or friction.key: end})
        for speed in (0.0, 5.0, 25.0):
            torque = factor * brake_torque(braked, speed, 0.7)
            assert brake_torque(varied, speed, 0.7) == pytest.approx(torque, rel=1e-12)
    assert "braking.application" not in told


@pytest.mark.parametrize(
    ("brake", "key"),
    [
        ("braked_weight={percentage: 80, speed: 100 km/h}", "braked_weight.percentage"),
        ("deceleration=0.6 m/s^2", "deceleration"),
    ],
)
def test_a_brake_without_torque_is_varied_too(stop: Scenario, brake: str, key: str) -> None:
    told = {one.key for one in doubts(load_scenario("tank-wagon", [*_RIGID, f"braking.{brake}"]))}
    assert f"braking.{key}" in told


def test_effects_are_those_of_the_stop_itself(stop: Scenario, found: Sensitivity) -> None:
    rows = {row["key"]: row for row in found.rows()}
    assert found.base[DISTANCE] == simulate(stop).braking_distance_m
    torque = stop.braking.torque
    assert torque is not None
    for side, factor in (("low", 0.85), ("high", 1.15)):
        own = simulate(stop.with_({"braking.torque": factor * torque}))
        assert rows["braking.torque"][f"{DISTANCE}_{side}"] == pytest.approx(own.braking_distance_m, rel=1e-12)
        assert rows["braking.torque"][f"{UNLOADING}_{side}"] == pytest.approx(own.max_wheel_unloading, rel=1e-12)
    assert rows["braking.torque"]["matters"]
    assert not rows["track.rail.mass_per_length"]["matters"]
    sizes = [max(map(abs, one.change(found.base, DISTANCE))) for one in found.effects]
    assert sizes == sorted(sizes, reverse=True)


def test_table_and_chart_are_kept(found: Sensitivity, tmp_path: Path) -> None:
    files = keep_sensitivity(found, tmp_path, keeping := Keeping())
    assert not keeping.failures
    assert len(Path(files["table"]).read_text(encoding="utf-8").splitlines()) == len(found.effects) + 1
    assert sorted(Path(file).suffix for file in files["figures"]) == [".png", ".svg"]
    chart = next(file for file in files["figures"] if file.endswith(".svg"))
    text = Path(chart).read_text(encoding="utf-8")
    assert "braking.torque (yours)" in text
    assert "track.rail.mass_per_length" not in text
    assert "the scenario itself locks no wheel" in text


@pytest.mark.parametrize(
    ("low", "matters"),
    [
        (_row(), False),
        (_row(100.0 * (1.0 + 0.9 * SMALL[DISTANCE])), False),
        (_row(100.0 * (1.0 - 1.1 * SMALL[DISTANCE])), True),
        (_row(lock=5.0), True),
        (_row(None, status="time limit"), True),
        (None, False),
    ],
)
def test_what_matters(low: Mapping[str, Any] | None, matters: bool) -> None:
    assert Effect(_WORN, (low, _row())).matters(_row()) is matters


def test_a_lock_at_another_speed_matters() -> None:
    assert Effect(_WORN, (_row(lock=9.0), _row(lock=10.0))).matters(_row(lock=10.0))
    assert not Effect(_WORN, (_row(lock=9.8), _row(lock=10.0))).matters(_row(lock=10.0))
    assert Effect(_WORN, (_row(), _row(lock=10.0))).matters(_row(lock=10.0))


def test_a_stop_without_an_answer_has_no_sensitivity(stop: Scenario) -> None:
    with pytest.raises(UsageError, match="must come to a standstill"):
        sensitivity(stop.with_({"solver.time_limit": 1.0}))
