"""Reading, changing and writing scenarios."""

import time
from collections.abc import Callable
from pathlib import Path

import pytest
from malformed_case import BASE, edited

from slosh_cli.errors import ScenarioError, UsageError
from slosh_cli.scenario import (
    Scenario,
    TankScenario,
    find_packaged,
    load_any_scenario,
    load_scenario,
    load_tank_scenario,
    packaged_scenarios,
    parse_scenario,
    scenario_to_yaml,
)

Write = Callable[[str | bytes], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Put a text into a file."""

    def put(content: str | bytes) -> Path:
        path = tmp_path / "scenario.yaml"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return put


@pytest.fixture
def paper() -> Scenario:
    return load_scenario(find_packaged("paper-80-liquid"))


def test_values_of_the_paper(paper: Scenario) -> None:
    wagon, tank, track, braking = paper.wagon, paper.tank, paper.track, paper.braking
    tare = wagon.car_body.mass + 2 * wagon.bogie.mass + 4 * wagon.wheelset.mass
    assert tare == 30500.0
    assert (wagon.bogie.wheelbase, wagon.pivot_spacing, wagon.traction_height) == (1.8, 12.0, 0.9)
    assert (wagon.wheelset.spin_inertia, wagon.wheelset.wheel_radius) == (120.0, 0.46)
    assert (wagon.primary_suspension.stiffness, wagon.secondary_suspension.damping) == (2.6e6, 6.5e4)
    resistance = wagon.running_resistance
    assert (resistance.constant, resistance.linear, resistance.quadratic) == (851.0, 13.5, 1.244)
    assert (tank.shape, tank.width, tank.height, tank.length, tank.fill) == ("horizontal-cylinder", 3.0, 3.0, 15.5, 0.5)
    assert (tank.liquid.model, tank.liquid.density, tank.liquid.damping_ratio) == ("modal", 830.0, 0.0)
    assert (track.rail.youngs_modulus, track.rail.second_moment) == (2e11, 3.06e-5)
    assert (track.foundation.stiffness, track.foundation.shear_stiffness) == (1e7, 666875.0)
    assert (track.domain.length, track.domain.element_length) == (50.0, 0.5)
    assert paper.contact.adhesion.model_dump() == {"mu0": 0.55, "A": 0.4, "B": 0.6, "kA": 1.0, "kS": 0.4}
    assert paper.contact.stiffness is None
    assert braking.initial_speed == pytest.approx(80 / 3.6, rel=1e-15)
    assert (braking.torque, braking.onset, braking.stop_speed) == (5000.0, 0.5, 0.02)
    assert (paper.solver.tolerance, paper.solver.time_limit, paper.output.interval) == (1e-4, 600.0, 0.01)


PRINTED = {
    "kolaei-half": (1.2, 5.75, 1.2, 998.2, 1.65, -16466.0, -15147.0, 25434.0),
    "kolaei-three-quarters": (1.2, 5.75, 1.8, 998.2, 2.1, -14231.0, -20046.0, 13571.0),
    "paper-80-liquid": (1.5, 15.5, 1.5, 830.0, 0.69, 137071.0, -68461.0, 442163.0),
}


@pytest.mark.parametrize("name", PRINTED)
def test_coefficients_are_transcribed_as_printed(name: str) -> None:
    tank = load_tank_scenario(find_packaged(name)).tank
    assert tank.shape == "horizontal-cylinder"
    assert isinstance(tank.coefficients, tuple)
    (mode,) = tank.coefficients
    geometry = (tank.radius, tank.length, tank.fill * tank.height, tank.liquid.density)
    assert (*geometry, mode.frequency, mode.lambda_1, mode.lambda_02, mode.mu) == pytest.approx(
        PRINTED[name], rel=1e-15
    )


def test_packaged_scenarios() -> None:
    speeds = {"paper-80-liquid": 80, "paper-80-solid": 80, "paper-160-liquid": 160, "paper-160-solid": 160}
    assert list(packaged_scenarios()) == sorted(
        [*speeds, "block-brake", "kolaei-half", "kolaei-three-quarters", "tank-wagon"]
    )
    reference = load_scenario(find_packaged("paper-80-liquid"))
    for name, speed in speeds.items():
        found = load_scenario(find_packaged(name))
        assert found.name == name
        assert found.tank.liquid.model == ("rigid" if name.endswith("solid") else "modal")
        same = {"name": "same", "description": "", "tank.liquid.model": "modal", "braking.initial_speed": 20.0}
        assert found.braking.initial_speed == pytest.approx(speed / 3.6, rel=1e-15)
        assert found.with_(same) == reference.with_(same)


@pytest.mark.parametrize("name", ["paper-160-solid", "paper_160_solid", "paper_160_solid.yaml"])
def test_find_packaged(name: str) -> None:
    assert find_packaged(name).name == "paper_160_solid.yaml"


def test_a_packaged_scenario_is_read_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    by_name = load_scenario("paper-80-liquid", ["braking.torque=10 kN m"])
    assert by_name == load_scenario(find_packaged("paper-80-liquid"), ["braking.torque=10 kN m"])
    assert load_tank_scenario("kolaei-half").name == "kolaei-half"
    with pytest.raises(ScenarioError, match=r"^paper-80-liquid:\d+: tank.fill: |^--set tank.fill: must be"):
        load_scenario("paper-80-liquid", ["tank.fill=2"])


def test_a_file_goes_before_a_packaged_scenario_of_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "paper-80-liquid").write_text(BASE, encoding="utf-8")
    assert load_scenario("paper-80-liquid").name == "example"


@pytest.mark.parametrize(
    "given", ["paper_80.yaml", "./paper-80-liquid", "there/paper-80-liquid", "paper-80", "Paper-80-liquid"]
)
def test_what_is_no_name_must_be_a_file(given: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ScenarioError, match="must exist; given a path with no file"):
        load_scenario(given)


def test_find_packaged_guesses() -> None:
    with pytest.raises(UsageError, match="given `paper-80-solit`; write `paper-80-solid`"):
        find_packaged("paper-80-solit")
    with pytest.raises(UsageError, match="write one of block-brake, kolaei-half"):
        find_packaged("zzz")


@pytest.mark.parametrize("name", packaged_scenarios())
def test_written_out_it_reads_back_equal(name: str, write: Write) -> None:
    scenario = load_any_scenario(find_packaged(name))
    text = scenario_to_yaml(scenario)
    assert load_any_scenario(write(text)) == scenario
    if isinstance(scenario, Scenario):
        assert parse_scenario(text) == scenario
        assert "interval: 0.01 s" in text


CHANGES = [
    ("tank={shape: rectangular, width: 2.4 m, height: 2 m, length: 9 m, fill: 0.3, bottom_height: 1.2 m, "
     "liquid: {model: modal, density: 1 t/m^3, damping_ratio: 0.01}, modes: 3}",),
    ("tank.shape=polygon", "tank.coefficients=computed", "tank.points=[[-1, 0], [1, 0], [1.2, 1.5], [-1.2, 1.5]]",
     "tank.radius=1 m"),
    ("contact.adhesion={mu0: 0.3, A: 0.1, B: 0.123456789 s/m, kA: 0.9, kS: 0.3}", "contact.stiffness=9e10 N/m^1.5"),
    ("solver.tolerance=1e-7", "output.interval=1.7 ms", "braking.initial_speed=123.4 km/h"),
    ("description='Umlaute: äöü # and \"quotes\"'",),
]  # fmt: skip


@pytest.mark.parametrize("changes", CHANGES, ids=lambda changes: changes[0][:20])
def test_changed_and_written_out_it_reads_back_equal(changes: tuple[str, ...], write: Write) -> None:
    base = edited(("  radius: 1.5 m\n", "")) if "polygon" in changes[0] else BASE
    overrides = [change for change in changes if not change.startswith("tank.radius")]
    scenario = load_scenario(write(base), overrides)
    assert parse_scenario(scenario_to_yaml(scenario)) == scenario
    assert scenario.with_({}) == scenario


def test_overrides_use_units_lists_mappings_and_the_last_one_counts(write: Write) -> None:
    found = load_scenario(
        write(BASE),
        [
            "braking.torque=12 kN m",
            "braking.torque = 14 kN m",
            "contact.adhesion=wet",
            "tank.coefficients.0.mu=400 t",
            "output={interval: 5 ms}",
            "name=other",
        ],
    )
    assert found.braking.torque == 14000.0
    assert (found.contact.adhesion.mu0, found.contact.adhesion.kS) == (0.3, 0.1)
    assert isinstance(found.tank.coefficients, tuple)
    assert found.tank.coefficients[0].mu == 4e5
    assert (found.output.interval, found.name) == (0.005, "other")


def test_an_override_may_switch_the_shape(write: Write) -> None:
    path = write(edited(("  radius: 1.5 m\n", "")))
    changes = [
        "tank.shape=elliptical",
        "tank.width=2.6 m",
        "tank.height=2.2 m",
        "tank.coefficients=computed",
        "tank.modes=2",
    ]
    tank = load_scenario(path, changes).tank
    assert (tank.shape, tank.width, tank.height) == ("elliptical", 2.6, 2.2)
    assert (tank.coefficients, tank.modes) == ("computed", 2)


def test_an_override_of_one_value_of_named_adhesion_keeps_the_others(write: Write) -> None:
    adhesion = load_scenario(write(BASE), ["contact.adhesion.mu0=0.2"]).contact.adhesion
    assert adhesion.model_dump() == {"mu0": 0.2, "A": 0.4, "B": 0.6, "kA": 1.0, "kS": 0.4}


def test_an_override_may_add_a_mapping_the_file_leaves_out(write: Write) -> None:
    path = write(edited(("solver: {tolerance: 1.0e-4, time_limit: 600 s}\n", "")))
    assert load_scenario(path, ["solver.time_limit=9 s"]).solver.model_dump() == {"tolerance": 1e-4, "time_limit": 9.0}


def test_left_out_parts_have_defaults(write: Write) -> None:
    short = BASE[: BASE.index("solver:")].replace("  stop_speed: 0.02 m/s\n", "")
    found = load_scenario(write(short.replace("description: A wagon to break\n", "")))
    assert (found.description, found.braking.stop_speed) == ("", 0.02)
    assert (found.solver.tolerance, found.solver.time_limit, found.output.interval) == (1e-4, 600.0, 0.01)
    assert found.tank.modes == 1


@pytest.mark.parametrize(
    ("old", "new", "value"),
    [
        ("poisson_ratio: 0.3", "poisson_ratio: 3e-1", 0.3),
        ("poisson_ratio: 0.3", "poisson_ratio: +.3", 0.3),
        ("poisson_ratio: 0.3", "poisson_ratio: 0", 0.0),
    ],
)
def test_numbers_that_yaml_1_1_takes_for_text(write: Write, old: str, new: str, value: float) -> None:
    assert load_scenario(write(edited((old, new)))).contact.poisson_ratio == value


def test_words_that_yaml_1_1_takes_for_something_else(write: Write) -> None:
    assert load_scenario(write(edited(("name: example", "name: on")))).name == "on"
    assert load_scenario(write(edited(("name: example", "name: 2024-01-01")))).name == "2024-01-01"


@pytest.mark.parametrize(
    "content",
    [BASE.encode("utf-8-sig"), BASE.replace("\n", "\r\n").encode(), ("---\n" + BASE + "...\n").encode()],
    ids=["byte order mark", "Windows line ends", "document markers"],
)
def test_files_of_other_editors(write: Write, content: bytes) -> None:
    assert load_scenario(write(content)).name == "example"


def test_aliases_and_merge_keys(write: Write) -> None:
    named, second = "primary_suspension: &unit {", "{stiffness: 6.0e6 N/m, damping: 6.5e4 N s/m}"
    merged = edited(("primary_suspension: {", named), (second, "{<<: *unit, damping: 7 kN s/m}"))
    wagon = load_scenario(write(merged)).wagon
    assert wagon.secondary_suspension.model_dump() == {"stiffness": 2.6e6, "damping": 7000.0}
    alias = edited(("primary_suspension: {", named), (second, "*unit"))
    assert load_scenario(write(alias)).wagon.secondary_suspension == wagon.primary_suspension


def test_a_mistake_behind_a_merge_key_is_placed_where_it_is_written(write: Write) -> None:
    text = edited(
        ("primary_suspension: {", "primary_suspension: &unit {"),
        ("2.6e6 N/m", "2.6e6"),
        ("{stiffness: 6.0e6 N/m, damping: 6.5e4 N s/m}", "{<<: *unit, damping: 7 kN s/m}"),
    )
    with pytest.raises(ScenarioError) as caught:
        load_scenario(write(text))
    places = [(problem.line, problem.key) for problem in caught.value.problems]
    stiffness = "{}_suspension.stiffness"
    assert places == [(17, "wagon." + stiffness.format("primary")), (17, "wagon." + stiffness.format("secondary"))]


def test_aliases_that_unfold_without_end_are_refused_at_once(write: Write) -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)]
    started = time.perf_counter()
    with pytest.raises(ScenarioError, match="must be a tree of at most 20000 values"):
        load_scenario(write("\n".join(lines)))
    assert time.perf_counter() - started < 5.0


def test_a_tank_is_read_from_either_kind_of_file(paper: Scenario) -> None:
    found = load_tank_scenario(find_packaged("paper-80-liquid"))
    assert isinstance(found, TankScenario)
    assert (found.name, found.tank) == (paper.name, paper.tank)
    changes = ["tank.fill=0.6", "tank.coefficients=computed"]
    assert load_tank_scenario(find_packaged("kolaei-half"), changes).tank.fill == 0.6
    assert isinstance(load_any_scenario(find_packaged("kolaei-half")), TankScenario)
    assert isinstance(load_any_scenario(find_packaged("paper-80-liquid")), Scenario)


def test_a_stop_with_a_mistake_is_no_tank_either(write: Write) -> None:
    with pytest.raises(ScenarioError, match=r"braking\.torque: must be a torque"):
        load_tank_scenario(write(edited(("5 kN m", "5"))))


def test_a_missing_file_guesses_the_one_beside_it(write: Write) -> None:
    path = write(BASE)
    with pytest.raises(ScenarioError) as caught:
        load_scenario(path.with_name("scenari.yaml"))
    assert caught.value.problems[0].fix == f"write `{path}`"


def test_replace_takes_si_numbers_and_texts_and_leaves_the_original(paper: Scenario) -> None:
    before = paper.model_dump()
    found = paper.with_(
        {
            "braking.torque": 12500.0,
            "braking.initial_speed": "160 km/h",
            "tank.liquid.model": "rigid",
            "contact.adhesion": "wet",
            "tank.coefficients": "computed",
            "tank.modes": 3,
            "name": "12",
            "track.rail": {"youngs_modulus": 2.1e11, "second_moment": "3e-5 m^4", "mass_per_length": 54},
        }
    )
    assert (found.braking.torque, found.braking.initial_speed) == (12500.0, pytest.approx(160 / 3.6, rel=1e-15))
    assert (found.tank.liquid.model, found.contact.adhesion.mu0) == ("rigid", 0.3)
    assert (found.tank.coefficients, found.tank.modes, found.name) == ("computed", 3, "12")
    assert found.track.rail.model_dump() == {"youngs_modulus": 2.1e11, "second_moment": 3e-5, "mass_per_length": 54.0}
    assert paper.model_dump() == before
    assert paper.with_({"contact.adhesion": paper.contact.adhesion}) == paper


def test_replace_from_computed_to_given_coefficients_and_back(paper: Scenario) -> None:
    given = paper.tank.coefficients
    computed = paper.with_({"tank.coefficients": "computed"})
    assert computed.with_({"tank.coefficients": given}) == paper
    with pytest.raises(ScenarioError, match=r"tank\.modes: must not be set where"):
        computed.with_({"tank.modes": 2}).with_({"tank.coefficients": given})


def test_replace_of_a_tank_alone() -> None:
    tank = load_tank_scenario(find_packaged("kolaei-half"))
    found = tank.with_({"tank.radius": 1.0, "tank.coefficients": "computed"})
    assert (type(found), found.tank.width) == (TankScenario, 2.0)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("braking.torque", "12", "braking.torque: must be a torque with its unit, such as"),
        ("braking.torque", -1.0, "braking.torque: must be a torque from 0 N m to 1e6 N m; given `-1 N m`"),
        ("braking.torque", True, "braking.torque: must be a torque"),
        ("braking.torque", float("nan"), "braking.torque: must be a torque"),
        ("braking.torq", 5.0, "braking.torq: is not a key of `braking`"),
        ("tank.fill", 2.0, "tank.fill: must be a number from 0.02 to 0.995"),
        ("track.domain.length", 15.0, "track.domain.length: must hold the wheels"),
        ("tank.modes", 2, "tank.modes: must not be set where"),
    ],
)
def test_replace_refuses_what_a_file_may_not_have(paper: Scenario, key: str, value: object, message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        paper.with_({key: value})
    assert str(caught.value).startswith(message)
    assert caught.value.file == "paper-80-liquid"


def test_loading_takes_well_under_a_tenth_of_a_second() -> None:
    path = find_packaged("paper-80-liquid")
    load_scenario(path)
    started = time.perf_counter()
    for _ in range(5):
        load_scenario(path)
    assert time.perf_counter() - started < 0.5
