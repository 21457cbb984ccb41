"""`slosh init`, `check`, `schema` and `plot`."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import h5py
import pytest
from stand_ins import PAPER, Slosh, Solver

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.scenario import Scenario, load_any_scenario, load_scenario, packaged_scenarios
from slosh_cli.scenario.packaged import packaged_trains


def test_init_writes_a_scenario_that_is_sound_and_commented(slosh: Slosh, tmp_path: Path) -> None:
    outcome = slosh("init")
    assert outcome.code == ExitCode.DONE
    text = (tmp_path / "tank-wagon.yaml").read_text(encoding="utf-8")
    assert "# " in text
    assert text == packaged_scenarios()["tank-wagon"].read_text(encoding="utf-8")
    assert load_scenario("tank-wagon.yaml").tank.coefficients == "computed"
    assert slosh("check", "tank-wagon.yaml").code == ExitCode.DONE


def test_init_names_the_file_after_the_scenario(slosh: Slosh, tmp_path: Path) -> None:
    assert slosh("init", "paper-80-liquid").code == ExitCode.DONE
    assert (tmp_path / "paper-80-liquid.yaml").read_bytes() == PAPER.read_bytes()
    assert slosh("init", "paper_160").code == ExitCode.DONE
    assert load_scenario("paper-160-liquid.yaml").name == "paper-160-liquid"


@pytest.mark.parametrize("name", packaged_scenarios())
def test_init_writes_any_packaged_scenario(slosh: Slosh, tmp_path: Path, name: str) -> None:
    outcome = slosh("init", name, "-o", "mine.yaml")
    assert outcome.code == ExitCode.DONE
    a_stop = isinstance(load_any_scenario("mine.yaml"), Scenario)
    assert ("slosh run mine.yaml" in outcome.out) is a_stop
    assert set(packaged_scenarios()) - set(re.findall(r"[\w-]+", outcome.out)) == {name}
    written = (tmp_path / "mine.yaml").read_text(encoding="utf-8")
    assert written == packaged_scenarios()[name].read_text(encoding="utf-8").replace(f"name: {name}\n", "name: mine\n")
    assert load_any_scenario("mine.yaml").name == "mine"
    assert slosh("check", "mine.yaml").code == ExitCode.DONE


def test_init_never_overwrites(slosh: Slosh, tmp_path: Path) -> None:
    (tmp_path / "tank-wagon.yaml").write_text("mine")
    outcome = slosh("init")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "exists already" in outcome.err
    assert (tmp_path / "tank-wagon.yaml").read_text() == "mine"


def test_init_lists_the_packaged_scenarios(slosh: Slosh, tmp_path: Path) -> None:
    assert slosh("init", "--list").out.split() == [*packaged_scenarios(), *packaged_trains()]
    assert list(tmp_path.iterdir()) == []


def test_init_guesses_the_name_that_was_meant(slosh: Slosh, tmp_path: Path) -> None:
    outcome = slosh("init", "paper_08")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "paper-80-liquid" in outcome.err
    assert list(tmp_path.iterdir()) == []


def test_init_into_a_missing_folder_is_the_users_matter(slosh: Slosh) -> None:
    outcome = slosh("init", "-o", "nowhere/mine.yaml")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "cannot write" in outcome.err


def test_check_of_a_sound_scenario(slosh: Slosh) -> None:
    outcome = slosh("check", PAPER)
    assert outcome.code == ExitCode.DONE
    assert "paper-80-liquid" in outcome.out
    answer = json.loads(slosh("check", PAPER, "--json").out)
    assert answer["valid"] is True
    assert answer["name"] == "paper-80-liquid"


def test_check_names_every_mistake_with_its_line(slosh: Slosh, tmp_path: Path) -> None:
    lines = PAPER.read_text(encoding="utf-8").splitlines()
    first = next(n for n, line in enumerate(lines) if "torque: 5 kN m" in line)
    second = next(n for n, line in enumerate(lines) if "pivot_spacing: 12 m" in line)
    lines[first] = lines[first].replace("5 kN m", "5")
    lines[second] = lines[second].replace("pivot_spacing", "pivot_spacin")
    (tmp_path / "bad.yaml").write_text("\n".join(lines), encoding="utf-8")
    outcome = slosh("check", "bad.yaml")
    assert outcome.code == ExitCode.BAD_INPUT
    assert f"bad.yaml:{first + 1}: braking.torque" in outcome.err
    assert f"bad.yaml:{second + 1}: wagon.pivot_spacin" in outcome.err
    error = json.loads(slosh("check", "bad.yaml", "--json").out)["error"]
    assert error["code"] == "scenario"
    assert error["where"].startswith("bad.yaml:")


def test_check_takes_changed_values(slosh: Slosh) -> None:
    assert slosh("check", PAPER, "--set", "tank.fill=0.7", "--set", "tank.coefficients=computed").code == ExitCode.DONE
    assert slosh("check", PAPER, "--set", "tank.fill=1.7").code == ExitCode.BAD_INPUT


def test_schema_is_a_json_schema_of_the_scenario(slosh: Slosh) -> None:
    outcome = slosh("schema")
    schema = json.loads(outcome.out)
    assert outcome.code == ExitCode.DONE
    assert {"wagon", "tank", "track", "contact", "braking"} <= set(schema["properties"])


def test_schema_of_a_study(slosh: Slosh) -> None:
    schema = json.loads(slosh("schema", "study").out)
    assert set(schema["properties"]) == {"name", "description", "base", "vary", "liquid"}
    assert {"tank.fill", "braking.torque", "contact.adhesion"} <= set(schema["properties"]["vary"]["properties"])
    assert (
        json.loads(slosh("schema", "scenario").out)["properties"]
        == json.loads(slosh("schema").out)["else"]["properties"]
    )


def test_plot_draws_beside_the_history(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    slosh("run", PAPER, "-o", "here", "--no-figures")
    outcome = slosh("plot", "here/run.h5")
    assert outcome.code == ExitCode.DONE
    drawn = {Path(line) for line in outcome.out.split()}
    assert drawn == {Path("here") / file.name for file in (tmp_path / "here").iterdir()} - {
        Path("here/run.h5"),
        Path("here/summary.csv"),
    }
    assert len(drawn) == 8


def test_plot_draws_where_the_user_wants(slosh: Slosh, solver: Solver, tmp_path: Path) -> None:
    slosh("run", PAPER, "-o", "here", "--no-figures")
    assert slosh("plot", "here/run.h5", "-o", "there").code == ExitCode.DONE
    assert len(list((tmp_path / "there").iterdir())) == 8
    assert len(list((tmp_path / "here").iterdir())) == 2


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (
            lambda file: [file.pop(f"wheel_{i}_speed") for i in (1, 2, 3, 4)],
            "it lacks the channels wheel_1_speed, wheel",
        ),
        (
            lambda file: file.attrs.modify("status", "nonsense"),
            "its attribute status must be one of stopped, time-limit",
        ),
    ],
)
def test_plot_of_a_damaged_history_names_what_is_missing(
    slosh: Slosh, solver: Solver, tmp_path: Path, spoil: Callable[[h5py.File], object], said: str
) -> None:
    slosh("run", PAPER, "-o", "here")
    with h5py.File(tmp_path / "here" / "run.h5", "r+") as file:
        spoil(file)
    outcome = slosh("plot", "here/run.h5", "-o", "there")
    assert outcome.code == ExitCode.BAD_INPUT
    assert f"cannot read {Path('here/run.h5')} as a slosh history: {said}" in outcome.err
    assert not (tmp_path / "there").exists()


@pytest.mark.parametrize("file", ["nowhere.h5", PAPER, "."])
def test_plot_of_something_else_is_the_users_matter(slosh: Slosh, tmp_path: Path, file: object) -> None:
    outcome = slosh("plot", file)
    assert outcome.code == ExitCode.BAD_INPUT
    assert str(file) in outcome.err
    assert list(tmp_path.iterdir()) == []


def test_the_name_of_a_new_scenario_can_name_a_folder(slosh: Slosh) -> None:
    assert slosh("init", "-o", "my wagon (2).yaml").code == ExitCode.DONE
    assert load_scenario("my wagon (2).yaml").name == "my-wagon-2"


_OF_PRESETS = ["init", "--wagon", "zacns-like", "--product", "petrol", "--temperature", "30 C", "--gross", "75t"]


def test_init_writes_a_scenario_of_presets_and_never_overwrites(slosh: Slosh, tmp_path: Path) -> None:
    file = tmp_path / "my.yaml"
    assert slosh(*_OF_PRESETS, "-o", str(file)).code == 0
    scenario = load_scenario(file)
    assert (scenario.name, scenario.tank.liquid.density, scenario.tank.gross_mass) == ("my", 731.4, 75000.0)
    assert scenario.braking.initial_speed == pytest.approx(100.0 / 3.6)
    before = file.read_text(encoding="utf-8")
    assert slosh(*_OF_PRESETS, "-o", str(file)).code == 2
    assert file.read_text(encoding="utf-8") == before


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--gross", "120 t"], "the tank holds"),
        (["--wagon", "zacn"], "did you mean `zacns-like`?"),
        (["--temperature", "90"], "must be from -20 to 50 C"),
        (["--product", "k-blocks"], "must be the name of a product preset"),
        (["tank-wagon"], "must stand alone"),
        (["--load", "60 %"], "exactly one of --load and --gross"),
    ],
)
def test_init_writes_nothing_that_is_not_sound(options: list[str], told: str, slosh: Slosh, tmp_path: Path) -> None:
    file = tmp_path / "my.yaml"
    found = slosh(*_OF_PRESETS, *options, "-o", str(file))
    assert (found.code, file.exists()) == (2, False)
    assert told in found.err


def test_init_asks_on_a_terminal_and_nowhere_else(
    slosh: Slosh, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = {"Wagon": "15-9049", "Mass": "80 t"}

    def prompt(question: str, default: str | None) -> str:
        return default or answers[question.split(maxsplit=1)[0]]

    monkeypatch.setattr("typer.prompt", prompt)
    assert slosh("init").code == 0
    assert (tmp_path / "tank-wagon.yaml").exists()
    monkeypatch.setattr("slosh_cli.cli.init._on_a_terminal", lambda: True)
    assert slosh("init").code == 0
    assert load_scenario(tmp_path / "15-9049-diesel.yaml").wagon.pivot_spacing == 7.8
    answers |= {"Wagon": "zacns-like", "Mass": "60 %"}
    assert slosh("init").code == 0
    assert load_scenario(tmp_path / "zacns-like-diesel.yaml").tank.volume == pytest.approx(52.2, abs=0.1)


def test_presets_are_listed_and_printed_with_their_sources(slosh: Slosh) -> None:
    assert "15-9049" in slosh("presets").out
    told = slosh("presets", "15-9049").out
    assert "wagon.pivot_spacing: 7.8 m  [published: data sheet of the wagon]" in told
    listed = json.loads(slosh("presets", "--json").out)["presets"]
    assert {entry["kind"] for entry in listed} == {"wagon", "bogie", "track", "product", "brake", "default"}
    assert json.loads(slosh("presets", "diesel", "--json").out)["un"] == 1202
    refused = slosh("presets", "dieesl")
    assert (refused.code, "did you mean `diesel`?" in refused.err) == (2, True)


@pytest.mark.parametrize("group", [(), ("tank",)])
def test_help_cuts_no_line_of_a_command(group: tuple[str, ...], slosh: Slosh, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a command does fits beside its name on 80 columns."""
    monkeypatch.setenv("COLUMNS", "80")
    listed = slosh(*group, "--help").out.partition("Commands:\n")[2]
    assert not re.findall(r".*\.\.\.$", listed, re.MULTILINE)
