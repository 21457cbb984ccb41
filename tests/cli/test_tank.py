"""`slosh tank coefficients`, `excite` and `chart`."""

import csv
import json
from pathlib import Path

import h5py
import numpy as np
import pytest
from matplotlib.image import imread
from stand_ins import PAPER, Outcome, Slosh

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.scenario import load_any_scenario

HALF = PAPER.parent / "kolaei_half.yaml"
COMPUTED = ("--set", "tank.coefficients=computed")


@pytest.fixture(autouse=True)
def _coarse_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slosh_cli.report.figures.RESOLUTION", 30)


def answer(outcome: Outcome) -> dict:
    assert outcome.code == ExitCode.DONE, outcome.err
    return json.loads(outcome.out)


def rows_of(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8") as table:
        return list(csv.DictReader(table))


def test_coefficients_have_the_keys_of_the_contract(slosh: Slosh, tmp_path: Path) -> None:
    found = answer(slosh("tank", "coefficients", HALF, "--modes", 3, "--json"))
    assert found["liquid_mass_kg"] == pytest.approx(12982.78, abs=0.01)
    assert found["centroid_m"] == pytest.approx(1.2 * (1 - 4 / (3 * np.pi)))
    assert [mode["n"] for mode in found["modes"]] == [1, 3, 5]
    keys = ["n", "omega_rad_s", "lambda_1_kg", "lambda_02_kg_m", "mu_kg", "mass_fraction", "height_m"]
    assert all(list(mode) == keys for mode in found["modes"] + found["given"])
    first, given = found["modes"][0], found["given"][0]
    assert first["omega_rad_s"] == pytest.approx(1.586020, rel=1e-6)
    assert first["mass_fraction"] == pytest.approx(first["lambda_1_kg"] ** 2 / first["mu_kg"] / found["liquid_mass_kg"])
    assert first["height_m"] == pytest.approx(first["lambda_02_kg_m"] / first["lambda_1_kg"])
    assert given["omega_rad_s"] == 1.65
    assert found["deviations_percent"][0]["omega_rad_s"] == pytest.approx(4.03, abs=0.01)
    assert found["pitch_inertia_stokes_joukowski_kg_m2"] < found["pitch_inertia_frozen_kg_m2"]
    assert found["accuracy"]["frequency_change"] < 1e-5
    assert len(found["warnings"]) == 1
    assert "0.8211" in found["warnings"][0]
    assert list(tmp_path.iterdir()) == []


def test_coefficients_as_a_table_fit_the_terminal_and_warn(
    slosh: Slosh, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    outcome = slosh("tank", "coefficients", PAPER)
    assert outcome.code == ExitCode.DONE
    assert "…" not in outcome.out
    for text in (
        "0.681815",
        "0.69",
        "+1.20",
        "-121225",
        "+13.07",
        "407229",
        "0.79366",
        "0.93454",
        "0.8634 m",
        "warning",
    ):
        assert text in outcome.out
    assert "45468.7 kg" in outcome.out


def test_computed_coefficients_have_nothing_beside_them(slosh: Slosh) -> None:
    found = answer(slosh("tank", "coefficients", HALF, *COMPUTED, "--json"))
    assert (found["given"], found["deviations_percent"], found["warnings"]) == ([], [], [])


def test_coefficients_draw_the_modes_where_a_folder_is_given(slosh: Slosh, tmp_path: Path) -> None:
    found = answer(slosh("tank", "coefficients", HALF, "--modes", 2, "-o", "here", "--json"))
    assert {file.name for file in (tmp_path / "here").iterdir()} == {
        "coefficients.csv", "mode_1.png", "mode_1.svg", "mode_3.png", "mode_3.svg",
    }  # fmt: skip
    table = rows_of(Path(found["files"]["table"]))
    assert [(row["source"], row["n"]) for row in table] == [("computed", "1"), ("computed", "3"), ("given", "1")]
    assert float(table[0]["omega_rad_s"]) == found["modes"][0]["omega_rad_s"]
    assert all(np.any(imread(tmp_path / "here" / f"mode_{n}.png")[..., :3] < 0.5) for n in (1, 3))
    assert "Slosh mode n = 3" in (tmp_path / "here" / "mode_3.svg").read_text(encoding="utf-8")


def test_a_tank_of_any_shape_is_drawn(slosh: Slosh, tmp_path: Path) -> None:
    text = HALF.read_text(encoding="utf-8").split("  # The coefficients")[0]
    polygon = text.replace("horizontal-cylinder", "polygon").replace(
        "radius: 1.2 m", "points: [[-1, 0], [1, 0], [1.5, 1], [0.5, 1], [0.5, 2], [-0.5, 2], [-0.5, 1], [-1.5, 1]]"
    )
    (tmp_path / "bottle.yaml").write_text(polygon, encoding="utf-8")
    assert slosh("tank", "coefficients", "bottle.yaml", "-o", "here").code == ExitCode.DONE
    assert (tmp_path / "here" / "mode_1.svg").exists()


def test_excite_writes_table_history_and_figure(slosh: Slosh, tmp_path: Path) -> None:
    found = answer(
        slosh("tank", "excite", HALF, "--deceleration", "0.2 g", "--duration", "10 s", "-o", "here", "--json")
    )
    names = {"excite.csv", "excite.h5", "excite.png", "excite.svg"}
    assert {file.name for file in (tmp_path / "here").iterdir()} == names
    assert found["max_normalised_force"] == pytest.approx(1.82, abs=0.005)
    assert found["min_normalised_force"] == pytest.approx(0.18, abs=0.005)
    assert found["mass_error"] == 0.0
    table = rows_of(tmp_path / "here" / "excite.csv")
    assert list(table[0]) == ["time_s", "force_N", "moment_N_m", "surface_front_m", "surface_rear_m"]
    assert [float(row["time_s"]) for row in table[:3]] == pytest.approx([0.0, 0.01, 0.02])
    assert float(table[-1]["time_s"]) == 10.0
    unit = found["liquid_mass_kg"] * 1.962
    assert max(float(row["force_N"]) for row in table) / unit == pytest.approx(found["max_normalised_force"], rel=1e-12)
    assert max(float(row["moment_N_m"]) for row in table) == found["max_moment_N_m"]
    assert max(float(row["surface_front_m"]) for row in table) == found["max_surface_m"]


def test_the_history_of_an_excitation_says_what_it_is(slosh: Slosh, tmp_path: Path) -> None:
    answer(slosh("tank", "excite", HALF, "--deceleration", "1 m/s^2", "--duration", "2 s", "-o", "here", "--json"))
    with h5py.File(tmp_path / "here" / "excite.h5") as file:
        assert file["liquid_force"].attrs["units"] == "N"
        assert file["deceleration"][0] == 1.0
        assert file["time"].shape == file["surface_rear"].shape == (201,)
        assert file.attrs["program"] == "slosh"
        assert file.attrs["max_normalised_force"] > 1.0
        (tmp_path / "again.yaml").write_bytes(file["scenario"][()])
    assert load_any_scenario(tmp_path / "again.yaml") == load_any_scenario(HALF)
    outcome = slosh("plot", "here/excite.h5")
    assert outcome.code == ExitCode.BAD_INPUT
    assert "not the history of a slosh run" in outcome.err


def test_the_ramp_and_the_liquid_are_the_users_choice(slosh: Slosh) -> None:
    ramp = ("--deceleration", "0.2 g", "--ramp", "2 s", "--json")
    assert answer(slosh("tank", "excite", HALF, *ramp, *COMPUTED))["max_normalised_force"] == pytest.approx(
        1.47, abs=0.005
    )
    found = answer(slosh("tank", "excite", HALF, *ramp, "--set", "tank.liquid.model=rigid"))
    assert (found["max_normalised_force"], found["max_surface_m"]) == (pytest.approx(1.0), 0.0)
    found = answer(slosh("tank", "excite", PAPER, *ramp, "--set", "tank.liquid.model=shallow-water"))
    assert 0.0 < found["mass_error"] < 1e-12
    assert found["max_surface_m"] <= found["surface_limit_m"] * (1 + 1e-12)


def test_without_a_folder_the_files_go_where_those_of_a_run_go(slosh: Slosh, tmp_path: Path) -> None:
    assert slosh("tank", "excite", HALF, "--deceleration", "0.1 g", "--duration", "1 s").code == ExitCode.DONE
    assert (tmp_path / "outputs" / "kolaei-half" / "excite.csv").exists()


def test_a_modal_liquid_through_the_roof_is_warned_of(slosh: Slosh) -> None:
    found = answer(slosh("tank", "excite", HALF, "--deceleration", "0.5 g", "--duration", "5 s", "--json"))
    assert any("outside the linear theory" in warning for warning in found["warnings"])


def test_a_table_is_linear_in_between(slosh: Slosh, tmp_path: Path) -> None:
    (tmp_path / "brake.csv").write_text("# a ramp\ntime_s,deceleration_m_s2\n0,0\n2,1.962\n\n", encoding="utf-8")
    by_table = answer(slosh("tank", "excite", HALF, "--table", "brake.csv", "--json"))
    by_ramp = answer(slosh("tank", "excite", HALF, "--deceleration", "0.2 g", "--ramp", "2 s", "--json"))
    assert by_table["max_normalised_force"] == pytest.approx(by_ramp["max_normalised_force"], rel=1e-12)


def test_a_table_of_a_german_spreadsheet_is_the_same_table(slosh: Slosh, tmp_path: Path) -> None:
    (tmp_path / "brake.csv").write_text("time_s,deceleration_m_s2\n0,0\n1.5,0.981\n", encoding="utf-8")
    (tmp_path / "bremse.csv").write_text("time_s;deceleration_m_s2\r\n0,0;0,0\r\n1,5;0,981\r\n", encoding="utf-8-sig")
    ours, theirs = (
        answer(slosh("tank", "excite", HALF, "--table", name, "--duration", "5 s", "--json"))
        for name in ("brake.csv", "bremse.csv")
    )
    assert ours["max_normalised_force"] == theirs["max_normalised_force"] > 1.0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time_s,deceleration_m_s2\n0,0\n1,x\n", "brake.csv:3: deceleration_m_s2: must be a finite number"),
        ("time_s,deceleration_m_s2\n0,0\n1\n", "brake.csv:3: deceleration_m_s2: must be a finite number"),
        ("time_s,deceleration_m_s2\n0,0\n1,nan\n", "brake.csv:3: deceleration_m_s2: must be a finite number"),
        ("time_s,deceleration_m_s2\n0,0\n2,1\n1,1\n", "brake.csv:4: time_s: must not fall from row to row"),
        ("time,a\n0,0\n", "must have the columns time_s and deceleration_m_s2"),
        ("", "must have the columns"),
        ("time_s,deceleration_m_s2\n", "at least one row"),
        ("time_s,deceleration_m_s2\n0,0\n", "must be decelerated"),
    ],
)
def test_a_table_that_is_none_is_named_with_its_line(slosh: Slosh, tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "brake.csv").write_text(text, encoding="utf-8")
    outcome = slosh("tank", "excite", HALF, "--table", "brake.csv")
    assert outcome.code == ExitCode.BAD_INPUT
    assert said in outcome.err
    assert [file.name for file in tmp_path.iterdir()] == ["brake.csv"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ((), "--deceleration '0.2 g', --table FILE.csv or --motion FILE.csv"),
        (("--deceleration", "1 g", "--table", "x.csv"), "--deceleration '0.2 g', --table FILE.csv or"),
        (("--deceleration", "1 g", "--start", "rest"), "--start goes with --motion"),
        (("--deceleration", "1 g", "--motion", "x.csv"), "leave out --deceleration, --ramp, --table"),
        (("--motion", "nowhere.csv"), "nowhere.csv: must exist"),
        (("--deceleration", "1 g", "--probe", "5.76 m"), "the front wall (5.75 m); given 5.76 m"),
        (("--deceleration", "1 g", "--probe", "1 kg"), "which is a mass"),
        (("--deceleration", "0.2"), "`0.2` without a unit"),
        (("--deceleration", "0.2 m/s"), "which is a speed"),
        (("--deceleration", "0 g"), "must be decelerated"),
        (("--deceleration", "1e9 g"), "must stay below"),
        (("--deceleration", "1 g", "--ramp", "-1 s"), "--ramp must not be negative"),
        (("--deceleration", "1 g", "--duration", "0 s"), "--duration must be positive"),
        (("--deceleration", "1 g", "--interval", "1 us", "--duration", "40 s"), "at most 1000000 rows"),
        (("--table", "nowhere.csv"), "nowhere.csv: must exist"),
        (("--ramp", "1 s", "--table", "nowhere.csv"), "--ramp goes with --deceleration"),
    ],
)
def test_wishes_that_cannot_be_met(slosh: Slosh, options: tuple[str, ...], said: str) -> None:
    outcome = slosh("tank", "excite", HALF, *options, "--json")
    assert outcome.code == ExitCode.BAD_INPUT
    assert said in json.loads(outcome.out)["error"]["message"]


