"""The journal of a study: every finished stop, committed at once (sqlite).

A stop that was committed survives a killed process and a power cut: the write-ahead log is flushed to the disk
at every commit (synchronous=FULL; NORMAL would keep the file sound, but lose the latest stops to a power cut).
"""

from __future__ import annotations

import json
import platform
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, Self

from slosh_cli.results.files import FileError
from slosh_cli.results.result import Status
from slosh_cli.study.outcome import FinishedStop
from slosh_cli.version import __version__

JOURNAL: Final = "journal.sqlite"
_FORMAT: Final = 1

_TABLES: Final = (
    "CREATE TABLE session (id INTEGER PRIMARY KEY, started TEXT NOT NULL, program TEXT NOT NULL, sources TEXT NOT NULL,"
    " circumstances TEXT NOT NULL)",
    "CREATE TABLE stop (key TEXT PRIMARY KEY, status TEXT NOT NULL, final INTEGER NOT NULL, seconds REAL NOT NULL,"
    " finished TEXT NOT NULL, session INTEGER NOT NULL REFERENCES session (id), answer TEXT NOT NULL)",
    f"PRAGMA user_version = {_FORMAT}",
)
_ADD: Final = (
    "INSERT INTO stop (key, status, final, seconds, finished, session, answer) VALUES (?, ?, ?, ?, ?, ?, ?)"
    " ON CONFLICT (key) DO UPDATE SET status = excluded.status, final = excluded.final, seconds = excluded.seconds,"
    " finished = excluded.finished, session = excluded.session, answer = excluded.answer"
)


class Journal:
    """The finished stops of a study by key. Belongs to the thread that opened it.

    Everything raises FileError where the file cannot be read or written; what was committed before stays.
    """

    def __init__(self, path: Path, *, read_only: bool = False) -> None:
        self.path = path
        self._session = 0
        with self._trouble("read"):
            where = f"{path.absolute().as_uri()}?mode={'ro' if read_only else 'rwc'}"
            self._file = sqlite3.connect(where, uri=True, isolation_level=None)
            try:
                self._open(read_only=read_only)
            except BaseException:
                self._file.close()
                raise

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

    def _open(self, *, read_only: bool) -> None:
        (found,) = self._file.execute("PRAGMA user_version").fetchone()
        if found not in (0, _FORMAT):
            raise FileError(f"{self.path} is the journal of another version of slosh (format {found})", str(self.path))
        if read_only:
            return
        self._file.execute("PRAGMA journal_mode = WAL")
        self._file.execute("PRAGMA synchronous = FULL")
        if found == 0:
            with self._commit():
                for statement in _TABLES:
                    self._file.execute(statement)

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
            (one.key, one.status, one.final, one.seconds, now, self._session, json.dumps(one.answer))
            for one in outcomes
        ]
        with self._commit():
            self._file.executemany(_ADD, rows)

    def __contains__(self, key: str) -> bool:
        """Whether the stop is finished for good; one that failed for a passing reason is not."""
        with self._trouble("read"):
            found = self._file.execute("SELECT final FROM stop WHERE key = ?", (key,)).fetchone()
        return bool(found and found[0])

    def __len__(self) -> int:
        with self._trouble("read"):
            return int(self._file.execute("SELECT count(*) FROM stop").fetchone()[0])

    def answer(self, key: str) -> dict[str, Any] | None:
        """The row of a stop: column to value; None where it has not been run."""
        with self._trouble("read"):
            found = self._file.execute("SELECT answer FROM stop WHERE key = ?", (key,)).fetchone()
            return _answer(found[0]) if found else None

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
            text = f"cannot {verb} {self.path}: {error}"
            if isinstance(error, ValueError) or error.__class__ is sqlite3.DatabaseError:
                text = f"{self.path} is damaged or no journal of slosh ({error}); --fresh starts the study over"
            elif verb == "write":
                text += "; every stop committed before is kept. Make room, then start the same command again"
            raise FileError(text, str(self.path)) from error


def _answer(text: str) -> dict[str, Any]:
    """A row as it was committed, its status by the name it has today."""
    answer = dict(json.loads(text))
    return answer | {"status": str(Status(answer["status"]))}


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
