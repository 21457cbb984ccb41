"""Polach's creep force: the formula of theory section 7, its derivatives, and what is known of its behaviour."""

from itertools import product
from math import atan, exp, pi

import numpy as np
import pytest

from slosh_cli.scenario import Contact
from slosh_cli.scenario.schema_run import ADHESIONS, coulomb_adhesion
from slosh_cli.track.contact import contact_model
from slosh_cli.track.hertz import hertz_contact

PARAMETERS = {
    "dry": {"kA": 1.00, "kS": 0.40, "mu0": 0.55, "A": 0.40, "B": 0.60},
    "wet": {"kA": 0.30, "kS": 0.10, "mu0": 0.30, "A": 0.40, "B": 0.20},
}
LOADS = (1.0, 2e3, 93e3, 250e3)
SLIPS = (1e-9, 1e-5, 1e-3, 0.02, 0.3, 2.0, 20.0)
SPEEDS = (1e-3, 0.049, 0.051, 0.5, 5.0, 44.0)


def contact_of(adhesion):
    given = {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "rail_crown_radius": 0.3, "kalker_c11": 4.12}
    return contact_model(Contact(**given, adhesion=adhesion), 0.46)


CONTACTS = {rail: contact_of(ADHESIONS[rail]) for rail in PARAMETERS}


def polach(rail, N, slip, speed, power=2):
    """The force as theory section 7 writes it; `power=1` is the known misprint `kA eps^2` for `(kA eps)^2`."""
    p = PARAMETERS[rail]
    a, b = hertz_contact(0.46, 0.30, 210e9, 0.3).semi_axes(N)
    G = 210e9 / (2 * (1 + 0.3))
    creepage = slip / max(abs(speed), 0.05)
    mu = p["mu0"] * ((1 - p["A"]) * exp(-p["B"] * abs(slip)) + p["A"])
    eps = G * pi * a * b * 4.12 * abs(creepage) / (4 * mu * N)
    force = 2 * mu * N / pi * (p["kA"] * eps / (1 + p["kA"] ** power * eps**2) + atan(p["kS"] * eps))
    return force if slip >= 0 else -force


def force(rail, N, slip, speed):
    return CONTACTS[rail].creep_force(N, slip, speed)[0]


@pytest.mark.parametrize("rail", PARAMETERS)
def test_named_adhesions_are_polachs(rail):
    assert ADHESIONS[rail].model_dump() == PARAMETERS[rail]


@pytest.mark.parametrize("rail", PARAMETERS)
def test_force_is_the_formula(rail):
    for N, slip, speed in product(LOADS, SLIPS, SPEEDS):
        assert force(rail, N, slip, speed) == pytest.approx(polach(rail, N, slip, speed), rel=1e-9)


def test_only_a_wet_rail_tells_the_square_from_the_misprint():
    """`(kA eps)^2`, not `kA eps^2`: the same on a dry rail, where kA = 1, and a third of the force on a wet one."""
    assert polach("dry", 93e3, 0.02, 10.0, power=1) == pytest.approx(polach("dry", 93e3, 0.02, 10.0))
    wrong, right = polach("wet", 93e3, 0.06, 10.0, power=1), polach("wet", 93e3, 0.06, 10.0)
    assert abs(wrong / right - 1) > 0.2
    assert force("wet", 93e3, 0.06, 10.0) == pytest.approx(right, rel=1e-9)


@pytest.mark.parametrize("rail", PARAMETERS)
def test_derivatives_are_those_of_the_force(rail):
    for N, slip, speed in product(LOADS, SLIPS, SPEEDS):
        _, by_normal, by_slip, by_speed = CONTACTS[rail].creep_force(N, slip, speed)
        scale = force(rail, N, slip, speed)
        for analytic, place in ((by_normal, 0), (by_slip, 1), (by_speed, 2)):
            at = np.array([N, slip, speed])
            step = 1e-5 * at[place]
            change = np.eye(3)[place] * step
            difference = (force(rail, *(at + change)) - force(rail, *(at - change))) / (2 * step)
            assert analytic == pytest.approx(difference, abs=2e-7 * scale / at[place])


@pytest.mark.parametrize("rail", PARAMETERS)
def test_force_is_odd_in_slip(rail):
    for N, slip, speed in product(LOADS, SLIPS, SPEEDS):
        forward, backward = (CONTACTS[rail].creep_force(N, sign * slip, speed) for sign in (1, -1))
        assert backward[0] == -forward[0]
        assert backward[1] == -forward[1]  # by normal force
        assert backward[2] == forward[2]  # by slip
        assert backward[3] == -forward[3]  # by speed
    assert force(rail, 93e3, 0.0, 10.0) == 0.0


@pytest.mark.parametrize("rail", PARAMETERS)
def test_no_force_without_load(rail):
    for N in (0.0, -1.0, -93e3):
        assert CONTACTS[rail].creep_force(N, 1.0, 10.0) == (0.0, 0.0, 0.0, 0.0)
    assert force(rail, 1e-6, 1.0, 10.0) < 1e-6  # and it goes there continuously


