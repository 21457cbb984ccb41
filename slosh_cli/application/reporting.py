"""The report of a run, a train or a study: one HTML page."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.application.differing import labelled
from slosh_cli.application.input_tables import inputs_table
from slosh_cli.report.html import page_table, page_text, plain_numbers
from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.files import FileError, write_text

if TYPE_CHECKING:
    from slosh_cli.arrays import Integers
    from slosh_cli.results.stored import History
    from slosh_cli.results.surface import SurfaceProfile
    from slosh_cli.scenario import Scenario

_MOST_ROWS: Final = 1000
_CHARTS: Final = (
    ("Speed, km/h", 3.6, ("speed",)),
    ("Normal force of each wheel, kN", 1e-3, tuple(wheel(i, "normal_force") for i in WHEELS)),
    ("Circumferential speed of each wheel, km/h", 3.6, tuple(wheel(i, "speed") for i in WHEELS)),
    ("Rise of the surface at the end walls, m", 1.0, ("surface_front", "surface_rear")),
    ("Force of the liquid on the tank, kN", 1e-3, ("liquid_force",)),
)
_PROVENANCE: Final = ("program", "program_version", "created", "python_version", "numpy_version", "numba_version")
_LOCKED_SPEED: Final = 1e-3
_PRESSED: Final = (
    "A least load above the load at rest is no error: from the onset to the stop, resistance and brake press that "
    "wheel down all the time, and its unloading is negative."
)


def write_report(source: str | Path, target: str | Path | None = None) -> Path:
    """Write the report of a history file or of a study's folder; returns its file, default report.html beside them.

    It appears whole or not at all. Raises FileError for a source that cannot be read or is something else.
    """
    from slosh_cli.application.study_report import study_page
    from slosh_cli.application.train_report import train_page
    from slosh_cli.results.hdf5 import is_train_history

    path = Path(source)
    file = Path(target) if target is not None else (path if path.is_dir() else path.parent) / "report.html"
    if file.absolute() == path.absolute():
        raise FileError(f"the report must not replace its own source {path}", where=str(path))
    text = study_page(path) if path.is_dir() else train_page(path) if is_train_history(path) else _run_page(path)
    write_text(text, file)
    return file


def animate(source: str | Path, target: str | Path | None = None) -> Path:
    """Write the replay of a history file as a GIF, or an MP4; returns its file, default animation.gif beside it.

    It appears whole or not at all. Raises FileError for a source that is no run, and for another kind of file.
    """
    from slosh_cli.report.animation import write_animation
    from slosh_cli.results.hdf5 import read_history, read_surface

    path = Path(source)
    file = Path(target) if target is not None else path.with_name("animation.gif")
    history, profile = read_history(path), read_surface(path)
    write_animation(history.name, _run_data(history, _scenario(history), profile, _picked(history)), file)
    return file


def _run_page(path: Path) -> str:
    from slosh_cli.results.hdf5 import read_history, read_surface

    history, profile = read_history(path), read_surface(path)
    rows = _picked(history)
    facts = {
        "title": history.name,
        "verdict": _verdict(history),
        "warnings": [*history.warnings, *([history.reason] if history.reason else [])],
        "rows": history.time.size,
        "surface_words": _surface_words(history, profile),
        "tables": _run_tables(history),
        "scenario": history.scenario_text,
    }
    return page_text(facts, _run_data(history, _scenario(history), profile, rows), {})


def _picked(history: History) -> Integers:
    """The rows shown: at equal steps, with the largest and the least of every curve."""
    even = np.linspace(0, history.time.size - 1, min(history.time.size, _MOST_ROWS)).round().astype(np.int64)
    curves = [history.channels[name] for _, _, names in _CHARTS for name in names]
    extremes = [int(find(values)) for values in curves for find in (np.argmin, np.argmax)]
    return np.unique(np.concatenate([even, np.asarray(extremes, dtype=np.int64)]))


def _verdict(history: History) -> str:
    if history.braking_distance_m is None:
        return f"No braking distance: {history.status}."
    found = f"Stopped after {history.braking_distance_m:.2f} m"
    over = [check.name for check in history.checks if not check.within] if hasattr(history, "checks") else []
    within = "no check is over its limit" if not over else "over its limit: " + "; ".join(over)
    return f"{found} from {history.initial_speed_m_s * 3.6:.4g} km/h; {within}."


def _surface_words(history: History, profile: SurfaceProfile | None) -> str:
    if profile is None:
        return "The surface was recorded at the end walls only and is drawn there alone."
    if not history.has_liquid:
        return "The load is frozen: its surface stays flat."
    assumed = " Their shapes along the tank are assumed: cosines." if profile.standing == "assumed" else ""
    return f"The surface is that of the slosh modes, cut off at the tank's bottom and roof.{assumed}"


def _scenario(history: History) -> Scenario:
    """The scenario of the run, from its text."""
    from slosh_cli.scenario import load_scenario

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scenario.yaml"
        file.write_text(history.scenario_text, encoding="utf-8")
        return load_scenario(file)


def _run_data(history: History, scenario: Scenario, profile: SurfaceProfile | None, rows: Integers) -> dict[str, Any]:
    from slosh_cli.section import liquid_depth, section_of

    tank, wagon, held = scenario.tank, scenario.wagon, history.channels
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
            **{"length": tank.length, "bottom": tank.bottom_height, "height": section_of(tank).height},
            **{"depth": liquid_depth(tank), "pivot_spacing": wagon.pivot_spacing, "wheelbase": wagon.bogie.wheelbase},
            **{"radius": wagon.wheelset.wheel_radius, "baffles": [one.position for one in tank.baffles]},
        },
    }
    if profile is None:
        return data
    along = [np.interp(history.time[rows], profile.time, values) for values in profile.rise.T]
    rise = [[float(f"{value:.4g}") for value in values] for values in np.stack(along, axis=1)]
    return data | {"place": plain_numbers(profile.place), "rise": rise}


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


def _run_tables(history: History) -> list[dict[str, Any]]:
    """Answers, checks, inputs, ledger and provenance."""
    facts, note = history.attributes, "Computed by the model, SI units; lists are wheels 1 to 4."
    if any(least > rest for least, rest in zip(history.min_wheel_load_N, history.static_wheel_load_N, strict=True)):
        note += f" {_PRESSED}"
    checks = json.loads(facts["checks"]) if "checks" in facts else []
    answers = [
        (labelled(one.name, one.meaning), _words(getattr(history, one.name)), one.unit)
        for one in history.table()
        if one.unit and hasattr(history, one.name)
    ]
    ledger = [
        (_said(name, "energy_", "_J"), _words(facts[name]))
        for name in facts
        if name.startswith("energy_") and name.endswith("_J")
    ]
    judged = [
        (
            one["check"],
            _words(one["value"]),
            _words(one["limit"]),
            "within" if one["within"] else "over its limit",
            one.get("standing") or "model",
        )
        for one in checks
    ]
    return [
        page_table("Answers", ("answer", "value", "unit"), answers, note),
        page_table("Checks", ("check", "value", "limit", "verdict", "standing of the limit"), judged),
        inputs_table(history.scenario_text),
        page_table("Energy ledger", ("part", "J"), ledger, "Of the whole wagon at the end of the run."),
        _facts_table("Provenance", facts, _PROVENANCE),
    ]


def _said(name: str, before: str = "", after: str = "") -> str:
    return name.removeprefix(before).removesuffix(after).replace("_", " ")


def _words(value: Any) -> str:
    if value is None:
        return "none"
    if isinstance(value, tuple | list | np.ndarray):
        return ", ".join(_words(one) for one in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _facts_table(title: str, facts: Mapping[str, Any], names: Collection[str]) -> dict[str, Any]:
    return page_table(title, ("name", "value"), [(name, _words(facts[name])) for name in facts if name in names])
