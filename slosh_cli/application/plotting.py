"""The figures of everything that has an answer: one way to draw and to write them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from slosh_cli.report import FIGURE_NAMES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from slosh_cli.results.result import Record
    from slosh_cli.results.train_result import TrainHistory, TrainResult
    from slosh_cli.validation.case import CaseResult

    Figures = dict[str, Callable[[], Figure]]
    """Name of a figure, and of its files -> what draws it."""


@runtime_checkable
class Drawable(Protocol):
    """A result that has figures."""

    def figures(self) -> Figures:
        """What draws each figure, by name; nothing is drawn, nor imported for it, before that is called."""
        ...


def plot(
    source: Drawable | Record | TrainResult | CaseResult | str | Path, folder: str | Path | None = None
) -> dict[str, Figure]:
    """The figures of a result, or of the history file of a run, by name; also as NAME.png and NAME.svg in `folder`.

    Raises FileError for a file that cannot be read or written.
    """
    from slosh_cli.report.saving import save, styled

    drawn = {}
    with styled():
        for name, draw in _figures_of(source).items():
            drawn[name] = draw()
            if folder is not None:
                save(drawn[name], Path(folder), name)
    return drawn


def _figures_of(source: Drawable | Record | TrainResult | CaseResult | str | Path) -> Figures:
    from slosh_cli.results.train_result import TrainResult
    from slosh_cli.validation.case import CaseResult

    if isinstance(source, CaseResult):
        return case_figures(source)
    if isinstance(source, TrainResult):
        return _train_figures(source.history)
    if isinstance(source, str | Path):
        from slosh_cli.results.hdf5 import is_train_history, read_history, read_train

        path = Path(source)
        return _train_figures(read_train(path)) if is_train_history(path) else _run_figures(read_history(path))
    return source.figures() if isinstance(source, Drawable) else _run_figures(source)


def _train_figures(train: TrainHistory) -> Figures:
    from slosh_cli.report.train_figures import train_figures

    return train_figures(train)


def _run_figures(record: Record) -> Figures:
    def draw(name: str) -> Figure:
        from slosh_cli.report.figures import FIGURES

        return FIGURES[name](record)

    return {name: partial(draw, name) for name in FIGURE_NAMES if record.has_figure(name)}


def case_figures(result: CaseResult) -> Figures:
    """The figure of a validation case; none where it broke down."""

    def draw() -> Figure:
        from slosh_cli.report.validation_figures import case_figure

        assert result.chart is not None
        return case_figure(result.data.title, result.chart)

    return {} if result.chart is None else {result.name: draw}


def writers(figures: Figures) -> dict[str, Callable[[Path], object]]:
    """Name of a figure -> what draws it and writes it into a folder."""

    def write(name: str, draw: Callable[[], Figure], folder: Path) -> list[Path]:
        from slosh_cli.report.saving import save, styled

        with styled():
            return save(draw(), folder, name)

    return {name: partial(write, name, draw) for name, draw in figures.items()}
