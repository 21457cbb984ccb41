"""Files that appear whole or not at all."""

import errno
import io
import json
import os
import re
import secrets
import shutil
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO, Final

from slosh_cli.errors import SloshError

_PART: Final = re.compile(r"\..*[0-9a-f]{8}\.part")
_WHOLE: Final = re.compile(r"\.[0-9a-f]{8}\.whole")
_NAMES: Final = ".names"
"""File in a stage that says what moves up and what goes for it."""
_FULL: Final = (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC))
_CLOSED: Final = (errno.EROFS, errno.EACCES, errno.EPERM)
_ABANDONED: Final = 86400.0
"""Seconds after which an unfinished part belongs to a process that was killed."""

_unfinished: Final[set[Path]] = set()
"""Files and folders of this process that nobody may take for whole."""


class FileError(SloshError):
    """A file that cannot be written, or read for what it should be; `where` is its path."""

    code = "file"


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary name beside `path`; what is written there replaces `path` when the block ends well.

    The data reaches the disk before the rename. When the block fails, whatever was at `path` stays as it was.
    Folders on the way to `path` are made.
    Raises FileError when the operating system refuses.
    """
    with _refusals(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
        _unfinished.add(temporary)
        try:
            yield temporary
            _to_disk(temporary)
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
            _unfinished.discard(temporary)
        _to_disk(path.parent)


@contextmanager
def staging(folder: Path, owned: Collection[str] = ()) -> Iterator[Path]:
    """Yield an empty folder inside `folder`; when the block ends well its files move up together.

    Files named in `owned` are removed first, so that `folder` never holds a mixture of two runs. When the block fails,
    `folder` keeps what it had. Where the process ends while the files move, whoever looks into `folder` next moves the
    rest: it holds the old files or the new ones, whenever that happens.
    Raises FileError when the operating system refuses.
    """
    with _refusals(folder):
        folder.mkdir(parents=True, exist_ok=True)
        finish_moves(folder)
        stage = folder / f".{secrets.token_hex(4)}.part"
        _unfinished.add(stage)
        stage.mkdir()
        try:
            yield stage
            written = sorted(stage.iterdir())
            for file in written:
                _to_disk(file)
            names = [file.name for file in written]
            _check_no_folders(folder, names)
            (stage / _NAMES).write_text(json.dumps({"new": names, "owned": sorted(owned)}), encoding="utf-8")
            _to_disk(stage / _NAMES)
            _to_disk(stage)
            _move_up(stage.rename(stage.with_suffix(".whole")))
        finally:
            shutil.rmtree(stage, ignore_errors=True)
            _unfinished.discard(stage)


def finish_moves(folder: Path) -> None:
    """Bring up the files of an answer that was whole when its process ended. What cannot be moved stays."""
    with suppress(OSError, ValueError, KeyError):
        for stage in folder.iterdir():
            if _WHOLE.fullmatch(stage.name) and stage.is_dir() and not stage.is_symlink():
                _move_up(stage)


def _move_up(stage: Path) -> None:
    """Replace the files of the folder around `stage` by those in it, once more where that was begun before."""
    folder, told = stage.parent, json.loads((stage / _NAMES).read_text(encoding="utf-8"))
    names = [Path(name).name for name in told["new"]]
    for name in (Path(name).name for name in told["owned"]):
        if name not in names or (stage / name).exists():
            (folder / name).unlink(missing_ok=True)
    for name in names:
        with suppress(FileNotFoundError):  # it has moved already
            (stage / name).replace(folder / name)
    _to_disk(folder)
    shutil.rmtree(stage, ignore_errors=True)


def remove_unfinished() -> None:
    """Take away what this process has not finished: it is about to end, whatever it is doing."""
    for path in tuple(_unfinished):
        with suppress(OSError):
            shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)


def write_text(text: str, path: Path) -> None:
    """Write a text (UTF-8) to `path`, which is replaced only when it is whole. Raises FileError."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def try_targets(folder: Path, names: Collection[str]) -> None:
    """Refuse what cannot be written before the work that it is for: `names` in `folder`.

    A file is made there and taken away again, with the folders that had to be made for it. Parts of files that
    processes left which were killed are removed. Raises FileError.
    """
    with _refusals(folder):
        missing = [place for place in (folder, *folder.absolute().parents) if not place.exists()]
        for place in (folder, *folder.absolute().parents):
            if place.is_symlink() and not place.exists():
                raise FileError(f"cannot write into {folder}: {place} is a link that leads nowhere", str(folder))
            if place.exists() and not place.is_dir():
                raise FileError(f"cannot write into {folder}: {place} is not a folder", str(folder))
        try:
            folder.mkdir(parents=True, exist_ok=True)
            probe = folder / f".{max(names, key=len)}.{secrets.token_hex(4)}.part"
            probe.touch(exist_ok=False)
            probe.unlink()
            _check_no_folders(folder, names)
            _remove_abandoned(folder)
            finish_moves(folder)
        finally:
            for place in missing:
                with suppress(OSError):
                    place.rmdir()


