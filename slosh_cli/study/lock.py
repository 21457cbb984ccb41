"""One process at a time in a study's folder."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Final

from slosh_cli.errors import UsageError
from slosh_cli.results.files import FileError

LOCK: Final = "journal.lock"


class FolderInUse(UsageError):  # noqa: N818  (reads as what is the case)
    """Another process works in the study's folder."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold `folder` for this process while the block runs; the system lets go of it however the process ends.

    Raises FolderInUse, naming the holder, or FileError where no lock can be made.
    """
    path = folder / LOCK
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = path.open("a+", encoding="utf-8")
    except OSError as error:
        raise FileError(f"cannot write {path}: {error.strerror or error}", str(path)) from error
    with file:
        try:
            _take(file)
        except OSError:
            file.seek(0, os.SEEK_SET)
            holder = file.read().strip() or "another process"
            raise FolderInUse(
                f"{holder} is already working on the study in {folder}; wait for it, or choose another folder with -o",
                str(folder),
            ) from None
        _sign(file)
        yield


def _sign(file: IO[str]) -> None:
    """Leave word of who holds the lock; a full disk is no reason to do without."""
    with suppress(OSError):
        file.seek(0)
        file.truncate()
        file.write(f"process {os.getpid()} on {socket.gethostname()}\n")
        file.flush()


if sys.platform == "win32":
    import msvcrt

    _FAR: Final = 1 << 30  # a byte beyond the text: what is locked cannot be read

    def _take(file: IO[str]) -> None:
        file.seek(_FAR)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _take(file: IO[str]) -> None:
        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
