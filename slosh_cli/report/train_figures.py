"""Figures of a train: forces of its couplings over time and along it, brake wave, speeds, slosh in every tank."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from slosh_cli.arrays import Integers, Matrix, Vector
from slosh_cli.report import FORMATS, TRAIN_FIGURES
from slosh_cli.report.figures import FRONT, REAR
from slosh_cli.report.saving import INK, MUTED, save, styled
from slosh_cli.results.train_result import TrainHistory

_LINES: Final = ("-", (0, (6, 2)), (0, (6, 2, 1, 2)), (0, (1.5, 1.2)))
_GREYS: Final = ("#08306b", "#4a98c9", "#8c2d04", "#fd8d3c")
_MOST_COLUMNS: Final = 1000
_APPLIED: Final = 0.95


def draw_train(
    train: TrainHistory, folder: Path, formats: Sequence[str] = FORMATS, names: Sequence[str] = TRAIN_FIGURES
) -> list[Path]:
    """Draw those of the figures `names` that suit the train into `folder`; returns the files.

    Each file appears whole or not at all. Raises FileError when one cannot be written.
    """
    with styled():
        return [
            file
            for name, draw in train_figures(train).items()
            if name in names
            for file in save(draw(), folder, name, formats)
        ]


def train_figures(train: TrainHistory) -> dict[str, Callable[[], Figure]]:
    """What draws each figure that suits the train, by name."""
    found: dict[str, Callable[[TrainHistory], Figure]] = {}
    if train.couplings:
        found |= {"coupling_forces": _coupling_forces, "coupling_extremes": _coupling_extremes}
        found |= {"brake_wave": _brake_wave}
    found |= {"train_speed": _train_speed}
    found |= {"train_slosh": _train_slosh} if any(_sloshes(train)) else {}
    return {name: partial(draw, train) for name, draw in found.items()}


def _sloshes(train: TrainHistory) -> list[bool]:
    return [one.facts["liquid_model"] != "rigid" for one in train.vehicles]


def _picked(count: int) -> list[int]:
    """Up to four places along the train: its front, two inside, its end."""
    return sorted({round(part * (count - 1)) for part in (0.0, 1 / 3, 2 / 3, 1.0)})


def _title(train: TrainHistory, title: str) -> str:
    return f"{title}: {train.name}, {len(train.vehicles)} vehicles"


def _largest(values: Vector, begins: Integers) -> Vector:
    """The value of largest magnitude of each stretch: no blow is lost where there is no room for every row."""
    low, high = np.minimum.reduceat(values, begins), np.maximum.reduceat(values, begins)
    return np.where(-low > high, low, high)


def _waterfall(axes: Any, train: TrainHistory, values: Sequence[Vector], front: float, colours: str) -> Any:
    """Draw time against the place in the train, the front above; values of either sign in shades of their own. The
    first of them begins at the place `front`."""
    edges = np.arange(len(values) + 1) + front
    every = max(len(train.time) // _MOST_COLUMNS, 1)
    begins = np.arange(0, len(train.time), every)
    found: Matrix = np.array([_largest(one, begins) for one in values])
    most, times = max(float(np.abs(found).max()), 1e-9), train.time[begins]
    across = np.concatenate([times, times[-1:] + (train.time[-1] - times[-1]) + 1e-9])
    drawn = axes.pcolormesh(across, edges, found, cmap=colours, vmin=-most, vmax=most, rasterized=True)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_ylim(len(train.vehicles) + 0.5, 0.5)
    axes.grid(visible=False)
    return drawn


def _axes(train: TrainHistory, title: str, across: str, up: str) -> tuple[Figure, Any]:
    figure = Figure(figsize=(9.6, 5.4), layout="constrained")
    axes = figure.add_subplot()
    axes.set_title(_title(train, title), loc="left", color=INK)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    return figure, axes


def _legend(figure: Figure, axes: Any, columns: int = 4) -> None:
    """What the lines mean, under the picture: no line is covered."""
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=columns)


def _coupling_forces(train: TrainHistory) -> Figure:
    """Forces of a few couplings against time."""
    figure, axes = _axes(train, "Coupling forces", "time / s", "force / kN, compression positive")
    for style, place in enumerate(_picked(len(train.couplings))):
        look = {"color": _GREYS[style], "linestyle": _LINES[style], "label": f"vehicles {place + 1} and {place + 2}"}
        axes.plot(train.time, train.couplings[place].channels["force"] / 1e3, **look)
    axes.axhline(0.0, color=MUTED, linewidth=0.8)
    _legend(figure, axes)
    return figure


def _coupling_extremes(train: TrainHistory) -> Figure:
    """Largest compression and tension of every coupling along the train, and when they come."""
    figure = Figure(figsize=(9.6, 7.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    above.set_title(_title(train, "Largest coupling forces"), loc="left", color=INK)
    above.set_ylabel("force / kN")
    below.set_ylabel("instant / s")
    below.set_xlabel("coupling, from the front")
    places = np.arange(1, len(train.couplings) + 1)
    for way, marker, look in (("compression", "o", FRONT), ("tension", "s", REAR)):
        forces = [one.facts[f"max_{way}_N"] / 1e3 for one in train.couplings]
        above.plot(places, forces, marker=marker, label=way, clip_on=False, **look)
        instants = [one.facts.get(f"max_{way}_s", np.nan) for one in train.couplings]
        below.plot(places, instants, marker=marker, label=way, **look)
    above.set_ylim(bottom=0.0)
    below.set_ylim(bottom=0.0)
    below.xaxis.get_major_locator().set_params(integer=True)
    _legend(figure, above)
    return figure


def _brake_wave(train: TrainHistory) -> Figure:
    """Forces of all couplings, time against the place in the train, with the way of the brakes along it."""
    figure, axes = _axes(train, "Brake wave and coupling forces", "time / s", "vehicle, from the front")
    force = [one.channels["force"] / 1e3 for one in train.couplings]
    drawn = _waterfall(axes, train, force, 1.0, "RdBu_r")
    vehicles = np.arange(1, len(train.vehicles) + 1)
    axes.plot([one.facts["onset_s"] for one in train.vehicles], vehicles, color=INK, label="brakes set in")
    full = [_first_time(train, one.channels["brake_application"], _APPLIED) for one in train.vehicles]
    axes.plot(full, vehicles, color=INK, linestyle=_LINES[1], label=f"{_APPLIED:.0%} of the full brake")
    _legend(figure, axes)
    figure.colorbar(drawn, ax=axes, label="force / kN, compression positive")
    return figure


def _first_time(train: TrainHistory, values: Vector, level: float) -> float:
    """When a channel first reaches a level, s; NaN where it never does."""
    reached = np.flatnonzero(values >= level)
    return float(train.time[reached[0]]) if reached.size else np.nan


def _train_speed(train: TrainHistory) -> Figure:
    """Speeds of a few vehicles against time."""
    figure, axes = _axes(train, "Speed of the vehicles", "time / s", "speed / km/h")
    for style, place in enumerate(_picked(len(train.vehicles))):
        one = train.vehicles[place]
        label = f"vehicle {place + 1}: {one.facts['distance_m']:.1f} m from its onset"
        look = {"color": _GREYS[style], "linestyle": _LINES[style], "label": label}
        axes.plot(train.time, one.channels["speed"] * 3.6, **look)
    _legend(figure, axes, columns=2)
    return figure


def _train_slosh(train: TrainHistory) -> Figure:
    """Rise of the surface at the front wall of every tank: time against the place in the train."""
    figure, axes = _axes(train, "Surface at the front walls", "time / s", "vehicle, from the front")
    rise = [one.channels["surface_front"] for one in train.vehicles]
    drawn = _waterfall(axes, train, rise, 0.5, "PuOr")
    figure.colorbar(drawn, ax=axes, label="rise / m")
    return figure
