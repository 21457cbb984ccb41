"""Random plausible tank wagons, tracks, lines and brakes: overrides, in SI units, of the packaged scenario.

A seed gives the same overrides everywhere (numpy's PCG64). What is drawn is plausible for a real wagon, or for a script
that studies one; what belongs together is drawn together: a heavy body is long, wheels fit under a bogie.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from slosh_cli.scenario import Scenario, load_scenario

Overrides = dict[str, Any]
Draw = np.random.Generator
PACKAGED = "paper-80-liquid"
KM_H = 3.6


@cache
def packaged() -> Scenario:
    """The scenario that everything is drawn over."""
    return load_scenario(PACKAGED)


def scenario_of(overrides: Mapping[str, Any]) -> Scenario:
    """The scenario with the overrides; ScenarioError where it is refused."""
    return packaged().with_(overrides)


def wagon(seed: int) -> Overrides:
    """A stop of a random wagon."""
    draw = np.random.default_rng(seed)
    found = body(draw)
    found |= {"tank": tank(draw, found["wagon.pivot_spacing"])}
    found |= track(draw) | line(draw, found) | brake(draw)
    found |= {
        "contact.adhesion": adhesion(draw),
        "braking.initial_speed": float(draw.uniform(5.0, 160.0)) / KM_H,
        "braking.onset": float(draw.choice([0.0, draw.uniform(0.0, 2.0)])),
        "solver.time_limit": 300.0,
        "output.interval": 0.02,
    }
    return found


def _between(draw: Draw, low: float, high: float) -> float:
    """Between two positive values, evenly in their logarithms."""
    return float(math.exp(draw.uniform(math.log(low), math.log(high))))


def _rarely(draw: Draw, chance: float, made: Callable[[], float], else_: float = 0.0) -> float:
    """`made()` with a `chance`; else another value."""
    return made() if draw.random() < chance else else_


def body(draw: Draw) -> Overrides:
    """Masses, lengths, springs and resistance of a wagon."""
    radius = float(draw.uniform(0.31, 0.50))
    wheelbase = float(draw.uniform(max(1.5, 2.0 * radius + 0.2), 2.6))
    spacing = float(draw.uniform(max(5.0, wheelbase + 2.0), 15.5))
    mass = _between(draw, 7e3, 4e4)
    frame = float(draw.uniform(1.3e3, 3.0e3))
    wheelset = float(draw.uniform(1.0e3, 1.9e3))
    found: Overrides = {
        "wagon.wheelset.wheel_radius": radius,
        "wagon.wheelset.mass": wheelset,
        "wagon.wheelset.spin_inertia": wheelset * radius**2 * float(draw.uniform(0.3, 0.6)),
        "wagon.bogie.wheelbase": wheelbase,
        "wagon.bogie.mass": frame,
        "wagon.bogie.pitch_inertia": frame * wheelbase**2 * float(draw.uniform(0.08, 0.5)),
        "wagon.bogie.centre_height": float(draw.uniform(0.4, 0.65)),
        "wagon.pivot_spacing": spacing,
        "wagon.car_body.mass": mass,
        "wagon.car_body.pitch_inertia": mass * (1.3 * spacing) ** 2 / 12.0 * float(draw.uniform(0.6, 1.4)),
        "wagon.car_body.centre_height": float(draw.uniform(1.5, 2.4)),
        "wagon.traction_height": float(draw.uniform(0.6, 1.2)),
        "wagon.primary_suspension.stiffness": _between(draw, 4e5, 5e6),
        "wagon.primary_suspension.damping": _rarely(draw, 0.9, lambda: _between(draw, 2e3, 6e4)),
        "wagon.running_resistance.constant": _rarely(draw, 0.8, lambda: float(draw.uniform(200.0, 2000.0))),
        "wagon.running_resistance.linear": _rarely(draw, 0.5, lambda: float(draw.uniform(0.0, 50.0))),
        "wagon.running_resistance.quadratic": _rarely(draw, 0.7, lambda: float(draw.uniform(0.0, 4.0))),
    }
    if draw.random() < 0.3:
        return found | {"wagon.secondary_suspension": "none"}
    return found | {
        "wagon.secondary_suspension.stiffness": _between(draw, 2e6, 3e7),
        "wagon.secondary_suspension.damping": _between(draw, 8e3, 2e5),
    }


def tank(draw: Draw, spacing: float) -> Overrides:
    """A tank on pivots so far (m) apart, with its load."""
    length = spacing * float(draw.uniform(1.0, 1.5))
    fills = (0.02, 0.97, float(draw.uniform(0.02, 0.97)), float(draw.uniform(0.3, 0.95)))
    found: Overrides = {
        "length": length,
        "fill": float(draw.choice(fills, p=(0.05, 0.05, 0.4, 0.5))),
        "bottom_height": float(draw.uniform(0.8, 1.4)),
        "coefficients": "computed",
        "modes": int(draw.integers(1, 6)),
    }
    found |= _section(draw) | {"liquid": liquid(draw)}
    if found["liquid"]["model"] != "modal" and draw.random() < 0.3:
        found["baffles"] = _baffles(draw, length)
    return found


def _section(draw: Draw) -> Overrides:
    width, height = float(draw.uniform(2.0, 3.0)), float(draw.uniform(1.3, 2.9))
    shape = str(draw.choice(["horizontal-cylinder", "rectangular", "elliptical", "polygon"], p=(0.4, 0.2, 0.2, 0.2)))
    if shape == "horizontal-cylinder":
        return {"shape": shape, "radius": 0.5 * width}
    if shape != "polygon":
        return {"shape": shape, "width": width, "height": height}
    low, high, top = (float(draw.uniform(*span)) for span in ((0.1, 0.4), (0.5, 0.9), (0.3, 0.9)))
    half, foot = 0.5 * width, 0.5 * width * float(draw.uniform(0.2, 0.95))
    right = [[foot, 0.0], [half, low * height], [half, high * height], [top * half, height]]
    return {"shape": shape, "points": [*right, *([-y, z] for y, z in reversed(right))]}


def liquid(draw: Draw) -> Overrides:
    """Rigid, modal, shallow water, or shallow water with dispersion."""
    model = str(draw.choice(["rigid", "modal", "shallow-water"], p=(0.3, 0.3, 0.4)))
    found: Overrides = {"model": model, "density": _between(draw, 500.0, 1900.0)}
    if model == "modal":
        found["damping_ratio"] = _rarely(draw, 0.5, lambda: float(draw.uniform(0.0, 0.03)))
    if model == "shallow-water":
        found["cells"] = int(draw.choice([20, 40, 60, 120], p=(0.2, 0.3, 0.3, 0.2)))
        found["dispersion"] = "on" if draw.random() < 0.3 else "off"
    return found


def _baffles(draw: Draw, length: float) -> list[Overrides]:
    count = int(draw.integers(1, 4))
    places = [length * (k + 1 + float(draw.uniform(-0.25, 0.25))) / (count + 1) for k in range(count)]
    return [
        {"position": place, "opening": _rarely(draw, 0.8, lambda: float(draw.uniform(0.05, 0.9)))} for place in places
    ]


def track(draw: Draw) -> Overrides:
    """Rail and foundation, the length of elements left to the program or not; now and then on springs alone."""
    damped = draw.random() < 0.85
    found: Overrides = {
        "track.rail.second_moment": float(draw.uniform(2.0e-5, 3.4e-5)),
        "track.foundation.stiffness": _between(draw, 3e6, 8e7),
        "track.foundation.shear_stiffness": _rarely(draw, 0.5, lambda: float(draw.uniform(0.0, 1.5e6))),
        "track.foundation.damping": _between(draw, 2e3, 6e4) if damped else 0.0,
        "track.foundation.shear_damping": _rarely(draw, 0.4, lambda: float(draw.uniform(0.0, 2e3))) if damped else 0.0,
    }
    found["track.domain"] = {} if draw.random() < 0.6 else {"element_length": 0.5}
    if draw.random() < 0.1:
        found["track.model"] = "rigid"
    return found


def line(draw: Draw, wagon_: Mapping[str, Any]) -> Overrides:
    """Gradient, unevenness, dips, wheel flats: each on a part of the wagons."""
    found: Overrides = {}
    if draw.random() < 0.3:
        one = float(draw.uniform(-0.02, 0.03))
        points = [[0.0, one], [200.0, float(draw.uniform(-0.02, 0.03))], [600.0, 0.0]]
        found["track.gradient"] = one if draw.random() < 0.5 else points
    kind = draw.random()
    if kind < 0.1:
        found["track.unevenness"] = {"sigma": float(draw.uniform(5e-4, 2.5e-3)), "seed": int(draw.integers(1, 1000))}
    elif kind < 0.15:
        found["track.unevenness"] = {"spectrum": str(draw.choice(["fra-6", "fra-5", "erri-low", "erri-high"]))}
    elif kind < 0.25:
        first = 21.0 + 0.5 * (wagon_["wagon.bogie.wheelbase"] + wagon_["wagon.pivot_spacing"])
        place, length = first + float(draw.uniform(0.0, 50.0)), _between(draw, 0.5, 20.0)
        found["track.unevenness"] = {"dips": [{"position": place, "length": length, "depth": 1e-3 * length**0.5}]}
    if draw.random() < 0.1:
        depth = _between(draw, 2e-4, 1e-3)
        length = 4.0 * math.sqrt(depth * wagon_["wagon.wheelset.wheel_radius"])
        found["wagon.wheel_flats"] = [{"wheel": int(draw.integers(1, 5)), "depth": depth, "length": length}]
    return found


def adhesion(draw: Draw) -> Any:
    """Dry, wet, plain friction, or parameters of one's own."""
    kind = draw.random()
    if kind < 0.4:
        return "dry"
    if kind < 0.75:
        return "wet"
    if kind < 0.85:
        return float(draw.uniform(0.05, 0.6))
    area = float(draw.uniform(0.2, 1.0))
    return {
        "mu0": _between(draw, 0.02, 0.6),
        "A": float(draw.uniform(0.3, 1.0)),
        "B": float(draw.uniform(0.0, 1.0)),
        "kA": area,
        "kS": area * float(draw.uniform(0.2, 1.0)),
    }


