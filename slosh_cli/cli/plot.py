"""`slosh plot`: the figures of a run, from its history file."""

from pathlib import Path
from typing import Annotated

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.keeping import Keeping
from slosh_cli.cli.output import say


def register(app: typer.Typer) -> None:
    """Add the command to the tree."""
    app.command("plot")(plot)


def plot(
    history_file: Annotated[
        Path, typer.Argument(metavar="FILE.h5", help="History file of a run.", show_default=False)
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="DIR", help="Folder for the figures. Default: that of FILE.h5.",
            show_default=False,
        ),
    ] = None,
) -> ExitCode:  # fmt: skip
    """Draw the figures of a run from its history file.

    Each is written as PNG and as SVG.
    """
    from slosh_cli.report import FIGURE_NAMES, FORMATS
    from slosh_cli.report.figures import draw_run
    from slosh_cli.results.files import try_targets
    from slosh_cli.results.hdf5 import read_history

    history = read_history(history_file)
    folder, keeping = output or history_file.parent, Keeping()
    try_targets(folder, [f"{name}.{suffix}" for name in FIGURE_NAMES for suffix in FORMATS])
    for name in FIGURE_NAMES:
        with keeping.part(f"the figure {folder / name}"):
            for file in draw_run(history, folder, names=(name,)):
                say(str(file))
    return keeping.told()
