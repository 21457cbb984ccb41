"""For each case at least one deliberate error in the code under test turns it red."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from sabotages import SABOTAGES, Sabotage, edited

from slosh_cli.solver import setup
from slosh_cli.tank import longitudinal
from slosh_cli.validation import registry, runs
from slosh_cli.validation.data_file import read_case

ROOT = Path(__file__).parents[2]
IN_MEMORY = sorted(name for name, sabotage in SABOTAGES.items() if not sabotage.copy)
IN_A_COPY = sorted(name for name, sabotage in SABOTAGES.items() if sabotage.copy)
SLOW_CASES = {"second-code", "figure3"}


def test_every_case_lists_its_sabotages_and_every_sabotage_is_listed():
    listed = {catch.test: name for name in registry.NAMES for catch in read_case(name).catches}
    assert listed == {name: sabotage.case for name, sabotage in SABOTAGES.items()}
    assert set(listed.values()) == set(registry.NAMES)


@pytest.fixture
def fresh(monkeypatch):
    """Nothing that was computed before the sabotage is used in it, nor the other way round."""
    monkeypatch.setattr(longitudinal, "_CACHE", longitudinal._Cache())
    monkeypatch.setattr(longitudinal, "_MOST_UNKNOWNS", 20_000)  # what does not converge gives up sooner
    computed = (runs.stop, setup._wagon, setup._rail)
    for one in computed:
        one.cache_clear()
    yield monkeypatch
    for one in computed:
        one.cache_clear()


def marked(name: str) -> object:
    return pytest.param(name, marks=[pytest.mark.slow] if SABOTAGES[name].case in SLOW_CASES else [])


@pytest.mark.parametrize("name", [marked(name) for name in IN_MEMORY])
def test_an_error_in_memory_turns_the_case_red(name, fresh):
    sabotage = SABOTAGES[name]
    data = read_case(sabotage.case)
    if not registry.is_available(data):
        pytest.skip(f"{sabotage.case} needs {data.needs}")
    registry.compute_of(sabotage.case)  # what it imports is imported before it is replaced
    for one in sabotage.edits:
        owner, function, wrong = edited(one)
        true = getattr(owner, function)
        fresh.setattr(owner, function, wrong)
        for module in list(sys.modules.values()):  # where it was imported by name
            if getattr(module, "__name__", "").startswith("slosh_cli.") and getattr(module, function, None) is true:
                fresh.setattr(module, function, wrong)
    result = registry.case_result(data)
    assert not result.passed
    red = [row.quantity for row in result.rows if not row.passed]
    assert any(sabotage.red in quantity for quantity in red), [row for row in result.rows if not row.passed]


def sabotaged_copy(sabotage: Sabotage, folder: Path) -> None:
    for part in ("slosh_cli", "scenarios"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    for one in sabotage.edits:
        file = folder / "slosh_cli" / Path(*one.module.split(".")).with_suffix(".py")
        text = file.read_text(encoding="utf-8")
        *classes, name = one.function.split(".")
        begin = 0
        for word in (*(f"class {part}(" for part in classes), f"def {name}("):
            begin = text.index(word, begin)
        assert one.old in text[begin:], f"{one.function} has no {one.old!r} any more"
        file.write_text(text[:begin] + text[begin:].replace(one.old, one.new, 1), encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("name", IN_A_COPY)
def test_an_error_in_a_kernel_turns_the_case_red(name, tmp_path):
    """Compiles the whole time loop: a minute each."""
    sabotage = SABOTAGES[name]
    sabotaged_copy(sabotage, tmp_path)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
    code = "import sys; from slosh_cli.cli import main; sys.exit(main(sys.argv[1:]))"
    words = ["validate", sabotage.case, "--json", "-o", str(tmp_path / "out")]
    run = subprocess.run(
        [sys.executable, "-c", code, *words], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode == 1, run.stderr
    (case,) = json.loads(run.stdout)["cases"]
    assert not case["passed"]
    red = [
        row["quantity"]
        for row in case["rows"]
        if row["tolerance"] is not None and (row["deviation"] is None or row["deviation"] > row["tolerance"])
    ]
    assert any(sabotage.red in quantity for quantity in red), red