def test_a_chart_has_a_row_per_filling_and_mode(slosh: Slosh, tmp_path: Path) -> None:
    found = answer(slosh("tank", "chart", HALF, "--fills", "0.3:0.7:0.2", "--modes", 2, "-o", "here", "--json"))
    table = rows_of(tmp_path / "here" / "fill_chart.csv")
    assert [(float(row["fill"]), row["n"]) for row in table] == [(f, n) for f in (0.3, 0.5, 0.7) for n in ("1", "3")]
    assert float(table[2]["omega_rad_s"]) == pytest.approx(1.58602, rel=1e-5)
    assert found["rows"][2]["mass_fraction"] == pytest.approx(0.738717, rel=1e-5)
    assert {file.name for file in (tmp_path / "here").iterdir()} == {
        "fill_chart.csv",
        "fill_chart.png",
        "fill_chart.svg",
    }


def motion_file(folder: Path, column: str, values: np.ndarray, time: np.ndarray) -> Path:
    rows = "".join(f"{t:.9g},{value:.12g}\n" for t, value in zip(time, values, strict=True))
    (folder / f"{column}.csv").write_text(f"time_s,{column}\n{rows}", encoding="utf-8")
    return folder / f"{column}.csv"


def test_a_motion_is_the_same_by_place_speed_and_acceleration(slosh: Slosh, tmp_path: Path) -> None:
    time = np.linspace(0.0, 8.0, 1601)
    courses = {
        "displacement_m": 0.1 * np.sin(1.2 * time),
        "velocity_m_s": 0.12 * np.cos(1.2 * time),
        "acceleration_m_s2": -0.144 * np.sin(1.2 * time),
    }
    peaks = {}
    for column, values in courses.items():
        file = motion_file(tmp_path, column, values, time)
        words = ("--motion", file, "--duration", "8 s", "--json", *COMPUTED)
        for start in ("rest", "moving"):
            found = answer(slosh("tank", "excite", HALF, *words, "--start", start))
            peaks[column, start] = (found["max_surface_m"], found["max_moment_N_m"])
    reference = peaks["acceleration_m_s2", "moving"]
    assert peaks["acceleration_m_s2", "rest"] == reference
    for column in ("displacement_m", "velocity_m_s"):
        assert peaks[column, "moving"] == pytest.approx(reference, rel=2e-3)
    at_rest = [peaks[column, "rest"] for column in ("displacement_m", "velocity_m_s")]
    assert at_rest[0] == pytest.approx(at_rest[1], rel=2e-3)
    assert abs(at_rest[0][0] / reference[0] - 1) > 0.2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time_s,place\n0,0\n1,1\n", "must have exactly one of the columns"),
        ("time_s,displacement_m,velocity_m_s\n0,0,0\n1,1,1\n", "must have exactly one of the columns"),
        ("time_s,velocity_m_s\n1,0\n2,1\n", "must begin at 0 s"),
        ("time_s,velocity_m_s\n0,0\n0,1\n", "must rise from row to row"),
        ("time_s,displacement_m\n0,0\n1,1\n", "needs at least 4 rows; given 2"),
        ("time_s,velocity_m_s\n0,1\n1,1\n", "must be decelerated at some time"),
    ],
)
def test_motions_that_are_none(slosh: Slosh, tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "motion.csv").write_text(text, encoding="utf-8")
    outcome = slosh("tank", "excite", HALF, "--motion", "motion.csv", "--json")
    assert outcome.code == ExitCode.BAD_INPUT
    assert said in outcome.out


