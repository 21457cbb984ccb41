"""The pages of the documentation: built from the cases, complete, and right in what they say in prose."""

import csv
import importlib.util
import math
import re
from pathlib import Path

import pytest

from slosh_cli.cli import main
from slosh_cli.validation import registry
from slosh_cli.validation.case import CaseResult, Row
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import read_case

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(DOCS.glob("*.md"))


def script(name):
    specification = importlib.util.spec_from_file_location(f"docs_{name}", DOCS / f"{name}.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def hooks():
    return script("hooks")


@pytest.fixture(scope="module")
def identifiability():
    return script("identifiability")


@pytest.fixture(scope="module")
def real_brakes():
    return script("real_brakes")


@pytest.fixture(scope="module")
def train_couplers():
    return script("train_couplers")


@pytest.fixture(scope="module")
def baffles():
    return script("baffles")


def stored_rows():
    with (DOCS / "identifiability.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def made_up(data):
    rows = (
        Row("some | quantity", 1.0, 2.0, 0.5, 0.1, data.source, "relative"),
        Row("a note", 3.0, None, None, None, ""),
    )
    return CaseResult(data, rows, Chart((Panel("x", "y", (curve("line", [0, 1], [0, 1]),)),)), 0.1)


def test_the_manual_has_every_case_tolerance_reason_and_sabotage(hooks):
    cases = [read_case(name) for name in registry.NAMES if name != "second-code"]
    text = hooks.manual([made_up(data) for data in cases], [read_case("second-code")])
    for data in cases:
        assert f"\n## {data.name}\n" in text
        for said in (data.question, data.source, *data.errata, *(entry.reason for entry in data.tolerances.values())):
            assert said.replace("|", "\\|") in text or said in text
        for catch in data.catches:
            assert f"| {catch.error} | {data.name} |" in text
    assert "needs `exudyn`" in text
    assert "some \\| quantity" in text
    assert "fell short" in text


def test_rows_of_a_case_take_the_place_of_their_mark(hooks):
    text = hooks.with_rows(
        "before\nSee `slosh validate polach`, rows on *quantity*.\nafter", lambda name: made_up(read_case(name))
    )
    assert "`slosh validate polach`" in text
    assert "some \\| quantity" in text
    assert "a note" not in text
    with pytest.raises(ValueError, match="no row about 'nonsense'"):
        hooks.with_rows("See `slosh validate polach`, rows on *nonsense*.", lambda name: made_up(read_case(name)))


def test_every_mark_in_the_pages_finds_rows(hooks):
    marks = [match for page in PAGES for match in hooks.ROWS.finditer(page.read_text(encoding="utf-8"))]
    assert len(marks) >= 4
    for match in marks:
        assert match[1] in registry.NAMES
        if read_case(match[1]).quick and match[2]:
            assert any(match[2] in row.quantity for row in hooks.result_of(match[1]).rows)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_images_lead_somewhere(page):
    made_when_built = {"validation.md"}
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        assert target in made_when_built or (DOCS / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_in_the_pages_exist(page, capsys):
    for command, name in re.findall(r"`slosh (\w+)(?: ([\w-]+))?", page.read_text(encoding="utf-8")):
        if command == "validate" and name:
            assert name in registry.NAMES
        assert main([command, "--help"]) == 0
        capsys.readouterr()


@pytest.mark.parametrize(
    ("text", "fetches"),
    [
        ('<script src="https://cdn.example/a.js"></script>', True),
        ("<script src=//cdn.example/a.js>", True),
        ('<link rel="stylesheet" href="https://fonts.example/css">', True),
        ('<link href="https://fonts.example" rel="preconnect" crossorigin>', True),
        ("@import 'https://fonts.example/css';", True),
        ("src: url(https://fonts.example/a.woff2)", True),
        ('<img alt="x" src="http://elsewhere.example/a.png">', True),
        ('<script src="assets/a.js"></script><link rel="stylesheet" href="assets/a.css">', False),
        ('<a href="https://elsewhere.example/paper">paper</a>', False),
        ('<link rel="canonical" href="https://elsewhere.example/">', False),
        ('src: url(data:image/svg+xml;charset=utf-8,<svg xmlns="http://www.w3.org/2000/svg"/>)', False),
    ],
)
def test_a_page_that_loads_from_elsewhere_is_seen(hooks, text, fetches):
    assert bool(hooks.fetched_from_elsewhere(text)) is fetches


def test_a_site_that_needs_a_network_is_refused(hooks, tmp_path):
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "style.css").write_text("body {}", encoding="utf-8")
    hooks.on_post_build({"site_dir": str(tmp_path)})
    (tmp_path / "assets" / "style.css").write_text("@import '//fonts.example/css';", encoding="utf-8")
    with pytest.raises(ValueError, match=r"style\.css loads from elsewhere"):
        hooks.on_post_build({"site_dir": str(tmp_path)})


def test_the_site_has_every_page():
    navigation = (DOCS.parent / ".mkdocs.yml").read_text(encoding="utf-8")
    for page in PAGES:
        assert f": {page.name}\n" in navigation, page.name


def test_the_identifiability_page_is_that_of_its_table(identifiability):
    rows = stored_rows()
    told = [(row["varied"], row["value"], row["changed"]) for row in rows]
    assert told == [
        (varied, value, "; ".join(changes))
        for varied, values in identifiability.VARIED.items()
        for value, changes in values
    ]
    assert (DOCS / "identifiability.md").read_text(encoding="utf-8") == identifiability.page(rows)


@pytest.mark.slow
@pytest.mark.parametrize("row", [0, 10, 21])
def test_a_row_of_the_identifiability_table_is_what_sweep_gives_today(identifiability, row, tmp_path):
    stored = stored_rows()[row]
    found = identifiability.examined(tmp_path / "study", tuple(filter(None, stored["changed"].split("; "))))
    assert {key: str(value) for key, value in found.items()} == {key: stored[key] for key in found}


def test_the_page_of_real_brakes_is_that_of_its_table(real_brakes):
    rows = real_brakes.read()
    choices = (real_brakes.FILLS, real_brakes.BRAKES, real_brakes.LAMBDAS, real_brakes.APPLICATIONS, real_brakes.RAILS)
    assert len(rows) == math.prod(map(len, (*choices, real_brakes.GRADIENTS, real_brakes.LIQUIDS)))
    assert len({(real_brakes.conditions(row), row["liquid"]) for row in rows}) == len(rows)
    assert (DOCS / "real-brakes.md").read_text(encoding="utf-8") == real_brakes.page(rows)


@pytest.mark.parametrize("fill", [0.4, 0.9])
def test_rows_of_the_table_of_real_brakes_are_what_a_run_gives_today(real_brakes, fill):
    wagon = real_brakes.loaded(fill)
    for row in real_brakes.read():
        asked = row["fill"] == f"{fill:g}" and row["liquid"] != "shallow-water" and row["application"] == "P"
        if not asked or row["lambda"] not in ("50", "100"):
            continue
        stored = dict(row)
        force = real_brakes.force_for(wagon, row["brake"], float(row["lambda"]))
        changes = {
            "braking.application": "P", "contact.adhesion": row["rail"], "track.gradient": float(row["gradient"]),
            "tank.liquid.model": row["liquid"],
        }  # fmt: skip
        found = real_brakes.examined(({}, real_brakes.braked(wagon, row["brake"], force, **changes)))
        for name, text in found.items():
            told = stored[name]
            assert text == told or float(text) == pytest.approx(float(told), rel=1e-4, abs=1e-3), (row, name)


def test_the_page_of_train_couplers_is_that_of_its_table(train_couplers):
    rows = train_couplers.read()
    assert {tuple(str(value) for value in stop.values()) for stop in train_couplers.settings()} == {
        (*train_couplers.conditions(row), row["liquid"]) for row in rows
    }
    assert len(rows) == len(train_couplers.settings())
    assert (DOCS / "train-couplers.md").read_text(encoding="utf-8") == train_couplers.page(rows)


@pytest.mark.parametrize("liquid", ["modal", "rigid"])
def test_rows_of_the_table_of_train_couplers_are_what_a_run_gives_today(train_couplers, liquid, tmp_path):
    asked = dict(zip(train_couplers.CONDITIONS, (10, 0.5, "P", "screw"), strict=True)) | {"liquid": liquid}
    (stored,) = train_couplers.only(train_couplers.read(), **asked)
    found = train_couplers.examined(asked, train_couplers.train_of(asked, tmp_path))
    near = {"steps": 0.02, "energy_residual": 0.02}  # rounding decides them at locks and slack
    for name, text in found.items():
        told = stored[name]
        assert text == told or float(text) == pytest.approx(float(told), rel=near.get(name, 1e-4)), name


def test_the_page_of_baffles_is_that_of_its_table(baffles):
    rows = baffles.read()
    asked = [tuple(str(value) for value in stop.values()) for stop in baffles.settings()]
    assert [tuple(row[name] for name in baffles.CONDITIONS) for row in rows] == asked
    assert (DOCS / "baffles.md").read_text(encoding="utf-8") == baffles.page(rows)


def test_a_row_of_the_table_of_baffles_is_what_a_run_gives_today(baffles):
    asked = dict(zip(baffles.CONDITIONS, (0.6, "P", "slot", 2), strict=True))
    (stored,) = baffles.only(baffles.read(), **asked)
    for name, text in baffles.examined(asked).items():
        told = stored[name]
        assert text == told or float(text) == pytest.approx(float(told), rel=1e-3, abs=1e-5), name


def test_what_the_findings_say_in_prose(stop):
    """Surface at roof and bottom at 5 kN m, past them at 7.5 kN m."""
    at_five, at_more = (stop("paper_80", f"braking.torque={torque} kN m") for torque in (5, 7.5))
    assert at_five.max_surface_m == pytest.approx(at_five.surface_limit_m, rel=0.01)
    assert at_more.max_surface_m > 1.3 * at_more.surface_limit_m
