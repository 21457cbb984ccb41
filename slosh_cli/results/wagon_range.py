"""Verdicts on a wagon, its track and its brake before anything moves: what is probably not meant, and what will happen.

Sources of the limits: EN 15528 (axle load 22.5 t, line category D); RID 6.8.2.1.18 (least wall of a tank of mild steel,
5 mm); Y25 bogies weigh 4.4 to 5 t with their wheelsets, their bare frames 1.6 to 2.2 t.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from slosh_cli.arrays import Vector
from slosh_cli.results.point_stop import mean_tau
from slosh_cli.results.recommendation import stop_deceleration
from slosh_cli.results.validity import Check
from slosh_cli.scenario import Scenario, rail_reach
from slosh_cli.scenario.schema_limits import Limits
from slosh_cli.section import section_of
from slosh_cli.tank.load import frozen_load
from slosh_cli.track.mem import rail_model
from slosh_cli.wagon.model import POSITION, wagon_model
from slosh_cli.wagon.torque import brake_torque, nominal_torque, total_mass

_FRAME_LIMIT = 3.5
"""t; heavier than any bare frame of a two-axle freight bogie."""
_OVERHANG_LIMIT = 1.6
"""Longest tank, in pivot spacings; tank wagons reach 1.2 to 1.5, beyond that the ends leave the gauge in curves."""
_TAU_SOURCE = "usual design limits of a freight wagon's brake; no clause of a standard was verified"
_MOST_BOUNCES = 0.3
"""From there on wheel loads over a dip differ by a per cent and more from those on the moving rail (seen)."""
_SHELL_MASS_PER_AREA = 7850.0 * 0.005
"""kg/m^2; a steel wall of 5 mm."""


def wagon_checks(scenario: Scenario) -> tuple[Check, ...]:
    """Verdicts on masses, lengths and track of a scenario."""
    return (_axle_check(scenario), _tau_check(scenario), *_mass_checks(scenario), *_track_checks(scenario))


def _mass_checks(scenario: Scenario) -> Iterator[Check]:
    wagon, tank = scenario.wagon, scenario.tank
    frame = wagon.bogie.mass / 1e3
    yield Check(
        "mass of a bogie frame in t",
        "input",
        frame,
        _FRAME_LIMIT,
        f"wagon.bogie.mass of {frame:.3g} t is that of a whole bogie, not of a frame without wheelsets (about 2 t); "
        f"the two wheelsets of {wagon.wheelset.mass / 1e3:.3g} t each are probably counted twice.",
    )
    overhang = tank.length / wagon.pivot_spacing
    yield Check(
        "length of the tank in pivot spacings",
        "input",
        overhang,
        _OVERHANG_LIMIT,
        f"A tank {tank.length:.4g} m long on pivots {wagon.pivot_spacing:.4g} m apart overhangs them by "
        f"{0.5 * (tank.length - wagon.pivot_spacing):.3g} m at each end; no wagon does (usual: 1.2 to 1.5 spacings). "
        "Check tank.length and wagon.pivot_spacing.",
    )
    shell, body = shell_mass(scenario), wagon.car_body.mass
    yield Check(
        "mass of a thin tank shell over that of the car body",
        "input",
        shell / body,
        1.0,
        f"wagon.car_body.mass of {body / 1e3:.3g} t is less than the bare shell of its tank in 5 mm of "
        f"steel, {shell / 1e3:.2g} t. It is the mass of the car body together with the empty tank.",
    )


def _axle_check(scenario: Scenario) -> Check:
    axle, limit = total_mass(scenario) / 4e3, scenario.limits.axle_load / 1e3
    standing, source = scenario.limits.standing_of(("axle_load",), "standard", "EN 15528, line category D")
    return Check(
        "axle load in t",
        "operation",
        axle,
        limit,
        f"Overload: each axle carries {axle:.1f} t; most lines end at 22.5 t (category D, EN 15528), the limit here is "
        f"{limit:g} t. Check masses, liquid density and fill.",
        standing,
        source,
    )


def _tau_check(scenario: Scenario) -> Check:
    """The brake against what wagons with and without wheel slide protection are built for."""
    tau, limits, protected = mean_tau(scenario), scenario.limits, scenario.braking.slide_protection is not None
    key, usual = "tau_with_protection" if protected else "tau", Limits()
    most: float = getattr(limits, key)
    meaning = (
        f"The brake asks for {tau:.3f} of the weight, on average of the way; the limit here is {most:g}. Wagons are "
        f"built for at most {usual.tau:g} without wheel slide protection, {usual.tau_with_protection:g} with it."
    )
    if tau > usual.tau_with_protection:
        meaning += " No freight wagon has such a brake."
    standing, source = limits.standing_of((key,), "indicative", _TAU_SOURCE)
    return Check("brake force over weight (tau)", "operation", tau, most, meaning, standing, source)


def shell_mass(scenario: Scenario) -> float:
    """Least mass (kg) of the tank's wall and ends in 5 mm of steel: a circle has the shortest outline of an area."""
    section = section_of(scenario.tank)
    area = section.area(section.height)
    return _SHELL_MASS_PER_AREA * (2.0 * math.sqrt(math.pi * area) * scenario.tank.length + 2.0 * area)


