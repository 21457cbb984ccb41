"""The program held against what it did not compute: cases chosen, run, and kept as a report with figures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

from slosh_cli.application.keeping import Keeping, by_kind, default_folder
from slosh_cli.application.plotting import case_figures, writers
from slosh_cli.report import FORMATS
from slosh_cli.results.files import try_targets
from slosh_cli.validation import registry
from slosh_cli.validation.case import CaseResult
from slosh_cli.validation.data_file import CaseData

_REPORT: Final = "report.md"
_LONGEST: Final = 80
"""Characters of a folder's name that names the cases."""


def validate(
    names: Sequence[str] = (), progress: Callable[[int, int, str], None] = lambda *_: None
) -> tuple[CaseResult, ...]:
    """Run the named cases, or all that can run here; `progress` is told done, total and the case in hand.

    A case that falls short, or breaks down, is a result: see its `passed` and `rows`. Raises UsageError for an unknown
    name, and for one that needs an extra that is not installed.
    """
    cases, results = registry.chosen(names), []
    for done, data in enumerate(cases):
        progress(done, len(cases), data.name)
        results.append(registry.case_result(data))
    return tuple(results)


def validation_folder(cases: Sequence[CaseData], given: Path | None, *, part: bool) -> Path:
    """The folder of a report: that `given`, else one where a `part` of the cases does not replace the report of all.

    Raises FileError where it cannot take the files.
    """
    folder = given or default_folder("validation")
    if part and given is None:
        told = "+".join(data.name for data in cases)
        short = f"{len(cases)}-cases-{sha256(told.encode()).hexdigest()[:8]}"
        folder /= told if len(told) <= _LONGEST else short
    try_targets(folder, _files(cases))
    return folder


def _files(cases: Sequence[CaseData]) -> list[str]:
    return [_REPORT, *(f"{data.name}.{suffix}" for data in cases for suffix in FORMATS)]


def keep_validation(
    results: Sequence[CaseResult], missing: Sequence[CaseData], folder: Path, keeping: Keeping
) -> dict[str, Any]:
    """Write the report into `folder`, then a figure per case; returns where those lie that could be written."""
    from slosh_cli.results.files import write_text
    from slosh_cli.validation.markdown import report
    from slosh_cli.version import __version__

    text = report(results, missing, f"slosh {__version__}: validation")
    drawn = {name: write for result in results for name, write in writers(case_figures(result)).items()}
    owned = _files([result.data for result in results])
    return by_kind(keeping.keep(folder, owned, {_REPORT: partial(write_text, text)}, drawn), report=_REPORT)
