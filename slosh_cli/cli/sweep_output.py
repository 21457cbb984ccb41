"""The terminal summary of a study."""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.output import complain, note, say, show
from slosh_cli.report.study_answers import asked_for
from slosh_cli.report.study_pages import View, name_of, unit_of, value_text
from slosh_cli.results.result import Status
from slosh_cli.study.axis import Axis
from slosh_cli.study.plan import LIQUID, SOLID, SPEED, TORQUE, Study, TrainStudy
from slosh_cli.study.table import TABLE

if TYPE_CHECKING:
    from rich.table import Table

    from slosh_cli.study.claims import Verdict

_Row = Mapping[str, Any]

_MOST_LINES: Final = 60
"""Points of a table on the terminal; a larger study is read from its file."""
_EXAMPLES: Final = 4
"""Stops named in a group of failures."""
_FEWEST: Final = 3
"""Torques from which on the most effective one is worth a word."""
_SHORT: Final[Mapping[str, str]] = {SPEED: "v0", TORQUE: "torque"}
_NUMBER: Final = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", re.IGNORECASE)


def grid_words(study: Study) -> str:
    """``48 stops: 2 speeds, ...``: how many values each axis has."""
    counts = ", ".join(f"{name_of(axis)} {_span(axis)}" for axis in study.axes)
    return f"{study.size} stops: {counts}"


def _span(axis: Axis) -> str:
    if len(axis.values) <= 3:
        return " | ".join(axis.values)
    return f"{axis.values[0]} to {axis.values[-1]} ({len(axis.values)} values)"


def show_study(study: Study, rows: Iterable[_Row], view: View) -> None:
    """Print the table and the most effective torques, to stdout."""
    rows = list(rows) if _lines(study) <= _MOST_LINES else []
    if rows and view.show:
        show(_answers_table(study, rows, view), whole=True)
    elif rows:
        show(_table(study, rows), whole=True)
        legend = _legend(study, rows)
        if legend:
            say(legend)
        for line in _best_lines(study, rows):
            say(line)


def claim_text(verdicts: Mapping[str, Sequence["Verdict"]]) -> str:
    """What became of the paper's claims, by model of the liquid; empty where there is nothing to tell."""
    lines = []
    for model, found in verdicts.items():
        of_model = f" ({model})" if len(verdicts) > 1 else ""
        for verdict in found:
            lines.append(f"\n{verdict.claim}{of_model}: {verdict.finding}")
            lines.append(f"  the paper: {verdict.text}\n  here: {verdict.evidence}")
    return "\n".join(lines)


def tell_troubles(study: Study, rows: Callable[[], Iterable[_Row]], counts: Mapping[Status, int]) -> None:
    """Tell what lies outside the limits of a check, and what ended without an answer, on stderr.

    `counts` says how many stops ended how; only those that failed are complained of.
    """
    outside = _verdict_lines(rows())
    if outside:
        note("\n".join(outside))
    written = sum(counts.values())
    unanswered = written - counts.get(Status.STOPPED, 0)
    if unanswered:
        tell = complain if any(status.is_failure for status in counts) else note
        lines = _failure_lines(study, rows())
        tell("\n".join([f"{unanswered} of {written} stops ended without an answer:", *lines]))


def _failure_lines(study: Study, rows: Iterable[_Row]) -> list[str]:
    """What went wrong, grouped by cause: how often, why, where."""
    groups: dict[tuple[str, str], list[_Row]] = {}
    for row in rows:
        if row["status"] != "stopped":
            cause = _NUMBER.sub("#", str(row.get("reason") or ""))
            groups.setdefault((str(row["status"]), cause), []).append(
                {"where": _where(study, row), "reason": row.get("reason")}
            )
    lines = []
    for (status, _), members in sorted(groups.items(), key=lambda entry: -len(entry[1])):
        lines.append(f"{len(members)} x {status}: {members[0]['reason'] or 'no reason was given'}")
        more = f" and {len(members) - _EXAMPLES} more" if len(members) > _EXAMPLES else ""
        lines.append(f"    at {'; '.join(member['where'] for member in members[:_EXAMPLES])}{more}")
    return lines