def test_a_start_that_is_none(slosh: Slosh, tmp_path: Path) -> None:
    motion_file(tmp_path, "velocity_m_s", np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    outcome = slosh("tank", "excite", HALF, "--motion", "velocity_m_s.csv", "--start", "now", "--json")
    assert "--start must be rest or moving; given `now`" in outcome.out


@pytest.mark.parametrize("model", ["modal", "shallow-water"])
def test_probes_and_profiles_are_the_surface_between_the_walls(slosh: Slosh, tmp_path: Path, model: str) -> None:
    words = ("--deceleration", "0.2 m/s^2", "--duration", "5 s", *COMPUTED, "--set", f"tank.liquid.model={model}")
    probes = ("--probe", "0 m", "--probe", "2.875 m", "--probe", "5.75 m")
    found = answer(slosh("tank", "excite", HALF, *words, *probes, "-o", "here", "--json"))
    with h5py.File(found["files"]["history"]) as file:
        assert np.allclose(file["surface_at_0"], file["surface_rear"], atol=1e-12)
        assert np.allclose(file["surface_at_5.75"], file["surface_front"], atol=1e-12)
        assert np.abs(file["surface_at_2.875"][()]).max() < 0.1 * np.abs(file["surface_front"][()]).max()
        time, place, rise = (file[f"profile_{name}"][()] for name in ("time", "place", "rise"))
        assert rise.shape == (time.size, place.size)
        assert rise[:, -1] == pytest.approx(np.interp(time, file["time"], file["surface_front"]), abs=1e-9)
        # the liquid's weight does the moment but for its height: force and shift of one history belong together
        shift = file["liquid_shift"][()]
        assert shift.max() > 0.0
        assert np.corrcoef(shift, file["surface_front"])[0, 1] > 0.98
    assert "2.875 m from the rear wall" in (tmp_path / "here" / "excite.svg").read_text(encoding="utf-8")
    assert "surface_at_2.875_m" in rows_of(tmp_path / "here" / "excite.csv")[0]


def test_a_centre_that_moves_by_a_hundredth_of_the_length_is_beyond_linear_theory(slosh: Slosh) -> None:
    words = ("--ramp", "5 s", "--duration", "10 s", "--json", *COMPUTED)
    gentle, firm = (
        answer(slosh("tank", "excite", HALF, "--deceleration", f"{level} m/s^2", *words)) for level in (0.03, 0.2)
    )
    name = "shift of the liquid's centre over the length of the tank"
    shifts = [next(check["value"] for check in found["checks"] if check["check"] == name) for found in (gentle, firm)]
    assert shifts[0] < 0.01 < shifts[1]
    assert not any("leave linear theory" in warning for warning in gentle["warnings"])
    assert any("leave linear theory" in warning for warning in firm["warnings"])


@pytest.mark.parametrize("fills", ["0.01", "0.5,1.2", "half", "0.1:0.9", "0.5 m", ""])
def test_fillings_that_are_none(slosh: Slosh, fills: str) -> None:
    outcome = slosh("tank", "chart", HALF, "--fills", fills)
    assert outcome.code == ExitCode.BAD_INPUT
    assert "--fills" in outcome.err


def test_every_axis_of_the_figures_has_a_unit(slosh: Slosh, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    monkeypatch.setattr("slosh_cli.report.saving.save", lambda figure, *_: drawn.append(figure) or [])
    slosh("tank", "coefficients", HALF, "-o", "here")
    slosh("tank", "excite", HALF, "--deceleration", "1 m/s^2", "--duration", "2 s", "-o", "here")
    slosh("tank", "chart", HALF, "--fills", "0.3,0.5", "-o", "here")
    assert len(drawn) == 3
    for figure in drawn:
        for axes in figure.axes:
            assert axes.get_ylabel(), axes.get_title()
        assert figure.axes[-1].get_xlabel() or figure.axes[-1].get_ylabel().startswith("potential")


def test_an_excitation_never_replaces_another_one(slosh: Slosh, tmp_path: Path) -> None:
    outputs = tmp_path / "outputs"
    short = ["tank", "excite", PAPER, "--duration", "0.1 s"]
    for level in ("1 m/s^2", "2 m/s^2", "1 m/s^2"):
        assert slosh(*short, "--deceleration", level).code == 0
    slosh(*short, "--deceleration", "1 m/s^2", "--set", "tank.liquid.model=rigid")
    assert {folder.name for folder in outputs.iterdir()} == {
        "paper-80-liquid", "paper-80-liquid-2", "paper-80-liquid-tank.liquid.model=rigid",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("writer", "lost"),
    [
        ("results.hdf5.write_excitation", {"excite.h5"}),
        ("results.tables.write_table", {"excite.csv"}),
        ("report.tank_figures.excitation_figure", {"excite.png", "excite.svg"}),
    ],
)
def test_a_file_of_an_excitation_that_fails_costs_itself_alone(
    slosh: Slosh, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, writer: str, lost: set[str]
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(f"slosh_cli.{writer}", full)
    outcome = slosh("tank", "excite", PAPER, "--deceleration", "1 m/s^2", "--duration", "0.1 s", "-o", "here", "--json")
    assert outcome.code == 2
    found = json.loads(outcome.out)
    assert found["max_normalised_force"] > 0.0
    assert "No space left on device" in found["warnings"][-1]
    files = {file.name for file in (tmp_path / "here").iterdir()}
    assert files == {"excite.csv", "excite.h5", "excite.png", "excite.svg"} - lost
    told = [
        *found["files"]["figures"],
        *(found["files"][kind] for kind in ("table", "history") if kind in found["files"]),
    ]
    assert {file.rsplit("/")[-1] for file in told} == files


@pytest.mark.parametrize("model", ["modal", "shallow-water", "rigid"])
def test_both_directions_of_a_deceleration_have_the_same_extremes(slosh: Slosh, model: str) -> None:
    """The extreme is that of the magnitude, with its sign; a peak is no less a peak for pointing backwards."""
    given = ("--ramp", "1 s", "--duration", "8 s", "--set", f"tank.liquid.model={model}", *COMPUTED, "--json")
    forward, backward = (
        answer(slosh("tank", "excite", HALF, "--deceleration", f"{sign}0.1 g", *given)) for sign in ("", "-")
    )
    for key in ("max_normalised_force", "max_moment_N_m"):
        assert forward[key] > 0.0
        assert backward[key] == pytest.approx(-forward[key], rel=1e-3)
    assert backward["max_normalised_force"] <= -1.0 + 1e-9
    assert abs(backward["max_surface_m"]) == pytest.approx(abs(forward["max_surface_m"]), rel=1e-3)


def test_a_fall_of_the_surface_is_an_extreme_too(slosh: Slosh, tmp_path: Path) -> None:
    """Under the roof there is 0.2 m to rise, and 1.8 m to fall."""
    found = answer(box(slosh, tmp_path, "30 m/s"))
    table = rows_of(tmp_path / "here" / "excite.csv")
    changes = [float(row[f"surface_{end}_m"]) for row in table for end in ("front", "rear")]
    assert found["max_surface_m"] == min(changes) < -0.3
    assert max(changes) == pytest.approx(0.2, abs=1e-6)


BOX = """format: 1
name: box
tank:
  shape: rectangular
  width: 2 m
  height: 2 m
  length: 10 m
  fill: 0.9
  liquid: {model: shallow-water, density: 1000 kg/m^3}
"""


def box(slosh: Slosh, folder: Path, slot_speed: str) -> Outcome:
    (folder / "box.yaml").write_text(BOX, encoding="utf-8")
    return slosh(
        "tank", "excite", "box.yaml", "--set", f"tank.liquid.slot_speed={slot_speed}", "--deceleration", "0.1 g",
        "--ramp", "2 s", "--duration", "10 s", "-o", "here", "--json",
    )  # fmt: skip


def test_a_peak_of_the_slot_is_told_in_json_history_and_figure(slosh: Slosh, tmp_path: Path) -> None:
    """The peak is another one at 30 m/s and at 100 m/s: the slot's, not the liquid's."""
    slow, fast = (answer(box(slosh, tmp_path, speed)) for speed in ("30 m/s", "100 m/s"))
    assert fast["max_normalised_force"] > 1.15 * slow["max_normalised_force"]
    for found in (slow, fast):
        assert any("roof" in text and "slot_speed" in text for text in found["warnings"])
        (head,) = (check for check in found["checks"] if check["check"] == "head of pressure under the roof")
        assert head["value"] > 0.1
        assert not head["within"]
        assert found["recommendation"]["liquid_model"] == "shallow-water"
    with h5py.File(tmp_path / "here" / "excite.h5") as file:
        kept = json.loads(file.attrs["checks"])
        assert "slot_speed" in file.attrs["warnings"]
        assert "use tank.liquid.model" in file.attrs["recommendation"]
    assert [check["check"] for check in kept] == [check["check"] for check in fast["checks"]]
    assert "The liquid struck the roof" in (tmp_path / "here" / "excite.svg").read_text(encoding="utf-8")


def test_excite_tells_of_a_first_frequency_that_is_too_high(slosh: Slosh) -> None:
    given = ("--deceleration", "0.01 g", "--duration", "1 s", "--set", "tank.liquid.model=shallow-water", "--json")
    found = answer(slosh("tank", "excite", HALF, *given, "--set", "tank.length=4 m", *COMPUTED))
    assert any("overstates the first slosh frequency" in text for text in found["warnings"])
    assert found["recommendation"]["liquid_model"] == "modal"


def test_coefficients_have_checks_and_a_recommendation(slosh: Slosh) -> None:
    """Of a tank alone: up to which deceleration the modes may be used; of a stop: for its own deceleration."""
    found = answer(slosh("tank", "coefficients", HALF, "--json"))
    (bound,) = found["checks"]
    assert bound["value"] == pytest.approx(0.8211 / 0.8106, abs=1e-4)
    assert not bound["within"]
    assert found["recommendation"]["liquid_model"] is None
    assert found["recommendation"]["modal_up_to_m_s2"] > 0.0
    deep = answer(slosh("tank", "coefficients", HALF, "--json", "--set", "tank.liquid.model=shallow-water", "--set",
                        "tank.length=4 m", *COMPUTED))  # fmt: skip
    assert any("first slosh frequency" in text for text in deep["warnings"])
    stop = answer(slosh("tank", "coefficients", PAPER, "--json", *COMPUTED))
    assert stop["recommendation"]["liquid_model"] == "shallow-water"
    assert any("expected to move by 1.79 m" in text for text in stop["warnings"])
