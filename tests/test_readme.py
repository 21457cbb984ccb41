"""What the README tells people to type works in an empty folder, in the README's own order."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from slosh_cli.version import install_command

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```", README, re.MULTILINE | re.DOTALL)
COMMANDS = [
    line for kind, text in BLOCKS if kind in ("", "sh") for line in text.splitlines() if line.startswith("slosh ")
]
LONG = ("slosh validate ",)
"""The whole validation takes a minute."""
ELSEWHERE = ("--cluster",)
"""What needs other machines."""


def run(folder: Path, *words: str) -> "subprocess.CompletedProcess[str]":
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "COLUMNS")}
    return subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=600)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty folder but for the files that the README speaks of as the reader's own."""
    empty = tmp_path_factory.mktemp("readme")
    (empty / "brake.csv").write_text("time_s,deceleration_m_s2\n0,0\n2,1.5\n")
    (study,) = [text for kind, text in BLOCKS if kind == "yaml" and "\nvary:" in text]
    (empty / "study.yaml").write_text(study, encoding="utf-8")
    return empty


def test_the_readme_has_the_commands_of_every_chapter() -> None:
    assert {shlex.split(command, comments=True)[1] for command in COMMANDS} >= {
        "init", "check", "run", "plot", "sweep", "tank", "validate",
    }  # fmt: skip


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_works(folder: Path, command: str) -> None:
    if any(word in command for word in ELSEWHERE) or f"{command.partition('#')[0].strip()} " in LONG:
        pytest.skip("needs other machines, or is a test of its own")
    words = shlex.split(command, comments=True)
    outcome = run(
        folder, sys.executable, "-c", "import sys; from slosh_cli.cli import main; sys.exit(main())", *words[1:]
    )
    assert outcome.returncode == 0, outcome.stderr
    assert "Traceback" not in outcome.stderr


def test_the_python_example_works_outside_a_checkout(tmp_path: Path) -> None:
    (example,) = [text for kind, text in BLOCKS if kind == "python"]
    outcome = run(tmp_path, sys.executable, "-c", f"import matplotlib; matplotlib.use('agg')\n{example}")
    assert outcome.returncode == 0, outcome.stderr
    assert re.match(r"stopped \d+\.\d+ m\n", outcome.stdout)


@pytest.mark.parametrize("extra", ["cluster", "validation"])
def test_the_command_that_installs_an_extra_names_what_the_package_index_has(extra: str) -> None:
    import tomllib

    text = (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    needed = tomllib.loads(text)["project"]["optional-dependencies"][extra]
    assert install_command(extra) == "python -m pip install " + " ".join(f"'{name}'" for name in needed)