@pytest.mark.parametrize("rail", PARAMETERS)
def test_small_slip_is_kalkers_linear_law_reduced(rail):
    """For eps -> 0 the force is `G a b c11 creepage (kA + kS)/2`."""
    p, G = PARAMETERS[rail], 210e9 / 2.6
    a, b = hertz_contact(0.46, 0.30, 210e9, 0.3).semi_axes(93e3)
    linear = G * a * b * 4.12 * 1e-7 * (p["kA"] + p["kS"]) / 2
    assert force(rail, 93e3, 1e-7 * 20.0, 20.0) == pytest.approx(linear, rel=1e-5)


@pytest.mark.parametrize("rail", PARAMETERS)
def test_force_never_exceeds_friction(rail):
    p = PARAMETERS[rail]
    for N, slip, speed in product(LOADS, SLIPS, SPEEDS):
        mu = p["mu0"] * ((1 - p["A"]) * exp(-p["B"] * slip) + p["A"])
        assert 0 < force(rail, N, slip, speed) <= mu * N * 1.0000001
    # locked at speed: nearly all of it
    mu = p["mu0"] * ((1 - p["A"]) * exp(-p["B"] * 20.0) + p["A"])
    assert force(rail, 93e3, 20.0, 20.0) == pytest.approx(mu * 93e3, rel=0.05)


def test_published_behaviour_of_dry_and_wet_rail():
    """Polach: adhesion peaks at a few per cent of creepage when dry, later and flatter when wet, and falls beyond."""
    creepage, speed = np.geomspace(1e-4, 1.0, 4000), 40 / 3.6
    curves = {rail: np.array([force(rail, 93e3, c * speed, speed) / 93e3 for c in creepage]) for rail in PARAMETERS}
    peaks = {rail: creepage[curve.argmax()] for rail, curve in curves.items()}
    assert 0.01 < peaks["dry"] < 0.04
    assert peaks["wet"] > 2 * peaks["dry"]
    assert 0.40 < curves["dry"].max() < 0.55
    assert 0.20 < curves["wet"].max() < 0.30
    assert curves["dry"][-1] < 0.6 * curves["dry"].max()
    assert 0.5 * curves["wet"].max() < curves["wet"][-1] < 0.8 * curves["wet"].max()


def test_peak_falls_with_speed_and_locked_wheels_hold_better_when_slow():
    creepage = np.geomspace(1e-4, 1.0, 1000)
    peaks = [max(force("dry", 93e3, c * speed, speed) for c in creepage) for speed in (5.0, 20.0, 40.0)]
    assert peaks[0] > 1.05 * peaks[1] > 1.1 * peaks[2]
    locked = [force("dry", 93e3, speed, speed) for speed in (40.0, 10.0, 3.0, 0.5)]
    assert np.all(np.diff(locked) > 0)


def test_creepage_has_a_floor_of_5_cm_a_second():
    assert force("dry", 93e3, 1e-4, 0.02) == force("dry", 93e3, 1e-4, 0.05)
    assert CONTACTS["dry"].creep_force(93e3, 1e-4, 0.02)[3] == 0.0
    assert force("dry", 93e3, 1e-4, 0.06) < force("dry", 93e3, 1e-4, 0.05)


def test_ellipse_follows_the_load():
    """For small slip the force goes as a b, that is as N^(2/3); a frozen ellipse would not change it at all."""
    small = [force("wet", N, 1e-6, 10.0) for N in (50e3, 100e3)]
    assert small[1] / small[0] == pytest.approx(2 ** (2 / 3), rel=1e-4)


@pytest.mark.parametrize("mu", [0.005, 0.15, 1.5])
def test_a_coefficient_of_friction_is_plain_coulomb_friction(mu):
    """With A = 1 and kA = kS = 1 the force rises to mu N and stays there; `4 / (3 pi eps^3)` of it is missing."""
    contact = contact_of(coulomb_adhesion(mu))
    for N, speed in product((20e3, 93e3), (0.1, 5.0, 44.0)):
        a, b = hertz_contact(0.46, 0.30, 210e9, 0.3).semi_axes(N)
        eps = 210e9 / 2.6 * pi * a * b * 4.12 / (4 * mu * N)
        locked = contact.creep_force(N, speed, speed)[0]
        assert locked == pytest.approx(mu * N, rel=3e-6)
        assert 1 - locked / (mu * N) == pytest.approx(4 / (3 * pi * eps**3), rel=1e-2, abs=1e-15)
        rising = [contact.creep_force(N, slip * speed, speed)[0] for slip in np.geomspace(1e-5, 3.0, 200)]
        assert np.all(np.diff(rising) >= -1e-12 * mu * N)
        assert max(rising) <= mu * N
