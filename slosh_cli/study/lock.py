"""One process at a time in a study's folder."""

from __future__ import annotations

import errno
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
_TURNS: Final = 100
"""How often the lock is sought anew where its file vanishes; file systems without stable numbers give way at last."""


class FolderInUse(UsageError):  # noqa: N818  (reads as what is the case)
    """Another process works in the study's folder."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold `folder` for this process while the block runs; the system lets go of it however the process ends.

    The lock's file goes with the block; one that a killed process left behind holds nobody up.
    Raises FolderInUse, naming the holder, or FileError where no lock can be made.
    """
    path = folder / LOCK
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = _taken(path)
    except OSError as error:
        raise FileError(f"cannot write {path}: {error.strerror or error}", str(path)) from error
    with file:
        _sign(file)
        try:
            yield
        finally:
            _leave(file, path)


def _taken(path: Path) -> IO[str]:
    """The lock's file at `path`, locked. Raises OSError where it cannot be made, FolderInUse where another has it."""
    for turn in range(_TURNS):
        file = path.open("a+", encoding="utf-8")
        try:
            _take(file)
        except OSError:
            with file:
                file.seek(0, os.SEEK_SET)
                holder = file.read().strip() or "another process"
            raise FolderInUse(
                f"{holder} is already working on the study in {path.parent}; wait for it, or choose another folder "
                "with -o",
                str(path.parent),
            ) from None
        with suppress(OSError):
            if turn == _TURNS - 1 or os.path.samestat(os.fstat(file.fileno()), path.stat()):
                return file
        file.close()  # its holder has just left and taken the name along: what was locked is nobody's any more
    raise OSError(errno.EBUSY, os.strerror(errno.EBUSY))


def is_held(folder: Path) -> bool:
    """Whether another process works in `folder` now."""
    try:
        with (folder / LOCK).open("r+", encoding="utf-8") as file:
            _take(file)
    except FileNotFoundError:
        return False
    except OSError:
        return True
    return False


def _sign(file: IO[str]) -> None:
    """Leave word of who holds the lock; a full disk is no reason to do without."""
    with suppress(OSError):  # past Python's buffer, which would try again, and fail, when the file is closed
        os.ftruncate(file.fileno(), 0)
        os.write(file.fileno(), f"process {os.getpid()} on {socket.gethostname()}\n".encode())


if sys.platform == "win32":
    import msvcrt

    _FAR: Final = 1 << 30  # a byte beyond the text: what is locked cannot be read

    def _take(file: IO[str]) -> None:
        file.seek(_FAR)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

    def _leave(file: IO[str], path: Path) -> None:
        file.close()  # an open file cannot be removed here
        with suppress(OSError):
            path.unlink()

else:
    import fcntl

    def _take(file: IO[str]) -> None:
        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)

    def _leave(file: IO[str], path: Path) -> None:
        del file  # closed, and so unlocked, once the name is gone
        with suppress(OSError):
            path.unlink()
