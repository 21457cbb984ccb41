"""The surface along the tank: under it lies the liquid there is, and it ends where the channels say."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from slosh_cli.application.stop import simulate
from slosh_cli.application.train import simulate_train
from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import is_train_history, read_history, read_surface, read_train, write_history, write_train
from slosh_cli.results.result import Result
from slosh_cli.results.surface import SurfaceProfile, surface_profile
from slosh_cli.scenario import Scenario, load_scenario
from slosh_cli.scenario.train_file import load_train
from slosh_cli.section import liquid_depth, section_of

SHALLOW = ("tank.liquid.model=shallow-water", "braking.initial_speed=30 km/h")
BAFFLES = "tank.baffles=[{position: 4 m, opening: 0.2}, {position: 9.3 m, opening: 0}]"
CASES = {
    "plain": (),
    "dispersion": ("tank.liquid.dispersion=on",),
    "compartments": (BAFFLES,),
    "many cells": (BAFFLES, "tank.liquid.cells=450"),
    "many instants": ("output.interval=1 ms",),
}


def stop(*words: str) -> Result:
    return simulate(load_scenario("tank-wagon", [*SHALLOW, *words]))


@pytest.fixture(scope="module", params=CASES)
def run(request: pytest.FixtureRequest) -> Result:
    return stop(*CASES[request.param])


@pytest.fixture(scope="module")
def written(run: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("run") / "run.h5"
    write_history(run, path)
    return path


def surface(path: Path, vehicle: int | None = None) -> SurfaceProfile:
    found = read_surface(path, vehicle)
    assert found is not None
    return found


def middles_of(found: SurfaceProfile) -> np.ndarray:
    """Which places are middles of cells: walls and both sides of baffles are not."""
    _, first, count = np.unique(found.place, return_index=True, return_counts=True)
    return first[count == 1][1:-1]


def volumes(found: SurfaceProfile, scenario: Scenario, since: float, until: float) -> np.ndarray:
    """Liquid (times,) m^3 under a surface between two places, m from the front wall."""
    section, middles, edges = section_of(scenario.tank), middles_of(found), [0.0]
    for place in found.place[middles]:
        edges.append(2.0 * place - edges[-1])
    assert edges[-1] == pytest.approx(scenario.tank.length, rel=1e-9)
    inside = (found.place[middles] > since) & (found.place[middles] < until)
    depths = liquid_depth(scenario.tank) + found.rise[:, middles[inside]]
    return np.vectorize(section.area)(depths) @ np.diff(edges)[inside]


def test_under_the_surface_of_every_compartment_lies_its_liquid(run: Result, written: Path) -> None:
    found, tank = surface(written), run.scenario.tank
    section = section_of(tank)
    bulkheads = [tank.length - round(one.position * tank.liquid.cells / tank.length) / tank.liquid.cells * tank.length
                 for one in tank.baffles if one.opening == 0.0]  # fmt: skip
    walls = sorted([0.0, *bulkheads, tank.length])
    assert np.abs(found.rise).max() > 0.05
    thinned = SurfaceProfile(found.time[::40], found.place, found.rise[::40], found.standing)
    for since, until in pairwise(walls):
        still = section.area(liquid_depth(tank)) * (until - since)
        assert volumes(thinned, run.scenario, since, until) == pytest.approx(still, rel=1e-6)


def test_the_surface_ends_where_the_channels_end(run: Result, written: Path) -> None:
    found, history = surface(written), read_history(written)
    rows = np.searchsorted(history.time, found.time)
    assert np.array_equal(history.time[rows], found.time)
    assert found.rise[:, 0] == pytest.approx(history.channels["surface_front"][rows], rel=1e-6, abs=1e-7)
    assert found.rise[:, -1] == pytest.approx(history.channels["surface_rear"][rows], rel=1e-6, abs=1e-7)
    middles = middles_of(found)  # the outermost cells hold what the walls see, but for the curve of area over depth
    if run.scenario.tank.liquid.cells == 120:
        assert found.rise[:, middles[0]] == pytest.approx(found.rise[:, 0], abs=2e-3)
    assert found.time[[0, -1]] == pytest.approx(history.time[[0, -1]])
    assert found.standing == "computed"


def test_a_baffle_parts_the_surface(run: Result, written: Path) -> None:
    found, tank = surface(written), run.scenario.tank
    place, count = np.unique(found.place, return_counts=True)
    twice = sorted(round(one.position * tank.liquid.cells / tank.length) for one in tank.baffles)
    spacing = tank.length / tank.liquid.cells
    assert place[count == 2] == pytest.approx([tank.length - face * spacing for face in reversed(twice)])
    for where in place[count == 2]:
        front, rear = np.flatnonzero(found.place == where)
        assert np.array_equal(found.rise[:, front], found.rise[:, front - 1])
        assert np.array_equal(found.rise[:, rear], found.rise[:, rear + 1])


def test_the_surface_is_a_small_part_of_the_file(run: Result, written: Path) -> None:
    found = surface(written)
    assert found.time.size <= 2001
    assert found.place.size <= 212
    with h5py.File(written) as file:
        kept = file["surface_profile"]
        assert (kept.dtype, kept.compression) == (np.dtype("<f4"), "gzip")
        assert kept.id.get_storage_size() < 0.8 * 4 * kept.size
        channels = sum(8 * file[name].size for name in run.channels)
    assert written.stat().st_size < channels + 1_500_000


def test_instants_are_thinned_evenly_and_the_end_stays() -> None:
    fine = stop("output.interval=1 ms", "solver.time_limit=4.198 s")
    found = surface_profile(fine.scenario, fine.time, fine.channels, fine.wetted)
    assert found is not None
    assert fine.time.size > 4000
    assert np.diff(found.time)[:-1] == pytest.approx(4e-3)
    assert found.time[-1] == fine.time[-1]
    assert 1000 < found.time.size < 2000
    front = fine.channels["surface_front"][np.searchsorted(fine.time, found.time)]
    assert found.rise[:, 1] == pytest.approx(front, abs=2e-3)
    assert abs(front[-1]) > 0.01


def test_a_still_liquid_stays_level() -> None:
    """It rolls without resistance until the brake sets in, a tenth of a second before the end."""
    words = ("braking.onset=1.9 s", "solver.time_limit=2 s", "wagon.running_resistance.constant=0 N")
    more = ("wagon.running_resistance.linear=0 N s/m", "wagon.running_resistance.quadratic=0 N s^2/m^2")
    still = stop(*words, *more, BAFFLES)
    found = surface_profile(still.scenario, still.time, still.channels, still.wetted)
    assert found is not None
    assert np.abs(found.rise[found.time < 1.9]).max() < 1e-6
    assert np.abs(found.rise[-1]).max() > 1e-3


def test_a_liquid_against_the_roof_is_cut_off_there(tmp_path: Path) -> None:
    full = stop("tank.fill=0.95", "braking.torque=8 kN m")
    write_history(full, tmp_path / "run.h5")
    room = full.surface_limit_m
    assert surface(tmp_path / "run.h5").rise.max() == pytest.approx(room, rel=1e-6)


@pytest.mark.parametrize("model", ["modal", "rigid"])
def test_a_load_with_computed_modes_has_its_surface(model: str, tmp_path: Path) -> None:
    words = (f"tank.liquid.model={model}", "braking.initial_speed=30 km/h", "output.interval=0.1 s")
    found = simulate(load_scenario("tank-wagon", words))
    write_history(found, tmp_path / "run.h5")
    profile = surface(tmp_path / "run.h5")
    assert profile.standing == "computed"
    assert profile.rise[:, 0] == pytest.approx(found.channels["surface_front"], abs=1e-6)
    assert profile.rise[:, -1] == pytest.approx(found.channels["surface_rear"], abs=1e-6)
    assert (np.abs(profile.rise).max() > 0.05) == (model == "modal")


def test_instants_that_are_not_finite_are_left_out() -> None:
    found = simulate(load_scenario("tank-wagon", ("braking.initial_speed=30 km/h", "output.interval=0.1 s")))
    spoiled = {name: values.copy() for name, values in found.channels.items()}
    for values in spoiled.values():
        values[-1] = np.nan
    profile = surface_profile(found.scenario, found.time, spoiled)
    assert profile is not None
    assert np.array_equal(profile.time, found.time[:-1])


TRAIN = """format: 1
name: three
vehicles:
  - {{scenario: tank-wagon, set: {{tank.liquid.model: shallow-water, braking.torque: 2 kN m}}}}
{more}
coupling: screw
braking: {{initial_speed: 15 km/h, onset: 0.5 s}}
output: {{interval: 10 ms}}
"""
OTHERS = """  - {scenario: tank-wagon, set: {braking.torque: 2 kN m}}
  - {scenario: tank-wagon, set: {tank.liquid.model: rigid, braking.torque: 2 kN m}}
