"""Recorded stops satisfy the model's equations of motion, written down afresh from its energies.

Every equation is weighed with a smooth bump and integrated by parts until only recorded quantities are left:
`INT q chi'' M - q chi' C + q chi K = INT Q chi`. So nothing has to be differentiated, and the history alone, forces
and displacements, shows whether the wagon moved as theory sections 2, 3, 7 and 8 say. Two damped slosh modes, three
wheels that lock; one millisecond between rows.
"""

import numpy as np
import pytest
from plain_lagrangian import half_full_cylinder, plain_matrices

MODES = (
    "[{frequency: 0.66 rad/s, lambda_1: -1.0e5 kg, lambda_02: -1.1e5 kg m, mu: 3.3e5 kg, damping_ratio: 0.02}, "
    "{frequency: 1.8 rad/s, lambda_1: -1.2e4 kg, lambda_02: -9e3 kg m, mu: 1.2e5 kg, damping_ratio: 0.05}]"
)
STOP = (
    "paper_160",
    f"tank.coefficients={MODES}",
    "braking.torque=17.5 kN m",
    "output.interval=1 ms",
    "solver.tolerance=1e-6",
)
RADIUS = 0.46
WHEELS = (1, 2, 3, 4)
EQUATIONS = (
    "s", "car heave", "car pitch", "bogie 1 heave", "bogie 1 pitch", "bogie 2 heave", "bogie 2 pitch",
    *(f"wheel {i} heave" for i in WHEELS), *(f"wheel {i} spin" for i in WHEELS), "slosh 1", "slosh 2",
)  # fmt: skip
SPINS, BOGIE_PITCHES = slice(11, 15), [4, 6]


@pytest.fixture(scope="module")
def run(stop):
    return stop(*STOP)


@pytest.fixture(scope="module")
def load(run):
    return half_full_cylinder(run.scenario)


def of_wheels(run, quantity):
    return np.array([run.channels[f"wheel_{i}_{quantity}"] for i in WHEELS])


def displacements(run):
    """Recorded coordinates (17, n); wheel rotations are left zero, their speeds are used instead."""
    c = run.channels
    bogies = [c[f"bogie_{b}_{name}"] for b in (1, 2) for name in ("heave", "pitch")]
    spins = np.zeros((4, run.time.size))
    wagon = [c["position"], c["car_heave"], c["car_pitch"], *bogies]
    return np.vstack([wagon, of_wheels(run, "heave"), spins, c["slosh_1_amplitude"], c["slosh_2_amplitude"]])


def forces(run, weight):
    """Generalised forces (17, n) of contacts, brakes, resistance and weight on one rail's half."""
    c, force = run.channels, np.repeat(weight[:, None], run.time.size, axis=1)
    normal, creep, torque = (of_wheels(run, name) for name in ("normal_force", "tangential_force", "brake_torque"))
    force[0] -= creep.sum(axis=0) + (851 + 13.5 * c["speed"] + 1.244 * c["speed"] ** 2) / 2
    force[7:11] += normal
    force[SPINS] += creep * RADIUS - torque
    force[4] += torque[0] + torque[1]
    force[6] += torque[2] + torque[3]
    return force


class Bump:
    """sin^4 between two instants, its derivatives, and integrals over the recorded rows in between."""

    def __init__(self, time, begin, end):
        self.rows = (time >= begin) & (time <= end)
        self.time = time[self.rows]
        width = end - begin
        angle = np.pi * (self.time - begin) / width
        sine, cosine = np.sin(angle), np.cos(angle)
        self.value = sine**4
        self.slope = 4 * sine**3 * cosine * np.pi / width
        self.curve = (12 * sine**2 * cosine**2 - 4 * sine**4) * (np.pi / width) ** 2

    def integral(self, values, weight):
        return np.trapezoid(values[..., self.rows] * weight, self.time, axis=-1)


def missing(run, load, begin, end):
    """What every equation misses in a window, relative to the sum of its terms' sizes; (17,)."""
    plain, bump = plain_matrices(run.scenario, load), Bump(run.time, begin, end)
    q = displacements(run)
    q[0] -= q[0, bump.rows].mean()
    inertia = plain.mass @ bump.integral(q, bump.curve)
    inertia[SPINS] = -60.0 * bump.integral(of_wheels(run, "speed") / RADIUS, bump.slope)
    terms = [
        inertia,
        -plain.damping @ bump.integral(q, bump.slope),
        plain.stiffness @ bump.integral(q, bump.value),
        -bump.integral(forces(run, plain.weight), bump.value),
    ]
    size = sum(np.abs(term) for term in terms)
    return np.where(size > 0, sum(terms) / np.maximum(size, 1e-300), 0.0)


def test_three_wheels_lock_in_this_stop(run):
    assert run.status == "stopped"
    assert run.locked_time_s[0] == 0.0
    assert min(run.locked_time_s[1:]) > 17.0


@pytest.mark.parametrize("window", [(3.0, 9.0), (5.0, 6.0), (10.0, 14.0), (2.2, 19.0)])
def test_every_equation_holds_between_the_switches(run, load, window):
    gaps = missing(run, load, *window)
    assert dict(zip(EQUATIONS, gaps, strict=True)) == pytest.approx(dict.fromkeys(EQUATIONS, 0.0), abs=3e-5)


