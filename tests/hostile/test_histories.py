"""HDF5 files that are no histories, or have something wrong in them: a reason, at once, and nothing drawn."""

import os
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from answer import answer
from good_files import Good
from spoilt_histories import dataset, put, spoils

from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import read_history, read_surface, read_train


@pytest.mark.parametrize("name", spoils("run"))
def test_a_spoilt_history_of_a_run_is_refused(name: str, good: Good, folder: Path) -> None:
    os.mkfifo("pipe")
    shutil.copy(good.run, "run.h5")
    with h5py.File("run.h5", "r+") as file:
        spoils("run")[name](file)
    assert "run.h5" in answer("report", "run.h5", "-o", "out.html", code=2).err
    assert not [path for path in folder.iterdir() if path.name not in ("run.h5", "pipe")]


@pytest.mark.parametrize("name", spoils("train"))
def test_a_spoilt_history_of_a_train_is_refused(name: str, good: Good, folder: Path) -> None:
    os.mkfifo("pipe")
    shutil.copy(good.train_run, "run.h5")
    with h5py.File("run.h5", "r+") as file:
        spoils("train")[name](file)
    assert "run.h5" in answer("plot", "run.h5", "-o", "out", code=2).err
    assert not [path for path in folder.iterdir() if path.name not in ("run.h5", "pipe")]


def test_what_was_not_spoilt_is_read(good: Good) -> None:
    assert read_history(good.run).time.size == read_train(good.train_run).time.size
    assert len(read_train(good.train_run).couplings) == 2
    assert read_surface(good.run) is not None


def test_a_link_inside_the_file_is_followed(good: Good, tmp_path: Path) -> None:
    shutil.copy(good.run, "run.h5")
    with h5py.File("run.h5", "r+") as file:
        file.move("speed", "kept_elsewhere")
        put("speed", h5py.SoftLink("/kept_elsewhere"))(file)
    np.testing.assert_array_equal(
        read_history(Path("run.h5")).channels["speed"], read_history(good.run).channels["speed"]
    )


def test_a_history_that_another_program_has_packed_is_read(good: Good) -> None:
    shutil.copy(good.run, "run.h5")
    with h5py.File("run.h5", "r+") as file:
        speed = file["speed"][:]
        dataset("speed", data=speed, compression="gzip", dtype="f4")(file)
    np.testing.assert_allclose(read_history(Path("run.h5")).channels["speed"], speed, rtol=1e-6)


@pytest.mark.parametrize(
    "content", [b"", b"\x89HDF\r\n\x1a\n", b"\x89HDF\r\n\x1a\n" + b"\xff" * 2000, b"text\n" * 1000]
)
def test_what_is_no_hdf5_is_refused(content: bytes, good: Good, folder: Path) -> None:
    (folder / "run.h5").write_bytes(content)
    for words in (["plot", "run.h5"], ["report", "run.h5"], ["animate", "run.h5"], ["compare", good.run, "run.h5"]):
        answer(*words, code=2)


@pytest.mark.parametrize("share", [0.02, 0.3, 0.7, 0.99])
def test_half_a_history_is_refused(share: float, good: Good, folder: Path) -> None:
    whole = good.run.read_bytes()
    (folder / "run.h5").write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(FileError, match="cannot read"):
        read_history(folder / "run.h5")
