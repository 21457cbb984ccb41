"""Figures of several runs over each other, told apart by line style and lightness, against the time since the onset."""

from collections.abc import Mapping, Sequence
from textwrap import shorten
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from slosh_cli.arrays import Vector
from slosh_cli.report.figures import RESOLUTION
from slosh_cli.report.saving import INK
from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.result import Record

LOOKS: Final[Sequence[dict[str, Any]]] = (
    {"color": "#08306b", "linestyle": "-", "linewidth": 2.2},
    {"color": "#e07020", "linestyle": (0, (6, 2))},
    {"color": "#4a98c9", "linestyle": (0, (1.5, 1.2))},
    {"color": "#7f1d1d", "linestyle": (0, (6, 2, 1, 2))},
    {"color": "#9a9a9a", "linestyle": "-", "linewidth": 1.2},
    {"color": "#111111", "linestyle": (0, (10, 3))},
)
"""How the runs of one picture are told apart, in their order."""
_POSITION, _SLOSH = "position", "compare_slosh"
_Panel = tuple[str, str, float]
"""Label of the vertical axis, channel, SI units that a unit of the axis counts."""
_LOADS: Final = [(f"wheel {i} / kN", wheel(i, "normal_force"), 1e3) for i in WHEELS]
_PANELS: Final[Mapping[str, tuple[str, Sequence[_Panel]]]] = {
    "compare_speed": (
        "Speed and distance",
        [("speed / km/h", "speed", 1 / 3.6), ("distance since\nthe onset / m", _POSITION, 1.0)],
    ),
    "compare_wheel_loads": ("Wheel loads", _LOADS),
    _SLOSH: (
        "Sloshing of the liquid",
        [
            ("surface at the\nfront wall / m", "surface_front", 1.0),
            ("surface at the\nrear wall / m", "surface_rear", 1.0),
            ("force on tank,\nforward / kN", "liquid_force", 1e3),
        ],
    ),
    "compare_brake": (
        "The brake",
        [("part of the\nfull force / %", "brake_application", 0.01)]
        + [(f"torque at\nwheel {i} / kN m", wheel(i, "brake_torque"), 1e3) for i in (1, 4)],
    ),
}
_SAME_SCALE: Final = ("compare_wheel_loads",)
"""Figures whose panels share the vertical axis."""


def suits(name: str, runs: Sequence[Record]) -> bool:
    """Whether the figure `name` has something to show of `runs`."""
    return any(_shows(name, run) for run in runs)


def compare_figure(name: str, runs: Sequence[Record], names: Sequence[str]) -> Figure:
    """The figure `name` of `runs`, which the legend above the panels calls by `names`."""
    title, panels = _PANELS[name]
    figure = Figure(figsize=(10.0, 1.2 + 2.3 * len(panels) + 0.25 * len(runs)), dpi=RESOLUTION, layout="constrained")
    figure.suptitle(title, x=0.02, ha="left", fontsize=17, fontweight="bold", color=INK)
    shared = name in _SAME_SCALE
    axes = figure.subplots(len(panels), 1, sharex=True, sharey=shared, squeeze=False)[:, 0]
    drawn = {}
    for place, run in enumerate(runs):
        if not _shows(name, run):
            continue
        for one, (label, channel, per) in zip(axes, panels, strict=True):
            values = _values(run, channel) / per
            (line,) = one.plot(run.time - run.onset_s, values, **LOOKS[place])
            one.set_ylabel(label)
            drawn[shorten(names[place], 100, placeholder="...")] = line
    axes[-1].set_xlabel("time since the brake set in / s")
    figure.align_ylabels(list(axes))
    figure.legend(handles=list(drawn.values()), labels=list(drawn), loc="outside lower left", ncols=1)
    return figure


def _values(run: Record, channel: str) -> Vector:
    """A channel; of the position what is counted from the onset, as the braking distance is."""
    values = run.channels[channel]
    return values - np.interp(run.onset_s, run.time, values) if channel == _POSITION else values


def _shows(name: str, run: Record) -> bool:
    channels = [channel for _, channel, _ in _PANELS[name][1]]
    return (name != _SLOSH or run.has_liquid) and all(channel in run.channels for channel in channels)
