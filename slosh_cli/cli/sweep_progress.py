"""What people see while a study is under way, all of it on stderr."""

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self

from slosh_cli.cli.output import note

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

NOTE_SECONDS: Final = 60.0
"""How often a study without a terminal says how far it is, s."""


class StopsProgress:
    """A bar with rate and time left on a terminal, a line now and then elsewhere."""

    def __init__(self, *, noted_every: float = NOTE_SECONDS) -> None:
        self._every = noted_every
        self._began = self._noted = time.monotonic()
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, done: int, total: int) -> None:
        """Show that `done` of `total` stops are finished."""
        now = time.monotonic()
        rate = done / max(now - self._began, 1e-9)
        left = (total - done) / rate if done else None
        if sys.stderr.isatty():
            self._draw(done, total, rate, left)
        elif done and done < total and now - self._noted >= self._every:
            self._noted = now
            note(f"{done} of {total} stops, {rate:.1f} per second, {duration(left)} left")

    def _draw(self, done: int, total: int, rate: float, left: float | None) -> None:
        if self._bar is None:
            self._bar = _bar()
            self._task = self._bar.add_task("stops", total=total, rate="", left="")
            self._bar.start()
        assert self._task is not None
        told: dict[str, Any] = {"rate": f"{rate:.1f}/s", "left": f"{duration(left)} left"} if done else {}
        self._bar.update(self._task, completed=done, **told)


def duration(seconds: float | None) -> str:
    """Seconds as people say them: ``4 s``, ``12 min``, ``3.5 h``."""
    if seconds is None:
        return "an unknown time"
    if seconds < 100.0:
        return f"{max(seconds, 1.0):.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"


def _bar() -> "Progress":
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TextColumn("{task.fields[left]}"),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
    )
