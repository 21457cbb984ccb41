"""A journal that is damaged, locked, foreign, old, new or gone is told for what it is, and never believed."""

import json
import os
import random
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from study_tools import QuickSolver

from slosh_cli.application.studies import sweep
from slosh_cli.errors import SloshError
from slosh_cli.results.files import FileError
from slosh_cli.scenario import Scenario
from slosh_cli.study import journal as journals
from slosh_cli.study.journal import JOURNAL, Journal
from slosh_cli.study.outcome import FinishedStop
from slosh_cli.study.table import TABLE

KEYS = [f"key {number}" for number in range(12)]


def outcome(key: str) -> FinishedStop:
    number = 218.19 + KEYS.index(key)
    return FinishedStop(0, key, {"status": "stopped", "braking_distance_m": number, "words": "x" * 600}, True, 0.25)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / JOURNAL


@pytest.fixture
def filled(path: Path) -> Path:
    with Journal(path) as journal:
        journal.begin_session("abc")
        journal.add([outcome(key) for key in KEYS])
    return path


def change(path: Path, statement: str) -> None:
    with closing(sqlite3.connect(path)) as file, file:
        file.execute(statement)


FORGED = {
    "a digit": "UPDATE stop SET answer = replace(answer, '218.19', '118.19') WHERE key = 'key 0'",
    "the status": "UPDATE stop SET status = 'failed' WHERE key = 'key 0'",
    "finality": "UPDATE stop SET final = 0 WHERE key = 'key 0'",
    "another key": "UPDATE OR REPLACE stop SET key = 'key 0' WHERE key = 'key 1'",
    "the answer of another": (
        "UPDATE stop SET answer = (SELECT answer FROM stop WHERE key = 'key 1') WHERE key = 'key 0'"
    ),
    "a number for a text": "UPDATE stop SET answer = 5 WHERE key = 'key 0'",
    "bytes for a text": "UPDATE stop SET answer = CAST(x'ff00' AS TEXT) WHERE key = 'key 0'",
}


@pytest.mark.parametrize("statement", FORGED.values(), ids=FORGED)
def test_a_row_that_does_not_match_its_checksum_counts_as_never_computed(filled: Path, statement: str) -> None:
    change(filled, statement)
    with Journal(filled) as journal:
        assert journal.answer("key 0") is None
        assert "key 0" not in journal
        assert all(key in journal for key in KEYS[2:])
        journal.add([outcome("key 0")])
        assert journal.answer("key 0") == outcome("key 0").answer


def test_a_study_computes_a_stop_with_one_altered_digit_again_and_says_so(
    tmp_path: Path, solver: QuickSolver, paper: Scenario
) -> None:
    first = sweep(paper, {"braking.torque": "5,10 kN m"}, folder=tmp_path)
    assert (first.reused, list(first.warnings)) == (0, [])
    table = (tmp_path / TABLE).read_bytes()
    change(tmp_path / JOURNAL, "UPDATE stop SET answer = replace(answer, '_m\": ', '_m\": 1') WHERE rowid = 2")
    again = sweep(paper, {"braking.torque": "5,10 kN m"}, folder=tmp_path)
    assert again.reused == 3
    assert [text.partition(" in ")[0] for text in again.warnings] == ["1 stop does not match the checksum"]
    assert (tmp_path / TABLE).read_bytes() == table


def test_a_journal_from_before_the_checksums_is_not_believed(filled: Path) -> None:
    change(filled, "ALTER TABLE stop DROP COLUMN checksum")
    change(filled, "PRAGMA user_version = 1")
    with pytest.raises(FileError, match=r"format 1\), whose rows have no checksums; .*-o, or .* --fresh"):
        Journal(filled)
    change(filled, "PRAGMA user_version = 2")
    with pytest.raises(FileError, match=r"no journal of slosh \(.*checksum.*--fresh"), Journal(filled) as journal:
        assert "key 0" in journal


def test_a_journal_of_a_newer_version_is_left_alone(filled: Path) -> None:
    change(filled, "PRAGMA user_version = 3")
    before = filled.read_bytes()
    with pytest.raises(FileError, match=r"another version of slosh \(format 3\); this one has format 2; choose"):
        Journal(filled)
    assert filled.read_bytes() == before


def test_a_database_of_another_program_is_left_alone(path: Path) -> None:
    change(path, "CREATE TABLE bookmarks (title TEXT)")
    before = path.read_bytes()
    with pytest.raises(FileError, match=r"database of another program \(tables bookmarks\); choose another folder"):
        Journal(path)
    assert path.read_bytes() == before


def test_a_locked_journal_is_told_as_locked(filled: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journals, "_WAITING", 0.05)
    with Journal(filled) as journal, closing(sqlite3.connect(filled, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(FileError, match="locked by another program") as refusal:
            journal.add([outcome("key 0")])
        assert "Make room" not in str(refusal.value)
        other.execute("ROLLBACK")
        journal.add([outcome("key 0")])


@pytest.mark.parametrize("gone", [[JOURNAL], [JOURNAL, f"{JOURNAL}-wal", f"{JOURNAL}-shm"], ["the folder"]])
def test_a_journal_that_is_removed_while_it_is_in_use_is_written_anew(tmp_path: Path, gone: list[str]) -> None:
    path = tmp_path / "study" / JOURNAL
    path.parent.mkdir()
    with Journal(path) as journal:
        journal.add([outcome("key 0")])
        for name in gone:
            (path.parent / name).unlink() if name != "the folder" else shutil.rmtree(path.parent)
        journal.add([outcome("key 1")])
        assert journal.restored == 1
        journal.add([outcome("key 2")])
        assert journal.restored == 1
    with Journal(path) as journal:
        assert [key in journal for key in KEYS[:4]] == [True, True, True, False]


def test_a_journal_that_is_replaced_while_it_is_in_use_ends_the_study(filled: Path) -> None:
    other = filled.with_name("other")
    shutil.copy(filled, other)
    with Journal(filled) as journal:
        os.replace(other, filled)
        with pytest.raises(FileError, match="replaced by another file while the study ran"):
            journal.add([outcome("key 0")])


def damaged_copies(whole: bytes, how_many: int) -> Iterator[tuple[str, bytes]]:
    """Copies of a file that are cut short or have some bytes changed."""
    chance = random.Random(7)
    for number in range(how_many):
        place = chance.randrange(1, len(whole))
        if number % 4 == 0:
            yield f"cut at {place}", whole[:place]
        else:
            size = chance.choice((1, 1, 16))
            yield f"{size} bytes changed at {place}", whole[:place] + chance.randbytes(size) + whole[place + size :]


def read(path: Path) -> dict[str, Any]:
    with Journal(path) as journal:
        found = {key: journal.answer(key) for key in KEYS if key in journal}
        journal.add([outcome("key 0")])
        assert journal.answer("key 0") == outcome("key 0").answer
    return found


@pytest.mark.parametrize("copies", [60, pytest.param(3000, marks=pytest.mark.slow)])
def test_a_damaged_journal_gives_the_rows_it_was_given_or_a_reason(filled: Path, copies: int) -> None:
    whole, refused, rightly_told, lost = filled.read_bytes(), 0, 0, 0
    for what, content in damaged_copies(whole, copies):
        Journal.remove(filled)
        filled.write_bytes(content)
        try:
            found = read(filled)
        except SloshError as error:
            rightly_told += "Make room" not in str(error)
            refused += 1
            continue
        for key, answer in found.items():
            assert json.dumps(answer) == json.dumps(outcome(key).answer), what
        lost += len(found) < len(KEYS)
    assert refused == rightly_told > 0
    assert lost
