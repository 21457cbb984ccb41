"""What the figures of a study show: which axis lies along the bottom, which makes panels, which makes figures."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, TypeVar

from slosh_cli.errors import UsageError
from slosh_cli.report.study_answers import DISTANCE, NAMES, Answered, asked_for, usual
from slosh_cli.results.result import Status
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.schema_run import ADHESIONS
from slosh_cli.scenario.train_file import TrainScenario
from slosh_cli.study.axis import Axis
from slosh_cli.study.plan import LIQUID, SPEED, TORQUE, Study
from slosh_cli.study.table import column_of
from slosh_cli.wagon.torque import nominal_torque

_T = TypeVar("_T")

_NAMES: Final[Mapping[str, str]] = {SPEED: "initial speed", TORQUE: "brake torque per wheel", LIQUID: "load"}
_UNITS: Final[Mapping[str, str]] = {SPEED: "km/h", TORQUE: "kN m"}
_COLUMNS: Final[Mapping[str, str]] = {SPEED: "v0_km_h", TORQUE: "torque_kN_m", LIQUID: "liquid"}
_FIGURE: Final = re.compile(rf"(?P<shown>{'|'.join(NAMES)})(?:_(?P<number>[0-9]+))?\.(?P<kind>png|svg)")
_MOST_PANELS: Final = 6


@dataclass(frozen=True)
class Mark:
    """One stop: its place `x` on the axis, the answer shown (None where there is none), how it ended."""

    x: float
    value: float | None
    status: Status
    liquid_in_range: bool


@dataclass(frozen=True)
class StopsPanel:
    """One panel: its title and, by what the curve is of (models of the load), its stops in the order of `x`."""

    title: str
    curves: dict[str, list[Mark]] = field(default_factory=dict)


@dataclass(frozen=True)
class Page:
    """One figure: panels that share the horizontal axis `label`; `ticks` name its places where it has no numbers.

    `best` is what the lowest point of a curve is called, `unit` that of the horizontal axis; `shown` is what the
    figure shows.
    """

    shown: Answered
    conditions: str
    label: str
    unit: str
    best: str
    panels: Sequence[StopsPanel]
    ticks: Sequence[str] = ()


@dataclass(frozen=True)
class View:
    """What is shown of a study: answers, and the keys along the axis, of the curves and of the panels; "" as fits."""

    show: tuple[str, ...] = ()
    x: str = ""
    curves: str = ""
    panels: str = ""


_AS_FITS: Final = View()
MOST_CURVES: Final = 4
"""Curves of a panel that differ in grey, too."""
_SHORT_KEYS: Final[Mapping[str, str]] = {SPEED: "v0", TORQUE: "torque", LIQUID: "liquid"}


def named(pages: Sequence["Page"]) -> dict[str, "Page"]:
    """The pages by the names of their files, with a number from 1 where several show the same."""
    found = {}
    for page in pages:
        alike = [other for other in pages if other.shown is page.shown]
        number = f"_{next(k for k, other in enumerate(alike, 1) if other is page)}" if len(alike) > 1 else ""
        found[f"{page.shown.name}{number}"] = page
    return found


def figure_files(folder: Path) -> list[str]:
    """Names of the files of figures of studies in `folder`, by their numbers."""
    found = [(match, file.name) for file in folder.iterdir() if (match := _FIGURE.fullmatch(file.name))]
    order = sorted(found, key=lambda one: (one[0]["shown"], int(one[0]["number"] or 0), one[0]["kind"]))
    return [name for _, name in order]


def name_of(axis: Axis) -> str:
    """What people call an axis."""
    return _NAMES.get(axis.key, axis.key)


def unit_of(axis: Axis) -> str:
    """The unit of an axis in tables and figures."""
    return _UNITS.get(axis.key, axis.unit)


def _column(axis: Axis) -> str:
    """The column of the table that holds an axis's value."""
    return _COLUMNS.get(axis.key) or column_of(axis)


def value_text(axis: Axis, row: Mapping[str, Any]) -> str:
    """The value of an axis in a row, with its unit."""
    value = row[_column(axis)]
    return f"{value:g} {unit_of(axis)}".rstrip() if isinstance(value, float) else str(value)


def pages(study: Study, rows: Iterable[Mapping[str, Any]], view: View = _AS_FITS) -> list[Page]:
    """The figures of a study; none where nothing but the load varies. Raises UsageError for a view it cannot have."""
    roles = _roles(study, view)
    if roles is None:
        return []
    along, told, beside, apart = roles
    each = asked_for(study, view.show) or usual(study)
    found: dict[Answered, dict[str, dict[str, StopsPanel]]] = {shown: {} for shown in each}
    ticks: dict[Any, int] = {}
    for row in rows:
        page = ", ".join(f"{name_of(axis)} {value_text(axis, row)}" for axis in apart)
        title = _panel_title(beside, row) if beside or SPEED not in (along.key, told.key if told else "") else ""
        kind = f"{value_text(told, row)}, " if told else ""
        for shown, drawn in found.items():
            panel = drawn.setdefault(page, {}).setdefault(title, StopsPanel(title))
            for curve, value in shown.curves(row):
                panel.curves.setdefault(kind + curve, []).append(_mark(along, row, value, ticks))
    unit = unit_of(along)
    label = f"{name_of(along)} / {unit}" if unit else name_of(along)
    return [
        Page(shown, _conditions(study, page), label, unit, _best(along, shown), together, list(ticks))
        for shown, drawn in found.items()
        for page, panels in drawn.items()
        for together in _shared_out([_in_order(panel) for panel in panels.values()], _MOST_PANELS)
    ]


