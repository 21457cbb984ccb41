"""The data sheet of a wagon against figures by hand."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.linalg import eigh

from slosh_cli.results.data_sheet import data_sheet, resonances
from slosh_cli.results.point_stop import _applied
from slosh_cli.wagon.torque import moved_mass, total_mass


def test_the_half_filled_wagon_by_hand(shipped):
    """A half-filled circle of 1.5 m: its centre lies 4 R/(3 pi) below the axis."""
    scenario = shipped("paper_80_solid")
    wagon, tank = scenario.wagon, scenario.tank
    sheet = data_sheet(shipped("paper_80_solid", "tank.fill=0.5", "tank.liquid.density=1000 kg/m^3"))
    full = math.pi * 1.5**2 * 15.5
    load, gross = 0.5 * full, 21.3 + 3.6 + 5.6 + 0.5 * full
    centre = tank.bottom_height + 1.5 - 4 * 1.5 / (3 * math.pi)
    radius = wagon.wheelset.wheel_radius
    empty = 21.3 * wagon.car_body.centre_height + 3.6 * wagon.bogie.centre_height + 5.6 * radius
    tau = 8 * scenario.braking.torque / radius / (gross * 1e3 * 9.81)
    known = {
        "tank_volume_m3": full,
        "liquid_volume_m3": load,
        "ullage_m3": load,
        "degree_of_filling": 0.5,
        "fill": 0.5,
        "payload_t": load,
        "gross_mass_t": gross,
        "axle_load_front_t": gross / 4,
        "axle_load_rear_t": gross / 4,
        "centre_of_gravity_m": (empty + load * centre) / gross,
        "tau": tau,
        "tau_initial": tau,
        "tau_near_rest": tau,
        "filling_time_s": 0.0,
    }
    assert {name: sheet[name] for name in known} == pytest.approx(known, rel=1e-9)


FREE = "wagon.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s^2/m^2}"
TO_REST = (FREE, "braking.stop_speed=0.1 mm/s", "braking.onset=0 s")
CAST_IRON = "braking.blocks={count: 2, force: 20 kN, friction: cast-iron}"


def test_the_point_mass_in_closed_form(shipped):
    """A step `V^2/(2 A)`, linear over tau `+ V tau/2 - A tau^2/24`, on a slope `V^2/(2 (A + g i M/M_eff))`."""
    wagon = shipped("paper_80_solid", *TO_REST)
    speed, force = 80 / 3.6, 8 * 5e3 / 0.46
    slowing = force / moved_mass(wagon)
    step = speed**2 / (2 * slowing)
    assert data_sheet(wagon)["stopping_distance_m"] == pytest.approx(step, rel=1e-7)
    assert data_sheet(wagon)["mean_deceleration_m_s2"] == pytest.approx(slowing, rel=1e-7)
    linear = wagon.with_({"braking.application": "{form: linear, time: 4 s}"})
    assert data_sheet(linear)["stopping_distance_m"] == pytest.approx(step + 2 * speed - slowing * 16 / 24, rel=1e-7)
    assert data_sheet(linear)["filling_time_s"] == pytest.approx(3.8)
    uphill = wagon.with_({"track.gradient": 0.02})
    pull = 9.81 * 0.02 * total_mass(wagon) / moved_mass(wagon)
    assert data_sheet(uphill)["stopping_distance_m"] == pytest.approx(speed**2 / 2 / (slowing + pull), rel=1e-7)


def test_a_cast_iron_brake_fades_at_speed_and_bites_near_rest(shipped):
    wagon = shipped("paper_80_solid", *TO_REST, CAST_IRON)
    sheet = data_sheet(wagon)

    def friction(speed):
        return 0.6 * (1.62 * 20 + 100) / (8.1 * 20 + 100) * (3.6 * speed + 100) / (18 * speed + 100)

    weight = total_mass(wagon) * 9.81
    assert sheet["tau_near_rest"] == pytest.approx(8 * 2 * 20e3 * friction(0) / weight)
    assert sheet["tau_initial"] == pytest.approx(8 * 2 * 20e3 * friction(80 / 3.6) / weight)
    way = quad(lambda v: v * moved_mass(wagon) / (16 * 20e3 * friction(v)), 0, 80 / 3.6)[0]
    assert sheet["stopping_distance_m"] == pytest.approx(way, rel=1e-6)
    assert sheet["tau"] == pytest.approx(moved_mass(wagon) * (80 / 3.6) ** 2 / 2 / way / weight, rel=1e-6)


def test_the_point_mass_stops_as_the_wagon_does(stop):
    """Filled blocks, resistance and a slope that changes: the wagon has slip and pitch on top, a part of 1e-3."""
    slope = "track.gradient=[[0 m, 0.0], [100 m, 0.01]]"
    run = stop("paper_80_solid", "tank.liquid.model=rigid", CAST_IRON, "braking.application=P", slope)
    assert data_sheet(run.scenario)["stopping_distance_m"] == pytest.approx(run.braking_distance_m, rel=1e-3)


@pytest.mark.parametrize(("speed", "told"), [(100, 80.0), (120, 65.0), (160, 150.0), (80, None)])
def test_the_braked_weight_that_a_distance_stands_for(shipped, speed, told):
    """A brake told by its braked weight, built up as that is defined, has it again; at 80 km/h there is none."""
    built_up = "braking.application={form: table, points: [[0 s, 0], [0.2 s, 0], [4.2 s, 1]]}"
    signed = f"braking.braked_weight={{percentage: {told or 80}, speed: {speed if told else 100} km/h}}"
    start = f"braking.initial_speed={speed} km/h"
    wagon = shipped("paper_80_solid", signed, built_up, start, *TO_REST[1:])
    assert data_sheet(wagon).get("braked_weight_percentage") == (told and pytest.approx(told, rel=1e-4))
    assert "braked_weight_percentage" not in data_sheet(wagon.with_({"track.gradient": 0.01}))


def test_what_never_stops_has_no_distance(shipped):
    sheet = data_sheet(shipped("paper_80_solid", "braking.torque=1 N m", "track.gradient=-0.03"))
    assert sheet["stopping_distance_m"] is sheet["mean_deceleration_m_s2"] is None


def test_bounce_and_pitch_of_bodies_on_springs(shipped):
    """Car on bogies on springs; with all centres at the height of the axles and hardly a load nothing else moves."""
    level = ("wagon.traction_height=0.46 m", "wagon.car_body.centre_height=0.46 m", "wagon.bogie.centre_height=0.46 m")
    light = ("tank.fill=0.02", "tank.liquid.density=50 kg/m^3", "tank.bottom_height=0 m")
    scenario = shipped("paper_80_solid", *level, *light)
    car, bogie, half = 0.5 * 21.3e3, 0.5 * 1.8e3, 6.0
    soft, stiff = 6.0e6, 2.6e6

    def lowest(mass, stiffness):
        return math.sqrt(eigh(stiffness, np.diag(mass), eigvals_only=True)[0]) / (2 * math.pi)

    ends = 2 * soft + 4 * stiff
    bounce = lowest([car, 2 * bogie], [[2 * soft, -2 * soft], [-2 * soft, ends]])
    turn = 2 * soft * half
    pitch = lowest([0.5 * 4.6e5, 2 * bogie], [[turn * half, turn], [turn, ends]])
    sheet = data_sheet(scenario)
    assert sheet["bounce_frequency_Hz"] == pytest.approx(bounce, rel=1e-3)
    assert sheet["pitch_frequency_Hz"] == pytest.approx(pitch, rel=1e-3)


APPLICATIONS = {
    "step": ("step", 1.0),
    "P": ("P", None),
    "G": ("G", None),
    "late": ("{form: filling, time_95: 5 s, delay: 1 s, jump: 0.3}", None),
    "ramp over a period": ("{form: linear, time: PERIOD s}", 0.0),
    "ramp over half a period": ("{form: linear, time: HALF s}", 2 / math.pi),
    "table": ("{form: table, points: [[0 s, 0.2], [1 s, 0.3], [3 s, 0.3], [3.5 s, 1], [8 s, 0.4]]}", None),
}


@pytest.mark.parametrize("case", APPLICATIONS)
def test_the_slosh_that_a_build_up_leaves(shipped, case):
    """An undamped oscillator pushed by the application, integrated in time, swings so much about its new rest."""
    written, exact = APPLICATIONS[case]
    period = data_sheet(shipped("paper_80"))["slosh_period_rolling_s"]
    written = written.replace("PERIOD", repr(period)).replace("HALF", repr(0.5 * period))
    scenario = shipped("paper_80", f"braking.application={written}")
    found, omega = data_sheet(scenario)["slosh_after_build_up"], 2 * math.pi / period
    if exact is not None:
        assert found == pytest.approx(exact, abs=1e-9)
    onset, end = scenario.braking.onset, 200.0

    def rates(time, state):
        return [state[1], omega**2 * (_applied(scenario, onset + time) - state[0])]

    kinks = (0.0, 1.0, 3.0, 3.5, 8.0, 0.5 * period, period, end)
    state = np.zeros(2)
    for start, stop in pairwise(sorted(kinks)):
        state = solve_ivp(rates, (start, stop - 1e-12), state, rtol=1e-10, atol=1e-12, max_step=0.5).y[:, -1]
    assert math.hypot(state[0] - _applied(scenario, onset + end), state[1] / omega) == pytest.approx(found, abs=1e-6)


def test_the_wagon_that_rolls_recoils_under_its_liquid(stop):
    """In the run itself the liquid swings with the rolling wagon's period, and P leaves as much as the sheet says."""
    gentle = ("braking.torque=1.5 kN m", "braking.initial_speed=160 km/h", "output.interval=20 ms")
    swings = {}
    for application in ("step", "P"):
        run = stop("paper_80", *gentle, f"braking.application={application}")
        late = (run.time > 14) & (run.time < 34)  # P has built up; no wagon stands
        surface, time = run.channels["surface_front"][late], run.time[late]
        surface = surface - np.polyval(np.polyfit(time, surface, 1), time)
        up = time[1:][(surface[:-1] < 0) & (surface[1:] >= 0)]
        swings[application] = np.ptp(surface), np.diff(up).mean()
    sheet = data_sheet(run.scenario)
    assert sheet["slosh_period_s"] == pytest.approx(9.106, abs=1e-3)
    assert sheet["slosh_period_rolling_s"] == pytest.approx(swings["step"][1], rel=0.01)
    assert sheet["slosh_after_build_up"] == pytest.approx(swings["P"][0] / swings["step"][0], abs=0.03)


