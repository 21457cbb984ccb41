"""Whole commands beside the bare import of the libraries they need, as processes, in turns."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .conftest import ROUNDS
from .same_stop import SCENARIO

SLOSH = "import sys; from slosh_cli.cli import main; sys.exit(main())"
"""What the installed command `slosh` does."""
TYPER = "import typer"
LIBRARIES = "import numba, scipy.linalg, pandas, h5py, matplotlib.pyplot, pydantic, yaml"
STOP = str(SCENARIO.with_name("paper_80.yaml"))

COMMANDS = {
    "slosh --help": (["--help"], TYPER),
    "slosh check": (["check", STOP], TYPER),
    "slosh run, all outputs": (["run", STOP, "-o", "{folder}"], LIBRARIES),
    "slosh sweep, Figure 3": (["sweep", "--fresh", "-o", "{folder}"], LIBRARIES),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_command(
    benchmark: Any, in_turns: Callable[..., None], name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)  # as where the program is installed
    arguments, imports = COMMANDS[name]
    command = [sys.executable, "-c", SLOSH, *(argument.format(folder=tmp_path) for argument in arguments)]

    def ours() -> None:
        process = subprocess.run(command, capture_output=True, text=True, check=False)
        assert process.returncode == 0, process.stderr

    def bare() -> None:
        subprocess.run([sys.executable, "-c", imports], check=True, capture_output=True)

    in_turns(ours, bare, rounds=5 * ROUNDS if imports == TYPER else ROUNDS)  # a sixth of a second each
    benchmark.extra_info |= {"kind": "startup", "command": name, "beside": imports}
