"""What the paper's section 4 says about its Figure 2 (reference file claims.csv), put to the program."""

import numpy as np
import pytest

WHEELS = (1, 2, 3, 4)


def loads(result):
    """Normal forces (4, n) and time from half a second after the onset, when the brakes' jerk has died down."""
    settled = result.time >= result.onset_s + 0.5
    return np.array([result.channels[f"wheel_{i}_normal_force"][settled] for i in WHEELS]), result.time[settled]


@pytest.fixture(scope="module", params=[(), ("tank.coefficients=computed",)], ids=["printed", "computed"])
def liquid(request, stop):
    return stop("paper_80", *request.param)


@pytest.fixture(scope="module")
def solid(stop):
    return stop("paper_80_solid")


def test_figure_2_is_of_80_km_h_and_5_kn_m(liquid, solid):
    for result in (liquid, solid):
        assert result.initial_speed_m_s == pytest.approx(80 / 3.6)
        assert result.torque_N_m == 5e3
        assert result.status == "stopped"


def test_fig2_oscillation(liquid, solid):
    """Claim: "at 80 km/h and 5 kN m the contact forces oscillate much more with liquid than with the equivalent
    solid"

    Three seconds into the run the solid's loads stand still to tens of newtons; the liquid's swing by kilonewtons.
    """
    moving, time = loads(liquid)
    still, _ = loads(solid)
    assert np.all(np.ptp(moving, axis=1) > 30e3)
    assert np.all(moving.std(axis=1) > 20 * still.std(axis=1))
    late = 200  # rows of 10 ms
    assert np.all(moving[:, late:].std(axis=1) > 100 * still[:, late:].std(axis=1))
    assert time[late] == pytest.approx(3.0, abs=0.02)


def test_fig2_front_bogie(liquid):
    """Claim: "both wheels of the front bogie carry more than those of the rear bogie while braking with liquid"

    On average over the stop, and at three instants of four. When the liquid swings back, wheel 2, unloaded by its
    own bogie's brakes, for a while carries less than wheel 3; the bogies as wholes keep their order throughout.
    """
    normal, time = loads(liquid)
    mean = np.trapezoid(normal, time, axis=1) / np.ptp(time)
    assert min(mean[0], mean[1]) > max(mean[2], mean[3]) + 10e3
    assert np.all(normal[0] + normal[1] > normal[2] + normal[3])
    assert np.mean(normal[:2].min(axis=0) > normal[2:].max(axis=0)) > 0.7


def test_front_bogies_lead_is_the_liquids_doing(solid):
    """With the equivalent solid wheel 3 carries more than wheel 2 all the time."""
    normal, _ = loads(solid)
    assert np.all(normal[2] > normal[1])


def test_fig2_lead_wheel(liquid, solid):
    """Claim: "within one bogie the leading wheel carries more than the trailing wheel", at every instant of braking."""
    for result in (liquid, solid):
        braking = result.time > result.onset_s
        normal = np.array([result.channels[f"wheel_{i}_normal_force"][braking] for i in WHEELS])
        assert np.all(normal[0] > normal[1])
        assert np.all(normal[2] > normal[3])


def test_liquid_runs_forward_and_swings_at_its_own_pace(stop):
    """Undamped liquid under a steady deceleration a swings between level and twice its still tilt.

    One mode driven by a: `mu (beta'' + omega^2 beta) = lambda_1 a`, still at `lambda_1 a/(mu omega^2)`.
    """
    liquid = stop("paper_80")
    front, time = liquid.channels["surface_front"], liquid.time
    settled = time > 1.0
    assert front[settled].min() > -0.05
    assert liquid.channels["surface_rear"] == pytest.approx(-front)
    assert liquid.max_surface_m == pytest.approx(front.max(), rel=1e-4)
    a = np.trapezoid(-liquid.channels["car_acceleration"][settled], time[settled]) / np.ptp(time[settled])
    assert front.max() == pytest.approx(2 * 137071 / 442163 * a / 0.69**2, rel=0.1)
    peaks = time[1:-1][(front[1:-1] > front[:-2]) & (front[1:-1] >= front[2:]) & (front[1:-1] > 1.0)]
    # the wagon gives way, so the pair swings faster: omega^2/(1 - lambda_1^2/(mu m)), rotating mass included
    mass = liquid.weight_N / 9.81 + 4 * 120 / 0.46**2
    period = 2 * np.pi / 0.69 * np.sqrt(1 - 137071**2 / 442163 / mass)
    assert np.diff(peaks) == pytest.approx(period, rel=0.03)
    assert peaks[0] - 0.5 == pytest.approx(period / 2, rel=0.03)