def _check_no_folders(folder: Path, names: Collection[str]) -> None:
    for target in (folder / name for name in names):
        if target.is_dir() and not target.is_symlink():
            raise FileError(f"cannot write {target}: there is a folder of that name", str(target))


def _remove_abandoned(folder: Path) -> None:
    for part in folder.iterdir():
        with suppress(OSError):
            if _PART.fullmatch(part.name) and time.time() - part.lstat().st_mtime > _ABANDONED:
                shutil.rmtree(part) if part.is_dir() and not part.is_symlink() else part.unlink()


def words_of(error: OSError) -> str:
    """Why the system refused, and what to do about it where that is known."""
    words = error.strerror or str(error)
    if error.errno in _FULL:
        limit = " (the limit is `ulimit -f`)" if error.errno == errno.EFBIG else ""
        return f"{words}{limit}; make room, or choose another place with -o"
    return f"{words}; choose another place with -o" if error.errno in _CLOSED else words


@contextmanager
def _refusals(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise FileError(f"cannot write {path}: {words_of(error)}", where=str(path)) from error


def _to_disk(path: Path) -> None:
    """Flush a file, or the names in a folder, to the disk; file systems that cannot do it are left alone."""
    is_folder = path.is_dir()
    if is_folder and os.name == "nt":
        return
    descriptor = os.open(path, os.O_RDONLY if is_folder else os.O_RDWR)
    try:
        if is_folder:
            with suppress(OSError):
                os.fsync(descriptor)
        else:
            os.fsync(descriptor)
    finally:
        os.close(descriptor)


class SteadyFile(io.RawIOBase):
    """A binary file that takes everything it is given; `trouble` is why the disk did not, None where it did."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._place = self._end = 0
        self.trouble: OSError | KeyboardInterrupt | None = None

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._place = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._place, os.SEEK_END: self._end}[whence]
        return self._place

    def tell(self) -> int:
        return self._place

    def write(self, data: Any) -> int:
        count = memoryview(data).nbytes
        self._try(lambda: self._file.write(data))
        self._place += count
        self._end = max(self._end, self._place)
        return count

    def readinto(self, buffer: Any) -> int:
        view = memoryview(buffer).cast("B")
        view[:] = bytes(len(view))
        self._try(lambda: self._file.readinto(view))  # type: ignore[attr-defined]
        self._place += len(view)
        return len(view)

    def truncate(self, size: int | None = None) -> int:
        self._end = self._place if size is None else size
        self._try(lambda: self._file.truncate(self._end))
        return self._end

    def flush(self) -> None:
        if not self.closed:
            self._try(self._file.flush)

    def _try(self, action: Callable[[], object]) -> None:
        """Carry `action` out at the present place, unless the disk has refused before."""
        if self.trouble is not None:
            return
        try:
            self._file.seek(self._place)
            action()
        except (OSError, KeyboardInterrupt) as error:  # neither may pass through HDF5
            self.trouble = error