@pytest.mark.parametrize("window", [(0.1, 17.0), (0.6, 1.6), (1.0, 3.0), (0.45, 2.0)])
def test_equations_hold_across_onset_and_locks(run, load, window):
    """A torque that jumps between two rows is only known to half a row: bogie pitch and spin see that."""
    gaps = missing(run, load, *window)
    gaps[BOGIE_PITCHES] *= 1e-2
    gaps[SPINS] = 0.0
    assert dict(zip(EQUATIONS, gaps, strict=True)) == pytest.approx(dict.fromkeys(EQUATIONS, 0.0), abs=2e-6)


@pytest.mark.parametrize("wheel", [2, 3, 4])
def test_torque_stops_the_wheel_against_the_creep_force(run, wheel):
    """Impulse from just after the onset to the lock: `I phi' = INT (T - f R) dt`, half a wheelset on one rail."""
    speed, creep = run.channels[f"wheel_{wheel}_speed"], run.channels[f"wheel_{wheel}_tangential_force"]
    lock = np.argmax(speed == 0.0)
    turning = (run.time >= 0.52) & (np.arange(run.time.size) < lock)
    time = run.time[turning]
    impulse = np.trapezoid(17.5e3 - creep[turning] * RADIUS, time)
    spin = 60.0 * speed[turning] / RADIUS
    assert impulse == pytest.approx(spin[0] - spin[-1], rel=1e-4)


def test_contact_forces_follow_from_the_recorded_state(run):
    """Hertz and Polach (theory section 7, dry) at every row and wheel."""
    c = run.channels
    heave, rail, normal = (of_wheels(run, name) for name in ("heave", "rail_deflection", "normal_force"))
    approach = np.maximum(rail - heave, 0.0)
    assert normal == pytest.approx(9.4130e10 * approach**1.5, rel=2e-4)
    exact = normal[0, 0] / approach[0, 0] ** 1.5
    assert normal == pytest.approx(exact * approach**1.5, rel=1e-9, abs=1e-3)
    slip = c["speed"] - of_wheels(run, "speed")
    creepage = slip / np.maximum(np.abs(c["speed"]), 0.05)
    assert of_wheels(run, "creepage") == pytest.approx(creepage, rel=1e-12, abs=1e-12)
    mu = 0.55 * (0.6 * np.exp(-0.6 * np.abs(slip)) + 0.4)
    ellipse = 7.0e-3 * 5.3e-3 * (normal / 93e3) ** (2 / 3)  # to the digits of the check numbers
    eps = 210e9 / 2.6 * np.pi * ellipse * 4.12 * np.abs(creepage) / (4 * mu * normal)
    creep = 2 * mu * normal / np.pi * (eps / (1 + eps**2) + np.arctan(0.4 * eps)) * np.sign(slip)
    assert of_wheels(run, "tangential_force") == pytest.approx(creep, rel=1e-2, abs=1.0)


@pytest.mark.parametrize("window", [(0.1, 17.0), (5.0, 6.0), (10.0, 14.0)])
def test_liquid_force_and_moment_are_the_loads_own_momentum(run, load, window):
    """Theory section 3: force `-(m (u_B + z_c theta) + sum lambda_1 beta)''` of the whole tank, and its moment."""
    c, bump, wagon = run.channels, Bump(run.time, *window), run.scenario.wagon
    arm = wagon.traction_height - RADIUS
    pitches = c["bogie_1_pitch"] + c["bogie_2_pitch"]
    bottom = c["position"] + arm * pitches / 2 + c["car_pitch"] * (1.15 - wagon.traction_height)
    bottom = bottom - bottom[bump.rows].mean()
    amplitudes = [c["slosh_1_amplitude"], c["slosh_2_amplitude"]]
    momentum = load.mass * (bottom + load.centre * c["car_pitch"])
    turning = load.centre * momentum + load.inertia * c["car_pitch"]
    tilt = 9.81 * load.mass * load.centre * c["car_pitch"]
    for (_, lambda_1, lambda_02, _, _), beta in zip(load.modes, amplitudes, strict=True):
        momentum = momentum + lambda_1 * beta
        turning = turning + lambda_02 * beta
        tilt = tilt + 9.81 * lambda_1 * beta
    force, moment = (bump.integral(c[name], bump.value) for name in ("liquid_force", "liquid_moment"))
    assert force == pytest.approx(-bump.integral(momentum, bump.curve), rel=1e-4)
    parts = bump.integral(tilt, bump.value), bump.integral(turning, bump.curve)
    assert moment == pytest.approx(parts[0] - parts[1], abs=1e-5 * sum(map(abs, parts)))


def test_surface_rises_in_front_while_braking(run):
    """The sum of the modes' width-mean amplitudes; a positive one raises the rear (lambda_1 < 0, theory section 4)."""
    c = run.channels
    amplitudes = c["slosh_1_amplitude"] + c["slosh_2_amplitude"]
    assert c["surface_rear"] == pytest.approx(amplitudes, abs=1e-12)
    assert c["surface_front"] == pytest.approx(-amplitudes, abs=1e-12)
    assert c["surface_front"][run.time > 1.0].mean() > 0.5
    assert run.max_surface_m == pytest.approx(np.abs(c["surface_front"]).max(), rel=1e-4)
