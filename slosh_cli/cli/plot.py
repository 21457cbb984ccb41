"""`slosh plot`: the figures of a run, from its history file."""

from pathlib import Path
from typing import Annotated, Any

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import option
from slosh_cli.cli.output import say


def plot_command(
    history_file: Annotated[Path, typer.Argument(metavar="FILE.h5", help="History file of a run.", show_default=False)],
    output: Annotated[
        Path | None, option("--output -o", "DIR", "Folder for the figures. Default: that of FILE.h5.")
    ] = None,
) -> ExitCode:
    """Draw the figures of a run from its history file.

    Each is written as PNG and as SVG.
    """
    from slosh_cli.application.keeping import Keeping
    from slosh_cli.application.stop import FIGURE_FILES
    from slosh_cli.application.train import TRAIN_FILES
    from slosh_cli.cli.keeping import told
    from slosh_cli.report import FIGURE_NAMES, TRAIN_FIGURES
    from slosh_cli.report.figures import draw_run
    from slosh_cli.report.train_figures import draw_train
    from slosh_cli.results.files import try_targets
    from slosh_cli.results.hdf5 import is_train_history, read_history, read_train

    of_train = is_train_history(history_file)
    history: Any = (read_train if of_train else read_history)(history_file)
    draw: Any = draw_train if of_train else draw_run
    folder, keeping = output or history_file.parent, Keeping()
    try_targets(folder, TRAIN_FILES if of_train else FIGURE_FILES)
    for name in TRAIN_FIGURES if of_train else FIGURE_NAMES:
        with keeping.part(f"the figure {folder / name}"):
            for file in draw(history, folder, names=(name,)):
                say(str(file))
    return told(keeping)
