"""Replays as a GIF or an MP4, drawn by matplotlib: the wagon of the report's page, or a tank alone."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.animation import FFMpegWriter, PillowWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from slosh_cli.arrays import Vector
from slosh_cli.report.saving import INK, MUTED, styled
from slosh_cli.results.files import FileError, replacing

_FRAMES: Final = 150
_RATE: Final = 10
_LOCKED: Final = "#c00000"
_LIQUID: Final = "#7fb3d9"


def write_animation(title: str, data: Mapping[str, Any], target: Path) -> None:
    """Write the replay of a page's `data` to `target`, .gif or .mp4, whole or not at all.

    A stop of more than 15 s is quickened, and the picture says so. Raises FileError for another ending, and for .mp4
    where there is no ffmpeg.
    """
    figure = Figure(figsize=(8.0, 3.4), dpi=80)
    axes = figure.add_axes((0.01, 0.01, 0.98, 0.86))

    def draw(row: int) -> str:
        _draw(axes, data, row)
        return f"{3.6 * data['speed'][row]:5.1f} km/h"

    _film(figure, title, np.array(data["time"]), draw, target)


def write_tank_animation(title: str, data: Mapping[str, Any], target: Path) -> None:
    """Write the replay of a tank alone: its section along with the surface, the force on it below. As
    `write_animation`."""
    with styled():
        figure = Figure(figsize=(8.0, 4.0), dpi=80)
        above = figure.add_axes((0.09, 0.44, 0.89, 0.42))
        below = figure.add_axes((0.09, 0.12, 0.89, 0.24))
    course, times = data["course"], data["time"]
    force = course["liquid_force"] / 1e3
    below.plot(course["time"], force, color=INK, linewidth=1.0)
    below.set(xlabel="time / s", ylabel="force / kN", xlim=(0.0, max(float(course["time"][-1]), 1e-9)))
    now = below.axvline(0.0, color=_LOCKED, linewidth=1.0)
    (dot,) = below.plot([0.0], [0.0], marker="o", markersize=4, color=_LOCKED)
    slowing, pushes = (np.interp(times, course["time"], values) for values in (course["deceleration"], force))

    def draw(row: int) -> str:
        _draw_tank(above, data["tank"], data["place"], data["rise"][row])
        now.set_xdata([times[row]] * 2)
        dot.set_data([times[row]], [pushes[row]])
        return f"deceleration {slowing[row]:5.2f} m/s², force of the liquid {pushes[row]:6.1f} kN"

    _film(figure, title, times, draw, target)


def _film(figure: Figure, title: str, times: Vector, draw: Callable[[int], str], target: Path) -> None:
    """Write frames, each drawn by `draw` at one of the `times` (n,) s and told in its words."""
    if target.suffix not in (".gif", ".mp4"):
        raise FileError(f"an animation is a .gif or an .mp4, not {target.name}", where=str(target))
    if target.suffix == ".mp4" and not FFMpegWriter.isAvailable():
        raise FileError(f"{target.name} needs ffmpeg, which is not here; write a .gif", where=str(target))
    count = min(_FRAMES, max(2, round(times[-1] * _RATE) + 1))
    quicker = max(1.0, times[-1] / (_FRAMES / _RATE))
    rows = np.searchsorted(times, np.linspace(0.0, times[-1], count)).clip(0, times.size - 1)
    writer: Any = PillowWriter(fps=_RATE) if target.suffix == ".gif" else FFMpegWriter(fps=_RATE)
    hurry, shown = f", {quicker:.3g} times quicker" if quicker > 1.0 else "", title.replace("$", r"\$")
    with styled(), tempfile.TemporaryDirectory() as folder:
        drawn = Path(folder) / f"animation{target.suffix}"
        FigureCanvasAgg(figure)
        with writer.saving(figure, str(drawn), 80):
            for row in rows:
                told = draw(int(row))
                words = f"{shown}\n{times[row]:5.2f} s, {told}{hurry}"
                figure.suptitle(words, x=0.02, y=0.99, ha="left", va="top", fontsize=10)
                writer.grab_frame()
        with replacing(target) as temporary:
            temporary.write_bytes(drawn.read_bytes())


def _draw(axes: Axes, data: Mapping[str, Any], row: int) -> None:
    """The wagon at a row, front to the right; units m."""
    wagon = data["wagon"]
    half, bottom, height, depth = wagon["length"] / 2, wagon["bottom"], wagon["height"], wagon["depth"]
    axes.clear()
    axes.set_axis_off()
    axes.axhline(0.0, color=MUTED)
    if "rise" in data:
        level = bottom + np.clip(depth + np.array(data["rise"][row]), 0.0, height)
        axes.fill_between(half - np.array(data["place"]), bottom, level, color=_LIQUID, linewidth=0.0)
    else:  # known at the walls alone
        for way, rises in zip((1.0, -1.0), data["walls"], strict=True):
            level = float(np.clip(depth + rises[row], 0.0, height))
            axes.add_patch(Rectangle((way * half, bottom), -0.15 * way, level, color=_LIQUID, linewidth=0.0))
    _draw_walls(axes, half, bottom, wagon)
    for i, wheel in enumerate(data["wheels"]):
        bogie, place = (1.0 if i < 2 else -1.0), (-1.0 if i % 2 else 1.0)
        middle = 0.5 * (bogie * wagon["pivot_spacing"] + place * wagon["wheelbase"])
        _draw_wheel(axes, wheel, row, middle, wagon["radius"])
    reach = max(half, 0.5 * (wagon["pivot_spacing"] + wagon["wheelbase"]) + wagon["radius"]) + 0.4
    axes.set(xlim=(-reach, reach), ylim=(-1.5, bottom + height + 0.3), aspect="equal")


def _draw_walls(axes: Axes, half: float, bottom: float, tank: Mapping[str, Any]) -> None:
    """Tank, baffles and still level about the tank's middle; units m."""
    axes.add_patch(Rectangle((-half, bottom), 2.0 * half, tank["height"], fill=False, edgecolor=INK))
    axes.plot([-half, half], [bottom + tank["depth"]] * 2, color=INK, linewidth=0.8, linestyle="--")
    for from_rear in tank["baffles"]:
        axes.plot([from_rear - half] * 2, [bottom, bottom + tank["height"]], color=INK, linewidth=0.8, linestyle="--")


