"""How figures are written: this program's style, laid out once, PNG and SVG."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Final, cast

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.text import Text

from slosh_cli.report import FORMATS
from slosh_cli.results.files import FileError, replacing

INK: Final = "#222222"
MUTED: Final = "#777777"

STYLE: Final[dict[Any, Any]] = {
    "font.size": 13,
    "axes.labelsize": 13,
    "axes.edgecolor": MUTED,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.8,
    "legend.frameon": False,
    "legend.fontsize": 11.5,
    "legend.handlelength": 2.5,
    "lines.linewidth": 1.6,
    "svg.fonttype": "none",
    "svg.hashsalt": "slosh",
}


def styled() -> AbstractContextManager[None]:
    """This program's style, whatever the user's matplotlib settings are, for the length of the block."""
    return mpl.rc_context({**mpl.rcParamsDefault, **STYLE})


def save(figure: Figure, folder: Path, name: str, formats: Sequence[str] = FORMATS) -> list[Path]:
    """Write a figure into `folder`, a file per format; returns the files. Each appears whole or not at all.

    The layout, a third of the work, is done once; `Figure.savefig` would do it for every format.
    Raises FileError when a file cannot be written, once the others are.
    """
    _take_words_as_they_are(figure)
    # matplotlib's writers have no types
    png: Any = figure.canvas if isinstance(figure.canvas, FigureCanvasAgg) else FigureCanvasAgg(figure)
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    files = [folder / f"{name}.{suffix}" for suffix in formats]
    refusal: FileError | None = None
    for file, suffix in zip(files, formats, strict=True):
        try:
            with replacing(file) as temporary:
                if suffix == "svg":
                    svg: Any = FigureCanvasSVG(figure)
                    svg.print_svg(temporary, metadata={"Date": None})
                else:
                    png.print_png(temporary)
        except FileError as error:
            refusal = refusal or error
    if refusal is not None:
        raise refusal
    return files


def _take_words_as_they_are(figure: Figure) -> None:
    """No word of a figure is a formula: names of wagons and files may hold any sign. Numbers at axes may be powers."""
    ticks = [
        tick for one in figure.axes for axis in (one.xaxis, one.yaxis) for tick in (*axis.majorTicks, *axis.minorTicks)
    ]
    numbers = {id(label) for tick in ticks for label in (tick.label1, tick.label2)}
    for text in cast("list[Text]", figure.findobj(Text)):
        if id(text) not in numbers:
            text.set_parse_math(False)
