"""What runs and checks tell of a line: channels, rest and descent on a slope, the level of the rails, refusals."""

import json
import re

import numpy as np
import pytest

from slosh_cli.application.plotting import plot
from slosh_cli.cli import main
from slosh_cli.errors import PhysicsError
from slosh_cli.results.hdf5 import read_history, write_history
from slosh_cli.results.line import descent_checks
from slosh_cli.results.recommendation import stop_deceleration
from slosh_cli.results.simulate import simulate
from slosh_cli.scenario import parse_scenario, scenario_to_yaml

PROFILE = "track.gradient=[[0 m, 0], [100 m, 0.01], [200 m, -0.02]]"
LEVEL = "track.unevenness={sigma: 1.2 mm, seed: 1}"


def test_channels_tell_gradient_height_and_level(stop, tmp_path):
    even, result = stop("paper_80_solid"), stop("paper_80_solid", PROFILE, LEVEL)
    assert not {"line_gradient", "line_height", "rail_level"} & even.channels.keys()
    s, height, gradient = (result.channels[name] for name in ("position", "line_height", "line_gradient"))
    assert gradient[np.argmin(np.abs(s - 100.0))] == pytest.approx(0.01, abs=1e-5)
    assert gradient[-1] == -0.02
    assert height[np.argmin(np.abs(s - 100.0))] == pytest.approx(0.5, abs=3e-3)
    assert height[-1] == pytest.approx(0.0 - 0.02 * (s[-1] - 200.0), abs=1e-6)  # 200 m: 0.5 + 0.5 (0.01 - 0.02)/2 ...
    assert result.unevenness_d1_m == pytest.approx(1.2e-3, rel=0.3)
    assert even.unevenness_d1_m is None
    assert 0.3e-3 < np.std(result.channels["rail_level"]) < 6e-3
    write_history(result, tmp_path / "run.h5")
    back = read_history(tmp_path / "run.h5")
    assert np.array_equal(back.channels["rail_level"], result.channels["rail_level"])
    assert back.unevenness_d1_m == result.unevenness_d1_m
    assert set(plot(back)) - set(plot(even)) == {"line"}


def rest(result):
    return next((check for check in result.checks if "after the stop" in check.name), None)


def test_a_rigid_wagon_too_may_not_hold_on_a_slope(stop):
    assert rest(stop("paper_80_solid")) is None
    assert rest(stop("paper_80_solid", "track.gradient=-5 permille")).within
    hill = stop("paper_80_solid", "track.gradient=[[0 m, 0], [100 m, 0.08]]", "braking.torque=2 kN m")
    found = rest(hill)
    assert found.value == pytest.approx(hill.weight_N * hill.channels["line_gradient"][-1], rel=1e-9)
    assert found.limit == pytest.approx(8 * 2000 / 0.46 + 851, rel=1e-9)
    assert not found.within
    assert "the gradient would push it back" in found.meaning


def test_a_liquid_feels_brakes_but_no_gradient(shipped):
    level, slope = shipped("paper_80"), shipped("paper_80", "track.gradient=-2 %")
    assert stop_deceleration(level) == stop_deceleration(slope)


def test_a_downhill_steeper_than_the_brakes_is_told_before_a_run(shipped):
    assert descent_checks(shipped("paper_80", "track.gradient=1 %")) == ()
    (found,) = descent_checks(shipped("paper_80", "track.gradient=[[0 m, 0], [100 m, -0.05]]", "braking.torque=2 kN m"))
    assert found.value == pytest.approx(0.05 * 9.81)
    assert not found.within
    (holds,) = descent_checks(shipped("paper_80", "track.gradient=-1 %"))
    assert holds.within


@pytest.fixture
def measured(tmp_path):
    def write(end):
        x = np.arange(0.0, end, 0.5)
        rows = "".join(f"{a},{b:.6f}\n" for a, b in zip(x, 1e-3 * np.sin(x), strict=True))
        (tmp_path / "measured.csv").write_text("x_m,z_m\n" + rows)
        return tmp_path / "measured.csv"

    return write


def test_a_measured_rail_has_to_cover_the_stop(shipped, measured):
    with pytest.raises(
        PhysicsError, match=r"must cover the stop, but it ends at 99\.5 m and the leading wheel came to 23"
    ):
        simulate(shipped("paper_80_solid", f"track.unevenness={{file: {measured(100.0)}}}"))
    assert simulate(shipped("paper_80_solid", f"track.unevenness={{file: {measured(260.0)}}}")).status == "stopped"


def test_a_resolved_scenario_depends_on_no_file(shipped, measured):
    file = measured(260.0)
    scenario = shipped("paper_80_solid", f"track.unevenness={{file: {file}}}")
    file.unlink()
    assert parse_scenario(scenario_to_yaml(scenario)) == scenario
    assert scenario.with_({"braking.torque": 6e3}).track == scenario.track


def test_check_prints_the_level_with_its_convention(capsys):
    words = ["check", "scenarios/paper_80_solid.yaml", "--set", "track.unevenness={spectrum: fra-6}"]
    assert main(words) == 0
    told = capsys.readouterr().out
    assert re.search(r"1\.4[234] mm", told)
    assert "one-sided, per rad/m" in told
    assert "FRA vertical profile 0.25 A_v" in told
    assert main([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["unevenness_d1_m"] == pytest.approx(1.43e-3, rel=0.01)
