"""The data sheet of a loaded wagon: what an engineer asks of it before it moves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.results.filling import degree_of_filling
from slosh_cli.results.point_stop import mean_tau, point_stop, tau_at
from slosh_cli.scenario import Scenario, Tank, TankScenario
from slosh_cli.scenario.schema_brake import braked_percentage
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.section import liquid_depth, section_of
from slosh_cli.tank.coefficients import SloshMode, given_modes
from slosh_cli.tank.errors import TankError
from slosh_cli.tank.load import frozen_load
from slosh_cli.tank.longitudinal import longitudinal_modes
from slosh_cli.tank.still import longest_section
from slosh_cli.wagon.model import CAR_HEAVE, CAR_PITCH, POSITION, WagonModel, wagon_model
from slosh_cli.wagon.torque import moved_mass, total_mass

Sheet = dict[str, float | None]
"""Name, its unit at the end -> value; None where there is none."""
_NEAR = 0.15
"""A time is near a multiple of a period when it is off by less than this part of the period."""


def data_sheet(scenario: Scenario | TankScenario) -> Sheet:
    """Volumes in m^3, masses and axle loads in t, heights above the rail head in m, times in s, frequencies in Hz.

    Tau is the sum of T/R of all wheels over the weight of the loaded wagon, fully applied: at the initial speed, near
    rest, and of the constant brake that stops as short. Axle loads are those of standstill. Distance (from the onset)
    and deceleration are those of the wagon as a rigid point mass without slip. A tank alone has no wagon's figures.
    """
    tank_sheet = _tank_sheet(scenario.tank)
    slosh_sheet = _slosh_sheet(scenario)
    if not isinstance(scenario, Scenario):
        return tank_sheet | slosh_sheet
    return tank_sheet | _mass_sheet(scenario) | _brake_sheet(scenario) | slosh_sheet | _wagon_frequencies(scenario)


def _tank_sheet(tank: Tank) -> Sheet:
    section = section_of(tank)
    volume, liquid = (section.area(depth) * tank.length for depth in (section.height, liquid_depth(tank)))
    return {
        "tank_volume_m3": volume,
        "liquid_volume_m3": liquid,
        "ullage_m3": volume - liquid,
        "degree_of_filling": degree_of_filling(tank),
        "fill": tank.fill,
        "payload_t": frozen_load(tank).mass / 1e3,
    }


def _mass_sheet(scenario: Scenario) -> Sheet:
    wagon, tank = scenario.wagon, scenario.tank
    load, gross = frozen_load(tank), total_mass(scenario)
    moment = (
        wagon.car_body.mass * wagon.car_body.centre_height
        + 2.0 * wagon.bogie.mass * wagon.bogie.centre_height
        + 4.0 * wagon.wheelset.mass * wagon.wheelset.wheel_radius
        + load.mass * (tank.bottom_height + load.centre_height)
    )
    axles = _axle_loads(scenario)
    return {
        "gross_mass_t": gross / 1e3,
        "axle_load_front_t": float(axles[0]) / 1e3,
        "axle_load_rear_t": float(axles[-1]) / 1e3,
        "centre_of_gravity_m": moment / gross,
    }


def _brake_sheet(scenario: Scenario) -> Sheet:
    stop, level = point_stop(scenario), not any(slope for _, slope in scenario.track.gradient_points)
    percentage = braked_percentage(scenario.braking.initial_speed, stop.distance) if stop and level else None
    return {
        "tau": mean_tau(scenario),
        "tau_initial": tau_at(scenario, scenario.braking.initial_speed),
        "tau_near_rest": tau_at(scenario, 0.0),
        "filling_time_s": scenario.braking.filling_time,
        "mean_deceleration_m_s2": stop.deceleration if stop else None,
        "stopping_distance_m": stop.distance if stop else None,
    } | ({"braked_weight_percentage": percentage} if percentage else {})


def _slosh_sheet(scenario: Scenario | TankScenario) -> Sheet:
    """Periods of the first slosh mode: with the tank held, and in the wagon as a rigid mass that is free to roll.

    A brake gives the wagon a force; the wagon recoils under its liquid, which shortens the period (theory section 3).
    None where closed bulkheads part the liquid, which then has several periods, or where no mode is known.
    """
    tank, first = scenario.tank, _first_mode(scenario.tank)
    period = 2.0 * math.pi / first.frequency if first else None
    if not isinstance(scenario, Scenario):
        return {"slosh_period_s": period}
    rolling, parted = None, tank.liquid.model != "modal" and longest_section(tank) < tank.length
    if first and period and not parted and first.slosh_mass < moved_mass(scenario):
        rolling = period * math.sqrt(1.0 - first.slosh_mass / moved_mass(scenario))
    return {
        "slosh_period_s": period,
        "slosh_period_rolling_s": rolling,
        "slosh_after_build_up": _slosh_left(scenario, rolling) if rolling else None,
    }


def _first_mode(tank: Tank) -> SloshMode | None:
    """The first slosh mode: a modal liquid's own, else by potential flow, as if a solid load could move.

    That of the longest part between closed bulkheads. None where the section has no finite-element mesh.
    """
    given = given_modes(tank) if tank.liquid.model == "modal" else ()
    if given:
        return min(given, key=lambda mode: mode.frequency)
    length, density = tank.length if tank.liquid.model == "modal" else longest_section(tank), tank.liquid.density
    try:
        mode = longitudinal_modes(section_of(tank), liquid_depth(tank), length).modes[0]
    except TankError:
        return None
    return SloshMode(mode.frequency, density * mode.lambda_1, density * mode.lambda_02, density * mode.mu)


def _slosh_left(scenario: Scenario, period: float) -> float:
    """Amplitude of an undamped slosh of a `period` (s) once the brake has built up, over that of a brake at once.

    That is the size of the Fourier transform of the application's rate: 1 for a step, 0 for a ramp over whole periods.
    """
    turn, total, before = 2.0j * math.pi / period, 0.0j, 0.0
    stretches = scenario.braking.application.stretches
    for (start, base, slope, amplitude, rate), after in zip(stretches, (*stretches[1:], None), strict=True):
        length = after[0] - start if after else math.inf
        rest, fade = (0.0, 0.0) if after is None else (np.exp(-turn * length), math.exp(-rate * length))
        ramp = slope * (1.0 - rest) / turn - amplitude * rate * (1.0 - rest * fade) / (rate + turn)
        total += np.exp(-turn * start) * (base + amplitude - before + ramp)
        before = base + slope * length + amplitude * fade if after else before
    return float(abs(total))


def _half_wagon(scenario: Scenario) -> WagonModel:
    tank = scenario.tank
    return wagon_model(scenario.wagon, tank.bottom_height, frozen_load(tank))


def _axle_loads(scenario: Scenario) -> Vector:
    """Static axle loads (kg) from the front, (axles,): twice the reactions of the half wagon's wheels held at rest."""
    model = _half_wagon(scenario)
    body, wheels = slice(CAR_HEAVE, model.first_wheel), slice(model.first_wheel, model.first_spin)
    rest = np.linalg.solve(model.stiffness[body, body], model.weight[body])
    loads: Vector = 2.0 * (model.stiffness[wheels, body] @ rest - model.weight[wheels]) / STANDARD_GRAVITY
    return loads


