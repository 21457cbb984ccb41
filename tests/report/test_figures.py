"""The figures of a run: whole, legible without colour, and true to the channels."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from slosh_cli.report import figures
from slosh_cli.report.figures import FIGURES, draw_run
from slosh_cli.results.files import FileError
from slosh_cli.results.hdf5 import read_history, write_history
from slosh_cli.results.result import Result, Status
from slosh_cli.results.stored import NEEDED

NAMES = ["contact_forces", "speed_distance", "wheel_speed", "slosh"]


@pytest.fixture(scope="module")
def drawn(liquid: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("figures")
    draw_run(liquid, folder)
    return folder


def test_every_figure_comes_as_png_and_svg_and_nothing_else(liquid: Result, tmp_path: Path) -> None:
    files = draw_run(liquid, tmp_path)
    assert {file.name for file in files} == {f"{name}.{suffix}" for name in NAMES for suffix in ("png", "svg")}
    assert set(files) == set(tmp_path.iterdir())


def test_a_solid_load_has_no_slosh_figure(solid: Result, tmp_path: Path) -> None:
    assert {file.stem for file in draw_run(solid, tmp_path, formats=("svg",))} == {*NAMES} - {"slosh"}


@pytest.mark.parametrize("name", NAMES)
def test_a_png_is_large_and_has_something_on_it(drawn: Path, name: str) -> None:
    pixels = imread(drawn / f"{name}.png")
    height, width = pixels.shape[:2]
    assert width >= 1500  # ten inches at 150 dots per inch
    assert height >= 800
    inked = np.any(pixels[..., :3] < 0.97, axis=2)
    assert 0.01 < inked.mean() < 0.5
    columns_with_ink = inked[height // 4 : -height // 4].any(axis=0).mean()
    assert columns_with_ink > 0.5


@pytest.mark.parametrize("name", NAMES)
def test_an_svg_names_the_run_and_warns(drawn: Path, liquid: Result, name: str) -> None:
    text = (drawn / f"{name}.svg").read_text(encoding="utf-8")
    assert "paper-80-liquid: V₀ = 80 km/h, 5 kN m per wheel, liquid (modal)" in text
    assert liquid.warnings[0] in text


@pytest.mark.parametrize("name", NAMES)
def test_axes_carry_quantity_and_unit(liquid: Result, name: str) -> None:
    *upper, lowest = FIGURES[name](liquid).axes
    assert lowest.get_xlabel() == "time / s"
    for axes in (*upper, lowest):
        label = axes.get_ylabel()
        assert " / " in label or label == "locked\nwheel"


def test_wheels_differ_in_line_style_and_in_lightness() -> None:
    lightness = [
        float(np.dot(to_rgb(style["color"]), (0.299, 0.587, 0.114))) for style in figures._WHEEL_STYLES.values()
    ]
    assert np.diff(sorted(lightness)).min() > 0.07
    assert abs(lightness[0] - lightness[1]) > 0.3  # the pair in one bogie runs side by side
    assert abs(lightness[2] - lightness[3]) > 0.3
    assert len({str(style["linestyle"]) for style in figures._WHEEL_STYLES.values()}) == 4


def test_contact_forces_shows_four_normal_forces_in_kilonewtons(liquid: Result) -> None:
    lines = FIGURES["contact_forces"](liquid).axes[0].lines[:4]
    for i, line in enumerate(lines, start=1):
        np.testing.assert_allclose(line.get_ydata(), liquid.channels[f"wheel_{i}_normal_force"] / 1e3)


def test_the_acceleration_shown_is_the_cars(liquid: Result) -> None:
    axes = FIGURES["speed_distance"](liquid).axes[1]
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), liquid.channels["car_acceleration"])


def test_speed_is_shown_in_kilometres_per_hour(liquid: Result) -> None:
    axes = FIGURES["speed_distance"](liquid).axes[0]
    assert axes.lines[0].get_ydata()[0] == pytest.approx(80.0)


def test_locked_stretches_are_those_in_which_the_wheel_stands(liquid: Result) -> None:
    assert liquid.locked_stretches(1) == []
    ((start, duration),) = liquid.locked_stretches(4)
    assert start == pytest.approx(liquid.time[-1] - 1.25, abs=0.02)
    assert duration == pytest.approx(1.2, abs=0.03)


def test_a_wheel_locked_to_the_end_is_shown_to_the_end(liquid: Result) -> None:
    speed = np.where(liquid.time > 5.0, 0.0, liquid.channels["wheel_1_speed"])
    run = replace(liquid, channels={**liquid.channels, "wheel_1_speed": speed})
    ((start, duration),) = run.locked_stretches(1)
    assert start + duration == pytest.approx(liquid.time[-1])


def test_the_figure_shades_the_locked_wheel_only(liquid: Result) -> None:
    bars = FIGURES["wheel_speed"](liquid).axes[2].collections
    assert [len(bar.get_paths()) for bar in bars] == [0, 0, 0, 1]


def test_wheels_of_a_standing_train_are_not_locked(liquid: Result) -> None:
    standing = {name: np.where(liquid.time > 8.0, 0.0, liquid.channels[name]) for name in ("speed", "wheel_2_speed")}
    assert replace(liquid, channels=liquid.channels | standing).locked_stretches(2) == []


def test_the_figure_says_when_no_wheel_locks(liquid: Result, solid: Result) -> None:
    for run, says_so in ((solid, True), (liquid, False)):
        texts = [text.get_text() for text in FIGURES["wheel_speed"](run).axes[2].texts]
        assert ("no wheel locks" in texts) is says_so


def test_the_roof_is_drawn_at_the_room_above_the_surface(liquid: Result) -> None:
    lines = {line.get_label(): line for line in FIGURES["slosh"](liquid).axes[0].lines}
    roof = lines["roof, 1.50 m above still level"]
    assert set(roof.get_ydata()) == {1.5}


def test_without_a_known_roof_none_is_drawn(liquid: Result) -> None:
    labels = [str(line.get_label()) for line in FIGURES["slosh"](replace(liquid, surface_limit_m=np.nan)).axes[0].lines]
    assert not any("roof" in label for label in labels)


def test_every_mode_is_drawn(liquid: Result) -> None:
    second = {**liquid.channels, "slosh_2_amplitude": 0.1 * liquid.channels["slosh_1_amplitude"]}
    labels = [line.get_label() for line in FIGURES["slosh"](replace(liquid, channels=second)).axes[1].lines]
    assert labels[:2] == ["mode 1", "mode 2"]


def test_a_run_that_did_not_stop_says_so(liquid: Result) -> None:
    run = replace(liquid, status=Status.PITCH_LIMIT, reason="car pitch 0.1 rad at 3 s", warnings=())
    assert figures._caption(run) == "The run ended as pitch-limit: car pitch 0.1 rad at 3 s"


def test_a_long_name_is_cut(liquid: Result) -> None:
    scenario = liquid.scenario.model_copy(update={"name": "wagon " * 40})
    assert len(figures._conditions(replace(liquid, scenario=scenario))) < 110


def test_text_that_looks_like_mathematics_stays_text(liquid: Result, tmp_path: Path) -> None:
    scenario = liquid.scenario.model_copy(update={"name": r"a$b_{$\frac"})
    run = replace(liquid, scenario=scenario, warnings=(r"costs $5 and \alpha$",))
    draw_run(run, tmp_path, formats=("svg",))
    text = (tmp_path / "slosh.svg").read_text(encoding="utf-8")
    assert r">a$b_{$\frac: V₀" in text
    assert r">Warning: costs $5 and \alpha$</text>" in text


def test_a_run_of_a_single_row_can_be_drawn(liquid: Result, tmp_path: Path) -> None:
    run = replace(
        liquid,
        time=liquid.time[:1],
        channels={name: values[:1] for name, values in liquid.channels.items()},
        status=Status.FAILED,
        reason="no equilibrium",
        braking_distance_m=None,
    )
    assert len(draw_run(run, tmp_path, formats=("png",))) == 4


def test_the_channels_that_a_history_must_have_are_all_that_figures_need(liquid: Result, tmp_path: Path) -> None:
    bare = replace(liquid, channels={name: liquid.channels[name] for name in NEEDED})
    assert len(draw_run(bare, tmp_path, formats=("svg",))) == 4
    for name in NEEDED:
        with pytest.raises(KeyError):
            draw_run(
                replace(bare, channels={other: bare.channels[other] for other in NEEDED - {name}}), tmp_path, ("svg",)
            )


def test_drawing_from_the_history_file_gives_the_same_figures(liquid: Result, drawn: Path, tmp_path: Path) -> None:
    write_history(liquid, tmp_path / "run.h5")
    draw_run(read_history(tmp_path / "run.h5"), tmp_path)
    for name in NAMES:
        assert (tmp_path / f"{name}.svg").read_bytes() == (drawn / f"{name}.svg").read_bytes()
        np.testing.assert_array_equal(imread(tmp_path / f"{name}.png"), imread(drawn / f"{name}.png"))


def test_a_figure_that_fails_midway_leaves_the_old_one(
    liquid: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw_run(liquid, tmp_path)
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}

    def fail(_: Result) -> None:
        raise RuntimeError("halfway")

    monkeypatch.setattr(figures, "FIGURES", {"contact_forces": fail})
    with pytest.raises(RuntimeError, match="halfway"):
        draw_run(liquid, tmp_path)
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_a_folder_that_cannot_be_written_is_the_users_matter(liquid: Result, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot write"):
        draw_run(liquid, tmp_path / "file")


def test_drawing_neither_heeds_nor_changes_the_settings_of_matplotlib(
    liquid: Result, drawn: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(mpl.rcParams, "font.size", 4.0)
    monkeypatch.setitem(mpl.rcParams, "axes.facecolor", "red")
    draw_run(liquid, tmp_path, formats=("svg",))
    assert mpl.rcParams["font.size"] == 4.0
    assert mpl.rcParams["axes.facecolor"] == "red"
    assert (tmp_path / "slosh.svg").read_bytes() == (drawn / "slosh.svg").read_bytes()


def test_drawing_needs_no_display_and_no_pyplot() -> None:
    code = "import sys, slosh_cli.report.figures; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
