"""Wheels on the rail's static stiffness in place of the moving rail (theory section 6)."""

import numpy as np
import pytest
from scipy.integrate import quad

from slosh_cli.errors import PhysicsError, ScenarioError
from slosh_cli.results.simulate import simulate, simulate_train
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
    assert min(result.min_wheel_load_N) < 0.5 * max(result.static_wheel_load_N)
    assert result.energy_residual < 1e-4


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
