"""Grids that nobody can wait for, and ranges of numbers that cannot be counted through."""

from pathlib import Path

import pytest
from answer import answer
from good_files import Good

RANGES = (
    "1e999", "1:1e999:1", "1:1e400:1e-400", "0:1e-400:1e-405", "1e-400:1:1e-400", "1:2:1e-99999999", "1:1e999999999:1",
    "0:1e300:1e299", "-1e999:1e999:1e998", "9" * 5000, f"0:{'9' * 5000}:1", ":::", "1:2", "1:2:0", "1:2:-1", "nan:1:1",
    "inf", "0x10", "1_000", "1;2", "[1", "{a: 1", "'", '"', ",", "1,,2", "80,160:", "\ud83d", "1e5:1e6:1e1 km/h",
)  # fmt: skip


@pytest.mark.parametrize("spec", RANGES)
def test_a_range_beyond_counting_is_refused(spec: str) -> None:
    answer("sweep", "--v0", spec, "--dry-run", code=2)
    answer("sweep", "--vary", f"tank.length={spec}", "--dry-run", code=2)
    answer("find", "--vary", f"tank.length={spec}", "--until", "first_lock", "paper-80-liquid", code=2)


@pytest.mark.parametrize(
    "words",
    [
        ["--v0", "10:160:0.01", "--torque", "2:30:1"],
        ["--vary", "tank.fill=0.3:0.9:0.00001", "--vary", "tank.length=10:15:1 m"],
        ["--vary", "tank.fill=0.3:0.9:0.01", "--vary", "tank.length=10:15:0.001 m"],
    ],
)
def test_a_grid_of_300_000_stops_is_refused_before_it_is_planned(words: list[str]) -> None:
    told = answer("sweep", *words, "--dry-run", code=2).err
    assert "must have at most 200,000 stops" in told
    assert "widen the steps" in told


def test_a_large_grid_is_told_of_before_it_is_planned(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    told: list[str] = []

    def plan(study: object, *_: object) -> None:
        told.append(str(study))
        raise KeyboardInterrupt

    monkeypatch.setattr("slosh_cli.study.runner.plan", plan)
    words = ["--vary", "tank.fill=0.3:0.9:0.01", "--v0", "80:179:1", "--dry-run"]
    assert "stops; each is checked" in answer("sweep", *words, code=130).err
    assert told


def test_a_list_may_be_long_but_not_endless(good: Good, folder: Path) -> None:
    many = ", ".join(f"{0.2 + 1e-6 * n:.6f}" for n in range(19_000))
    (folder / "study.yaml").write_text(f"base: paper-80-liquid\nvary:\n  tank.fill: [{many}]\n  x: 1:9:1\n", "utf-8")
    answer("sweep", "study.yaml", "--dry-run", code=2)