def _roles(study: Study, view: View) -> tuple[Axis, Axis | None, Axis | None, list[Axis]] | None:
    """The axes along the bottom, of the curves beside the load, of the panels, and those that make figures."""
    varied = [axis for axis in study.axes if len(axis.values) > 1 and axis.key != LIQUID]
    chosen = {option: _chosen(varied, option, key) for option, key in vars(view).items() if option != "show" and key}
    if len({axis.key for axis in chosen.values()}) < len(chosen):
        raise UsageError("one key cannot be shown in two ways; name it with one of --x, --curves, --panels")
    if not varied:
        return None
    free = [axis for axis in varied if axis not in chosen.values()]
    along = chosen.get("x") or next((axis for key in (TORQUE, SPEED) for axis in free if axis.key == key), None)
    along = along or next((axis for axis in reversed(free) if _is_number(axis)), free[-1] if free else None)
    if along is None:
        raise UsageError("nothing is left for the horizontal axis; leave --curves or --panels out, or vary one more")
    others = sorted((axis for axis in free if axis is not along), key=lambda axis: axis.key != SPEED)
    told, beside = chosen.get("curves"), chosen.get("panels")
    loads = next((len(axis.values) for axis in study.axes if axis.key == LIQUID), 1)
    if told and len(told.values) * loads > MOST_CURVES:
        few = f"{len(told.values) * loads} curves in a panel, of which {MOST_CURVES} can be told apart"
        raise UsageError(f"--curves {told.key} would make {few}; give fewer values, or one --liquid", "--curves")
    beside = beside or (others.pop(0) if others else None)
    return along, told, beside, others


def _chosen(varied: Sequence[Axis], option: str, key: str) -> Axis:
    """The axis that a person names: by its key, or the end of it."""
    alike = [axis for axis in varied if key in (axis.key, axis.key.rpartition(".")[2], _SHORT_KEYS.get(axis.key))]
    if len(alike) != 1:
        raise UsageError(
            f"`{key}` is no key that varies; those are {', '.join(axis.key for axis in varied)}", f"--{option}"
        )
    return alike[0]


def _is_number(axis: Axis) -> bool:
    return all(isinstance(axis.plain(place), float) for place in range(len(axis.values)))


def _in_order(panel: StopsPanel) -> StopsPanel:
    for marks in panel.curves.values():
        marks.sort(key=lambda mark: mark.x)
    return panel


def _best(along: Axis, shown: Answered) -> str:
    """What the lowest point of a curve is called; nothing where it is no matter."""
    if shown.asked and not shown.name.startswith(DISTANCE):
        return ""
    return (
        "most effective torque" if along.key == TORQUE else "shortest" if shown.name.startswith(DISTANCE) else "least"
    )


def _shared_out(panels: Sequence[_T], most: int) -> Iterator[Sequence[_T]]:
    """`panels` on as few pages of at most `most` as there must be, about as many on each."""
    count = math.ceil(len(panels) / most)
    for number in range(count):
        yield panels[number * len(panels) // count : (number + 1) * len(panels) // count]


def _panel_title(beside: Axis | None, row: Mapping[str, Any]) -> str:
    if beside is None:
        return f"{row['v0_km_h']:g} km/h"
    return value_text(beside, row) if beside.key in _UNITS else f"{name_of(beside)} {value_text(beside, row)}"


def _conditions(study: Study, page: str) -> str:
    """The study's name and what is the same in all of a figure."""
    fixed = [axis for axis in study.axes if len(axis.values) == 1 and axis.key not in (LIQUID, SPEED)]
    words = [page] if page else []
    words += [f"{name_of(axis)} {axis.values[0]}" for axis in fixed]
    words += _of_wagon(study, study.base) if isinstance(study.base, Scenario) else _of_train(study.base)
    return f"{study.name}: {', '.join(words)}"


def _of_train(train: TrainScenario) -> list[str]:
    kinds = dict.fromkeys(vehicle.name for vehicle in train.vehicles)
    return [f"{sum(vehicle.name == kind for vehicle in train.vehicles)} x {kind}" for kind in kinds]


def _of_wagon(study: Study, base: Scenario) -> list[str]:
    keys, words = {axis.key for axis in study.axes}, []
    brake, told = base.braking, {".".join(key.split(".")[:2]) for key in keys}
    if told.isdisjoint(f"braking.{key}" for key in ("torque", *brake.rivals("torque"))):
        words.append("blocks" if brake.blocks else "discs" if brake.discs else _torque(base))
    tank = base.tank
    words += [f"{tank.shape} tank"] if "tank.shape" not in keys else []
    words += [f"fill {tank.fill:g}"] if told.isdisjoint(f"tank.{key}" for key in ("fill", *tank.rivals("fill"))) else []
    rail = next((name for name, adhesion in ADHESIONS.items() if adhesion == base.contact.adhesion), "")
    words += [f"{rail} rail"] if rail and not any(key.startswith("contact.adhesion") for key in keys) else []
    return words


def _torque(base: Scenario) -> str:
    return f"{nominal_torque(base) / 1e3:g} kN m per wheel"


def _mark(along: Axis, row: Mapping[str, Any], value: float | None, ticks: dict[Any, int]) -> Mark:
    place = row[_column(along)]
    x = place if isinstance(place, float) else float(ticks.setdefault(place, len(ticks)))
    return Mark(x, value, Status(row["status"]), bool(row.get("liquid_in_range")))
