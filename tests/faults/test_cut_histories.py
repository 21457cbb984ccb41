"""A history that is cut short anywhere is refused with a sentence, by every command that reads one."""

import random
from pathlib import Path

import pytest

from slosh_cli.cli import main
from slosh_cli.results.hdf5 import write_history
from slosh_cli.results.result import Result

COMMANDS = ("plot", "report", "animate", "compare")


@pytest.fixture(scope="module")
def whole(template: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("whole") / "run.h5"
    write_history(template, file)
    return file


@pytest.mark.parametrize("every", [6400, pytest.param(64, marks=pytest.mark.slow)])
def test_a_history_cut_at_any_byte_is_refused_by_every_command(
    tmp_path: Path, whole: Path, capsys: pytest.CaptureFixture[str], every: int
) -> None:
    content, chance, file = whole.read_bytes(), random.Random(1), tmp_path / "cut.h5"
    places = sorted({*range(0, len(content), every), *range(0, 4096, max(every // 8, 64)), len(content) - 1})
    for place in places:
        file.write_bytes(content[:place])
        command = chance.choice(COMMANDS)
        more = [str(whole)] if command == "compare" else []
        assert main([command, str(file), *more, "-o", str(tmp_path / "out")]) == 2, (command, place)
        err = capsys.readouterr().err
        assert "cut.h5" in err, (command, place)
        assert "slosh itself failed" not in err
        assert not (tmp_path / "out").exists()
