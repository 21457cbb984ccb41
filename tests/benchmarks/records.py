"""What a run of the benchmarks left behind, as records and as the ratios that are asked for."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

Record = Mapping[str, Any]

PARTS = ("contestants", "floor", "scaling", "startup", "liquids", "batch")
"""Files of benchmarks, `bench_PART.py`; each leaves `PART.json`."""

ALLOWED_ERROR = 2e-4
"""Error in distance at which contestants are compared."""
CONTESTANTS = {
    "a": "textbook: Newmark, solve_banded, Python loop",
    "b": "rail fixed in the ground",
    "c": "exudyn, no rail",
    "d": "scipy solve_ivp",
    "d*": "scipy solve_ivp, scaled tolerances",
    "e": "slosh",
}
TEXTBOOK_STEP = "0.5 ms"


def read(folder: Path) -> list[dict[str, Any]]:
    """Records of the run whose JSON lies in `folder`: what each benchmark noted, with the median of its times (s)."""
    found = []
    for part in PARTS:
        if (file := folder / f"{part}.json").exists():
            for entry in json.loads(file.read_text(encoding="utf-8"))["benchmarks"]:
                info, times = entry["extra_info"], entry["stats"]
                scale = info.get("scale", 1.0)
                found.append(info | {"seconds": scale * times["median"], "rounds": times["rounds"]})
    return found


def of_kind(records: Iterable[Record], kind: str) -> list[Record]:
    """Records of one kind in the order they were made."""
    return [record for record in records if record.get("kind") == kind]


def fastest(records: Iterable[Record], contestant: str) -> Record | None:
    """A contestant's quickest run within the allowed error."""
    sound = [
        one
        for one in of_kind(records, "contestant")
        if one["contestant"] == contestant and one["error"] is not None and one["error"] <= ALLOWED_ERROR
    ]
    return min(sound, key=lambda one: one["seconds"], default=None)


@dataclass(frozen=True)
class Ratio:
    """A measured ratio beside its limit; `least` says that it must not be smaller, otherwise not larger."""

    what: str
    value: float | None
    limit: float | None = None
    least: bool = False
    remark: str = ""

    @property
    def verdict(self) -> str:
        """In words: met, falls short, not measured; nothing where no limit was set."""
        if self.value is None:
            return "not measured"
        if self.limit is None:
            return ""
        return "met" if (self.value >= self.limit if self.least else self.value <= self.limit) else "falls short"

    @property
    def bound(self) -> str:
        """The limit as text."""
        return "" if self.limit is None else f"{'>=' if self.least else '<='} {self.limit:g}"


def ratios(records: list[dict[str, Any]]) -> list[Ratio]:
    """Every ratio that is asked for, in the order of the documentation."""
    return [
        *_contests(records),
        *_floors(records),
        *_growth(records),
        *_studies(records),
        *_commands(records),
        *_liquids(records),
    ]


def _over(other: Record | None, ours: Record | None) -> float | None:
    return None if other is None or ours is None else other["seconds"] / ours["seconds"]


def _contests(records: list[dict[str, Any]]) -> list[Ratio]:
    ours = fastest(records, "e")
    textbook = [one for one in of_kind(records, "contestant") if one["contestant"] == "a"]
    usual = next((one for one in textbook if one["setting"] == TEXTBOOK_STEP), None)
    best = {name: fastest(records, name) for name in "acd"} | {"d*": fastest(records, "d*")}
    at = {name: f"at {one['setting']}, error {one['error']:.1e}" if one else "" for name, one in best.items()}
    goal = f"goal 1000; slosh {ours['setting']}, error {ours['error']:.1e}" if ours else ""
    return [
        Ratio("(a) textbook at 0.5 ms / slosh", _over(usual, ours), 500.0, True, goal),
        Ratio("(a) textbook at its coarsest sound step / slosh", _over(best["a"], ours), remark=at["a"]),
        Ratio("(c) exudyn without rail / slosh", _over(best["c"], ours), 1.0, True, at["c"]),
        Ratio("(d) solve_ivp / slosh", _over(best["d"], ours), 100.0, True, at["d"]),
        Ratio("(d*) solve_ivp, scaled tolerances / slosh", _over(best["d*"], ours), remark=at["d*"]),
    ]


