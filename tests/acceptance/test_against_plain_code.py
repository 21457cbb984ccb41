"""The compiled solver against the plain implementation in `tests/reference_code`, written without sight of it.

The plain code's numbers are stored (`make reference` recomputes them); `tests/reference_code/test_plain.py` re-runs one
of its stops live. Its own error, by halving its step, is below 5e-6 of the distance and 0.01 kN in wheel loads.
"""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from slosh_cli import load_scenario, simulate

ROOT = Path(__file__).parents[2]
FINEST_STEP = 0.0005


def _stored() -> dict[str, dict[str, str]]:
    with (ROOT / "tests/data/plain_stops.csv").open(encoding="utf-8", newline="") as file:
        return {row["stop"]: row for row in csv.DictReader(file) if float(row["step_s"]) == FINEST_STEP}


STORED = _stored()


@pytest.mark.parametrize("stop", STORED)
def test_distance_loads_and_locking_agree(stop: str) -> None:
    row = STORED[stop]
    overrides = [text.strip() for text in row["overrides"].split(";") if text.strip()]
    if "tank.liquid.model=rigid" in overrides:
        overrides.append("tank.coefficients=computed")
    result = simulate(load_scenario(ROOT / "scenarios/paper_80.yaml", overrides))
    assert result.braking_distance_m == pytest.approx(float(row["distance_m"]), rel=5e-4)
    assert result.braking_time_s == pytest.approx(float(row["time_s"]), rel=5e-4)
    for wheel in range(4):
        assert result.min_wheel_load_N[wheel] == pytest.approx(float(row[f"min_load_{wheel + 1}_N"]), abs=500)
        assert result.max_wheel_load_N[wheel] == pytest.approx(float(row[f"max_load_{wheel + 1}_N"]), abs=500)
        assert result.locked_time_s[wheel] == pytest.approx(float(row[f"locked_time_{wheel + 1}_s"]), abs=0.02)
