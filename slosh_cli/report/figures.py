"""Figures of a run, as PNG and SVG.

Every line differs from its neighbours in line style and in lightness, not in colour alone.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from textwrap import shorten, wrap
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from slosh_cli.arrays import Vector
from slosh_cli.report import FIGURE_NAMES, FORMATS
from slosh_cli.report.saving import INK, MUTED, save, styled
from slosh_cli.results.channels import WHEELS, slosh_amplitude, wheel
from slosh_cli.results.result import Record, Status

RESOLUTION: Final = 200  # dots per inch
_CAPTION_WIDTH: Final = 126  # characters

_WHEEL_STYLES: Final[Mapping[int, dict[str, Any]]] = {
    1: {"color": "#08306b", "linestyle": "-", "label": "wheel 1"},
    2: {"color": "#4a98c9", "linestyle": (0, (6, 2)), "label": "wheel 2"},
    3: {"color": "#8c2d04", "linestyle": (0, (6, 2, 1, 2)), "label": "wheel 3"},
    4: {"color": "#fd8d3c", "linestyle": (0, (1.5, 1.2)), "label": "wheel 4"},
}
_ENDS: Final = {1: "wheel 1 (leading)", 4: "wheel 4 (trailing)"}
FRONT: Final[dict[str, Any]] = {"color": "#08306b", "linestyle": "-"}
REAR: Final[dict[str, Any]] = {"color": "#fd8d3c", "linestyle": (0, (6, 2))}
ALARM: Final = "#a50f15"


def draw_run(
    record: Record, folder: Path, formats: Sequence[str] = FORMATS, names: Sequence[str] = FIGURE_NAMES
) -> list[Path]:
    """Draw those of the figures `names` that suit the run into `folder`; returns the files, one per figure and format.

    Each file appears whole or not at all. Raises FileError when one cannot be written.
    """
    with styled():
        return [
            file
            for name, draw in FIGURES.items()
            if name in names and record.has_figure(name)
            for file in save(draw(record), folder, name, formats)
        ]


def _contact_forces(record: Record) -> Figure:
    """Normal forces of the four wheels against time (Figure 2 of the paper)."""
    figure, (axes,) = _panels(record, "Wheel loads during braking", [1.0], height=5.6)
    for i in WHEELS:
        style = _WHEEL_STYLES[i] | ({"label": _ENDS[i]} if i in _ENDS else {})
        axes.plot(record.time, record.channels[wheel(i, "normal_force")] / 1e3, **style)
    for load in sorted({round(load / 1e3, 1) for load in record.static_wheel_load_N}):
        at_rest = axes.axhline(load, color=MUTED, linewidth=1.0, linestyle=":", zorder=1)
    at_rest.set_label("at rest")
    axes.set_ylabel("normal force per wheel / kN")
    _mark_onset(record, axes)
    _legend(axes, columns=5)
    return figure


def _speed_distance(record: Record) -> Figure:
    """Speed, acceleration of the car body and distance against time."""
    figure, (speed, acceleration, distance) = _panels(record, "Speed and distance", [1.25, 1.0, 1.0], height=7.4)
    speed.plot(record.time, record.channels["speed"] * 3.6, color=INK)
    speed.set_ylabel("speed / km/h")
    speed.set_ylim(bottom=min(0.0, float(record.channels["speed"].min()) * 3.6))
    acceleration.plot(record.time, record.channels["car_acceleration"], color=INK, linewidth=1.2)
    acceleration.axhline(0.0, color=MUTED, linewidth=0.8)
    acceleration.set_ylabel("acceleration\nof the car / m/s²")
    position = record.channels["position"]
    distance.plot(record.time, position, color=INK)
    distance.set_ylabel("distance / m")
    distance.set_ylim(bottom=0.0)
    if record.braking_distance_m is not None:
        text = f"braking distance {record.braking_distance_m:.1f} m"
        end = (float(record.time[-1]), float(position[-1]))
        distance.plot(*end, "o", color=INK, markersize=6, clip_on=False)
        distance.annotate(text, end, xytext=(-10, -16), textcoords="offset points", ha="right", va="top")
    for axes in (speed, acceleration, distance):
        _mark_onset(record, axes, named=axes is speed)
    return figure


def _wheel_speed(record: Record) -> Figure:
    """Circumferential speed of the wheels against the train's, their slip, and where they are locked."""
    figure, (speed, slip, locked) = _panels(record, "Wheel speed and slip", [1.5, 1.0, 0.7], height=7.8)
    speed.plot(
        record.time, record.channels["speed"] * 3.6, color="#c8c8c8", linewidth=5.0, solid_capstyle="round",
        label="train",
    )  # fmt: skip
    for i in WHEELS:
        speed.plot(record.time, record.channels[wheel(i, "speed")] * 3.6, **_WHEEL_STYLES[i])
        slip.plot(record.time, 100.0 * record.channels[wheel(i, "creepage")], **_WHEEL_STYLES[i])
    speed.set_ylabel("circumferential\nspeed / km/h")
    speed.set_ylim(bottom=0.0)
    slip.set_ylim(5e-3, 200.0)
    slip.set_yscale("log", nonpositive="mask")
    slip.set_yticks([0.01, 0.1, 1.0, 10.0, 100.0], ["0.01", "0.1", "1", "10", "100"])
    slip.set_ylabel("slip / %")
    _draw_locked(record, locked)
    _legend(speed, columns=5)
    for axes in (speed, slip, locked):
        _mark_onset(record, axes, named=axes is speed)
    return figure


