"""Figures of validation cases, as PNG and SVG: what the program computes over what it is compared with.

The reference is a broad grey line beneath; computed curves differ in dash and lightness, points in their marker. The
legend stands above the axes, where it hides nothing.
"""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from slosh_cli.validation.chart import Chart, Curve, Panel

_PANEL_WIDTH: Final = 7.0  # inches
_HEIGHT: Final = 5.8
RESOLUTION: Final = 130  # dots per inch

_LINES: Final[tuple[dict[str, Any], ...]] = (
    {"color": "#08306b", "linestyle": "-"},
    {"color": "#c1440e", "linestyle": (0, (6, 2))},
    {"color": "#4a98c9", "linestyle": (0, (6, 2, 1, 2))},
    {"color": "#7a7a7a", "linestyle": (0, (1.5, 1.2))},
    {"color": "#8c2d04", "linestyle": (0, (3, 1))},
)
_MARKS: Final = ("o", "s", "^", "D", "v", "P")
_EXACT: Final[tuple[str, ...]] = ("#bdbdbd", "#d9c7a8", "#c6d6e8")


def case_figure(title: str, chart: Chart) -> Figure:
    """The panels of a chart side by side."""
    count = len(chart.panels)
    figure = Figure(figsize=(_PANEL_WIDTH * count, _HEIGHT), dpi=RESOLUTION, layout="constrained")
    figure.suptitle(title, fontsize=15, fontweight="bold", x=0.012, ha="left")
    for axes, panel in zip(figure.subplots(1, count, squeeze=False)[0], chart.panels, strict=True):
        _draw_panel(axes, panel)
    return figure


def _draw_panel(axes: Axes, panel: Panel) -> None:
    lines, marks, exact = cycle(_LINES), cycle(zip(_MARKS, _LINES, strict=False)), cycle(_EXACT)
    for one in panel.curves:
        _draw_curve(axes, one, lines, marks, exact)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    if panel.log_x:
        axes.set_xscale("log")
    if panel.log_y:
        axes.set_yscale("log")
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        borderaxespad=0.2,
        fontsize=11,
        title=panel.title or None,
        alignment="left",
        ncols=_columns(panel),
    )


def _columns(panel: Panel) -> int:
    """Columns of the legend: as many as the longest label leaves room for beside its line."""
    longest = max(len(one.label) for one in panel.curves)
    return max(1, min(len(panel.curves), 66 // (longest + 9)))


def _draw_curve(axes: Axes, one: Curve, lines: Any, marks: Any, exact: Any) -> None:
    if one.exact:
        axes.plot(one.x, one.y, color=next(exact), linewidth=5.0, solid_capstyle="round", label=one.label)
    elif one.marks:
        marker, line = next(marks)
        axes.plot(one.x, one.y, linestyle="none", marker=marker, color=line["color"], markersize=6.5, label=one.label)
    else:
        axes.plot(one.x, one.y, **next(lines), label=one.label)
