"""How much is in a tank: a depth, a volume, a mass or the gross mass of the wagon; exactly one of them."""

import math
import pickle
from pathlib import Path

import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario import (
    OutlivedCoefficientsError,
    find_packaged,
    load_any_scenario,
    load_scenario,
    parse_scenario,
    scenario_to_yaml,
)
from slosh_cli.section import EllipticalSection, PolygonalSection, RectangularSection, depth_of_area
from slosh_cli.study.build import grid
from slosh_cli.study.table import column_of, columns

WAGON, PAPER = find_packaged("tank-wagon"), find_packaged("paper-80-liquid")
ALONE = Path(__file__).parents[2] / "scenarios/kolaei_half.yaml"
TARE = 21.3 + 2 * 1.8 + 4 * 1.4
HALF = math.pi * 1.5**2 / 2 * 15.5
SHELF = ((-1.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.4, 1.0), (0.4, 1.4), (1.2, 1.4), (1.2, 2.0), (-1.2, 2.0))
SHELF = (*SHELF, (-1.2, 1.4), (-0.4, 1.4), (-0.4, 1.0), (-1.0, 1.0))
POLYGON = "tank={shape: polygon, points: [[-1, 0], [1, 0], [1.4, 2], [-1.4, 2]], length: 10 m, bottom_height: 1 m, "


@pytest.mark.parametrize(
    "amount",
    [
        f"volume={HALF!r} m^3",
        f"volume={HALF * 1e3!r} L",
        f"mass={0.83 * HALF!r} t",
        f"gross_mass={TARE + 0.83 * HALF!r} t",
    ],
)
def test_a_half_full_circle_by_any_amount(amount: str) -> None:
    """An override displaces the file's own amount."""
    found = load_scenario(WAGON, [f"tank.{amount}"])
    assert found.tank.fill == pytest.approx(0.5, rel=1e-12)
    assert found.tank.model_fields_set.isdisjoint({"fill"})
    again = parse_scenario(scenario_to_yaml(found))
    assert again == found == pickle.loads(pickle.dumps(found))
    assert amount.partition("=")[0] in scenario_to_yaml(found)
    assert "fill:" not in scenario_to_yaml(found)


@pytest.mark.parametrize(
    "section",
    [RectangularSection(2.4, 2.0), EllipticalSection(1.5, 1.5), EllipticalSection(1.3, 1.0), PolygonalSection(SHELF)],
    ids=["box", "circle", "ellipse", "shelves"],
)
def test_the_depth_of_an_area_is_the_inverse_of_the_area_of_a_depth(section) -> None:
    for share in (0.02, 0.1, 0.37, 0.5, 0.69999, 0.7001, 0.9, 0.995):
        depth = share * section.height
        assert depth_of_area(section, section.area(depth)) == pytest.approx(depth, rel=1e-9)
    assert depth_of_area(section, 0.0) == 0.0
    assert depth_of_area(section, 1e3) == section.height


def test_a_polygon_by_its_mass() -> None:
    """A trapezium 2 m wide at the bottom and 0.4 m wider per metre: 2 h + 0.2 h^2 = 2.2 at h = 1 m."""
    tank = POLYGON + "mass: 22 t, liquid: {model: rigid, density: 1000 kg/m^3}}"
    assert load_scenario(WAGON, [tank]).tank.fill == pytest.approx(0.5, rel=1e-12)


def test_an_amount_stays_what_it_is_when_other_values_change() -> None:
    by_mass = load_scenario(WAGON, ["tank.mass=40 t"])
    by_gross = load_scenario(WAGON, ["tank.gross_mass=80 t"])
    for lighter in (by_mass, by_gross):
        assert lighter.with_({"tank.liquid.density": 1000.0}).tank.fill < lighter.tank.fill
    other = by_gross.with_({"wagon.car_body.mass": "31.3 t"})
    assert other.tank.fill == pytest.approx(load_scenario(WAGON, ["tank.gross_mass=70 t"]).tank.fill, rel=1e-12)
    assert by_gross.tank.fill != other.tank.fill
    assert by_mass.with_({"wagon.car_body.mass": "31.3 t"}).tank.fill == by_mass.tank.fill
    assert by_gross.with_({"tank.fill": 0.4}).tank.gross_mass is None