def _slosh(record: Record) -> Figure:
    """Rise of the surface at both ends below the roof, amplitudes of the modes, force of the liquid."""
    amplitudes = _amplitudes(record)
    shares = [1.5, 1.0, 1.0] if amplitudes else [1.5, 1.0]
    figure, (surface, *others) = _panels(record, "Sloshing of the liquid", shares, height=7.8)
    surface.plot(record.time, record.channels["surface_front"], **FRONT, label="front end wall")
    surface.plot(record.time, record.channels["surface_rear"], **REAR, label="rear end wall")
    surface.set_ylabel("surface rise / m")
    _draw_roof(record, surface)
    _legend(surface, columns=3)
    force = others[-1]
    force.plot(record.time, record.channels["liquid_force"] / 1e3, color=INK)
    force.set_ylabel("force on tank,\nforward / kN")
    if amplitudes:
        _draw_amplitudes(record, others[0], amplitudes)
    for axes in (surface, *others):
        axes.axhline(0.0, color=MUTED, linewidth=0.8, zorder=1)
        _mark_onset(record, axes, named=axes is surface)
    return figure


def _brake(record: Record) -> Figure:
    """Application of the brake, friction where the brake has it, torque of the outer wheels: held and transmitted."""
    shares = [0.8, 0.8, 1.4] if wheel(1, "friction") in record.channels else [0.8, 1.4]
    figure, (applied, *middle, torque) = _panels(record, "The brake", shares, height=7.4)
    applied.plot(record.time, 100.0 * record.channels["brake_application"], color=INK, label="application")
    applied.set_ylabel("part of the\nfull force / %")
    for i in _ENDS:
        style, share = _WHEEL_STYLES[i], record.channels.get(wheel(i, "slide_protection_share"))
        if share is not None:
            left = {"label": f"left by slide protection, wheel {i}", "linewidth": 1.0}
            applied.plot(record.time, 100.0 * share, **style | left)
        for axes in middle:
            axes.plot(record.time, record.channels[wheel(i, "friction")], **style)
            axes.set_ylabel("friction\ncoefficient")
        held, label = record.channels[wheel(i, "held_torque")] / 1e3, "that the brakes can hold" if i == 1 else None
        torque.plot(record.time, held, color="#bdbdbd", linewidth=3.5, label=label)
        torque.plot(record.time, record.channels[wheel(i, "brake_torque")] / 1e3, **style)
    torque.set_ylabel("brake torque\nper wheel / kN m")
    _legend(applied, columns=3)
    _legend(torque, columns=3)
    for axes in (applied, *middle, torque):
        axes.set_ylim(bottom=0.0)
        _mark_onset(record, axes, named=axes is applied)
    return figure


