"""Ten thousand cheap stops by one `slosh sweep`: `make bench-batch`."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

MANY_STOPS = Path(__file__).parents[1] / "study" / "many_stops.py"


def test_ten_thousand_stops(benchmark: Any) -> None:
    """The stops are those of `tests/study/many_stops.py`: 20 to 44.5 km/h, coarse rail, tolerance 1e-2."""
    said = benchmark.pedantic(
        subprocess.run, args=([sys.executable, str(MANY_STOPS), "10000"],), rounds=1,
        kwargs={"check": True, "capture_output": True, "text": True},
    ).stdout  # fmt: skip
    found = re.match(r"(\d+) stops in ([\d.]+) s, .*memory ([\d.]+) MiB .*?, ([\d.]+) MiB at most", said)
    assert found, said
    stops, seconds, settled, most = map(float, found.groups())
    benchmark.extra_info |= {
        "kind": "batch", "stops": int(stops), "seconds": seconds, "settled_MiB": settled, "most_MiB": most,
    }  # fmt: skip
