"""The replay of a stop, or of a tank alone: what the page's script and the animation draw of a history."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.errors import ScenarioError
from slosh_cli.report.html import plain_numbers
from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.files import FileError, try_targets

if TYPE_CHECKING:
    from slosh_cli.arrays import Integers, Matrix, Vector
    from slosh_cli.results.stored import History, StoredExcitation
    from slosh_cli.results.surface import SurfaceProfile
    from slosh_cli.scenario import Scenario, TankScenario

_MOST_ROWS: Final = 1000
_CHARTS: Final = (
    ("Speed, km/h", 3.6, ("speed",)),
    ("Normal force of each wheel, kN", 1e-3, tuple(wheel(i, "normal_force") for i in WHEELS)),
    ("Circumferential speed of each wheel, km/h", 3.6, tuple(wheel(i, "speed") for i in WHEELS)),
    ("Rise of the surface at the end walls, m", 1.0, ("surface_front", "surface_rear")),
    ("Force of the liquid on the tank, kN", 1e-3, ("liquid_force",)),
)
_LOCKED_SPEED: Final = 1e-3


def animate(source: str | Path, target: str | Path | None = None) -> Path:
    """Write the replay of a run's history, or of an excited tank's, as a GIF or an MP4; returns its file, default
    animation.gif beside it.

    It appears whole or not at all. Raises FileError for a source that is neither or has no surface along the tank where
    there is nothing else to draw, and for another kind of file.
    """
    from slosh_cli.report.animation import write_animation, write_tank_animation
    from slosh_cli.results.hdf5 import is_excitation, read_excitation, read_history, read_surface
    from slosh_cli.results.stored import StoredExcitation

    path = Path(source)
    held = read_excitation(path) if is_excitation(path) else read_history(path)
    file = Path(target) if target is not None else path.with_name("animation.gif")
    try_targets(file.parent, [file.name])
    if isinstance(held, StoredExcitation):
        if held.surface is None:
            told = "has no surface along the tank, as earlier versions of slosh recorded none"
            raise FileError(f"{path} {told}: run `slosh tank excite` again", where=str(path))
        write_tank_animation(held.name, _tank_data(path, held, held.surface), file)
    else:
        write_animation(held.name, replay_data(path, held, read_surface(path)), file)
    return file


def surface_words(history: History, profile: SurfaceProfile | None) -> str:
    """What the surface is that the replay of a run shows."""
    if profile is None:
        return "The surface was recorded at the end walls only and is drawn there alone."
    if not history.has_liquid:
        return "The load is frozen: its surface stays flat."
    if history.liquid_model == "shallow-water":
        return "The surface is that of the cells of the shallow-water liquid, cut off at the tank's roof."
    assumed = " Their shapes along the tank are assumed: cosines." if profile.standing == "assumed" else ""
    return f"The surface is that of the slosh modes, cut off at the tank's bottom and roof.{assumed}"


def replay_data(path: Path, history: History, profile: SurfaceProfile | None) -> dict[str, Any]:
    """What the replay of the run at `path` draws, at some thousand of its rows, and its curves over time."""
    scenario: Any = _scenario(path, history.scenario_text)
    wagon, held, rows = scenario.wagon, history.channels, _shown(history)
    moving = held["speed"] > _LOCKED_SPEED
    wheels = []
    for i, static in zip(WHEELS, history.static_wheel_load_N, strict=True):
        rolling = held[wheel(i, "speed")]
        turned = np.concatenate([[0.0], np.cumsum(0.5 * (rolling[1:] + rolling[:-1]) * np.diff(history.time))])
        locked = (np.abs(rolling) < _LOCKED_SPEED) & moving
        angle = plain_numbers(np.mod(turned / wagon.wheelset.wheel_radius, 2.0 * np.pi)[rows])
        normal = plain_numbers(held[wheel(i, "normal_force")][rows])
        wheels.append({"angle": angle, "normal": normal, "static": static, "locked": locked[rows].tolist()})
    data = {
        "time": plain_numbers(history.time[rows]),
        "speed": plain_numbers(held["speed"][rows]),
        "position": plain_numbers(held["position"][rows]),
        "walls": [plain_numbers(held[name][rows]) for name in ("surface_front", "surface_rear")],
        "wheels": wheels,
        "charts": [_chart(history, rows, *one) for one in _CHARTS],
        "wagon": {
            **_tank(scenario),
            **{"pivot_spacing": wagon.pivot_spacing, "wheelbase": wagon.bogie.wheelbase},
            "radius": wagon.wheelset.wheel_radius,
        },
    }
    return data if profile is None else data | _surface(profile, history.time[rows])


def _scenario(path: Path, text: str) -> Scenario | TankScenario:
    """The scenario of the history at `path`, from its text. Raises FileError where that is none."""
    from slosh_cli.scenario import load_any_scenario

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scenario.yaml"
        file.write_text(text, encoding="utf-8")
        try:
            return load_any_scenario(file)
        except ScenarioError as error:
            told = f"its scenario is none that this version can read: {error.problems[0].text('scenario')}"
            raise FileError(f"cannot read {path} as a slosh history: {told}; run it again", where=str(path)) from error


def _shown(history: History) -> Integers:
    """The rows shown: at equal steps, with the largest and the least of every curve."""
    even = np.linspace(0, history.time.size - 1, min(history.time.size, _MOST_ROWS)).round().astype(np.int64)
    curves = [history.channels[name] for _, _, names in _CHARTS for name in names]
    extremes = [int(find(values)) for values in curves for find in (np.argmin, np.argmax)]
    return np.unique(np.concatenate([even, np.asarray(extremes, dtype=np.int64)]))


def _tank(scenario: Scenario | TankScenario) -> dict[str, Any]:
    """The tank from the side, m; its baffles by their distances from the rear wall."""
    from slosh_cli.section import liquid_depth, section_of

    tank = scenario.tank
    return {
        **{"length": tank.length, "height": section_of(tank).height, "depth": liquid_depth(tank)},
        **{"bottom": getattr(tank, "bottom_height", 0.0), "baffles": [one.position for one in tank.baffles]},
    }


def _surface(profile: SurfaceProfile, time: Vector) -> dict[str, Any]:
    """The surface along the tank at other instants, to the millimetre."""
    along = np.stack([np.interp(time, profile.time, values) for values in profile.rise.T], axis=1)
    return {"place": plain_numbers(profile.place), "rise": np.round(along, 3).tolist()}


def _chart(history: History, rows: Integers, title: str, scale: float, names: Sequence[str]) -> dict[str, Any]:
    def short(name: str) -> str:
        return name.split("_normal", maxsplit=1)[0].split("_speed", maxsplit=1)[0].replace("_", " ")

    lines = [
        {
            "name": short(name),
            "channel": name,
            "scale": scale,
            "values": plain_numbers(history.channels[name][rows] * scale),
        }
        for name in names
    ]
    return {"title": title, "lines": lines}


def _tank_data(path: Path, excited: StoredExcitation, surface: SurfaceProfile) -> dict[str, Any]:
    """What the replay of a tank alone draws: the surface at the instants it is known, and the whole course of the
    force and the deceleration."""
    tank = _tank(_scenario(path, excited.scenario_text))
    baffles = np.array([place for place in tank["baffles"] if 0.0 < place < tank["length"]], dtype=np.float64)
    place, rise = _with_walls(surface.place, surface.rise, tank["length"], baffles)
    return {
        "time": surface.time,
        "place": tank["length"] - place,
        "rise": rise,
        "tank": tank,
        "course": {
            "time": excited.time,
            **{name: excited.channels[name] for name in ("liquid_force", "deceleration")},
        },
    }


def _with_walls(place: Vector, rise: Matrix, length: float, baffles: Vector) -> tuple[Vector, Matrix]:
    """Surfaces that are level from the last place to a wall, be it an end or a baffle with two sides."""
    behind = np.searchsorted(place, baffles).clip(1, place.size - 1)
    sides = np.stack([behind - 1, behind], axis=1).ravel()
    where = np.concatenate([[0.0, length], np.repeat(baffles, 2), place])
    taken = np.concatenate([[0, place.size - 1], sides, np.arange(place.size)])
    order = np.argsort(where, kind="stable")
    return where[order], rise[:, taken[order]]
