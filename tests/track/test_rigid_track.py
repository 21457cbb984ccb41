"""Wheels on the rail's static stiffness in place of the moving rail (theory section 6)."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from slosh_cli.errors import PhysicsError, ScenarioError
from slosh_cli.results.simulate import simulate, simulate_train
from slosh_cli.results.wagon_range import wagon_checks
from slosh_cli.scenario.train_file import load_train
from slosh_cli.track.mem import rail_model, steady_shapes

WHEELS = np.array([6.9, 5.1, -5.1, -6.9])
TRACKS = {
    "paper": (),
    "no shear": ("track.foundation.shear_stiffness=0 N",),
    "stiff shear": ("track.foundation.shear_stiffness=4.0e7 N",),
}


def track_of(shipped, *overrides):
    return shipped("paper_80_solid", "track.domain.length=200 m", "track.domain.element_length=0.1 m", *overrides).track


@pytest.mark.parametrize("name", TRACKS)
def test_a_spring_is_as_stiff_as_the_standing_rail_under_one_load(shipped, name):
    track = track_of(shipped, *TRACKS[name])
    springs = rail_model(track.model_copy(update={"model": "rigid"}), WHEELS)
    single = rail_model(track, np.array([0.0]))
    deflection = -steady_shapes(single, 0.0)[single.contact[0], 0]
    assert 1.0 / springs.stiffness == pytest.approx(deflection, rel=1e-5)
    assert -steady_shapes(springs, 0.0)[:4] == pytest.approx(np.eye(4) / springs.stiffness, rel=1e-12)


@pytest.mark.parametrize("name", TRACKS)
def test_a_spring_moves_and_damps_as_the_rail_in_the_shape_of_its_load(shipped, name):
    track = track_of(shipped, *TRACKS[name])
    springs = rail_model(track.model_copy(update={"model": "rigid"}), WHEELS)
    bending, foundation = track.rail.youngs_modulus * track.rail.second_moment, track.foundation
    roots = np.roots([bending, 0.0, -foundation.shear_stiffness, 0.0, foundation.stiffness])
    one, two = roots[roots.real > 0.0].astype(complex)

    def shape(x):
        return ((two * np.exp(-one * x) - one * np.exp(-two * x)) / (two - one)).real

    def slope(x):
        return (one * two * (np.exp(-two * x) - np.exp(-one * x)) / (two - one)).real

    squares = [2.0 * quad(lambda x, f=f: f(x) ** 2, 0.0, 60.0, limit=400)[0] for f in (shape, slope)]
    assert springs.mass == pytest.approx(track.rail.mass_per_length * squares[0], rel=1e-7)
    damping = foundation.damping * squares[0] + foundation.shear_damping * squares[1]
    assert springs.damping == pytest.approx(damping, rel=1e-7)


@pytest.mark.parametrize("liquid", ["rigid", "modal", "shallow-water"])
def test_a_stop_on_springs_is_that_on_the_rail(shipped, liquid):
    scenario = shipped("tank_wagon", f"tank.liquid.model={liquid}", "braking.application=P", "output.interval=1 s")
    rail, springs = simulate(scenario), simulate(scenario.with_({"track.model": "rigid"}))
    assert springs.braking_distance_m == pytest.approx(rail.braking_distance_m, rel=2e-5)
    assert springs.braking_distance_m != rail.braking_distance_m
    assert springs.max_wheel_unloading == pytest.approx(rail.max_wheel_unloading, abs=1e-3)
    assert springs.static_wheel_load_N == pytest.approx(rail.static_wheel_load_N, rel=1e-6)
    assert springs.energy_residual < 1e-5


def test_the_ledger_closes_over_dips_and_lifted_wheels(shipped):
    dip = "track.unevenness={dips: [{position: 40 m, length: 0.6 m, depth: 8 mm}]}"
    result = simulate(shipped("tank_wagon", "track.model=rigid", dip, "braking.initial_speed=60 km/h"))
    assert result.status == "stopped"
    assert min(result.min_wheel_load_N) == 0.0
    assert result.energy_residual < 1e-4


def test_springs_carry_no_waves_whose_error_would_shorten_steps(shipped):
    fast = shipped(
        "paper_80_solid", "track.foundation.stiffness=1e5 N/m^2", "track.foundation.shear_stiffness=0 N",
        "braking.initial_speed=140 m/s", "output.interval=1 s",
    )  # fmt: skip
    assert simulate(fast.with_({"track.model": "rigid"})).steps < simulate(fast).steps


@pytest.mark.parametrize("window", ["length=14 m", "element_length=3 m"])
def test_the_stretch_of_a_rail_that_is_not_computed_may_be_any(shipped, window):
    given = f"track.domain.{window}"
    with pytest.raises(ScenarioError, match=r"track\.domain"):
        shipped("tank_wagon", given)
    assert shipped("tank_wagon", given, "track.model=rigid").track.domain


DIP = "track.unevenness={{dips: [{{position: 40 m, length: {} m, depth: 4 mm}}]}}"


@pytest.mark.parametrize(
    ("model", "blow", "told"),
    [
        ("rigid", DIP.format(0.6), True),
        ("rigid", "wagon.wheel_flats=[{wheel: 2, length: 20 mm, depth: 0.1 mm}]", True),
        ("rigid", DIP.format(6), False),
        ("rigid", "track.unevenness={spectrum: erri-low}", False),
        ("moving-element", DIP.format(0.6), False),
    ],
)
def test_a_blow_that_springs_give_back_is_warned_of(shipped, model, blow, told):
    found = wagon_checks(shipped("tank_wagon", f"track.model={model}", blow))
    assert any("Wheels on springs" in check.meaning and not check.within for check in found) is told


def test_wheel_loads_over_what_is_not_warned_of_are_those_on_the_rail(shipped):
    rail = simulate(shipped("tank_wagon", DIP.format(2), "braking.initial_speed=60 km/h", "tank.liquid.model=rigid"))
    springs = simulate(rail.scenario.with_({"track.model": "rigid"}))
    assert all(check.within for check in wagon_checks(springs.scenario) if "Wheels on springs" in check.meaning)
    assert springs.max_wheel_unloading == pytest.approx(rail.max_wheel_unloading, abs=1e-2)
    assert springs.max_wheel_load_N == pytest.approx(rail.max_wheel_load_N, rel=1e-2)


def test_no_stop_begins_above_the_critical_speed_on_springs_either(shipped):
    soft = ("track.foundation.stiffness=1e5 N/m^2", "track.foundation.shear_stiffness=0 N")
    with pytest.raises((PhysicsError, ScenarioError), match="critical speed"):
        simulate(
            shipped(
                "paper_80_solid", "track.model=rigid", *soft, "track.rail.second_moment=1e-6 m^4", "track.domain={}",
                "braking.initial_speed=90 m/s",
            )
        )  # fmt: skip


TRAIN = """\
format: 1
name: short
vehicles:
  - {scenario: tank-wagon, set: {tank.liquid.model: rigid, braking.torque: 6 kN m}}
  - {scenario: tank-wagon, count: 3, set: {braking.application: P}}
