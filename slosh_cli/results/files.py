"""Files that appear whole or not at all."""

import os
import secrets
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from slosh_cli.errors import SloshError


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
        try:
            yield temporary
            _to_disk(temporary)
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
        _to_disk(path.parent)


@contextmanager
def staging(folder: Path, owned: Collection[str] = ()) -> Iterator[Path]:
    """Yield an empty folder inside `folder`; when the block ends well its files move up together.

    Files named in `owned` that the block did not write are removed then, so that `folder` never holds
    a mixture of two runs. When the block fails, `folder` keeps what it had.
    Raises FileError when the operating system refuses.
    """
    with _refusals(folder):
        folder.mkdir(parents=True, exist_ok=True)
        stage = folder / f".{secrets.token_hex(4)}.part"
        stage.mkdir()
        try:
            yield stage
            written = sorted(stage.iterdir())
            for file in written:
                _to_disk(file)
            for file in written:
                file.replace(folder / file.name)
            for name in set(owned) - {file.name for file in written}:
                (folder / name).unlink(missing_ok=True)
        finally:
            shutil.rmtree(stage, ignore_errors=True)
        _to_disk(folder)


@contextmanager
def _refusals(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise FileError(f"cannot write {path}: {error.strerror or error}", where=str(path)) from error


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
