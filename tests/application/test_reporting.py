"""The report of a run or a study: what it embeds is what the file holds, and whatever a scenario says stays text."""

import html
import json
import re
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from PIL import Image

from slosh_cli.application.replay import animate
from slosh_cli.application.reporting import write_report
from slosh_cli.application.stop import simulate
from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import read_surface, write_history
from slosh_cli.scenario import load_scenario

EVIL = "</script><script>alert(1)</script>"


@pytest.fixture(scope="module")
def run_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    scenario = load_scenario("paper-80-liquid", ["output.interval=0.05 s", f'description="{EVIL}"'])
    write_history(simulate(scenario), folder / "run.h5")
    return folder / "run.h5"


def data_of(page: str) -> dict:
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)[1])


def test_curves_of_the_page_are_rows_of_the_file(run_file: Path) -> None:
    found = data_of(write_report(run_file).read_text(encoding="utf-8"))
    with h5py.File(run_file) as file:
        rows = np.searchsorted(file["time"][:], np.array(found["time"]) - 1e-4)
        for chart in found["charts"]:
            for line in chart["lines"]:
                values = file[line["channel"]][:] * line["scale"]
                assert line["values"] == pytest.approx(values[rows], rel=6e-7, abs=1e-12)
                assert max(line["values"]) == pytest.approx(values.max(), rel=6e-7, abs=1e-12)
                assert min(line["values"]) == pytest.approx(values.min(), rel=6e-7, abs=1e-12)


def test_what_a_scenario_says_stays_text(run_file: Path) -> None:
    page = write_report(run_file).read_text(encoding="utf-8")
    assert EVIL not in page
    assert html.escape(EVIL) in page
    assert len(re.findall(r"<script", page)) == 2
    assert not re.search(r"""(src|href)=["']?(https?:)?//""", page)


def test_inputs_tell_their_standing(run_file: Path, tmp_path: Path) -> None:
    file = Path(shutil.copy(run_file, tmp_path))
    with h5py.File(file, "r+") as held:
        text = held["scenario"].asstr()[()]
        del held["scenario"]
        held["scenario"] = text + "presets: {contact.adhesion: default, track.rail.youngs_modulus: soft-track}\n"
    page = write_report(file).read_text(encoding="utf-8")
    cells = r"<td>contact.adhesion.mu0</td><td>0.55</td><td>default</td><td>assumed: usual</td>"
    assert re.search(cells, page)
    assert "<td>tank.length</td><td>15.5 m</td><td>yours</td><td></td>" in page
    assert "<td>limits.axle_load</td><td>22500 kg</td><td>default</td><td>the program&#39;s own</td>" in page
    assert "preset soft-track" in page
    assert "preset soft-track" not in write_report(run_file).read_text(encoding="utf-8")


def test_the_surface_along_the_tank_ends_at_the_walls(run_file: Path) -> None:
    profile = read_surface(run_file)
    assert profile is not None
    with h5py.File(run_file) as file:
        time, front, rear = (file[name][:] for name in ("time", "surface_front", "surface_rear"))
        assert [scale.name for axis in file["surface_profile"].dims for scale in axis.values()] == [
            "/surface_profile_time",
            "/surface_profile_place",
        ]
    rows = np.searchsorted(time, profile.time)
    assert np.abs(front).max() > 0.1
    assert profile.rise[:, 0] == pytest.approx(front[rows], rel=1e-6, abs=1e-6)
    assert profile.rise[:, -1] == pytest.approx(rear[rows], rel=1e-6, abs=1e-6)
    assert np.trapezoid(profile.rise, profile.place, axis=1) == pytest.approx(np.zeros(rows.size), abs=1e-5)


TABLE = "v0_km_h,torque_kN_m,braking_distance_m,status,max_wheel_unloading\n"


def test_a_study_has_its_worst_cases(tmp_path: Path) -> None:
    (tmp_path / "braking_distance.csv").write_text(TABLE + "80,8,148.5,stopped,0.3\n80,<b>,99,stopped,0.75\n")
    page = write_report(tmp_path).read_text(encoding="utf-8")
    assert "<td>148.5</td><td>m</td><td>v0_km_h 80, torque_kN_m 8</td>" in page
    assert "<td>0.75</td><td>1</td><td>v0_km_h 80, torque_kN_m &lt;b&gt;</td>" in page
    assert "Download CSV" in page


def test_the_worst_case_tells_what_was_varied_and_digits_are_few(tmp_path: Path) -> None:
    """A key of one's own stands after the status. The table shows six digits and keeps all for the download."""
    head = "v0_km_h,torque_kN_m,liquid,braking_distance_m,status,tank_fill,ratio_to_solid,max_wheel_unloading\n"
    rows = "100.0,2.5,rigid,299.2456420844567,stopped,0.2,,0.2\n100.0,2.5,rigid,400,stopped,0.9,1.1,0.1\n"
    (tmp_path / "braking_distance.csv").write_text(head + rows)
    page = write_report(tmp_path).read_text(encoding="utf-8")
    assert "<td>400</td><td>m</td><td>v0_km_h 100, torque_kN_m 2.5, liquid rigid, tank_fill 0.9</td>" in page
    assert '<td title="299.2456420844567">299.246</td>' in page


@pytest.mark.parametrize("table", [None, "", TABLE, "a,b\n1,2\n", TABLE + "80,8\n"])
def test_a_folder_without_the_rows_of_a_study_is_refused(tmp_path: Path, table: str | None) -> None:
    if table is not None:
        (tmp_path / "braking_distance.csv").write_text(table)
    with pytest.raises(FileError, match=r"braking_distance\.csv"):
        write_report(tmp_path)
    assert not (tmp_path / "report.html").exists()


def test_damaged_histories_are_refused(run_file: Path, tmp_path: Path) -> None:
    def spoiled(name: str, spoil: object) -> Path:
        copy = tmp_path / f"{name}.h5"
        copy.write_bytes(run_file.read_bytes())
        with h5py.File(copy, "r+") as file:
            spoil(file)  # type: ignore[operator]
        return copy

    def all_nan(file: h5py.File) -> None:
        file["speed"][:] = np.nan

    def no_channel(file: h5py.File) -> None:
        del file["wheel_1_normal_force"]

    def other_kind(file: h5py.File) -> None:
        del file.attrs["format_version"]

    def bent_surface(file: h5py.File) -> None:
        file["surface_profile"][0, 0] = np.nan

    for spoil in (all_nan, no_channel, other_kind, bent_surface):
        with pytest.raises(FileError):
            write_report(spoiled(spoil.__name__, spoil), tmp_path / "page.html")
    with pytest.raises(FileError, match="its own source"):
        write_report(run_file, run_file)
    assert not (tmp_path / "page.html").exists()


def test_the_animation_moves(run_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slosh_cli.report.animation._FRAMES", 12)
    with Image.open(animate(run_file, tmp_path / "stop.gif")) as film:
        assert film.n_frames == 12
        pictures = []
        for frame in (0, 4, 11):
            film.seek(frame)
            pictures.append(film.convert("RGB").tobytes())
    assert len(set(pictures)) == 3


@pytest.mark.parametrize("name", ["stop.mp4", "stop.avi"])
def test_no_animation_without_its_writer(
    run_file: Path, tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slosh_cli.report.animation.FFMpegWriter.isAvailable", lambda: False)
    with pytest.raises(FileError, match=name):
        animate(run_file, tmp_path / name)
    assert not list(tmp_path.iterdir())
