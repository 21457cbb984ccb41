"""A sweep of many stops: memory while it runs, journal and table afterwards, stops per second.

Run as `python tests/study/many_stops.py 10000`.
"""

import csv
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from study_tools import CHEAP, count, journal_rows, run_slosh, start_slosh

from slosh_cli.scenario import load_scenario
from slosh_cli.study.outcome import solve
from slosh_cli.study.plan import Stop

SETTLED = 1000
"""Stops after which memory must not grow any more."""
FLAT = 0.10
"""Growth from there on that still counts as flat."""


@dataclass(frozen=True)
class Measured:
    """What a sweep took: resident memory (MiB) by number of finished stops, seconds from start to end."""

    stops: int
    memory: list[tuple[int, float]]
    seconds: float

    @property
    def growth(self) -> float:
        """Largest memory after the first thousand stops over that at the thousandth, less one."""
        settled = [used for done, used in self.memory if done >= SETTLED]
        return max(settled) / settled[0] - 1.0

    def report(self) -> str:
        """One line for people."""
        settled = [used for done, used in self.memory if done >= SETTLED]
        return (
            f"{self.stops} stops in {self.seconds:.1f} s, {self.stops / self.seconds:.1f} per second; "
            f"memory {settled[0]:.1f} MiB after {SETTLED} stops, {max(settled):.1f} MiB at most ({self.growth:+.1%})"
        )


def arguments(stops: int) -> list[str]:
    """A grid of `stops` cheap stops: torques and speeds, liquid and solid."""
    torques = stops // 2 // 50
    cheap = [option for option in CHEAP if option not in ("--v0", "30")]
    return ["sweep", *cheap, "--v0", "20:44.5:0.5", "--torque", f"3:{3 + 0.01 * (torques - 1):g}:0.01", "--json"]


def measure(folder: Path, stops: int) -> Measured:
    """Run the sweep in a process of its own and watch its memory; stderr shows how far it is."""
    began = time.monotonic()
    process = start_slosh(folder, *arguments(stops))
    journal, memory = folder / "outputs/cheap/journal.sqlite", []
    while process.poll() is None:
        memory.append((count(journal), resident(process.pid)))
        time.sleep(0.5)
    seconds = time.monotonic() - began
    out, err = process.communicate()
    assert process.returncode in (0, 3), err
    assert f'"runs": {stops}' in out, out
    return Measured(stops, [(done, used) for done, used in memory if used > 0.0], seconds)


def resident(pid: int) -> float:
    """Memory of a process in MiB, 0 once it has ended."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0.0
    return next((int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS:")), 0.0)


def check_table(folder: Path, stops: int) -> None:
    """Every stop is in journal and table once, in the order of the grid; some are computed again and compared."""
    assert len(journal_rows(folder / "outputs/cheap/journal.sqlite")) == stops
    with (folder / "outputs/cheap/braking_distance.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == stops
    places = [(float(row["v0_km_h"]), float(row["torque_kN_m"]), row["liquid"]) for row in rows]
    assert places == sorted(set(places))
    values = [option for option in CHEAP if "=" in option]
    base = load_scenario("paper-80-liquid", values)
    for row in rows[:: stops // 20]:
        changes = {
            "braking.initial_speed": f"{row['v0_km_h']} km/h", "braking.torque": f"{row['torque_kN_m']} kN m",
            "tank.liquid.model": row["liquid"],
        }  # fmt: skip
        answer = solve(Stop(0, "", base.with_(changes))).answer
        assert row["status"] == answer["status"]
        assert row["braking_distance_m"] == str(answer["braking_distance_m"] or "")


def check_reuse(folder: Path, stops: int) -> None:
    """The same command again computes nothing."""
    code, out, err = run_slosh(folder, *arguments(stops))
    assert code in (0, 3), err
    assert f'"reused": {stops}' in out


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        measured = measure(Path(name), int(sys.argv[1]))
        check_table(Path(name), measured.stops)
        check_reuse(Path(name), measured.stops)
        sys.stdout.write(measured.report() + "\n")
        for done, used in measured.memory[:: max(1, len(measured.memory) // 20)]:
            sys.stdout.write(f"{done:8d} stops {used:8.1f} MiB\n")
