"""Keys of a line: gradient, unevenness, flats; what no line looks like is refused with its place, rule and fix."""

import re
from pathlib import Path

import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import Scenario, load_scenario, parse_scenario, scenario_to_yaml
from slosh_cli.study.key import stop_key

SHIPPED = (Path(__file__).parents[2] / "scenarios/paper_80_solid.yaml").read_text(encoding="utf-8")


def written(folder: Path, track: str = "", wagon: str = "") -> Path:
    """A scenario with lines more in its track and wagon, each on the line behind the part's key."""
    text = re.sub(r"^(track:.*)$", rf"\1\n  {track}" if track else r"\1", SHIPPED, count=1, flags=re.MULTILINE)
    text = re.sub(r"^(wagon:.*)$", rf"\1\n  {wagon}" if wagon else r"\1", text, count=1, flags=re.MULTILINE)
    (folder / "stop.yaml").write_text(text, encoding="utf-8")
    return folder / "stop.yaml"


def refused(folder: Path, track: str = "", wagon: str = "") -> ScenarioError:
    file = written(folder, track, wagon)
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file)
    line = next(number for number, text in enumerate(file.read_text().splitlines(), 1) if (track or wagon) in text)
    assert f"stop.yaml:{line}: " in str(caught.value)
    return caught.value


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("gradient: .nan", "from -0.1 to 0.1"),
        ("gradient: 0.5", "from -0.1 to 0.1"),
        ("gradient: []", "from 1 to 20000 points"),
        ("gradient: [[0 m, 0], [0 m, 0.01]]", "by 1 m or more, but point 2 does not"),
        ("gradient: [[10 m, 0], [0 m, 0.01]]", "by 1 m or more, but point 2 does not"),
        ("gradient: [[0 m, 0], [300 m]]", "but point 2 is not"),
        ("gradient: [[0, 0], [300 m, 0.01]]", "with its unit"),
        ("gradient: {from: 0}", "a number or a list of points"),
        ("unevenness: {}", "one of the keys sigma, spectrum, file and dips"),
        ("unevenness: {sigma: 1 mm, spectrum: fra-4}", "must not be given beside `sigma`"),
        ("unevenness: {sigma: 1 m}", "to 0.02 m"),
        ("unevenness: {sigma: 0 mm}", "above 0 m"),
        ("unevenness: {spectrum: fra-7}", "must be `fra-1`"),
        ("unevenness: {spectrum: fra-4, shape: fra}", "must stand beside `sigma`"),
        ("unevenness: {sigma: 1 mm, wavelengths: [30 m, 1.5 m]}", "the shortest and the longest wavelength"),
        ("unevenness: {sigma: 1 mm, wavelengths: [5 m, 30 m]}", "from 3 m or less to 25 m or more"),
        ("unevenness: {sigma: 1 mm, lines: 1.5}", "a whole number"),
        ("unevenness: {dips: []}", "at least 1 entry"),
        ("unevenness: {dips: [{position: 5 m, length: 1 m, depth: 2 mm}]}", "must be 26.9 m or more"),
        ("unevenness: {dips: [{position: -5 m, length: 1 m, depth: 2 mm}]}", "from 0 m"),
        ("unevenness: {dips: [{position: 50 m, length: 1 m, depth: 2 mm}], seed: 1}", "beside `sigma` or `spectrum`"),
        ("unevenness: {file: 3}", "the name of a CSV file"),
        ('unevenness: {file: ""}', "the name of a CSV file"),
    ],
)
def test_what_no_track_looks_like_is_refused(tmp_path: Path, text: str, rule: str) -> None:
    assert rule in str(refused(tmp_path, track=text))


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("wheel_flats: [{wheel: 5, depth: 1 mm, length: 60 mm}]", "from 1 to 4"),
        ("wheel_flats: [{wheel: 1.5, depth: 1 mm, length: 60 mm}]", "a whole number from 1 to 4"),
        ("wheel_flats: [{wheel: 1, depth: 1 mm, length: 3 m}]", "to 1 m"),
        ("wheel_flats: [{wheel: 1, depth: 1 mm, length: 0.9 m}]", "a quarter of the wheel's circumference, 0.722566 m"),
        ("wheel_flats: [{wheel: 1, depth: 0 mm, length: 60 mm}]", "above 0 m"),
        ("wheel_flats: {wheel: 1}", "must be a list"),
    ],
)
def test_what_no_flat_looks_like_is_refused(tmp_path: Path, text: str, rule: str) -> None:
    assert rule in str(refused(tmp_path, wagon=text))


