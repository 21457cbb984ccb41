"""Stops on the threads of this machine: the compiled kernel releases the interpreter lock."""

from __future__ import annotations

import os
import sys
from collections.abc import Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from threading import Event
from typing import TYPE_CHECKING

from slosh_cli.study.outcome import FinishedStop, run_of, solve
from slosh_cli.study.plan import Stop

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario
    from slosh_cli.scenario.train_file import TrainScenario

_TURN = 1e-4
"""Seconds for which a thread that computes in Python may keep another from it."""
_WAITING = 8
"""Stops per thread that wait their turn: a thread never idles, and memory does not grow with the study."""
_GATHER = 0.03
"""Seconds in which finished stops may gather: whoever keeps the books takes core and interpreter from who computes."""


def available_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class Threads:
    """Computes stops on `threads` threads; a few are in hand at any time, whatever their number."""

    def __init__(self, threads: int) -> None:
        self.threads = threads

    @property
    def words(self) -> str:
        """What computes, for people."""
        return f"{self.threads} thread{'s' if self.threads > 1 else ''}"

    def outcomes(self, stops: Iterable[Stop], total: int, cancel: Event) -> Generator[list[FinishedStop], None, None]:
        """Outcomes as they come, in no particular order. `cancel` gives up the stops in hand and ends the iteration."""
        del total  # only workers far away need to know
        waiting: set[Future[FinishedStop]] = set()
        with _quick_turns(), ThreadPoolExecutor(self.threads, thread_name_prefix="stop") as pool:
            try:
                for stop in stops:
                    waiting.add(pool.submit(_solve, stop, cancel))
                    if len(waiting) >= self.threads * (1 + _WAITING):
                        done, waiting = _gathered(waiting)
                        yield _finished(done, cancel)
                    if cancel.is_set():
                        break
                while waiting:
                    if cancel.is_set():
                        waiting = {future for future in waiting if not future.cancel()}
                    done, waiting = _gathered(waiting)
                    yield _finished(done, cancel)
            except BaseException:
                cancel.set()  # the pool waits for its threads: they must not go on to the end of their stops
                pool.shutdown(wait=False, cancel_futures=True)
                raise


def _gathered(waiting: set[Future[FinishedStop]]) -> tuple[set[Future[FinishedStop]], set[Future[FinishedStop]]]:
    """Those that have finished after a moment, at least one, and those that have not."""
    done, open_ = wait(waiting, timeout=_GATHER)
    return (done, open_) if done else wait(waiting, return_when=FIRST_COMPLETED)


@contextmanager
def _quick_turns() -> Iterator[None]:
    """A thread that comes out of the kernels waits for the interpreter a tenth of a millisecond, not five."""
    earlier = sys.getswitchinterval()
    sys.setswitchinterval(_TURN)
    try:
        yield
    finally:
        sys.setswitchinterval(earlier)


def _solve(stop: Stop, cancel: Event) -> FinishedStop:
    """A stop that was waiting its turn when the study was given up is not begun."""
    from slosh_cli.solver.run import Cancelled

    if cancel.is_set():
        raise Cancelled
    return solve(stop, cancel)


def _finished(futures: Iterable[Future[FinishedStop]], cancel: Event) -> list[FinishedStop]:
    """What the futures brought, without the stops that were given up."""
    from slosh_cli.solver.run import Cancelled

    outcomes = []
    for future in futures:
        try:
            outcomes.append(future.result())
        except Cancelled:
            if not cancel.is_set():
                raise
    return sorted(outcomes, key=lambda outcome: outcome.index)


def warm_up(scenario: Scenario | TrainScenario) -> None:
    """Load or compile the kernels here and now, on this thread, where an interrupt is heard."""
    from slosh_cli.errors import SloshError
    from slosh_cli.solver.run import Cancelled

    enough = Event()
    enough.set()
    try:
        run_of(scenario, cancel=enough)
    except (Cancelled, SloshError):
        return
