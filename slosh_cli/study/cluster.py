"""Stops on a Dask cluster that runs already: batches out, outcomes back as they come.

Needs the extra `cluster` here, and the same version of slosh wherever a worker runs.
"""

from __future__ import annotations

import logging
import math
import queue
import time
from collections import deque
from collections.abc import Generator, Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from statistics import median
from threading import Event
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.errors import SloshError, UsageError
from slosh_cli.study.key import RESULT_VERSION
from slosh_cli.study.outcome import FinishedStop, failed, solve
from slosh_cli.study.plan import Stop
from slosh_cli.version import __version__, install_command

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Self

_Batch = tuple[Stop, ...]
_Future = Any
"""A future of Dask, which carries no types."""

_BATCH_SECONDS: Final = 4.0
"""Work of a batch in s: long beside what the scheduler spends on it, short enough to lose with a worker."""
_FIRST_BATCH: Final = 4
_LARGEST_BATCH: Final = 1000
_IN_HAND: Final = 2
"""Batches per thread of the cluster that are on their way at any time."""
_CONNECT_SECONDS: Final = 10.0
_POLL_SECONDS: Final = 0.3
_COUNT_SECONDS: Final = 5.0
"""How often the workers are counted: some may come later."""
_CERTIFICATES: Final = "name them under distributed.comm.tls in Dask's configuration (docs/studies.md, On a cluster)"
_TALKERS: Final = ("distributed", "tornado", "asyncio")
"""Who logs a lost connection, by a traceback of whichever part noticed first."""


class ClusterError(SloshError):
    """The cluster cannot do the work: no scheduler, other versions, connection lost."""

    code = "cluster"


def _solve_batch(batch: _Batch, needed: str) -> list[FinishedStop]:
    """What a worker does. Raises ClusterError where its version of slosh is not the `needed` one."""
    if needed != _this_version():
        raise ClusterError(f"a worker has {_this_version()}, but the study needs {needed}; install the same there")
    return [solve(stop) for stop in batch]


def _this_version() -> str:
    """Program and result version that both ends must share."""
    return f"slosh {__version__} (results {RESULT_VERSION})"