def test_a_study_of_gross_masses_tells_the_fill() -> None:
    study = grid(load_scenario(WAGON), {"tank.gross_mass": "70:90:10 t", "braking.initial_speed": "80 km/h"})
    fills = {study.stop(index).scenario.tank.fill for index in range(study.size)}
    assert len(fills) == 3
    assert {"fill", "tank_gross_mass_t"} <= set(columns(study))
    assert "tank_gross_mass_t" in [column_of(axis) for axis in study.axes]


REFUSED = {
    "fill and mass": (["tank.fill=0.5", "tank.mass=30 t"], "--set tank.mass: must not be given beside `fill`"),
    "nothing": (["tank.volume=0 m^3"], "must be a volume above 0 m"),
    "negative": (["tank.mass=-3 t"], "must be a mass above 0 kg"),
    "too much": (["tank.volume=200 m^3"], "(the tank holds 109.563 m^3); write at most `109.497 m^3`"),
    "too little": (["tank.mass=1 kg"], "2% to 99.5% of the tank's height"),
    "below tare": (["tank.gross_mass=20 t"], "the wagon itself weighs 30.5 t); write at least `30.9341 t`"),
    "too heavy": (["tank.gross_mass=200 t"], "write at most `121.382 t`"),
    "out of this world": (["tank.gross_mass=1e9 t"], "must be a mass above 0 kg and to 1e8 kg"),
    "no unit": (["tank.volume=45"], "write `45 m^3` or `45 L`"),
    "another unit": (["tank.mass=45 m^3"], "which is a volume"),
    "no number": (["tank.mass=.nan t"], "must be a mass"),
    "empty": (["tank.gross_mass="], "must be"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_no_wagon_carries_is_refused_with_the_numbers(case: str) -> None:
    overrides, said = REFUSED[case]
    with pytest.raises(ScenarioError) as refused:
        load_scenario(WAGON, overrides)
    assert said in str(refused.value)


def test_two_amounts_or_none_in_a_file(tmp_path: Path) -> None:
    file, text = tmp_path / "w.yaml", WAGON.read_text(encoding="utf-8")
    line = text.splitlines().index(next(one for one in text.splitlines() if "  fill: 0.5" in one)) + 1
    file.write_text(text.replace("  fill: 0.5", "  fill: 0.5\n  mass: 40 t"), encoding="utf-8")
    with pytest.raises(ScenarioError, match=rf":{line + 1}: tank.mass: must not be given beside `fill`"):
        load_scenario(file)
    assert load_scenario(file, ["tank.gross_mass=80 t"]).tank.mass is None
    file.write_text(text.replace("  fill: 0.5 ", "  #"), encoding="utf-8")
    with pytest.raises(ScenarioError, match="must have one of the keys fill, volume, mass and gross_mass"):
        load_scenario(file)


def test_a_tank_alone_has_no_gross_mass() -> None:
    with pytest.raises(ScenarioError, match="must not be given for a tank alone: it is the mass of wagon and load"):
        load_any_scenario(ALONE, ["tank.gross_mass=30 t"])
    assert load_any_scenario(ALONE, ["tank.mass=20 t", "tank.coefficients=computed"]).tank.fill > 0.5


@pytest.mark.parametrize("change", ["tank.mass=55 t", "tank.volume=60 m^3", "tank.gross_mass=80 t"])
def test_given_coefficients_belong_to_one_fill_by_whichever_key(change: str) -> None:
    with pytest.raises(OutlivedCoefficientsError, match=rf"--set {change.partition('=')[0]}: .* instead of `0\.5`"):
        load_scenario(PAPER, [change])
    assert load_scenario(PAPER, [f"tank.volume={HALF!r} m^3"]).tank.coefficients != "computed"


def test_given_coefficients_of_a_gross_mass_belong_to_one_wagon(tmp_path: Path) -> None:
    file = tmp_path / "w.yaml"
    file.write_text(PAPER.read_text(encoding="utf-8").replace("fill: 0.5", "gross_mass: 75.969 t"), encoding="utf-8")
    assert load_scenario(file, ["wagon.pivot_spacing=11 m"]).tank.coefficients != "computed"
    with pytest.raises(OutlivedCoefficientsError, match=r"--set wagon\.car_body\.mass: .* must stay"):
        load_scenario(file, ["wagon.car_body.mass=22 t"])
    with pytest.raises(OutlivedCoefficientsError):
        grid(load_scenario(file), {"wagon.car_body.mass": "21:23:1 t", "braking.torque": "5 kN m"}).check()