def _line(record: Record) -> Figure:
    """The stop against the distance, and under it the line: its height with the gradient, the level of its rails."""
    position, rows = record.channels["position"], _line_rows(record)
    figure, (speed, loads, *under) = _panels(record, "The stop on its line", [1.0, 1.0, *[0.9] * len(rows)], height=9.0)
    speed.plot(position, record.channels["speed"] * 3.6, color=INK)
    speed.set_ylabel("speed / km/h")
    speed.set_ylim(bottom=min(0.0, float(record.channels["speed"].min()) * 3.6))
    for i in _ENDS:
        loads.plot(position, record.channels[wheel(i, "normal_force")] / 1e3, **_WHEEL_STYLES[i] | {"linewidth": 1.1})
    loads.set_ylabel("normal force\nper wheel / kN")
    _legend(loads, columns=2)
    for axes, (label, values) in zip(under, rows, strict=True):
        low, high, size = float(values.min()), float(values.max()), float(np.abs(values).max()) or 1.0
        room = 0.1 * (high - low if high - low > 1e-6 * size else size)  # what stays the same has a scale, too
        axes.fill_between(position, values, low - room, color="#d9d9d9")
        axes.plot(position, values, color=INK, linewidth=1.2)
        axes.set_ylim(low - room, high + room)
        axes.set_ylabel(label)
    onset = float(np.interp(record.onset_s, record.time, position))
    for axes in (speed, loads, *under):
        axes.set_xlim(float(position[0]), max(float(position.max()), 0.1) * 1.01)
        if record.onset_s < record.time[-1]:
            axes.axvline(onset, color=MUTED, linewidth=1.0, linestyle=(0, (2, 2)), zorder=1)
    (under or [loads])[-1].set_xlabel("distance / m")
    return figure


def _line_rows(record: Record) -> list[tuple[str, Vector]]:
    """Label and values of what the line has beside being level and even."""
    units = {"line_height": ("height of\nthe line / m", 1.0), "line_gradient": ("gradient\n/ permille", 1e3)}
    units["rail_level"] = ("rail level under\nwheel 1 / mm", 1e3)
    return [(label, per * record.channels[name]) for name, (label, per) in units.items() if name in record.channels]


FIGURES: Final[Mapping[str, Callable[[Record], Figure]]] = {
    "contact_forces": _contact_forces,
    "speed_distance": _speed_distance,
    "wheel_speed": _wheel_speed,
    "slosh": _slosh,
    "brake": _brake,
    "line": _line,
}
"""Every figure of a run, by the name of its files."""


def _conditions(record: Record) -> str:
    """Scenario, speed, torque and load in one line, for the head of a figure."""
    load = f"liquid ({record.liquid_model})" if record.has_liquid else "equivalent solid"
    speed = f"{record.initial_speed_m_s * 3.6:.4g} km/h"
    torque = record.torque_words
    return f"{shorten(record.name, 48, placeholder='...')}: V₀ = {speed}, {torque}, {load}"


def _caption(record: Record) -> str:
    """What a reader must know before trusting the figure: how the run ended, its warnings; mostly empty."""
    ended = [] if record.status is Status.STOPPED else [f"The run ended as {record.status}: {record.reason}"]
    return "\n".join([*ended, *(f"Warning: {warning}" for warning in record.warnings)])


