"""The figures of a study show every stop as what it is."""

import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from PIL import Image

from slosh_cli.report import figures
from slosh_cli.report.study_answers import Answered
from slosh_cli.report.study_figures import OUTSIDE, draw_study, study_figure
from slosh_cli.report.study_pages import Mark, Page, StopsPanel, pages
from slosh_cli.results.result import Status
from slosh_cli.study.build import Wishes, build

DISTANCE = Answered("Braking distance", "braking_distance", "braking distance / m", "m", lambda _: [])
STOPPED, PITCH_LIMIT = Status.STOPPED, Status.PITCH_LIMIT


def page(**changes: Any) -> Page:
    """Two panels: a liquid with a gap, out of linear theory from the third stop on; a solid."""
    liquid = [
        Mark(2.5, 430.0, STOPPED, True), Mark(5.0, 218.0, STOPPED, True), Mark(7.5, 155.0, STOPPED, False),
        Mark(10.0, None, PITCH_LIMIT, False), Mark(12.5, 101.0, STOPPED, False), Mark(15.0, 103.0, STOPPED, False),
    ]  # fmt: skip
    solid = [Mark(2.5 * k, 440.0 / k, STOPPED, True) for k in range(1, 7)]
    panels = [
        StopsPanel("80 km/h", {"modal": liquid, "rigid": solid}),
        StopsPanel("160 km/h", {"modal": liquid, "rigid": solid}),
    ]
    given: dict[str, Any] = {
        "shown": DISTANCE, "conditions": "a wagon", "label": "torque / kN m", "unit": "kN m",
        "best": "most effective torque", "panels": panels,
    }  # fmt: skip
    return Page(**(given | changes))


def lines(axes: Axes, color: str, marker: str) -> list[Line2D]:
    return [line for line in axes.lines if line.get_color() == color and line.get_marker() == marker]


BLUE, ORANGE = "#08306b", "#c1440e"


def places(found: list[Line2D], **look: Any) -> list[tuple[float, float]]:
    chosen = [line for line in found if all(getattr(line, f"get_{key}")() == value for key, value in look.items())]
    return [(float(x), float(y)) for line in chosen for x, y in zip(*line.get_data(), strict=True)]


def test_a_stop_outside_linear_theory_is_hollow_one_within_is_filled() -> None:
    axes = study_figure(page()).axes[0]
    circles = [line for line in lines(axes, BLUE, "o") if line.get_markersize() < 10]
    assert places(circles, markerfacecolor=BLUE) == [(2.5, 430.0), (5.0, 218.0)]
    assert places(circles, markerfacecolor="white") == [(7.5, 155.0), (12.5, 101.0), (15.0, 103.0)]
    assert len(places(lines(axes, ORANGE, "s"), markerfacecolor=ORANGE)) == 6


def test_no_line_leads_to_a_stop_without_an_answer_and_dotted_ones_to_those_outside_linear_theory() -> None:
    axes = study_figure(page()).axes[0]
    ways = {line.get_linestyle(): line for line in lines(axes, BLUE, "None") if len(line.get_xdata())}
    assert set(ways) == {"-", "--"}
    assert list(ways["-"].get_xdata()[1:]) == [2.5, 5.0]
    dotted = np.asarray(ways["--"].get_xdata(), dtype=float)
    assert [list(stretch) for stretch in np.split(dotted, np.flatnonzero(np.isnan(dotted)))[1:]] == [
        [pytest.approx(np.nan, nan_ok=True), 5.0, 7.5],
        [pytest.approx(np.nan, nan_ok=True), 12.5, 15.0],
    ]
    assert OUTSIDE != "-"


def test_the_legend_of_three_models_stays_on_the_page() -> None:
    given = page()
    panels = [StopsPanel(one.title, {**one.curves, "shallow-water": one.curves["rigid"]}) for one in given.panels]
    figure = study_figure(page(panels=panels))
    (legend,) = figure.legends
    box = legend.get_window_extent()
    assert [text.get_text() for text in legend.get_texts()][-1] == "most effective torque"
    assert figure.bbox.x0 <= box.x0
    assert box.x1 <= figure.bbox.x1
    assert box.y0 >= max(axes.title.get_window_extent().y1 for axes in figure.axes)


def test_a_stop_without_an_answer_is_a_cross_at_the_top_in_the_colour_of_its_curve() -> None:
    axes = study_figure(page()).axes[0]
    (cross,) = lines(axes, BLUE, "x")
    assert list(cross.get_xdata()) == [10.0]
    assert 0.9 < cross.get_ydata()[0] < 1.0
    assert cross.get_transform() == axes.get_xaxis_transform()
    assert lines(axes, ORANGE, "x") == []


