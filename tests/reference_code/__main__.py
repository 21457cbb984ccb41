"""Write the oracle's stops to ``tests/data/plain_stops.csv``: ``python -m tests.reference_code``.

Takes about ten minutes. Every stop is made twice, the second time with half the step, so the file itself
shows how far it has converged.
"""

import csv
import sys
from pathlib import Path

from slosh_cli.scenario import load_scenario

from .plain_stop import PlainStop, stop

ROOT = Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "scenarios" / "paper_80.yaml"
TABLE = ROOT / "tests" / "data" / "plain_stops.csv"
STEPS = (1e-3, 5e-4)  # s

RIGID = "tank.liquid.model=rigid"
STOPS: dict[str, list[str]] = {
    "locking": [RIGID, "braking.initial_speed=150 km/h", "braking.torque=25 kN m"],
    "wet": ["contact.adhesion=wet"],
    "paper-80-liquid": [],
    "fast": [RIGID, "braking.initial_speed=160 km/h", "braking.torque=10 kN m"],
    "quick": ["braking.initial_speed=30 km/h", "braking.torque=20 kN m"],
    "three-lock": [RIGID, "braking.initial_speed=150 km/h", "braking.torque=19.6 kN m"],
    "four-lock": [RIGID, "braking.initial_speed=150 km/h", "braking.torque=20 kN m"],
}


def row(name: str, step: float, result: PlainStop) -> dict[str, str]:
    """One line of the table, the unit in every column's name; distance and time count from the onset."""
    cells = {
        "stop": name,
        "overrides": "; ".join(STOPS[name]),
        "step_s": f"{step:g}",
        "distance_m": f"{result.distance:.6f}",
        "time_s": f"{result.time:.6f}",
    }
    for column, values, decimals in (
        ("min_load_{}_N", result.min_loads, 1),
        ("max_load_{}_N", result.max_loads, 1),
        ("locked_time_{}_s", result.locked_time, 5),
    ):
        cells |= {column.format(wheel + 1): f"{value:.{decimals}f}" for wheel, value in enumerate(values)}
    return cells | {"energy_residual": f"{result.energy_residual:.2e}"}


def main() -> None:
    """Make all stops, then write the table in one piece."""
    rows = []
    for name, overrides in STOPS.items():
        scenario = load_scenario(SCENARIO, overrides=overrides)
        for step in STEPS:
            rows.append(row(name, step, stop(scenario, step)))
            sys.stderr.write(f"{name}, {step:g} s: {rows[-1]['distance_m']} m\n")
    TABLE.parent.mkdir(exist_ok=True)
    part = TABLE.with_suffix(".part")
    with part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    part.replace(TABLE)


if __name__ == "__main__":
    main()
