"""Figures of a study, as PNG and SVG: braking distance against what varies, liquid beside solid (the paper's Figure 3).

A stop without an answer has no distance: it stands as a mark of its own at the top of its panel, and no line leads to
it. A stop outside linear theory has a hollow marker and hangs on a dotted line.
"""

from __future__ import annotations

import gc
import math
import textwrap
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Annotation
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from slosh_cli.report import FORMATS, figures
from slosh_cli.report.label_places import spread
from slosh_cli.report.saving import INK, MUTED, save, styled
from slosh_cli.report.study_pages import Mark, Page, StopsPanel, figure_files, named
from slosh_cli.results.files import FileError
from slosh_cli.results.result import Status
from slosh_cli.study.plan import SOLID

_LINEAR: Final = "modal"
_LIQUIDS: Final = (_LINEAR, "shallow-water")
_WIDTH: Final = 10.4
"""Width of a figure of two panels in inches; a wider one has no more pixels across."""

LOOKS: Final[Sequence[dict[str, Any]]] = (
    {"color": "#08306b", "marker": "o", "linestyle": "-", "markersize": 6.5},
    {"color": "#c1440e", "marker": "s", "linestyle": (0, (5, 1.5)), "markersize": 9.0},
    {"color": "#4a98c9", "marker": "^", "linestyle": (0, (6, 2, 1, 2)), "markersize": 7.0},
    {"color": "#7a7a7a", "marker": "D", "linestyle": (0, (3, 1.5, 1, 1.5, 1, 1.5)), "markersize": 6.0},
)
OUTSIDE: Final = (0, (1, 1.8))
"""Line style of the way to and from a stop outside linear theory."""
_LIMIT: Final = (0, (8, 3))
_WITHOUT_ANSWER: Final = {Status.PITCH_LIMIT: "x", Status.TIME_LIMIT: "1", Status.FAILED: "+"}


def draw_study(pages: Sequence[Page], folder: Path, formats: Sequence[str] = FORMATS) -> list[Path]:
    """Draw one figure per page into `folder`, by its name.

    Returns the files. Each appears whole or not at all; those of an earlier study that had more are removed then.
    Raises FileError when one cannot be written, once the others are.
    """
    files = []
    refusal: FileError | None = None
    with styled():
        for name, page in named(pages).items():
            try:
                files += save(study_figure(page), folder, name, formats)
            except FileError as error:
                refusal = refusal or error
            if len(pages) > 1:
                gc.collect()  # a drawn figure is ten megabytes of objects that refer to each other
    if refusal is not None:
        raise refusal
    for name in figure_files(folder):
        if folder / name not in files:
            (folder / name).unlink(missing_ok=True)
    return files


def study_figure(page: Page) -> Figure:
    """An answer against what varies, one panel beside the other, one curve per model of the load or kind of force."""
    columns = min(len(page.panels), 3 if len(page.panels) != 4 else 2)
    lines = math.ceil(len(page.panels) / columns)
    looks = _looks(page)
    handles = _legend(page, looks)
    width = max(5.2 * columns, 7.0)
    beside = _beside(handles, width)
    header = 1.35 + 0.28 * (math.ceil(len(handles) / beside) - 1)
    height = 4.6 * lines + 0.4 + header
    figure = Figure(figsize=(width, height), dpi=figures.RESOLUTION * min(1.0, _WIDTH / width))
    FigureCanvasAgg(figure)  # measures all its words with one canvas
    figure.text(0.014, 1.0 - 0.14 / height, page.shown.title, fontsize=17, fontweight="bold", color=INK, va="top")
    words = "\n".join(textwrap.wrap(page.conditions, int(width * 11)))
    figure.text(0.014, 1.0 - 0.5 / height, words, fontsize=12.5, color=MUTED, va="top", parse_math=False)
    figure.set_layout_engine("constrained", rect=(0.008, 0.006, 0.984, 1.0 - header / height))
    grid = figure.subplots(lines, columns, squeeze=False)
    panels = grid.ravel()
    labels = {axes: _draw_panel(axes, page, panel, looks) for axes, panel in zip(panels, page.panels, strict=False)}
    for axes in panels[len(page.panels) :]:
        axes.set_axis_off()
    for axes in grid[:, 0]:
        axes.set_ylabel(page.shown.label)
    figure.legend(
        handles=handles, loc="upper left", ncols=beside, columnspacing=1.5, handletextpad=0.6,
        bbox_to_anchor=(0.006, 1.0 - 0.82 / height), borderaxespad=0.0,
    )  # fmt: skip
    figure.draw_without_rendering()  # only now is it known where everything lies
    figure.set_layout_engine("none")
    for axes, panel in zip(panels, page.panels, strict=False):
        answered = [(mark.x, mark.value) for marks in panel.curves.values() for mark in marks]
        spread(axes, labels[axes], [place for place in answered if place[1] is not None])
    return figure