braking: {initial_speed: 20 km/h, onset: 0.1 s}
output: {interval: 1 s}
"""


@pytest.fixture
def train(tmp_path):
    """Load the train with text added, and overrides."""

    def load(*overrides, added=""):
        file = tmp_path / "short.yaml"
        file.write_text(TRAIN.replace("3, set: {", f"3, set: {{{added}, ") if added else TRAIN, encoding="utf-8")
        return load_train(file, overrides)

    return load


def models(train):
    return [vehicle.track.model == "rigid" for vehicle in train.vehicles]


def test_a_train_or_a_vehicle_is_put_on_springs_by_a_word(train):
    assert models(train()) == [False] * 4
    assert models(train("track=rigid")) == models(train().with_({"track": "rigid"})) == [True] * 4
    assert models(train("vehicles.2.track=rigid")) == [False, True, False, False]
    assert models(train(added="track: rigid")) == [False, True, True, True]
    assert train("track=rigid").vehicles[1].track.rail == train().vehicles[1].track.rail


def test_the_word_is_written_as_a_word(train, tmp_path):
    own, *_ = train("track=rigid").text.split("---\n")
    assert "track: rigid\n" in own
    (tmp_path / "again.yaml").write_text(own, encoding="utf-8")
    assert models(load_train(tmp_path / "again.yaml")) == [True] * 4


def test_a_mistake_elsewhere_is_told_alone(train):
    with pytest.raises(ScenarioError) as refused:
        train("track=rigid").with_({"braking.onset": -1.0})
    assert [problem.key for problem in refused.value.problems] == ["braking.onset"]


def test_a_train_of_one_is_the_wagon_on_springs(train):
    alone = train("track=rigid", "braking.initial_speed=60 km/h")
    one = replace(alone, vehicles=alone.vehicles[:1])
    whole, wagon = simulate_train(one), simulate(one.vehicles[0])
    assert (whole.braking_distance_m, whole.energy_residual) == (wagon.braking_distance_m, wagon.energy_residual)


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (("track=soft",), "must be `rigid`"),
        (("track=rigid", "vehicles.2.track=rigid"), "must be said of the whole train"),
        (("track.model=stiff",), "`moving-element` or `rigid`"),
    ],
)
def test_other_words_are_refused(train, overrides, told):
    with pytest.raises(ScenarioError, match=told):
        train(*overrides)


def test_a_train_on_springs_is_that_on_the_rail(train):
    rail, springs = simulate_train(train()), simulate_train(train("track=rigid"))
    mixed = simulate_train(train("vehicles.2.track=rigid"))
    assert springs.braking_distance_m == pytest.approx(rail.braking_distance_m, rel=5e-5)
    assert springs.max_compression_N == pytest.approx(rail.max_compression_N, rel=5e-3)
    assert mixed.max_compression_N == pytest.approx(rail.max_compression_N, rel=5e-3)
    assert len({rail.max_compression_N, springs.max_compression_N, mixed.max_compression_N}) == 3
    assert max(one.energy_residual for one in (springs, mixed)) < 1e-5


def test_the_ledger_of_a_train_closes_with_friction_in_couplings_and_lifted_wheels(train):
    dip = "all.track.unevenness={dips: [{position: 45 m, length: 0.6 m, depth: 8 mm}]}"
    light = ("all.tank.liquid.model=rigid", "all.tank.fill=0.05", "braking.initial_speed=60 km/h")
    result = simulate_train(train(*light, dip, "all.track=rigid"))
    assert result.status == "stopped"
    assert result.max_wheel_unloading == 1.0
    assert result.max_compression_N > 1e3
    assert result.energy_residual < 1e-4