def _verdict_lines(rows: Iterable[_Row]) -> list[str]:
    """How many stops each check warns of, most first; the warnings themselves are in the table."""
    counts: Counter[str] = Counter()
    stops = 0
    for row in rows:
        stops += 1
        counts.update(name for name in str(row.get("not_within") or "").split("; ") if name)
    found = [f"  {count} of {stops}: {name}" for name, count in counts.most_common()]
    return [f"outside the limits of a check (see not_within and warnings in {TABLE}):", *found] if found else []


def _where(study: Study, row: _Row) -> str:
    told = ", ".join(value_text(axis, row) for axis in study.axes if len(axis.values) > 1)
    return told or str(row.get("liquid", study.name))


def _lines(study: Study) -> int:
    """Points of the grid, liquid and solid counted as one."""
    models = next((len(axis.values) for axis in study.axes if axis.key == LIQUID), 1)
    return study.size // models


def _told(study: Study) -> list[Axis]:
    """The axes that have a column on the terminal."""
    return [axis for axis in study.axes if axis.key != LIQUID and (len(axis.values) > 1 or axis.key in (SPEED, TORQUE))]


def _table(study: Study, rows: Sequence[_Row]) -> "Table":
    from rich import box
    from rich.table import Table

    if isinstance(study, TrainStudy):
        return _train_table(study, rows)
    axes = _told(study)
    models = list(dict.fromkeys(str(row["liquid"]) for row in rows))
    liquids = [model for model in models if model != SOLID]
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    table.title, table.title_justify, table.title_style = f"{study.name}: braking distance", "left", "bold"
    heads = [(_SHORT.get(axis.key) or name_of(axis), unit_of(axis)) for axis in axes]
    heads += [(model, "m") for model in models]
    heads += [(model, f"/ {SOLID}") for model in liquids if SOLID in models]
    for name, unit in heads:
        table.add_column(f"{name}\n{unit}", justify="right", no_wrap=True)
    best = _best(rows, _curve_of(study))
    for _, group in groupby(rows, key=lambda row: tuple(value_text(axis, row) for axis in axes)):
        point = {str(row["liquid"]): row for row in group}
        first = next(iter(point.values()))
        cells = [value_text(axis, first).removesuffix(unit_of(axis)).strip() for axis in axes]
        cells += [_distance(point.get(model), best) for model in models]
        cells += [_ratio(point.get(model)) for model in liquids if SOLID in models]
        table.add_row(*cells)
    return table


def _answers_table(study: Study, rows: Sequence[_Row], view: View) -> "Table":
    """One line per stop, with the answers that are asked for."""
    from rich import box
    from rich.table import Table

    axes, shown = _told(study), asked_for(study, view.show)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    table.title, table.title_justify, table.title_style = study.name, "left", "bold"
    heads = [(_SHORT.get(axis.key) or _short(axis, axes), unit_of(axis)) for axis in axes]
    for name, unit in [*heads, ("load", ""), *((one.title.lower(), one.unit) for one in shown)]:
        table.add_column(f"{name}\n{unit}", justify="right", no_wrap=True)
    for row in rows:
        cells = [value_text(axis, row).removesuffix(unit_of(axis)).strip() for axis in axes]
        found = [value for one in shown for _, value in one.curves(row)]
        ended = "-" if row["status"] == Status.STOPPED else str(row["status"])
        table.add_row(
            *cells, str(row.get("liquid", "train")), *(ended if value is None else f"{value:.5g}" for value in found)
        )
    return table


