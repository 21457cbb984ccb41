"""docs/speed.md: its tables agree with each other and with the limits; errors and work are what a stop gives today."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from benchmarks.multibody import is_installed
from benchmarks.records import ALLOWED_ERROR, CONTESTANTS, ratios
from benchmarks.same_stop import scenario, stopped
from told_speed import amount, error, tables, work

SHOWN_BY_REFERENCE = 1e-7
"""Errors below are of the size of the converged stop's own."""

VERDICTS = {line["ratio"]: line for line in tables()["verdicts"]}
CONTEST = {(re.match(r"\((.+?)\)", line["contestant"])[1], line["setting"]): line for line in tables()["contest"]}
FLOOR = {line["elements"]: line for line in tables()["floor"]}
TIME = "time / slosh at 2e-4"


def test_every_ratio_with_its_limit_and_its_verdict():
    asked = {one.what: one for one in ratios([])}
    assert list(VERDICTS) == list(asked)
    for what, line in VERDICTS.items():
        one = replace(asked[what], value=amount(line["measured"]))
        assert (line["limit"], line[""]) == (one.bound, one.verdict), what


@pytest.mark.parametrize("contestant", ["a", "c", "d", "d*"])
def test_a_verdict_names_the_quickest_sound_run(contestant):
    sound = {
        place: line
        for place, line in CONTEST.items()
        if place[0] == contestant and (amount(line["error in distance"]) or 1.0) <= ALLOWED_ERROR
    }
    best = min(sound.values(), key=lambda line: float(line[TIME]))
    (line,) = (
        one for name, one in VERDICTS.items() if name.startswith(f"({contestant})") and one["remark"].startswith("at ")
    )
    assert line["remark"] == f"at {best['setting']}, error {best['error in distance']}"
    assert line["measured"] == best[TIME]


def test_the_textbook_at_its_usual_step_is_told_twice():
    usual = VERDICTS["(a) textbook at 0.5 ms / slosh"]
    quickest = [line for (name, _), line in CONTEST.items() if name == "e" and line[TIME] == "1"]  # or next to it
    assert usual["measured"] == CONTEST["a", "0.5 ms"][TIME]
    told = [f"goal 1000; slosh {line['setting']}, error {line['error in distance']}" for line in quickest]
    assert usual["remark"] in told


def test_every_contestant_has_its_name():
    for (name, _), line in CONTEST.items():
        assert line["contestant"] == f"({name}) {CONTESTANTS[name]}"


@pytest.mark.parametrize("elements", list(FLOOR))
def test_floors_are_told_twice(elements):
    line = FLOOR[elements]
    for floor, words in (("own", "own kernels"), ("LAPACK", "LAPACK")):
        verdict = VERDICTS.get(f"stop / floor of {words}, {elements} elements")
        assert verdict is None or verdict["measured"] == line[f"stop / {floor} floor"]
    quotient = float(line["stop / own floor"]) / float(line["stop / LAPACK floor"])
    assert quotient == pytest.approx(float(line["LAPACK floor / own floor"]), rel=5e-3)


def test_what_was_run_in_part_is_part_of_the_whole_stop():
    whole = f"{stopped(scenario()).time[-1]:.1f} s run"
    parts = [line["part"] for line in CONTEST.values() if line["part"]]
    assert parts
    assert all(whole in part for part in parts)


def with_errors():
    return [place for place, line in CONTEST.items() if (amount(line["error in distance"]) or 0.0) > SHOWN_BY_REFERENCE]


@pytest.mark.slow
@pytest.mark.parametrize(("contestant", "setting"), with_errors())
def test_an_error_is_what_the_contestant_gives(contestant, setting):
    if contestant == "c" and not is_installed():
        pytest.skip("exudyn is not installed")
    assert f"{error(contestant, setting):.1e}" == CONTEST[contestant, setting]["error in distance"]


@pytest.mark.slow
@pytest.mark.parametrize("elements", list(FLOOR))
def test_work_is_what_the_stop_takes(elements):
    told = FLOOR[elements]
    counted = work(int(elements))
    assert {name: told[name] for name in counted} == counted
