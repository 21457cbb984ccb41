"""The long run: `make fuzz N=100000`. Searches for inputs whose answer is not what an answer must be, kind by kind."""

import argparse
import os
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import copy

import h5py
from answer import Answer, settled
from good_files import Good, good_files
from hypothesis import HealthCheck, Phase, given, seed, settings, target
from hypothesis.database import DirectoryBasedExampleDatabase
from spoiling import Given, strategies

SHARES = {"scenario": 30, "train": 20, "study": 10, "--set": 20, "--vary": 8, "CSV": 4, "presets": 3, "HDF5": 5}
"""Of 100 inputs, how many are of each kind."""
CHUNK = 500


@contextmanager
def in_a_folder(one: Given, good: Good) -> Iterator[None]:
    """The files of an input, in a folder of their own that is the working one."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for name, text in one.files.items():
                Path(name).write_bytes(text.encode("utf-8", "surrogatepass"))
            if one.history is not None:
                os.mkfifo("pipe")
                copy(good.run if one.base == "run" else good.train_run, "run.h5")
                with h5py.File("run.h5", "r+") as file:
                    one.history[1](file)
            yield
        finally:
            os.chdir(before)


def judged(one: Given, good: Good) -> Answer:
    """The answer to an input."""
    with in_a_folder(one, good):
        return settled(*one.words)


class Campaign:
    """What was tried and found so far."""

    def __init__(self, good: Good, folder: Path) -> None:
        self.good, self.folder = good, folder
        self.tried: Counter[str] = Counter()
        self.codes: Counter[int] = Counter()
        self.slowest: tuple[float, str] = (0.0, "")
        self.biggest: tuple[float, str] = (0.0, "")
        self.findings: dict[str, str] = {}

    def chunk(self, kind: str, count: int, number: int) -> None:
        """Try `count` inputs of a kind, towards those that take long, say much and take memory."""

        @seed(number)
        @settings(
            max_examples=count,
            deadline=None,
            database=DirectoryBasedExampleDatabase(self.folder / "examples" / kind.strip("-")),
            suppress_health_check=list(HealthCheck),
            phases=[Phase.reuse, Phase.generate, Phase.target, Phase.shrink],
        )
        @given(strategies(self.good)[kind])
        def search(one: Given) -> None:
            found = judged(one, self.good)
            self.tried[kind] += 1
            self.codes[found.code] += 1
            self.slowest = max(self.slowest, (found.seconds, repr(one)[:200]))
            self.biggest = max(self.biggest, (found.megabytes, repr(one)[:200]))
            target(found.seconds, label="seconds")
            target(float(len(found.err)), label="letters")
            assert not found.faults, found.faults

        try:
            search()
        except Exception as error:
            lines = "".join(traceback.format_exception(error))
            self.findings.setdefault(f"{kind}: {str(error)[:300]}", lines[-6000:])
            (self.folder / f"finding-{len(self.findings):03d}.txt").write_text(
                lines, encoding="utf-8", errors="replace"
            )

    def report(self) -> str:
        """The figures so far."""
        kinds = ", ".join(f"{kind} {count}" for kind, count in self.tried.items())
        codes = ", ".join(f"{code}: {count}" for code, count in sorted(self.codes.items()))
        return "\n".join(
            [
                f"inputs {self.tried.total()} ({kinds}); exit codes {codes}",
                f"slowest {self.slowest[0]:.2f} s: {self.slowest[1]}",
                f"most memory {self.biggest[0]:.0f} MB: {self.biggest[1]}",
                f"findings {len(self.findings)}",
                *(f"  {words}" for words in self.findings),
            ]
        )


def main() -> int:
    """Try as many inputs as asked for; returns 1 where something was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--folder", type=Path, default=Path("outputs/fuzz"))
    asked_for = parser.parse_args()
    folder = asked_for.folder.absolute()
    folder.mkdir(parents=True, exist_ok=True)
    work = Campaign(good_files(folder), folder)
    number = asked_for.seed
    while work.tried.total() < asked_for.inputs:
        for kind, share in SHARES.items():
            work.chunk(kind, max(1, CHUNK * share // 100), number)
            number += 1
        sys.stdout.write(work.report() + "\n")
        sys.stdout.flush()
    return 1 if work.findings else 0


if __name__ == "__main__":
    sys.exit(main())