"""


def train(folder: Path, more: str = "") -> Path:
    (folder / "train.yaml").write_text(TRAIN.format(more=more), encoding="utf-8")
    write_train(simulate_train(load_train(folder / "train.yaml")), folder / "train.h5")
    return folder / "train.h5"


def test_the_surface_of_a_train_of_one_is_that_of_the_wagon(tmp_path: Path) -> None:
    path = train(tmp_path)
    write_history(simulate(load_train(tmp_path / "train.yaml").vehicles[0]), tmp_path / "run.h5")
    one, other = surface(tmp_path / "run.h5"), surface(path, 1)
    for name in ("time", "place", "rise"):
        assert np.array_equal(getattr(one, name), getattr(other, name))


def test_every_vehicle_of_a_train_has_its_surface(tmp_path: Path) -> None:
    path = train(tmp_path, OTHERS)
    assert is_train_history(path)
    held = read_train(path)
    for number, vehicle in enumerate(held.vehicles, 1):
        found = surface(path, number)
        assert "surface_profile" not in vehicle.channels
        rows = np.searchsorted(held.time, found.time)
        for end, name in ((0, "surface_front"), (-1, "surface_rear")):
            assert found.rise[:, end] == pytest.approx(vehicle.channels[name][rows], rel=1e-6, abs=1e-7)
        assert (np.abs(found.rise).max() > 0.02) == (number < 3)
    first = surface(path, 1)
    tank = load_train(tmp_path / "train.yaml").vehicles[0]
    thinned = SurfaceProfile(first.time[::20], first.place, first.rise[::20], first.standing)
    still = section_of(tank.tank).area(liquid_depth(tank.tank)) * tank.tank.length
    assert volumes(thinned, tank, 0.0, np.inf) == pytest.approx(still, rel=1e-6)
    assert first.time.size <= 501
    with pytest.raises(FileError, match="say which of 3 vehicles"):
        read_surface(path)
    with pytest.raises(FileError, match="has no vehicle 4, but 3 vehicles"):
        read_surface(path, 4)


def put(name: str, value: Any) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        del file[name]
        if value is not None:
            file[name] = value

    return change


def spoil(name: str, place: Any, value: float) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        file[name][place] = value

    return change


SPOILED: dict[str, tuple[Callable[[h5py.File], Any], str]] = {
    "no numbers": (spoil("surface_profile", (3, 4), np.nan), "surface_profile must be finite, and within 1000 m"),
    "out of this world": (spoil("surface_profile", (3, 4), 1e6), "surface_profile must be finite, and within 1000 m"),
    "no times": (put("surface_profile_time", None), "surface along the tank lacks surface_profile_time"),
    "no rises": (put("surface_profile", None), "surface along the tank lacks surface_profile"),
    "another shape": (put("surface_profile", np.zeros((3, 4))), "surface_profile must be numbers, as many as its"),
    "texts": (put("surface_profile", "none"), "surface_profile must be numbers, as many as its"),
    "a plane of places": (put("surface_profile_place", np.zeros((2, 2))), "surface_profile_place must be a column"),
    "time stands": (spoil("surface_profile_time", 5, 0.0), "surface_profile_time must be finite and rise"),
    "places fall": (spoil("surface_profile_place", 5, 0.0), "surface_profile_place must be finite and must not fall"),
    "another standing": (
        lambda file: file["surface_profile"].attrs.modify("standing", "guessed"),
        "surface_profile must be computed or assumed",
    ),
    "no standing": (lambda file: file["surface_profile"].attrs.pop("standing"), "must be computed or assumed"),
}


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sound") / "run.h5"
    write_history(stop("output.interval=0.1 s"), path)
    return path


@pytest.mark.parametrize(("change", "message"), SPOILED.values(), ids=SPOILED)
def test_a_damaged_surface_is_refused(
    sound: Path, tmp_path: Path, change: Callable[[h5py.File], Any], message: str
) -> None:
    path = tmp_path / "run.h5"
    path.write_bytes(sound.read_bytes())
    with h5py.File(path, "r+") as file:
        change(file)
    with pytest.raises(FileError, match=message):
        read_surface(path)
    assert read_history(path).status == "stopped"


def test_a_run_of_an_earlier_version_has_no_surface(sound: Path, tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    path.write_bytes(sound.read_bytes())
    with h5py.File(path, "r+") as file:
        for name in ("surface_profile", "surface_profile_time", "surface_profile_place"):
            del file[name]
    assert read_surface(path) is None