def _beside(handles: Sequence[Line2D], width: float) -> int:
    """How many entries of the legend find room beside each other on `width` inches."""
    widest = max(len(str(handle.get_label())) for handle in handles)
    room = int(width / (0.08 * widest + 0.75))
    return len(handles) if sum(0.08 * len(str(h.get_label())) + 0.75 for h in handles) < width else max(1, room)


def _looks(page: Page) -> dict[str, dict[str, Any]]:
    """Look of every model of the load; the solid has the second one wherever it stands in the list."""
    models = list(dict.fromkeys(model for panel in page.panels for model in panel.curves))
    crowded = len(models) > len(LOOKS) - 1 and SOLID not in models
    others = iter([*(LOOKS if crowded else (LOOKS[0], *LOOKS[2:]))] * len(models))
    return {model: LOOKS[1] if model == SOLID else next(others) for model in models}


def _draw_panel(axes: Axes, page: Page, panel: StopsPanel, looks: dict[str, dict[str, Any]]) -> list[Annotation]:
    """Draw the curves; returns the names of their lowest points."""
    for model, marks in sorted(panel.curves.items(), key=lambda curve: curve[0] != SOLID):  # the solid lies below
        _draw_curve(axes, marks, looks[model])
        beneath = list(looks).index(model) if page.shown.asked else 0  # where a curve has none, others have none either
        _draw_unanswered(axes, marks, looks[model], 0.965 - 0.04 * beneath)
    _scale(axes, page.panels if page.shown.asked else [panel], page.shown.limit)
    labels = []
    for model, marks in panel.curves.items() if page.best else ():
        others = [mark for other, found in panel.curves.items() if other != model for mark in found]
        labels += _mark_best(axes, page, marks, looks[model], others)
    axes.set_title(panel.title, fontsize=13, fontweight="bold", loc="left", color=INK)
    axes.set_xlabel(page.label)
    if page.ticks:
        axes.set_xticks(range(len(page.ticks)), list(page.ticks))
    places = [mark.x for marks in panel.curves.values() for mark in marks]
    room = (0.12 if labels else 0.05) * (max(places) - min(places)) or 0.5  # a name stands beside no tick
    axes.set_xlim(min(places) - room, max(places) + room)
    return labels


def _draw_curve(axes: Axes, marks: Sequence[Mark], look: dict[str, Any]) -> None:
    """Lines between neighbours that both have an answer, and the markers: hollow outside linear theory."""
    color = look["color"]
    for within, style, width in ((True, look["linestyle"], 1.8), (False, OUTSIDE, 1.5)):
        axes.plot(*_way(marks, within=within), color=color, linestyle=style, linewidth=width, zorder=2)
        places = [(mark.x, mark.value) for mark in marks if mark.value is not None and mark.liquid_in_range == within]
        axes.plot(
            [x for x, _ in places], [distance for _, distance in places], marker=look["marker"], color=color,
            markerfacecolor=color if within else "white", markersize=look["markersize"], markeredgewidth=1.5,
            linestyle="none", zorder=3,
        )  # fmt: skip


def _way(marks: Sequence[Mark], *, within: bool) -> tuple[list[float], list[float]]:
    """The line through neighbours that both lie within linear theory, or through the others; NaN where it breaks."""
    x: list[float] = []
    y: list[float] = []
    for first, second in pairwise(marks):
        if first.value is None or second.value is None:
            continue
        if (first.liquid_in_range and second.liquid_in_range) == within:
            if not x or x[-1] != first.x:
                x += [math.nan, first.x]
                y += [math.nan, first.value]
            x.append(second.x)
            y.append(second.value)
    return x, y


def _draw_unanswered(axes: Axes, marks: Sequence[Mark], look: dict[str, Any], height: float) -> None:
    for mark in marks:
        if mark.value is None:
            axes.plot(
                [mark.x], [height], marker=_WITHOUT_ANSWER.get(mark.status, "+"), color=look["color"], markersize=9.0,
                markeredgewidth=2.2, linestyle="none", transform=axes.get_xaxis_transform(), zorder=4,
            )  # fmt: skip


