"""A wagon that cannot pitch, on a rail that does not give, is a point mass with rotating wheels.

Whole wagon: `(m + 4 I (1 - nu)/R^2) dV/dt = -(8 T/R + a + b V + c V^2)`, with the creepage nu that the creep force
`f = T/R` needs. The force hardly depends on speed, so nu stays what it becomes within milliseconds of the onset;
there the wheels give up `4 I nu V/R^2` of their momentum to the wagon.
"""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from slosh_cli.validation.exact.wagon import PointWagon, stopping

RADIUS, ONSET, STOP_SPEED = 0.46, 0.5, 0.02
MASS = 21.3e3 + 2 * 1.8e3 + 4 * 1.4e3 + 830 * 15.5 * np.pi * 1.5**2 / 2
ROTATING = 4 * 120 / RADIUS**2
STIFF = (
    "wagon.primary_suspension.stiffness=2e9 N/m",
    "wagon.primary_suspension.damping=1e6 N s/m",
    "wagon.secondary_suspension.stiffness=2e9 N/m",
    "wagon.secondary_suspension.damping=1e6 N s/m",
    "track.foundation.stiffness=1e10 N/m^2",
    "contact.stiffness=1e14 N/m^1.5",
)
SPEEDS = {"paper_80_solid": 80 / 3.6, "paper_160_solid": 160 / 3.6}


def resistance(V):
    return 851 + 13.5 * V + 1.244 * V**2


def creepage(force, kalker):
    """Creepage at which Polach's dry law gives `force` (N) under the static load; eps as in theory section 7.

    The check numbers of theory section 7 fix a b at 93 kN; falling friction does not matter at so little slip.
    """
    N = 9.81 * MASS / 8
    ellipse = 7.0e-3 * 5.3e-3 * (N / 93e3) ** (2 / 3)

    def surplus(nu):
        eps = 210e9 / 2.6 * np.pi * ellipse * kalker * nu / (4 * 0.55 * N)
        return 2 * 0.55 * N / np.pi * (eps / (1 + eps**2) + np.arctan(0.4 * eps)) - force

    return brentq(surplus, 0.0, 0.01)


def closed_form(V0, torque, kalker):
    """Braking distance (m) and time (s), from numbers written down here."""
    wagon = PointWagon(MASS, ROTATING, RADIUS, (851, 13.5, 1.244))
    return stopping(wagon, V0, lambda _: torque, ONSET, STOP_SPEED, creepage(torque / RADIUS, kalker))


@pytest.mark.parametrize("torque", [2.5, 5.0, 10.0])
@pytest.mark.parametrize("name", SPEEDS)
def test_rigid_wagon_on_rigid_track_stops_like_a_point_mass(stop, name, torque):
    """Acceptance: distance within 1e-4 of the closed form; c11 = 100 leaves next to no slip."""
    result = stop(name, *STIFF, "contact.kalker_c11=100", f"braking.torque={torque} kN m")
    distance, seconds = closed_form(SPEEDS[name], torque * 1e3, 100.0)
    assert result.status == "stopped"
    assert result.braking_distance_m == pytest.approx(distance, rel=3e-6)
    assert result.braking_time_s == pytest.approx(seconds, rel=3e-6)
    assert max(np.abs(result.channels["car_pitch"])) < 1e-4


@pytest.mark.parametrize("name", SPEEDS)
def test_slip_of_ordinary_wheels_is_in_the_closed_form_too(stop, name):
    result = stop(name, *STIFF)
    distance, _ = closed_form(SPEEDS[name], 5e3, 4.12)
    without_slip, _ = closed_form(SPEEDS[name], 5e3, 1e6)
    assert result.braking_distance_m == pytest.approx(distance, rel=5e-6)
    assert result.braking_distance_m > without_slip * (1 + 1e-5)


def test_rotating_mass_and_resistance_are_in_the_distance(stop):
    """What the closed form would be without either: both lie far outside the tolerance."""
    result = stop("paper_80_solid", *STIFF, "contact.kalker_c11=100", "braking.torque=5 kN m")
    exact, _ = closed_form(80 / 3.6, 5e3, 100.0)
    assert result.braking_distance_m > 1.02 * exact * MASS / (MASS + ROTATING)
    assert result.braking_distance_m < 0.99 * (MASS + ROTATING) * (80 / 3.6) ** 2 / 2 / (8 * 5e3 / RADIUS)


def test_paper_wagon_stops_within_a_per_cent_of_the_energy_balance(stop):
    """Acceptance: at 5 kN m and 80 km/h within 1 % of V0^2/(2 a), a from torque, resistance and total mass."""
    V0 = 80 / 3.6
    mean_resistance = quad(resistance, 0, V0)[0] / V0
    a = (8 * 5e3 / RADIUS + mean_resistance) / (MASS + ROTATING)
    for name in ("paper_80", "paper_80_solid"):
        assert stop(name).braking_distance_m == pytest.approx(V0**2 / (2 * a), rel=1e-2)


def test_liquid_and_solid_differ_by_less_than_a_per_cent_at_80_km_h(stop):
    liquid, solid = stop("paper_80").braking_distance_m, stop("paper_80_solid").braking_distance_m
    assert liquid == pytest.approx(solid, rel=1e-2)
    assert liquid != pytest.approx(solid, rel=1e-4)  # but they are not the same run


@pytest.mark.parametrize("mu", ["0.1", "15 %"])
def test_locked_wheels_on_plain_coulomb_friction_stop_in_the_distance_of_a_sliding_block(stop, mu):
    """`V^2 / (2 mu g)`: the weight is what it is, so that pitching moves load between wheels and nothing else."""
    none = "wagon.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s^2/m^2}"
    braking = ("braking.torque=40 kN m", "braking.onset=0 s")
    result = stop("paper_80_solid", f"contact.adhesion={mu}", none, *braking)
    friction = {"0.1": 0.1, "15 %": 0.15}[mu]
    assert result.status == "stopped"
    block = (SPEEDS["paper_80_solid"] ** 2 - STOP_SPEED**2) / (2 * friction * 9.81)
    assert result.braking_distance_m == pytest.approx(block, rel=1e-4)
