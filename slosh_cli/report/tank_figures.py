"""Figures of a tank alone, as PNG and SVG: an excitation, the shape of a slosh mode, modes against the filling.

Lines differ in dash and lightness, the potential is drawn in lightness with contour lines: legible in greyscale.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from slosh_cli.report import figures
from slosh_cli.report.figures import FRONT, REAR
from slosh_cli.report.saving import INK, MUTED
from slosh_cli.section import TankGeometry, section_of
from slosh_cli.tank.mesh import Floats

if TYPE_CHECKING:
    from slosh_cli.solver.excite import Excitation
    from slosh_cli.tank.chart import FillChart
    from slosh_cli.tank.longitudinal import LongitudinalMode

_MODE_LOOKS: Final[tuple[dict[str, Any], ...]] = (
    {"color": "#08306b", "linestyle": "-"},
    {"color": "#c1440e", "linestyle": (0, (6, 2))},
    {"color": "#4a98c9", "linestyle": (0, (6, 2, 1, 2))},
    {"color": "#7a7a7a", "linestyle": (0, (1.5, 1.2))},
)
_WARNING_WIDTH: Final = 12.6
"""Characters of a warning per inch of a figure's width."""
_SURFACE_SHARE: Final = 0.16
"""The drawn rise of a mode's surface, as a share of the section's height."""


@dataclass(frozen=True)
class Heading:
    """What stands above a figure: what it shows, and of what; below it what to know before believing it."""

    title: str
    conditions: str
    warnings: Sequence[str] = ()


def excitation_figure(excitation: Excitation, heading: Heading, room: float) -> Figure:
    """Deceleration, force, moment and surface against time; `room` (m) is the roof's height over the still level."""
    figure = _headed(heading, (10.0, 9.2))
    given, force, moment, surface = figure.subplots(4, 1, sharex=True, height_ratios=[0.7, 1.2, 1.0, 1.2])
    time = excitation.time
    given.plot(time, excitation.deceleration, color=INK)
    given.set_ylabel("deceleration\n/ m/s²")
    force.plot(time, excitation.force / 1e3, color=INK)
    force.set_ylabel("force on tank,\nforward / kN")
    unit = excitation.mass * excitation.largest_deceleration / 1e3
    normalised = force.secondary_yaxis("right", functions=(lambda y: y / unit, lambda y: y * unit))
    normalised.set_ylabel("force / (m |a|)")
    moment.plot(time, excitation.moment / 1e3, color=INK)
    moment.set_ylabel("moment,\nnose-down / kN m")
    surface.plot(time, excitation.surface_front, **FRONT, label="front end wall")
    surface.plot(time, excitation.surface_rear, **REAR, label="rear end wall")
    watched = excitation.watched
    for number, (place, rises) in enumerate(zip(watched.probe_places, watched.probes.T, strict=True)):
        look = _MODE_LOOKS[(number + 2) % len(_MODE_LOOKS)]
        surface.plot(time, rises, **look, linewidth=1.2, label=f"{place:.4g} m from the rear wall")
    surface.set_ylabel("surface rise / m")
    if max(float(rise.max()) for rise in (excitation.surface_front, excitation.surface_rear)) > 0.4 * room:
        surface.axhline(room, color=MUTED, linewidth=1.4, linestyle=":", label=f"roof, {room:.2f} m above still level")
    surface.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, borderaxespad=0.2)
    surface.set_xlabel("time / s")
    for axes in (given, force, moment, surface):
        axes.axhline(0.0, color=MUTED, linewidth=0.8, zorder=1)
        axes.set_xlim(0.0, max(float(time[-1]), 1e-3))
    figure.align_ylabels([given, force, moment, surface])
    return figure


def mode_figure(mode: LongitudinalMode, tank: TankGeometry, heading: Heading) -> Figure:
    """Potential over the cross-section with the risen surface, and the surface along the tank."""
    figure = _headed(heading, (11.0, 5.2))
    across, along = figure.subplots(1, 2, width_ratios=[1.0, 1.35])
    section = section_of(tank)
    _draw_section(across, mode, tank, section.height)
    figure.legend(*across.get_legend_handles_labels(), loc="outside lower left")
    x = np.linspace(-0.5, 0.5, 400) * tank.length
    rise = np.cos(mode.n * math.pi * (x / tank.length + 0.5))
    rise *= math.copysign(1.0, rise[-1])  # drawn with the surface up in front
    along.fill_between(x, -1.4, rise, color="#cfe1f2", linewidth=0.0)
    along.plot(x, rise, color="#08306b", linewidth=2.0)
    along.axhline(0.0, color=MUTED, linewidth=1.0, linestyle=(0, (4, 3)))
    for wall in (-0.5, 0.5):
        along.axvline(wall * tank.length, color=INK, linewidth=2.2)
    along.set_ylim(-1.4, 1.4)
    along.set_xlabel("along the tank, forward / m")
    along.set_ylabel("mean rise over the width\n(at the end walls: 1)")
    along.set_title("along the tank", fontsize=13, loc="left", color=INK)
    return figure


