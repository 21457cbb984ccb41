"""Tables of ratios, for the terminal and the documentation. No seconds: those are the machine's, not the program's."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .records import CONTESTANTS, fastest, of_kind, ratios

Table = tuple[list[str], list[list[str]]]


def _number(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def verdicts(records: list[dict[str, Any]]) -> Table:
    """Every ratio beside its limit."""
    rows = [[one.what, _number(one.value), one.bound, one.verdict, one.remark] for one in ratios(records)]
    return ["ratio", "measured", "limit", "", "remark"], rows


def contest(records: list[dict[str, Any]]) -> Table:
    """Every run of every contestant: error, and time over slosh's quickest within the allowed error."""
    ours, rows = fastest(records, "e"), []
    for one in sorted(of_kind(records, "contestant"), key=lambda one: one["contestant"]):
        error = "-" if one["error"] is None else f"{one['error']:.1e}"
        time = _number(one["seconds"] / ours["seconds"] if ours else None)
        name = f"({one['contestant']}) {CONTESTANTS[one['contestant']]}"
        rows.append([name, one["setting"], error, time, str(one["rounds"]), one.get("part", "")])
    return ["contestant", "setting", "error in distance", "time / slosh at 2e-4", "runs", "part"], rows


def floor(records: list[dict[str, Any]]) -> Table:
    """The solver's time over both floors, and what the floors are made of."""
    rows = []
    for one in of_kind(records, "floor"):
        own, lapack = (one["solver_seconds"] / one[name] for name in ("own_floor", "lapack_floor"))
        trials = one["steps"] + one["rejected"]
        singles = f"{one['singles'] / trials:.1f}"
        counts = [str(one["elements"]), str(one["unknowns"]), str(trials), singles]
        rows.append([*counts, _number(own), _number(lapack), _number(one["lapack_floor"] / one["own_floor"])])
    head = ["elements", "unknowns", "steps tried", "single right-hand sides per step"]
    return [*head, "stop / own floor", "stop / LAPACK floor", "LAPACK floor / own floor"], rows


TABLES = {"verdicts": verdicts, "contest": contest, "floor": floor}


def markdown(table: Table) -> str:
    """A table for a manual."""

    def lines() -> Iterator[str]:
        head, rows = table
        yield "| " + " | ".join(head) + " |"
        yield "|" + "---|" * len(head)
        yield from ("| " + " | ".join(row) + " |" for row in rows)

    return "\n".join(lines())
