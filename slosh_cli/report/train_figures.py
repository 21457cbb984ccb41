"""Figures of a train: forces of its couplings over time and along it, speeds, slosh in every tank."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from slosh_cli.arrays import Matrix
from slosh_cli.report import FORMATS, TRAIN_FIGURES
from slosh_cli.report.figures import FRONT, REAR
from slosh_cli.report.saving import INK, MUTED, save, styled
from slosh_cli.results.train_result import TrainHistory

_LINES: Final = ("-", (0, (6, 2)), (0, (6, 2, 1, 2)), (0, (1.5, 1.2)))
_GREYS: Final = ("#08306b", "#4a98c9", "#8c2d04", "#fd8d3c")
_MOST_COLUMNS: Final = 1000


def draw_train(
    train: TrainHistory, folder: Path, formats: Sequence[str] = FORMATS, names: Sequence[str] = TRAIN_FIGURES
) -> list[Path]:
    """Draw those of the figures `names` that suit the train into `folder`; returns the files.

    Each file appears whole or not at all. Raises FileError when one cannot be written.
    """
    drawn = {
        "coupling_forces": _coupling_forces if train.couplings else None,
        "coupling_extremes": _coupling_extremes if train.couplings else None,
        "train_speed": _train_speed,
        "train_slosh": _train_slosh if any(_sloshes(train)) else None,
    }
    with styled():
        return [
            file
            for name, draw in drawn.items()
            if draw is not None and name in names
            for file in save(draw(train), folder, name, formats)
        ]


def _sloshes(train: TrainHistory) -> list[bool]:
    return [one.facts["liquid_model"] != "rigid" for one in train.vehicles]


def _picked(count: int) -> list[int]:
    """Up to four places along the train: its front, two inside, its end."""
    return sorted({round(part * (count - 1)) for part in (0.0, 1 / 3, 2 / 3, 1.0)})


def _axes(train: TrainHistory, title: str, across: str, up: str) -> tuple[Figure, Any]:
    figure = Figure(figsize=(9.6, 5.4), layout="constrained")
    axes = figure.add_subplot()
    axes.set_title(f"{title}: {train.name}, {len(train.vehicles)} vehicles", loc="left", color=INK)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    return figure, axes


def _coupling_forces(train: TrainHistory) -> Figure:
    """Forces of a few couplings against time."""
    figure, axes = _axes(train, "Coupling forces", "time / s", "force / kN, compression positive")
    for style, place in enumerate(_picked(len(train.couplings))):
        look = {"color": _GREYS[style], "linestyle": _LINES[style], "label": f"vehicles {place + 1} and {place + 2}"}
        axes.plot(train.time, train.couplings[place].channels["force"] / 1e3, **look)
    axes.axhline(0.0, color=MUTED, linewidth=0.8)
    axes.legend()
    return figure


def _coupling_extremes(train: TrainHistory) -> Figure:
    """Largest compression and tension of every coupling, along the train."""
    figure, axes = _axes(train, "Largest coupling forces", "coupling, from the front", "force / kN")
    places = np.arange(1, len(train.couplings) + 1)
    push = [one.facts["max_compression_N"] / 1e3 for one in train.couplings]
    pull = [one.facts["max_tension_N"] / 1e3 for one in train.couplings]
    axes.plot(places, push, marker="o", label="compression", **FRONT)
    axes.plot(places, pull, marker="s", label="tension", **REAR)
    axes.set_ylim(bottom=0.0)
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.legend()
    return figure


def _train_speed(train: TrainHistory) -> Figure:
    """Speeds of a few vehicles against time."""
    figure, axes = _axes(train, "Speed of the vehicles", "time / s", "speed / km/h")
    for style, place in enumerate(_picked(len(train.vehicles))):
        one = train.vehicles[place]
        label = f"vehicle {place + 1}: {one.facts['distance_m']:.1f} m from its onset"
        look = {"color": _GREYS[style], "linestyle": _LINES[style], "label": label}
        axes.plot(train.time, one.channels["speed"] * 3.6, **look)
    axes.legend()
    return figure


def _train_slosh(train: TrainHistory) -> Figure:
    """Rise of the surface at the front wall of every tank: time against the place in the train."""
    figure, axes = _axes(train, "Surface at the front walls", "time / s", "vehicle, from the front")
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    every = max(len(train.time) // _MOST_COLUMNS, 1)
    rise: Matrix = np.array([one.channels["surface_front"][::every] for one in train.vehicles])
    most = max(float(np.abs(rise).max()), 1e-9)
    edges = np.arange(len(train.vehicles) + 1) + 0.5
    times = train.time[::every]
    across = np.concatenate([times, times[-1:] + (train.time[-1] - times[-1]) + 1e-9])
    drawn = axes.pcolormesh(across, edges, rise, cmap="PuOr", vmin=-most, vmax=most, rasterized=True)
    axes.invert_yaxis()
    axes.grid(visible=False)
    figure.colorbar(drawn, ax=axes, label="rise / m")
    return figure
