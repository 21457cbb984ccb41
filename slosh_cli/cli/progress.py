"""What people see while a run is under way, all of it on stderr."""

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self

from slosh_cli.cli.output import note

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

_PATIENCE: Final = 2.0
"""Seconds before a bar appears: a shorter run needs none."""

_COMPILE_SECONDS: Final = 40
"""What compiling the time loop for a kind of liquid takes on an ordinary machine, in s."""

_NOTE_SECONDS: Final = 60.0
"""How often a study or a run without a terminal says how far it is, s."""


def announce_solver(models: Iterable[str]) -> None:
    """Say that this run takes longer where the solver was not compiled before for these models of the liquid."""
    from slosh_cli.compiled import solver_is_cached

    missing = [model for model in models if not solver_is_cached(model)]
    if missing:
        _announce("the solver", len(missing) * _COMPILE_SECONDS)


def announce_kernel(what: str, seconds: int, kernel: str) -> None:
    """Say that this run takes longer where `kernel` was not compiled before."""
    from slosh_cli.compiled import is_cached

    if not is_cached(kernel):
        _announce(what, seconds)


def _announce(what: str, seconds: int) -> None:
    """Say what is compiled, how long it takes, and whether it is once."""
    from slosh_cli.compiled import not_kept

    trouble = not_kept()
    if not trouble:
        note(f"Compiling {what}, once: about {seconds} s. Later runs start at once.")
    else:
        note(
            f"Compiling {what} in memory, for this run only: about {seconds} s. It cannot be kept: {trouble}. Set "
            "XDG_CACHE_HOME or NUMBA_CACHE_DIR to a folder of yours, and later runs start at once."
        )


class _Bar:
    """A bar that appears on stderr when it is first drawn, and goes when the block ends."""

    def __init__(self, description: str, *fields: str, counted: bool = True) -> None:
        self._description = description
        self._fields = fields
        self._counted = counted
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def count(self, done: int, total: int, description: str | None = None) -> None:
        """Show that `done` of `total` are finished, and what is in hand."""
        self._draw(done, total, description=description or self._description)

    def _draw(self, completed: float, total: float, **told: str) -> None:
        if self._bar is None:
            self._bar = _rich_bar(*self._fields, counted=self._counted)
            empty: dict[str, Any] = dict.fromkeys(self._fields, "")
            self._task = self._bar.add_task(self._description, total=total, **empty)
            self._bar.start()
        assert self._task is not None
        fields: dict[str, Any] = told
        self._bar.update(self._task, completed=completed, **fields)


class RunProgress(_Bar):
    """A bar for a run that takes longer than two seconds; a line a minute when stderr is no terminal.

    After a minute the `reason`, why such a run may take long, is told once. Call it with the fraction done (0 to 1)
    and the train's speed in m/s.
    """

    def __init__(self, description: str, reason: str = "") -> None:
        super().__init__(description, "speed", counted=False)
        self._reason = reason
        self._started = self._noted = time.monotonic()

    def __call__(self, fraction: float, speed: float) -> None:
        now, part = time.monotonic(), min(max(fraction, 0.0), 1.0)
        if self._bar is not None or (now - self._started >= _PATIENCE and _somebody_watches()):
            self._draw(part, 1.0, speed=f"{speed * 3.6:5.1f} km/h")
        if now - self._noted >= _NOTE_SECONDS:
            self._note(now, part, speed)

    def _note(self, now: float, part: float, speed: float) -> None:
        """Say how far the run is where there is no bar, and why it takes long."""
        self._noted = now
        told = [] if self._bar else [f"{part:.0%} after {duration(now - self._started)}, {speed * 3.6:.1f} km/h"]
        told += [self._reason] if self._reason else []
        self._reason = ""
        if told:
            note(f"{self._description}: {'; '.join(told)}")


class StopsProgress(_Bar):
    """A bar with rate and time left on a terminal, a line now and then elsewhere."""

    def __init__(self, *, noted_every: float = _NOTE_SECONDS) -> None:
        super().__init__("stops", "rate", "left")
        self._every = noted_every
        self._began = self._noted = self._moved = time.monotonic()
        self._done = 0

    def __call__(self, done: int, total: int) -> None:
        """Show that `done` of `total` stops are finished; called again without progress, since when there is none."""
        now = time.monotonic()
        if done != self._done:
            self._done, self._moved = done, now
        rate = done / max(now - self._began, 1e-9)
        left = (total - done) / rate if done else None
        if _somebody_watches():
            told = {"rate": f"{rate:.1f}/s", "left": f"{duration(left)} left"} if done else {}
            self._draw(done, total, **told)
        elif done < total and now - self._moved >= max(self._every, _NOTE_SECONDS) and now - self._noted >= self._every:
            self._noted = now
            since = duration(now - self._moved)
            note(f"{done} of {total} stops, none for {since}: a worker may hang. Ctrl-C keeps what is finished")
        elif done and done < total and now - self._noted >= self._every:
            self._noted = now
            note(f"{done} of {total} stops, {rate:.1f} per second, {duration(left)} left")


@contextmanager
def counting(description: str) -> Iterator[Callable[..., None]]:
    """A bar on a terminal, silence elsewhere: call it with done, total and, if it changes, the description."""
    with _Bar(description) as bar:
        yield bar.count if _somebody_watches() else lambda *_: None


def duration(seconds: float | None) -> str:
    """Seconds as people say them: ``4 s``, ``12 min``, ``3.5 h``."""
    if seconds is None:
        return "an unknown time"
    if seconds < 100.0:
        return f"{max(seconds, 1.0):.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"


def _somebody_watches() -> bool:
    return sys.stderr.isatty()


def _rich_bar(*fields: str, counted: bool) -> "Progress":
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn() if counted else TaskProgressColumn(),
        *(TextColumn(f"{{task.fields[{field}]}}") for field in fields),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
    )
