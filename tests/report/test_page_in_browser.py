"""The page in a real browser: no errors, the replay moves, the cursor changes the picture, text stays text."""

import json
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

import pytest

from slosh_cli.application.reporting import write_report
from slosh_cli.application.stop import simulate
from slosh_cli.application.train import simulate_train
from slosh_cli.results.hdf5 import write_history, write_train
from slosh_cli.scenario import load_scenario

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium here")

# frames come by a timer: a browser without a screen may draw none
WATCH = """<script>window.found = {errors: []}; addEventListener("error", (e) => found.errors.push(e.message));
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);
window.cancelAnimationFrame = clearTimeout;</script>"""
FRAME = """<pre id="found"></pre><iframe src="visit.html" width="{width}" height="900" style="border: 0"></iframe>
<script>addEventListener("message", (e) => {{ document.querySelector("#found").textContent = e.data; }});</script>"""
VISIT = """<script>
window.alert = () => found.errors.push("alert");
const picture = () => document.querySelector("#wagon, #waterfall")?.toDataURL();
const scrub = document.querySelector("#scrub");
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const key = (name) => document.body.dispatchEvent(new KeyboardEvent("keydown", {key: name, bubbles: true}));
(async () => {
  found.wide = document.documentElement.scrollWidth - window.innerWidth;
  found.scripts = document.scripts.length; found.inner = window.innerWidth;
  if (scrub) {
    const first = picture();
    scrub.value = Math.floor(scrub.max / 2); scrub.dispatchEvent(new Event("input"));
    found.scrubbed = picture() !== first; found.now = document.querySelector("#now").textContent;
    const before = Number(scrub.value); key("ArrowRight"); key("ArrowRight"); key("ArrowLeft");
    found.stepped = Number(scrub.value) - before;
    const still = picture(); key(" ");
    for (let tries = 0; tries < 200 && Number(scrub.value) <= before + 1; tries++) await wait(100);
    key(" ");
    found.played = picture() !== still && Number(scrub.value) > before + 1;
    const paused = scrub.value; await wait(200); found.paused = scrub.value === paused;
  }
  const table = document.querySelector("table.sortable");
  if (table) {
    const column = () => [...table.tBodies[0].rows].map((row) => row.cells[2].textContent);
    table.tHead.rows[0].cells[2].firstChild.click(); found.up = column();
    table.tHead.rows[0].cells[2].firstChild.click(); found.down = column();
  }
  found.sorted = [...document.querySelectorAll("table.sortable")].map((one) => {
    const head = one.tHead.rows[0].cells[3]; head.firstChild.click();
    return [head.textContent, [...one.tBodies[0].rows].map((row) => row.cells[3].textContent)];
  });
  parent.postMessage(JSON.stringify(found), "*");
})();
</script>"""


def visited(page: Path, width: int = 1280) -> dict[str, Any]:
    """What a visit of the page by mouse and keys finds, in a window of a `width`."""
    text = page.read_text(encoding="utf-8").replace("<head>", "<head>" + WATCH).replace("</body>", VISIT + "</body>")
    visit = page.with_name("visit.html")
    visit.write_text(text, encoding="utf-8")
    frame = page.with_name("frame.html")  # for windows of browsers are never as narrow as a phone
    frame.write_text(FRAME.format(width=width), encoding="utf-8")
    options = ("--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--virtual-time-budget=60000")
    run = subprocess.run(
        [
            *(str(BROWSER), *options, "--window-size=1400,1200"),
            *(f"--user-data-dir={page.parent}/browser", "--dump-dom", frame.as_uri()),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert "CONSOLE" not in run.stderr, run.stderr
    return json.loads(unescape(re.search(r'<pre id="found">(.*?)</pre>', run.stdout)[1]))


@pytest.fixture(scope="module")
def run_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    evil = 'description="<script>alert(1)</script>"'
    write_history(simulate(load_scenario("paper-80-liquid", ["output.interval=0.05 s", evil])), folder / "run.h5")
    return write_report(folder / "run.h5")


@pytest.mark.parametrize("width", [390, 1280])
def test_a_run_replays(run_page: Path, width: int) -> None:
    found = visited(run_page, width)
    assert found["errors"] == []
    assert found["scripts"] == 4  # the page's two and those of the visit, apart from what it still reads
    assert found["inner"] == width
    assert found["scrubbed"]
    assert re.fullmatch(r"\d+\.\d\d s, \d+\.\d km/h, \d+\.\d m", found["now"])
    assert found["stepped"] == 1
    assert found["played"]
    assert found["paused"]
    assert found["wide"] <= 0


TRAIN = """\
format: 1
name: four
description: <script>alert(1)</script>
vehicles:
  - {scenario: paper-80-solid, set: {name: front, tank.coefficients: computed}}
  - {scenario: paper-80-solid, count: 3, set: {tank.fill: 0.3, tank.coefficients: computed}}
braking: {initial_speed: 10 km/h, onset: 0.2 s}
output: {interval: 20 ms}
"""


@pytest.fixture(scope="module")
def train_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("train")
    (folder / "four.yaml").write_text(TRAIN, encoding="utf-8")
    write_train(simulate_train(folder / "four.yaml"), folder / "run.h5")
    return write_report(folder / "run.h5")


@pytest.mark.parametrize("width", [390, 1280])
def test_a_train_replays(train_page: Path, width: int) -> None:
    found = visited(train_page, width)
    assert found["errors"] == []
    assert found["scripts"] == 4
    assert found["scrubbed"]
    assert re.fullmatch(r"\d+\.\d\d s, \d+\.\d km/h, (compression|tension) \d+\.\d kN in coupling \d", found["now"])
    assert found["stepped"] == 1
    assert found["played"]
    assert found["paused"]
    assert found["wide"] <= 0
    assert [head for head, _ in found["sorted"]] == ["onset, s", "at, s"]
    for _, column in found["sorted"]:
        assert sorted(column, key=float) == column
        assert len(set(column)) > 1


def test_a_table_sorts_by_number(tmp_path: Path) -> None:
    rows = "80,8,99,stopped\n80,9,148.5,stopped\n80,10,,failed\n80,11,1000,stopped\n"
    (tmp_path / "braking_distance.csv").write_text("v0_km_h,torque_kN_m,braking_distance_m,status\n" + rows)
    found = visited(write_report(tmp_path), 390)
    assert found["errors"] == []
    assert found["up"] == ["99", "148.5", "1000", ""]
    assert found["down"] == ["1000", "148.5", "99", ""]
    assert found["wide"] <= 0
