"""What leaves the wagon's momentum, along the track and across it, on every shipped stop."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.channels import WHEELS, slosh_amplitude, wheel
from slosh_cli.results.result import Result
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.tank.coefficients import slosh_modes
from slosh_cli.tank.load import frozen_load
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.wagon import point_wagon
from slosh_cli.validation.runs import runnable, scenario, stop


def compute(data: CaseData) -> Outcome:
    """Momentum along the track against the impulse of creep and resistance; mean wheel load against the weight."""
    found, curves = Findings(data), []
    for name in runnable():
        flowing = scenario(name).tank.liquid.model == "shallow-water"  # its channels do not tell its momentum
        result = stop(name, *data.reference["overrides"], *([data.reference["flowing"]] if flowing else []))
        lost, impulse = _lost(result), _impulse(result)
        found.compare(f"{name}: momentum lost / kN s", float(lost[-1]) / 1e3, float(impulse[-1]) / 1e3, "momentum")
        gap = float(np.abs(lost - impulse).max() / impulse[-1])
        found.limit(f"{name}: largest difference on the way, over the whole", gap, "on_the_way")
        weight = STANDARD_GRAVITY * point_wagon(result.scenario).mass
        found.compare(f"{name}: weight / kN", result.weight_N / 1e3, weight / 1e3, "weight")
        mean = result.mean_total_wheel_load_N
        rails = "mean_load" if result.scenario.track.unevenness is None else "mean_load_uneven"
        found.compare(f"{name}: mean of the summed wheel loads over the stop / kN", mean / 1e3, weight / 1e3, rails)
        least = min(float(result.channels[wheel(i, "normal_force")].min()) for i in WHEELS)
        found.limit(f"{name}: largest tension between wheel and rail / N", max(0.0, -least), "tension")
        if name.endswith("-liquid"):
            curves.append(curve(f"{name}: impulse", result.time, impulse / 1e3, exact=True))
            curves.append(curve(f"{name}: momentum", result.time[::1500], lost[::1500] / 1e3, marks=True))
    return found.outcome(Chart((Panel("time / s", "momentum lost / kN s", curves),)))


def _rate(result: Result, channel: str) -> Array:
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(result.time, result.channels[channel])(result.time, 1))


def _lost(result: Result) -> Array:
    """Momentum along the track (N s) that the whole wagon has lost since t = 0, body by body (theory sections 2, 3)."""
    case: Scenario = result.scenario
    wagon, load = case.wagon, frozen_load(case.tank)
    axle, pivot = wagon.wheelset.wheel_radius, wagon.traction_height
    bogies = [_rate(result, f"bogie_{k}_pitch") for k in (1, 2)]
    car_pitch = _rate(result, "car_pitch")
    at_pivot = result.channels["speed"] + 0.5 * (pivot - axle) * (bogies[0] + bogies[1])

    def car_at(height: float) -> Array:
        return np.asarray(at_pivot + car_pitch * (height - pivot))

    momentum = 4 * wagon.wheelset.mass * result.channels["speed"]
    for pitch in bogies:
        momentum = momentum + wagon.bogie.mass * (result.channels["speed"] + pitch * (wagon.bogie.centre_height - axle))
    momentum += wagon.car_body.mass * car_at(wagon.car_body.centre_height)
    momentum += load.mass * car_at(case.tank.bottom_height + load.centre_height)
    for n, mode in enumerate(slosh_modes(case.tank), start=1):
        momentum += mode.lambda_1 * _rate(result, slosh_amplitude(n))
    return np.asarray(momentum[0] - momentum)


def _impulse(result: Result) -> Array:
    """Impulse (N s) of the eight creep forces, of the running resistance and of gravity uphill since t = 0."""
    from scipy.interpolate import CubicSpline

    resistance = point_wagon(result.scenario).resistance
    force = 2 * sum((result.channels[wheel(i, "tangential_force")] for i in WHEELS), np.zeros_like(result.time))
    force += np.array([resistance(v) for v in result.channels["speed"]])
    if "line_gradient" in result.channels:
        force += STANDARD_GRAVITY * point_wagon(result.scenario).mass * result.channels["line_gradient"]
    return np.asarray(CubicSpline(result.time, force).antiderivative()(result.time))
