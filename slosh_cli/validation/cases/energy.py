"""The energy ledger of every shipped stop, and what of it can be added up again from the channels alone."""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.results.channels import WHEELS, wheel
from slosh_cli.results.result import Result
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.quadrature import integral
from slosh_cli.validation.exact.wagon import point_wagon
from slosh_cli.validation.runs import runnable, stop


def compute(data: CaseData) -> Outcome:
    """The residual at the default tolerance and at a tight one; creep, brake, resistance and initial energy by hand."""
    found, curves = Findings(data), []
    for name in runnable():
        found.limit(f"{name}: residual at the default tolerance", stop(name).energy_residual, "default")
        result = stop(name, *data.reference["accurate"])
        found.limit(f"{name}: residual in an accurate integration", result.energy_residual, "accurate")
        wagon, case = point_wagon(result.scenario), result.scenario
        speed = case.braking.initial_speed
        initial = 0.5 * (wagon.mass + wagon.rotating_mass) * speed**2
        found.compare(
            f"{name}: initial kinetic energy / MJ", result.energy["initial_kinetic"] / 1e6, initial / 1e6, "initial"
        )
        for loss, power in _powers(result).items():
            by_hand = integral(result.time, power, case.braking.onset)
            deviation = (result.energy[loss] - by_hand) / initial
            found.limit(
                f"{name}: {loss} of the ledger less {loss} from the channels, over the initial energy",
                deviation,
                "losses",
            )
        curves.append(curve(name, result.time, np.maximum(np.abs(result.channels["energy_residual"]), 1e-14)))
    soft = stop("paper-80-solid", *data.reference["accurate"], *data.reference["soft_contact"])
    found.limit("a slow stop on soft contacts: residual", soft.energy_residual, "accurate")
    return found.outcome(Chart((Panel("time / s", "energy missing over initial kinetic energy", curves, log_y=True),)))


def _powers(result: Result) -> dict[str, Array]:
    """Power (W) that creep, brakes and resistance take from the whole wagon."""
    wagon, channels = point_wagon(result.scenario), result.channels
    speed = channels["speed"]
    creep = np.zeros_like(speed)
    brake = np.zeros_like(speed)
    for i in WHEELS:
        turning = channels[wheel(i, "speed")]
        creep += 2 * channels[wheel(i, "tangential_force")] * (speed - turning)
        bogie = _rate(result.time, channels[f"bogie_{1 if i <= 2 else 2}_pitch"])
        brake += 2 * channels[wheel(i, "brake_torque")] * (turning / wagon.wheel_radius - bogie)
    resistance = np.array([wagon.resistance(v) * v for v in speed])
    return {"creep": creep, "brake": brake, "resistance": resistance}


def _rate(time: Array, values: Array) -> Array:
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(time, values)(time, 1))
