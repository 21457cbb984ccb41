"""The report of a run, a train or a study: one HTML page."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.application.replay import replay_data, surface_words
from slosh_cli.report.html import page_table, page_text
from slosh_cli.results.files import FileError, write_text

if TYPE_CHECKING:
    from slosh_cli.results.stored import History

_PROVENANCE: Final = ("program", "program_version", "created", "python_version", "numpy_version", "numba_version")
_IN_WORDS: Final = ("warnings", "reason", "name")


def write_report(source: str | Path, target: str | Path | None = None) -> Path:
    """Write the report of a history file or of a study's folder; returns its file, default report.html beside them.

    It appears whole or not at all. Raises FileError for a source that cannot be read or is something else.
    """
    from slosh_cli.application.study_report import study_page
    from slosh_cli.results.hdf5 import is_train_history

    path = Path(source)
    file = Path(target) if target is not None else (path if path.is_dir() else path.parent) / "report.html"
    if file.absolute() == path.absolute():
        raise FileError(f"the report must not replace its own source {path}", where=str(path))
    text = study_page(path) if path.is_dir() else _train_page(path) if is_train_history(path) else _run_page(path)
    write_text(text, file)
    return file


def _run_page(path: Path) -> str:
    from slosh_cli.results.hdf5 import read_history, read_surface

    history, profile = read_history(path), read_surface(path)
    data = replay_data(history, profile)  # first of all: it says of a scenario what is wrong with it
    facts = {
        "title": history.name,
        "verdict": _verdict(history),
        "warnings": [*history.warnings, *([history.reason] if history.reason else [])],
        "rows": history.time.size,
        "surface_words": surface_words(history, profile),
        "tables": _run_tables(history),
        "scenario": history.scenario_text,
    }
    return page_text(facts, data, {})


def _verdict(history: History) -> str:
    if history.braking_distance_m is None:
        return f"No braking distance: {history.status}."
    found = f"Stopped after {history.braking_distance_m:.2f} m"
    over = [check.name for check in history.checks if not check.within] if hasattr(history, "checks") else []
    within = "no check is over its limit" if not over else "over its limit: " + "; ".join(over)
    return f"{found} from {history.initial_speed_m_s * 3.6:.4g} km/h; {within}."


def _run_tables(history: History) -> list[dict[str, Any]]:
    """Answers, checks, inputs, ledger and provenance."""
    facts = history.attributes
    checks = json.loads(facts["checks"]) if "checks" in facts else []
    inputs = list(_inputs(history.scenario_text))
    answers = [
        (one.meaning, _words(getattr(history, one.name)), one.unit)
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
        page_table(
            "Answers", ("answer", "value", "unit"), answers, "Computed by the model, SI units; lists are wheels 1 to 4."
        ),
        page_table("Checks", ("check", "value", "limit", "verdict", "standing of the limit"), judged),
        page_table(
            "Inputs",
            ("key", "value", "standing"),
            inputs,
            "As resolved, with units. Default: the file said nothing of it; else the preset it was taken from.",
        ),
        page_table("Energy ledger", ("part", "J"), ledger, "Of the whole wagon at the end of the run."),
        _facts_table("Provenance", facts, _PROVENANCE),
    ]


def _flat(data: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """Key paths and values of a scenario."""
    if isinstance(data, Mapping | list):
        pairs = data.items() if isinstance(data, Mapping) else enumerate(data, 1)
        for name, value in pairs:
            yield from _flat(value, f"{key}.{name}" if key else str(name))
    else:
        yield key, str(data)


def _inputs(text: str) -> Iterator[tuple[str, str, str]]:
    """Key paths and values of a scenario with what gave them where the file did not: `default`, or a preset."""
    from slosh_cli.scenario.presets import DEFAULT, TAKEN
    from slosh_cli.scenario.yaml_text import parse

    given = dict(parse(text, "the scenario of the run").data)
    taken = given.pop(TAKEN, {})
    for key, value in _flat(given):
        found = (name for path, name in taken.items() if key == path or key.startswith(f"{path}."))
        yield key, value, next((name if name == DEFAULT else f"preset {name}" for name in found), "")


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


def _train_page(path: Path) -> str:
    from slosh_cli.application.plotting import plot
    from slosh_cli.results.hdf5 import read_train

    train = read_train(path)
    tables = [_facts_table("Answers", train.facts, set(train.facts) - {*_PROVENANCE, *_IN_WORDS})]
    for title, found in (("Vehicles", train.vehicles), ("Couplings", train.couplings)):
        names = [name for name in (found[0].facts if found else {}) if name not in ("scenario", "checks")]
        rows = [(number, *(_words(one.facts.get(name)) for name in names)) for number, one in enumerate(found, 1)]
        tables.append(page_table(title, ("number", *names), rows, "From the front, SI units."))
    tables.append(_facts_table("Provenance", train.facts, _PROVENANCE))
    distance = train.facts.get("braking_distance_m", np.nan)
    stopped = f"The first vehicle stopped after {distance:.2f} m." if np.isfinite(distance) else "No braking distance."
    warnings = [*str(train.facts.get("warnings", "")).splitlines(), str(train.facts.get("reason", ""))]
    facts = {"title": train.name, "verdict": stopped, "warnings": [one for one in warnings if one], "tables": tables}
    with tempfile.TemporaryDirectory() as folder:
        drawn = plot(path, folder)
        files = {name: Path(folder) / f"{name}.png" for name in drawn}
        return page_text(facts, {}, files)
