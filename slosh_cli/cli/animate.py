"""`slosh animate`: the replay of a run or of an excited tank as a GIF."""

from pathlib import Path
from typing import Annotated

import typer

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.options import option
from slosh_cli.cli.output import say


def animate_command(
    history_file: Annotated[
        Path, typer.Argument(metavar="FILE.h5", help="History of a run, or of `tank excite`.", show_default=False)
    ],
    output: Annotated[
        Path | None,
        option("--output -o", "FILE", "A .gif, or an .mp4 where ffmpeg is. Default: animation.gif beside FILE.h5."),
    ] = None,
) -> ExitCode:
    """Replay a run, or an excited tank, as a GIF or MP4."""
    from slosh_cli.application.replay import animate

    say(str(animate(history_file, output)))
    return ExitCode.DONE