def test_the_most_effective_torque_of_every_curve_is_ringed_and_named() -> None:
    axes = study_figure(page()).axes[0]
    rings = {line.get_color(): line.get_data() for line in axes.lines if line.get_markersize() > 12}
    assert {color: (data[0][0], data[1][0]) for color, data in rings.items()} == {
        BLUE: (12.5, 101.0),
        ORANGE: (15.0, pytest.approx(440.0 / 6)),
    }
    assert {text.get_text() for text in axes.texts} == {"12.5 kN m\n101 m", "15 kN m\n73.33 m"}


def test_the_legend_names_what_occurs_and_nothing_else() -> None:
    def legend(shown: Page) -> list[str]:
        return [text.get_text() for text in study_figure(shown).legends[0].get_texts()]

    assert legend(page()) == [
        "liquid (modal)", "equivalent solid", "outside linear theory", "pitch-limit", "most effective torque",
    ]  # fmt: skip
    fine = StopsPanel("", {"rigid": [Mark(1.0, 5.0, STOPPED, True), Mark(2.0, 4.0, STOPPED, True)]})
    assert legend(page(panels=[fine])) == ["equivalent solid", "most effective torque"]


def test_a_panel_without_any_answer_says_so() -> None:
    nothing = StopsPanel(
        "80 km/h", {"modal": [Mark(1.0, None, PITCH_LIMIT, False), Mark(2.0, None, PITCH_LIMIT, False)]}
    )
    (axes,) = study_figure(page(panels=[nothing])).axes
    assert [text.get_text() for text in axes.texts] == ["no stop has an answer"]
    assert len(lines(axes, BLUE, "x")) == 2


def test_curves_differ_in_grey_in_line_and_in_marker() -> None:
    from slosh_cli.report.study_figures import LOOKS

    greys = [
        sum(w * int(look["color"][k : k + 2], 16) for w, k in ((0.299, 1), (0.587, 3), (0.114, 5))) for look in LOOKS
    ]
    assert min(abs(a - b) for i, a in enumerate(greys[:2]) for b in greys[:i]) > 40
    assert len({look["marker"] for look in LOOKS}) == len({str(look["linestyle"]) for look in LOOKS}) == len(LOOKS)


def test_files_are_fit_for_print(tmp_path: Path) -> None:
    png, svg = draw_study([page()], tmp_path)
    assert (png.name, svg.name) == ("braking_distance.png", "braking_distance.svg")
    width, height = Image.open(png).size
    assert width / 300 > 6.5  # inches at 300 dots each: the width of a printed page
    assert 1.2 < width / height < 2.2
    text = " ".join("".join(node.itertext()) for node in ElementTree.parse(svg).iter() if node.tag.endswith("text"))
    for words in ("braking distance / m", "torque / kN m", "80 km/h", "160 km/h", "pitch-limit"):
        assert words in text


def test_the_same_study_gives_the_same_files(tmp_path: Path) -> None:
    first = [file.read_bytes() for file in draw_study([page()], tmp_path / "a")]
    assert [file.read_bytes() for file in draw_study([page()], tmp_path / "b")] == first


def test_several_pages_are_numbered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figures, "RESOLUTION", 25)
    files = draw_study([page(), page()], tmp_path)
    assert [file.name for file in files] == [
        "braking_distance_1.png", "braking_distance_1.svg", "braking_distance_2.png", "braking_distance_2.svg",
    ]  # fmt: skip


