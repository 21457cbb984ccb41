"""Replays of shallow-water stops and of a tank alone: what is drawn is what the file holds."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from PIL import Image

from slosh_cli.application.excitation import excite
from slosh_cli.application.keeping import Keeping
from slosh_cli.application.replay import animate
from slosh_cli.application.reporting import write_report
from slosh_cli.application.stop import simulate
from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import write_history
from slosh_cli.scenario import load_scenario

SHALLOW = ("tank.liquid.model=shallow-water", "tank.baffles=[{position: 10 m, opening: 0}]")
LIQUID = (0x7F, 0xB3, 0xD9)


def test_the_page_of_a_shallow_water_stop_shows_its_surface(tmp_path: Path) -> None:
    words = (*SHALLOW, "braking.initial_speed=30 km/h", "output.interval=50 ms")
    write_history(simulate(load_scenario("tank-wagon", words)), tmp_path / "run.h5")
    page = write_report(tmp_path / "run.h5").read_text(encoding="utf-8")
    assert "that of the cells of the shallow-water liquid" in page
    data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)[1])
    rise, place = np.array(data["rise"]), np.array(data["place"])
    assert rise.shape == (len(data["time"]), place.size)
    for end, walls in ((0, data["walls"][0]), (-1, data["walls"][1])):
        assert rise[:, end] == pytest.approx(np.array(walls), abs=6e-4)
    bulkhead = np.flatnonzero(np.diff(place) == 0.0)
    assert data["wagon"]["length"] - place[bulkhead] == pytest.approx([10.0], abs=0.07)
    assert np.abs(rise[:, bulkhead + 1] - rise[:, bulkhead]).max() > 0.05


@pytest.fixture(scope="module", params=["modal", "shallow-water"])
def excited(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("excited")
    words = (f"tank.liquid.model={request.param}", *(SHALLOW[1:] if request.param != "modal" else ()))
    found = excite(load_scenario("tank-wagon", words), "0.8 m/s^2", duration="2 s", interval="20 ms")
    found.keep(folder, Keeping())
    return folder / "excite.h5"


def blue(film: Image.Image, frame: int) -> np.ndarray:
    """Pixels of liquid in each column of a frame."""
    film.seek(frame)
    pixels = np.asarray(film.convert("RGB"), dtype=int)
    return (np.abs(pixels - LIQUID).max(axis=2) < 12).sum(axis=0)


def test_a_tank_alone_is_animated(excited: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slosh_cli.report.animation._FRAMES", 4)
    with Image.open(animate(excited, tmp_path / "tank.gif")) as film:
        assert film.n_frames == 4
        still, swung = blue(film, 0), blue(film, 3)
    inside = np.flatnonzero(still > 0.9 * still.max())
    rear, front = inside[:20], inside[-20:]
    assert still[front].mean() == pytest.approx(still[rear].mean(), abs=1.5)
    with h5py.File(excited) as file:
        room, rise = still.max() / 1.5, file["surface_front"][-1] - file["surface_rear"][-1]
    assert swung[front].mean() - swung[rear].mean() == pytest.approx(room * rise, abs=5.0)
    assert rise > 0.2


def put(name: str, value: Any) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        del file[name]
        if value is not None:
            file[name] = value

    return change


def all_profiles(file: h5py.File) -> None:
    for name in ("profile_time", "profile_place", "profile_rise"):
        del file[name]


SPOILED: dict[str, tuple[Callable[[h5py.File], Any], str]] = {
    "of an earlier version": (all_profiles, "has no surface along the tank.*run `slosh tank excite` again"),
    "without places": (put("profile_place", None), "its surface along the tank lacks profile_place"),
    "of another shape": (put("profile_rise", np.zeros((2, 2))), "its profile_rise must be numbers, as many as"),
    "without force": (put("liquid_force", None), "it lacks the channels liquid_force"),
    "a short force": (put("liquid_force", np.zeros(3)), "liquid_force is not as long as the time axis"),
    "no deceleration": (put("deceleration", np.full(101, np.nan)), "its channel deceleration must be finite"),
    "of another format": (lambda file: file.attrs.modify("excitation_format_version", 9), "that this version can read"),
    "nameless": (lambda file: file.attrs.pop("name"), "cannot read"),
    "without a scenario": (put("scenario", None), "it lacks the text scenario"),
}


@pytest.mark.parametrize(("change", "message"), SPOILED.values(), ids=SPOILED)
def test_a_tank_without_what_is_drawn_is_refused(
    excited: Path, tmp_path: Path, change: Callable[[h5py.File], Any], message: str
) -> None:
    path = tmp_path / "excite.h5"
    path.write_bytes(excited.read_bytes())
    with h5py.File(path, "r+") as file:
        change(file)
    with pytest.raises(FileError, match=message):
        animate(path)
    assert not (tmp_path / "animation.gif").exists()
