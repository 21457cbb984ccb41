"""One stop of a train: its simulation, its files."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.application.keeping import Keeping, by_kind
from slosh_cli.report import FORMATS, TRAIN_FIGURES

if TYPE_CHECKING:
    from slosh_cli.results.train_result import TrainResult
    from slosh_cli.scenario.train_file import TrainScenario
    from slosh_cli.solver.run import Cancel, Progress

_HISTORY: Final = "run.h5"
_SUMMARY: Final = "summary.csv"
_VEHICLES: Final = "vehicles.csv"
_COUPLINGS: Final = "couplings.csv"
TRAIN_FILES: Final = (
    _HISTORY,
    _SUMMARY,
    _VEHICLES,
    _COUPLINGS,
    *(f"{name}.{suffix}" for name in TRAIN_FIGURES for suffix in FORMATS),
)
"""Every file that a train's run may write, its history first."""


def simulate_train(
    train: TrainScenario | str | Path, *, progress: Progress | None = None, cancel: Cancel | None = None
) -> TrainResult:
    """Integrate one stop of a train, or of its file; arguments and errors are those of `simulate`."""
    from slosh_cli.results.simulate import simulate_train as integrated
    from slosh_cli.scenario.train_file import load_train

    return integrated(load_train(train) if isinstance(train, str | Path) else train, progress=progress, cancel=cancel)


def keep_train(result: TrainResult, folder: Path, keeping: Keeping, *, figures: bool = True) -> dict[str, Any]:
    """Write history and tables of a train's run into `folder`, then its figures; returns where those lie that could be.

    What an earlier run left in `folder` goes.
    """
    from slosh_cli.results.answers import Shown
    from slosh_cli.results.hdf5 import write_train
    from slosh_cli.results.tables import write_table

    def draw(name: str, folder: Path) -> None:
        from slosh_cli.report.train_figures import draw_train

        draw_train(result.history, folder, names=(name,))

    def rows(parts: Any, kind: str) -> list[dict[str, Any]]:
        return [{kind: number} | part.row(Shown.SUMMARY) for number, part in enumerate(parts, 1)]

    numbers = {
        _SUMMARY: partial(write_table, [result.row(Shown.SUMMARY)]),
        _VEHICLES: partial(write_table, rows(result.vehicles, "vehicle")),
        _HISTORY: partial(write_train, result),
    }
    if result.couplings:
        numbers[_COUPLINGS] = partial(write_table, rows(result.couplings, "coupling"))
    drawn = {name: partial(draw, name) for name in TRAIN_FIGURES if figures}
    kept = keeping.keep(folder, TRAIN_FILES, numbers, drawn)
    kinds = {"history": _HISTORY, "summary": _SUMMARY, "vehicles": _VEHICLES, "couplings": _COUPLINGS}
    return by_kind(kept, **kinds)
