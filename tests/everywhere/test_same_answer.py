"""Runs agree to the last bit: repeated, side by side, and in processes with other threads, hashes, zones, folders."""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest

from everywhere.answers import STOPS, answer, difference, digest, distances_differ, scenario_of
from everywhere.comparison import LARGEST_DISTANCE, SAME, SPREAD, verdict

TESTS = Path(__file__).parents[1]
CHOSEN = ("paper_160, three wheels lock", "paper_80, wheels lift and land", "paper_80, computed modes",
          "tank_wagon, shallow water", "tank_wagon, uneven rail")  # fmt: skip
SWEEP = (
    "sweep", "--v0", "30,40", "--torque", "5,15", "--set", "solver.tolerance=1e-2", "--set", "name=cheap",
    "--set", "track.domain.length=30 m", "--set", "track.domain.element_length=0.9 m", "-o", "study",
)  # fmt: skip

CHILD = f"""
import json, locale, sys
sys.path.insert(0, {str(TESTS)!r})
try:
    locale.setlocale(locale.LC_ALL, "")
except locale.Error:
    pass
from everywhere.answers import digest, scenario_of
from slosh_cli.cli.shell import execute
from slosh_cli.results.simulate import simulate
digests = {{name: digest(simulate(scenario_of(name))) for name in {CHOSEN!r}}}
code = execute([*{SWEEP!r}, "--jobs", sys.argv[1]])
with open("told.json", "w") as file:
    json.dump({{"digests": digests, "code": code}}, file)
"""

THREADS = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
SURROUNDINGS = {
    "one thread": {
        "PYTHONHASHSEED": "1", "TZ": "Asia/Kathmandu", "LC_ALL": "de_DE.UTF-8", **dict.fromkeys(THREADS, "1")
    },
    "two threads": {"PYTHONHASHSEED": "4711", "TZ": "America/Caracas", "LC_ALL": "C", **dict.fromkeys(THREADS, "2")},
}  # fmt: skip


@dataclass
class Told:
    """What a process of its own answered."""

    digests: dict[str, str]
    table: bytes


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Told]:
    """The answers of one process for each of the `SURROUNDINGS`, at the same time, each in a folder of its own."""
    folders = {name: tmp_path_factory.mktemp(name) for name in SURROUNDINGS}
    children = {
        name: subprocess.Popen(
            [sys.executable, "-c", CHILD, more["OMP_NUM_THREADS"]], cwd=folders[name], env={**os.environ, **more},
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        )
        for name, more in SURROUNDINGS.items()
    }  # fmt: skip
    found = {}
    for name, child in children.items():
        _, err = child.communicate(timeout=600)
        assert child.returncode == 0, err
        answers = json.loads((folders[name] / "told.json").read_text())
        assert answers["code"] == 0, err
        found[name] = Told(answers["digests"], (folders[name] / "study" / "braking_distance.csv").read_bytes())
    return found


@pytest.fixture(scope="module")
def here() -> dict[str, str]:
    from slosh_cli.results.simulate import simulate

    return {name: digest(simulate(scenario_of(name))) for name in CHOSEN}


def test_a_digest_tells_the_last_bit(here: dict[str, str]) -> None:
    from slosh_cli.results.simulate import simulate

    result = simulate(scenario_of("paper_80, wheels lift and land"))
    assert digest(result) == here["paper_80, wheels lift and land"]
    name, values = next(iter(result.channels.items()))
    changed = values.copy()
    changed[-1] += abs(changed[-1]) * 2.5e-16
    assert changed[-1] != values[-1]
    object.__setattr__(result, "channels", {**result.channels, name: changed})
    assert digest(result) != here["paper_80, wheels lift and land"]


def test_stops_side_by_side_are_the_same_to_the_last_bit(here: dict[str, str]) -> None:
    from slosh_cli.results.simulate import simulate

    with ThreadPoolExecutor(4) as pool:
        found = pool.map(lambda name: (name, digest(simulate(scenario_of(name)))), [*CHOSEN, *reversed(CHOSEN)])
        assert all(here[name] == one for name, one in found)


@pytest.mark.parametrize("name", SURROUNDINGS)
def test_another_process_gives_the_same_to_the_last_bit(here: dict[str, str], told: dict[str, Told], name: str) -> None:
    assert told[name].digests == here


def test_a_study_is_the_same_byte_for_byte(told: dict[str, Told]) -> None:
    first, second = (one.table for one in told.values())
    assert first.count(b"\n") == 9
    assert first == second


def test_the_comparison_of_environments_knows_same_from_other() -> None:
    """Within 1e-9 is the same; further apart only where the stop's own last digit moves it as far."""
    one = {"status": "stopped", "steps": 7, "braking_distance_m": 200.0, "loads": [1e3, 2e3], "rounding": 1e-12}

    def moved(share: float, **more: object) -> dict[str, object]:
        return one | {"braking_distance_m": 200.0 * (1 + share), "loads": [1e3, 2e3 * (1 + share)]} | more

    assert verdict(one, moved(0.9 * SAME))[0] == "same"
    assert verdict(one, moved(2 * SAME))[0] == "DIFFERS"
    chatter = {"rounding": 2e-9 / SPREAD}
    assert verdict(one, moved(1.9e-9, **chatter))[0].startswith("magnifies rounding")
    assert verdict(one, moved(2.1e-9, **chatter))[0] == "DIFFERS"
    assert verdict(one, moved(1.1 * LARGEST_DISTANCE, rounding=1.0))[0] == "DIFFERS"
    assert verdict(one, one | {"status": "failed"})[0] == "DIFFERS"
    assert verdict(one, one | {"braking_distance_m": None})[0] == "DIFFERS"


def test_another_rounding_of_the_initial_speed_hardly_moves_a_stop_without_lift() -> None:
    name = "paper_160"
    assert name in STOPS
    plain, nudged = answer(name), answer(name, 4e-16)
    assert plain != nudged
    assert distances_differ(plain, nudged) < 1e-11
    assert difference(plain, nudged) < SAME