def brake(draw: Draw) -> Overrides:
    """One of the five ways in which a brake is told, and how it builds up."""
    kind = str(draw.choice(["torque", "blocks", "discs", "deceleration", "braked_weight"], p=(0.5, 0.2, 0.1, 0.1, 0.1)))
    laws = ["cast-iron", "composite", float(draw.uniform(0.1, 0.4)), [[0.0, 0.32], [30.0, 0.25]]]
    law = laws[int(draw.integers(0, len(laws)))]
    kinds: dict[str, Any] = {
        "torque": _between(draw, 1e3, 3e4),
        "blocks": {"count": int(draw.integers(1, 3)), "force": float(draw.uniform(5e3, 4e4)), "friction": law},
        "discs": {"faces": 2, "force": float(draw.uniform(5e3, 3e4)), "radius": 0.25, "friction": law},
        "deceleration": float(draw.uniform(0.2, 1.5)),
        "braked_weight": {
            "percentage": float(draw.uniform(40.0, 120.0)),
            "speed": float(draw.choice([100.0, 120.0])) / KM_H,
        },
    }
    found: Overrides = {f"braking.{kind}": kinds[kind]}
    released = [[0.0, 0.0], [2.0, 1.0], [6.0, 1.0], [7.0, float(draw.uniform(0.0, 0.6))], [12.0, 1.0]]
    applications: list[Any] = [None, "P", "G", {"form": "linear", "time": float(draw.uniform(0.5, 8.0))}]
    applications.append({"form": "filling", "time_95": float(draw.uniform(3.0, 30.0)), "delay": 0.3, "jump": 0.1})
    applications.append({"form": "table", "points": released})
    application = applications[int(draw.choice(len(applications), p=(0.5, 0.2, 0.1, 0.1, 0.05, 0.05)))]
    found |= {} if application is None else {"braking.application": application}
    if draw.random() < 0.1:
        found["braking.slide_protection"] = {}
    if draw.random() < 0.1:
        found["braking.load_changeover"] = {"gross_mass": 48e3, "empty_share": 0.58}
    return found
