"""What a study shows: any answer, along any key, in curves and panels."""

from typing import Any

import pytest
from study_tools import PAPER

from slosh_cli.errors import UsageError
from slosh_cli.report.study_answers import asked_for
from slosh_cli.report.study_figures import LOOKS, study_figure
from slosh_cli.report.study_pages import View, pages
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.plan import Study


def study(**wishes: Any) -> Study:
    usual = {"speeds": "60,80", "torques": "5,10,15", "vary": ["contact.adhesion=dry,wet"]}
    return build(Wishes(PAPER, **{**usual, **wishes}))


def rows(of: Study) -> list[dict[str, Any]]:
    found = []
    for index in range(of.size):
        values = of.values(index)
        speed, torque = (float(values[f"braking.{key}"].split()[0]) for key in ("initial_speed", "torque"))
        row = {"v0_km_h": speed, "torque_kN_m": torque, "contact_adhesion": values.get("contact.adhesion", "dry")}
        liquid = values["tank.liquid.model"]
        answers = {"max_wheel_unloading": torque / 20, "braking_distance_m": 1e3 / torque}
        found.append(row | answers | {"liquid": liquid, "status": "stopped", "liquid_in_range": True})
    return found


def test_answers_are_known_by_name_and_by_short_name() -> None:
    names = [one.name for one in asked_for(study(), ["unloading", "first_lock", "distance", "max_surface_m"])]
    assert names == ["max_wheel_unloading", "speed_at_first_lock_m_s", "braking_distance_m", "max_surface_m"]


def test_an_unknown_answer_is_guessed() -> None:
    with pytest.raises(UsageError, match="do you mean `unloading`"):
        asked_for(study(), ["unloding"])


def test_words_make_curves_and_the_numbers_lie_along_the_bottom() -> None:
    of = study()
    (page,) = pages(of, rows(of), View(("unloading",), curves="adhesion"))
    assert page.label.startswith("brake torque")
    assert [panel.title for panel in page.panels] == ["60 km/h", "80 km/h"]
    assert list(page.panels[0].curves) == ["dry, modal", "dry, rigid", "wet, modal", "wet, rigid"]
    assert [mark.value for mark in page.panels[0].curves["wet, rigid"]] == pytest.approx([25.0, 50.0, 75.0])


def test_four_curves_look_different_and_panels_share_a_scale_with_the_limit() -> None:
    of = study()
    figure = study_figure(pages(of, rows(of), View(("unloading",), curves="adhesion"))[0])
    lines = [(line.get_color(), line.get_marker()) for line in figure.legends[0].get_lines()[: len(LOOKS)]]
    assert len(set(lines)) == len(LOOKS)
    first, second = figure.axes
    assert first.get_ylim() == second.get_ylim()
    assert any(list(line.get_ydata()) == [60.0, 60.0] for line in first.lines)
    assert len(first.get_yticks()) > 2


def test_a_stop_that_did_not_end_shows_no_answer() -> None:
    (shown,) = asked_for(study(), ["unloading"])
    assert shown.curves({"liquid": "modal", "status": "pitch-limit", "max_wheel_unloading": 1.0}) == [("modal", None)]


def test_speeds_along_the_bottom_share_one_panel() -> None:
    of = study(torques="5", vary=())
    (page,) = pages(of, rows(of))
    assert [len(curve) for panel in page.panels for curve in panel.curves.values()] == [2, 2]


@pytest.mark.parametrize(
    ("view", "message"),
    [
        (View(x="fill"), "no key that varies"),
        (View(x="torque", curves="torque"), "two ways"),
        (View(curves="torque"), "can be told apart"),
    ],
)
def test_a_view_that_cannot_be_is_refused(view: View, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        pages(study(), (), view)