def test_a_wheel_has_one_flat(tmp_path: Path) -> None:
    flat = "{wheel: 1, depth: 1 mm, length: 60 mm}"
    assert "another wheel for each flat" in str(refused(tmp_path, wagon=f"wheel_flats: [{flat}, {flat}]"))


@pytest.mark.parametrize(
    ("rows", "place", "rule"),
    [
        ("0,0\n1,nan\n2,0\n3,0\n", ":3: z_m", "finite number"),
        ("0,0\n1,0\n1,0\n3,0\n", ":4: x_m", "rise by 0.01 m or more"),
        ("0,0\n2,0\n1,0\n3,0\n", ":4: x_m", "rise by 0.01 m or more"),
        ("0,0\n1,0\n2,5\n3,0\n", ":4: z_m", "in metres"),
        ("5,0\n6,0\n7,0\n8,0\n", ":2: x_m", "begin at 0 or before"),
        ("0,0\n1,0\n", "", "from 4 to 20000 rows"),
        ("".join(f"{x},0\n" for x in range(20_001)), "", "from 4 to 20000 rows"),
        ("", "", "at least one row"),
    ],
)
def test_a_measured_rail_is_refused_by_its_line(tmp_path: Path, rows: str, place: str, rule: str) -> None:
    (tmp_path / "rail.csv").write_text("x_m,z_m\n" + rows, encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        load_scenario(written(tmp_path, track="unevenness: {file: rail.csv}"))
    assert f"rail.csv{place}" in str(caught.value)
    assert rule in str(caught.value)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"rail\.csv: must exist"):
        load_scenario(written(tmp_path, track="unevenness: {file: rail.csv}"))


def test_a_name_that_no_folder_can_hold_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"must be readable; given `File name too long`"):
        load_scenario(written(tmp_path, track=f"unevenness: {{file: {300 * 'x'}.csv}}"))


def measured(folder: Path, height: float) -> Scenario:
    """The scenario with a measured rail beside it, read from another folder."""
    (folder / "rail.csv").write_text(f"x_m,z_m\n0,0\n1,{height}\n2,0\n3,0\n", encoding="utf-8")
    return load_scenario(written(folder, track="unevenness: {file: rail.csv}"))


def test_the_content_of_a_file_is_what_tells_stops_apart(tmp_path: Path) -> None:
    one, again, other = measured(tmp_path, 0.001), measured(tmp_path, 0.001), measured(tmp_path, 0.0015)
    assert stop_key(one) == stop_key(again) != stop_key(other)
    (tmp_path / "rail.csv").unlink()
    assert parse_scenario(scenario_to_yaml(one)) == one


def test_content_that_was_changed_by_hand_is_checked_like_a_file(tmp_path: Path) -> None:
    found = refused(tmp_path, track='unevenness: {file: "x_m,z_m 0,0 1,0 1,0 2,0"}')
    assert "rise by 0.01 m or more from row to row (point 3)" in str(found)


@pytest.mark.parametrize(
    "text",
    [
        "gradient: [[0 m, 0], [300 m, 0.01]]",
        "unevenness: {sigma: 1.2 mm, seed: 1, shape: fra}",
        "unevenness: {spectrum: erri-high, wavelengths: [2 m, 20 m], lines: 100}",
        "unevenness: {dips: [{position: 50 m, length: 1 m, depth: 2 mm}, {position: 60 m, length: 1 m, depth: -1 mm}]}",
    ],
)
def test_a_line_reads_back_as_itself(tmp_path: Path, text: str) -> None:
    scenario = load_scenario(written(tmp_path, track=text))
    assert parse_scenario(scenario_to_yaml(scenario)) == scenario
    assert scenario.with_({"braking.torque": 4e3}).track == scenario.track


def test_a_plain_scenario_says_nothing_of_unevenness_and_flats() -> None:
    text = scenario_to_yaml(parse_scenario(SHIPPED))
    assert "unevenness" not in text
    assert "wheel_flats" not in text