def _draw_tank(axes: Axes, tank: Mapping[str, Any], place: Vector, rise: Vector) -> None:
    """A tank alone, front to the right, heights above its bottom; units m."""
    half, height = tank["length"] / 2, tank["height"]
    axes.clear()
    level = np.clip(tank["depth"] + rise, 0.0, height)
    axes.fill_between(half - place, 0.0, level, color=_LIQUID, linewidth=0.0)
    _draw_walls(axes, half, 0.0, tank)
    axes.set(xlim=(-1.02 * half, 1.02 * half), ylim=(-0.03 * height, 1.05 * height), ylabel="height / m")
    axes.set(aspect="equal", anchor="S")
    axes.grid(visible=False)
    axes.tick_params(labelbottom=False, bottom=False)
    axes.text(0.99, 0.93, "front", transform=axes.transAxes, ha="right", va="top", fontsize=8, color=MUTED)


def _draw_wheel(axes: Axes, wheel: Mapping[str, Any], row: int, middle: float, radius: float) -> None:
    """A wheel with its spokes, red where it is locked, and its normal force in kN."""
    colour = _LOCKED if wheel["locked"][row] else INK
    axes.add_patch(Circle((middle, radius), radius, facecolor="white", edgecolor=colour, zorder=3))
    for spoke in wheel["angle"][row] + np.arange(3) * 2.0 * np.pi / 3.0:  # clockwise, for the wagon runs to the right
        end = (middle + radius * np.cos(spoke), radius - radius * np.sin(spoke))
        axes.plot([middle, end[0]], [radius, end[1]], color=colour, linewidth=1.2, zorder=4)
    axes.text(middle, -0.9, f"{wheel['normal'][row] / 1e3:.0f} kN", ha="center", fontsize=8, color=colour)
