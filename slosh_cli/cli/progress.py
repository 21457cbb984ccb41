"""What people see while a run is under way, all of it on stderr."""

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Final, Self

from slosh_cli.cli.output import note

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

PATIENCE: Final = 2.0
"""Seconds before a bar appears: a shorter run needs none."""

COMPILE_SECONDS: Final = 40
"""What compiling the time loop takes on an ordinary machine, in s."""


def announce_compilation(
    what: str = "the solver", seconds: int = COMPILE_SECONDS, kernel: str = "advance.advance"
) -> None:
    """Say that this run takes longer when `kernel` was not compiled before, and whether it is once."""
    from slosh_cli.compiled import is_cached, not_kept

    if is_cached(kernel):
        return
    trouble = not_kept()
    if not trouble:
        note(f"Compiling {what}, once: about {seconds} s. Later runs start at once.")
    else:
        note(
            f"Compiling {what} in memory, for this run only: about {seconds} s. It cannot be kept: {trouble}. Set "
            "XDG_CACHE_HOME or NUMBA_CACHE_DIR to a folder of yours, and later runs start at once."
        )


class RunProgress:
    """A progress bar for a run that takes longer than two seconds; silent when stderr is no terminal.

    Call it with the fraction done (0 to 1) and the train's speed in m/s.
    """

    def __init__(self, description: str) -> None:
        self._description = description
        self._started = time.monotonic()
        self._bar: Progress | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, fraction: float, speed: float) -> None:
        if self._bar is None:
            if time.monotonic() - self._started < PATIENCE or not _somebody_watches():
                return
            self._bar = _bar()
            self._task = self._bar.add_task(self._description, total=1.0, speed="")
            self._bar.start()
        assert self._task is not None
        self._bar.update(self._task, completed=min(max(fraction, 0.0), 1.0), speed=f"{speed * 3.6:5.1f} km/h")


def _somebody_watches() -> bool:
    return sys.stderr.isatty()


def _bar() -> "Progress":
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TextColumn("{task.fields[speed]}"),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
    )
