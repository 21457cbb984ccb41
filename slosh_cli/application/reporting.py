"""The report of a run, a train or a study: one HTML page."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from slosh_cli.application.differing import labelled
from slosh_cli.application.input_tables import inputs_table
from slosh_cli.application.replay import replay_data, surface_words
from slosh_cli.report.html import page_table, page_text
from slosh_cli.results.files import FileError, write_text

if TYPE_CHECKING:
    from slosh_cli.results.stored import History

_PROVENANCE: Final = ("program", "program_version", "created", "python_version", "numpy_version", "numba_version")
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


def _run_page(path: Path) -> str:
    from slosh_cli.results.hdf5 import read_history, read_surface

    history, profile = read_history(path), read_surface(path)
    data = replay_data(path, history, profile)  # first of all: it says of a scenario what is wrong with it
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
    facts, note = history.attributes, "Computed by the model, SI units; lists are wheels 1 to 4."
    if any(least > rest for least, rest in zip(history.min_wheel_load_N, history.static_wheel_load_N, strict=True)):
        note += f" {_PRESSED}"
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
            one.name,
            _words(one.value),
            _words(one.limit),
            "within" if one.within else "over its limit",
            one.standing or "model",
        )
        for one in getattr(history, "checks", ())
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