class Cluster:
    """Computes stops on the workers of the Dask scheduler at `address`; a context manager.

    Raises UsageError without the extra, ClusterError where nobody answers at `address`.
    """

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            text = f"--cluster needs Dask: {install_command('cluster')}, here and for the workers"
            raise UsageError(text, "--cluster") from None
        self._dask: Any = distributed
        self.address = address
        _silence()
        try:
            self._client: Any = self._dask.Client(
                address, timeout=_CONNECT_SECONDS, set_as_default=False, name="slosh", direct_to_workers=False
            )
        except (OSError, ValueError, TimeoutError) as error:
            raise ClusterError(f"no Dask scheduler answers at {address}: {error}", "--cluster") from None
        except TypeError:  # what Dask says of an address that needs certificates where its configuration has none
            raise ClusterError(f"{address} needs certificates: {_CERTIFICATES}", "--cluster") from None
        self._batches: dict[Any, _Batch] = {}
        self._done: queue.SimpleQueue[_Future] = queue.SimpleQueue()
        self._seconds: deque[float] = deque(maxlen=64)
        self._threads, self._counted = 0, -math.inf

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._client.close(timeout=2.0)

    @property
    def words(self) -> str:
        """What computes, for people."""
        with self._connection():
            workers = self._client.scheduler_info(n_workers=-1)["workers"]
        threads = sum(worker["nthreads"] for worker in workers.values())
        if not workers:
            return f"the cluster at {self.address}, which has no workers yet"
        return f"{threads} threads of {len(workers)} workers at {self.address}"

    @property
    def threads(self) -> int:
        """Threads of all workers there are now, at least one."""
        return max(self._all_threads(), 1)

    def outcomes(self, stops: Iterable[Stop], total: int, cancel: Event) -> Generator[list[FinishedStop], None, None]:
        """Outcomes batch by batch, in no particular order. `cancel` gives up what is on its way and ends the iteration.

        The batch of a worker that dies goes to another one; a stop that takes worker after worker with it ends as
        a failure of its own. Raises ClusterError when the scheduler is lost.
        """
        remaining = iter(stops)
        left = total
        try:
            while not cancel.is_set():
                for batch in self._next_batches(remaining, left):
                    left -= len(batch)
                    self._send(batch)
                if not self._batches:
                    break
                future = self._wait()
                if future is None:
                    yield []  # whoever waits may say so
                else:
                    yield from self._received(future)
        finally:
            for future in list(self._batches):
                future.cancel()
            self._batches.clear()

    def _next_batches(self, stops: Iterator[Stop], left: int) -> Iterator[_Batch]:
        """Batches until enough are on their way, smaller towards the end so that all workers end together."""
        self._count_threads()
        while len(self._batches) < _IN_HAND * max(self._threads, 1):
            share = math.ceil(left / (_IN_HAND * max(self._threads, 1)))
            wanted = round(_BATCH_SECONDS / median(self._seconds)) if self._seconds else _FIRST_BATCH
            batch = tuple(islice(stops, max(1, min(share, wanted, _LARGEST_BATCH))))
            if not batch:
                return
            left -= len(batch)
            yield batch

    def _count_threads(self) -> None:
        now = time.monotonic()
        if now - self._counted > _COUNT_SECONDS and self._client.status == "running":
            self._threads = self._all_threads()
            self._counted = now

    def _all_threads(self) -> int:
        with self._connection():
            return int(sum(self._client.nthreads().values()))

    def _send(self, batch: _Batch) -> None:
        with self._connection():
            future = self._client.submit(_solve_batch, batch, _this_version(), pure=False)
        self._await(future, batch)

    def _await(self, future: _Future, batch: _Batch) -> None:
        self._batches[future] = batch
        future.add_done_callback(self._done.put)

    def _wait(self) -> _Future | None:
        """The next future that has ended; None when nothing happens for a moment."""
        try:
            return self._done.get(timeout=_POLL_SECONDS)
        except queue.Empty:
            if self._client.status != "running":  # the scheduler forgets what a client that went away had asked for
                raise self._lost() from None
            return None

    def _received(self, future: _Future) -> Iterator[list[FinishedStop]]:
        """The outcomes of a batch, or the batch sent again stop by stop where it killed its workers."""
        batch = self._batches.pop(future, ())
        if future.status in ("lost", "pending"):  # its worker died with it: the scheduler has it computed again
            self._await(future, batch)
            return
        if future.status == "cancelled":
            raise self._lost()
        error: Any = future.exception() if future.status == "error" else None
        if error is None:
            with self._connection():  # the outcomes come from the worker only now, by way of the scheduler
                outcomes: list[FinishedStop] = future.result()
            self._seconds.extend(max(outcome.seconds, 1e-3) for outcome in outcomes)
            yield outcomes
        elif not isinstance(error, self._dask.KilledWorker):
            raise _told(error)
        elif len(batch) > 1:
            for stop in batch:
                self._send((stop,))
        else:
            yield [failed(stop, "every worker that computed this stop died", final=False) for stop in batch]

    @contextmanager
    def _connection(self) -> Iterator[None]:
        """What Dask raises where the scheduler goes away in the middle of a request, as the error it is."""
        try:
            yield
        except Exception as error:
            gone = isinstance(error, OSError | self._dask.CancelledError) or self._client.status != "running"
            if not gone:
                raise
            raise self._lost() from None

    def _lost(self) -> ClusterError:
        return ClusterError(
            f"lost the Dask scheduler at {self.address}; every stop received before is kept: start the scheduler, "
            "then the same command again",
            "--cluster",
        )


def _silence() -> None:
    """Keep Dask's own lines off the terminal: what they say, we say."""
    for name in _TALKERS:  # inherited by whatever has no level of its own
        logging.getLogger(name).setLevel(logging.CRITICAL)
    for name, logger in logging.root.manager.loggerDict.items():
        if name.partition(".")[0] in _TALKERS and isinstance(logger, logging.Logger):
            logger.setLevel(logging.CRITICAL)


def _told(error: BaseException) -> SloshError:
    """An error of a worker in words for the person who started the study."""
    if isinstance(error, SloshError):
        return error
    text = f"{type(error).__name__}: {error}"
    if isinstance(error, ImportError):
        text += f"; the workers need slosh {__version__} and Dask, installed as on this machine"
    return ClusterError(f"a worker failed: {text}", "--cluster")
