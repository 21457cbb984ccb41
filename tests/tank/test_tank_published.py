"""The paper's tanks: printed coefficients beside computed ones, and what is known about the difference."""

import csv
import math
from pathlib import Path

import pytest
from tank_examples import cylinder

from slosh_cli.scenario import Coefficient, Liquid, load_tank_scenario
from slosh_cli.tank.coefficients import computed_modes, slosh_modes
from slosh_cli.tank.comparison import LARGEST_MASS_FRACTION, compare_modes, impossible_fractions
from slosh_cli.tank.load import frozen_load

ROOT = Path(__file__).parents[2]
NAMES = ("frequency", "lambda_1", "lambda_02", "mu")


def printed():
    with (ROOT / "tests" / "data" / "coefficients.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {row.pop("case"): {name: float(value) for name, value in row.items()} for row in rows}


PRINTED = printed()


def tank_of(case):
    row = PRINTED[case]
    liquid = Liquid(model="modal", density=row["density_kg_m3"])
    given = Coefficient(
        frequency=row["omega_rad_s"], lambda_1=row["lambda_11_kg"], lambda_02=row["lambda_021_kg_m"], mu=row["mu_1_kg"]
    )
    tank = cylinder(row["depth_m"] / (2.0 * row["radius_m"]), row["radius_m"], row["length_m"], liquid)
    return tank.model_copy(update={"coefficients": (given,)})


@pytest.mark.parametrize(
    ("case", "scenario"),
    [("kolaei-half", "kolaei_half"), ("kolaei-three-quarters", "kolaei_three_quarters"), ("tagkks-half", "paper_80")],
)
def test_the_shipped_scenarios_carry_the_printed_figures(case, scenario):
    shipped = load_tank_scenario(ROOT / "scenarios" / f"{scenario}.yaml").tank
    assert slosh_modes(shipped) == slosh_modes(tank_of(case))
    assert frozen_load(shipped).mass == pytest.approx(frozen_load(tank_of(case)).mass)


COMPUTED = {
    "kolaei-half": (1.58602016466, -16050.7284347, -3388.18031519, 26862.3212284, 0.738717140697),
    "kolaei-three-quarters": (2.02612765800, -13900.3385737, -3963.71405446, 14256.8055621, 0.648791730989),
    "tagkks-half": (0.681814985949, -121225.223563, -28485.6295521, 407228.598713, 0.793661899073),
}
"""omega, lambda_1, lambda_02, mu and mass fraction on the program's first mesh refined four times."""


@pytest.mark.parametrize("case", PRINTED)
def test_computed_coefficients(case):
    tank = tank_of(case)
    mode = computed_modes(tank, 1)[0]
    omega, lambda_1, lambda_02, mu, fraction = COMPUTED[case]
    assert (mode.frequency, mode.lambda_1, mode.mu) == pytest.approx((omega, lambda_1, mu), rel=3e-7)
    assert mode.lambda_02 == pytest.approx(lambda_02, rel=2e-6)
    assert mode.slosh_mass / frozen_load(tank).mass == pytest.approx(fraction, rel=1e-6)


@pytest.mark.parametrize(
    ("case", "fraction"), [("kolaei-half", 0.8211), ("kolaei-three-quarters", 0.7144), ("tagkks-half", 0.9345)]
)
def test_printed_mass_fractions_break_the_bound_in_both_half_filled_tanks(case, fraction):
    tank = tank_of(case)
    mode = slosh_modes(tank)[0]
    found = mode.slosh_mass / frozen_load(tank).mass
    assert found == pytest.approx(fraction, abs=5e-5)
    said = impossible_fractions(tank)
    assert len(said) == (1 if found > LARGEST_MASS_FRACTION else 0)
    assert (found > LARGEST_MASS_FRACTION) == (case != "kolaei-three-quarters")
    assert all(f"{fraction:.4f}" in sentence and "0.8106" in sentence for sentence in said)


@pytest.mark.parametrize(
    ("case", "deviation"), [("kolaei-half", 4.0), ("kolaei-three-quarters", 3.6), ("tagkks-half", 1.2)]
)
def test_printed_frequencies_are_one_to_four_percent_high(case, deviation):
    row = compare_modes(tank_of(case))[0]
    assert 100.0 * row.deviations()["frequency"] == pytest.approx(deviation, abs=0.06)


@pytest.mark.parametrize(
    ("case", "from_lambda", "from_mu", "from_both"),
    [
        ("kolaei-half", 1024.0, 1022.9, 1025.2),
        ("kolaei-three-quarters", 1021.9, 1020.7, 1023.2),
        ("tagkks-half", 938.5, 923.0, 954.3),
    ],
)
def test_printed_masses_belong_to_another_density(case, from_lambda, from_mu, from_both):
    """lambda_1 is proportional to the density, mu to density over omega^2, lambda_1^2/mu to density times omega^2."""
    row = compare_modes(tank_of(case))[0]
    density = PRINTED[case]["density_kg_m3"]
    given, computed = row.given, row.computed
    slower = (given.frequency / computed.frequency) ** 2
    assert density * given.lambda_1 / computed.lambda_1 == pytest.approx(from_lambda, abs=0.3)
    assert density * given.mu / computed.mu * slower == pytest.approx(from_mu, abs=0.3)
    assert density * given.slosh_mass / computed.slosh_mass / slower == pytest.approx(from_both, abs=0.3)


@pytest.mark.parametrize("case", PRINTED)
def test_printed_heights_match_neither_the_bottom_nor_the_surface(case):
    row = compare_modes(tank_of(case))[0]
    depth = PRINTED[case]["depth_m"]
    for origin in (0.0, depth):
        about = row.computed.height - origin
        assert abs(row.given.height - about) > 0.05
        assert abs(-row.given.height - about) > 0.05


def test_the_wagon_tanks_printed_couplings_differ_in_sign():
    assert slosh_modes(tank_of("tagkks-half"))[0].height < 0.0
    assert slosh_modes(tank_of("kolaei-half"))[0].height > 0.0


def ramp_peak(mode, mass, duration):
    """Peak of force/(m a) under a ramp of a deceleration, then held, undamped."""
    phase = mode.frequency * duration / 2.0
    return 1.0 + mode.slosh_mass / mass * abs(math.sin(phase) / phase if phase > 0.0 else 1.0)


@pytest.mark.parametrize(("case", "peak"), [("kolaei-half", 1.47), ("kolaei-three-quarters", 1.29)])
def test_a_ramp_of_two_seconds_gives_the_papers_table_1(case, peak):
    tank = tank_of(case)
    assert ramp_peak(computed_modes(tank, 1)[0], frozen_load(tank).mass, 2.0) == pytest.approx(peak, abs=0.005)


@pytest.mark.parametrize(("case", "peak"), [("kolaei-half", 1.82), ("kolaei-three-quarters", 1.71)])
def test_a_step_with_the_printed_coefficients_does_not(case, peak):
    tank = tank_of(case)
    assert ramp_peak(slosh_modes(tank)[0], frozen_load(tank).mass, 0.0) == pytest.approx(peak, abs=0.005)


def test_deviations_do_not_depend_on_the_sense_of_the_amplitude():
    tank = tank_of("tagkks-half")
    given = tank.coefficients[0]
    turned = given.model_copy(update={"lambda_1": -given.lambda_1, "lambda_02": -given.lambda_02})
    other = tank.model_copy(update={"coefficients": (turned,)})
    assert compare_modes(tank)[0].deviations() == compare_modes(other)[0].deviations()
    assert 100.0 * compare_modes(tank)[0].deviations()["lambda_1"] == pytest.approx(13.07, abs=0.01)


def test_a_computed_tank_has_nothing_to_compare():
    rows = compare_modes(cylinder().model_copy(update={"modes": 2}))
    assert [row.n for row in rows] == [1, 3]
    assert [row.given for row in rows] == [None, None]
    assert [row.deviations() for row in rows] == [{}, {}]
    assert impossible_fractions(cylinder()) == ()
    assert [row.n for row in compare_modes(cylinder(), 3)] == [1, 3, 5]


def test_higher_given_modes_have_their_own_bound():
    first, second = (
        Coefficient(frequency=omega, lambda_1=1000.0, lambda_02=0.0, mu=1000.0 / (share * 12.98278))
        for omega, share in ((1.6, 0.7), (3.8, 0.2))
    )
    tank = cylinder().model_copy(update={"coefficients": (first, second)})
    assert [row.n for row in compare_modes(tank)] == [1, 3]
    said = impossible_fractions(tank)
    assert len(said) == 1
    assert said[0].startswith("given mode 2 moves 0.2000")
    assert "0.0901" in said[0]
