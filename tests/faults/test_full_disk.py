"""A disk that takes nothing: what was there stays, the sentence says what to do, nothing appears by half."""

import errno
import os
from pathlib import Path

import pytest

from slosh_cli.application.keeping import Keeping
from slosh_cli.cli import main
from slosh_cli.results.files import FileError, replacing, words_of
from slosh_cli.study.journal import JOURNAL, Journal


def full(_: Path) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EFBIG, errno.EDQUOT, errno.EROFS, errno.EACCES])
def test_a_refusal_says_what_to_do(tmp_path: Path, number: int) -> None:
    with pytest.raises(FileError, match="choose another place with -o") as refusal, replacing(tmp_path / "file"):
        raise OSError(number, os.strerror(number))
    assert str(tmp_path / "file") in str(refusal.value)
    assert os.strerror(number) in str(refusal.value)
    assert ("make room" in str(refusal.value)) == (number not in (errno.EROFS, errno.EACCES))
    assert words_of(OSError(errno.EIO, "Input/output error")) == "Input/output error"


def test_where_nothing_of_an_answer_can_be_written_the_earlier_one_stays(tmp_path: Path) -> None:
    (tmp_path / "run.h5").write_text("old")
    keeping, drawn = Keeping(), []
    files = keeping.keep(tmp_path, ["run.h5", "a.png"], {"run.h5": full}, {"a": drawn.append})
    assert (files, drawn) == ([], [])
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [("run.h5", "old")]
    assert "make room" in keeping.failures[0]
    assert "what an earlier command left there stays" in keeping.failures[1]


def test_init_writes_its_file_whole_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It used to open the file first: a power cut left an empty one, and the next `init` refused to overwrite it."""
    monkeypatch.setattr("slosh_cli.results.files._to_disk", full)
    monkeypatch.chdir(tmp_path)
    assert main(["init", "-o", "mine.yaml"]) == 2
    assert "cannot write mine.yaml: No space left on device; make room" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="limits of Linux")
def test_a_disk_that_takes_no_journal_leaves_none(tmp_path: Path) -> None:
    import subprocess
    import sys

    code = (
        "import resource, sys; from pathlib import Path; from slosh_cli.study.journal import Journal;"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)); Journal(Path(sys.argv[1]))"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / JOURNAL)], capture_output=True, text=True, check=False
    )
    assert "Make room, then start the same command again" in run.stderr
    assert list(tmp_path.iterdir()) == []
    with Journal(tmp_path / JOURNAL) as journal:
        assert len(journal) == 0