def _floors(records: list[dict[str, Any]]) -> list[Ratio]:
    found = {record["elements"]: record for record in of_kind(records, "floor")}
    lines = []
    for floor, name in (("own_floor", "own kernels"), ("lapack_floor", "LAPACK")):
        for elements, limit in ((100, 2.0), (800, 1.5)):
            one = found.get(elements)
            value = one["solver_seconds"] / one[floor] if one else None
            lines.append(Ratio(f"stop / floor of {name}, {elements} elements", value, limit))
    return lines


def _growth(records: list[dict[str, Any]]) -> list[Ratio]:
    sizes = sorted((one["count"], one["seconds"]) for one in of_kind(records, "growth") if one["by"] == "elements")
    steepest = max(((t / s) / (n / m) for (m, s), (n, t) in pairwise(sizes)), default=None)
    rows = next((one for one in of_kind(records, "recording") if one["interval_ms"] == 10.0), None)
    return [
        Ratio("twice the elements: time / (2 x time), largest", steepest, 1.0, remark="50 to 1600 elements"),
        Ratio("a row every 10 ms / no rows, time loop", rows["loop"] / rows["other_loop"] if rows else None, 1.1),
        Ratio("a row every 10 ms / no rows, with the history", rows["seconds"] / rows["other"] if rows else None),
    ]


def _studies(records: list[dict[str, Any]]) -> list[Ratio]:
    threads = next(iter(of_kind(records, "threads")), None)
    dask = {one["workers"]: one["seconds"] for one in of_kind(records, "dask")}
    batch = next(iter(of_kind(records, "batch")), None)
    return [
        Ratio(
            "one thread / two threads, 480 stops", threads["other"] / threads["seconds"] if threads else None, 1.8, True
        ),
        Ratio(
            "one core / two threads, 480 stops",
            threads["one_core"] / threads["seconds"] if threads and "one_core" in threads else None,
        ),
        Ratio("one Dask worker / two, 480 stops", dask[1] / dask[2] if len(dask) == 2 else None),
        Ratio(
            "10,000 stops: most memory / after 1,000", batch["most_MiB"] / batch["settled_MiB"] if batch else None, 1.1
        ),
    ]


def _commands(records: list[dict[str, Any]]) -> list[Ratio]:
    limits = {
        "slosh --help": 2.0, "slosh check": 3.0, "slosh run, all outputs": 3.0, "slosh sweep, Figure 3": 4.0,
    }  # fmt: skip
    found = {one["command"]: one for one in of_kind(records, "startup")}
    beside = {"slosh --help": "import typer", "slosh check": "import typer"}
    return [
        Ratio(
            f"{name} / {beside.get(name, 'import of its libraries')}",
            found[name]["seconds"] / found[name]["other"] if name in found else None,
            limit,
        )
        for name, limit in limits.items()
    ]


def _liquids(records: list[dict[str, Any]]) -> list[Ratio]:
    stops = {one["model"]: one for one in of_kind(records, "liquid")}
    cells = {one["model"]: one["cell"] / one["plain"] for one in of_kind(records, "cell")}
    modal = stops.get("modal")
    return [
        Ratio("160 km/h, 10 kN m: shallow water / modal", _over(stops.get("shallow-water"), modal), 10.0),
        Ratio("160 km/h, 10 kN m: with dispersion / modal", _over(stops.get("dispersion"), modal)),
        Ratio("a cell and stage of shallow water / of a plain box", cells.get("shallow-water")),
        Ratio("a cell and stage with dispersion / of a plain box", cells.get("dispersion")),
    ]