def _scale(axes: Axes, panels: Sequence[StopsPanel], limit: float | None) -> None:
    """One scale for `panels`, logarithmic where distances differ a lot: on it, a ratio has the same length everywhere.

    A share has a `limit`, which is drawn, and a linear scale from zero.
    """
    marks = [mark for panel in panels for curve in panel.curves.values() for mark in curve]
    found = [mark.value for mark in marks if mark.value is not None]
    if limit is not None:
        axes.axhline(limit, color=INK, linewidth=1.2, linestyle=_LIMIT, zorder=1)
        axes.set_ylim(min([0.0, *found]), 1.12 * max([limit, *found]))
        return
    if not found:
        words = "no stop has such a value" if any(one.status is Status.STOPPED for one in marks) else ""
        axes.text(0.5, 0.5, words or "no stop has an answer", transform=axes.transAxes, ha="center", color=MUTED)
        axes.set_yticks([])
        return
    low, high = min(found), max(found)
    if high < 1.6 * low or low <= 0.0:  # without forces there is no ratio
        span = max(high - low, 0.02 * high) or 1.0
        axes.set_ylim(low - 0.25 * span, high + 0.25 * span)
        return
    axes.set_yscale("log")
    axes.set_ylim(low * (low / high) ** 0.22, high * (high / low) ** 0.14)
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0), numticks=20))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="y", which="minor", length=0)


def _mark_best(
    axes: Axes, page: Page, marks: Sequence[Mark], look: dict[str, Any], others: Sequence[Mark]
) -> list[Annotation]:
    """Ring and name the lowest point of a curve, below it where no other curve is in the way; returns the name."""
    answered = [(mark.value, mark.x) for mark in marks if mark.value is not None]
    if len(answered) < 2:
        return []
    distance, x = min(answered)
    axes.plot(
        [x], [distance], marker="o", markersize=15.0, markerfacecolor="none", color=look["color"],
        markeredgewidth=1.6, linestyle="none", zorder=4,
    )  # fmt: skip
    below = not any(mark.x == x and mark.value is not None and mark.value < distance for mark in others)
    place = page.ticks[round(x)] if page.ticks else f"{x:g} {page.unit}".rstrip()
    label = axes.annotate(
        f"{place}\n{distance:.4g} {page.shown.unit}", (x, distance), xytext=(0, -13 if below else 13),
        textcoords="offset points",
        ha="center", va="top" if below else "bottom", color=look["color"], fontsize=11.5, linespacing=1.15, zorder=5,
    )  # fmt: skip
    return [label]


def _legend(page: Page, looks: dict[str, dict[str, Any]]) -> list[Line2D]:
    """What the lines and markers mean, as far as they occur."""
    handles = [_key(_name(model), **look, linewidth=1.8) for model, look in looks.items()]
    marks = [mark for panel in page.panels for marks in panel.curves.values() for mark in marks]
    if any(mark.value is not None and not mark.liquid_in_range for mark in marks):
        look = {"marker": "o", "markerfacecolor": "white", "markeredgewidth": 1.5, "markersize": 7.0}
        words = "outside linear theory" if set(looks) <= {_LINEAR, SOLID} else "outside its theory"
        handles.append(_key(words, linestyle=OUTSIDE, **look))
    for status in sorted({mark.status for mark in marks if mark.value is None}):
        look = {"marker": _WITHOUT_ANSWER.get(status, "+"), "markersize": 9.0, "markeredgewidth": 2.2}
        words = "none occurs" if status is Status.STOPPED else str(status)
        handles.append(_key(words, linestyle="none", **look))
    if page.shown.limit is not None:
        handles.append(_key(f"usual limit: {page.shown.limit:g} {page.shown.unit}", linestyle=_LIMIT, linewidth=1.2))
    if not page.best:
        return handles
    ring = {"marker": "o", "markerfacecolor": "none", "markersize": 13.0, "markeredgewidth": 1.6}
    return [*handles, _key(page.best, linestyle="none", **ring)]


def _name(model: str) -> str:
    return "equivalent solid" if model == SOLID else f"liquid ({model})" if model in _LIQUIDS else model


def _key(label: str, **look: Any) -> Line2D:
    return Line2D([], [], **{"color": INK, **look}, label=label)