def _wagon_frequencies(scenario: Scenario) -> Sheet:
    """Lowest frequencies (Hz) of the undamped wagon with its load frozen, rolling freely on a rigid rail.

    Bounce and pitch are the lowest modes in which the car body mostly heaves or pitches, by its part of the energy.
    """
    from scipy.linalg import eigh

    model = _half_wagon(scenario)
    bodies = slice(POSITION, model.first_wheel)
    mass, stiffness = model.mass[bodies, bodies].copy(), model.stiffness[bodies, bodies]
    mass[POSITION, POSITION] += 0.5 * (moved_mass(scenario) - total_mass(scenario))  # the wheels turn with it
    squares, modes = eigh(stiffness, mass)
    heave, pitch = (np.abs(modes[place]) * np.sqrt(mass[place, place]) for place in (CAR_HEAVE, CAR_PITCH))
    found = {}
    for name, part, other in (("bounce", heave, pitch), ("pitch", pitch, heave)):
        rest = 1e-9 * squares[-1]  # of the free way along the track
        mine = [square for square, a, b in zip(squares, part, other, strict=True) if a > b and square > rest]
        found[f"{name}_frequency_Hz"] = float(np.sqrt(mine[0])) / (2.0 * math.pi) if mine else None
    return found


def resonances(sheet: Mapping[str, float | None]) -> list[str]:
    """Sentences where the brake's filling time or a frequency of the wagon is near the first slosh period.

    That of the rolling wagon, for a brake does not hold the tank.
    """
    return list(_resonances(sheet))


def _resonances(sheet: Mapping[str, float | None]) -> Iterator[str]:
    left, filling = sheet.get("slosh_after_build_up"), sheet.get("filling_time_s")
    period = sheet.get("slosh_period_rolling_s") or sheet.get("slosh_period_s")
    if period is None:
        return
    turns = round((filling or 0.0) / period)
    if filling and left is not None and turns and abs(filling / period - turns) < _NEAR:
        times = "the" if turns == 1 else f"{turns} times the"
        yield (
            f"The brake fills in {filling:.1f} s, near {times} slosh period of {period:.1f} s in the rolling wagon: a "
            "straight build-up over a whole multiple of the period is an input shaper and leaves no slosh of the first "
            f"mode; this one leaves {left:.0%} of what a step leaves."
        )
    for name in ("bounce", "pitch"):
        frequency = sheet.get(f"{name}_frequency_Hz")
        if frequency is not None and abs(frequency * period - 1.0) < _NEAR:
            yield (
                f"The wagon's {name} at {frequency:.2f} Hz is near the first slosh frequency of {1.0 / period:.2f} Hz: "
                "the liquid and the suspension swing each other up."
            )
