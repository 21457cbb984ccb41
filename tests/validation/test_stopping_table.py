"""The published stopping tables: the closed form, and, where the file of all figures is at hand, what is said of it.

`SLOSH_MEASURED` names the folder with `train_stopping_tables.csv`, which is not part of the project.
"""

import csv
import math
import os
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from slosh_cli.validation.cases.stopping_table import fitted
from slosh_cli.validation.data_file import read_case
from slosh_cli.validation.exact.friction import ramped_stop

DATA = read_case("stopping-table").reference
TABLE = Path(os.environ.get("SLOSH_MEASURED", "")) / "train_stopping_tables.csv"
needs_the_table = pytest.mark.skipif(not TABLE.is_file(), reason="SLOSH_MEASURED names no folder with the table")


@pytest.mark.parametrize("pull", [0.0, 0.2, -0.2, -0.29])
@pytest.mark.parametrize(("speed", "build_up"), [(30.0, 40.0), (4.0, 40.0), (20.0, 0.0)])
def test_the_closed_form_is_the_motion(speed, build_up, pull):
    def slowing(t, x):
        return [x[1], -0.3 * (min(t / build_up, 1.0) if build_up else 1.0) - pull]

    def stands(_, x):
        return x[1]

    stands.terminal, stands.direction = True, -1
    run = solve_ivp(slowing, (0, 1e5), [0.0, speed], rtol=1e-10, atol=1e-10, events=stands, max_step=5.0)
    assert ramped_stop(speed, 0.3, build_up, pull) == pytest.approx(run.y[0, -1], rel=1e-7)


def test_a_brake_weaker_than_gravity_does_not_stop():
    assert ramped_stop(20.0, 0.3, 10.0, -0.3) == math.inf


def test_the_fit_finds_the_numbers_that_made_a_table():
    made = [(v, 0, ramped_stop(v / 3.6, 0.35, 2 * 18.0)) for v in (40, 80, 110)]
    assert fitted(made) == pytest.approx((0.35, 18.0), rel=1e-6)


def test_at_most_a_dozen_figures_are_carried():
    assert sum(len(figures) for figures in DATA["trains"].values()) <= 12


def published():
    """Rows of speed (km/h), gradient (1 in x, 0 for the level, positive uphill) and distance (m) by train."""
    trains = {}
    with TABLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            grade = 0 if row["grade_1_in_x"] == "Level" else int(row["grade_1_in_x"])
            figures = trains.setdefault(row["brake_curve"], [])
            figures.append((int(row["speed_kph"]), grade, int(row["stopping_distance_m"])))
    return trains


@needs_the_table
def test_the_figures_carried_are_the_published_ones():
    trains = published()
    assert set(DATA["whole_table"]) == set(trains)
    for train, figures in DATA["trains"].items():
        assert {tuple(row) for row in figures} <= set(trains[train])


def spread(figures):
    """What the data file says of a train's whole table."""
    a, equivalent = fitted([row for row in figures if row[1] == 0])
    grades = np.array([row[1] for row in figures])
    errors = []
    for speed, grade, metres in figures:
        pull = 9.81 / grade if grade else 0.0
        errors.append(100 * (ramped_stop(speed / 3.6, a, 2 * equivalent, pull) / metres - 1))
    errors = np.array(errors)
    found = [round(a, 4), round(equivalent, 2)]
    for chosen in (grades == 0, grades > 0, (grades < 0) & (grades <= -100)):
        part = errors[chosen]
        found += [round(float(np.sqrt(np.mean(part**2))), 1), round(float(part[np.argmax(np.abs(part))]), 1)]
    return [*found, round(float(errors[(grades < 0) & (grades > -100)].max()), 1)]


@needs_the_table
@pytest.mark.parametrize("train", DATA["whole_table"])
def test_what_is_said_of_the_whole_table(train):
    assert spread(published()[train]) == pytest.approx(DATA["whole_table"][train], abs=0.11, rel=0.02)


def best_share(figures, chosen):
    """The share of gravity that fits the chosen gradients best."""
    a, equivalent = fitted([row for row in figures if row[1] == 0])
    rows = [row for row in figures if chosen(row[1])]

    def miss(share):
        errors = [ramped_stop(v / 3.6, a, 2 * equivalent, share * 9.81 / grade) / d - 1 for v, grade, d in rows]
        return np.mean(np.square(errors))

    return minimize_scalar(miss, bounds=(0.4, 1.2), method="bounded").x


@needs_the_table
def test_the_table_answers_to_less_than_gravity():
    uphill = [best_share(figures, lambda grade: grade > 0) for figures in published().values()]
    downhill = [best_share(figures, lambda grade: grade <= -100) for figures in published().values()]
    assert (min(uphill), max(uphill)) == pytest.approx((0.80, 0.86), abs=0.005)
    assert (min(downhill), max(downhill)) == pytest.approx((0.79, 0.90), abs=0.005)
