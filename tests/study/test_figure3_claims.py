"""The verdicts on what the paper says of its Figure 3."""

from typing import Any

import pytest

from slosh_cli.scenario import Scenario
from slosh_cli.study.build import Wishes, build
from slosh_cli.study.claims import Judgement, Verdict, applies, verdicts

TORQUES = [2.5 * k for k in range(1, 13)]


def row(speed: float, torque: float, liquid: str, distance: float | None, *, within: bool = True) -> dict[str, Any]:
    status = "pitch-limit" if distance is None else "stopped"
    return {
        "v0_km_h": speed, "torque_kN_m": torque, "liquid": liquid, "braking_distance_m": distance, "status": status,
        "liquid_in_range": within,
    }  # fmt: skip


def figure(best: float = 17.5, ratio: float = 1.15) -> list[dict[str, Any]]:
    """A Figure 3 as the paper describes it: a best torque, liquid longer, most at high speed and large torque."""
    found = []
    for speed in (80.0, 160.0):
        for torque in TORQUES:
            solid = speed * (1.0 + abs(torque - best) / 10.0)
            excess = (ratio - 1.0) * speed * torque / (160.0 * 20.0)
            found += [row(speed, torque, "modal", solid * (1.0 + excess)), row(speed, torque, "rigid", solid)]
    return found


def by_claim(rows: list[dict[str, Any]]) -> dict[str, Verdict]:
    return {verdict.claim: verdict for verdict in verdicts(rows)}


def without(rows: list[dict[str, Any]], speed: float, torque: float, liquid: str) -> list[dict[str, Any]]:
    key = (speed, torque, liquid)
    return [row(*key, None) if (one["v0_km_h"], one["torque_kN_m"], one["liquid"]) == key else one for one in rows]


def test_a_figure_like_the_papers_confirms_all_of_it() -> None:
    found = by_claim(figure())
    assert {verdict.finding for verdict in found.values()} == {Judgement.HOLDS}
    assert "80 km/h modal: 17.5 kN m" in found["fig3-optimum"].evidence
    assert "longer at 24 of 24 points" in found["fig3-longer"].evidence
    assert "Most at 160 km/h 30 kN m" in found["fig3-longer"].evidence
    assert "15.0 % longer" in found["fig3-15-percent"].evidence


def test_a_best_torque_elsewhere_denies_the_optimum() -> None:
    assert by_claim(figure(best=25.0))["fig3-optimum"].finding is Judgement.FAILS


def test_an_optimum_at_one_speed_only_is_half_a_claim() -> None:
    mixed = [one for one in figure() if one["v0_km_h"] == 80.0]
    mixed += [one for one in figure(best=25.0) if one["v0_km_h"] == 160.0]
    assert by_claim(mixed)["fig3-optimum"].finding is Judgement.IN_PART


def test_torques_that_end_within_the_range_cannot_tell_its_optimum() -> None:
    narrow = [one for one in figure() if one["torque_kN_m"] <= 20.0]
    verdict = by_claim(narrow)["fig3-optimum"]
    assert verdict.finding is Judgement.OPEN
    assert "do not reach beyond" in verdict.evidence


def test_a_liquid_that_stops_sooner_somewhere_is_named() -> None:
    rows = figure()
    rows[0]["braking_distance_m"] *= 0.9
    verdict = by_claim(rows)["fig3-longer"]
    assert verdict.finding is Judgement.IN_PART
    assert "not at 80 km/h 2.5 kN m" in verdict.evidence


def test_a_liquid_that_stops_sooner_everywhere_and_differs_most_when_slow_denies_the_claim() -> None:
    verdict = by_claim(figure(ratio=0.6))["fig3-longer"]
    assert verdict.finding is Judgement.FAILS


@pytest.mark.parametrize(
    ("ratio", "finding"),
    [
        (1.11, Judgement.HOLDS), (1.19, Judgement.HOLDS), (1.09, Judgement.FAILS), (1.21, Judgement.FAILS),
        (0.85, Judgement.FAILS),
    ],
)  # fmt: skip
def test_about_15_percent_is_10_to_20(ratio: float, finding: Judgement) -> None:
    assert by_claim(figure(ratio=ratio))["fig3-15-percent"].finding is finding


def test_a_stop_without_an_answer_leaves_the_claim_open_and_is_named() -> None:
    found = by_claim(without(figure(), 160.0, 20.0, "modal"))
    assert found["fig3-15-percent"].finding is Judgement.OPEN
    assert "liquid: pitch-limit" in found["fig3-15-percent"].evidence
    assert "160 km/h modal: 17.5 kN m" in found["fig3-optimum"].evidence
    assert "without an answer at 20 kN m" in found["fig3-optimum"].evidence
    assert "longer at 23 of 23 points" in found["fig3-longer"].evidence


def test_what_lies_outside_linear_theory_says_so() -> None:
    rows = [one | {"liquid_in_range": one["liquid"] == "rigid"} for one in figure()]
    found = by_claim(rows)
    assert "outside linear theory" in found["fig3-optimum"].evidence
    assert "outside linear theory" in found["fig3-15-percent"].evidence


def test_another_model_of_the_liquid_is_judged_by_its_own_stops() -> None:
    rows = figure() + [one | {"liquid": "shallow-water"} for one in figure(best=25.0) if one["liquid"] == "modal"]
    found = {verdict.claim: verdict for verdict in verdicts(rows, "shallow-water")}
    assert found["fig3-optimum"].finding is Judgement.IN_PART
    assert "80 km/h shallow-water: 25 kN m" in found["fig3-optimum"].evidence
    assert by_claim(rows)["fig3-optimum"].finding is Judgement.HOLDS


@pytest.mark.parametrize(
    ("wishes", "expected"),
    [
        (Wishes(), True),
        (Wishes(speeds="40:160:40"), True),
        (Wishes(overrides=["solver.tolerance=1e-5"]), True),
        (Wishes(speeds="80"), False),
        (Wishes(torques="10"), False),
        (Wishes(liquids="modal"), False),
        (Wishes(liquids="rigid"), False),
        (Wishes(liquids="shallow-water,rigid"), True),
        (Wishes(vary=["tank.fill=0.4,0.5"], speeds="80,160"), False),
        (Wishes(overrides=["tank.fill=0.6", "tank.coefficients=computed"]), False),
        (Wishes(overrides=["contact.adhesion=wet"]), False),
    ],
)
def test_the_claims_are_about_the_papers_wagon_and_its_grid(wishes: Wishes, expected: bool, paper: Scenario) -> None:
    assert applies(build(wishes), paper) is expected
