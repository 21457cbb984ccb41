"""Which model of the liquid suits a tank, its filling and a deceleration: one answer, whichever model is in use.

The measure is the error of the force on the tank, rms over mass times deceleration during the first 14 s, as the two
models show it beside interFoam (`slosh validate interfoam`: rectangular tank 15.5 m x 3 m, 1.1875 m deep). Linear
theory errs in proportion to the surface's movement at first; shallow water errs by bores and impacts, and by the phase
that its first frequency gains where the liquid is deep for its length. The lesser error is recommended.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from slosh_cli.results.liquid_range import FREQUENCY_LIMIT, room_and_depth
from slosh_cli.scenario import Scenario, Tank, TankScenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.tank.still import frequency_excess
from slosh_cli.wagon.torque import brake_torque, moved_mass, total_mass

_MovingLiquid = Literal["modal", "shallow-water"]

LINEAR_ERRORS = ((0.0, 0.0), (0.798, 0.218), (1.996, 0.363))
"""Surface movement a L/g over the lesser of room and depth -> error of the modal liquid (0.6 and 1.5 m/s^2)."""
SHALLOW_ERROR = 0.132
"""The larger of shallow water's errors there, 0.132 and 0.109; its frequency is 1 % high in that tank."""
_DRIFT = 3.1
"""Error per excess of the first frequency: a share 8/pi^2 of the force gains the phase 2 pi n e in n = 1.5 periods
(14 s there); the rms of the difference is 8/pi^2 2 pi n e/sqrt(6)."""


@dataclass(frozen=True)
class Recommendation:
    """The model of the liquid that errs less, at a `deceleration` (m/s^2).

    `error`, `other_error`: expected errors of the force of this and of the other model, rms over mass times
    deceleration. `changeover`: deceleration (m/s^2) up to which the modal liquid errs less. `sentence` says it all.
    Without a deceleration (a tank alone) there is no model and no error, only the changeover.
    """

    model: _MovingLiquid | None
    deceleration: float | None
    error: float | None
    other_error: float | None
    changeover: float
    sentence: str

    @property
    def errors(self) -> str:
        """Both errors in words, as far as the comparisons reach; empty without a deceleration."""
        if self.error is None or self.other_error is None:
            return ""
        return f"{_words(self.error)} instead of {_words(self.other_error)}"

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON."""
        return {
            "liquid_model": self.model,
            "deceleration_m_s2": self.deceleration,
            "expected_force_error": self.error,
            "other_force_error": self.other_error,
            "modal_up_to_m_s2": self.changeover,
            "sentence": self.sentence,
        }


def recommend(tank: Tank, deceleration: float | None) -> Recommendation:
    """The model for this tank, its filling and a deceleration of this size (m/s^2), its own model left out of account.

    Without a deceleration: up to which one the modal liquid is to be preferred.
    """
    least, shallow = min(room_and_depth(tank)), shallow_error(frequency_excess(tank, STANDARD_GRAVITY))
    walls = bool(tank.baffles)
    changeover = 0.0 if walls else movement_of(shallow) * least * STANDARD_GRAVITY / tank.length
    if deceleration is None:
        sentence = (
            f"Use tank.liquid.model: modal for decelerations up to {changeover:.2f} m/s^2, shallow-water beyond "
            f"(expected error of the force there {_words(shallow)} of mass times deceleration, from comparisons with "
            "interFoam)."
        )
        if walls:
            sentence = "Use tank.liquid.model: shallow-water: the modal liquid has no baffles."
        return Recommendation(None, None, None, None, changeover, sentence)
    size = abs(deceleration)
    linear = linear_error(size * tank.length / STANDARD_GRAVITY / least)
    model: _MovingLiquid = "modal" if size <= changeover and not walls else "shallow-water"
    error, other = (linear, shallow) if model == "modal" else (shallow, linear)
    sentence = (
        f"At {size:.2f} m/s^2 use tank.liquid.model: {model} (expected error of the force {_words(error)} of mass "
        f"times deceleration, {_other(model)} {_words(other)}, from comparisons with interFoam): "
        f"{_reason(tank, size, model)}."
    )
    return Recommendation(model, size, error, other, changeover, sentence)


def _reason(tank: Tank, size: float, model: _MovingLiquid) -> str:
    """Why this model, at a deceleration of this `size` (m/s^2); the liquid's own model is left out of account."""
    if tank.baffles:
        return "the modal liquid has no baffles"
    room, depth = room_and_depth(tank)
    moved, excess = size * tank.length / STANDARD_GRAVITY, frequency_excess(tank, STANDARD_GRAVITY)
    outside = moved > min(room, depth) if model == "modal" else excess > FREQUENCY_LIMIT
    space = f"{room:.2f} m of room above" if room <= depth else f"{depth:.2f} m of liquid below"
    return (
        f"the surface would move by about {moved:.2f} m at the end walls, with {space} it, and shallow water's first "
        f"frequency is {excess:.1%} too high{'; neither model is good here, this one errs less' if outside else ''}"
    )


def _words(error: float) -> str:
    """The error in figures, as far as the comparisons reach."""
    most = LINEAR_ERRORS[-1][1]
    return f"{error:.2f}" if error <= most else f"over {most:.2f}"


def _other(model: _MovingLiquid) -> _MovingLiquid:
    return "modal" if model == "shallow-water" else "shallow-water"


def linear_error(movement: float) -> float:
    """Expected error of the modal liquid whose surface moves by this part of the lesser of room and depth."""
    (x0, y0), (x1, y1), (x2, y2) = LINEAR_ERRORS
    if movement <= x1:
        return y0 + (y1 - y0) * (movement - x0) / (x1 - x0)
    return y1 + (y2 - y1) * (movement - x1) / (x2 - x1)


def movement_of(error: float) -> float:
    """The movement at which the modal liquid's expected error is `error`: the inverse of `linear_error`."""
    (x0, y0), (x1, y1), (x2, y2) = LINEAR_ERRORS
    if error <= y1:
        return x0 + (x1 - x0) * (error - y0) / (y1 - y0)
    return x1 + (x2 - x1) * (error - y1) / (y2 - y1)


def shallow_error(excess: float) -> float:
    """Expected error of shallow water whose first frequency is too high by the part `excess`."""
    return math.hypot(SHALLOW_ERROR, _DRIFT * excess)


def stop_deceleration(scenario: Scenario) -> float:
    """Deceleration (m/s^2) of the wagon as a rigid point mass at its initial speed: by torque, at most by adhesion.

    It is what a load feels: gravity's pull on a gradient is left out, which pulls the load along (theory section 14).
    """
    wagon, brake = scenario.wagon, scenario.braking
    resistance = wagon.running_resistance
    speed, radius = brake.initial_speed, wagon.wheelset.wheel_radius
    drag = resistance.constant + resistance.linear * speed + resistance.quadratic * speed**2
    mass = total_mass(scenario)
    rolling = (8.0 * brake_torque(scenario, speed) / radius + drag) / moved_mass(scenario)
    return min(rolling, scenario.contact.adhesion.mu0 * STANDARD_GRAVITY + drag / mass)


def deceleration_of(scenario: Scenario | TankScenario) -> float | None:
    """The same of any scenario; None for a tank alone, which nothing decelerates."""
    return stop_deceleration(scenario) if isinstance(scenario, Scenario) else None