def chart_figure(chart: FillChart, heading: Heading, fill: float) -> Figure:
    """Frequency, mass fraction and height of the modes against the filling; `fill` is the tank's own."""
    figure = _headed(heading, (14.5, 5.4), head=1.3)
    panels = figure.subplots(1, 3)
    quantities = (
        (chart.frequency, "frequency / rad/s"),
        (chart.mass_fraction, "slosh mass / liquid mass"),
        (chart.height, "height of the force\nabove the bottom / m"),
    )
    percent = 100.0 * chart.fill
    marker = "o" if len(percent) < 40 else None
    for axes, (values, label) in zip(panels, quantities, strict=True):
        for row, n in enumerate(chart.numbers):
            look = _MODE_LOOKS[row % len(_MODE_LOOKS)]
            axes.plot(percent, values[row], **look, marker=marker, markersize=3.5, label=f"n = {n}")
        axes.axvline(100.0 * fill, color=MUTED, linewidth=1.0, linestyle=":", label=f"filling {100.0 * fill:.3g} %")
        axes.set_xlabel("filling (depth over height) / %")
        axes.set_ylabel(label)
    for axes in panels[:2]:
        axes.set_ylim(bottom=0.0)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="upper left", ncols=8, bbox_to_anchor=(0.006, 1.0 - 0.85 / 5.4), borderaxespad=0.0
    )
    return figure


def _draw_section(axes: Axes, mode: LongitudinalMode, tank: TankGeometry, height: float) -> None:
    """The potential in the wetted part, the wall around it, and the surface at the front end wall."""
    shape = mode.shape
    levels = np.linspace(float(shape.potential.min()), float(shape.potential.max()), 13)
    if levels[-1] > levels[0]:
        mesh = Triangulation(shape.y, shape.z, shape.triangles)
        filled = axes.tricontourf(mesh, shape.potential, levels=levels, cmap="Blues")
        axes.tricontour(mesh, shape.potential, levels=levels, colors=INK, linewidths=0.4)
        bar = axes.figure.colorbar(filled, ax=axes, shrink=0.8, ticks=levels[::3], format="%.3g")
        bar.set_label("potential φ / m")
    depth = float(shape.z.max())
    lift = depth + _SURFACE_SHARE * height * shape.surface_rise
    axes.plot(shape.surface_y, lift, color="#c1440e", linewidth=2.2, label="risen surface (not to scale)")
    axes.plot(shape.surface_y[[0, -1]], [depth, depth], color=MUTED, linewidth=1.2, linestyle=(0, (4, 3)))
    y, z = _outline(tank, height)
    axes.plot(y, z, color=INK, linewidth=2.2)
    room = 0.04 * height
    axes.set_xlim(float(y.min()) - room, float(y.max()) + room)
    axes.set_ylim(-room, max(height, float(lift.max())) + room)
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.set_xlabel("y / m")
    axes.set_ylabel("z above the bottom / m")
    axes.set_title("cross-section at an end wall", fontsize=13, loc="left", color=INK)


def _outline(tank: TankGeometry, height: float) -> tuple[Floats, Floats]:
    """The wall as a line (y, z): a polygon's own corners, otherwise the width at many depths, on both sides."""
    points = getattr(tank, "points", None)
    if points is not None:
        corners = np.array([*points, points[0]], dtype=np.float64)
        return corners[:, 0], corners[:, 1]
    z = 0.5 * height * (1.0 - np.cos(np.linspace(0.0, math.pi, 200)))
    section = section_of(tank)
    inside = np.clip(z, 1e-9 * height, (1.0 - 1e-9) * height)
    half = np.array([0.5 * section.surface_width(float(level)) for level in inside])
    return np.concatenate([half, -half[::-1], half[:1]]), np.concatenate([z, z[::-1], z[:1]])


def _headed(heading: Heading, size: tuple[float, float], head: float = 0.95) -> Figure:
    """A figure of `size` (inches) with its head written; `head` inches stay free for it, and some for its warnings."""
    width, height = size
    lines = [
        line for text in heading.warnings for line in textwrap.wrap(f"Warning: {text}", int(_WARNING_WIDTH * width))
    ]
    foot = 0.195 * len(lines) + 0.1 * bool(lines)
    height += foot
    figure = Figure(figsize=(width, height), dpi=figures.RESOLUTION)
    figure.text(0.014, 1.0 - 0.14 / height, heading.title, fontsize=17, fontweight="bold", color=INK, va="top")
    figure.text(
        0.014, 1.0 - 0.5 / height, _shortened(heading.conditions, int(11.5 * width)), fontsize=12.5, color=MUTED,
        va="top", parse_math=False,
    )  # fmt: skip
    if lines:
        figure.text(
            0.014, 0.08 / height, "\n".join(lines), fontsize=10.5, color=figures.ALARM, va="bottom", linespacing=1.3,
            parse_math=False,
        )  # fmt: skip
    below = 0.008 + foot / height
    figure.set_layout_engine("constrained", rect=(0.008, below, 0.984, 1.0 - head / height - foot / height))
    return figure


def _shortened(text: str, length: int) -> str:
    return text if len(text) <= length else text[: length - 1] + "…"
