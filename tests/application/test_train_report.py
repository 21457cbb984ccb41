"""The report of a train: what it says is what the file holds, and whatever a scenario says stays text."""

import html
import json
import re

import numpy as np
import pytest

from slosh_cli.application.input_tables import vehicle_inputs_table
from slosh_cli.application.reporting import write_report
from slosh_cli.application.train import simulate_train
from slosh_cli.results.hdf5 import scenario_text, write_train
from slosh_cli.results.train_result import TrainResult

EVIL = "</script><script>alert(1)</script>"
TRAIN = f"""\
format: 1
name: five
description: {EVIL}
vehicles:
  - {{scenario: paper-80-solid, set: {{name: front, tank.coefficients: computed}}}}
  - {{scenario: paper-80-solid, count: 4, set: {{tank.fill: 0.3, tank.coefficients: computed}}}}
braking: {{initial_speed: 10 km/h, onset: 0.2 s}}
output: {{interval: 3 ms}}
"""


@pytest.fixture(scope="module")
def train(tmp_path_factory: pytest.TempPathFactory) -> TrainResult:
    file = tmp_path_factory.mktemp("train") / "five.yaml"
    file.write_text(TRAIN, encoding="utf-8")
    return simulate_train(file)


@pytest.fixture(scope="module")
def page(train: TrainResult, tmp_path_factory: pytest.TempPathFactory) -> str:
    file = tmp_path_factory.mktemp("page") / "run.h5"
    write_train(train, file)
    return write_report(file).read_text(encoding="utf-8")


def table_of(page: str, title: str) -> list[list[str]]:
    section = page.split(f"<h2>{title}</h2>")[1].split("</section>", maxsplit=1)[0]
    rows = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row) for row in re.findall(r"<tr>(.*?)</tr>", section)]
    return [[html.unescape(re.sub(r"<[^>]+>", "", cell)) for cell in row] for row in rows]


def test_the_charts_hold_the_largest_forces(train: TrainResult, page: str) -> None:
    data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)[1])
    shown = data["train"]
    assert len(shown["time"]) == len(shown["forces"][0]) <= 500 < train.time.size
    for one, force, most in zip(train.couplings, shown["forces"], shown["compression"], strict=True):
        assert max(map(abs, force)) == pytest.approx(np.abs(one.force).max() / 1e3, rel=1e-3)
        assert most == pytest.approx(one.max_compression_N / 1e3, rel=1e-3)
    assert shown["tension"] == pytest.approx([-one.max_tension_N / 1e3 for one in train.couplings], rel=1e-3)
    assert shown["onset"] == pytest.approx([one.onset_s for one in train.vehicles])


def test_vehicles_and_couplings_have_their_rows(train: TrainResult, page: str) -> None:
    head, *rows = table_of(page, "Vehicles")
    least = [float(row[head.index("least load, kN")]) for row in rows]
    assert least == pytest.approx([min(one.min_wheel_load_N) / 1e3 for one in train.vehicles], rel=1e-3)
    assert rows[0][1] == "front"
    head, *rows = table_of(page, "Couplings")
    found = [float(row[head.index("compression, kN")]) for row in rows]
    assert found == pytest.approx([one.max_compression_N / 1e3 for one in train.couplings], rel=1e-3)
    assert [row[1] for row in rows] == ["1 and 2", "2 and 3", "3 and 4", "4 and 5"]


def test_the_ledger_of_the_train_is_even(train: TrainResult, page: str) -> None:
    *_, (words, begin, end) = table_of(page, "Energy ledger")
    assert words.startswith("sum")
    kinetic = float(next(row for row in table_of(page, "Energy ledger") if row[0].startswith("kinetic"))[1])
    assert abs(float(begin) - float(end)) < (2.0 * train.energy_residual + 1e-5) * kinetic


def test_the_verdict_says_where_and_the_page_needs_nothing_else(train: TrainResult, page: str) -> None:
    place = train.compression_at
    said = (
        f"The largest compression is {train.max_compression_N / 1e3:.1f} kN, between vehicles {place} and {place + 1}"
    )
    assert said in page
    assert f"{train.braking_distance_m:.2f} m since its brake set in" in page
    assert EVIL not in page
    assert html.escape(EVIL) in page
    assert len(re.findall(r"<script", page)) == 2
    assert not re.search(r"""(src|href)=["']?(https?:)?//""", page)


def test_inputs_are_told_once_for_all_that_are_alike(train: TrainResult, page: str) -> None:
    assert ["braking.initial_speed", "2.77778 m/s", "yours", ""] in table_of(page, "Inputs of the train")
    rows = table_of(page, "Inputs of the vehicles")
    fills = [row[1:] for row in rows if row[0] == "tank.fill"]
    assert fills == [["0.5", "yours", "", "1"], ["0.3", "yours", "", "2-5"]]
    assert ["tank.coefficients", "computed", "computed", "by the program, from the other values", "all"] in rows
    assert not [row for row in rows if row[0] == "braking.onset"]
    texts = [scenario_text(one.scenario) for one in train.vehicles]
    assert vehicle_inputs_table(texts[:1])["rows"][0][-1] == "all"