def test_a_closed_bulkhead_leaves_no_one_period_of_the_rolling_wagon(shipped):
    parted = shipped("paper_80_solid", "tank.baffles=[{position: 5 m, opening: 0}]", "braking.application=P")
    sheet = data_sheet(parted)
    assert sheet["slosh_period_rolling_s"] is sheet["slosh_after_build_up"] is None
    assert resonances(sheet) == []


def test_the_slosh_period_is_that_of_the_modes_in_use(shipped):
    assert data_sheet(shipped("paper_80"))["slosh_period_s"] == pytest.approx(2 * math.pi / 0.69)
    computed = data_sheet(shipped("paper_80_solid"))["slosh_period_s"]
    assert computed == pytest.approx(data_sheet(shipped("tank_wagon"))["slosh_period_s"], rel=1e-3)
    halves = ("tank.liquid.model=shallow-water", "tank.baffles=[{position: 7.75 m, opening: 0}]")
    assert data_sheet(shipped("tank_wagon", *halves))["slosh_period_s"] < 0.7 * computed


@pytest.mark.parametrize(
    ("known", "said"),
    [
        ({"filling_time_s": 4.1}, "near the slosh period of 4.0 s in the rolling wagon: a straight build-up over"),
        ({"filling_time_s": 24.3}, "near 6 times the slosh period"),
        ({"filling_time_s": 6.0}, ""),
        ({"filling_time_s": 0.0}, ""),
        ({"bounce_frequency_Hz": 0.26}, "bounce at 0.26 Hz is near the first slosh frequency of 0.25 Hz"),
        ({"pitch_frequency_Hz": 2.5}, ""),
    ],
)
def test_a_build_up_or_a_frequency_near_the_slosh_period_is_told(known, said):
    told = resonances({"slosh_period_rolling_s": 4.0, "slosh_period_s": 6.0, "slosh_after_build_up": 0.5, **known})
    assert (said in told[0]) if said else not told
    assert resonances({"slosh_period_s": None, **known}) == []