def _panels(record: Record, title: str, shares: Sequence[float], height: float) -> tuple[Figure, list[Axes]]:
    """A figure with panels above each other that share the time axis, a head and, if need be, a caption."""
    note = "\n".join(line for text in _caption(record).splitlines() for line in wrap(text, _CAPTION_WIDTH))
    lines = note.count("\n") + 1 if note else 0
    extra = 0.195 * lines + 0.05 * bool(lines)
    figure = Figure(figsize=(10.0, height + extra), dpi=RESOLUTION)
    total = height + extra
    figure.text(0.018, 1.0 - 0.16 / total, title, fontsize=17, fontweight="bold", color=INK, va="top")
    figure.text(0.018, 1.0 - 0.52 / total, _conditions(record), fontsize=12.5, color=MUTED, va="top", parse_math=False)
    if note:
        figure.text(
            0.018, 0.12 / total, note, fontsize=10.5, color=ALARM, va="bottom", linespacing=1.3, parse_math=False
        )
    figure.set_layout_engine("constrained", rect=(0.012, (extra + 0.1) / total, 0.98, 1.0 - (extra + 0.95) / total))
    axes = figure.subplots(len(shares), 1, sharex=True, squeeze=False, height_ratios=list(shares))[:, 0]
    for panel in axes:
        panel.set_xlim(float(record.time[0]), max(float(record.time[-1]), 0.1) * 1.01)
    axes[-1].set_xlabel("time / s")
    axes[-1].xaxis.set_major_locator(MaxNLocator(nbins=10, steps=[1, 2, 5, 10]))
    figure.align_ylabels(list(axes))
    return figure, list(axes)


def _mark_onset(record: Record, axes: Axes, *, named: bool = True) -> None:
    if record.onset_s >= record.time[-1]:
        return
    axes.axvline(record.onset_s, color=MUTED, linewidth=1.0, linestyle=(0, (2, 2)), zorder=1)
    if named:
        axes.annotate(
            "brake on", (record.onset_s, 0.02), xycoords=("data", "axes fraction"), xytext=(4, 0),
            textcoords="offset points", color=MUTED, fontsize=10.5, va="bottom",
        )  # fmt: skip


def _legend(axes: Axes, columns: int) -> None:
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, borderaxespad=0.2, columnspacing=1.3)


def _draw_locked(record: Record, axes: Axes) -> None:
    """One bar per wheel, filled where the wheel stands while the wagon moves."""
    found = False
    for i in WHEELS:
        stretches = record.locked_stretches(i)
        found = found or bool(stretches)
        axes.broken_barh(stretches, (i - 0.36, 0.72), facecolor=_WHEEL_STYLES[i]["color"], edgecolor=INK, linewidth=0.8)
    axes.set_ylim(4.6, 0.4)
    axes.set_yticks(list(WHEELS))
    axes.set_ylabel("locked\nwheel")
    axes.grid(visible=False, axis="y")
    if not found:
        axes.text(0.5, 0.5, "no wheel locks", transform=axes.transAxes, ha="center", va="center", color=MUTED)


def _draw_roof(record: Record, axes: Axes) -> None:
    """Hatch the tank's roof above the room that the surface has."""
    limit = record.surface_limit_m
    if not np.isfinite(limit):
        return
    highest = max(float(record.channels[f"surface_{end}"].max()) for end in ("front", "rear"))
    top = max(highest, limit) * 1.15
    axes.axhspan(limit, top, facecolor="#d9d9d9", edgecolor="#8a8a8a", hatch="///", linewidth=0.0, zorder=0)
    axes.axhline(limit, color=INK, linewidth=1.4, label=f"roof, {limit:.2f} m above still level")
    axes.set_ylim(top=top)


def _amplitudes(record: Record) -> list[int]:
    """Numbers of the modes that the run has."""
    numbers = range(1, len(record.channels) + 1)
    return [n for n in numbers if slosh_amplitude(n) in record.channels]


def _draw_amplitudes(record: Record, axes: Axes, modes: Sequence[int]) -> None:
    greys = np.linspace(0.1, 0.65, len(modes))
    styles = ("-", (0, (6, 2)), (0, (6, 2, 1, 2)), (0, (1.5, 1.2)))
    for n, grey in zip(modes, greys, strict=True):
        style = styles[(n - 1) % len(styles)]
        values = record.channels[slosh_amplitude(n)]
        axes.plot(record.time, values, color=str(round(float(grey), 3)), linestyle=style, label=f"mode {n}")
    axes.set_ylabel("modal\namplitude / m")
    if len(modes) > 1:
        _legend(axes, columns=6)
