"""A physically plausible run to test files, figures and commands with, made without the solver.

A point-mass wagon with one slosh mode and quasi-static load transfer: the shapes and sizes are those
of a real stop, the numbers are nobody's answer.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from slosh_cli.results.channels import CHANNELS, WHEELS, wheel
from slosh_cli.results.result import Result, Status

MASS = 76e3  # kg, whole wagon
WHEEL_RADIUS = 0.46  # m
SPAN = 12.0  # m between bogies
STATIC_LOAD = 93e3  # N, one wheel


def plausible_run(scenario: Any, *, interval: float = 0.01, locking: bool = False) -> Result:
    """One stop of `scenario` (only its braking, tank.liquid.model and name count)."""
    motion = _motion(scenario, interval)
    time, channels = motion["time"], _channels(scenario, motion, locking)
    if scenario.tank.liquid.model != "rigid":
        channels["slosh_1_amplitude"] = motion["amplitude"]
    stop_time = float(time[-1]) - scenario.braking.onset
    loads = [channels[wheel(i, "normal_force")] for i in WHEELS]
    peak = max(float(np.abs(channels["surface_front"]).max()), 0.0)
    return Result(
        scenario=scenario,
        status=Status.STOPPED,
        warnings=(f"the surface rises {peak:.2f} m, above the roof at 1.50 m",) if peak > 1.5 else (),
        time=time,
        channels=channels,
        braking_distance_m=float(np.interp(stop_time, time - scenario.braking.onset, channels["position"])),
        braking_time_s=stop_time,
        max_surface_m=peak,
        surface_limit_m=1.5,
        min_wheel_load_N=tuple(float(load.min()) for load in loads),  # type: ignore[arg-type]
        max_wheel_load_N=tuple(float(load.max()) for load in loads),  # type: ignore[arg-type]
        static_wheel_load_N=(STATIC_LOAD,) * 4,
        mean_total_wheel_load_N=8 * STATIC_LOAD,
        weight_N=8 * STATIC_LOAD,
        locked_time_s=(0.0, 0.0, 0.0, 1.25 if locking else 0.0),
        brake_torque_max_N_m=(5e3,) * 4,
        slide_protection_cycles=None,
        slide_protection_air=None,
        energy_residual=3.2e-6,
        energy={"kinetic": 1.0, "brake": 1.8e7, "creep": 4.0e4},
        steps=812,
        rejected_steps=23,
        work={"newton_iterations": 2901, "factorisations": 835, "events": 3},
        solve_seconds=0.41,
    )


def unfinished_run(scenario: Any) -> Result:
    """The same wagon, out of time before it stops: no distance, no time, values that are not finite."""
    return replace(
        plausible_run(scenario),
        status=Status.TIME_LIMIT,
        reason="still at 3.1 m/s after 600 s",
        braking_distance_m=None,
        braking_time_s=None,
        energy_residual=math.nan,
    )


def _motion(scenario: Any, interval: float) -> dict[str, np.ndarray]:
    """Speed, distance and slosh amplitude by small symplectic steps of the point-mass wagon."""
    brake = scenario.braking
    ratio, frequency = (-0.31, 0.69) if scenario.tank.liquid.model != "rigid" else (0.0, 1.0)
    share = 137071.0 / MASS * -ratio
    speed, position, amplitude, rate, now = brake.initial_speed, 0.0, 0.0, 0.0, 0.0
    rows = []
    while speed > brake.stop_speed and now < 300.0:
        force = 8.0 * brake.torque / WHEEL_RADIUS if now >= brake.onset else 0.0
        drag = 851.0 + 13.5 * speed + 1.244 * speed**2
        pull = -(frequency**2) * amplitude
        acceleration = (-(force + drag) / MASS + share * pull * 0.5) / (1.0 - 0.5 * share)
        rate += interval * (pull + ratio * acceleration)
        amplitude += interval * rate
        rows.append((now, position, speed, acceleration, amplitude, -0.5 * MASS * share * pull))
        position += interval * speed
        speed += interval * acceleration
        now += interval
    names = ("time", "position", "speed", "acceleration", "amplitude", "force")
    return dict(zip(names, np.array(rows).T, strict=True))


def _channels(scenario: Any, motion: dict[str, np.ndarray], locking: bool) -> dict[str, np.ndarray]:
    time = motion["time"]
    braking = time >= scenario.braking.onset
    ring = np.where(braking, np.exp(-(time - scenario.braking.onset)), 0.0) * np.sin(40.0 * time)
    channels = {name: np.zeros_like(time) for name in CHANNELS}
    channels |= {name: motion[name] for name in ("position", "speed")}
    channels["car_acceleration"] = motion["acceleration"]
    channels["acceleration"] = motion["acceleration"] + 0.3 * ring
    channels["liquid_force"] = motion["force"]
    channels["surface_front"] = motion["amplitude"]
    channels["surface_rear"] = -motion["amplitude"]
    for i in WHEELS:
        channels |= _wheel(i, scenario, motion, ring)
    if locking:
        last = (time > time[-1] - 1.25) & (time < time[-1] - 0.05)
        channels["wheel_4_speed"] = np.where(last, 0.0, channels["wheel_4_speed"])
        channels["wheel_4_creepage"] = np.where(last, 1.0, channels["wheel_4_creepage"])
    return channels


def _wheel(i: int, scenario: Any, motion: dict[str, np.ndarray], ring: np.ndarray) -> dict[str, np.ndarray]:
    front, leading = (1 if i <= 2 else -1), (1 if i % 2 else -1)
    transfer = -MASS * motion["acceleration"] * 1.6 / SPAN / 4.0
    shift = 137071.0 * 9.81 * motion["amplitude"] / SPAN / 8.0
    creepage = np.where(motion["time"] >= scenario.braking.onset, 2e-3 + 1e-4 * i, 0.0)
    normal = STATIC_LOAD + front * (transfer + shift) + leading * (1500.0 + 2500.0 * ring)
    return {
        wheel(i, "normal_force"): normal,
        wheel(i, "tangential_force"): np.full_like(normal, scenario.braking.torque / WHEEL_RADIUS),
        wheel(i, "speed"): motion["speed"] * (1.0 - creepage),
        wheel(i, "creepage"): creepage,
        wheel(i, "brake_torque"): np.full_like(normal, scenario.braking.torque),
    }
