"""The journal of a study: every finished stop, committed at once (sqlite).

A stop that was committed survives a killed process and a power cut: the write-ahead log is flushed to the disk
at every commit (synchronous=FULL; NORMAL would keep the file sound, but lose the latest stops to a power cut).
Every row carries a checksum of its key and its content. A row that does not match it counts as never computed.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, Self

from slosh_cli.results.files import FileError, replacing
from slosh_cli.results.result import Status
from slosh_cli.study.outcome import FinishedStop
from slosh_cli.version import __version__

JOURNAL: Final = "journal.sqlite"
_FORMAT: Final = 2
"""Format 1 had no checksums."""
_WAITING: Final = 5.0
"""Seconds for which a journal that another program holds is waited for."""

_TABLES: Final = (
    "CREATE TABLE session (id INTEGER PRIMARY KEY, started TEXT NOT NULL, program TEXT NOT NULL, sources TEXT NOT NULL,"
    " circumstances TEXT NOT NULL)",
    "CREATE TABLE stop (key TEXT PRIMARY KEY, status TEXT NOT NULL, final INTEGER NOT NULL, seconds REAL NOT NULL,"
    " finished TEXT NOT NULL, session INTEGER NOT NULL REFERENCES session (id), answer TEXT NOT NULL,"
    " checksum TEXT NOT NULL)",
    f"PRAGMA user_version = {_FORMAT}",
)
_ADD: Final = (
    "INSERT INTO stop (key, status, final, seconds, finished, session, answer, checksum)"
    " VALUES (?, ?, ?, ?, ?, ?, ?, ?)"
    " ON CONFLICT (key) DO UPDATE SET status = excluded.status, final = excluded.final, seconds = excluded.seconds,"
    " finished = excluded.finished, session = excluded.session, answer = excluded.answer,"
    " checksum = excluded.checksum"
)


class Journal:
    """The finished stops of a study by key. Belongs to the thread that opened it.

    unsound: keys of the rows that were found not to match their checksum. restored: how often the file was written
    anew, because somebody removed it while it was in use.
    Everything raises FileError where the file cannot be read or written; what was committed before stays.
    """

    def __init__(self, path: Path, *, read_only: bool = False) -> None:
        self.path = path
        self.unsound: set[str] = set()
        self.restored = 0
        self._session = 0
        self._connect(read_only=read_only)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(sqlite3.Error):  # closing tidies the log up; on a full disk it may stay
            self._file.close()

    @staticmethod
    def remove(path: Path) -> None:
        """Remove a journal with its log. Raises FileError."""
        try:
            for name in (path.name, f"{path.name}-wal", f"{path.name}-shm"):
                path.with_name(name).unlink(missing_ok=True)
        except OSError as error:
            raise FileError(f"cannot remove {path}: {error.strerror or error}", str(path)) from error

    def _connect(self, *, read_only: bool) -> None:
        with self._trouble("read"):
            where = f"{self.path.absolute().as_uri()}?mode={'ro' if read_only else 'rwc'}"
            self._file = sqlite3.connect(where, uri=True, isolation_level=None, timeout=_WAITING)
            self._file.text_factory = lambda raw: raw.decode("utf-8", "replace")
            try:
                self._open(read_only=read_only)
            except BaseException:
                self._file.close()
                with suppress(OSError):
                    if not read_only and not self.path.stat().st_size:  # a full disk takes the name alone
                        self.path.unlink()
                raise
        self._identity = self.path.stat()

    def _open(self, *, read_only: bool) -> None:
        (found,) = self._file.execute("PRAGMA user_version").fetchone()
        tables = {name for (name,) in self._file.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
        self._check_format(found, tables)
        if read_only:
            return
        self._file.execute("PRAGMA journal_mode = WAL")
        self._file.execute("PRAGMA synchronous = FULL")
        if not tables:
            with self._commit():
                for statement in _TABLES:
                    self._file.execute(statement)
        (verdict,) = self._file.execute("PRAGMA integrity_check(1)").fetchone()
        if verdict != "ok":
            raise sqlite3.DatabaseError(" ".join(verdict.split()))

    def _check_format(self, found: int, tables: set[str]) -> None:
        """Raise FileError for a database that is no journal of this version."""
        away = "choose another folder with -o"
        other = f"{self.path} is the journal of another version of slosh (format {found})"
        start_over = f"{away}, or start the study over with --fresh"
        if tables and "stop" not in tables:
            text = f"{self.path} is a database of another program (tables {', '.join(sorted(tables)[:3])})"
            start_over = away
        elif found == 1:
            text = f"{other}, whose rows have no checksums"
        elif found != _FORMAT and (found or tables):
            text = f"{other}; this one has format {_FORMAT}"
        else:
            return
        raise FileError(f"{text}; {start_over}", str(self.path))

    def begin_session(self, sources: str) -> None:
        """Note who computes from now on; `sources` tells one build of the solver from another."""
        circumstances = {
            "python": platform.python_version(),
            "numpy": version("numpy"),
            "numba": version("numba"),
            "platform": platform.platform(),
            "machine": platform.node(),
        }
        row = (_now(), f"slosh {__version__}", sources, json.dumps(circumstances))
        with self._commit():
            done = self._file.execute(
                "INSERT INTO session (started, program, sources, circumstances) VALUES (?, ?, ?, ?)", row
            )
        self._session = done.lastrowid or 0

    def note_study(self, study: Mapping[str, Any]) -> None:
        """Note what study the folder holds from now on."""
        with self._commit():
            self._file.execute("CREATE TABLE IF NOT EXISTS study (id INTEGER PRIMARY KEY, axes TEXT NOT NULL)")
            self._file.execute("INSERT OR REPLACE INTO study (id, axes) VALUES (1, ?)", (json.dumps(study),))

    def study(self) -> dict[str, Any] | None:
        """The study that was noted last; None where none was."""
        with self._trouble("read"):
            if not self._file.execute("SELECT 1 FROM sqlite_master WHERE name = 'study'").fetchone():
                return None
            found = self._file.execute("SELECT axes FROM study").fetchone()
            return dict(json.loads(found[0])) if found else None

    def add(self, outcomes: Sequence[FinishedStop]) -> None:
        """Commit finished stops; on return they are on the disk."""
        now = _now()
        rows = [
            (one.key, *content, now, self._session, answer, _checksum(one.key, *content, answer))
            for one in outcomes
            for content, answer in [((one.status, one.final, one.seconds), json.dumps(one.answer))]
        ]
        with self._commit():
            self._file.executemany(_ADD, rows)
        self._put_back()

    def _put_back(self) -> None:
        """Write the journal anew where somebody removed it; what is open can still be read, and nothing is lost.

        Raises FileError where another file has taken its place.
        """
        with self._trouble("write"), suppress(FileNotFoundError):
            if os.path.samestat(self.path.stat(), self._identity):
                return
            raise FileError(
                f"{self.path} was replaced by another file while the study ran; start the same command again",
                str(self.path),
            )
        with self._trouble("write"), replacing(self.path) as temporary:
            with closing(sqlite3.connect(temporary)) as copy:
                self._file.backup(copy)
            self._file.close()
            for log in ("-wal", "-shm"):
                self.path.with_name(f"{self.path.name}{log}").unlink(missing_ok=True)
        self._connect(read_only=False)
        self.restored += 1

    def _sound(self, key: str) -> tuple[bool, str] | None:
        """Whether the stop is finished for good, and its row as text; None where there is none that can be trusted."""
        with self._trouble("read"):
            question = "SELECT status, final, seconds, answer, checksum FROM stop WHERE key = ?"
            found = self._file.execute(question, (key,)).fetchone()
        if found is None:
            return None
        status, final, seconds, answer, checksum = found
        if checksum != _checksum(key, status, final, seconds, answer):
            self.unsound.add(key)
            return None
        return bool(final), answer

    def __contains__(self, key: str) -> bool:
        """Whether the stop is finished for good; one that failed for a passing reason is not."""
        found = self._sound(key)
        return found is not None and found[0]

    def __len__(self) -> int:
        with self._trouble("read"):
            return int(self._file.execute("SELECT count(*) FROM stop").fetchone()[0])

    def answer(self, key: str) -> dict[str, Any] | None:
        """The row of a stop: column to value; None where it has not been run."""
        found = self._sound(key)
        with self._trouble("read"):
            return _answer(found[1]) if found else None

    def mean_seconds(self) -> float | None:
        """What a stop has taken on average, in s of one thread; None before the first."""
        with self._trouble("read"):
            mean = self._file.execute("SELECT avg(seconds) FROM stop WHERE final").fetchone()[0]
        return None if mean is None else float(mean)

    def other_sources(self, sources: str) -> int:
        """How many stops were computed by a solver built from other sources than `sources`."""
        question = "SELECT count(*) FROM stop JOIN session ON session = session.id WHERE sources != ?"
        with self._trouble("read"):
            return int(self._file.execute(question, (sources,)).fetchone()[0])

    @contextmanager
    def _commit(self) -> Iterator[None]:
        with self._trouble("write"):
            self._file.execute("BEGIN IMMEDIATE")
            try:
                yield
                self._file.execute("COMMIT")
            except BaseException:
                with suppress(sqlite3.Error):
                    self._file.execute("ROLLBACK")
                raise

    @contextmanager
    def _trouble(self, verb: str) -> Iterator[None]:
        """The words of sqlite in those of the person whose study it is."""
        try:
            yield
        except (sqlite3.Error, ValueError) as error:
            raise FileError(_told(error, self.path, verb), str(self.path)) from error
        except OSError as error:
            raise FileError(f"cannot {verb} {self.path}: {error.strerror or error}", str(self.path)) from error


def _told(error: sqlite3.Error | ValueError, path: Path, verb: str) -> str:
    """What sqlite met, and what to do about it."""
    kind = getattr(error, "sqlite_errorname", None) or ""
    if kind.startswith(("SQLITE_BUSY", "SQLITE_LOCKED")):
        return f"{path} is locked by another program ({error}); close it there, then start the same command again"
    if kind.startswith(("SQLITE_READONLY", "SQLITE_PERM", "SQLITE_CANTOPEN")):
        return f"cannot {verb} {path}: {error}; make it and its folder writable, or choose another folder with -o"
    if kind == "SQLITE_ERROR" or isinstance(error, ValueError) or error.__class__ is sqlite3.DatabaseError:
        return f"{path} is damaged or no journal of slosh ({error}); --fresh starts the study over"
    kept = "every stop committed before is kept. Make room, then start the same command again"
    full = kind.startswith(("SQLITE_FULL", "SQLITE_IOERR"))
    return f"cannot {verb} {path}: {error}" + (f"; {kept}" if verb == "write" or full else "")


def _checksum(key: str, status: str, final: int, seconds: float, answer: str) -> str:
    """Of a row under its key: one digit that changed is found, and a row that an index calls by another key."""
    return hashlib.sha256(repr((key, status, bool(final), seconds, answer)).encode()).hexdigest()[:16]


def _answer(text: str) -> dict[str, Any]:
    """A row as it was committed, its status by the name it has today."""
    answer = dict(json.loads(text))
    return answer | {"status": str(Status(answer["status"]))}


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
