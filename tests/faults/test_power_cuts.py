"""The power fails under the journal: what was not flushed to the disk is dropped, sector by sector, at random.

The disk is that of the process, recorded after every commit. What was flushed stays. Of what was written since, any
sector may hold the old content or the new one. A commit writes the log alone. Where it is full, the log is flushed,
then its pages go to the database, which is flushed in turn. A log that begins anew has its head flushed before the
rest: else the frames of an old log, believed up to the first new one, would spoil the database.
"""

import random
from collections.abc import Iterator, Sequence
from pathlib import Path
from threading import Event

import pytest
from study_tools import QuickSolver

from slosh_cli.application.studies import StudyResult, opened, sweep
from slosh_cli.scenario import Scenario
from slosh_cli.study.build import grid
from slosh_cli.study.journal import JOURNAL, Journal
from slosh_cli.study.outcome import FinishedStop
from slosh_cli.study.table import TABLE
from slosh_cli.study.threads import Threads

_SECTOR = 512
_HEAD = 32
_VARY = {"braking.torque": "2:14:1 kN m"}


class Disk:
    """What the disk holds for sure after each commit, and the keys that were committed by then."""

    def __init__(self, folder: Path) -> None:
        self._file, self._log = folder / JOURNAL, folder / f"{JOURNAL}-wal"
        self.states: list[tuple[bytes, bytes, set[str]]] = []
        self._keys: set[str] = set()

    def record(self, outcomes: Sequence[FinishedStop] = ()) -> None:
        self._keys |= {one.key for one in outcomes}
        self.states.append((self._file.read_bytes(), self._log.read_bytes(), set(self._keys)))

    def cut(self, chance: random.Random) -> tuple[bytes, bytes, set[str]]:
        """The files after a power cut at a random moment, and the keys that must be in them."""
        before, after = chance.choice(list(zip(self.states, self.states[1:], strict=False)))
        if before[0] == after[0] or chance.random() < 0.5:
            return before[0], mixed_log(before[1], after[1], chance), before[2]
        return mixed(before[0], after[0], chance), after[1], before[2]


def mixed_log(old: bytes, new: bytes, chance: random.Random) -> bytes:
    """As `mixed`, but that the head of a log that begins anew is old, or new before anything else is."""
    if old[:_HEAD] == new[:_HEAD]:
        return mixed(old, new, chance)
    if chance.random() < 0.2:
        return old
    return new[:_HEAD] + mixed(old, new, chance)[_HEAD:]


def mixed(old: bytes, new: bytes, chance: random.Random) -> bytes:
    """Each sector old or new; a file that grew may have grown by any part, filled with nothing."""
    size = chance.choice((len(old), len(new), chance.randrange(min(len(old), len(new)), max(len(old), len(new)) + 1)))
    chance_of_new, found = chance.random(), bytearray()
    for place in range(0, size, _SECTOR):
        sector = (new if chance.random() < chance_of_new else old)[place : place + _SECTOR]
        found += sector.ljust(_SECTOR, b"\0")
    return bytes(found[:size])


@pytest.fixture
def recorded(tmp_path: Path, paper: Scenario, solver: QuickSolver, monkeypatch: pytest.MonkeyPatch) -> Disk:
    """A study whose journal's disk is recorded; its log is copied to the database every few commits."""
    folder = tmp_path / "recorded"
    folder.mkdir()
    disk, add = Disk(folder), Journal.add
    monkeypatch.setattr(Journal, "add", lambda journal, outcomes: (add(journal, outcomes), disk.record(outcomes)))
    with opened(grid(paper, _VARY), folder) as work:
        work.journal._file.execute("PRAGMA wal_autocheckpoint = 12")
        work.begin_session()
        disk.record()
        for number in work.planned.open:  # a commit for each stop
            one = type(work.planned)(folder, work.planned.keys, open=[number])
            type(work)(work.study, one, work.journal).compute(Threads(1), Event(), lambda *_: None)
    monkeypatch.undo()
    assert len({state[0] for state in disk.states}) > 2
    return disk


def cuts(disk: Disk, how_many: int) -> Iterator[tuple[bytes, bytes, set[str]]]:
    chance = random.Random(how_many)
    for _ in range(how_many):
        yield disk.cut(chance)


@pytest.mark.parametrize("how_many", [12, pytest.param(200, marks=pytest.mark.slow)])
def test_after_any_power_cut_the_same_command_ends_with_the_same_table(
    tmp_path: Path, recorded: Disk, paper: Scenario, template: object, monkeypatch: pytest.MonkeyPatch, how_many: int
) -> None:
    quick = QuickSolver(template)  # type: ignore[arg-type]
    monkeypatch.setattr("slosh_cli.results.simulate.simulate", quick.simulate)
    monkeypatch.setattr("slosh_cli.application.studies.OpenStudy.keep_figures", lambda *_: [])

    def carried_out(folder: Path) -> tuple[StudyResult, bytes]:
        found = sweep(paper, _VARY, folder=folder, threads=1)
        return found, (folder / TABLE).read_bytes()

    _, whole = carried_out(tmp_path / "whole")
    lost = 0
    for number, (file, log, keys) in enumerate(cuts(recorded, how_many)):
        folder = tmp_path / f"cut {number}"
        folder.mkdir()
        (folder / JOURNAL).write_bytes(file)
        (folder / f"{JOURNAL}-wal").write_bytes(log)
        found, table = carried_out(folder)
        assert len(keys) <= found.reused <= len(keys) + 1
        assert table == whole
        lost += found.reused == len(keys)
    assert 0 < lost < how_many
