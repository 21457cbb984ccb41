"""The figure of a search: every stop that was computed, what was found, and the limits."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from matplotlib.figure import Figure

from slosh_cli.report.saving import INK, MUTED

_BLUE, _RED = "#08306b", "#c1440e"


def search_figure(found: Any) -> Figure:
    """An answer against the key, with the value that was found; one panel.

    `found` is a `Searched`. Stops outside a limit are hollow, stops without an answer stand as crosses at the top, a
    line leads from neighbour to neighbour but not over a jump.
    """
    search = found.search
    figure = Figure(figsize=(8.4, 5.6), dpi=150, layout="constrained")
    axes = figure.subplots()
    sign = -1.0 if search.most else 1.0
    jumps = {one.below.x for one in found.passages if one.kind == "jump"}
    for first, second in pairwise(found.samples):
        if first.value is not None and second.value is not None and first.x not in jumps:
            axes.plot([first.x, second.x], [sign * first.value, sign * second.value], color=_BLUE, zorder=2)
    answered = [one for one in found.samples if one.value is not None]
    for words, inside in (("a stop", True), ("a stop outside a limit", False)):
        marks = [one for one in answered if one.admitted == inside]
        if marks:
            axes.plot(
                [one.x for one in marks], [sign * one.value for one in marks], "o", color=_BLUE, markersize=6.0,
                markerfacecolor=_BLUE if inside else "white", label=words, zorder=3,
            )  # fmt: skip
    missing = [one.x for one in found.samples if one.value is None]
    if missing:
        axes.plot(
            missing, [0.97] * len(missing), "x", color=_RED, transform=axes.get_xaxis_transform(),
            label="a stop without an answer", zorder=3,
        )  # fmt: skip
    _draw_target(axes, found)
    span = search.span
    axes.set_xlabel(f"{span.key} / {span.unit}" if span.unit else span.key)
    axes.set_ylabel(search.asked.label)
    if not any(one.value for one in answered):
        axes.set_ylim(-0.05, 1.0)  # nothing but zeros: a scale of its own would seem to show digits of them
    limits = ", ".join(one.words for one in search.limits)
    axes.set_title(
        "\n".join([span.base.name, *([f"within {limits}"] if limits else [])]), loc="left", fontsize=13, color=INK,
        parse_math=False,
    )  # fmt: skip
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def _draw_target(axes: Any, found: Any) -> None:
    """The value asked for as a level line, and the key's value that was found as an upright one."""
    search, passage = found.search, found.passage
    if search.asked.sign == "=":
        axes.axhline(search.asked.target, color=MUTED, linestyle=(0, (6, 2)), label=search.asked.words, zorder=1)
    place = found.value if found.value is not None else passage.x if passage else None
    if place is not None:
        what = found.kind if found.best is None else f"best ({found.kind})"
        axes.axvline(place, color=_RED, linestyle=(0, (1.5, 1.2)), label=f"{what}: {search.span.text(place, 6)}")
