"""Figures of a run of the benchmarks, as PNG and SVG."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from slosh_cli.report.saving import STYLE

from .records import ALLOWED_ERROR, CONTESTANTS, fastest, of_kind

LOOKS: dict[str, dict[str, Any]] = {
    "a": {"color": "#8c2d04", "marker": "s", "linestyle": (0, (6, 2))},
    "c": {"color": "#fd8d3c", "marker": "D", "linestyle": (0, (6, 2, 1, 2))},
    "d": {"color": "#4a98c9", "marker": "^", "linestyle": (0, (1.5, 1.2))},
    "d*": {"color": "#41ab5d", "marker": "v", "linestyle": (0, (3, 1, 1, 1))},
    "e": {"color": "#08306b", "marker": "o", "linestyle": "-"},
}


def work_precision(records: list[dict[str, Any]]) -> Figure:
    """Error in distance against time, in units of slosh's quickest run within the allowed error."""
    figure = Figure(figsize=(9.0, 5.6), layout="constrained")
    axes, ours = figure.add_subplot(), fastest(records, "e")
    unit = ours["seconds"] if ours else 1.0
    for name, look in LOOKS.items():
        runs = [one for one in of_kind(records, "contestant") if one["contestant"] == name and one["error"]]
        runs.sort(key=lambda one: -one["error"])
        if runs:
            axes.loglog([one["seconds"] / unit for one in runs], [one["error"] for one in runs],
                        label=f"({name}) {CONTESTANTS[name]}", **look)  # fmt: skip
    axes.axhline(ALLOWED_ERROR, color="#777777", linewidth=1.0)
    axes.annotate("2e-4", (0.0, ALLOWED_ERROR), xycoords=("axes fraction", "data"), va="bottom", fontsize=11)
    axes.set_xlabel("time of the stop / time of slosh at 2e-4")
    axes.set_ylabel("error in braking distance")
    axes.set_title("160 km/h, 5 kN m: work and precision", loc="left")
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def _lines(axes: Axes, by: str, ratio: str, records: list[tuple[float, float]], slope: bool = False) -> None:
    records = sorted(records)
    if records:
        first = records[0]
        axes.loglog(*zip(*records, strict=True), **LOOKS["e"])
        if slope:
            ends = [first[0], records[-1][0]]
            axes.loglog(ends, [first[1], first[1] * ends[1] / ends[0]], color="#777777", linestyle=(0, (6, 2)))
            axes.annotate("linear", (ends[1], first[1] * ends[1] / ends[0]), ha="right", va="bottom", fontsize=11)
    axes.set_xlabel(by)
    axes.set_ylabel(ratio)


def scaling(records: list[dict[str, Any]]) -> Figure:
    """Elements, modes, output interval; threads and Dask workers."""
    figure = Figure(figsize=(11.0, 8.0), layout="constrained")
    panels = figure.subplots(2, 2)
    for axes, by, word in ((panels[0, 0], "elements", "elements of the rail"), (panels[0, 1], "modes", "slosh modes")):
        runs = sorted((one["count"], one["seconds"]) for one in of_kind(records, "growth") if one["by"] == by)
        relative = [(count, seconds / runs[0][1]) for count, seconds in runs]
        _lines(axes, word, f"time / time at {runs[0][0] if runs else 0:g}", relative, slope=by == "elements")
    panels[0, 1].set_yscale("linear")
    panels[0, 1].set_ylim(bottom=0.0)
    rows = [(one["interval_ms"], one["seconds"] / one["other"]) for one in of_kind(records, "recording")]
    _lines(panels[1, 0], "output interval / ms", "time / time without rows", rows)
    panels[1, 0].set_yscale("linear")
    panels[1, 0].axhline(1.1, color="#777777", linewidth=1.0)
    threads = next(iter(of_kind(records, "threads")), None)
    dask = {one["workers"]: one["seconds"] for one in of_kind(records, "dask")}
    bars: dict[str, float] = {}
    if threads is not None:
        bars |= {"1 thread": 1.0, "2 threads": threads["other"] / threads["seconds"]}
        bars |= {f"{n} Dask\nworker{'s' if n > 1 else ''}": threads["other"] / dask[n] for n in sorted(dask)}
    panels[1, 1].set_visible(bool(bars))
    if bars:
        panels[1, 1].bar(list(bars), list(bars.values()), color="#4a98c9", width=0.6)
    panels[1, 1].set_ylabel("stops per second / one thread's")
    return figure


def floor(records: list[dict[str, Any]]) -> Figure:
    """The solver's time over the floors by elements."""
    figure = Figure(figsize=(9.0, 5.0), layout="constrained")
    axes = figure.add_subplot()
    for name, label, look in (("own_floor", "own kernels", LOOKS["e"]), ("lapack_floor", "LAPACK", LOOKS["a"])):
        runs = [(one["elements"], one["solver_seconds"] / one[name]) for one in of_kind(records, "floor")]
        if runs:
            axes.semilogx(*zip(*sorted(runs), strict=True), label=f"over the floor by {label}", **look)
    axes.plot([100, 800], [2.0, 1.5], color="#777777", linestyle="none", marker="_", markersize=24, label="limit")
    axes.set_xticks([100, 200, 400, 800], labels=["100", "200", "400", "800"], minor=False)
    axes.minorticks_off()
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("elements of the rail")
    axes.set_ylabel("time of the stop / floor")
    axes.legend()
    return figure


FIGURES: dict[str, Callable[[list[dict[str, Any]]], Figure]] = {
    "speed_work_precision": work_precision,
    "speed_floor": floor,
    "speed_scaling": scaling,
}


def draw(records: list[dict[str, Any]], folder: Path, formats: tuple[str, ...] = ("png", "svg")) -> list[Path]:
    """Draw all figures into `folder`."""
    files = []
    for name, figure in FIGURES.items():
        with mpl.rc_context(STYLE):
            drawn = figure(records)
            for suffix in formats:
                files.append(folder / f"{name}.{suffix}")
                drawn.savefig(files[-1], dpi=100)
    return files