def _track_checks(scenario: Scenario) -> Iterator[Check]:
    if scenario.track.model == "rigid":
        yield _blow_check(scenario)
        return
    ends, elements = _domain_errors(scenario)
    track, speed = scenario.track, _speed(scenario)
    margin = rail_reach.margin_for(track.rail, track.foundation, speed, rail_reach.TOLD)
    longer = math.ceil(_wheels(scenario) + 2.0 * margin)
    yield Check(
        "change of the rail's deflection by the ends of its domain",
        "accuracy",
        ends,
        rail_reach.TOLD,
        f"The ends of the computed stretch of rail change its deflection by up to {ends:.1%}: this track is soft, its "
        f"wave reaches far. Write a track.domain.length of `{longer} m` or more, or leave it out.",
    )
    finer = 0.9 * rail_reach.fading_length(track.rail, track.foundation) * (250.0 * rail_reach.TOLD) ** 0.25
    yield Check(
        "error of the rail's deflection by its elements",
        "accuracy",
        elements,
        rail_reach.TOLD,
        f"The rail's elements are long for this track: its deflection errs by about {elements:.1%}. Write a "
        f"track.domain.element_length of `{finer:.2g} m` or less, or leave it out.",
    )


def _blow_check(scenario: Scenario) -> Check:
    """Springs give back the blows of short dips and of flats, which a rail carries away."""
    track, wheelset = scenario.track, scenario.wagon.wheelset
    spring = rail_model(track, np.zeros(1))
    bounce = math.sqrt(spring.stiffness / (0.5 * wheelset.mass + spring.mass)) / (2.0 * math.pi)
    dips = track.unevenness.dips or () if track.unevenness else ()
    lengths = [*(dip.length for dip in dips), *(flat.length for flat in scenario.wagon.wheel_flats)]
    shortest = min(lengths, default=math.inf)
    return Check(
        "dips and flats over the bounces of a wheel on its spring",
        "accuracy",
        scenario.braking.initial_speed / (shortest * bounce),
        _MOST_BOUNCES,
        f"Wheels on springs (track.model: rigid) bounce {bounce:.0f} times a second and give the blow of a dip or flat "
        f"{shortest:.2g} m long back to the wagon, where a rail carries it away: wheel loads may be several times too "
        "large. Write `track.model: moving-element` for them; the braking distance holds.",
    )


def _domain_errors(scenario: Scenario) -> tuple[float, float]:
    """Errors of the rail's deflection, as parts of it: by the ends of its domain, by the length of its elements."""
    if scenario.track.model == "rigid":
        return 0.0, 0.0
    wagon, track, speed = scenario.wagon, scenario.track, _speed(scenario)
    length, element = rail_reach.computed_lengths(track, wagon.bogie.wheelbase, wagon.pivot_spacing, speed)
    margin = 0.5 * (length - _wheels(scenario))
    return (
        rail_reach.error_of_ends(track.rail, track.foundation, speed, margin),
        rail_reach.error_of_elements(track.rail, track.foundation, element),
    )


