"""What every answer of `slosh` must be, whatever it was given: runs a command in this process and looks at it."""

import io
import re
import resource
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import FrameType

from slosh_cli.cli.shell import execute

SECONDS = 2.0
"""The longest that an input may be judged, on a machine that runs the loop of `slowness` in `LOOP_SECONDS`."""
LOOP_SECONDS = 0.06
MEGABYTES = 350.0
"""The most that a command may add to the memory of its process, which has 150 MB with all libraries loaded."""
PROBLEMS = 20
MOST_LETTERS = 60_000
HANGS_AFTER = 600
"""Seconds on the clock after which a command counts as hanging."""

EXIT_CODES = (0, 1, 2, 3, 130)
BROKEN = re.compile(r"Traceback|slosh itself failed|internal error|could not be written: \w+(Error|Exception|Warning):")
"""What only a fault of the program says."""
UNPRINTABLE = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")
"""Characters that move the cursor, turn the writing or change the colour of a terminal."""


class _HangError(BaseException):
    """The command did not end."""


@dataclass(frozen=True)
class Answer:
    """What a command said, in how many seconds of a fast machine, and with how much more memory (MB)."""

    words: tuple[str, ...]
    code: int
    out: str
    err: str
    seconds: float
    megabytes: float

    @property
    def faults(self) -> list[str]:
        """What is wrong with the answer, in words."""
        told = self.out + self.err
        lines = self.err.splitlines()
        found = {
            f"the exit code {self.code}": self.code not in EXIT_CODES,
            f"a fault of the program: {told[-600:]}": BROKEN.search(told) is not None,
            f"{len(lines)} lines of findings": len(lines) > PROBLEMS + 5,
            f"{len(told)} letters": len(told) > MOST_LETTERS,
            "characters that steer a terminal": UNPRINTABLE.search(told) is not None,
            "no reason for a refusal": self.code == 2 and not self.err.strip(),
            f"{self.seconds:.1f} s": self.seconds > SECONDS,
            f"{self.megabytes:.0f} MB more": self.megabytes > MEGABYTES,
        }
        return [words for words, wrong in found.items() if wrong]


def asked(*words: str | Path) -> Answer:
    """What `slosh` answers to the words, without a judgement."""
    texts = tuple(map(str, words))
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2)]
    before = sys.stdout, sys.stderr
    resident = _memory("VmRSS")
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    began = time.process_time()
    try:
        sys.stdout, sys.stderr = streams
        with _limit():
            code = int(execute(texts))
    except _HangError:
        code = -1
    finally:
        sys.stdout, sys.stderr = before
    seconds = (time.process_time() - began) / slowness()
    out, err = (stream.buffer.getvalue().decode("utf-8") for stream in streams)  # type: ignore[attr-defined]
    return Answer(texts, code, out, err, seconds, _memory("VmHWM") - resident)


def settled(*words: str | Path) -> Answer:
    """What `slosh` answers, asked once more where it took long and nothing else is wrong: a busy machine is slower."""
    found = asked(*words)
    return asked(*words) if found.seconds > SECONDS and len(found.faults) == 1 else found


def answer(*words: str | Path, code: int | None = None) -> Answer:
    """What `slosh` answers to the words; fails where it is not what an answer must be, or has another exit code."""
    found = asked(*words)
    if found.seconds > SECONDS and len(found.faults) == 1:  # once more: a busy machine is slower
        found = asked(*words)
    assert not found.faults, (found.words, found.faults)
    assert code is None or found.code == code, (found.words, found.code, found.out[-800:], found.err[-2000:])
    return found


@cache
def slowness() -> float:
    """How many times slower than a fast machine this one is; at least 1."""
    taken = []
    for _ in range(3):
        began = time.process_time()
        total = 0
        for number in range(1_000_000):
            total += number * number % 7
        taken.append(time.process_time() - began)
    return max(1.0, min(taken) / LOOP_SECONDS)


@contextmanager
def _limit() -> Iterator[None]:
    """End the block with an exception where it does not end by itself."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise _HangError

    former = signal.signal(signal.SIGALRM, stop)
    signal.alarm(HANGS_AFTER)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, former)


def _memory(name: str) -> float:
    """A line of what the system knows of this process, in MB; the peak where it has no such line."""
    with suppress(OSError, StopIteration):
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
        return int(next(line for line in lines if line.startswith(f"{name}:")).split()[1]) / 1024.0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def lines_of(found: Answer, option: Sequence[str] = ()) -> list[str]:
    """The lines of what it complained of."""
    return found.err.splitlines()
