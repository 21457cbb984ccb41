"""Where compiled kernels are kept: in a folder of this build of the program and of this user, or nowhere.

Kept kernels are machine code, wrapped in pickles: whoever can write them can run anything, and one that belongs to
other sources gives a wrong number that looks right. So there is one folder per digest of all that a kernel is made
from, it and every file in it must belong to the user (or to root) and be closed to writing by others, and every file
carries the checksum of its content and the signature it is for. Where no such folder can be had nothing is kept.
"""

from __future__ import annotations

import hashlib
import inspect
import os
import pickle
import re
import secrets
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, Final

PARTS: Final = ("tank", "wagon", "track", "train", "solver")
"""Packages with kernels, and with the constants and types that kernels use."""
_MODULES: Final = ("compiled", "kernel_store", "arrays", "blocks", "friction", "method", "vectors")
"""Modules beside them that decide about machine code."""

_OWN: Final = re.compile(r"[0-9a-f]{16}(-\d+)?")
_UNUSED_DAYS: Final = 60.0
_CHECKSUM: Final = hashlib.sha256().digest_size


def source_files(root: Path) -> list[Path]:
    """Every file that a kernel of the package at `root` can be made from."""
    own = [root / f"{name}.py" for name in _MODULES]
    return own + [file for part in PARTS for file in sorted((root / part).rglob("*.py"))]


def digest(files: Iterable[Path], root: Path, *others: object) -> str:
    """16 hexadecimal digits that change with the content of any of the files, and with `others`.

    Raises OSError where a file cannot be read.
    """
    found = hashlib.sha256(repr(others).encode())
    for file in files:
        content = file.read_bytes()
        found.update(f"{file.relative_to(root).as_posix()} {len(content)}\n".encode())
        found.update(content)
    return found.hexdigest()[:16]


@cache
def known_as(cls: type) -> str:
    """The name of a class, by which kernels that were made for it are known.

    The build tells the program's own classes. Of another class its source goes into the name, so that no kernel is used
    again that was made for other fields or other code.
    """
    name = f"{cls.__module__}.{cls.__qualname__}"
    if cls.__module__.partition(".")[0] == __name__.partition(".")[0]:
        return name
    try:
        source = Path(inspect.getfile(cls)).read_bytes()
    except (OSError, TypeError):  # typed in, or made up: nobody knows whether it is the same again
        source = secrets.token_bytes()
    return f"{name}@{hashlib.sha256(source).hexdigest()[:16]}"


class KernelStore:
    """The kernels kept under the name `build`, which is empty where nobody knows what the build is made of.

    folder: where they lie; None where no place can be trusted. trouble: why new ones cannot be kept, else empty.
    """

    def __init__(self, build: str) -> None:
        self.folder: Path | None = None
        self.trouble = ""
        if not build:
            self.trouble = "the program's own sources cannot be read"
            return
        try:
            home = _cache_home()
        except RuntimeError:
            self.trouble = "there is no home folder"
            return
        names = [build, *([f"{build}-{os.geteuid()}"] if os.name == "posix" else [])]
        troubles = []
        for place in (home / name for name in names):
            troubles.append(_claimed(place))
            if not troubles[-1] or (self.folder is None and _trusted_folder(place)):
                self.folder = place
            if not troubles[-1]:
                return
        self.trouble = troubles[0]

    def holds(self, name: str, chosen: str = "") -> bool:
        """Whether a kernel MODULE.FUNCTION of that name was kept, made for the classes `chosen`."""
        made_for = f"-{chosen}" if chosen else ""
        return self.folder is not None and any(self.folder.glob(f"*.{name}-*[0-9]{made_for}.*.nbc"))

    def load(self, name: str, key: object) -> Any:
        """What was kept for the function `name` and the signature `key`; None where there is nothing sound."""
        if self.folder is None:
            return None
        try:
            with (self.folder / _file_name(name, key)).open("rb") as file:
                if not _trusted(os.fstat(file.fileno())):
                    return None
                content = file.read()
            if hashlib.sha256(content[_CHECKSUM:]).digest() != content[:_CHECKSUM]:
                return None
            kept_key, value = pickle.loads(content[_CHECKSUM:])
        except Exception:  # a pickle of another world can fail in any way; what cannot be read is compiled
            return None
        return value if kept_key == key else None

    def save(self, name: str, key: object, value: object, dumps: Callable[[object], bytes]) -> None:
        """Keep `value`, whole or not at all; a disk that refuses is noted in `trouble`."""
        if self.folder is None:
            return
        content = dumps((key, value))
        file = self.folder / _file_name(name, key)
        temporary = file.with_name(f".{secrets.token_hex(8)}.part")
        try:
            descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o644)
            try:
                with open(descriptor, "wb") as new:
                    new.write(hashlib.sha256(content).digest() + content)
                temporary.replace(file)
            finally:
                temporary.unlink(missing_ok=True)
        except OSError as error:
            self.trouble = f"cannot write into {self.folder}: {error.strerror or error}"


def _cache_home() -> Path:
    """The folder of the builds' folders. Raises RuntimeError where nobody knows the user's home."""
    if os.environ.get("NUMBA_CACHE_DIR"):
        return Path(os.environ["NUMBA_CACHE_DIR"]).absolute()
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home()) / "slosh" / "kernels"
    stated = Path(os.environ.get("XDG_CACHE_HOME", ""))
    return (stated if stated.is_absolute() else Path.home() / ".cache") / "slosh" / "kernels"


def _claimed(folder: Path) -> str:
    """Make or take `folder`; returns why nothing can be kept there, else an empty text."""
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        try:
            folder.mkdir(mode=0o755)
        except FileExistsError:
            pass
        else:
            _tidy(folder)
        if not _trusted_folder(folder):
            return f"{folder} can be written by others"
        tempfile.TemporaryFile(dir=folder).close()
        if time.time() - folder.stat().st_mtime > 86400.0:
            os.utime(folder)
    except OSError as error:
        return f"cannot write into {folder}: {error.strerror or error}"
    return ""


def _trusted_folder(folder: Path) -> bool:
    """Whether it is a folder, not a link to one, that only this user (or root) can write."""
    try:
        state = folder.lstat()
    except OSError:
        return False
    return folder.is_dir() and not folder.is_symlink() and _trusted(state)


def _trusted(state: os.stat_result) -> bool:
    """Whether only this user (or root) can have written it; Windows guards the profile of a user by itself."""
    if os.name != "posix":
        return True
    return state.st_uid in (os.geteuid(), 0) and not state.st_mode & 0o022


def _tidy(folder: Path) -> None:
    """Remove the folders of other builds that nobody has used for long, from the program's own place only."""
    if folder.parent.parts[-2:] != ("slosh", "kernels"):
        return
    for other in folder.parent.iterdir():
        with suppress(OSError):
            unused = time.time() - other.lstat().st_mtime > _UNUSED_DAYS * 86400.0
            if other != folder and _OWN.fullmatch(other.name) and unused and _trusted_folder(other):
                shutil.rmtree(other, ignore_errors=True)


def _file_name(name: str, key: object) -> str:
    return f"{name}.{hashlib.sha256(repr(key).encode()).hexdigest()[:24]}.nbc"
