"""The example of docs/defaults.md runs; what it says may be left out may be."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from slosh_cli import load_scenario
from slosh_cli.cli import main
from slosh_cli.scenario import parse_scenario, scenario_to_yaml

PAGE = (Path(__file__).parents[1] / "docs" / "defaults.md").read_text(encoding="utf-8")


def _examples(kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


def test_the_sections_of_the_page_may_be_left_out() -> None:
    text = scenario_to_yaml(load_scenario("tank-wagon"))
    for section in ("track", "contact", "solver"):
        text = re.sub(rf"^{section}:\n(?: .*\n)+", "", text, flags=re.MULTILINE)
    text = re.sub(r"^  running_resistance:\n(?:    .*\n)+", "", text, flags=re.MULTILINE)
    (example,) = _examples("yaml")
    scenario = parse_scenario(text + example)
    assert scenario.track.foundation.stiffness == 2e7
    kept = {key.rpartition(".")[0] for key in scenario.defaults}
    assert kept >= {"track.rail", "track.foundation", "contact", "wagon.running_resistance", "solver"}


def test_command_and_script_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = scenario_to_yaml(load_scenario("tank-wagon", ["tank.liquid.model=rigid", "solver.tolerance=1e-3"]))
    (tmp_path / "scenario.yaml").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    (command,), (script,) = _examples("sh"), _examples("python")
    assert main(command.split()[1:]) == 0
    outcome = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith("braking.torque (")