def speed_check(scenario: Scenario) -> Check:
    """The initial speed against the critical one, from which on no run starts."""
    limit, speed = _critical_speed(scenario), scenario.braking.initial_speed
    return Check(
        "initial speed over the track's critical speed",
        "model",
        speed / limit,
        1.0,
        f"The initial speed of {speed:.1f} m/s is not below the track's critical speed of {limit:.1f} m/s: no steady "
        "rail shape exists there, and a run will refuse to start.",
    )


def _critical_speed(scenario: Scenario) -> float:
    return rail_reach.critical_speed(scenario.track.rail, scenario.track.foundation)


def _speed(scenario: Scenario) -> float:
    """The initial speed (m/s) where the track can bear it, standstill otherwise: no run starts from there."""
    speed = scenario.braking.initial_speed
    return speed if speed < _critical_speed(scenario) else 0.0


def _wheels(scenario: Scenario) -> float:
    return scenario.wagon.pivot_spacing + scenario.wagon.bogie.wheelbase


def residual_cause(scenario: Scenario, lifts: int) -> str:
    """What to do about a large energy residual: the cause that weighs most."""
    ends, elements = _domain_errors(scenario)
    if lifts:
        return (
            "wheels lifted and landed, and an undamped contact does not converge there; a braking distance does, loads "
            "do not"
        )
    if ends > rail_reach.TOLD and ends > elements:
        return "the rail's wave runs out at the ends of its domain; lengthen track.domain.length, or leave it out"
    if elements > rail_reach.TOLD:
        return "the rail's elements are long for this track; refine track.domain.element_length, or leave it out"
    if scenario.tank.liquid.model == "shallow-water":
        return "bores strike the end walls within steps; a lower solver.tolerance reduces it slowly"
    return "steps are long for this stop; lower solver.tolerance"


def braked_wheel_loads(scenario: Scenario) -> Vector:
    """Wheel loads (4,) N of the steadily braked wagon with a rigid load: static, on a rigid track, no wheel locked."""
    tank = scenario.tank
    model = wagon_model(scenario.wagon, tank.bottom_height, frozen_load(tank))
    slowing = stop_deceleration(scenario)
    drive = model.weight + slowing * model.mass[:, POSITION]
    np.add.at(drive, model.frame, nominal_torque(scenario))
    free, wheels = np.arange(1, model.first_wheel), np.arange(model.first_wheel, model.first_spin)
    place = np.zeros(model.coordinates)
    place[free] = np.linalg.solve(model.stiffness[np.ix_(free, free)], drive[free])
    return np.asarray(model.stiffness[wheels] @ place - drive[wheels], dtype=np.float64)


def lock_check(scenario: Scenario) -> Check:
    """Which wheels are bound to lock: their brake asks for more than the rail can give at any slip."""
    given = scenario.contact.adhesion.mu0 * np.maximum(braked_wheel_loads(scenario), 1.0)
    asked = brake_torque(scenario, 0.0) / scenario.wagon.wheelset.wheel_radius
    over = ", ".join(f"wheel {i}" for i, force in enumerate(given, 1) if asked > force)
    return Check(
        "brake force over adhesion",
        "operation",
        asked / float(given.min()),
        1.0,
        f"The brake asks for {asked / 1e3:.3g} kN at each wheel, but the rail gives at most {given.min() / 1e3:.3g} kN "
        f"under the least loaded one: locked wheels, with a rigid load {over}, will slide and wear flat.",
    )


def default_adhesion_checks(scenario: Scenario) -> Iterator[Check]:
    """Whether a stop whose file says nothing of the adhesion would lock wheels on wet rail, where dry rail is taken."""
    if "contact.adhesion" not in scenario.defaults:
        return
    wet = lock_check(scenario.with_({"contact.adhesion": "wet"}))
    meaning = (
        "The file says nothing of `contact.adhesion`: dry rail is taken. On wet rail the brake asks for more than the "
        "rail gives, wheels lock, and the stop is another; write `adhesion: dry` or `adhesion: wet`."
    )
    yield Check("brake force over adhesion, wet rail", "input", wet.value, wet.limit, meaning, "assumed", "Polach 2005")