def _train_table(study: Study, rows: Sequence[_Row]) -> "Table":
    """One line per stop of a train."""
    from rich import box
    from rich.table import Table

    axes = _told(study)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, 1, 0, 0))
    table.title, table.title_justify, table.title_style = f"{study.name}: stops of a train", "left", "bold"
    heads = [(_SHORT.get(axis.key) or _short(axis, axes), unit_of(axis)) for axis in axes]
    answers = [("distance", "m"), ("compression", "kN"), ("tension", "kN"), ("unloading", "%"), ("locked", "s")]
    for name, unit in [*heads, *answers]:
        table.add_column(f"{name}\n{unit}", justify="right", no_wrap=True)
    for row in rows:
        cells = [value_text(axis, row).removesuffix(unit_of(axis)).strip() for axis in axes]
        if row.get("max_compression_N") is None:
            table.add_row(*cells, str(row["status"]))
            continue
        forces = [f"{row[f'max_{way}_N'] / 1e3:.1f}" for way in ("compression", "tension")]
        wheels = [f"{100 * row['max_wheel_unloading']:.1f}", f"{row['longest_lock_s']:.2f}"]
        table.add_row(*cells, _distance(row, ()), *forces, *wheels)
    return table


def _short(axis: Axis, axes: Sequence[Axis]) -> str:
    """The last word of an axis's key, or all of it where another one ends alike."""
    word = axis.key.rpartition(".")[2]
    alike = [other for other in axes if other.key.rpartition(".")[2] == word]
    return word if len(alike) == 1 else axis.key


def _distance(row: _Row | None, best: Sequence[_Row]) -> str:
    if row is None:
        return "-"
    distance = row.get("braking_distance_m")
    if distance is None:
        return str(row["status"])
    outside = "" if row.get("liquid_in_range") else "o"
    mark = "*" if any(row is one for one in best) else ""
    return f"{mark}{outside} {distance:.2f}".strip()


def _ratio(row: _Row | None) -> str:
    ratio = None if row is None else row.get("ratio_to_solid")
    return "-" if ratio is None else f"{ratio:.4f}"


def _legend(study: Study, rows: Sequence[_Row]) -> str:
    words = [] if isinstance(study, TrainStudy) else ["* shortest of its curve"]
    outside = any(row.get("braking_distance_m") is not None and not row.get("liquid_in_range") for row in rows)
    words += ["o outside the range of the liquid's theory (see warnings in the table)"] if outside else []
    return "   ".join(words)


def _curve_of(study: Study) -> list[Axis]:
    """The axes that tell one curve from another: all but the torque, or the speed where the torque is fixed."""
    varied = [axis for axis in study.axes if len(axis.values) > 1 and axis.key != LIQUID]
    along = next(
        (axis for key in (TORQUE, SPEED) for axis in varied if axis.key == key), varied[-1] if varied else None
    )
    return [axis for axis in study.axes if axis is not along]


def _best(rows: Sequence[_Row], axes: Sequence[Axis]) -> list[_Row]:
    """The shortest stop of every curve."""
    curves: dict[tuple[str, ...], _Row] = {}
    for row in rows:
        if row.get("braking_distance_m") is None:
            continue
        key = tuple(value_text(axis, row) for axis in axes)
        if key not in curves or row["braking_distance_m"] < curves[key]["braking_distance_m"]:
            curves[key] = row
    return list(curves.values())


def _best_lines(study: Study, rows: Sequence[_Row]) -> list[str]:
    torques = next((axis for axis in study.axes if axis.key == TORQUE), None)
    if torques is None or len(torques.values) < _FEWEST:
        return []
    axes = [axis for axis in _curve_of(study) if len(axis.values) > 1]
    lines = ["most effective torque:"]
    for row in _best(rows, _curve_of(study)):
        where = ", ".join(value_text(axis, row) for axis in axes)
        lines.append(f"  {where}: {row['torque_kN_m']:g} kN m, {row['braking_distance_m']:.2f} m")
    return lines
