"""Every example of docs/find.md runs, and prints what it says."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from slosh_cli import load_scenario
from slosh_cli.cli import main
from slosh_cli.scenario import scenario_to_yaml

PAGE = (Path(__file__).parents[1] / "docs" / "find.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^```sh\n(.*?)\n```", PAGE, re.MULTILINE | re.DOTALL)
(SCRIPT,) = re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    scenario = load_scenario("paper-80-liquid", ["tank.liquid.model=rigid", "braking.initial_speed=150 km/h"])
    (tmp_path / "scenario.yaml").write_text(scenario_to_yaml(scenario), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_finds_something(folder: Path, capsys: pytest.CaptureFixture[str], command: str) -> None:
    import shlex

    assert main(shlex.split(command)[1:]) == 0
    out = capsys.readouterr().out
    assert "braking.torque 11.0" in out
    assert {file.suffix for file in (folder / "outputs").rglob("*.*") if file.is_file()} == {".csv", ".png", ".svg"}


def test_the_script_runs(folder: Path) -> None:
    outcome = subprocess.run([sys.executable, "-c", SCRIPT], cwd=folder, capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stderr
    assert re.match(r"change 11\.0\d+ kN m\nlimit 1[01]\.\d+ kN m\n", outcome.stdout)
    assert len(list((folder / "figures").iterdir())) == 2


def test_nothing_found_is_exit_code_3_with_both_ends(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["find", "scenario.yaml", "--vary", "braking.torque=2:18 kN m", "--until", "braking_distance=10 m"]
    assert main([*words, "--points", "5", "--no-figures"]) == 3
    err = capsys.readouterr().err
    assert "at 2 kN m: braking distance" in err
    assert "at 18 kN m: braking distance" in err
    assert "try a wider range, such as `--vary 'braking.torque=1:36 kN m'`" in err


def test_the_force_of_blocks_is_told_with_its_torque(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two blocks of 20 kN with friction 0.3 at a wheel of 0.46 m brake with 5.52 kN m."""
    words = ["find", "scenario.yaml", "--until", "braking_distance=10 m", "--points", "5", "--no-figures"]
    blocks = ["--set", "braking.blocks={count: 2, force: 20 kN, friction: 0.3}"]
    assert main([*words, *blocks, "--vary", "braking.blocks.force=20:40 kN"]) == 3
    told = re.search(r"at 20 kN: .*, ([0-9.]+) kN m per wheel at the initial speed", capsys.readouterr().err)
    assert told is not None
    radius = load_scenario("scenario.yaml").wagon.wheelset.wheel_radius
    assert float(told[1]) == pytest.approx(2 * 20 * 0.3 * radius, rel=1e-3)
    assert main([*words, *blocks, "--vary", "braking.torque"]) == 2
    assert "its brake is told by `braking.blocks.force`" in capsys.readouterr().err
