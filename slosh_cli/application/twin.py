"""The solid twin that an earlier run left in its folder: it must not lie beside a run that it is no twin of."""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path
from typing import Final

TWIN_FOLDER: Final = "solid"
"""Where the run of the equivalent solid lies, in the folder of the run itself."""
_LIQUID: Final = re.compile(r"^(  liquid:\n    model: )[a-z-]+$", re.MULTILINE)


class EarlierTwin:
    """What lies in the twin's folder before a run replaces the one in `folder`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / TWIN_FOLDER
        twin = _text(self.folder / "run.h5")
        run = _text(folder / "run.h5")
        self.is_there = twin is not None
        self.is_own = twin is not None and run is not None and _LIQUID.sub(r"\1rigid", run) == twin

    def drop(self) -> str:
        """Take the twin of the run that was replaced away; words where what lies there is not known to be one."""
        from slosh_cli.application.stop import RUN_FILES
        from slosh_cli.application.train import TRAIN_FILES

        if self.is_there and not self.is_own:
            return f"{self.folder} holds a run that is not known to be the solid twin of this one; it is left as it was"
        with suppress(OSError):  # what cannot be taken away is told by its file
            for name in {*RUN_FILES, *TRAIN_FILES} if self.is_own else ():
                (self.folder / name).unlink(missing_ok=True)
            if self.is_own:
                self.folder.rmdir()
        return f"{self.folder} holds files of an earlier twin" if self.is_own and self.folder.exists() else ""


def _text(file: Path) -> str | None:
    """The scenario of a run without its words; None where there is no run."""
    from slosh_cli.results.hdf5 import inputs_of

    return inputs_of(file) if file.exists() else None