def test_figures_of_an_earlier_study_that_had_more_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figures, "RESOLUTION", 25)
    others = ["notes.png", "braking_distance_of_mine.png", "braking_distance.csv"]
    for name in (*others, "braking_distance_1.png", "braking_distance_12.svg"):
        (tmp_path / name).touch()
    draw_study([page()], tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {*others, "braking_distance.png", "braking_distance.svg"}


def shown(wishes: Wishes) -> list[tuple[str, str, list[str]]]:
    """Per figure of a study: its conditions, its label, the titles of its panels."""
    study = build(wishes)
    rows = []
    for index in range(study.size):
        values = {axis.key: axis.plain(place) for axis, place in zip(study.axes, study.positions(index), strict=True)}
        row = study.conditions(index) | {"status": "stopped", "braking_distance_m": 100.0 + index}
        units = {"tank.fill": "tank_fill", "contact.adhesion": "contact_adhesion",
                 "wagon.pivot_spacing": "wagon_pivot_spacing_m"}  # fmt: skip
        rows.append(row | {units[key]: value for key, value in values.items() if key in units})
    return [(one.conditions, one.label, [panel.title for panel in one.panels]) for one in pages(study, rows)]


def test_figure_3_has_a_panel_per_speed() -> None:
    assert shown(Wishes()) == [
        ("paper-wagon: horizontal-cylinder tank, fill 0.5, dry rail", "brake torque per wheel / kN m",
         ["80 km/h", "160 km/h"])
    ]  # fmt: skip


def test_what_varies_beside_speed_and_torque_makes_figures() -> None:
    found = shown(Wishes(speeds="80,160", torques="5,10", vary=["tank.fill=0.3,0.5"]))
    assert [conditions.split(":")[1].split(",")[0].strip() for conditions, _, _ in found] == [
        "tank.fill 0.3",
        "tank.fill 0.5",
    ]
    assert [panels for _, _, panels in found] == [["80 km/h", "160 km/h"]] * 2


def test_many_speeds_share_as_few_figures_as_there_must_be() -> None:
    found = shown(Wishes(speeds="10:80:10", torques="5,10"))
    assert [panels for _, _, panels in found] == [
        ["10 km/h", "20 km/h", "30 km/h", "40 km/h"], ["50 km/h", "60 km/h", "70 km/h", "80 km/h"],
    ]  # fmt: skip


def test_a_wide_figure_has_no_more_pixels_across(tmp_path: Path) -> None:
    six = page(panels=[StopsPanel(f"{speed} km/h", page().panels[0].curves) for speed in range(6)])
    (png, _) = draw_study([six], tmp_path)
    assert Image.open(png).size[0] == pytest.approx(2080, abs=2)


def test_without_torque_and_speed_the_last_key_lies_along_the_bottom() -> None:
    found = shown(Wishes(vary=["contact.adhesion=dry,wet", "wagon.pivot_spacing=10:12:1 m"]))
    assert [(label, panels) for _, label, panels in found] == [
        ("wagon.pivot_spacing / m", ["contact.adhesion dry", "contact.adhesion wet"])
    ]
    assert shown(Wishes(speeds="80", torques="5")) == []


def test_an_answer_of_zero_is_an_answer() -> None:
    solid = [Mark(1.0, 0.0, STOPPED, True), Mark(2.0, 80.0, STOPPED, True)]
    for marks in (solid, solid[:1]):
        (axes,) = study_figure(page(panels=[StopsPanel("80 km/h", {"tension": marks})])).axes
        assert "no stop has an answer" not in [text.get_text() for text in axes.texts]
        assert axes.get_yscale() == "linear"
        assert axes.get_ylim()[0] < 0.0


def test_words_along_the_bottom_are_named() -> None:
    study = build(Wishes(vary=["contact.adhesion=dry,wet"]))
    rows = [
        study.conditions(index) | {"status": "stopped", "braking_distance_m": 9.0 + index, "contact_adhesion": word}
        for index, word in enumerate(("dry", "dry", "wet", "wet"))
    ]
    (found,) = pages(study, rows)
    assert list(found.ticks) == ["dry", "wet"]
    (axes,) = study_figure(found).axes
    assert [label.get_text() for label in axes.get_xticklabels()] == ["dry", "wet"]


def test_drawing_a_study_does_not_import_what_only_runs_need() -> None:
    code = "import sys, slosh_cli.report.study_figures; print(*{'numba', 'pandas', 'h5py'} & set(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.split() == []


def test_a_figure_tells_no_torque_of_a_brake_that_varies(shipped) -> None:
    from slosh_cli.report import study_pages
    from slosh_cli.study.build import grid

    blocks = shipped("paper_80", "braking.blocks={count: 2, force: 25 kN, friction: cast-iron}")
    kept, varied = (grid(blocks, vary) for vary in ({"braking.application": "P,G"}, {"braking.blocks.count": "1,2"}))
    assert "blocks" in study_pages._conditions(kept, "")
    assert "blocks" not in study_pages._conditions(varied, "")
    assert "kN m" not in study_pages._conditions(kept, "") + study_pages._conditions(varied, "")
    masses = grid(shipped("paper_80_solid"), {"tank.mass": "30 t, 40 t"})
    assert "fill" not in study_pages._conditions(masses, "")
    assert "5 kN m per wheel" in study_pages._conditions(masses, "")
