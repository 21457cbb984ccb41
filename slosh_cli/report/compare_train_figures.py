"""Figures of several trains over each other: forces along the train, speed and way of the first vehicle."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from textwrap import shorten
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from slosh_cli.report.compare_figures import LOOKS
from slosh_cli.report.figures import RESOLUTION
from slosh_cli.report.saving import INK
from slosh_cli.results.train_result import TrainHistory

_MARKERS: Final = "os^vDx"


def compare_train_figures(trains: Sequence[TrainHistory], names: Sequence[str]) -> Mapping[str, Callable[[], Figure]]:
    """What draws each figure of `trains`, which the legend below the panels calls by `names`."""
    found = {"compare_train_speed": partial(_speed, trains, names)}
    coupled = any(train.couplings for train in trains)
    return found | ({"compare_train_forces": partial(_forces, trains, names)} if coupled else {})


def _forces(trains: Sequence[TrainHistory], names: Sequence[str]) -> Figure:
    """The largest compression and tension of every coupling along the train."""
    figure, axes = _panels("Largest coupling forces along the train", len(trains))
    drawn = {}
    for place, train in enumerate(trains):
        for one, way in zip(axes, ("compression", "tension"), strict=True):
            forces = [coupling.facts[f"max_{way}_N"] / 1e3 for coupling in train.couplings]
            look = LOOKS[place] | {"marker": _MARKERS[place], "markersize": 5}
            (line,) = one.plot(np.arange(1, len(forces) + 1), forces, **look)
            one.set_ylabel(f"{way} / kN")
            drawn[shorten(names[place], 100, placeholder="...")] = line
    for one in axes:
        one.set_ylim(bottom=0.0)  # after all lines, for it ends the search for the largest value
    axes[-1].set_xlabel("coupling, from the front")
    axes[-1].xaxis.set_major_locator(MaxNLocator(integer=True))
    figure.legend(handles=list(drawn.values()), labels=list(drawn), loc="outside lower left", ncols=1)
    return figure


def _speed(trains: Sequence[TrainHistory], names: Sequence[str]) -> Figure:
    """Speed and way of the first vehicle from its onset."""
    figure, axes = _panels("Speed and distance of the first vehicle", len(trains))
    drawn = {}
    for place, train in enumerate(trains):
        first = train.vehicles[0]
        onset, way = first.facts["onset_s"], first.channels["position"]
        distance = way - np.interp(onset, train.time, way)
        for one, values, label in zip(
            axes,
            (first.channels["speed"] * 3.6, distance),
            ("speed / km/h", "distance since\nthe onset / m"),
            strict=True,
        ):
            (line,) = one.plot(train.time - onset, values, **LOOKS[place])
            one.set_ylabel(label)
            drawn[shorten(names[place], 100, placeholder="...")] = line
    axes[-1].set_xlabel("time since the brake of the first vehicle set in / s")
    figure.legend(handles=list(drawn.values()), labels=list(drawn), loc="outside lower left", ncols=1)
    return figure


def _panels(title: str, count: int) -> tuple[Figure, Any]:
    figure = Figure(figsize=(10.0, 5.8 + 0.25 * count), dpi=RESOLUTION, layout="constrained")
    figure.suptitle(title, x=0.02, ha="left", fontsize=17, fontweight="bold", color=INK)
    axes = figure.subplots(2, 1, sharex=True)
    figure.align_ylabels(list(axes))
    return figure, axes
